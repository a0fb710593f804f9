//! Coupled systems: continuous states integrated together with a mechanism, which may command it between ticks, such as
//! a block diagram.
//!
//! The mechanism does not know the other system. At every evaluation the system is first asked for the commands at that
//! instant, then, with the accelerations that follow, for the derivatives of its own states. The joint state vector is
//! y = (mechanism's y, z).

use sincro_math::{Branches, Dual, Real};

use crate::integrate::{Implicit, SingularStages, System};
use crate::mechanism::Mechanism;
use crate::model::Model;
use crate::scratch::Scratch;

/// Continuous system integrated together with a mechanism, such as a block diagram that controls it: states z, commands
/// at every evaluation, derivatives of z. Given to [`World::advance_with`](crate::world::World::advance_with).
pub trait CoupledSystem<R: Real> {
    /// Continuous states z between steps, each in its own unit; the world reads them before a step and writes the new
    /// ones after it. Their number never changes.
    fn states(&mut self) -> &mut [R];

    /// Announces the time event at the end of the coming sub-step `[s]`, infinite if none is there: evaluations at that
    /// instant still belong to the time before it.
    fn set_time_event(&mut self, event: f64);

    /// Next time event: the first instant after `t` `[s]` at which the system is discontinuous because of time alone;
    /// infinite if there is none.
    fn next_time_event(&self, t: f64) -> f64;

    /// Writes the commands that the system determines at this instant with the states `z`. `commands` are all commands
    /// of the model (n_commands), each in the unit of its actuator; entries that are not written keep their values.
    fn find_commands(&mut self, state_view: &mut StateView<'_, R>, z: &[R], commands: &mut [R]);

    /// Writes the derivatives of `z` into `slope` (same length, units of `z` per second), given the accelerations and
    /// motor torques that follow from the commands just found.
    fn slope(
        &mut self,
        state_view: &mut StateView<'_, R>,
        response: MechanismResponse<'_, R>,
        z: &[R],
        slope: &mut [R],
    );

    /// Writes the diagonal of −∂f/∂z at the instant of the last [`CoupledSystem::slope`] `[1/s]`, one entry for each
    /// state, 0 where unknown; implicit methods evaluate these terms at the new state.
    fn negated_jacobian_diagonal(&mut self, negated_jacobian_diagonal: &mut [R]);

    /// Number of its zero-crossing functions, 0 if it has time events alone; `None` without events of its own, the
    /// default.
    fn zero_crossing_count(&self) -> Option<usize> {
        None
    }

    /// Computes the zero-crossing functions at the instant `t` `[s]` of the last [`CoupledSystem::slope`] into `values`
    /// (their number of entries): above zero where an event has happened since events were last handled, below zero
    /// where it has not.
    fn zero_crossings(&mut self, _t: f64, _values: &mut [R]) {}

    /// Ends an accepted step at the instant `t` `[s]` of the last [`CoupledSystem::slope`]: handles the events that
    /// have happened, which may change the states `z`. Returns true if there was one.
    fn handle_events(&mut self, _t: f64, _z: &mut [R]) -> bool {
        false
    }

    /// Returns false if it has no states and never writes a command: then it is asked for neither.
    fn acts(&self) -> bool {
        true
    }
}

impl<R: Real> CoupledSystem<R> for &mut (dyn CoupledSystem<R> + '_) {
    fn states(&mut self) -> &mut [R] {
        (**self).states()
    }

    fn set_time_event(&mut self, event: f64) {
        (**self).set_time_event(event);
    }

    fn next_time_event(&self, t: f64) -> f64 {
        (**self).next_time_event(t)
    }

    fn find_commands(&mut self, state_view: &mut StateView<'_, R>, z: &[R], commands: &mut [R]) {
        (**self).find_commands(state_view, z, commands);
    }

    fn slope(
        &mut self,
        state_view: &mut StateView<'_, R>,
        response: MechanismResponse<'_, R>,
        z: &[R],
        slope: &mut [R],
    ) {
        (**self).slope(state_view, response, z, slope);
    }

    fn negated_jacobian_diagonal(&mut self, negated_jacobian_diagonal: &mut [R]) {
        (**self).negated_jacobian_diagonal(negated_jacobian_diagonal);
    }

    fn zero_crossing_count(&self) -> Option<usize> {
        (**self).zero_crossing_count()
    }

    fn zero_crossings(&mut self, t: f64, values: &mut [R]) {
        (**self).zero_crossings(t, values);
    }

    fn handle_events(&mut self, t: f64, z: &mut [R]) -> bool {
        (**self).handle_events(t, z)
    }

    fn acts(&self) -> bool {
        (**self).acts()
    }
}

/// Mechanism at one instant, as a coupled system, sensor or controller sees it.
#[derive(Debug)]
pub struct StateView<'a, R> {
    /// Time `[s]`.
    pub t: f64,
    /// Model, which gives the order of the vectors below.
    pub model: &'a Model<R>,
    /// Coordinates `[rad]`, `[m]`, quaternions (w, x, y, z); n_q.
    pub q: &'a [R],
    /// Velocities `[rad/s]`, `[m/s]`; n_v.
    pub v: &'a [R],
    /// Rotor states, as [`State::rotors`](crate::state::State::rotors) has them: speeds `[rad/s]`, mass flows `[kg/s]`.
    pub rotors: &'a [R],
    /// Commands last given, each in the unit of its actuator (n_commands); empty while they are being written.
    pub commands: &'a [R],
    /// Working memory for kinematics; its content is undefined until poses or motions are computed in it.
    pub scratch: &'a mut Scratch<R>,
}

/// Response of the mechanism to the commands just found, argument of [`CoupledSystem::slope`].
#[derive(Clone, Copy, Debug)]
pub struct MechanismResponse<'a, R> {
    /// Accelerations `[rad/s²]`, `[m/s²]`; n_v.
    pub accelerations: &'a [R],
    /// Smooth torque of each motor `[N·m]` or `[N]`, in the order of the motors; empty unless totals are tracked.
    pub motor_torque: &'a [R],
}

/// Coupled system without states that leaves all commands as they are: for a mechanism alone.
#[derive(Clone, Copy, Debug)]
pub struct NoCoupling;

impl<R: Real> CoupledSystem<R> for NoCoupling {
    fn states(&mut self) -> &mut [R] {
        &mut []
    }
    fn set_time_event(&mut self, _: f64) {}
    fn next_time_event(&self, _: f64) -> f64 {
        f64::INFINITY
    }
    #[inline(always)]
    fn find_commands(&mut self, _: &mut StateView<'_, R>, _: &[R], _: &mut [R]) {}
    #[inline(always)]
    fn slope(&mut self, _: &mut StateView<'_, R>, _: MechanismResponse<'_, R>, _: &[R], _: &mut [R]) {}
    fn negated_jacobian_diagonal(&mut self, _: &mut [R]) {}
    #[inline(always)]
    fn acts(&self) -> bool {
        false
    }
}

/// Number of one lane for which the equations of a coupled mechanism are compiled in this crate. A generic function is
/// compiled again by each crate that uses it; one that evaluates the equations through this trait is not.
pub trait CompiledNumber: Real {
    /// Writes the derivatives of all unknowns y at time `t` `[s]` into `slope` (same length).
    fn evaluate(coupled: &mut Coupled<'_, Self, dyn CoupledSystem<Self> + '_>, t: f64, y: &[Self], slope: &mut [Self]);
}

impl CompiledNumber for f64 {
    fn evaluate(coupled: &mut Coupled<'_, Self, dyn CoupledSystem<Self> + '_>, t: f64, y: &[Self], slope: &mut [Self]) {
        coupled.slope(t, y, slope);
    }
}

impl CompiledNumber for Dual<1> {
    fn evaluate(coupled: &mut Coupled<'_, Self, dyn CoupledSystem<Self> + '_>, t: f64, y: &[Self], slope: &mut [Self]) {
        coupled.slope(t, y, slope);
    }
}

/// State view of a mechanism at the coordinates last placed and the velocities in `y`.
#[inline(always)]
fn state_view<'a, R: Real>(mechanism: &'a mut Mechanism<R>, t: f64, y: &'a [R]) -> StateView<'a, R> {
    let layout = mechanism.layout();
    let (v, rotors) = (&y[layout.velocities()], &y[layout.rotor_states()]);
    let (model, q, commands) = (&mechanism.model, &*mechanism.q, &*mechanism.commands);
    StateView { t, model, q, v, rotors, commands, scratch: &mut mechanism.scratch }
}

/// Mechanism and coupled system as one [`System`] for an integrator, with the unknowns y = (mechanism's y, z).
#[derive(Debug)]
pub struct Coupled<'a, R, A: ?Sized> {
    /// Mechanism, with the commands that the system writes.
    pub mechanism: &'a mut Mechanism<R>,
    /// Coupled system.
    pub system: &'a mut A,
    /// Working memory for the diagonal of −∂f/∂z `[1/s]`; its length is the number of states z.
    pub negated_jacobian_diagonal: &'a mut [R],
}

impl<R: Real, A: CoupledSystem<R> + ?Sized> Coupled<'_, R, A> {
    #[inline(always)]
    fn find_commands(&mut self, t: f64, own: &[R], z: &[R]) {
        let mut commands = core::mem::take(&mut self.mechanism.commands);
        self.system.find_commands(&mut state_view(self.mechanism, t, own), z, &mut commands);
        self.mechanism.commands = commands;
    }

    #[inline(always)]
    fn rates(&mut self, t: f64, own: &[R], own_slope: &[R], z: &[R], slope: &mut [R]) {
        let torques = self.mechanism.take_motor_torque();
        let response = MechanismResponse {
            accelerations: &own_slope[self.mechanism.layout().velocities()],
            motor_torque: &torques,
        };
        self.system.slope(&mut state_view(self.mechanism, t, own), response, z, slope);
        self.mechanism.put_motor_torque(torques);
    }
}

impl<R: Real, A: CoupledSystem<R> + ?Sized> System<R> for Coupled<'_, R, A> {
    #[inline(always)]
    fn dim(&self) -> usize {
        self.mechanism.dim() + self.negated_jacobian_diagonal.len()
    }

    #[inline(always)]
    fn is_controlled(&self, k: usize) -> bool {
        k >= self.mechanism.dim() || self.mechanism.is_controlled(k)
    }

    #[inline(always)]
    fn slope(&mut self, t: f64, y: &[R], slope: &mut [R]) {
        // one call of the mechanism's slope, which is inlined: large code
        let acts = self.system.acts();
        let (own, z) = y.split_at(self.mechanism.dim());
        let (own_slope, z_slope) = slope.split_at_mut(own.len());
        if acts {
            self.mechanism.set_coordinates(own);
            self.find_commands(t, own, z);
        }
        self.mechanism.slope(t, own, own_slope);
        if acts {
            self.rates(t, own, own_slope, z, z_slope);
        }
    }

    #[inline(always)]
    fn implicit_slope(&mut self, t: f64, h: f64, implicit: Implicit, y: &[R], slope: &mut [R]) {
        let acts = self.system.acts();
        let (own, z) = y.split_at(self.mechanism.dim());
        let (own_slope, z_slope) = slope.split_at_mut(own.len());
        if acts {
            self.mechanism.set_coordinates(own);
            self.find_commands(t, own, z);
        }
        self.mechanism.implicit_slope(t, h, implicit, own, own_slope);
        if z.is_empty() {
            return;
        }
        self.rates(t, own, own_slope, z, z_slope);
        self.system.negated_jacobian_diagonal(self.negated_jacobian_diagonal);
        for (slope, negated_jacobian_diagonal) in z_slope.iter_mut().zip(&*self.negated_jacobian_diagonal) {
            *slope = *slope / (R::one() + R::splat(h) * *negated_jacobian_diagonal);
        }
    }

    fn begin_step(&mut self) {
        self.mechanism.begin_step();
    }

    fn singular_stages(&self) -> SingularStages {
        self.mechanism.singular_stages()
    }

    fn branches(&mut self, y: &[R]) -> Option<Branches> {
        self.mechanism.branches(&y[..self.mechanism.dim()])
    }

    fn project_error(&mut self, y: &[R], error: &mut [R]) {
        let n = self.mechanism.dim();
        self.mechanism.project_error(&y[..n], &mut error[..n]);
    }

    #[inline(always)]
    fn rechart(&mut self, y: &mut [R]) {
        let n = self.mechanism.dim();
        self.mechanism.rechart(&mut y[..n]);
    }

    #[inline(always)]
    fn rechart_at_velocity_level(&mut self, y: &mut [R]) {
        let n = self.mechanism.dim();
        self.mechanism.rechart_at_velocity_level(&mut y[..n]);
    }

    fn magnitude(&self, y: &[R], k: usize) -> f64 {
        let n = self.mechanism.dim();
        if k < n { self.mechanism.magnitude(&y[..n], k) } else { y[k].lane(0).abs() }
    }
}
