//! The mechanism as a system to integrate: model, commands, drives and constraints as dy/dt = f(t, y).
//!
//! y = (δ, v, totals, rotors), see [`layout`]: displacement of the generalized coordinates in the chart of the step
//! (`n_v`), velocities (`n_v`), and, if they are tracked, the totals of [`State`]: work, dissipation, impulse of each
//! motor; last the states of rotors.
//!
//! The chart: q = q₀ ⊕ δ ([`displace`]). For a quaternion δ is a rotation vector φ and φ' = dexp⁻¹(φ) ω with ω in child
//! axes. Source: key `iserles2000`, sections 2.5 and 3.
//!
//! A mechanism is working memory for one evaluation after the other: [`State`] is what lasts. Of what lasts it has
//! copies, which [`Mechanism::load`] makes: the chart's origin, commands, modes. The parameters of the model are its
//! own.

mod analysis;
mod bearing_load;
pub(crate) mod constraints;
pub(crate) mod drive_monitor;
pub(crate) mod foresight;
mod kinks;
pub mod layout;
mod lines;
mod loop_rank;
pub(crate) mod passages;
mod reaction;
mod rotating_axes;
mod singular;
mod slopes;
mod torques;

use sincro_math::compiled::CompiledEvaluation;
use sincro_math::{Branches, Real};

use crate::actuation::{
    Drive, DriveKind, ElasticGear, ExternalForce, Motor, MotorMode, SpringDamper, damper, friction,
};
use crate::aero::rotor::{RotorLaw, SpeedSource};
use crate::constraint::{Constraints, Level};
use crate::ids::{MotorId, RotorId};
use crate::integrate::{Implicit, SingularStages, System};
use crate::joint::StageKind;
use crate::model::Model;
use crate::recursions::aba::{self, Prescribed};
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::spatial::{Force, Quat, Vec3};
use crate::state::{State, displace};
use bearing_load::Bearings;
use drive_monitor::DriveMonitor;
use layout::Layout;
use rotating_axes::RotatingLinks;
use singular::SingularPassage;
use torques::{TorqueInput, joint_torques};

/// Tolerance of the projection on constraints: positions `[m]`, `[rad]` and rates `[m/s]`, `[rad/s]` of a mechanism
/// with contacts, limits or loops are no more accurate than that.
pub const PROJECTION_TOLERANCE: f64 = 1e-12;

/// Model with its commands, drives and working memory as a [`System`] dy/dt = f(t, y), evaluated without allocation.
/// Part of a [`World`](crate::world::World); on its own for linearisation and co-simulation.
///
/// y: displacement in the chart (n_v), velocities (n_v), totals if tracked (2 + motors), rotor states.
#[derive(Clone, Debug)]
pub struct Mechanism<R> {
    pub(crate) model: Model<R>,
    /// Commands, each in the unit of its actuator, in the order of [`Model::n_commands`].
    pub commands: Vec<R>,
    /// Values that act in the place of the commands at the last evaluation; not kept where no actuator has an
    /// activation.
    actuations: Vec<R>,
    /// State of each drive, in the order of [`Model::drives`]: 0 locked, +1 or −1 saturated upwards or downwards.
    pub drives: Vec<R>,
    layout: Layout,
    /// True if joints have elements besides linear springs, dampers, motors and drives: the lists of others, of which
    /// most models have none, are asked for once, not in each evaluation.
    has_special: bool,
    /// True if elements of the model may act on links, asked for once too.
    has_external_elements: bool,
    /// q₀ of the chart.
    pub(crate) base: Vec<R>,
    pub(crate) q: Vec<R>,
    pub(crate) torque: Vec<R>,
    /// Velocities over a linearly implicit step: at its end, then their mean.
    step_velocity: Vec<R>,
    /// Zeros: velocities and torques of impulses.
    pub(crate) zeros: Vec<R>,
    pub(crate) diagonal: Vec<R>,
    pub(crate) locked_mask: Vec<R>,
    pub(crate) prescribed_acceleration: Vec<R>,
    /// Forces that the bearings of joints transmit in the last evaluation `[N]`; zero where friction does not grow with
    /// them.
    pub(crate) loads: Vec<R>,
    bearings: Option<Box<Bearings<R>>>,
    external: Vec<Force<R>>,
    /// External forces from outside the model, until they are removed.
    external_forces: Vec<ExternalForce<R>>,
    /// Power dissipated by drag elements in the last evaluation `[W]`.
    air_dissipation: R,
    /// Power of gravity that depends on the position, where it has a potential, in the last evaluation `[W]`.
    field_power: R,
    /// Springs and dampers between two points in the last evaluation.
    lines: lines::Lines<R>,
    /// First rotor whose load was not a number in the last evaluation.
    without_load: Option<RotorId>,
    motor_torque: Vec<R>,
    pub(crate) scratch: Scratch<R>,
    pub(crate) constraints: Option<Box<Constraints<R>>>,
    /// True if the model has constraints; lanes have no memory of them.
    is_constrained: bool,
    /// Working memory of projections and impacts.
    pub(crate) constraint_change: Vec<R>,
    /// Factor on the tolerance of projections: extent of a mechanism with loops that is smaller than 1 m, else 1.
    projection_scale: f64,
    /// Energy to whose share work and dissipation take part in error control `[J]`; infinite if they do not.
    energy_scale: f64,
    /// Links whose velocities have axes that rotate.
    rotating: RotatingLinks,
    /// Passage of a singular position of the loops.
    singular: SingularPassage<R>,
    /// Laws of limited drives at the stages of a step.
    pub(crate) drive_monitor: DriveMonitor,
    /// Right-hand side that was compiled for this mechanism, during a step of an explicit method.
    pub(crate) compiled: Option<Box<CompiledEvaluation>>,
}

impl<R: Real> Mechanism<R> {
    /// Creates the mechanism of `model` with all commands zero and all drives locked; `tracks_totals` adds work,
    /// dissipation and motor impulses to y.
    #[must_use]
    pub fn new(model: Model<R>, tracks_totals: bool) -> Self {
        let zero = vec![R::zero(); model.n_v()];
        Self {
            commands: vec![R::zero(); model.n_commands()],
            actuations: vec![R::zero(); model.n_commands()],
            drives: vec![R::zero(); model.n_drives()],
            layout: Layout::new(&model, tracks_totals),
            has_special: model.has_special_joint_elements(),
            has_external_elements: model.has_external(),
            base: vec![R::zero(); model.n_q()],
            q: vec![R::zero(); model.n_q()],
            torque: zero.clone(),
            step_velocity: zero.clone(),
            zeros: zero.clone(),
            diagonal: zero.clone(),
            locked_mask: zero.clone(),
            prescribed_acceleration: zero.clone(),
            loads: zero.clone(),
            bearings: Bearings::new(&model),
            external: vec![Force::zero(); if model.has_external() { model.links.len() } else { 0 }],
            external_forces: Vec::new(),
            air_dissipation: R::zero(),
            field_power: R::zero(),
            lines: lines::Lines::new(&model),
            without_load: None,
            motor_torque: vec![R::zero(); model.params.motors.len()],
            scratch: Scratch::new(&model),
            constraint_change: zero.clone(),
            projection_scale: 1.0,
            energy_scale: f64::INFINITY,
            rotating: RotatingLinks::new(&model),
            singular: SingularPassage::default(),
            drive_monitor: DriveMonitor::default(),
            compiled: None,
            is_constrained: !model.constraints().is_empty(),
            // constraints branch, which lanes cannot
            constraints: if R::IS_SCALAR { Constraints::new(&model) } else { None },
            model,
        }
    }

    /// Model that it evaluates.
    #[must_use]
    pub fn model(&self) -> &Model<R> {
        &self.model
    }

    /// Bytes that it takes on the heap, the model left out; for memory statistics.
    #[must_use]
    pub fn heap_bytes(&self) -> usize {
        let numbers = [
            &self.commands,
            &self.actuations,
            &self.drives,
            &self.base,
            &self.q,
            &self.torque,
            &self.step_velocity,
            &self.zeros,
            &self.diagonal,
            &self.locked_mask,
            &self.prescribed_acceleration,
            &self.motor_torque,
        ];
        numbers.iter().map(|v| size_of_val(&***v)).sum::<usize>()
            + size_of_val(&*self.external)
            + size_of_val(&*self.external_forces)
            + self.lines.heap_bytes()
            + self.scratch.heap_bytes()
    }

    /// Takes over the state `x` and writes its y ([`System::dim`] entries), in a chart centred at `x`.
    pub fn load(&mut self, x: &State<R>, y: &mut [R]) {
        let layout = self.layout;
        self.forget_conditioning();
        self.base.copy_from_slice(&x.q);
        copy_any(&mut self.commands, &x.commands);
        copy_any(&mut self.drives, &x.drives);
        if let Some(constraints) = &mut self.constraints {
            constraints.memory.load(&x.contacts);
        }
        y[layout.displacement()].fill(R::zero());
        y[layout.velocities()].copy_from_slice(&x.v);
        if layout.tracks_totals() {
            y[layout.totals()].copy_from_slice(&x.totals);
        }
        copy_any(&mut y[layout.rotor_states()], &x.rotors);
    }

    /// Writes to `x` the state that `y` ([`System::dim`] entries) describes, in a chart centred there; commands and
    /// tick of `x` stay.
    pub fn store(&self, y: &[R], x: &mut State<R>) {
        let layout = self.layout;
        x.q.copy_from_slice(&self.base);
        x.v.copy_from_slice(&y[layout.velocities()]);
        copy_any(&mut x.drives, &self.drives);
        if let Some(constraints) = &self.constraints {
            constraints.memory.store(&mut x.contacts);
        }
        if layout.tracks_totals() {
            x.totals.copy_from_slice(&y[layout.totals()]);
        }
        copy_any(&mut x.rotors, &y[layout.rotor_states()]);
    }

    /// Layout of y.
    #[inline(always)]
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Coordinates of the chart's origin.
    pub(crate) fn base(&self) -> &[R] {
        &self.base
    }

    #[cfg(feature = "batch")]
    pub(crate) fn base_mut(&mut self) -> &mut [R] {
        &mut self.base
    }

    /// Sets the chart's origin; y is not changed.
    pub(crate) fn set_base(&mut self, q: &[R]) {
        self.base.copy_from_slice(q);
    }

    /// Finds the coordinates of y.
    #[inline(always)]
    pub(crate) fn set_coordinates(&mut self, y: &[R]) {
        displace(&self.model, &self.base, &y[self.layout.displacement()], &mut self.q);
    }

    /// Lets work and dissipation, if they are tracked, take part in error control, relative to `scale` `[J]`.
    pub(crate) fn control_energies(&mut self, scale: f64) {
        self.energy_scale = if self.layout.tracks_totals() { scale } else { f64::INFINITY };
    }

    /// Returns true if entry `k` of y is work or dissipation and takes part in error control.
    fn is_controlled_energy(&self, k: usize) -> bool {
        let work = self.layout.work();
        self.energy_scale < f64::INFINITY && (work..work + 2).contains(&k)
    }

    pub(crate) fn take_motor_torque(&mut self) -> Vec<R> {
        core::mem::take(&mut self.motor_torque)
    }

    pub(crate) fn put_motor_torque(&mut self, torque: Vec<R>) {
        self.motor_torque = torque;
    }

    /// Torque of each motor in the last evaluation `[N·m]` or `[N]`, in the order of [`Model::motors`].
    #[must_use]
    pub fn motor_torque(&self) -> &[R] {
        &self.motor_torque
    }

    /// Computes poses, twists and accelerations of all links.
    pub(crate) fn update_kinematics(&mut self, x: &State<R>, v_dot: &[R]) {
        kinematics::motions(&self.model, &x.q, &x.v, v_dot, &mut self.scratch);
    }

    /// Working memory as the last evaluation left it: kinematics of its state.
    #[must_use]
    pub fn scratch(&mut self) -> &mut Scratch<R> {
        &mut self.scratch
    }

    /// Locks the degrees of freedom whose drives are locked, with zero prescribed acceleration, for the evaluations to
    /// come. To be called after changes of `drives`; without drives no effect.
    #[inline(always)]
    pub fn mark_locked(&mut self) {
        let (half, one, zero) = (R::splat(0.5), R::one(), R::zero());
        if self.drives.is_empty() {
            return;
        }
        if let Some(constraints) = &mut self.constraints {
            constraints.kinks.clear();
        }
        self.locked_mask.fill(zero);
        self.prescribed_acceleration.fill(zero);
        for (drive, &saturation) in self.model.params.drives.iter().zip(&self.drives) {
            let holds = saturation.abs().if_less(half, one, zero);
            self.locked_mask[drive.dof] = self.locked_mask[drive.dof].max(holds);
        }
    }

    /// Returns true if a degree of freedom is locked, as last marked.
    #[must_use]
    pub(crate) fn is_locked(&self, dof: usize) -> bool {
        self.locked_mask[dof].lane(0) > 0.5
    }

    /// Values that act in the place of the commands, as the last evaluation found them.
    #[inline(always)]
    fn acting_commands(&self) -> &[R] {
        acting(&self.model, &self.commands, &self.actuations)
    }

    /// Accelerations at (t, q in `self.q`, v) for the loads of bearings that are known; `implicit` as in [`Instant`].
    #[inline(always)]
    fn accelerations(&mut self, t: f64, v: &[R], rotors: &[R], implicit: Option<(f64, Implicit)>, v_dot: &mut [R]) {
        if !self.model.activations.is_empty() {
            self.model.find_actuations(&self.commands, rotors, &mut self.actuations);
        }
        let at = TorqueInput {
            t,
            q: &self.q,
            v,
            commands: acting(&self.model, &self.commands, &self.actuations),
            drives: &self.drives,
            elements: rotors,
            loads: &self.loads,
            implicit,
            has_special: self.has_special,
        };
        joint_torques(&self.model, &at, &mut self.torque, &mut self.diagonal);
        // a step of semi-implicit Euler is one at velocity level, in the axes at its start
        let velocity_level = match implicit {
            Some((h, Implicit::Dampers)) => Some(h),
            _ => None,
        };
        let in_fixed_axes = velocity_level.filter(|_| !self.rotating.is_empty());
        if let Some(h) = in_fixed_axes {
            self.rotating.correct_torques(&self.model, h, v, &self.locked_mask, &mut self.torque);
        }
        let external = if self.has_external() {
            self.external_wrenches(t, v, rotors, implicit);
            Some(&*self.external)
        } else {
            None
        };
        let prescribed = if self.drives.is_empty() {
            None
        } else {
            Some(Prescribed { mask: &self.locked_mask, acceleration: &self.prescribed_acceleration })
        };
        let input = aba::Input {
            q: &self.q,
            v,
            torque: &self.torque,
            diagonal: &self.diagonal,
            prescribed,
            external,
            gravity: true,
        };
        aba::forward_dynamics(&self.model, &input, &mut self.scratch, v_dot);
        if in_fixed_axes.is_some() {
            self.rotating.fix_axes(&self.model, v, &self.locked_mask, v_dot);
        }
        let has_drives = !self.drives.is_empty();
        let implicit_forces = match implicit {
            Some(_) => self.lines.factor(&self.model, &self.scratch, v_dot),
            None => None,
        };
        if R::IS_SCALAR
            && let Some(constraints) = &mut self.constraints
        {
            let level = velocity_level.map_or(Level::Acceleration, Level::Velocity);
            let at = (&*self.q, v);
            constraints.apply(&self.model, at, level, &mut self.scratch, v_dot, has_drives, implicit_forces);
        } else if R::IS_SCALAR
            && let Some(forces) = implicit_forces
        {
            forces.respond(&self.model, &mut self.scratch, v_dot, has_drives);
        }
    }

    #[inline(always)]
    fn external_wrenches(&mut self, t: f64, v: &[R], rotors: &[R], implicit: Option<(f64, Implicit)>) {
        self.external.fill(Force::zero());
        let has_field = R::IS_SCALAR && self.model.gravity_field.is_some();
        if self.model.moves_in_air() || self.model.has_lines() || has_field {
            // only poses and twists are looked at: any accelerations will do
            kinematics::motions(&self.model, &self.q, v, v, &mut self.scratch);
        } else if !self.external_forces.is_empty() || self.model.wrenches.iter().any(|w| !w.in_body) {
            kinematics::poses(&self.model, &self.q, &mut self.scratch);
        }
        self.air_wrenches(t, v, rotors);
        if let Some(field) = self.model.gravity_field.as_ref().filter(|_| R::IS_SCALAR) {
            self.field_power = R::zero();
            for (mass, link, center) in self.model.centers_of_mass() {
                let x_wl = &self.scratch.poses[link];
                let lin = x_wl.rot.tr_mul_vec(field.acceleration(x_wl.point(center))).scale(mass);
                let wrench = Force { ang: center.cross(lin), lin };
                self.external[link] += wrench;
                if field.potential.is_some() {
                    self.field_power += self.scratch.links[link].v.dot(&wrench);
                }
            }
        }
        if self.model.has_lines() {
            let implicit = implicit.map(|(h, implicit)| implicit.steps(h));
            let commands = acting(&self.model, &self.commands, &self.actuations);
            let at = (&*self.q, v, commands);
            self.lines.add_wrenches(&self.model, &self.scratch, at, implicit, &mut self.external);
        }
        for wrench in &self.model.wrenches {
            self.external[wrench.link] += wrench.wrench(t, &self.scratch.poses[wrench.link].rot, &self.commands);
        }
        for applied in &self.external_forces {
            self.external[applied.link] += applied.wrench(&self.scratch.poses[applied.link].rot);
        }
    }

    /// Returns true if external forces act on links now.
    #[inline(always)]
    fn has_external(&self) -> bool {
        self.has_external_elements || !self.external_forces.is_empty()
    }

    /// Adds an external force, to those on the same point of the same link if there are any.
    pub(crate) fn apply_external_force(&mut self, applied: ExternalForce<R>) {
        self.external.resize(self.model.links.len(), Force::zero());
        match self.external_forces.iter_mut().find(|p| p.link == applied.link && p.point == applied.point) {
            Some(known) => {
                known.force += applied.force;
                known.torque += applied.torque;
            }
            None => self.external_forces.push(applied),
        }
    }

    /// External forces from outside the model.
    pub(crate) fn external_forces(&self) -> &[ExternalForce<R>] {
        &self.external_forces
    }

    /// Returns true if external forces act from outside the model.
    pub(crate) fn has_external_forces(&self) -> bool {
        !self.external_forces.is_empty()
    }

    /// Removes all external forces.
    pub(crate) fn clear_external_forces(&mut self) {
        self.external_forces.clear();
        if !self.model.has_external() {
            self.external.clear();
        }
    }

    /// Replaces a motor, the degree of freedom kept. Drives that remain keep their state; a new one is locked.
    pub(crate) fn set_motor(&mut self, id: MotorId, motor: Motor<R>) {
        let old = self.model.drives().to_vec();
        self.model.set_motor(id, motor);
        if old.len() == self.model.n_drives() {
            return;
        }
        let known = |new: &Drive| old.iter().position(|old| old == new).map(|i| self.drives[i]);
        self.drives = self.model.drives().iter().map(|drive| known(drive).unwrap_or(R::zero())).collect();
        self.resize_drives();
    }

    /// Fits the states of drives to their number; new ones are locked.
    pub(crate) fn resize_drives(&mut self) {
        self.drives.resize(self.model.n_drives(), R::zero());
        self.locked_mask.fill(R::zero());
        self.prescribed_acceleration.fill(R::zero());
    }

    /// The first rotor whose law gave what is not a number in the last evaluation.
    pub(crate) fn rotor_without_load(&self) -> Option<RotorId> {
        self.without_load
    }

    /// Adds the wrenches of rotors and drag elements; after kinematics.
    #[inline(always)]
    fn air_wrenches(&mut self, t: f64, v: &[R], rotors: &[R]) {
        if !self.model.feels_air() {
            return;
        }
        let air = self.model.wind.as_ref().map(|wind| wind.at(t));
        let at = |link: usize| (&self.scratch.links[link].v, &self.scratch.poses[link]);
        self.without_load = None;
        for (k, rotor) in self.model.rotors.iter().enumerate() {
            let speed = rotor.speed.value(v, &self.commands, rotors);
            if let Some(load) = rotor.load_at_any_motion(speed, rotors) {
                self.external[rotor.link] += rotor.wrench(&load);
                continue;
            }
            let (twist, x_wl) = at(rotor.link);
            let load = rotor.load(speed, rotors, &rotor.hub(twist, x_wl, air.as_ref()));
            if matches!(rotor.law, RotorLaw::Printed(_)) && !(load.thrust.is_finite() && load.torque.is_finite()) {
                self.without_load = self.without_load.or(Some(RotorId::new(k)));
            }
            self.external[rotor.link] += rotor.wrench(&load);
        }
        self.air_dissipation = R::zero();
        for drag in &self.model.drags {
            let (twist, x_wl) = at(drag.link);
            let resistance = drag.resistance(drag.velocity(twist, x_wl, air.as_ref()), x_wl);
            self.external[drag.link] += drag.wrench(resistance.force);
            self.air_dissipation += resistance.dissipation;
        }
    }

    /// Rates of the states of elements for the accelerations in `slope`, over a linearly implicit step of length `h`
    /// `[s]` (0: now).
    #[inline(always)]
    fn element_rates(&self, y: &[R], h: f64, slope: &mut [R]) {
        if self.layout.has_element_states() {
            let states = self.layout.rotor_states();
            self.rotor_rates(&y[states.clone()], h, &mut slope[states]);
            self.current_rates(y, h, slope);
            let states = self.layout.rotor_states();
            self.model.activation_rates(&self.commands, &y[states.clone()], R::splat(h), &mut slope[states]);
        }
    }

    /// Rates of the states of rotors `x`, over a linearly implicit step of length `h` (0: now).
    #[inline(always)]
    fn rotor_rates(&self, x: &[R], h: f64, rates: &mut [R]) {
        for rotor in &self.model.rotors {
            match rotor.speed {
                SpeedSource::Lag { command, state, time_constant, .. } => {
                    rates[state] = (self.commands[command] - x[state]) / (time_constant + R::splat(h));
                }
                // particles are counted once a tick
                SpeedSource::Particles { state, .. } => rates[state] = R::zero(),
                SpeedSource::Command(_) | SpeedSource::Joint { .. } => {}
            }
        }
    }

    /// Rates of the currents of windings for the accelerations in `slope`, over a linearly implicit step of length `h`
    /// (0: now).
    #[inline(always)]
    fn current_rates(&self, y: &[R], h: f64, slope: &mut [R]) {
        let (layout, h) = (self.layout, R::splat(h));
        for winding in &self.model.windings {
            let Some(k) = winding.state else { continue };
            let (at, dof) = (layout.rotor_states().start + k, layout.velocity(winding.dof));
            let is_active = self.model.params.motors[winding.motor].mode == MotorMode::Voltage;
            let v_end = y[dof] + h * slope[dof];
            let command = self.acting_commands()[winding.motor];
            slope[at] = if is_active { winding.current_rate(y[at], v_end, command, h) } else { R::zero() };
        }
    }

    /// Rates of the totals at the last evaluation, with the states of elements there, for velocities `v` over which
    /// forces do their work: means over a linearly implicit step.
    #[inline(always)]
    fn total_rates(&mut self, t: f64, (v_at, elements): (&[R], &[R]), v: &[R], steps: (R, R), rates: &mut [R]) {
        let (mut work, mut dissipation) = (R::zero(), R::zero());
        let v = &v[..self.model.dofs.len()];
        for (dof, &v) in self.model.dofs.iter().zip(v) {
            work += dof.torque * v;
            dissipation += damper::dissipation(dof, v);
        }
        if self.has_special {
            for spring in &self.model.nonlinear_springs {
                let dof = &self.model.dofs[spring.dof];
                let v = v[spring.dof];
                dissipation -= spring.torques(dof, self.q[dof.q_idx as usize], v).1 * v;
            }
            for gear in &self.model.elastic_gears {
                dissipation += gear.dissipation(gear.error(&self.q, v_at).0, gear.rate(v));
            }
        }
        for applied in &self.model.applied {
            work += applied.torque::<R>(t) * v[applied.dof];
        }
        for (link, wrench) in self.scratch.links.iter().zip(&self.external) {
            work += link.v.dot(wrench);
        }
        if self.has_external_elements {
            // what comes out of a potential is no work
            work -= self.field_power;
            if !self.model.drags.is_empty() {
                // drag's power is in `work` already: what it takes as heat, and what the wind does, add up to it
                work += self.air_dissipation;
                dissipation += self.air_dissipation;
            }
            if !self.model.spring_dampers.is_empty() || !self.model.bushings.is_empty() {
                let commands = acting(&self.model, &self.commands, &self.actuations);
                let (of_actuators, heat) =
                    self.lines.power(&self.model, commands, (steps.0.lane(0) != 0.0).then_some(v));
                work += of_actuators;
                dissipation += heat;
            }
        }
        self.find_motor_torques((v_at, elements), v, steps);
        for (i, drive) in self.model.params.drives.iter().enumerate() {
            if drive.kind == DriveKind::Friction {
                dissipation += friction::dissipation(self.friction_torque(i, v_at[drive.dof]), v[drive.dof]);
            }
        }
        let motors = &self.model.params.motors[..];
        let (torques, of_motors) = (&self.motor_torque[..motors.len()], &mut rates[2..][..motors.len()]);
        for (i, motor) in motors.iter().enumerate() {
            work += torques[i] * v[motor.dof];
            of_motors[i] = torques[i];
        }
        if self.has_special {
            for winding in self.model.active_windings() {
                let (i, k) = (winding.motor, winding.dof);
                let v_end = v[k] + v[k] - v_at[k];
                let power =
                    winding.power(winding.state_in(elements), (v_end, v[k]), self.acting_commands()[i], steps.0);
                // the work of its torque is in the sum already
                work += power.electrical - self.motor_torque[i] * v[k];
                dissipation += power.heat;
            }
        }
        if R::IS_SCALAR
            && let Some(constraints) = &self.constraints
        {
            dissipation += constraints.dissipation(v);
        }
        rates[0] = work;
        rates[1] = dissipation;
    }

    /// Torque of the friction drive `i` in the last evaluation, at rate `v`: its limit if saturated; if locked, the
    /// reaction up to its limit (a motor that locks the same joint gives the rest).
    #[inline(always)]
    pub(crate) fn friction_torque(&self, i: usize, v: R) -> R {
        let drive = self.model.params.drives[i];
        let friction = self.model.dofs[drive.dof].friction.under(self.loads[drive.dof]);
        let locked = self.scratch.reaction[drive.dof].clamp_abs(friction.at_rest);
        self.drives[i].abs().if_less(R::splat(0.5), locked, self.drives[i] * friction.limit_at(v))
    }

    /// Torque of every motor in the last evaluation, with the velocities and states of elements there, and the mean
    /// velocities over a linearly implicit step.
    #[inline(always)]
    pub(crate) fn find_motor_torques(&mut self, (v, elements): (&[R], &[R]), mean: &[R], steps: (R, R)) {
        let motors = &self.model.params.motors[..];
        let commands = &acting(&self.model, &self.commands, &self.actuations)[..motors.len()];
        let torques = &mut self.motor_torque[..motors.len()];
        for (i, motor) in motors.iter().enumerate() {
            let q = self.model.dofs[motor.dof].coordinate_in(&self.q);
            torques[i] = motor.torque(q, v[motor.dof], commands[i], steps).0;
        }
        if self.has_special {
            for winding in self.model.active_windings() {
                let (i, k) = (winding.motor, winding.dof);
                let v_end = mean[k] + mean[k] - v[k];
                let current =
                    winding.current_after(winding.state_in(elements), v_end, self.acting_commands()[i], steps.0);
                self.motor_torque[i] = winding.torque_per_ampere() * current;
            }
        }
        let drives = &self.model.params.drives[..];
        let states = &self.drives[..drives.len()];
        for (d, drive) in drives.iter().enumerate() {
            let DriveKind::Motor(i) = drive.kind else { continue };
            let i = i.index();
            let mut locked = self.scratch.reaction[drive.dof];
            for (f, other) in drives[..d].iter().enumerate() {
                if other.dof == drive.dof {
                    // friction that locks the same joint takes its share first
                    let share = self.friction_torque(f, v[drive.dof]);
                    locked -= states[f].abs().if_less(R::splat(0.5), share, R::zero());
                }
            }
            let saturated = match self.model.drive_limit(drive) {
                Some(limit) => states[d] * limit,
                None => R::zero(),
            };
            self.motor_torque[i] = states[d].abs().if_less(R::splat(0.5), locked, saturated);
        }
    }

    /// Evaluates the compiled right-hand side; false if there is none for this state.
    #[inline(never)]
    fn compiled_slope(&mut self, y: &[R], slope: &mut [R]) -> bool {
        let Some(compiled) = &mut self.compiled else { return false };
        let Some(found) = compiled.evaluate([&self.base, y], &self.commands) else { return false };
        slope.iter_mut().zip(found).for_each(|(slope, x)| *slope = R::splat(*x));
        true
    }

    /// Rate of the chart's displacement for velocity `v` at displacement `delta`.
    #[inline(always)]
    fn chart_rate(&self, delta: &[R], v: &[R], rate: &mut [R]) {
        if !self.model.has_quaternions() {
            rate.copy_from_slice(v);
            return;
        }
        for link in &self.model.links {
            let k = link.v_idx as usize;
            if !matches!(link.kind, StageKind::Ball | StageKind::Free) {
                rate[k] = v[k];
                continue;
            }
            let phi = Vec3([delta[k], delta[k + 1], delta[k + 2]]);
            rate[k..k + 3].copy_from_slice(&phi.rotation_rate(Vec3([v[k], v[k + 1], v[k + 2]])).0);
            if link.kind == StageKind::Free {
                let turn = Quat::exp(phi).matrix();
                let lin = turn.mul_vec(Vec3([v[k + 3], v[k + 4], v[k + 5]]));
                rate[k + 3..k + 6].copy_from_slice(&lin.0);
            }
        }
    }

    /// Velocity changes by the impulses that bring about the prescribed changes as marked; reactions are impulses.
    #[inline(always)]
    pub(crate) fn impulse(&mut self, change: &mut [R]) {
        self.impulse_under(true, change);
    }

    /// Velocity changes by impulses under the prescribed changes as marked, or without any.
    #[inline(always)]
    fn impulse_under(&mut self, is_prescribed: bool, change: &mut [R]) {
        for (d, dof) in self.diagonal.iter_mut().zip(&self.model.dofs) {
            *d = dof.armature;
        }
        let prescribed = is_prescribed
            .then_some(Prescribed { mask: &self.locked_mask, acceleration: &self.prescribed_acceleration });
        let input = aba::Input {
            q: &self.base,
            v: &self.zeros,
            torque: &self.zeros,
            diagonal: &self.diagonal,
            prescribed,
            external: None,
            gravity: false,
        };
        aba::forward_dynamics(&self.model, &input, &mut self.scratch, change);
    }
}

impl<R: Real> System<R> for Mechanism<R> {
    #[inline(always)]
    fn dim(&self) -> usize {
        self.layout.dim()
    }

    #[inline(always)]
    fn is_controlled(&self, k: usize) -> bool {
        !self.layout.totals().contains(&k) || self.is_controlled_energy(k)
    }

    #[inline(always)]
    fn slope(&mut self, t: f64, y: &[R], slope: &mut [R]) {
        if R::IS_SCALAR && self.compiled.is_some() && self.compiled_slope(y, slope) {
            return;
        }
        if R::IS_SCALAR && self.bearings.is_some() {
            self.find_loads(t, None, y, slope);
        }
        self.explicit_slope(t, y, slope);
        if R::IS_SCALAR {
            self.finish_stage(t, None, y, slope);
        }
    }

    fn begin_step(&mut self) {
        self.singular.begin_step();
        self.drive_monitor.begin_trial();
        if let Some(c) = &mut self.constraints {
            c.solver.begin_trial();
        }
    }

    fn singular_stages(&self) -> SingularStages {
        self.singular.stages()
    }

    fn branches(&mut self, y: &[R]) -> Option<Branches> {
        let has_laws = self.model.spring_dampers.iter().any(SpringDamper::has_branches)
            || self.model.elastic_gears.iter().any(ElasticGear::has_branches)
            || !self.model.nonlinear_springs.is_empty();
        has_laws.then(|| self.branches_of_laws(y))
    }

    fn project_error(&mut self, y: &[R], error: &mut [R]) {
        if R::IS_SCALAR && self.singular.is_near {
            self.project_error_along_loops(y, error);
        }
    }

    #[inline(always)]
    fn implicit_slope(&mut self, t: f64, h: f64, implicit: Implicit, y: &[R], slope: &mut [R]) {
        if R::IS_SCALAR && self.bearings.is_some() {
            self.find_loads(t, Some((h, implicit)), y, slope);
        }
        self.linearly_implicit_slope(t, h, implicit, y, slope);
        if R::IS_SCALAR {
            self.finish_stage(t, Some((h, implicit)), y, slope);
        }
    }

    #[inline(always)]
    fn rechart(&mut self, y: &mut [R]) {
        let displacement = self.layout.displacement();
        if let Some(c) = &mut self.constraints {
            c.solver.accept_trial();
        }
        displace(&self.model, &self.base, &y[displacement.clone()], &mut self.q);
        core::mem::swap(&mut self.base, &mut self.q);
        y[displacement].fill(R::zero());
        if self.layout.has_element_states() {
            self.model.limit_activations(&mut y[self.layout.rotor_states()]);
        }
    }

    #[inline(always)]
    fn rechart_at_velocity_level(&mut self, y: &mut [R]) {
        self.rechart(y);
        // the former centre of the chart is left in q
        self.rotating.turn_velocities(&self.model, (&self.q, &self.base), &mut y[self.layout.velocities()]);
    }

    fn magnitude(&self, y: &[R], k: usize) -> f64 {
        let n = self.model.n_v();
        if self.is_controlled_energy(k) {
            return self.energy_scale;
        }
        if k >= n {
            return y[k].lane(0).abs();
        }
        if self.model.has_scalar_coordinate(k) {
            return self.base[self.model.dofs[k].q_idx as usize].lane(0).abs();
        }
        1.0
    }
}

/// Copies numbers of which most models have none: the test costs less than the call.
#[inline(always)]
pub(crate) fn copy_any<R: Copy>(to: &mut [R], from: &[R]) {
    if !(to.is_empty() && from.is_empty()) {
        to.copy_from_slice(from);
    }
}

/// Commands of elements: `actuations` if an actuator has an activation.
#[inline(always)]
fn acting<'a, R: Real>(model: &Model<R>, commands: &'a [R], actuations: &'a [R]) -> &'a [R] {
    if model.activations.is_empty() { commands } else { actuations }
}
