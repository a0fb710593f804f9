//! The scene file as it is written: twins of the builder's types, with the defaults of the format.
//!
//! Doc comments here become the descriptions in the JSON Schema; units in brackets are quoted by error messages.

use schemars::JsonSchema;
use serde::Deserialize;

use super::air::{DragFile, WindFile};
use super::sensor::SensorFile;
use super::signal_file::SignalFile;

/// A scene: joints, bodies, frames and forces in a tree of named objects. SI units and radians; z is up.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "sincro scene")]
pub(crate) struct SceneFile {
    /// Gravitational acceleration, world axes [m/s²].
    #[serde(default = "standard_gravity")]
    pub gravity: [f64; 3],
    /// Joints: what hangs on one moves against its parent.
    #[serde(default)]
    pub joint: Vec<JointFile>,
    /// Bodies: what has mass and shape.
    #[serde(default)]
    pub body: Vec<BodyFile>,
    /// Named points and axes without mass: tips, sensors, cameras.
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
    /// Wind; none if left out.
    pub wind: Option<WindFile>,
    /// Density of the air that rotors turn in [kg/m³].
    #[serde(default = "sea_level")]
    #[schemars(range(min = 0.0))]
    pub air_density: f64,
}

/// One value, or a list of them with one entry a degree of freedom.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
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
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]}))]
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
    pub friction: Option<OneOrList<f64>>,
    /// Applied torque or force as a signal, evaluated continuously; a list for several degrees of freedom [N·m] or [N].
    pub torque: Option<OneOrList<SignalFile>>,
    /// Motor, on a joint with one degree of freedom.
    pub motor: Option<MotorFile>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
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
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct InitialFile {
    /// Coordinates: a number, universal 2, planar 3 (x, y, angle), ball 4 (quaternion w, x, y, z), free 7 (x, y, z, then w, x, y, z) [rad] or [m].
    pub position: Option<OneOrList<f64>>,
    /// Rates: a number, universal 2, planar 3, ball 3 (angular, child axes), free 6 (angular first, child axes) [rad/s] or [m/s].
    pub velocity: Option<OneOrList<f64>>,
}

/// A linear spring.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpringFile {
    /// Torque a radian, or force a metre [N·m/rad] or [N/m].
    #[schemars(range(min = 0.0))]
    pub stiffness: f64,
    /// Coordinate without torque [rad] or [m].
    #[serde(default)]
    pub rest: f64,
}

/// A motor.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MotorFile {
    /// What it does with its command.
    pub mode: MotorModeFile,
    /// Command as a signal, held over each base step; default 0. Torque, velocity, or position, as the mode says.
    pub command: Option<SignalFile>,
    /// Largest torque or force; none if left out or inf [N·m] or [N].
    #[schemars(range(min = 0.0), extend("x-infinite" = true))]
    pub max_torque: Option<f64>,
    /// Mode `position`: velocity a unit of error [1/s].
    #[schemars(range(min = 0.0))]
    pub kp: Option<f64>,
    /// Mode `position`: largest velocity; none if left out or inf [rad/s] or [m/s].
    #[schemars(range(min = 0.0), extend("x-infinite" = true))]
    pub max_velocity: Option<f64>,
    /// Mode `spring` [N·m/rad] or [N/m].
    #[schemars(range(min = 0.0))]
    pub stiffness: Option<f64>,
    /// Mode `spring`; default 0 [N·m·s/rad] or [N·s/m].
    #[schemars(range(min = 0.0))]
    pub damping: Option<f64>,
}

/// What a motor does with its command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
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
}

/// A rigid body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]}))]
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
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub density: Option<f64>,
    /// With `inertia`, or with shapes that say how it is distributed [kg].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub mass: Option<f64>,
    /// In the body frame, with `mass` and `inertia`; default the origin [m].
    pub center_of_mass: Option<[f64; 3]>,
    /// About the centre of mass, body axes, with `mass`.
    pub inertia: Option<InertiaFile>,
    /// Solids it consists of.
    #[serde(default)]
    pub shape: Vec<ShapeFile>,
}

/// Inertia about the centre of mass, body axes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
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
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "oneOf" = [
        {"required": ["cuboid"]}, {"required": ["cylinder"]}, {"required": ["capsule"]}, {"required": ["cone"]},
        {"required": ["sphere"]}
    ],
    "not" = {"required": ["rotation_deg", "quaternion_wxyz"]}
))]
pub(crate) struct ShapeFile {
    /// A box.
    pub cuboid: Option<CuboidFile>,
    /// A cylinder along z, centred.
    pub cylinder: Option<RoundFile>,
    /// A cylinder along z with half spheres on its ends; `length` is that of the cylinder alone.
    pub capsule: Option<RoundFile>,
    /// A cone along z: base at −length/4, apex at 3·length/4.
    pub cone: Option<RoundFile>,
    /// A ball.
    pub sphere: Option<SphereFile>,
    /// Origin of the shape in the body frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw of the shape in the body: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation of the shape in the body as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// In place of the body's density [kg/m³].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub density: Option<f64>,
    /// Colour in pictures, `#rrggbb`.
    #[schemars(extend("pattern" = "^#[0-9a-fA-F]{6}$"))]
    pub color: Option<String>,
}

/// A box.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CuboidFile {
    /// Full lengths of the edges along x, y and z [m].
    #[schemars(extend("items" = {"type": "number", "exclusiveMinimum": 0.0}))]
    pub size: [f64; 3],
}

/// A solid of revolution about z.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RoundFile {
    /// Radius [m].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub radius: f64,
    /// Length along z [m].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub length: f64,
}

/// A ball.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SphereFile {
    /// Radius [m].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub radius: f64,
}

/// A named point without mass.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("not" = {"required": ["rotation_deg", "quaternion_wxyz"]}))]
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
}

/// An external force and torque at the origin of a body or frame.
#[derive(Debug, Deserialize, JsonSchema)]
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

/// A rotor: thrust along z of its own frame, and the reaction of its torque, at a given speed.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend(
    "oneOf" = [{"required": ["blade"]}, {"required": ["constant"]}],
    "not" = {"required": ["rotation_deg", "quaternion_wxyz"]}
))]
pub(crate) struct RotorFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body or frame that carries it.
    pub parent: String,
    /// Hub in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw in the parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation in the parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Which way it turns at positive speed, seen from above.
    pub spin: SpinFile,
    /// Blade elements in the flow of momentum theory.
    pub blade: Option<BladeFile>,
    /// T = thrust·Ω², Q = torque·Ω².
    pub constant: Option<ConstantRotorFile>,
    /// Speed over time; a diagram may give it through the port PATH [rad/s].
    #[serde(default = "no_signal")]
    pub speed: SignalFile,
}

/// Which way a rotor turns, seen from above (against the thrust).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, serde::Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum SpinFile {
    /// Counter-clockwise.
    Ccw,
    /// Clockwise.
    Cw,
}

/// Blades of a rotor, untwisted and of one chord.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct BladeFile {
    /// Radius of the disc [m].
    pub radius: f64,
    /// Chord of a blade [m].
    pub chord: f64,
    /// Number of blades.
    pub n_blades: u32,
    /// Slope of the lift coefficient [1/rad].
    pub lift_slope: f64,
    /// Collective pitch [rad].
    pub collective_pitch: f64,
    /// Drag coefficient at zero incidence: c_d = cd0 + k_cd·α².
    pub cd0: f64,
    /// Growth of the drag coefficient with the incidence squared [1/rad²].
    pub k_cd: f64,
}

/// Constant coefficients of a rotor.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConstantRotorFile {
    /// Thrust over speed squared [N·s²/rad²].
    pub thrust: f64,
    /// Torque over speed squared [N·m·s²/rad²].
    pub torque: f64,
}

/// Whose axes components are along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, serde::Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum InFrameFile {
    /// The world's: they keep their direction.
    #[default]
    World,
    /// The parent's: they turn with it.
    Body,
}

pub(crate) fn standard_gravity() -> [f64; 3] {
    [0.0, 0.0, -9.81]
}

fn world() -> String {
    "/".into()
}

fn no_signal() -> SignalFile {
    SignalFile::Number(0.0)
}

fn sea_level() -> f64 {
    1.225
}

fn no_signals() -> [SignalFile; 3] {
    std::array::from_fn(|_| SignalFile::Number(0.0))
}
