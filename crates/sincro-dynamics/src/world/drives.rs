//! Drives within a tick: velocity jumps at its start and at events.
//!
//! The law of a drive: [`crate::actuation::drive`]; the decision between its modes: [`super::switching`].

use super::World;
use crate::actuation::DriveKind;
use crate::coupled::CoupledSystem;
use crate::mechanism::Mechanism;

impl World {
    /// Latches the target velocity of each drive for a tick of length `h` `[s]`.
    pub(super) fn latch_target_velocities(&mut self, h: f64) {
        let Mechanism { model, commands, .. } = &self.mechanism;
        for (drive, target) in model.params.drives.iter().zip(&mut self.target_velocities) {
            *target = model.target_velocity_within(drive, self.mechanism.base(), commands, h);
        }
    }

    pub(super) fn is_unlimited(&self, drive: usize) -> bool {
        self.mechanism.model.drive_limit(&self.mechanism.model.params.drives[drive]).is_none()
    }

    /// Applies the velocity jumps at the start of a tick and resolves the modes of the drives after them.
    pub(super) fn start_tick(&mut self, t: f64, h: f64, system: &mut dyn CoupledSystem<f64>) {
        if self.mechanism.drives.is_empty() {
            return;
        }
        let jump = self.reach_target_velocities();
        if jump && self.is_constrained() {
            // it propagates through loop joints and contacts too
            self.apply_impact();
            self.resolve_impacts();
        }
        if !self.mechanism.couples_drives() {
            self.resolve_actuator_modes(t, h, system);
        }
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
    pub(super) fn apply_impulse(&mut self) -> bool {
        let layout = self.layout();
        let mut needed = false;
        self.mechanism.locked_mask.fill(0.0);
        self.mechanism.prescribed_acceleration.fill(0.0);
        for i in 0..self.target_velocities.len() {
            if self.jumps[i] || self.is_unlimited(i) {
                let dof = self.mechanism.model.params.drives[i].dof;
                let change = self.target_velocities[i] - self.velocity(dof);
                self.mechanism.locked_mask[dof] = 1.0;
                self.mechanism.prescribed_acceleration[dof] = change;
                needed |= change != 0.0;
            }
        }
        if needed {
            self.mechanism.impulse(&mut self.accelerations);
            for (v, change) in self.y[layout.velocities()].iter_mut().zip(&self.accelerations) {
                *v += *change;
            }
            self.add_impulses_to_totals();
        }
        for i in 0..self.target_velocities.len() {
            if self.jumps[i] {
                self.y[layout.velocity(self.mechanism.model.params.drives[i].dof)] = self.target_velocities[i];
            }
        }
        needed
    }

    /// Adds work and impulses of a velocity jump to the totals: ΔT = Σ λ·(mean of the velocities before and after).
    fn add_impulses_to_totals(&mut self) {
        let layout = self.layout();
        if !layout.tracks_totals() {
            return;
        }
        for (i, drive) in self.mechanism.model.params.drives.iter().enumerate() {
            if !self.jumps[i] && !self.is_unlimited(i) {
                continue;
            }
            let impulse = self.mechanism.scratch.reaction[drive.dof];
            let work = impulse * (self.target_velocities[i] - 0.5 * self.mechanism.prescribed_acceleration[drive.dof]);
            match drive.kind {
                DriveKind::Lock => {}
                DriveKind::Friction => self.y[layout.dissipation()] -= work,
                DriveKind::Motor(motor) => {
                    self.y[layout.work()] += work;
                    self.y[layout.motor_impulse(motor)] += impulse;
                }
            }
        }
    }

    pub(super) fn has_limited_drives(&self) -> bool {
        self.model().has_limited_drives()
    }

    /// Prescribes the accelerations by which locked drives reach their target velocity within `h`.
    pub(super) fn mark_targets(&mut self, h: f64) {
        if self.target_velocities.is_empty() {
            return;
        }
        self.mechanism.mark_locked();
        let layout = self.layout();
        for i in 0..self.target_velocities.len() {
            if self.mechanism.drives[i] == 0.0 {
                let dof = self.mechanism.model.params.drives[i].dof;
                self.mechanism.prescribed_acceleration[dof] =
                    (self.target_velocities[i] - self.before[layout.velocity(dof)]) / h;
            }
        }
    }
}
