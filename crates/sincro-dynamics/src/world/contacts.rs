//! Constraints within a tick: impacts at the start of a sub-step, events that end it, projection after it, and steps at
//! velocity level as a fallback for Zeno behaviour.

use sincro_complementarity::{WarmStart, ZenoFallback};

use super::switching::Law;
use super::{Method, Stop, World};
use crate::actuation::DriveKind;
use crate::coupled::{Coupled, CoupledSystem};
use crate::integrate::{Failure, FixedStep, SemiImplicitEuler};
use crate::mechanism::constraints::{ActivationRule, ProjectedRows};

/// Maximum number of successive impacts at one instant (propagation through a stack); the rest counts as inelastic.
const MAX_IMPACTS: usize = 50;

/// Number of contact events in one tick beyond which its rest is made at velocity level; where the tick before it was
/// made so, a smaller number is.
pub(super) const MAX_CONTACT_EVENTS: usize = 6000;
pub(super) const MAX_EVENTS_AGAIN: usize = 400;

/// Maximum number of times that a step at velocity level is made again because of what it passes.
const MAX_FORESIGHTS: usize = 4;

/// Number of steps at velocity level into which the rest of such a tick is divided.
const FINE_STEPS: u32 = 16;

impl World {
    /// Fallback for Zeno behaviour as of the last ticks.
    pub(super) fn zeno_fallback(&self) -> ZenoFallback {
        self.mechanism.constraints.as_ref().map_or_else(ZenoFallback::default, |c| c.memory.zeno_fallback())
    }

    pub(super) fn set_zeno_fallback(&mut self, zeno_fallback: ZenoFallback) {
        if let Some(constraints) = &mut self.mechanism.constraints {
            constraints.memory.set_zeno_fallback(zeno_fallback);
        }
    }

    /// Returns true if there are loop joints, gears, limits or contacts.
    pub(super) fn is_constrained(&self) -> bool {
        self.mechanism.constraints.is_some()
    }

    /// Returns true if the mechanism has constraints or limited drives, whose modes change the equations of motion.
    pub(super) fn switches(&self) -> bool {
        self.is_constrained() || self.has_limited_drives()
    }

    /// Returns true if friction hangs on the forces of contacts or bearings: only then can there be no finite forces
    /// that keep all laws (Painlevé).
    pub(super) fn has_friction_by_load(&self) -> bool {
        let model = self.model();
        !model.constraints().pairs.is_empty() || model.drives().iter().any(|drive| model.load_coefficient(drive) > 0.0)
    }

    /// Detects contacts and applies impacts until none is due.
    pub(super) fn resolve_impacts(&mut self) {
        if !self.is_constrained() {
            return;
        }
        let layout = self.layout();
        for _ in 0..MAX_IMPACTS {
            if !self.mechanism.detect_contacts(&self.y[layout.velocities()], ActivationRule::Touching).has_impact {
                return;
            }
            self.apply_impact();
        }
        self.mechanism.detect_contacts(&self.y[layout.velocities()], ActivationRule::Touching);
    }

    /// Applies an impact: rates jump; the totals get the energy lost and the impulses of ideal motors.
    pub(super) fn apply_impact(&mut self) {
        if !self.is_constrained() {
            return;
        }
        let layout = self.layout();
        self.mechanism.locked_mask.fill(0.0);
        for i in 0..self.target_velocities.len() {
            if self.is_unlimited(i) {
                self.mechanism.locked_mask[self.mechanism.model.params.drives[i].dof] = 1.0;
            }
        }
        let lost = self.mechanism.apply_impact(&mut self.y[layout.velocities()]);
        self.statistics.impacts += 1;
        if !layout.tracks_totals() {
            return;
        }
        self.y[layout.dissipation()] += lost;
        self.add_motor_impulses(Self::is_unlimited);
    }

    /// Projects onto the constraints after a sub-step, rates of sticking contacts included. Returns the work of the
    /// impulses that remove these rates `[J]`.
    pub(super) fn project(&mut self) -> f64 {
        if !self.is_constrained() {
            return 0.0;
        }
        self.mechanism.mark_locked();
        let projected = self.mechanism.project(&mut self.y, ProjectedRows::Sticking);
        self.statistics.event_work += projected.closing_work;
        if projected.has_impulses && self.layout().tracks_totals() {
            self.add_motor_impulses(|world, drive| world.mechanism.drives[drive] == 0.0);
        }
        projected.rate_work
    }

    /// Adds work and impulses of the motors chosen, whose velocities an impulse has left as they are, to the totals.
    fn add_motor_impulses(&mut self, is_chosen: impl Fn(&Self, usize) -> bool) {
        let layout = self.layout();
        for i in 0..self.target_velocities.len() {
            let drive = self.mechanism.model.params.drives[i];
            if let (DriveKind::Motor(motor), true) = (drive.kind, is_chosen(self, i)) {
                let impulse = self.mechanism.scratch.reaction[drive.dof];
                self.y[layout.work()] += impulse * self.y[layout.velocity(drive.dof)];
                self.y[layout.motor_impulse(motor)] += impulse;
            }
        }
    }

    /// Makes the rest of a tick, `span` from `t`, in steps at velocity level.
    pub(super) fn finish_at_velocity_level(
        &mut self,
        t: f64,
        span: f64,
        system: &mut dyn CoupledSystem<f64>,
    ) -> Result<(), (f64, Stop)> {
        self.statistics.fallback_ticks += 1;
        let h = span / f64::from(FINE_STEPS);
        self.statistics.fallback_square += f64::from(FINE_STEPS) * h * h;
        for k in 0..FINE_STEPS {
            self.velocity_level_step(t + f64::from(k) * h, h, &mut &mut *system)?;
        }
        Ok(())
    }

    /// Makes one step at velocity level: semi-implicit Euler, over the whole of which a limited drive either ends at
    /// its target velocity or is saturated, a contact stays closed or opens. Source: key `acary2008`, chapter 10
    /// (Moreau–Jean time-stepping).
    pub(super) fn velocity_level_step<A: CoupledSystem<f64>>(
        &mut self,
        t: f64,
        h: f64,
        system: &mut A,
    ) -> Result<(), (f64, Stop)> {
        let is_semi_implicit = matches!(self.method, Method::SemiImplicitEuler);
        self.mechanism.allow_rest(is_semi_implicit);
        // forces that were looked at are found already, by a problem that leaves nothing out
        let is_new = !core::mem::take(&mut self.knows_step_forces) || self.mechanism.is_all_at_rest();
        self.mechanism.forget_foreseen();
        let mut is_large = self.detect_step_contacts(h, is_semi_implicit && is_new);
        self.drives_before.clone_from(&self.mechanism.drives);
        self.try_step(t, h, is_large, system);
        if self.mechanism.has_woken() {
            // a force on what rests has changed
            is_large = self.undo_try(h);
            self.try_step(t, h, is_large, system);
        }
        is_large = self.sweep_unsolved(t, h, is_large, system);
        is_large = self.foresee(t, h, is_large, system);
        self.statistics.steps += 1;
        self.mechanism.contact_memory().into_iter().for_each(WarmStart::forget_start);
        if !self.y.iter().all(|x| x.is_finite()) {
            self.restore();
            return Err((t, Stop::Integration(Failure::NotFinite { t })));
        }
        let layout = self.layout();
        self.project_penetrations(is_large && is_semi_implicit);
        if is_large {
            // after the projection, which lays out the coordinates of all bodies anew
            self.mechanism.stop_quiet_motion(&self.base_before, &mut self.y[layout.velocities()]);
        }
        for i in 0..self.target_velocities.len() {
            if self.mechanism.drives[i] == 0.0 {
                self.y[layout.velocity(self.mechanism.model.params.drives[i].dof)] = self.target_velocities[i];
            }
        }
        // asked here, where it is known when compiled, not behind a call
        if system.zero_crossing_count().is_some() {
            self.handle_coupled_events(t + h, system)?;
        }
        Ok(())
    }

    /// Makes the step last tried again while it passes limits and contacts that nothing approached at its start: a blow
    /// moves what was at rest. They count as closed in the next try, which begins with the forces of the last one.
    /// Returns true if that was solved by sweeps.
    fn foresee<A: CoupledSystem<f64>>(&mut self, t: f64, h: f64, mut is_large: bool, system: &mut A) -> bool {
        let velocities = self.layout().velocities();
        for _ in 0..MAX_FORESIGHTS {
            if !self.mechanism.foresee(&self.y[velocities.clone()], h) {
                break;
            }
            self.return_to_step_start();
            is_large = self.detect_step_contacts(h, false);
            self.try_step(t, h, is_large, system);
            is_large = self.sweep_unsolved(t, h, is_large, system);
        }
        is_large
    }

    /// Makes the step last tried again by sweeps if it had few constraints whose modes were not found: sweeps need
    /// none. Returns true if it was solved by sweeps.
    fn sweep_unsolved<A: CoupledSystem<f64>>(&mut self, t: f64, h: f64, is_large: bool, system: &mut A) -> bool {
        let is_unsolved = !is_large && (self.has_unsolved_try() || self.leaves_drives_beyond_targets());
        if is_unsolved {
            self.undo_try(h);
            self.try_step(t, h, true, system);
        }
        is_large || is_unsolved
    }

    /// Goes back to the start of a step of length `h` as if it had not been tried, and detects its contacts anew, with
    /// everything that rests; returns true if they are solved by sweeps.
    fn undo_try(&mut self, h: f64) -> bool {
        self.return_to_step_start();
        self.mechanism.undo_classification();
        self.detect_step_contacts(h, false)
    }

    /// Goes back to state and modes of drives at the start of the step last tried.
    fn return_to_step_start(&mut self) {
        self.restore();
        self.mechanism.drives.copy_from_slice(&self.drives_before);
    }

    /// Returns true if the step last tried left a constraint problem unsolved that sweeps may solve.
    pub(super) fn has_unsolved_try(&self) -> bool {
        let unsolved = self.solver_report().map_or(0, |report| report.not_converged);
        unsolved > self.report_before.not_converged && self.mechanism.can_sweep()
    }

    /// Returns true if saturated drives have passed their targets in the step last tried, within the tolerance of its
    /// contacts, in a problem that sweeps may solve: they settle drives to rounding.
    fn leaves_drives_beyond_targets(&mut self) -> bool {
        self.mechanism.can_sweep()
            && self.mark_infeasible(Law::Velocity) > 0
            && self.kinks.list.iter().any(|kink| kink.infeasible && kink.saturation != 0.0)
    }

    /// Detects the contacts of a step of length `h` at velocity level; returns true if they make a problem that is
    /// solved by sweeps. Then islands at rest may be left out.
    fn detect_step_contacts(&mut self, h: f64, may_leave_out: bool) -> bool {
        if !self.is_constrained() {
            return false;
        }
        let velocities = self.layout().velocities();
        self.mechanism.detect_awake_contacts(&self.y[velocities.clone()], ActivationRule::Within(h), may_leave_out);
        let is_large = self.mechanism.is_large_contact_problem();
        if !is_large && self.mechanism.leaves_islands_out() {
            // few contacts are solved all together
            self.mechanism.undo_classification();
            self.mechanism.detect_contacts(&self.y[velocities], ActivationRule::Within(h));
        }
        is_large
    }

    /// Makes a step at velocity level with the contacts last detected, by sweeps if they are many (`is_large`), without
    /// what follows it: no projection, and nothing is looked at.
    fn try_step<A: CoupledSystem<f64>>(&mut self, t: f64, h: f64, is_large: bool, system: &mut A) {
        // a motor that a client has made a drive may be the first of its world
        let mut method = self.time_stepping.take().unwrap_or_else(|| SemiImplicitEuler::new(self.y.len()));
        self.mechanism.set_sweeps(is_large);
        self.save_step_start();
        let switches = self.switches();
        let is_compiled = !switches && self.compiled_step(h, system.acts());
        let mut step = |world: &mut Self| {
            if let Some(constraints) = &mut world.mechanism.constraints {
                constraints.sub_step = h;
            }
            let system = &mut Coupled {
                mechanism: &mut world.mechanism,
                system: &mut *system,
                negated_jacobian_diagonal: &mut world.negated_jacobian_diagonal,
            };
            method.step(system, t, h, &mut world.y);
        };
        if !switches {
            // no modes to decide: what is locked ends at its target velocity
            self.kinks.list.clear();
            if !is_compiled {
                self.mark_targets(h);
                step(self);
            }
        } else {
            self.solve_step_modes(h, |world| {
                world.restore();
                step(world);
            });
        }
        self.mechanism.set_sweeps(false);
        self.time_stepping = Some(method);
    }

    /// Returns true if the next step is one at velocity level with so many contacts that it is solved by sweeps, and
    /// has detected them then. Forces and accelerations are those of whole steps.
    pub(super) fn is_next_step_large(&mut self) -> bool {
        let is_time_stepping = matches!(self.method, Method::SemiImplicitEuler);
        if !is_time_stepping || !self.mechanism.can_have_many_contacts() {
            return false;
        }
        self.detect_next_step()
    }

    /// Detects the contacts of the next step; returns true if they make a problem that is solved by sweeps.
    pub(super) fn detect_next_step(&mut self) -> bool {
        self.mechanism.allow_rest(true);
        self.mechanism.forget_foreseen();
        self.detect_step_contacts(self.next_step, false)
    }

    /// Finds the forces of the next step from the present state with the contacts last detected, by sweeps, and stays
    /// there; the velocities at its end are left in `step_end_velocities`.
    pub(super) fn find_step_forces(&mut self, t: f64, system: &mut dyn CoupledSystem<f64>) {
        let layout = self.layout();
        self.drives_before.clone_from(&self.mechanism.drives);
        let (h, system) = (self.next_step, &mut { system });
        self.try_step(t, h, true, system);
        self.foresee(t, h, true, system);
        self.knows_step_forces = true;
        self.step_end_velocities.copy_from_slice(&self.y[layout.velocities()]);
        self.restore();
        if !self.step_end_velocities.iter().all(|v| v.is_finite()) {
            // a step that fails does so when it is made
            self.mechanism.load(&self.state, &mut self.y);
        }
    }

    /// Projects after a step at velocity level: penetrating contacts and loop joints.
    ///
    /// Sweeps have corrected the distances of contacts already: then loop joints and gears alone.
    fn project_penetrations(&mut self, is_large: bool) {
        if self.is_constrained() {
            let rows = if is_large { ProjectedRows::Bilateral } else { ProjectedRows::Penetrating };
            self.mechanism.mark_locked();
            self.mechanism.project(&mut self.y, rows);
        }
    }
}
