//! The builder: the tree as the user names it.

use std::sync::Arc;

use super::LoopJointKind;
use super::MassProperties;
use crate::actuation::{ForceLaw, Motor, NonlinearLaw};
use crate::aero::rotor::RotorLaw;
use crate::aero::wind::Wind;
use crate::contact::{Material, PairLaw, Surface};
use crate::joint::{Friction, JointKind};
use crate::signal::Signal;
use crate::spatial::Pose;

/// Default rest speed [m/s]: slower approach has no restitution; a bounce from here is 5e-8 m high under gravity.
/// Without it a ball would bounce infinitely often in finite time (Zeno behaviour).
pub const REST_SPEED: f64 = 1e-3;

/// One object of the tree under construction; [`NodeId::WORLD`] is its root.
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
    /// The world: fixed, carries everything.
    pub const WORLD: Self = Self(0);
}

/// A joint to be added. Lists have one entry a degree of freedom, or are empty for "none". Those of a ball joint are
/// about the axes of its child frame; those of a free joint these three, then along the same axes.
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
    /// Reflected inertia [kg·m²] or `[kg]`.
    pub armature: Vec<f64>,
    /// Spring stiffness [N·m/rad] or [N/m] and rest position `[rad]` or `[m]`. Of ball and free joints: stiffness and
    /// components of the rotation vector of the rest orientation, then, of free ones, along the axes of the joint frame
    /// (see [`crate::actuation::spring`]).
    pub spring: Vec<(f64, f64)>,
    /// Nonlinear laws of the springs and dampers, of the deflection from the rest position, added to the linear ones;
    /// not of ball and free joints.
    pub spring_law: Vec<Option<Arc<NonlinearLaw>>>,
    /// Viscous coefficient [N·m·s/rad] or [N·s/m].
    pub damping: Vec<f64>,
    /// Friction [N·m] or `[N]`.
    pub friction: Vec<Friction<f64>>,
    /// Applied torque [N·m] or force `[N]` over time, evaluated inside the step.
    pub torque: Vec<Signal>,
    /// True for a fixed joint through which the wrench is measured: it is then a link of its own, whose six degrees of
    /// freedom are locked.
    pub sensor: bool,
    /// Lower and upper limit of each coordinate, infinite for none `[rad]` or `[m]`.
    pub limits: Vec<(f64, f64)>,
    /// Restitution of the limits: speed after over speed before, 0 to 1.
    pub limit_restitution: f64,
    /// Motor, for a joint with one degree of freedom; its command is an input of the world.
    pub motor: Option<Motor<f64>>,
}

impl JointSpec {
    /// A joint of that kind without anything on it.
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
            motor: None,
        }
    }
}

/// A body to be added.
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
    /// Mass, centre of mass, inertia, in the body's frame.
    pub mass: MassProperties,
}

/// An external wrench on a body or frame, at its origin.
#[derive(Clone, Debug)]
pub struct ForceSpec {
    /// Force components `[N]` over time.
    pub force: [Signal; 3],
    /// Torque components [N·m] over time.
    pub torque: [Signal; 3],
    /// True if the components turn with the body; else they are along the world's axes.
    pub in_body: bool,
    /// True if six commands (force, then torque) are added to it.
    pub is_input: bool,
}

/// A rotor on a body or frame; the thrust axis is z of its own frame.
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
    /// Reduction of the induced velocity by the ground at z = 0; of blade elements only.
    pub ground_effect: bool,
}

/// Source of a rotor's speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RotorDrive {
    /// A command is its speed [rad/s].
    Command,
    /// The speed follows a command with a first-order lag: Ω' = (command − Ω)/τ.
    Lag {
        /// τ `[s]`, positive.
        time_constant: f64,
        /// Initial speed [rad/s].
        initial: f64,
    },
    /// It turns with a revolute joint that carries it, about that joint's axis: the rate of the joint is its speed, and
    /// the reaction of the air goes through the joint.
    Joint(NodeId),
}

/// A drag element on a body or frame, at its own origin, along its own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragSpec {
    /// Drag coefficient by area along each axis `[m²]`.
    pub area: [f64; 3],
    /// Linear coefficient along each axis [N·s/m].
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

/// Loop joint to be added.
#[derive(Clone, Debug)]
pub struct LoopJointSpec {
    /// Kind of the loop joint.
    pub kind: LoopJointKind,
    /// The two bodies or frames joined; either may be the world.
    pub ends: [NodeId; 2],
    /// Frames in them that the joint keeps together.
    pub poses: [Pose<f64>; 2],
}

/// Spring, damper and actuator between two points to be added.
#[derive(Clone, Debug)]
pub struct SpringDamperSpec {
    /// The two bodies or frames that carry the points; either may be the world.
    pub ends: [NodeId; 2],
    /// The points in their frames `[m]`.
    pub points: [[f64; 3]; 2],
    /// Length at which the deflection is zero `[m]`; none: the distance of the points with all coordinates zero.
    pub free_length: Option<f64>,
    /// Force `[N]` over deflection `[m]` and rate [m/s]; positive forces push the points apart.
    pub law: ForceLaw<f64>,
    /// True for a rope, which never pushes.
    pub tension_only: bool,
    /// Largest force of its actuator `[N]`, whose command is an input of the world; none: it has no actuator.
    pub actuator: Option<f64>,
}

impl SpringDamperSpec {
    /// Problems of the numbers: key of the number, message about the element `name`, help.
    #[must_use]
    pub fn problems(&self, name: &str) -> Vec<(&'static str, String, &'static str)> {
        let mut found = Vec::new();
        let not_negative = "give a finite number, zero or more";
        let numbers = [
            ("stiffness", Some(self.law.stiffness), "N/m"),
            ("damping", Some(self.law.damping), "N·s/m"),
            ("free_length", self.free_length, "m"),
        ];
        for (key, x, unit) in numbers {
            if let Some(x) = x.filter(|x| !(x.is_finite() && *x >= 0.0)) {
                let message = format!("{key} {x} {unit} of spring_damper `{name}` is negative or not finite");
                found.push((key, message, not_negative));
            }
        }
        if !self.law.preload.is_finite() {
            let message = format!("preload {} N of spring_damper `{name}` is not finite", self.law.preload);
            found.push(("preload", message, "give a number in N; a positive one pushes the points apart"));
        } else if self.tension_only && self.law.preload > 0.0 {
            let message = format!("spring_damper `{name}` pulls only, but its preload {} N pushes", self.law.preload);
            found.push(("preload", message, "leave `tension_only` out, or give a preload that pulls, below zero"));
        }
        if let Some(x) = self.actuator.filter(|x| x.is_nan() || *x < 0.0) {
            let message = format!("max_force {x} N of spring_damper `{name}` is negative or not a number");
            found.push(("actuator", message, "give zero or more, or inf for none"));
        }
        if !self.points.iter().flatten().all(|x| x.is_finite()) {
            let message = format!("points {:?} of spring_damper `{name}` are not finite", self.points);
            found.push(("points", message, "give two points, three numbers in m each"));
        }
        found
    }
}

/// Gear (mimic) constraint of two joints with one degree of freedom each: q₂ = ratio·q₁ + offset.
#[derive(Clone, Debug)]
pub struct GearSpec {
    /// The joints.
    pub joints: [NodeId; 2],
    /// Ratio of their rates.
    pub ratio: f64,
    /// `[rad]` or `[m]`.
    pub offset: f64,
}

pub(crate) struct Node {
    pub(crate) name: String,
    pub(crate) parent: NodeId,
    pub(crate) pose: Pose<f64>,
    pub(crate) kind: NodeKind,
}

/// Collects the objects of a model, parents before children.
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
    pub(crate) wind: Option<Arc<Wind>>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) colliders: Vec<(NodeId, Pose<f64>, Surface, Material)>,
    pub(crate) contact_pairs: Vec<([NodeId; 2], PairLaw)>,
    pub(crate) loop_joints: Vec<(String, LoopJointSpec)>,
    pub(crate) gears: Vec<(String, GearSpec)>,
    pub(crate) spring_dampers: Vec<(String, SpringDamperSpec)>,
    pub(crate) rest_speed: f64,
}

impl ModelBuilder {
    /// An empty world with a gravitational acceleration [m/s²].
    #[must_use]
    pub fn new(gravity: [f64; 3]) -> Self {
        let world = Node { name: "/".into(), parent: NodeId::WORLD, pose: Pose::identity(), kind: NodeKind::World };
        Self {
            gravity,
            wind: None,
            nodes: vec![world],
            colliders: Vec::new(),
            contact_pairs: Vec::new(),
            loop_joints: Vec::new(),
            gears: Vec::new(),
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
    pub fn joint(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, spec: JointSpec) -> NodeId {
        self.add(name, parent, pose, NodeKind::Joint(Box::new(spec)))
    }

    /// Adds a body whose frame stands at `pose` in its parent's `[m]`.
    pub fn body(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, spec: BodySpec) -> NodeId {
        self.add(name, parent, pose, NodeKind::Body(spec))
    }

    /// Adds a frame, a named point without mass, at `pose` in its parent's `[m]`.
    pub fn frame(&mut self, name: &str, parent: NodeId, pose: Pose<f64>) -> NodeId {
        self.add(name, parent, pose, NodeKind::Frame)
    }

    /// Sets the wind, which rotors and drag elements feel.
    pub fn wind(&mut self, wind: Wind) {
        self.wind = Some(Arc::new(wind));
    }

    /// Adds a rotor whose hub frame stands at `pose` in its parent's `[m]`.
    pub fn rotor(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, spec: RotorSpec) -> NodeId {
        self.add(name, parent, pose, NodeKind::Rotor(Box::new(spec)))
    }

    /// Adds a drag element whose axes and centre of pressure stand at `pose` in its parent's frame `[m]`.
    pub fn drag(&mut self, name: &str, parent: NodeId, pose: Pose<f64>, spec: DragSpec) -> NodeId {
        self.add(name, parent, pose, NodeKind::Drag(Box::new(spec)))
    }

    /// Adds an external wrench that acts at the origin of `parent`.
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

    /// Adds a surface that can touch others, at `pose` `[m]` in the frame of a body or frame.
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

    /// Gives the surfaces of two bodies a contact law of their own; the last one given to two bodies counts.
    pub fn contact_pair(&mut self, bodies: [NodeId; 2], law: PairLaw) {
        self.contact_pairs.push((bodies, law));
    }

    /// Adds a loop joint between two frames; its constraint closes a loop of the tree.
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

    /// Adds a gear (mimic) constraint between two joints.
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
    /// builder.gear("gear", GearSpec { joints, ratio: -3.0, offset: 0.0 });
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

    /// Adds a spring, damper and actuator between two points.
    pub fn spring_damper(&mut self, name: &str, spec: SpringDamperSpec) {
        self.spring_dampers.push((name.into(), spec));
    }

    /// Sets the rest speed [m/s]: slower approach has no restitution.
    pub fn set_rest_speed(&mut self, speed: f64) {
        self.rest_speed = speed;
    }
}
