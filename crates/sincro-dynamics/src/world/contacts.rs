//! Constraints within a tick: impacts at the start of a sub-step, events that end it, projection after it, and steps at velocity level where events
//! come too thick.

use super::{Stop, World};
use crate::actuation::DriveKind;
use crate::constraint::warm_start::ZenoFallback;
use crate::coupled::{Coupled, CoupledSystem};
use crate::integrate::{Failure, FixedStep, System};
use crate::mechanism::constraints::ActivationRule;

/// Impacts in a row at one instant (a blow that runs through a stack) before what is left counts as inelastic.
const MAX_IMPACTS: usize = 50;

/// Events of contacts in one tick beyond which the rest of it is done at velocity level.
pub(super) const MAX_CONTACT_EVENTS: usize = 400;

/// Steps at velocity level that the rest of such a tick is divided into.
const FINE_STEPS: u32 = 16;

impl World {
    /// How ticks with too many events were met lately.
    pub(super) fn zeno_fallback(&self) -> ZenoFallback {
        self.mechanism.constraints.as_ref().map_or_else(ZenoFallback::default, |c| c.memory.zeno_fallback())
    }

    pub(super) fn set_patience(&mut self, zeno_fallback: ZenoFallback) {
        if let Some(constraints) = &mut self.mechanism.constraints {
            constraints.memory.set_patience(zeno_fallback);
        }
    }

    /// Whether there are closures, limits or contacts.
    pub(super) fn is_constrained(&self) -> bool {
        self.mechanism.constraints.is_some()
    }

    /// Finds what touches and lets it bounce or come to rest.
    pub(super) fn resolve_impacts(&mut self) {
        if !self.is_constrained() {
            return;
        }
        let n = self.model().n_v();
        for _ in 0..MAX_IMPACTS {
            if !self.mechanism.detect_contacts(&self.y[n..2 * n], ActivationRule::Touching).has_impact {
                return;
            }
            self.apply_impact();
        }
        self.mechanism.detect_contacts(&self.y[n..2 * n], ActivationRule::Touching);
    }

    /// An impact: rates jump, the totals get what is lost and what ideal motors put in.
    pub(super) fn apply_impact(&mut self) {
        if !self.is_constrained() {
            return;
        }
        let n = self.model().n_v();
        self.mechanism.locked_mask.fill(0.0);
        for i in 0..self.target_velocities.len() {
            if self.is_unlimited(i) {
                self.mechanism.locked_mask[self.mechanism.model.drives[i].dof] = 1.0;
            }
        }
        let lost = self.mechanism.apply_impact(&mut self.y[n..2 * n]);
        self.statistics.impacts += 1;
        if self.mechanism.dim() == 2 * n {
            return;
        }
        self.y[2 * n + 1] += lost;
        for (i, drive) in self.mechanism.model.drives.iter().enumerate() {
            let DriveKind::Motor(motor) = drive.kind else { continue };
            if self.is_unlimited(i) {
                let impulse = self.mechanism.scratch.reaction[drive.dof];
                self.y[2 * n] += impulse * self.y[n + drive.dof];
                self.y[2 * n + 2 + motor] += impulse;
            }
        }
    }

    /// Forces at the start of a sub-step, after everything has been classified; drift is taken away.
    pub(super) fn resolve_contact_modes<A: CoupledSystem<f64> + ?Sized>(&mut self, t: f64, system: &mut A) {
        if !self.is_constrained() {
            return;
        }
        self.mechanism.mark_locked();
        self.evaluate_slope(t, system);
        self.mechanism.mark_start();
    }

    /// Whether a limit or contact should have changed.
    pub(super) fn has_contact_event(&mut self) -> bool {
        let n = self.model().n_v();
        self.mechanism.has_changed() || self.mechanism.has_new_contact(&self.y[n..2 * n])
    }

    /// Takes the drift of a sub-step away, sticking what sticks.
    pub(super) fn project(&mut self) {
        if self.is_constrained() {
            self.mechanism.mark_locked();
            self.mechanism.project(&mut self.y, true);
        }
    }

    /// The rest of a tick, `span` from `t`, in steps at velocity level.
    pub(super) fn finish_at_velocity_level<A: CoupledSystem<f64> + ?Sized>(
        &mut self,
        t: f64,
        span: f64,
        system: &mut A,
    ) -> Result<(), (f64, Stop)> {
        self.statistics.fallback_ticks += 1;
        let h = span / f64::from(FINE_STEPS);
        for k in 0..FINE_STEPS {
            self.velocity_level_step(t + f64::from(k) * h, h, system)?;
        }
        Ok(())
    }

    /// One step of semi-implicit Euler, contacts at velocity level; drives are as they are.
    fn velocity_level_step<A: CoupledSystem<f64> + ?Sized>(
        &mut self,
        t: f64,
        h: f64,
        system: &mut A,
    ) -> Result<(), (f64, Stop)> {
        let n = self.model().n_v();
        self.statistics.steps += 1;
        self.resolve_actuator_modes(t, system);
        self.mechanism.detect_contacts(&self.y[n..2 * n], ActivationRule::Within(h));
        let own = self.mechanism.dim();
        let Some(fallback) = &mut self.fallback else { return Ok(()) };
        let system = &mut Coupled {
            mechanism: &mut self.mechanism,
            system,
            negated_jacobian_diagonal: &mut self.negated_jacobian_diagonal,
        };
        fallback.step(system, t, h, &mut self.y);
        if !self.y[..own].iter().all(|x| x.is_finite()) {
            return Err((t, Stop::Integration(Failure::NotFinite { t })));
        }
        self.project_penetrations();
        Ok(())
    }

    /// After a step at velocity level: what presses and has gone in is brought out, closures are closed.
    pub(super) fn project_penetrations(&mut self) {
        if self.is_constrained() {
            self.mechanism.mark_locked();
            self.mechanism.project(&mut self.y, false);
        }
    }
}
