//! Drives within a tick: velocity jumps at its start, locked and saturated modes, events that end a sub-step.
//!
//! The law of a drive: [`crate::actuation::drive`].

use super::{Stop, World};
use crate::actuation::DriveKind;
use crate::coupled::CoupledSystem;
use crate::integrate::Control;

/// Relative width below which two velocities count as equal.
const SAME_VELOCITY: f64 = 1e-12;

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
    pub(super) fn start_tick<A: CoupledSystem<f64> + ?Sized>(&mut self, t: f64, system: &mut A) {
        if self.mechanism.drives.is_empty() {
            return;
        }
        self.reach_target_velocities();
        if self.is_constrained() {
            // the jump propagates through loop joints and contacts too
            self.apply_impact();
            self.resolve_impacts();
        }
        self.resolve_actuator_modes(t, system);
    }

    /// Brings unlimited motors to their target velocity at once.
    fn reach_target_velocities(&mut self) {
        for i in 0..self.target_velocities.len() {
            self.jumps[i] = self.is_unlimited(i);
        }
        self.apply_impulse();
        for i in 0..self.target_velocities.len() {
            if self.jumps[i] {
                self.mechanism.drives[i] = 0.0;
            }
        }
    }

    /// Brings the drives marked in `jumps` to their target velocity by an impulse that leaves every other generalised
    /// momentum unchanged; unlimited motors keep their velocity.
    fn apply_impulse(&mut self) {
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

    /// Resolves the mode of each limited drive: those at their target velocity are locked if their limit allows it.
    pub(super) fn resolve_actuator_modes<A: CoupledSystem<f64> + ?Sized>(&mut self, t: f64, system: &mut A) {
        for i in 0..self.target_velocities.len() {
            if !self.is_unlimited(i) {
                let missing = self.velocity_error(i);
                self.mechanism.drives[i] = if missing == 0.0 { 0.0 } else { missing.signum() };
            }
        }
        self.mechanism.mark_locked();
        if !self.has_limited_drives() {
            return;
        }
        for _ in 0..=self.target_velocities.len() {
            self.mechanism.mark_locked();
            self.evaluate_slope(t, system);
            if !self.saturate_overloaded() {
                return;
            }
        }
    }

    /// Velocity error of a drive, target minus present velocity, zero within rounding.
    fn velocity_error(&self, i: usize) -> f64 {
        let v = self.velocity(self.mechanism.model.drives[i].dof);
        let missing = self.target_velocities[i] - v;
        if missing.abs() <= SAME_VELOCITY * self.target_velocities[i].abs().max(v.abs()).max(1e-3) {
            0.0
        } else {
            missing
        }
    }

    /// Saturates the locked drives whose reaction in the last evaluation exceeds their limit; returns true if there
    /// were any.
    fn saturate_overloaded(&mut self) -> bool {
        let mut released = false;
        for i in 0..self.target_velocities.len() {
            if let Some(reaction) = self.overload(i) {
                self.mechanism.drives[i] = reaction.signum();
                released = true;
            }
        }
        released
    }

    /// Reaction on a locked drive, if the drives that lock its joint cannot give it together.
    fn overload(&self, i: usize) -> Option<f64> {
        if self.mechanism.drives[i] != 0.0 {
            return None;
        }
        let dof = self.mechanism.model.drives[i].dof;
        let mut limit = 0.0;
        for (drive, saturation) in self.mechanism.model.drives.iter().zip(&self.mechanism.drives) {
            if drive.dof == dof && *saturation == 0.0 {
                limit += self.mechanism.model.drive_limit(drive)?;
            }
        }
        let reaction = self.mechanism.scratch.reaction[dof];
        (reaction.abs() > limit * (1.0 + 1e-12)).then_some(reaction)
    }

    pub(super) fn has_limited_drives(&self) -> bool {
        (0..self.target_velocities.len()).any(|i| !self.is_unlimited(i))
    }

    /// Zero crossing of drives and contacts: returns true if a saturated drive passed its target velocity, a locked one
    /// exceeds its limit, or a contact has changed.
    pub(super) fn has_event<A: CoupledSystem<f64> + ?Sized>(&mut self, t: f64, system: &mut A) -> bool {
        let crossed = (0..self.target_velocities.len()).any(|i| {
            let saturation = self.mechanism.drives[i];
            !self.is_unlimited(i) && saturation != 0.0 && self.velocity_error(i) * saturation < 0.0
        });
        if crossed {
            return true;
        }
        if self.is_constrained() {
            self.mechanism.mark_locked();
            self.evaluate_slope(t, system);
            return self.has_contact_event() || (0..self.target_velocities.len()).any(|i| self.overload(i).is_some());
        }
        if self.mechanism.drives.iter().all(|saturation| *saturation != 0.0) {
            return false;
        }
        self.evaluate_slope(t, system);
        (0..self.target_velocities.len()).any(|i| self.overload(i).is_some())
    }

    /// Locates by bisection the first instant in (t, t + h] at which a drive or contact changes mode, goes there and
    /// changes it.
    pub(super) fn locate_event<A: CoupledSystem<f64> + ?Sized>(
        &mut self,
        t: f64,
        h: f64,
        control: Option<Control>,
        system: &mut A,
    ) -> Result<f64, (f64, Stop)> {
        let (mut good, mut bad) = (0.0, h);
        let resolution = (h * 1e-13).max(4.0 * f64::EPSILON * t.abs());
        while bad - good > resolution {
            let middle = 0.5 * (good + bad);
            self.repeat_step(t, middle, control, system)?;
            if self.has_event(t + middle, system) { bad = middle } else { good = middle }
        }
        self.repeat_step(t, bad, control, system)?;
        // a saturated drive that has just passed its target velocity is brought back to it, momentum and impulses kept
        // consistent
        for i in 0..self.target_velocities.len() {
            let saturation = self.mechanism.drives[i];
            self.jumps[i] = !self.is_unlimited(i) && saturation != 0.0 && self.velocity_error(i) * saturation < 0.0;
        }
        if self.jumps.contains(&true) {
            self.apply_impulse();
        }
        self.resolve_actuator_modes(t + bad, system);
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

    /// Updates the modes after a trial step: overloaded drives saturate, drives that passed their target velocity lock;
    /// returns true if any changed.
    pub(super) fn update_drive_modes(&mut self) -> bool {
        if self.saturate_overloaded() {
            return true;
        }
        let mut changed = false;
        for i in 0..self.target_velocities.len() {
            let saturation = self.mechanism.drives[i];
            if saturation != 0.0 && self.velocity_error(i) * saturation <= 0.0 {
                self.mechanism.drives[i] = 0.0;
                changed = true;
            }
        }
        changed
    }
}
