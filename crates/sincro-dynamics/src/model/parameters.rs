//! Parameters of a compiled model: the numbers that may change between two steps. The structure never changes.

use std::sync::Arc;

use sincro_math::Real;

use super::{ConstraintSet, MassProperties, Model, Names};
use crate::actuation::{Drive, Motor, MotorMode};
use crate::ids::{BodyId, MotorId};
use crate::spatial::{Pose, RigidInertia, Sym3, Vec3};

/// Numbers of a pair of surfaces in [`ModelParams::to_numbers`].
const PAIR_LEN: usize = 7;
/// Numbers of a motor: its mode, then [`Motor::numbers`].
const MOTOR_LEN: usize = 6;
/// Numbers of a body: mass, centre of mass, inertia.
const MASS_LEN: usize = 10;

/// Modes of motors, in the order of their numbers in [`ModelParams::to_numbers`].
const MODES: [MotorMode; 6] = [
    MotorMode::Free,
    MotorMode::Torque,
    MotorMode::Velocity,
    MotorMode::Position,
    MotorMode::Spring,
    MotorMode::Voltage,
];

/// Parameters of a model: gravity, masses, motors, bounds of joint limits, gears, contact laws of pairs. A value of its
/// own, which a snapshot holds beside the state; [`World`](crate::world::World) sets them one by one.
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let slide = JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] });
/// # let slide = builder.joint("slide", NodeId::WORLD, Pose::identity(), slide);
/// # let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// # builder.body("ball", slide, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// let mut world = World::builder(model).build()?;
/// let on_earth = world.model().params().clone();
/// world.set_gravity(Vec3([0.0, 0.0, -1.62]));
/// assert_eq!(world.model().gravity()[2], -1.62); // [m/s²]
/// world.set_params(&on_earth);
/// assert_eq!(world.model().gravity()[2], -9.81);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ModelParams<R> {
    /// Gravitational acceleration [m/s²], world axes.
    pub(crate) gravity: Vec3<R>,
    /// Inertia of each link with everything merged into it, about the link's origin, link axes; follows from `masses`.
    pub(crate) inertias: Vec<RigidInertia<R>>,
    /// Mass properties in its own frame of each body or frame, none for frames.
    pub(crate) masses: Vec<Option<MassProperties>>,
    pub(crate) motors: Vec<Motor<R>>,
    /// Drives; those of motors follow from `motors`.
    pub(crate) drives: Vec<Drive>,
    /// Loop joints, gears, joint limits and pairs of surfaces: shared between copies until a number of one changes.
    pub(crate) constraints: Arc<ConstraintSet>,
}

impl<R: PartialEq> PartialEq for ModelParams<R> {
    fn eq(&self, other: &Self) -> bool {
        let Self { gravity, inertias, masses, motors, drives, constraints } = self;
        // constraints may be many, and are mostly shared
        *gravity == other.gravity
            && *inertias == other.inertias
            && *masses == other.masses
            && *motors == other.motors
            && *drives == other.drives
            && (Arc::ptr_eq(constraints, &other.constraints) || *constraints == other.constraints)
    }
}

impl<R: Real> ModelParams<R> {
    /// Without links, bodies, motors and constraints.
    pub(crate) fn new(gravity: Vec3<R>) -> Self {
        Self {
            gravity,
            inertias: Vec::new(),
            masses: Vec::new(),
            motors: Vec::new(),
            drives: Vec::new(),
            constraints: Arc::default(),
        }
    }

    /// These parameters with the motors of others of the same structure.
    #[must_use]
    pub fn with_motors_of(&self, other: &Self) -> Self {
        Self { motors: other.motors.clone(), drives: other.drives.clone(), ..self.clone() }
    }

    /// Returns true if others are of the same structure, as far as their numbers tell.
    pub(crate) fn fits(&self, other: &Self) -> bool {
        let lengths = |p: &Self| {
            let set = &p.constraints;
            [p.inertias.len(), p.masses.len(), p.motors.len(), set.limits.len(), set.gears.len(), set.pairs.len()]
        };
        lengths(self) == lengths(other)
    }
}

impl ModelParams<f64> {
    /// All parameters as one list, in SI units: gravity (3), for each body mass, centre of mass and inertia (10), for
    /// each motor its mode and its numbers (6), each limit, ratio and offset of each gear, for each pair of surfaces
    /// 1 if it is ignored and six coefficients (7).
    #[must_use]
    pub fn to_numbers(&self) -> Vec<f64> {
        let mut all = self.gravity.0.to_vec();
        for mass in self.masses.iter().flatten() {
            all.push(mass.mass);
            all.extend(mass.center_of_mass.iter().chain(&mass.inertia));
        }
        for motor in &self.motors {
            all.push(MODES.iter().position(|mode| *mode == motor.mode).unwrap_or(0) as f64);
            all.extend(motor.numbers().map(|(_, number)| number));
        }
        all.extend(self.constraints.limits.iter().map(|limit| limit.bound));
        all.extend(self.constraints.gears.iter().flat_map(|gear| [gear.ratio, gear.offset]));
        for pair in &self.constraints.pairs {
            all.push(f64::from(u8::from(pair.is_ignored)));
            all.extend(pair.material.coefficients());
        }
        all
    }

    /// Number of entries of [`ModelParams::to_numbers`].
    fn n_numbers(&self) -> usize {
        let set = &self.constraints;
        let n_bodies = self.masses.iter().flatten().count();
        3 + MASS_LEN * n_bodies
            + MOTOR_LEN * self.motors.len()
            + set.limits.len()
            + 2 * set.gears.len()
            + PAIR_LEN * set.pairs.len()
    }
}

/// Inertia of a body that stands at `pose` in its link, about the link's origin.
pub(crate) fn carried(pose: &Pose<f64>, mass: &MassProperties) -> RigidInertia<f64> {
    let placed = mass.placed(&pose.rot, pose.pos);
    RigidInertia::from_center_of_mass(placed.mass, Vec3(placed.center_of_mass), &Sym3(placed.inertia))
}

/// Inertia of a link: the sum over its bodies, in the order in which they were added.
pub(crate) fn link_inertia(names: &Names, masses: &[Option<MassProperties>], link: usize) -> RigidInertia<f64> {
    let bodies = names.frames.iter().zip(masses).filter(|(frame, _)| frame.link == Some(link));
    bodies.fold(RigidInertia::zero(), |sum, (frame, mass)| match mass {
        Some(mass) => sum.plus(&carried(&frame.pose, mass)),
        None => sum,
    })
}

impl Model<f64> {
    /// Sets the mass properties of a body. Gives the same bits as a model built with them.
    pub(crate) fn set_mass_properties(&mut self, body: BodyId, mass: MassProperties) {
        self.params.masses[body.index()] = Some(mass);
        if let Some(link) = self.names.frames[body.index()].link {
            self.params.inertias[link] = link_inertia(&self.names, &self.params.masses, link);
        }
    }

    /// Parameters of this structure from a list of [`ModelParams::to_numbers`]; none if the list is of another
    /// structure.
    #[must_use]
    pub fn params_from_numbers(&self, numbers: &[f64]) -> Option<ModelParams<f64>> {
        if numbers.len() != self.params.n_numbers() {
            return None;
        }
        let mut model = self.clone();
        let mut rest = numbers.iter().copied();
        let mut next = || rest.next().unwrap_or(0.0);
        model.params.gravity = Vec3(std::array::from_fn(|_| next()));
        for mass in model.params.masses.iter_mut().flatten() {
            let (whole, center) = (next(), std::array::from_fn(|_| next()));
            *mass = MassProperties { mass: whole, center_of_mass: center, inertia: std::array::from_fn(|_| next()) };
        }
        for link in 0..model.links.len() {
            model.params.inertias[link] = link_inertia(&model.names, &model.params.masses, link);
        }
        for k in 0..model.params.motors.len() {
            let motor = Motor {
                dof: model.params.motors[k].dof,
                mode: *MODES.get(next() as usize)?,
                max_torque: next(),
                kp: next(),
                max_velocity: next(),
                stiffness: next(),
                damping: next(),
            };
            model.set_motor(MotorId::new(k), motor);
        }
        let set = Arc::make_mut(&mut model.params.constraints);
        set.limits.iter_mut().for_each(|limit| limit.bound = next());
        set.gears.iter_mut().for_each(|gear| (gear.ratio, gear.offset) = (next(), next()));
        for pair in &mut set.pairs {
            pair.is_ignored = next() != 0.0;
            pair.material = pair.material.with_coefficients(std::array::from_fn(|_| next()));
        }
        Some(model.params)
    }
}

impl<R: Real> Model<R> {
    /// Mass properties of a body in its own frame; none of a frame without mass.
    ///
    /// # Panics
    ///
    /// If the model has no such body or frame.
    #[must_use]
    pub fn mass_properties(&self, body: BodyId) -> Option<&MassProperties> {
        self.params.masses[body.index()].as_ref()
    }

    /// Replaces a motor, the degree of freedom kept; the list of drives follows.
    pub(crate) fn set_motor(&mut self, id: MotorId, motor: Motor<R>) {
        let was_drive = self.motor(id).is_drive();
        self.params.motors[id.index()] = Motor { dof: self.motor(id).dof, ..motor };
        if was_drive != motor.is_drive() {
            self.params.drives = self.find_drives();
        }
    }
}
