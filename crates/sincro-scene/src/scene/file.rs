//! The scene file as it is written: twins of the builder's types, with the defaults of the format.
//!
//! Doc comments here become the descriptions in the JSON Schema; units in brackets are quoted by error messages.

use std::collections::BTreeMap;

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::activation::ActivationFile;
use super::air::{DragFile, WindFile};
use super::bushing::BushingFile;
use super::camera::CameraFile;
use super::field::{AirDensityFile, GravityFile};
use super::pose_start::InitialPoseFile;
use super::reuse_file::{DefaultFile, InstanceFile};
use super::rotor::RotorFile;
use super::sensor::SensorFile;
use super::signal_file::SignalFile;
use super::spring_damper::SpringDamperFile;
use super::tendon::TendonFile;

/// A scene: joints, bodies, frames and forces in a tree of named objects. SI units and radians; z is up.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(title = "sincro scene"))]
pub(crate) struct SceneFile {
    /// Version of the format: 2, or 1 where it is left out.
    #[allow(dead_code)] // read from the document
    #[serde(default = "first_format")]
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub format: u64,
    /// Scene files whose objects are added to those of this one, their paths relative to the folder.
    #[allow(dead_code)] // written out before
    #[serde(default)]
    pub include: Vec<String>,
    /// Names and numbers for formulas in this file, which the experiment and instances can change.
    #[allow(dead_code)] // read from the document
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
    /// Other scene files below frames of their own.
    #[allow(dead_code)] // written out before
    #[serde(default)]
    pub instance: Vec<InstanceFile>,
    /// Keys of objects that do not give them.
    #[allow(dead_code)] // written out before
    #[serde(default)]
    pub default: Vec<DefaultFile>,
    /// Gravitational acceleration, world axes [m/s²]; or a table of formulas of the position.
    #[serde(default = "standard_gravity")]
    pub gravity: GravityFile,
    /// Joints: what hangs on one moves against its parent.
    #[serde(default)]
    pub joint: Vec<JointFile>,
    /// Bodies: what has mass and shape.
    #[serde(default)]
    pub body: Vec<BodyFile>,
    /// Named points and axes without mass: tips, grips, marks.
    #[serde(default)]
    pub frame: Vec<FrameFile>,
    /// External forces and torques on bodies.
    #[serde(default)]
    pub force: Vec<ForceFile>,
    /// Rotors.
    #[serde(default)]
    pub rotor: Vec<RotorFile>,
    /// Drag of bodies in the air.
    #[serde(default)]
    pub drag: Vec<DragFile>,
    /// Sensors: sampled at rates of their own, with errors.
    #[serde(default)]
    pub sensor: Vec<SensorFile>,
    /// Cameras: where the viewer and still pictures look from.
    #[serde(default)]
    pub camera: Vec<CameraFile>,
    /// Wind, felt by rotors and drag elements: a table of `mean`, `profile`, `gust` and `turbulence`; none if left out.
    pub wind: Option<WindFile>,
    /// Scripts, each on an object.
    #[serde(default)]
    pub script: Vec<ScriptFile>,
    /// What keeps two objects together that the tree leaves apart: closed loops.
    #[serde(default)]
    pub closure: Vec<ClosureFile>,
    /// Pairs of joints that move together: gears.
    #[serde(default)]
    pub coupling: Vec<CouplingFile>,
    /// Springs, dampers and actuators between two points.
    #[serde(default)]
    pub spring_damper: Vec<SpringDamperFile>,
    /// Compliant elements with six degrees of freedom between two frames.
    #[serde(default)]
    pub bushing: Vec<BushingFile>,
    /// Springs, dampers and actuators along paths through several bodies, or over several joints.
    #[serde(default)]
    pub tendon: Vec<TendonFile>,
    /// Pose of a body or frame in the world at the start, solved for the positions of joints; a list for several.
    pub initial_pose: Option<OneOrList<InitialPoseFile>>,
    /// Contact laws of pairs of bodies, where they are not the combination of the two surfaces.
    #[serde(default)]
    pub contact_pair: Vec<ContactPairFile>,
    /// Approach slower than this does not bounce [m/s].
    #[serde(default = "rest_speed")]
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub rest_speed: f64,
    /// Whether a run may start with objects that overlap: they are then pushed apart in its first step.
    #[serde(default)]
    pub allow_overlap: bool,
    /// Density of the air, for rotors and drag [kg/m³]; or a table with a formula of the position.
    #[serde(default = "sea_level")]
    pub air_density: AirDensityFile,
}

/// One value, or a list of them with one entry a degree of freedom.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub(crate) enum OneOrList<T> {
    /// For a joint with one degree of freedom.
    One(T),
    /// One entry a degree of freedom.
    List(Vec<T>),
}

impl<T> OneOrList<T> {
    pub fn as_slice(&self) -> &[T] {
        match self {
            Self::One(x) => std::slice::from_ref(x),
            Self::List(list) => list,
        }
    }
}

/// A joint and what acts in it.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]})))]
pub(crate) struct JointFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body, joint or frame that carries it; `/` is the world.
    #[serde(default = "world")]
    pub parent: String,
    /// How it moves.
    pub kind: JointKindFile,
    /// Axis in the joint frame, of any length but zero. Revolute, prismatic and screw: default z; universal: the first axis, default x.
    pub axis: Option<[f64; 3]>,
    /// Second axis of a universal joint, at zero angles; default y.
    pub axis2: Option<[f64; 3]>,
    /// Advance of a screw [m/rad].
    pub pitch: Option<f64>,
    /// Origin of the joint frame in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw of the frame in its parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation of the frame in its parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Reflected inertia, a list for several degrees of freedom [kg·m²] or [kg].
    pub armature: Option<OneOrList<f64>>,
    /// Where it starts.
    #[serde(default)]
    pub initial: InitialFile,
    /// Spring: τ = −stiffness·(q − rest); a list for several degrees of freedom.
    pub spring: Option<OneOrList<SpringFile>>,
    /// Viscous coefficient: τ = −damping·q̇; a list for several degrees of freedom [N·m·s/rad] or [N·s/m].
    pub damping: Option<OneOrList<f64>>,
    /// Coulomb friction: sticks below it, slips against the motion above it; a list for several degrees of freedom [N·m] or [N].
    pub friction: Option<OneOrList<FrictionFile>>,
    /// Applied torque or force as a signal, evaluated continuously; a list for several degrees of freedom [N·m] or [N].
    pub torque: Option<OneOrList<SignalFile>>,
    /// Fixed joints: whether the force and torque through it are measured.
    #[serde(default)]
    pub force_sensor: bool,
    /// Rigid stops; a list for several degrees of freedom.
    pub limits: Option<OneOrList<LimitsFile>>,
    /// Motor; a list for several degrees of freedom.
    pub motor: Option<OneOrList<MotorFile>>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum JointKindFile {
    /// Not at all.
    Fixed,
    /// Turns about `axis`.
    Revolute,
    /// Slides along `axis`.
    Prismatic,
    /// Turns about `axis` and advances by `pitch` along it.
    Screw,
    /// Turns about `axis`, then about `axis2`, which the first one carries.
    Universal,
    /// Turns in any way.
    Ball,
    /// Slides along x and y of the joint frame and turns about z.
    Planar,
    /// Moves in any way.
    Free,
}

/// Where a joint starts.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct InitialFile {
    /// Coordinates: a number, universal 2, planar 3 (x, y, angle), ball 4 (quaternion w, x, y, z), free 7 (x, y, z, then w, x, y, z) [rad] or [m].
    pub position: Option<OneOrList<f64>>,
    /// Rates: a number, universal 2, planar 3, ball 3 (angular, child axes), free 6 (angular first, child axes) [rad/s] or [m/s].
    pub velocity: Option<OneOrList<f64>>,
}

/// Rigid stops of a joint.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct LimitsFile {
    /// Smallest coordinate; none if left out [rad] or [m].
    pub lower: Option<f64>,
    /// Largest coordinate; none if left out [rad] or [m].
    pub upper: Option<f64>,
    /// Speed of leaving a stop over speed of arriving.
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub restitution: f64,
}

/// How the surface of a body answers to contact. Of two bodies: friction is the geometric mean, restitution and lengths the larger, compliances add.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ContactFile {
    /// Coulomb's coefficient, sliding and sticking.
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub friction: f64,
    /// Newton's coefficient: speed of leaving over speed of arriving.
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub restitution: f64,
    /// Lever arm of rolling resistance: its torque is at most this times the normal force [m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub rolling_friction: f64,
    /// Lever arm of the friction torque about the normal [m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub spinning_friction: f64,
    /// Force a metre of penetration; rigid if left out or inf [N/m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0, "x-infinite" = true)))]
    pub stiffness: Option<f64>,
    /// Of a compliant contact: force = stiffness·δ·(1 + dissipation·δ̇) [s/m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub dissipation: Option<f64>,
    /// Bodies of the same group (other than 0) do not touch each other.
    #[serde(default)]
    pub group: u32,
}

/// What keeps two objects together.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ClosureFile {
    /// Letters, digits, `_` and `-`; its path is `/` and the name.
    pub name: String,
    /// How they are kept together.
    pub kind: ClosureKindFile,
    /// Paths of two bodies or frames, or `/`: their origins are kept together.
    pub between: [String; 2],
    /// Kind `distance`: the distance [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub length: Option<f64>,
    /// Kinds `hinge`, `slider` and `cylindrical`: axis that the two frames share, in the axes of each; `planar`: normal of the plane; `universal`: axis of the cross in the first frame; default z.
    pub axis: Option<[f64; 3]>,
    /// Kind `universal`: axis of the cross in the second frame, perpendicular to the first at the start; default x.
    pub axis2: Option<[f64; 3]>,
}

/// How two objects are kept together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum ClosureKindFile {
    /// Their origins coincide: a ball joint.
    Point,
    /// Their origins and `axis` coincide.
    Hinge,
    /// Their frames coincide.
    Weld,
    /// Their frames coincide but for a translation along `axis`.
    Slider,
    /// Their frames coincide but for a translation along `axis` and a rotation about it.
    Cylindrical,
    /// Their origins coincide, and `axis` of the first stays perpendicular to `axis2` of the second.
    Universal,
    /// Their origins stay in one plane perpendicular to `axis`, which they share.
    Planar,
    /// Their origins keep the distance `length`.
    Distance,
}

/// Two joints of one degree of freedom that move together: second = ratio·first + offset, with higher powers of first by `polynomial`; exactly, or with a `stiffness` through an elastic mesh with backlash.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct CouplingFile {
    /// Letters, digits, `_` and `-`; its path is `/` and the name.
    pub name: String,
    /// Paths of the two joints.
    pub joints: [String; 2],
    /// Rate of the second over rate of the first.
    pub ratio: f64,
    /// Coordinate of the second where that of the first is zero [rad] or [m].
    #[serde(default)]
    pub offset: f64,
    /// Coefficients c₂, c₃, c₄ of first², first³ and first⁴ (or the first of them), which are added to second; only of a rigid gear.
    #[cfg_attr(test, schemars(length(min = 1, max = 3)))]
    pub polynomial: Option<Vec<f64>>,
    /// Stiffness of the teeth at the second joint, above 0; without it the gear is rigid [N·m/rad] or [N/m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub stiffness: Option<f64>,
    /// With `stiffness`: damping while the teeth touch; default 0 [N·m·s/rad] or [N·s/m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub damping: Option<f64>,
    /// With `stiffness`: free travel of the second joint while the first is held; default 0 [rad] or [m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub backlash: Option<f64>,
}

/// Contact law between two bodies; what is left out is combined from their two surfaces.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ContactPairFile {
    /// Paths of the two bodies; `*` stands for any characters within a name, `**` for any at all. The last pair that fits two bodies counts.
    pub between: [String; 2],
    /// Whether they touch each other at all.
    #[serde(default = "yes")]
    pub touches: bool,
    /// Coulomb's coefficient, sliding and sticking.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub friction: Option<f64>,
    /// Newton's coefficient: speed of leaving over speed of arriving.
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub restitution: Option<f64>,
    /// Lever arm of rolling resistance: its torque is at most this times the normal force [m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub rolling_friction: Option<f64>,
    /// Lever arm of the friction torque about the normal [m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub spinning_friction: Option<f64>,
    /// Force a metre of penetration; rigid if inf [N/m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0, "x-infinite" = true)))]
    pub stiffness: Option<f64>,
    /// Of a compliant contact: force = stiffness·δ·(1 + dissipation·δ̇) [s/m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub dissipation: Option<f64>,
}

/// Friction of a joint: one limit, or a table of a limit at rest and one in motion.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub(crate) enum FrictionFile {
    /// Coulomb friction, the same at rest and in motion [N·m] or [N].
    Coulomb(f64),
    /// Stiction and Stribeck's curve.
    Stribeck(#[serde(deserialize_with = "of_table")] StribeckFile),
}

/// Reads a table alone: structures are read from lists too, which here are frictions of several degrees of freedom.
fn of_table<'de, D: serde::Deserializer<'de>>(reader: D) -> Result<StribeckFile, D::Error> {
    let table = serde_json::Map::deserialize(reader)?;
    serde_json::from_value(table.into()).map_err(serde::de::Error::custom)
}

/// Friction that is larger at rest, or grows with the load: limit = sliding + (static − sliding)·exp(−(q̇/stribeck_velocity)²) + load_coefficient·N.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct StribeckFile {
    /// Limit in fast motion without load [N·m] or [N].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub sliding: f64,
    /// Limit at rest without load, at least that in motion; by default the same [N·m] or [N].
    #[serde(rename = "static")]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub at_rest: Option<f64>,
    /// Speed at which the excess over `sliding` has fallen to 37 % [rad/s] or [m/s].
    #[serde(default = "stribeck_velocity")]
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub stribeck_velocity: f64,
    /// Friction over the force N that the bearing transmits, of revolute joints (friction coefficient times radius of the pin) [m] and prismatic ones [1].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub load_coefficient: f64,
}

/// A linear spring.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["law", "table"]})))]
pub(crate) struct SpringFile {
    /// Torque a radian, or force a metre; default 0 with a `law` or a `table` [N·m/rad] or [N/m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub stiffness: Option<f64>,
    /// Coordinate without torque [rad] or [m].
    #[serde(default)]
    pub rest: f64,
    /// Formula of x = q − rest and v = q̇ for a torque that is added [N·m] or [N].
    pub law: Option<String>,
    /// Points (x, torque) of a torque that is added, linear between them and beyond: rad and N·m, or m and N.
    pub table: Option<Vec<[f64; 2]>>,
}

impl SpringFile {
    /// Returns true if it has a stiffness or a law.
    pub fn has_force(&self) -> bool {
        self.stiffness.is_some() || self.law.is_some() || self.table.is_some()
    }
}

/// A motor.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct MotorFile {
    /// What it does with its command.
    pub mode: MotorModeFile,
    /// Command as a signal, held over each base step; default 0. Torque, velocity, position, or voltage, as the mode says.
    pub command: Option<SignalFile>,
    /// Largest torque or force, above 0; none if left out or inf [N·m] or [N]. A joint that nothing drives has mode `free`.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0, "x-infinite" = true)))]
    pub max_torque: Option<f64>,
    /// Mode `position`: velocity a unit of error [1/s].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub kp: Option<f64>,
    /// Mode `position`: largest velocity; none if left out or inf [rad/s] or [m/s].
    #[cfg_attr(test, schemars(range(min = 0.0), extend("x-infinite" = true)))]
    pub max_velocity: Option<f64>,
    /// Mode `spring` [N·m/rad] or [N/m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub stiffness: Option<f64>,
    /// Mode `spring`; default 0 [N·m·s/rad] or [N·s/m].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub damping: Option<f64>,
    /// Mode `voltage`: resistance of the winding, above 0 [Ω].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub resistance: Option<f64>,
    /// Mode `voltage`: inductance of the winding; default 0, the current then follows at once [H].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub inductance: Option<f64>,
    /// Mode `voltage`: torque of the motor for each ampere, above 0 [N·m/A].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub torque_constant: Option<f64>,
    /// Mode `voltage`: induced voltage for each rad/s of the motor; default `torque_constant` [V·s/rad].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub back_emf_constant: Option<f64>,
    /// Mode `voltage`: turns of the motor for each turn of the joint, or angle of the motor over displacement [rad/m]; default 1.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub gear_ratio: Option<f64>,
    /// Mode `voltage`: inertia of the motor's rotor, which gear_ratio² times is added to the armature of the joint; default 0 [kg·m²].
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub rotor_inertia: Option<f64>,
    /// Mode `voltage`: voltage of the supply, above 0; no limit if left out or inf [V].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0, "x-infinite" = true)))]
    pub max_voltage: Option<f64>,
    /// Modes `torque`, `spring` and `voltage`: a state between the command and what acts, in the unit of the command.
    pub activation: Option<ActivationFile>,
}

/// What a motor does with its command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum MotorModeFile {
    /// Nothing: the joint turns freely.
    Free,
    /// The command is the torque.
    Torque,
    /// The joint has the commanded velocity exactly, with whatever torque that takes up to `max_torque`.
    Velocity,
    /// As velocity, towards the commanded position: kp·(command − q), up to `max_velocity`.
    Position,
    /// τ = stiffness·(command − q) − damping·q̇.
    Spring,
    /// The command is the voltage across the winding of a direct-current motor [V].
    Voltage,
}

/// A rigid body.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]})))]
pub(crate) struct BodyFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body, joint or frame that carries it; `/` is the world.
    #[serde(default = "world")]
    pub parent: String,
    /// Origin of the body frame in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw of the frame in its parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation of the frame in its parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Of its shapes, from which mass and inertia are computed [kg/m³].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub density: Option<f64>,
    /// With `inertia`, or with shapes that say how it is distributed [kg].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub mass: Option<f64>,
    /// In the body frame, with `mass` and `inertia`; default the origin [m].
    pub center_of_mass: Option<[f64; 3]>,
    /// About the centre of mass, body axes, with `mass`.
    pub inertia: Option<InertiaFile>,
    /// Solids it consists of.
    #[serde(default)]
    pub shape: Vec<ShapeFile>,
    /// Makes its shapes touch others that have a contact, too; without it they only show.
    pub contact: Option<ContactFile>,
    /// What shows in the place of its shapes; it has no mass and touches nothing.
    #[serde(default)]
    pub visual: Vec<VisualFile>,
}

/// Inertia about the centre of mass, body axes.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct InertiaFile {
    /// Moment about x [kg·m²].
    pub xx: f64,
    /// Moment about y [kg·m²].
    pub yy: f64,
    /// Moment about z [kg·m²].
    pub zz: f64,
    /// Off-diagonal entry −∫xy dm of the inertia matrix [kg·m²].
    #[serde(default)]
    pub xy: f64,
    /// Off-diagonal entry −∫xz dm of the inertia matrix [kg·m²].
    #[serde(default)]
    pub xz: f64,
    /// Off-diagonal entry −∫yz dm of the inertia matrix [kg·m²].
    #[serde(default)]
    pub yz: f64,
}

/// A solid of a body.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend(
    "oneOf" = [
        {"required": ["cuboid"]}, {"required": ["cylinder"]}, {"required": ["capsule"]}, {"required": ["cone"]},
        {"required": ["sphere"]}, {"required": ["plane"]}, {"required": ["hull"]}, {"required": ["mesh"]},
        {"required": ["height_field"]}, {"required": ["torus"]}
    ],
    "not" = {"required": ["rotation_deg", "quaternion_wxyz"]}
)))]
pub(crate) struct ShapeFile {
    /// A box.
    pub cuboid: Option<CuboidFile>,
    /// A cylinder along z, centred.
    pub cylinder: Option<RoundFile>,
    /// A cylinder along z with half spheres on its ends; `length` is that of the cylinder alone.
    pub capsule: Option<RoundFile>,
    /// A cone along z: base at −length/4, apex at 3·length/4.
    pub cone: Option<RoundFile>,
    /// A torus about z, such as a tyre; what touches it touches a disc with its rounded edge.
    pub torus: Option<TorusFile>,
    /// A ball.
    pub sphere: Option<SphereFile>,
    /// Everything below z = 0 of its frame; of bodies fixed in the world.
    pub plane: Option<PlaneFile>,
    /// Convex hull of points.
    pub hull: Option<HullFile>,
    /// A closed triangle mesh from a file.
    pub mesh: Option<MeshFile>,
    /// Ground as heights over a grid; of bodies fixed in the world.
    pub height_field: Option<HeightFieldFile>,
    /// Origin of the shape in the body frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw of the shape in the body: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation of the shape in the body as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// In place of the body's density [kg/m³].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub density: Option<f64>,
    /// Colour in pictures, `#rrggbb`.
    #[cfg_attr(test, schemars(extend("pattern" = "^#[0-9a-fA-F]{6}$")))]
    pub color: Option<String>,
}

/// A box.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct CuboidFile {
    /// Full lengths of the edges along x, y and z [m].
    #[cfg_attr(test, schemars(extend("items" = {"type": "number", "exclusiveMinimum": 0.0})))]
    pub size: [f64; 3],
}

/// A solid of revolution about z.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct RoundFile {
    /// Radius [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub radius: f64,
    /// Length along z [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub length: f64,
}

/// A torus about z; its hole has no contact.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct TorusFile {
    /// Radius of the circle in the middle of the tube [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub major_radius: f64,
    /// Radius of the tube, at most `major_radius` [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub tube_radius: f64,
}

/// A ball.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct SphereFile {
    /// Radius [m].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub radius: f64,
}

/// A half space below z = 0.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct PlaneFile {}

/// The convex hull of points.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct HullFile {
    /// Corners, four or more that span a volume [m].
    pub points: Vec<[f64; 3]>,
}

/// A closed triangle mesh.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshFile {
    /// STL (binary or text) or OBJ file, its path relative to the folder.
    pub file: String,
    /// What its lengths are multiplied by, one number or one for each axis; 0.001 if it is in millimetres.
    pub scale: Option<OneOrList<f64>>,
    /// Its convex hull in its place; what moves and touches needs one.
    #[serde(default)]
    pub convex: bool,
}

/// Heights over a grid centred on the frame of the shape.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["file"]}, {"required": ["heights"]}])))]
pub(crate) struct HeightFieldFile {
    /// CSV file of numbers without a line of names, its path relative to the folder: a line is a row along x, the first one at the least y.
    pub file: Option<String>,
    /// The same rows given here [m].
    pub heights: Option<Vec<Vec<f64>>>,
    /// Extent along x and y, from the first height to the last [m].
    #[cfg_attr(test, schemars(extend("items" = {"type": "number", "exclusiveMinimum": 0.0})))]
    pub size: [f64; 2],
    /// What heights are multiplied by.
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

/// A named point without mass.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]})))]
pub(crate) struct FrameFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body, joint or frame that carries it; `/` is the world.
    #[serde(default = "world")]
    pub parent: String,
    /// Origin in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw in the parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation in the parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// What shows there; it has no mass and touches nothing.
    #[serde(default)]
    pub visual: Vec<VisualFile>,
}

/// Something that only shows.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend(
    "oneOf" = [
        {"required": ["cuboid"]}, {"required": ["cylinder"]}, {"required": ["capsule"]}, {"required": ["cone"]},
        {"required": ["sphere"]}, {"required": ["torus"]}, {"required": ["mesh"]}
    ],
    "not" = {"required": ["rotation_deg", "quaternion_wxyz"]}
)))]
pub(crate) struct VisualFile {
    /// A box.
    pub cuboid: Option<CuboidFile>,
    /// A cylinder along z, centred.
    pub cylinder: Option<RoundFile>,
    /// A cylinder along z with half spheres on its ends; `length` is that of the cylinder alone.
    pub capsule: Option<RoundFile>,
    /// A cone along z: base at −length/4, apex at 3·length/4.
    pub cone: Option<RoundFile>,
    /// A torus about z, such as a tyre; what touches it touches a disc with its rounded edge.
    pub torus: Option<TorusFile>,
    /// A ball.
    pub sphere: Option<SphereFile>,
    /// Triangles from a file, which need not enclose a volume.
    pub mesh: Option<VisualMeshFile>,
    /// Origin in the frame of the body [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw in the body: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation in the body as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Colour, `#rrggbb`.
    #[cfg_attr(test, schemars(extend("pattern" = "^#[0-9a-fA-F]{6}$")))]
    pub color: Option<String>,
}

/// Triangles that only show.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct VisualMeshFile {
    /// STL (binary or text) or OBJ file, its path relative to the folder.
    pub file: String,
    /// What its lengths are multiplied by, one number or one for each axis; 0.001 if it is in millimetres.
    pub scale: Option<OneOrList<f64>>,
}

/// An external force and torque at the origin of a body or frame.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ForceFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body or frame it acts on.
    pub parent: String,
    /// Components along x, y and z as signals; default none [N].
    #[serde(default = "no_signals")]
    pub force: [SignalFile; 3],
    /// Components about x, y and z as signals; default none [N·m].
    #[serde(default = "no_signals")]
    pub torque: [SignalFile; 3],
    /// Whose axes the components are along.
    #[serde(default)]
    pub in_frame: InFrameFile,
    /// Whether a diagram may add to it, through the ports `PATH.force.x` … `PATH.torque.z` of the world.
    #[serde(default)]
    pub input: bool,
}

/// Whose axes components are along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, serde::Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum InFrameFile {
    /// The world's: they keep their direction.
    #[default]
    World,
    /// The parent's: they turn with it.
    Body,
}

pub(crate) fn standard_gravity() -> GravityFile {
    GravityFile::Uniform([0.0, 0.0, -9.81])
}

pub(super) fn world() -> String {
    "/".into()
}

fn rest_speed() -> f64 {
    sincro_dynamics::model::REST_SPEED
}

fn yes() -> bool {
    true
}

fn stribeck_velocity() -> f64 {
    0.01
}

fn first_format() -> u64 {
    1
}

fn sea_level() -> AirDensityFile {
    AirDensityFile::Uniform(1.225)
}

fn no_signals() -> [SignalFile; 3] {
    std::array::from_fn(|_| SignalFile::Number(0.0))
}

/// A script on an object, called inside the step.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["file"]}, {"required": ["code"]}])))]
pub(crate) struct ScriptFile {
    /// Path of the object that it belongs to.
    pub object: String,
    /// Lua file in this folder.
    pub file: Option<String>,
    /// Lua text, in place of a file.
    pub code: Option<String>,
    /// How it is called: `new` by functions `sysCall_…`, `old` as a whole with `sim_call_type`, `detect` by what its text has.
    #[serde(default)]
    pub style: ScriptStyleFile,
    /// `child`: of the simulation; `customization`: of the model, called after child scripts of the same place.
    #[serde(default)]
    pub kind: ScriptKindFile,
    /// Whether an old script is a thread: run once, and resumed at every tick where it called simSwitchThread or simWait.
    #[serde(default)]
    pub threaded: bool,
    /// What an error in a call does: `stop` ends the run; with `continue` it goes on as in V-REP, and its audit fails; `detect`: `continue` for scripts of V-REP up to 3.4.
    #[serde(default)]
    pub on_error: OnErrorFile,
    /// What is stored with it, for simGetScriptSimulationParameter.
    #[serde(default)]
    pub parameters: std::collections::BTreeMap<String, ScriptParameterFile>,
    /// Files of this folder that it may read with `io.open` and `io.lines`; without any, no file is open to it.
    #[serde(default)]
    pub files: Vec<String>,
    /// Memory that it may take, 2^20 bytes each.
    #[serde(default = "script_memory")]
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub max_memory_mib: u32,
    /// Lua instructions that one call may take.
    #[serde(default = "script_instructions")]
    #[cfg_attr(test, schemars(range(min = 1000)))]
    pub max_instructions: u64,
}

/// How a script is called.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, serde::Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum ScriptStyleFile {
    /// `new` if it has a function `sysCall_…` after its first run, else `old`.
    #[default]
    Detect,
    /// The whole text for every call.
    Old,
    /// Functions.
    New,
}

/// What an error in a call of a script does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, serde::Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum OnErrorFile {
    /// `continue` if it is written for V-REP up to 3.4 (names such as `simGetObjectHandle` only), else `stop`.
    #[default]
    Detect,
    /// The run stops.
    Stop,
    /// The run goes on, and its audit fails.
    Continue,
}

/// Kinds of scripts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, serde::Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub(crate) enum ScriptKindFile {
    /// Of the simulation.
    #[default]
    Child,
    /// Of the model.
    Customization,
}

/// A parameter of a script.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub(crate) enum ScriptParameterFile {
    /// A number.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// A text; scripts get nil, false, true or a number where it reads so.
    Text(String),
}

/// Ordinary scripts take less than 1 MiB.
fn script_memory() -> u32 {
    64
}

/// About half a second: far more than a call in a control loop needs.
fn script_instructions() -> u64 {
    20_000_000
}
