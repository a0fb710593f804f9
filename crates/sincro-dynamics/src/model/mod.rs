//! The model: a kinematic tree compiled to a flat list of links, with its force elements and constraints.
//!
//! [`ModelBuilder`] takes the tree as the user names it; [`ModelBuilder::build`] checks everything, reports all
//! diagnostics at once and compiles: fixed joints and bodies fixed to bodies are merged into *links*, universal and
//! planar joints become chains of one-degree-of-freedom stages, and every link frame is chosen parallel to its parent's
//! (at q = 0) with the joint's axis on a coordinate axis wherever the geometry allows, because that is cheapest in the
//! recursions. [`Names`] maps the user's objects to links and coordinates.
//!
//! A model is its [`Structure`], which never changes and is shared by all its copies, and its [`ModelParams`]: masses,
//! gravity, joint limits, gears, contact laws and motors, which may be set between two steps of a
//! [`World`](crate::world::World) and are part of a snapshot.

mod activations;
pub(crate) mod builder;
mod constraints;
pub(crate) mod diagnostic;
mod drives;
pub(crate) mod names;
mod pack;
pub(crate) mod parameters;
mod structure;

use std::ops::Deref;
use std::sync::Arc;

use sincro_complementarity::sweeps::rest::Trees;
use sincro_math::Real;

pub use crate::geometry::{MassProperties, Shape};
pub use crate::ids::{BodyId, JointId, MotorId, RotorId};
pub use crate::joint::{Dof, Link};
pub use builder::{
    BodySpec, BushingSpec, DragSpec, ElasticGearSpec, ForceSpec, GearSpec, JointSpec, LoopJointSpec, ModelBuilder,
    NodeId, PathSpec, REST_SPEED, RotorDrive, RotorSpec, SpringDamperSpec,
};
pub use constraints::{Anchor, ConstraintSet, GearConstraint, Limit, LoopJoint, LoopJointKind};
pub use diagnostic::{BuildError, Diagnostic, Severity};
pub use names::{Attached, FrameInfo, JointInfo, Names, SensorInfo};
pub use pack::PackError;
pub use parameters::ModelParams;
pub use sincro_complementarity::SLOT_LEN;
pub use structure::Structure;

use crate::actuation::Drive;
use crate::actuation::damper;
use crate::actuation::spring::{self, NonlinearSpring};
use crate::actuation::{
    AppliedTorque, AppliedWrench, Bushing, ElasticGear, GravityField, Motor, MotorMode, SpringDamper, Winding,
};
use crate::aero::AirDrag;
use crate::aero::rotor::MountedRotor;
use crate::aero::wind::Wind;
use crate::joint::{StageKind, WORLD};
use crate::spatial::{Pose, Vec3};

/// Compiled model: the kinematic tree and its elements, immutable but for parameters. Made by [`ModelBuilder::build`].
/// Numbers are of type `R`: those of one world, or of several worlds packed into lanes ([`Model::pack`]).
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// let base = builder.joint("base", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
/// let ball = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// builder.body("ball", base, Pose::identity(), BodySpec { mass: ball });
/// let (model, _warnings) = builder.build()?;
/// assert_eq!((model.n_q(), model.n_v()), (7, 6)); // position and quaternion; angular and linear velocity
/// assert_eq!(model.total_mass(), ball.mass); // [kg]
/// # Ok::<(), BuildError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Model<R> {
    structure: Arc<Structure<R>>,
    pub(crate) params: ModelParams<R>,
}

/// The fields of the structure, read as those of the model.
impl<R> Deref for Model<R> {
    type Target = Structure<R>;

    #[inline(always)]
    fn deref(&self) -> &Structure<R> {
        &self.structure
    }
}

impl Model<f64> {
    /// Largest gravitational acceleration on a body `[m/s²]`, with links at `poses` `[m]`.
    pub(crate) fn strongest_gravity(&self, poses: &[Pose<f64>]) -> f64 {
        let uniform = self.params.gravity.norm();
        let Some(field) = &self.gravity_field else { return uniform };
        let at = |(_, link, center): (f64, usize, Vec3<f64>)| field.acceleration(poses[link].point(center)).norm();
        uniform + self.centers_of_mass().map(at).fold(0.0, f64::max)
    }
}

impl<R: Real> Model<R> {
    pub(crate) fn new(structure: Structure<R>, params: ModelParams<R>) -> Self {
        Self { structure: Arc::new(structure), params }
    }

    /// Parameters, as they now are.
    #[must_use]
    pub fn params(&self) -> &ModelParams<R> {
        &self.params
    }

    /// Returns true if `other` is a copy of this model with the same parameters.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.structure, &other.structure) && self.params == other.params
    }

    /// Replaces the parameters by those of a model of the same structure.
    ///
    /// # Panics
    ///
    /// If they are of another structure: numbers of links, motors, limits, gears or pairs differ.
    pub fn set_params(&mut self, params: &ModelParams<R>) {
        assert!(self.params.fits(params), "parameters of a model of another structure");
        // mostly the same: a run that goes back and changes nothing
        if self.params != *params {
            self.params.clone_from(params);
        }
    }

    /// The structure, to be changed while the model is made.
    pub(crate) fn structure_mut(&mut self) -> &mut Structure<R> {
        Arc::make_mut(&mut self.structure)
    }

    /// Number of coordinates, the length of q; a quaternion has four.
    #[must_use]
    pub fn n_q(&self) -> usize {
        self.n_q
    }

    /// Number of degrees of freedom, the length of v.
    #[must_use]
    pub fn n_v(&self) -> usize {
        self.dofs.len()
    }

    /// Moving links, parents before children; other indices of links count them.
    #[must_use]
    pub fn links(&self) -> &[Link<R>] {
        &self.links
    }

    /// First link of the tree that each link belongs to.
    pub(crate) fn trees(&self) -> Vec<u32> {
        let mut tree = vec![0; self.links.len()];
        for (i, link) in self.links.iter().enumerate() {
            tree[i] = if link.parent == WORLD { i as u32 } else { tree[link.parent as usize] };
        }
        tree
    }

    /// Trees of links, degrees of freedom and coordinates.
    pub(crate) fn all_trees(&self) -> Trees {
        let of_link = self.trees();
        let (mut of_dof, mut of_coordinate) = (vec![WORLD; self.n_v()], vec![WORLD; self.n_q()]);
        for (link, tree) in self.links.iter().zip(&of_link) {
            let (q, v) = (link.q_idx as usize, link.v_idx as usize);
            of_coordinate[q..q + link.kind.n_q()].fill(*tree);
            of_dof[v..v + link.kind.n_v()].fill(*tree);
        }
        Trees { of_link, of_dof, of_coordinate }
    }

    /// Link that each degree of freedom moves.
    pub(crate) fn links_of_dofs(&self) -> Vec<u32> {
        let mut of_dof = vec![WORLD; self.n_v()];
        for (i, link) in self.links.iter().enumerate() {
            let k = link.v_idx as usize;
            of_dof[k..k + link.kind.n_v()].fill(i as u32);
        }
        of_dof
    }

    /// Passive properties of each degree of freedom (n_v), in the order of v.
    #[must_use]
    pub fn dofs(&self) -> &[Dof<R>] {
        &self.dofs
    }

    /// Motors, in the order of their ids and commands.
    #[must_use]
    pub fn motors(&self) -> &[Motor<R>] {
        &self.params.motors
    }

    /// Number of commands: one for each motor, in the unit of its mode; then six (force `[N]`, torque `[N·m]`) for each
    /// external force that takes them; then one for each rotor that does not turn with a joint, its speed `[rad/s]`;
    /// then one for each spring and damper with an actuator, its force `[N]`.
    #[must_use]
    pub fn n_commands(&self) -> usize {
        let of_lines = self.spring_dampers.iter().filter(|s| s.actuator.is_some()).count();
        self.n_commands_before_lines(self.names.inputs.len()) + of_lines
    }

    /// Number of commands before those of springs and dampers between two points, for so many external forces that take
    /// commands.
    pub(crate) fn n_commands_before_lines(&self, n_inputs: usize) -> usize {
        let of_rotors = self.rotors.iter().filter(|r| r.speed.command().is_some()).count();
        self.params.motors.len() + 6 * n_inputs + of_rotors
    }

    /// Number of states of elements, the length of [`crate::state::State::rotors`]: one for each rotor with a lag and
    /// each stock propeller, then one for each winding with inductance, then one for each activation.
    #[must_use]
    pub fn n_rotor_states(&self) -> usize {
        self.rotors.iter().filter(|r| r.speed.state().is_some()).count()
            + self.windings.iter().filter(|w| w.state.is_some()).count()
            + self.activations.len()
    }

    /// Windings of direct-current motors, in the order of their motors.
    #[must_use]
    pub fn windings(&self) -> &[Winding<R>] {
        &self.windings
    }

    /// Windings whose motors are in mode [`MotorMode::Voltage`]; the others carry no current.
    #[inline(always)]
    pub(crate) fn active_windings(&self) -> impl Iterator<Item = &Winding<R>> {
        self.windings.iter().filter(|w| self.params.motors[w.motor].mode == MotorMode::Voltage)
    }

    /// Energy of the magnetic fields of all windings `[J]` for the states of elements
    /// ([`crate::state::State::rotors`]).
    #[must_use]
    #[inline(always)]
    pub fn magnetic_energy(&self, states: &[R]) -> R {
        let mut sum = R::zero();
        for winding in &self.windings {
            sum += winding.energy(winding.state_in(states));
        }
        sum
    }

    /// Rotors, in the order of their ids.
    #[must_use]
    pub fn rotors(&self) -> &[MountedRotor<R>] {
        &self.rotors
    }

    /// Motor of that id, its numbers in SI units.
    ///
    /// # Panics
    ///
    /// If the model has no such motor.
    #[must_use]
    pub fn motor(&self, id: MotorId) -> &Motor<R> {
        &self.params.motors[id.index()]
    }

    /// Rotor of that id, its numbers in SI units.
    ///
    /// # Panics
    ///
    /// If the model has no such rotor.
    #[must_use]
    pub fn rotor(&self, id: RotorId) -> &MountedRotor<R> {
        &self.rotors[id.index()]
    }

    /// Drag elements, in the order in which they were added.
    #[must_use]
    pub fn drags(&self) -> &[AirDrag<R>] {
        &self.drags
    }

    /// Springs, dampers and actuators between two points, and tendons, in the order in which they were added.
    #[must_use]
    pub fn spring_dampers(&self) -> &[SpringDamper<R>] {
        &self.spring_dampers
    }

    /// Elastic gears, in the order in which they were added.
    #[must_use]
    pub fn elastic_gears(&self) -> &[ElasticGear<R>] {
        &self.elastic_gears
    }

    /// Bushings, in the order in which they were added.
    #[must_use]
    pub fn bushings(&self) -> &[Bushing<R>] {
        &self.bushings
    }

    /// Returns true if there are springs and dampers that couple degrees of freedom: along paths, of elastic gears
    /// and of bushings.
    pub(crate) fn has_lines(&self) -> bool {
        !self.spring_dampers.is_empty() || !self.elastic_gears.is_empty() || !self.bushings.is_empty()
    }

    /// Wind that rotors and drag elements feel; `None` if the air rests.
    #[must_use]
    pub fn wind(&self) -> Option<&Wind> {
        self.wind.as_deref()
    }

    /// Torques `[N·m]` and forces `[N]` on degrees of freedom that depend on time.
    #[must_use]
    pub fn applied(&self) -> &[AppliedTorque] {
        &self.applied
    }

    /// Gravity that depends on the position, in addition to the uniform one; `None` without.
    #[must_use]
    pub fn gravity_field(&self) -> Option<&GravityField> {
        self.gravity_field.as_deref()
    }

    /// Centres of mass of the bodies on links: mass `[kg]`, index of the link, position in it `[m]`.
    pub(crate) fn centers_of_mass(&self) -> impl Iterator<Item = (R, usize, Vec3<R>)> {
        self.names.frames.iter().zip(&self.params.masses).filter_map(|(frame, mass)| {
            let (link, mass) = (frame.link?, mass.as_ref()?);
            let center = frame.pose.point(Vec3(mass.center_of_mass));
            Some((R::splat(mass.mass), link, Vec3(center.0.map(R::splat))))
        })
    }

    /// Returns true if the density of the air depends on the position.
    #[must_use]
    pub fn has_atmosphere(&self) -> bool {
        self.rotors.iter().any(|r| r.atmosphere.is_some()) || self.drags.iter().any(|d| d.atmosphere.is_some())
    }

    /// Returns true if an element feels the air.
    pub(crate) fn feels_air(&self) -> bool {
        !self.rotors.is_empty() || !self.drags.is_empty()
    }

    /// Returns true if the air's forces depend on how links move.
    pub(crate) fn moves_in_air(&self) -> bool {
        self.rotors.iter().any(MountedRotor::feels_motion) || !self.drags.is_empty()
    }

    /// External forces and torques on links, in the order in which they were added.
    #[must_use]
    pub fn wrenches(&self) -> &[AppliedWrench<R>] {
        &self.wrenches
    }

    /// Returns true if external forces may act on links.
    pub(crate) fn has_external(&self) -> bool {
        !self.wrenches.is_empty() || self.feels_air() || self.has_lines() || self.gravity_field.is_some()
    }

    /// Returns true if joints have nonlinear springs, elastic gears, fixed tendons or windings.
    pub(crate) fn has_special_joint_elements(&self) -> bool {
        let has_laws = !self.nonlinear_springs.is_empty() || !self.elastic_gears.is_empty();
        let has_shares = self.spring_dampers.iter().any(|element| !element.shares().is_empty());
        has_laws || has_shares || !self.windings.is_empty()
    }

    /// Drives: joints with Coulomb friction, then motors in velocity and position mode, then locked force sensors.
    /// Indices of drives count them.
    #[must_use]
    pub fn drives(&self) -> &[Drive] {
        &self.params.drives
    }

    /// Constraints: loop joints, gears, joint limits, and the contacts that are possible.
    #[must_use]
    pub fn constraints(&self) -> &ConstraintSet {
        &self.params.constraints
    }

    /// Number of drives, the length of [`crate::state::State::drives`].
    #[must_use]
    pub fn n_drives(&self) -> usize {
        self.params.drives.len()
    }

    /// Returns true if degree of freedom `dof` (0 to n_v − 1) moves one coordinate of its own; false for those of ball
    /// and free joints.
    #[inline(always)]
    #[must_use]
    pub fn has_scalar_coordinate(&self, dof: usize) -> bool {
        self.dofs[dof].q_idx != WORLD
    }

    /// Returns true if degree of freedom `dof` (0 to n_v − 1) is a translation `[m]`, not a rotation `[rad]`.
    #[must_use]
    pub fn is_translation(&self, dof: usize) -> bool {
        let link = self.links.iter().rfind(|link| link.v_idx as usize <= dof);
        link.is_some_and(|link| match link.kind {
            StageKind::Prismatic => true,
            StageKind::Free => dof - link.v_idx as usize >= 3,
            _ => false,
        })
    }

    /// Returns true if there are ball or free joints; without them n_q = n_v, and v is the derivative of q.
    #[inline(always)]
    #[must_use]
    pub fn has_quaternions(&self) -> bool {
        self.n_q != self.dofs.len()
    }

    /// Total mass of the moving links `[kg]`.
    #[must_use]
    pub fn total_mass(&self) -> R {
        self.params.inertias.iter().fold(R::zero(), |sum, inertia| sum + inertia.mass)
    }

    /// Uniform gravitational acceleration in world axes `[m/s²]`.
    #[must_use]
    pub fn gravity(&self) -> Vec3<R> {
        self.params.gravity
    }

    /// Gravitational acceleration at a position in the world `[m]`, world axes `[m/s²]`.
    #[must_use]
    pub fn gravity_at(&self, position: Vec3<R>) -> Vec3<R> {
        match &self.gravity_field {
            None => self.params.gravity,
            Some(field) => self.params.gravity + field.acceleration(position),
        }
    }

    /// Sets the names and values of sensors, each of which is a frame of the same name; replaces former ones.
    ///
    /// # Panics
    ///
    /// If one of them has no frame of its name.
    pub fn set_sensors(&mut self, sensors: Vec<SensorInfo>) {
        for sensor in &sensors {
            assert!(self.names.frame(&sensor.name).is_some(), "the sensor `{}` is no frame", sensor.name);
        }
        Arc::make_mut(&mut self.structure_mut().names).sensors = sensors;
    }

    /// Names of the user's objects, with what each is in the model: joints, bodies, frames, rotors, sensors.
    #[must_use]
    pub fn names(&self) -> &Names {
        &self.names
    }
}

impl<R: Real> Model<R> {
    /// Torque `[N·m]` or force `[N]` of the springs on degree of freedom `dof` (0 to n_v − 1) at coordinates `q` (n_q);
    /// in child axes for ball and free joints.
    #[must_use]
    #[inline(always)]
    pub fn spring_torque(&self, dof: usize, q: &[R]) -> R {
        if let Some(coordinate) = self.dofs[dof].coordinate() {
            let mut sum = spring::torque(&self.dofs[dof], q[coordinate]);
            for law in self.nonlinear_springs.iter().filter(|spring| spring.dof == dof) {
                sum += law.torques(&self.dofs[dof], q[coordinate], R::zero()).0;
            }
            return sum;
        }
        let (zero, mut all) = ([R::zero(); 6], [R::zero(); 6]);
        for link in self.sprung.iter().map(|&link| &self.links[link]) {
            let first = link.v_idx as usize;
            if (first..first + link.kind.n_v()).contains(&dof) {
                spring::add_torques(link, &self.dofs[first..], (q, &zero), R::zero(), &mut all);
                return all[dof - first];
            }
        }
        R::zero()
    }

    /// Torque `[N·m]` or force `[N]` of the dampers on degree of freedom `dof` (0 to n_v − 1) at coordinates `q` (n_q)
    /// and velocities `v` (n_v), with the rate-dependent part of nonlinear springs.
    #[must_use]
    #[inline(always)]
    pub fn damping_torque(&self, dof: usize, q: &[R], v: &[R]) -> R {
        let mut sum = damper::torque(&self.dofs[dof], v[dof]);
        for law in self.nonlinear_springs.iter().filter(|spring| spring.dof == dof) {
            sum += law.torques(&self.dofs[dof], q[self.dofs[dof].q_idx as usize], v[dof]).1;
        }
        sum
    }

    /// Nonlinear springs and dampers of joints, in the order of their degrees of freedom.
    #[must_use]
    pub fn nonlinear_springs(&self) -> &[NonlinearSpring] {
        &self.nonlinear_springs
    }

    /// Applied torque `[N·m]` or force `[N]` on degree of freedom `dof` (0 to n_v − 1) at time `t` `[s]`; 0 if none is
    /// applied.
    #[must_use]
    pub fn applied_torque(&self, dof: usize, t: f64) -> R {
        let mut sum = R::zero();
        for applied in self.applied.iter().filter(|applied| applied.dof == dof) {
            sum += applied.torque::<R>(t);
        }
        self.dofs[dof].torque + sum
    }
}

impl Model<f64> {
    /// Sets the free length `[m]` of the spring and damper of index `k` in [`Model::spring_dampers`].
    ///
    /// # Panics
    ///
    /// If there is no such element.
    pub fn set_free_length(&mut self, k: usize, length: f64) {
        self.structure_mut().spring_dampers[k].free_length = length;
    }

    /// Next time event: the first instant after `t` `[s]` at which a force signal or its slope jumps, or a gust begins
    /// or ends; infinite if there is none.
    #[must_use]
    pub fn next_time_event(&self, t: f64) -> f64 {
        if self.applied.is_empty() && self.wrenches.is_empty() && self.wind.is_none() {
            return f64::INFINITY;
        }
        let of_wind = self.wind.as_ref().filter(|_| self.feels_air()).map_or(f64::INFINITY, |w| w.next_time_event(t));
        let applied = self.applied.iter().flat_map(|a| &a.signal);
        let wrenches = self.wrenches.iter().flat_map(|w| w.force.iter().chain(&w.torque).flatten());
        applied.chain(wrenches).map(|s| s.next_time_event(t)).fold(of_wind, f64::min)
    }
}
