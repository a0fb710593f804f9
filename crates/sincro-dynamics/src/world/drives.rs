//! Drives within a tick: velocity jumps at its start, events that end a sub-step.
//!
//! The law of a drive: [`crate::actuation::drive`]; the decision between its modes: [`super::switching`].

use super::{Stop, World};
use crate::actuation::DriveKind;
use crate::coupled::CoupledSystem;
use crate::integrate::Control;

/// Width to which the instant of an event is located, relative to the step.
const EVENT_RESOLUTION: f64 = 1e-13;

/// Distance of the instants within a step that are looked at where a law seems violated, relative to the step.
const INTERIOR_STEP: f64 = 0.125;

impl World {
    /// Latches the target velocity of each drive for this tick.
    pub(super) fn latch_target_velocities(&mut self) {
        for (i, drive) in self.mechanism.model.drives.iter().enumerate() {
            self.target_velocities[i] =
                self.mechanism.model.target_velocity(drive, self.mechanism.base(), &self.mechanism.commands);
        }
    }

    pub(super) fn is_unlimited(&self, drive: usize) -> bool {
        self.mechanism.model.drive_limit(&self.mechanism.model.drives[drive]).is_none()
    }

    /// Applies the velocity jumps at the start of a tick and resolves the modes of the drives after them.
    pub(super) fn start_tick<A: CoupledSystem<f64> + ?Sized>(&mut self, t: f64, h: f64, system: &mut A) {
        if self.mechanism.drives.is_empty() {
            return;
        }
        let jump = self.reach_target_velocities();
        if jump && self.is_constrained() {
            // it propagates through loop joints and contacts too
            self.apply_impact();
            self.resolve_impacts();
        }
        self.resolve_actuator_modes(t, h, system);
    }

    /// Brings unlimited motors to their target velocity at once; returns true if a velocity has jumped.
    fn reach_target_velocities(&mut self) -> bool {
        for i in 0..self.target_velocities.len() {
            self.jumps[i] = self.is_unlimited(i);
        }
        let jump = self.apply_impulse();
        for i in 0..self.target_velocities.len() {
            if self.jumps[i] {
                self.mechanism.drives[i] = 0.0;
            }
        }
        jump
    }

    /// Brings the drives marked in `jumps` to their target velocity by an impulse that leaves every other generalised
    /// momentum unchanged; unlimited motors keep their velocity. Returns true if there was an impulse.
    fn apply_impulse(&mut self) -> bool {
        let n = self.model().n_v();
        let mut needed = false;
        self.mechanism.locked_mask.fill(0.0);
        self.mechanism.prescribed_acceleration.fill(0.0);
        for i in 0..self.target_velocities.len() {
            if self.jumps[i] || self.is_unlimited(i) {
                let dof = self.mechanism.model.drives[i].dof;
                let change = self.target_velocities[i] - self.velocity(dof);
                self.mechanism.locked_mask[dof] = 1.0;
                self.mechanism.prescribed_acceleration[dof] = change;
                needed |= change != 0.0;
            }
        }
        if needed {
            self.mechanism.impulse(&mut self.accelerations);
            for k in 0..n {
                self.y[n + k] += self.accelerations[k];
            }
            self.add_impulses_to_totals();
        }
        for i in 0..self.target_velocities.len() {
            if self.jumps[i] {
                self.y[n + self.mechanism.model.drives[i].dof] = self.target_velocities[i];
            }
        }
        needed
    }

    /// Adds work and impulses of a velocity jump to the totals: ΔT = Σ λ·(mean of the velocities before and after).
    fn add_impulses_to_totals(&mut self) {
        let n = self.model().n_v();
        if !self.mechanism.tracks_totals() {
            return;
        }
        for (i, drive) in self.mechanism.model.drives.iter().enumerate() {
            if !self.jumps[i] && !self.is_unlimited(i) {
                continue;
            }
            let impulse = self.mechanism.scratch.reaction[drive.dof];
            let work = impulse * (self.target_velocities[i] - 0.5 * self.mechanism.prescribed_acceleration[drive.dof]);
            match drive.kind {
                DriveKind::Lock => {}
                DriveKind::Friction => self.y[2 * n + 1] -= work,
                DriveKind::Motor(motor) => {
                    let motor = motor.index();
                    self.y[2 * n] += work;
                    self.y[2 * n + 2 + motor] += impulse;
                }
            }
        }
    }

    pub(super) fn has_limited_drives(&self) -> bool {
        (0..self.target_velocities.len()).any(|i| !self.is_unlimited(i))
    }

    /// Zero crossing of drives and contacts: returns true if a saturated drive passed its target velocity, a locked one
    /// exceeds its limit, or a contact has changed.
    pub(super) fn has_event<A: CoupledSystem<f64> + ?Sized>(&mut self, t: f64, system: &mut A) -> bool {
        if (0..self.target_velocities.len()).any(|i| self.has_passed_target(i)) {
            return true;
        }
        let locked = self.mechanism.drives.contains(&0.0);
        if !locked && !self.is_constrained() {
            return false;
        }
        self.mechanism.mark_locked();
        self.evaluate_slope(t, system);
        (self.is_constrained() && self.has_contact_event()) || self.has_overload()
    }

    /// Time after `t` at which an event has happened `[s]`, none if there is none: at the end of the sub-step of length
    /// `h`, or at the earliest stage of it at which a law was violated (`violated` after `t`).
    pub(super) fn find_event<A: CoupledSystem<f64> + ?Sized>(
        &mut self,
        t: f64,
        h: f64,
        (reached, violated): (f64, f64),
        control: Option<Control>,
        system: &mut A,
    ) -> Result<Option<f64>, (f64, Stop)> {
        if self.has_event(reached, system) {
            return Ok(Some(h));
        }
        let violated = violated.min(self.find_passage(reached, h, system));
        if !(violated > 0.0 && violated < h) {
            return Ok(None);
        }
        // stage and cubic are estimates: what they told is looked at, and the rest of the step from there
        let mut at = violated;
        while at < h * (1.0 - 1e-6) {
            self.repeat_step(t, at, control, system)?;
            if self.has_event(t + at, system) {
                return Ok(Some(at));
            }
            at += INTERIOR_STEP * h;
        }
        self.repeat_step(t, h, control, system)?;
        Ok(None)
    }

    /// Earliest time within the sub-step at which a saturated drive seems to be beyond its target velocity `[s]`.
    fn find_passage<A: CoupledSystem<f64> + ?Sized>(&mut self, reached: f64, h: f64, system: &mut A) -> f64 {
        if self.mechanism.drives.iter().all(|saturation| *saturation == 0.0) {
            return f64::INFINITY;
        }
        self.evaluate_slope(reached, system);
        let n = self.model().n_v();
        self.mechanism.drive_monitor.passage(h, |i| {
            let dof = self.mechanism.model.drives[i].dof;
            (self.mechanism.drives[i], self.y[n + dof], self.slope[n + dof])
        })
    }

    /// Locates by bisection the first instant in (t, t + bad] at which a drive or contact changes mode, goes there and
    /// changes it; `h` is the length of the sub-step.
    pub(super) fn locate_event<A: CoupledSystem<f64> + ?Sized>(
        &mut self,
        t: f64,
        (bad, h): (f64, f64),
        control: Option<Control>,
        system: &mut A,
    ) -> Result<f64, (f64, Stop)> {
        let (mut good, mut bad) = (0.0, bad);
        // of the step's own time: t itself may be too coarse
        let resolution = h * EVENT_RESOLUTION;
        while bad - good > resolution {
            let middle = 0.5 * (good + bad);
            self.repeat_step(t, middle, control, system)?;
            if self.has_event(t + middle, system) { bad = middle } else { good = middle }
        }
        self.repeat_step(t, bad, control, system)?;
        // beyond the event the modes of the sub-step may fit no forces; those after it are found below
        let report = self.solver_report();
        self.evaluate_slope(t + bad, system);
        report.into_iter().for_each(|before| self.discard_failures(&before));
        // saturated drives that have just passed their target velocity, or reach it at the same instant, are brought to
        // it and locked ones kept there, momentum and impulses consistent
        let mut reached = false;
        for i in 0..self.target_velocities.len() {
            self.jumps[i] = self.has_passed_target(i) || self.reaches_target(i, resolution);
            reached |= self.jumps[i];
            self.jumps[i] |= self.mechanism.drives[i] == 0.0;
        }
        // under the modes of the sub-step: a contact that slid until now need not slip on when a drive has locked
        self.project();
        if reached {
            self.apply_impulse();
        }
        self.resolve_actuator_modes(t + bad, h, system);
        Ok(t + bad)
    }

    /// Prescribes the accelerations by which locked drives reach their target velocity within `h`.
    pub(super) fn mark_targets(&mut self, h: f64) {
        self.mechanism.mark_locked();
        let n = self.model().n_v();
        for i in 0..self.target_velocities.len() {
            if self.mechanism.drives[i] == 0.0 {
                let dof = self.mechanism.model.drives[i].dof;
                self.mechanism.prescribed_acceleration[dof] = (self.target_velocities[i] - self.before[n + dof]) / h;
            }
        }
    }
}
