//! The builder: the tree as the user names it.

use std::sync::Arc;

use sincro_math::scalar_field::ScalarField;

use super::LoopJointKind;
use super::MassProperties;
use crate::actuation::{Activation, ForceLaw, GravityField, Motor, NonlinearLaw, Winding};
use crate::aero::rotor::RotorLaw;
use crate::aero::wind::Wind;
use crate::contact::{Material, PairLaw, Surface};
use crate::joint::{Friction, JointKind};
use crate::signal::Signal;
use crate::spatial::Pose;

/// Default rest speed `[m/s]` of [`ModelBuilder::set_rest_speed`]: slower approach has no restitution; a bounce from
/// here is 5e-8 m high under gravity. Without it a ball would bounce infinitely often in finite time (Zeno behaviour).
pub const REST_SPEED: f64 = 1e-3;

/// Id of an object of the tree under construction, returned by the methods of [`ModelBuilder`] and valid for that
/// builder; [`NodeId::WORLD`] is the root.
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// let mast = builder.frame("mast", NodeId::WORLD, Pose::translation(Vec3([0.0, 0.0, 2.0])));
/// let tip = builder.frame("tip", mast, Pose::translation(Vec3([0.5, 0.0, 0.0])));
/// assert!(mast != tip && mast != NodeId::WORLD);
/// let (model, _warnings) = builder.build()?;
/// assert_eq!(model.names().frame("tip").unwrap().pose.pos, Vec3([0.5, 0.0, 2.0])); // [m], in the world
/// # Ok::<(), BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// The world: fixed root of the tree, with z up where gravity is along −z.
    pub const WORLD: Self = Self(0);
}

/// Joint to be added by [`ModelBuilder::joint`]. Lists have one entry for each degree of freedom, or are empty for
/// "none". Those of a ball joint are about the axes of its child frame; those of a free joint these three, then along
/// the same axes.
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// // a mass of 2 kg on a spring of 8 N/m: angular frequency √(k/m) = 2 rad/s
/// let mut builder = ModelBuilder::new([0.0; 3]);
/// let mut slide = JointSpec::new(JointKind::Prismatic { axis: [1.0, 0.0, 0.0] });
/// slide.spring = vec![(8.0, 0.0)]; // stiffness, rest position
/// let slide = builder.joint("slide", NodeId::WORLD, Pose::identity(), slide);
/// let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [0.01, 0.0, 0.0, 0.01, 0.0, 0.01] };
/// builder.body("cart", slide, Pose::identity(), BodySpec { mass });
/// let (model, _warnings) = builder.build()?;
/// let slide = model.names().joint_id("slide").unwrap();
/// let mut world = World::builder(model).method(MethodKind::Rk4).coordinates(slide, &[0.1]).build()?;
/// while world.time() < 1.0 {
///     world.step()?;
/// }
/// assert!((world.coordinates(slide)[0] - 0.1 * f64::cos(2.0)).abs() < 1e-9); // [m]
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct JointSpec {
    /// Kind and axes.
    pub kind: JointKind,
    /// Armature (reflected inertia of the drive) `[kg·m²]` or `[kg]`.
    pub armature: Vec<f64>,
    /// Spring stiffness [N·m/rad] or [N/m] and rest position `[rad]` or `[m]`. Of ball and free joints: stiffness and
    /// components of the rotation vector of the rest orientation, then, of free ones, along the axes of the joint frame
    /// (see [`crate::actuation::spring`]).
    pub spring: Vec<(f64, f64)>,
    /// Nonlinear laws of the springs and dampers, of the deflection from the rest position, added to the linear ones;
    /// not of ball and free joints.
    pub spring_law: Vec<Option<Arc<NonlinearLaw>>>,
    /// Viscous damping coefficients `[N·m·s/rad]` or `[N·s/m]`.
    pub damping: Vec<f64>,
    /// Coulomb friction and stiction `[N·m]` or `[N]`.
    pub friction: Vec<Friction<f64>>,
    /// Applied torque [N·m] or force `[N]` over time, evaluated inside the step.
    pub torque: Vec<Signal>,
    /// True for a fixed joint through which the wrench is measured: it is then a link of its own, whose six degrees of
    /// freedom are locked.
    pub sensor: bool,
    /// Lower and upper limit of each coordinate `[rad]` or `[m]`, infinite for none; not of ball and free joints.
    pub limits: Vec<(f64, f64)>,
    /// Restitution at the limits: speed after over speed before the impact, 0 to 1.
    pub limit_restitution: f64,
    /// Motors; their commands are inputs of the world. Those of ball and free joints are in mode free, torque or
    /// velocity: torques about the axes of the child frame, then, of free ones, forces along them.
    pub motor: Vec<Motor<f64>>,
    /// Windings of the motors in mode voltage, one entry a motor, or empty.
    pub winding: Vec<Option<Winding<f64>>>,
    /// Activations of the motors in mode torque, spring or voltage, one entry a motor, or empty.
    pub activation: Vec<Option<Activation<f64>>>,
}

impl JointSpec {
    /// Joint of that kind with empty lists: no spring, damper, friction, limits or motor.
    #[must_use]
    pub fn new(kind: JointKind) -> Self {
        Self {
            kind,
            armature: Vec::new(),
            spring: Vec::new(),
            spring_law: Vec::new(),
            damping: Vec::new(),
            friction: Vec::new(),
            torque: Vec::new(),
            sensor: false,
            limits: Vec::new(),
            limit_restitution: 0.0,
            motor: Vec::new(),
            winding: Vec::new(),
            activation: Vec::new(),
        }
    }
}

/// Body to be added by [`ModelBuilder::body`].
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// // bodies without a joint between them are one link
/// let mass = Shape::Sphere { radius: 0.05 }.mass_properties(1000.0);
/// builder.body("left", hinge, Pose::translation(Vec3([-0.1, 0.0, 0.0])), BodySpec { mass });
/// builder.body("right", hinge, Pose::translation(Vec3([0.1, 0.0, 0.0])), BodySpec { mass });
/// let (model, _warnings) = builder.build()?;
/// assert_eq!((model.links().len(), model.total_mass()), (1, 2.0 * mass.mass));
/// # Ok::<(), BuildError>(())
/// ```
#[derive(Clone, Debug)]
pub struct BodySpec {
    /// Mass `[kg]`, centre of mass `[m]` and inertia about it `[kg·m²]`, in the body's frame.
    pub mass: MassProperties,
}

/// External force and torque on a body or frame, at its origin; to be added by [`ModelBuilder::force`].
#[derive(Clone, Debug)]
pub struct ForceSpec {
    /// Force components x, y, z `[N]` over time.
    pub force: [Signal; 3],
    /// Torque components x, y, z `[N·m]` over time.
    pub torque: [Signal; 3],
    /// True if the components turn with the body; else they are along the world's axes.
    pub in_body: bool,
    /// True if it takes six commands (force x, y, z `[N]`, torque x, y, z `[N·m]`), which are added to the signals.
    pub is_input: bool,
}

/// Rotor to be added by [`ModelBuilder::rotor`]; the thrust axis is z of its own frame, the hub its origin.
#[derive(Clone, Debug)]
pub struct RotorSpec {
    /// Aerodynamic law.
    pub law: RotorLaw,
    /// Density of the air [kg/m³].
    pub density: f64,
    /// Source of its speed.
    pub drive: RotorDrive,
    /// Moment of inertia of the turning part about its axis, for its gyroscopic moment [kg·m²]; 0 for none.
    pub inertia: f64,
    /// True if the ground at z = 0 reduces the induced velocity; only of blade elements.
    pub ground_effect: bool,
}

/// Source of the speed of a rotor to be added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RotorDrive {
    /// Its command is the speed `[rad/s]`; of the stock propeller the velocity of the particles `[m/s]`.
    Command,
    /// The speed follows a command with a first-order lag: Ω' = (command − Ω)/τ.
    Lag {
        /// Time constant τ `[s]`, positive.
        time_constant: f64,
        /// Initial speed [rad/s].
        initial: f64,
    },
    /// Revolute joint that carries it, about the thrust axis: the rate of the joint is its speed, and the reaction of
    /// the air goes through the joint.
    Joint(NodeId),
}

/// Drag element on a body or frame, to be added by [`ModelBuilder::drag`]: quadratic and linear drag along its own
/// axes, at its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragSpec {
    /// Equivalent flat-plate area along x, y, z (drag coefficient times area) `[m²]`, not negative.
    pub area: [f64; 3],
    /// Linear drag coefficient along x, y, z `[N·s/m]`, not negative.
    pub linear: [f64; 3],
    /// Density of the air [kg/m³].
    pub density: f64,
}

pub(crate) enum NodeKind {
    World,
    Joint(Box<JointSpec>),
    Body(BodySpec),
    Frame,
    Force(Box<ForceSpec>),
    Rotor(Box<RotorSpec>),
    Drag(Box<DragSpec>),
}

/// Loop joint to be added by [`ModelBuilder::loop_joint`].
#[derive(Clone, Debug)]
pub struct LoopJointSpec {
    /// Kind of the loop joint.
    pub kind: LoopJointKind,
    /// The two bodies or frames joined; either may be the world.
    pub ends: [NodeId; 2],
    /// Frames of the joint in the two ends, in their order `[m]`: the kind tells which axes and origins are kept
    /// together.
    pub poses: [Pose<f64>; 2],
}

/// Path of a [`SpringDamperSpec`].
#[derive(Clone, Debug)]
pub enum PathSpec {
    /// Two points or more, in order: bodies or frames (the world too), and positions in their frames `[m]`. The path is
    /// the polyline through them, which slides through those between its ends without friction.
    Points(Vec<(NodeId, [f64; 3])>),
    /// Joints with one degree of freedom and lengths for each unit of their coordinates `[m/rad]`, or `[1]` of a
    /// prismatic joint: the length is their linear combination.
    Joints(Vec<(NodeId, f64)>),
}

/// Spring, damper and actuator between two points or along a tendon, to be added by [`ModelBuilder::spring_damper`].
#[derive(Clone, Debug)]
pub struct SpringDamperSpec {
    /// Path along which it acts.
    pub path: PathSpec,
    /// Length at which the deflection is zero `[m]`; `None`: the length with all coordinates zero.
    pub free_length: Option<f64>,
    /// Force `[N]` over deflection (length less free length) `[m]` and rate `[m/s]`; positive forces make the path
    /// longer.
    pub law: ForceLaw<f64>,
    /// True for a rope, which never pushes.
    pub tension_only: bool,
    /// Largest force of its actuator `[N]`, whose command is an input of the world; `None` for no actuator.
    pub actuator: Option<f64>,
    /// Activation of its actuator; `None`: the command acts at once.
    pub activation: Option<Activation<f64>>,
}

impl SpringDamperSpec {
    /// Checks the numbers: for each fault the name of the field, a message about the element, and a help; empty if
    /// there is none. `of` is the element as messages call it, with its name.
    #[must_use]
    pub fn problems(&self, of: &str) -> Vec<(&'static str, String, &'static str)> {
        let mut found = Vec::new();
        let not_negative = "give a finite number, zero or more";
        let numbers = [
            ("stiffness", Some(self.law.stiffness), "N/m"),
            ("damping", Some(self.law.damping), "N·s/m"),
            ("free_length", self.free_length, "m"),
        ];
        for (key, x, unit) in numbers {
            // a linear combination of coordinates may be negative
            let may_be_negative = key == "free_length" && matches!(self.path, PathSpec::Joints(_));
            if let Some(x) = x.filter(|x| !(x.is_finite() && (*x >= 0.0 || may_be_negative))) {
                let message = format!("{key} {x} {unit} of {of} is negative or not finite");
                found.push((key, message, not_negative));
            }
        }
        if !self.law.preload.is_finite() {
            let message = format!("preload {} N of {of} is not finite", self.law.preload);
            found.push(("preload", message, "give a number in N; a positive one makes the path longer"));
        } else if self.tension_only && self.law.preload > 0.0 {
            let message = format!("{of} pulls only, but its preload {} N pushes", self.law.preload);
            found.push(("preload", message, "leave `tension_only` out, or give a preload that pulls, below zero"));
        }
        if let Some(x) = self.actuator.filter(|x| x.is_nan() || *x < 0.0) {
            let message = format!("max_force {x} N of {of} is negative or not a number");
            found.push(("actuator", message, "give zero or more, or inf for none"));
        }
        match &self.path {
            PathSpec::Points(points) if points.len() < 2 => {
                let message = format!("{of} has no path: it goes through fewer than two points");
                found.push(("through", message, "give two bodies or frames, or more"));
            }
            PathSpec::Points(points) if !points.iter().flat_map(|(_, x)| x).all(|x| x.is_finite()) => {
                let points: Vec<_> = points.iter().map(|(_, x)| x).collect();
                let message = format!("points {points:?} of {of} are not finite");
                found.push(("points", message, "give three numbers in m each"));
            }
            PathSpec::Joints(joints) if !joints.iter().any(|(_, c)| *c != 0.0) => {
                found.push(("coefficients", format!("the length of {of} never changes"), "give one that is not zero"));
            }
            PathSpec::Joints(joints) if !joints.iter().all(|(_, c)| c.is_finite()) => {
                found.push(("coefficients", format!("a coefficient of {of} is not finite"), "give numbers in m/rad"));
            }
            _ => {}
        }
        found
    }
}

/// Gear (mimic) constraint of two joints with one degree of freedom each, q₂ = offset + ratio·q₁ + Σ cₖ q₁ᵏ; to be
/// added by [`ModelBuilder::gear`].
#[derive(Clone, Debug)]
pub struct GearSpec {
    /// The two joints, 1 and 2.
    pub joints: [NodeId; 2],
    /// Ratio of their rates, q̇₂ over q̇₁, in the units of the two joints.
    pub ratio: f64,
    /// Coordinate q₂ where q₁ = 0 `[rad]` or `[m]`.
    pub offset: f64,
    /// Coefficients c₂, c₃, c₄ of q₁², q₁³, q₁⁴; zero for a linear one, as all elastic gears are.
    pub higher: [f64; 3],
}

/// Elastic gear with backlash between two joints with one degree of freedom each; to be added by
/// [`ModelBuilder::elastic_gear`]. Units are those of a revolute second joint.
#[derive(Clone, Debug)]
pub struct ElasticGearSpec {
    /// Joints, ratio and offset, as of a rigid gear: q₂ = ratio·q₁ + offset in the middle of the gap.
    pub gear: GearSpec,
    /// Stiffness of the mesh, at the second joint `[N·m/rad]`.
    pub stiffness: f64,
    /// Damping of the mesh while the teeth touch `[N·m·s/rad]`.
    pub damping: f64,
    /// Backlash: free travel of the second joint while the first is held `[rad]`.
    pub backlash: f64,
}

/// Bushing between two frames, to be added by [`ModelBuilder::bushing`]; lists of six have x, y, z of the translation,
/// then of the rotation, along and about the axes of the first frame.
#[derive(Clone, Debug)]
pub struct BushingSpec {
    /// Bodies or frames (the world too) that carry its two frames.
    pub ends: [NodeId; 2],
    /// The two frames in these, in their order `[m]`: it is without force where they coincide.
    pub poses: [Pose<f64>; 2],
    /// Stiffnesses `[N/m]`, `[N·m/rad]`.
    pub stiffness: [f64; 6],
    /// Dampings `[N·s/m]`, `[N·m·s/rad]`.
    pub damping: [f64; 6],
}

impl BushingSpec {
    /// Checks the numbers: for each fault the name of the field, a message about the element, and a help; empty if
    /// there is none. `of` is the element as messages call it, with its name.
    #[must_use]
    pub fn problems(&self, of: &str) -> Vec<(&'static str, String, &'static str)> {
        let lists = [
            ("stiffness", &self.stiffness[..3], "N/m"),
            ("damping", &self.damping[..3], "N·s/m"),
            ("rotational_stiffness", &self.stiffness[3..], "N·m/rad"),
            ("rotational_damping", &self.damping[3..], "N·m·s/rad"),
        ];
        let mut found = Vec::new();
        for (key, list, unit) in lists {
            if let Some(x) = list.iter().find(|x| !(x.is_finite() && **x >= 0.0)) {
                let message = format!("{key} {x} {unit} of {of} is negative or not finite");
                found.push((key, message, "give finite numbers, zero or more"));
            }
        }
        found
    }
}

pub(crate) struct Node {
    pub(crate) name: String,
    pub(crate) parent: NodeId,
    pub(crate) pose: Pose<f64>,
    pub(crate) kind: NodeKind,
}

/// Builder of a [`Model`](super::Model): takes joints, bodies, frames and elements, parents before children, and checks
/// and compiles them in [`build`](ModelBuilder::build).
///
/// ```
/// use sincro_dynamics::joint::JointKind;
/// use sincro_dynamics::model::{BodySpec, JointSpec, ModelBuilder, NodeId, Shape};
/// use sincro_dynamics::spatial::{Pose, Vec3};
///
/// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// let rod = Shape::Cylinder { radius: 0.05, length: 0.5 }.mass_properties(1000.0);
/// builder.body("rod", hinge, Pose::translation(Vec3([0.0, 0.0, -0.25])), BodySpec { mass: rod });
/// let (model, warnings) = builder.build().unwrap();
/// assert_eq!((model.n_v(), warnings.len()), (1, 0));
/// ```
pub struct ModelBuilder {
    pub(crate) gravity: [f64; 3],
    pub(crate) gravity_field: Option<Arc<GravityField>>,
    pub(crate) air_density: Option<Arc<ScalarField>>,
    pub(crate) wind: Option<Arc<Wind>>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) colliders: Vec<(NodeId, Pose<f64>, Surface, Material)>,
    pub(crate) contact_pairs: Vec<([NodeId; 2], PairLaw)>,
    pub(crate) loop_joints: Vec<(String, LoopJointSpec)>,
    pub(crate) gears: Vec<(String, GearSpec)>,
    pub(crate) elastic_gears: Vec<(String, ElasticGearSpec)>,
    pub(crate) bushings: Vec<(String, BushingSpec)>,
    pub(crate) spring_dampers: Vec<(String, SpringDamperSpec)>,
    pub(crate) rest_speed: f64,
}

impl ModelBuilder {
    /// Empty builder with a gravitational acceleration `[m/s²]`, x, y, z in world axes.
    #[must_use]
    pub fn new(gravity: [f64; 3]) -> Self {
        let world = Node { name: "/".into(), parent: NodeId::WORLD, pose: Pose::identity(), kind: NodeKind::World };
        Self {
            gravity,
            gravity_field: None,
            air_density: None,
            wind: None,
            nodes: vec![world],
            colliders: Vec::new(),
            contact_pairs: Vec::new(),
            loop_joints: Vec::new(),
            gears: Vec::new(),
            elastic_gears: Vec::new(),
            bushings: Vec::new(),
            spring_dampers: Vec::new(),
            rest_speed: REST_SPEED,
        }
    }

    fn add(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, kind: NodeKind) -> NodeId {
        assert!((parent.0 as usize) < self.nodes.len(), "parents are added before children");
        self.nodes.push(Node { name: name.into(), parent, pose, kind });
        NodeId(u32::try_from(self.nodes.len() - 1).expect("fewer than 2^32 objects"))
    }

    /// Adds a joint whose frame stands at `pose` in its parent's `[m]`; whatever has it as its parent moves with it.
    /// `name` should be unique among the joints; the id returned is the parent for what hangs on the joint.
    pub fn joint(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, spec: JointSpec) -> NodeId {
        self.add(name, parent, pose, NodeKind::Joint(Box::new(spec)))
    }

    /// Adds a body whose frame stands at `pose` in its parent's `[m]`; returns the id, for colliders and children.
    pub fn body(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, spec: BodySpec) -> NodeId {
        self.add(name, parent, pose, NodeKind::Body(spec))
    }

    /// Adds a frame, a named point without mass, at `pose` in its parent's `[m]`; returns its id.
    pub fn frame(&mut self, name: &str, parent: NodeId, pose: Pose<f64>) -> NodeId {
        self.add(name, parent, pose, NodeKind::Frame)
    }

    /// Sets gravity that depends on the position, which adds to the uniform one.
    pub fn set_gravity_field(&mut self, field: GravityField) {
        self.gravity_field = Some(Arc::new(field));
    }

    /// Sets the density of the air over the position `[kg/m³]`, for all rotors and drag elements in the place of their
    /// own; to be called before [`ModelBuilder::build`].
    pub fn set_air_density(&mut self, density: ScalarField) {
        self.air_density = Some(Arc::new(density));
    }

    /// Sets the wind, which rotors and drag elements feel; without it the air rests.
    pub fn wind(&mut self, wind: Wind) {
        self.wind = Some(Arc::new(wind));
    }

    /// Adds a rotor whose hub frame stands at `pose` in its parent's `[m]`; thrust is along its z. Returns its id.
    pub fn rotor(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, spec: RotorSpec) -> NodeId {
        self.add(name, parent, pose, NodeKind::Rotor(Box::new(spec)))
    }

    /// Adds a drag element whose axes and centre of pressure stand at `pose` in its parent's frame `[m]`; returns its
    /// id.
    pub fn drag(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, spec: DragSpec) -> NodeId {
        self.add(name, parent, pose, NodeKind::Drag(Box::new(spec)))
    }

    /// Adds an external force and torque that act at the origin of `parent`; returns its id.
    ///
    /// ```
    /// use sincro_dynamics::model::ForceSpec;
    /// use sincro_dynamics::prelude::*;
    /// use sincro_dynamics::signal::Signal;
    ///
    /// # let mut builder = ModelBuilder::new([0.0; 3]);
    /// # let slide = JointSpec::new(JointKind::Prismatic { axis: [1.0, 0.0, 0.0] });
    /// # let slide = builder.joint("slide", NodeId::WORLD, Pose::identity(), slide);
    /// # let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [0.01, 0.0, 0.0, 0.01, 0.0, 0.01] };
    /// let cart = builder.body("cart", slide, Pose::identity(), BodySpec { mass }); // 2 kg, on a slide along x
    /// let [x, y, z] = [3.0, 0.0, 0.0].map(Signal::Constant); // [N]
    /// let none = [0.0; 3].map(Signal::Constant);
    /// builder.force("pull", cart, ForceSpec { force: [x, y, z], torque: none, in_body: false, is_input: false });
    /// let mut world = World::builder(builder.build()?.0).build()?;
    /// for _ in 0..1000 {
    ///     world.step()?;
    /// }
    /// assert!((world.state.v[0] - 3.0 / 2.0 * world.time()).abs() < 1e-9); // v = F t/m
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn force(&mut self, name: &str, parent: NodeId, spec: ForceSpec) -> NodeId {
        self.add(name, parent, Pose::identity(), NodeKind::Force(Box::new(spec)))
    }

    /// Adds a collider: a surface that can touch others, at `pose` `[m]` in the frame of the body or frame `on`.
    ///
    /// ```
    /// use sincro_dynamics::prelude::*;
    ///
    /// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    /// builder.collider(NodeId::WORLD, Pose::identity(), Surface::HalfSpace, Material::default()); // the floor
    /// let start = Pose::translation(Vec3([0.0, 0.0, 0.1]));
    /// let base = builder.joint("base", NodeId::WORLD, start, JointSpec::new(JointKind::Free));
    /// let shape = Shape::Sphere { radius: 0.1 };
    /// let mass = shape.mass_properties(1000.0);
    /// let ball = builder.body("ball", base, Pose::identity(), BodySpec { mass });
    /// builder.collider(ball, Pose::identity(), Surface::Solid(shape), Material::default());
    /// let mut world = World::builder(builder.build()?.0).build()?;
    /// world.step()?;
    /// let t = world.time();
    /// let force: f64 = world.observe(t).contacts().map(|contact| contact.force[2].abs()).sum();
    /// assert!((force - mass.mass * 9.81).abs() < 1e-6); // the floor carries the weight [N]
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn collider(&mut self, on: NodeId, pose: Pose<f64>, surface: Surface, material: Material) {
        self.colliders.push((on, pose, surface, material));
    }

    /// Sets a contact law for the colliders of two bodies, in place of the combination of their materials; the last law
    /// set for two bodies counts.
    pub fn contact_pair(&mut self, bodies: [NodeId; 2], law: PairLaw) {
        self.contact_pairs.push((bodies, law));
    }

    /// Adds a loop joint named `name` between two frames; its constraint closes a loop of the tree.
    ///
    /// ```
    /// use sincro_dynamics::model::{LoopJointKind, LoopJointSpec};
    /// use sincro_dynamics::prelude::*;
    ///
    /// // a ball on a string of 2 m instead of a joint: it keeps its distance from the ceiling
    /// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    /// let start = Pose::translation(Vec3([2.0, 0.0, 0.0]));
    /// let joint = builder.joint("joint", NodeId::WORLD, start, JointSpec::new(JointKind::Free));
    /// let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
    /// let ball = builder.body("ball", joint, Pose::identity(), BodySpec { mass });
    /// let (kind, poses) = (LoopJointKind::Distance(2.0), [Pose::identity(); 2]);
    /// builder.loop_joint("string", LoopJointSpec { kind, ends: [NodeId::WORLD, ball], poses });
    /// let (model, _warnings) = builder.build()?;
    /// let joint = model.names().joint_id("joint").unwrap();
    /// let mut world = World::builder(model).build()?;
    /// for _ in 0..500 {
    ///     world.step()?;
    /// }
    /// let [x, _, z] = [0, 1, 2].map(|k| world.coordinates(joint)[k]); // from where it started [m]
    /// assert!(z < -0.5 && (f64::hypot(2.0 + x, z) - 2.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn loop_joint(&mut self, name: &str, spec: LoopJointSpec) {
        self.loop_joints.push((name.into(), spec));
    }

    /// Adds a gear (mimic) constraint named `name` between two joints with one degree of freedom each.
    ///
    /// ```
    /// use sincro_dynamics::model::GearSpec;
    /// use sincro_dynamics::prelude::*;
    ///
    /// // the second wheel turns three times as fast as the first, the other way
    /// let mut builder = ModelBuilder::new([0.0; 3]);
    /// let mass = Shape::Cylinder { radius: 0.1, length: 0.02 }.mass_properties(2700.0);
    /// let joints = ["first", "second"].map(|name| {
    ///     let joint = JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
    ///     let joint = builder.joint(name, NodeId::WORLD, Pose::identity(), joint);
    ///     builder.body(&format!("{name} wheel"), joint, Pose::identity(), BodySpec { mass });
    ///     joint
    /// });
    /// builder.gear("gear", GearSpec { joints, ratio: -3.0, offset: 0.0, higher: [0.0; 3] });
    /// let (model, _warnings) = builder.build()?;
    /// let [first, second] = ["first", "second"].map(|name| model.names().joint_id(name).unwrap());
    /// let mut world = World::builder(model).velocities(first, &[1.0]).velocities(second, &[-3.0]).build()?;
    /// for _ in 0..100 {
    ///     world.step()?;
    /// }
    /// assert!((world.coordinates(second)[0] + 3.0 * world.coordinates(first)[0]).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn gear(&mut self, name: &str, spec: GearSpec) {
        self.gears.push((name.into(), spec));
    }

    /// Adds an elastic gear with backlash; see [`ElasticGear`](crate::actuation::ElasticGear).
    pub fn elastic_gear(&mut self, name: &str, spec: ElasticGearSpec) {
        self.elastic_gears.push((name.into(), spec));
    }

    /// Adds a bushing; see [`Bushing`](crate::actuation::Bushing).
    pub fn bushing(&mut self, name: &str, spec: BushingSpec) {
        self.bushings.push((name.into(), spec));
    }

    /// Adds a spring, damper and actuator between two points, or a tendon; see
    /// [`SpringDamper`](crate::actuation::SpringDamper).
    pub fn spring_damper(&mut self, name: &str, spec: SpringDamperSpec) {
        self.spring_dampers.push((name.into(), spec));
    }

    /// Sets the rest speed `[m/s]`, by default [`REST_SPEED`]: contacts that approach more slowly have no restitution.
    pub fn set_rest_speed(&mut self, speed: f64) {
        self.rest_speed = speed;
    }
}
