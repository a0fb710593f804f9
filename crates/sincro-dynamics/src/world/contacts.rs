//! Constraints within a tick: impacts at the start of a sub-step, events that end it, projection after it, and steps at velocity level where events
//! come too thick.

use super::{Stop, World};
use crate::actuation::DriveKind;
use crate::constraint::warm_start::Patience;
use crate::coupled::{Attachment, Coupled};
use crate::integrate::{Failure, FixedStep, System};
use crate::mechanism::constraints::Closing;

/// Impacts in a row at one instant (a blow that runs through a stack) before what is left counts as inelastic.
const MAX_BLOWS: usize = 50;

/// Events of contacts in one tick beyond which the rest of it is done at velocity level.
pub(super) const MAX_CONTACT_EVENTS: usize = 400;

/// Steps at velocity level that the rest of such a tick is divided into.
const FINE_STEPS: u32 = 16;

impl World {
    /// How ticks with too many events were met lately.
    pub(super) fn patience(&self) -> Patience {
        self.mechanism.constraints.as_ref().map_or_else(Patience::default, |c| c.memory.patience())
    }

    pub(super) fn set_patience(&mut self, patience: Patience) {
        if let Some(constraints) = &mut self.mechanism.constraints {
            constraints.memory.set_patience(patience);
        }
    }

    /// Whether there are closures, limits or contacts.
    pub(super) fn is_constrained(&self) -> bool {
        self.mechanism.constraints.is_some()
    }

    /// Finds what touches and lets it bounce or come to rest.
    pub(super) fn touch(&mut self) {
        if !self.is_constrained() {
            return;
        }
        let n = self.model().n_v();
        for _ in 0..MAX_BLOWS {
            if !self.mechanism.touch(&self.y[n..2 * n], Closing::Touching).arrives {
                return;
            }
            self.collide();
        }
        self.mechanism.touch(&self.y[n..2 * n], Closing::Touching);
    }

    /// An impact: rates jump, the totals get what is lost and what ideal motors put in.
    pub(super) fn collide(&mut self) {
        if !self.is_constrained() {
            return;
        }
        let n = self.model().n_v();
        self.mechanism.held_mask.fill(0.0);
        for i in 0..self.wanted.len() {
            if self.is_unlimited(i) {
                self.mechanism.held_mask[self.mechanism.model.drives[i].dof] = 1.0;
            }
        }
        let lost = self.mechanism.collide(&mut self.y[n..2 * n]);
        self.effort.impacts += 1;
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
    pub(super) fn settle_contacts<A: Attachment<f64> + ?Sized>(&mut self, t: f64, attachment: &mut A) {
        if !self.is_constrained() {
            return;
        }
        self.mechanism.mark_held();
        self.find_slope(t, attachment);
        self.mechanism.mark_start();
    }

    /// Whether a limit or contact should have changed.
    pub(super) fn contact_is_violated(&mut self) -> bool {
        let n = self.model().n_v();
        self.mechanism.has_changed() || self.mechanism.has_touched(&self.y[n..2 * n])
    }

    /// Takes the drift of a sub-step away, sticking what sticks.
    pub(super) fn project(&mut self) {
        if self.is_constrained() {
            self.mechanism.mark_held();
            self.mechanism.project(&mut self.y, true);
        }
    }

    /// The rest of a tick, `span` from `t`, in steps at velocity level.
    pub(super) fn finish_roughly<A: Attachment<f64> + ?Sized>(
        &mut self,
        t: f64,
        span: f64,
        attachment: &mut A,
    ) -> Result<(), (f64, Stop)> {
        self.effort.rough_ticks += 1;
        let h = span / f64::from(FINE_STEPS);
        for k in 0..FINE_STEPS {
            self.rough_step(t + f64::from(k) * h, h, attachment)?;
        }
        Ok(())
    }

    /// One step of semi-implicit Euler, contacts at velocity level; drives are as they are.
    fn rough_step<A: Attachment<f64> + ?Sized>(
        &mut self,
        t: f64,
        h: f64,
        attachment: &mut A,
    ) -> Result<(), (f64, Stop)> {
        let n = self.model().n_v();
        self.effort.steps += 1;
        self.settle(t, attachment);
        self.mechanism.touch(&self.y[n..2 * n], Closing::Within(h));
        let own = self.mechanism.dim();
        let Some(fallback) = &mut self.fallback else { return Ok(()) };
        let system = &mut Coupled { mechanism: &mut self.mechanism, attachment, decay: &mut self.decay };
        fallback.step(system, t, h, &mut self.y);
        if !self.y[..own].iter().all(|x| x.is_finite()) {
            return Err((t, Stop::Integration(Failure::NotFinite { t })));
        }
        self.lift_out();
        Ok(())
    }

    /// After a step at velocity level: what presses and has gone in is brought out, closures are closed.
    pub(super) fn lift_out(&mut self) {
        if self.is_constrained() {
            self.mechanism.mark_held();
            self.mechanism.project(&mut self.y, false);
        }
    }
}
