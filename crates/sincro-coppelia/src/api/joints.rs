//! Joints with one coordinate: positions, velocities, motors and their commands.
//!
//! V-REP's motors in the words of this program: motor off is `free`, velocity control `velocity`, position control
//! `position`, spring-damper control `spring`, force control `torque`. A target that the present mode does not use is
//! kept for when the mode changes.

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::joint::JointKind;

use super::registry::{Handle, JointEntry};
use super::{ApiError, SimApi};

/// Velocity a unit of error of a motor that becomes a position motor and has no gain: that of V-REP's default P = 0.1
/// in steps of 5 ms [1/s].
pub(super) const POSITION_GAIN: f64 = 20.0;

impl SimApi<'_> {
    /// Position of a joint with one coordinate: `[rad]`, `[m]` if it is prismatic. That of a revolute joint without
    /// limits is brought into (−π, π], as in V-REP.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or no joint with exactly one coordinate (a rotor has a speed only); the message names it.
    pub fn joint_position(&self, handle: Handle) -> Result<f64, ApiError> {
        let q = self.world.state.q[self.registry.joint(handle)?.q_idx];
        Ok(if self.joint_interval(handle)?.0 { within_a_turn(q) } else { q })
    }

    /// Puts a joint with one coordinate at a position, `[rad]` or, if it is prismatic, `[m]`, at once; its velocity
    /// stays. The motor of a hybrid joint takes it there while a run is on. In a run the change of the energy counts as
    /// work. For a motor's setpoint use [`SimApi::set_target_position`].
    ///
    /// # Errors
    ///
    /// `handle` is no object or no joint with one coordinate, or the position is not finite.
    pub fn set_joint_position(&mut self, handle: Handle, position: f64) -> Result<(), ApiError> {
        if self.is_running() && self.is_hybrid(handle) {
            return self.set_target_position(handle, position);
        }
        let (q_idx, position) = (self.registry.joint(handle)?.q_idx, finite(position, "position")?);
        self.count_as_work(|sim| sim.world.state.q[q_idx] = position);
        Ok(())
    }

    /// Velocity of a joint with one coordinate, or speed of a rotor: `[rad/s]`, `[m/s]` if it is prismatic.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or neither a joint with one coordinate nor a rotor.
    pub fn joint_velocity(&self, handle: Handle) -> Result<f64, ApiError> {
        if let Some(rotor) = self.rotor(handle)? {
            return Ok(self.rotor_speed(rotor));
        }
        Ok(self.world.state.v[self.registry.joint(handle)?.v_idx])
    }

    /// Sets the velocity of a joint with one coordinate, `[rad/s]` or, if it is prismatic, `[m/s]`, at once; its
    /// position stays. For a motor's setpoint use [`SimApi::set_target_velocity`].
    ///
    /// # Errors
    ///
    /// `handle` is no object or no joint with one coordinate, or the velocity is not finite.
    pub fn set_joint_velocity(&mut self, handle: Handle, velocity: f64) -> Result<(), ApiError> {
        let (v_idx, velocity) = (self.registry.joint(handle)?.v_idx, finite(velocity, "velocity")?);
        self.count_as_work(|sim| sim.world.state.v[v_idx] = velocity);
        Ok(())
    }

    /// Force or torque that V-REP reports for a joint: **minus** the mean effort of its motor over the last step of
    /// clients, `[N·m]` or, if it is prismatic, `[N]`. None before the first step of a run, and for a joint without
    /// motor.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or no joint with one coordinate.
    pub fn joint_force(&self, handle: Handle) -> Result<Option<f64>, ApiError> {
        let joint = self.registry.joint(handle)?;
        let Some(motor) = joint.motor else { return Ok(None) };
        let before = self.registry.impulse_before(motor);
        Ok(before.map(|before| (before - self.world.state.totals[2 + motor]) / self.registry.sample_time()))
    }

    /// Present parameters of the motor of a joint, in SI units; none without motor. Of a joint whose mode is not
    /// dynamic they are those that it will have in the dynamic mode.
    ///
    /// # Errors
    ///
    /// There is no such joint.
    pub(crate) fn joint_motor(&self, handle: Handle) -> Result<Option<Motor<f64>>, ApiError> {
        Ok(self.kept_motor(handle).or(self.registry.joint(handle)?.drive))
    }

    /// Mode of the motor that drives a joint at present: also of a joint whose mode is not dynamic.
    ///
    /// # Errors
    ///
    /// There is no such joint.
    pub(super) fn driving_mode(&self, handle: Handle) -> Result<MotorMode, ApiError> {
        Ok(self.registry.joint(handle)?.drive.map_or(MotorMode::Free, |motor| motor.mode))
    }

    /// Mode of the motor of a joint: [`MotorMode::Free`] without motor, [`MotorMode::Velocity`] for a rotor.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or neither a joint with one coordinate nor a rotor.
    pub fn joint_mode(&self, handle: Handle) -> Result<MotorMode, ApiError> {
        if self.rotor(handle)?.is_some() {
            return Ok(MotorMode::Velocity);
        }
        if let Some(mode) = self.parked_mode(handle) {
            return Ok(mode);
        }
        Ok(self.joint_motor(handle)?.map_or(MotorMode::Free, |m| m.mode))
    }

    /// Changes the mode of the motor of a joint; targets of all modes are kept for when it changes back. A motor that
    /// becomes a position motor and has no gain gets 20 1/s.
    ///
    /// # Errors
    ///
    /// `handle` is no object or no joint with one coordinate, or the joint has no motor (give it one in the scene).
    pub fn set_joint_mode(&mut self, handle: Handle, mode: MotorMode) -> Result<(), ApiError> {
        if self.parked_mode(handle).is_some() {
            return self.set_parked_mode(handle, mode, POSITION_GAIN);
        }
        self.change_motor(handle, |motor| {
            motor.mode = mode;
            if mode == MotorMode::Position && motor.kp == 0.0 {
                motor.kp = POSITION_GAIN;
            }
        })?;
        self.command(handle)
    }

    /// Changes the numbers of a motor: limit, gains. Its targets are kept. In another mode than the dynamic one they
    /// act when the joint is dynamic again, in a hybrid one at once, too.
    ///
    /// # Errors
    ///
    /// There is no such joint, it has no motor, or a number is negative or not a number.
    pub(crate) fn change_motor(
        &mut self,
        handle: Handle,
        change: impl FnOnce(&mut Motor<f64>),
    ) -> Result<(), ApiError> {
        match self.kept_motor(handle) {
            Some(_) => self.change_kept_motor(handle, change),
            None => self.change_driving_motor(handle, change),
        }
    }

    /// Changes the motor that drives a joint at present.
    ///
    /// # Errors
    ///
    /// As of [`SimApi::change_motor`].
    pub(super) fn change_driving_motor(
        &mut self,
        handle: Handle,
        change: impl FnOnce(&mut Motor<f64>),
    ) -> Result<(), ApiError> {
        let joint = self.registry.joint_mut(handle)?;
        let (Some(index), Some(mut motor)) = (joint.motor, joint.drive) else { return Err(self.without_motor(handle)) };
        change(&mut motor);
        check_motor(&motor)?;
        self.registry.joint_mut(handle)?.drive = Some(motor);
        self.world.set_motor(sincro_dynamics::ids::MotorId::new(index), motor);
        self.moved();
        Ok(())
    }

    /// Velocity setpoint of a joint or rotor, `[rad/s]` or, if it is prismatic, `[m/s]`: that of a client or script,
    /// else that of the scene; 0 if the motor is not in velocity mode and nobody has set one.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or neither a joint with one coordinate nor a rotor.
    pub fn target_velocity(&self, handle: Handle) -> Result<f64, ApiError> {
        if let Some(rotor) = self.rotor(handle)? {
            return Ok(self.rotor_target(rotor));
        }
        let joint = self.registry.joint(handle)?;
        Ok(joint.target_velocity.unwrap_or_else(|| self.commanded(joint, MotorMode::Velocity)))
    }

    /// Sets the velocity setpoint of a joint's motor or of a rotor, `[rad/s]` or, if the joint is prismatic, `[m/s]`.
    /// It acts from the next step on; a motor in another mode keeps it for when its mode changes.
    ///
    /// # Errors
    ///
    /// `handle` is no object or no joint with one coordinate, the joint has no motor, or the velocity is not finite.
    pub fn set_target_velocity(&mut self, handle: Handle, velocity: f64) -> Result<(), ApiError> {
        if let Some(rotor) = self.rotor(handle)? {
            return self.set_rotor_target(rotor, finite(velocity, "target velocity")?);
        }
        self.joint_with_motor(handle)?.target_velocity = Some(finite(velocity, "target velocity")?);
        self.command(handle)
    }

    /// Position setpoint of a joint, `[rad]` or, if it is prismatic, `[m]`: that of a client or script, else that of
    /// the scene; 0 if the motor is neither in position nor in spring mode and nobody has set one.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or no joint with one coordinate.
    pub fn target_position(&self, handle: Handle) -> Result<f64, ApiError> {
        let joint = self.registry.joint(handle)?;
        let of_scene = || match joint.drive.map(|m| m.mode) {
            Some(mode @ (MotorMode::Position | MotorMode::Spring)) => self.commanded(joint, mode),
            _ => 0.0,
        };
        Ok(joint.target_position.unwrap_or_else(of_scene))
    }

    /// Sets the position setpoint of a joint's motor, `[rad]` or, if the joint is prismatic, `[m]`. It acts from the
    /// next step on; a motor that is neither in position nor in spring mode keeps it for when its mode changes.
    ///
    /// # Errors
    ///
    /// `handle` is no object or no joint with one coordinate, the joint has no motor, or the position is not finite.
    pub fn set_target_position(&mut self, handle: Handle, position: f64) -> Result<(), ApiError> {
        self.joint_with_motor(handle)?.target_position = Some(finite(position, "target position")?);
        self.command(handle)
    }

    /// Effort setpoint of a motor in torque mode, else the largest effort that the motor may use: `[N·m]`, `[N]` if the
    /// joint is prismatic. Infinite for a motor without limit, 0 for a joint without motor.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or no joint with one coordinate.
    pub fn target_force(&self, handle: Handle) -> Result<f64, ApiError> {
        let joint = self.registry.joint(handle)?;
        Ok(match self.joint_motor(handle)? {
            None => 0.0,
            Some(motor) if motor.mode == MotorMode::Torque => {
                joint.target_force.unwrap_or_else(|| self.commanded(joint, MotorMode::Torque))
            }
            Some(motor) => motor.max_torque,
        })
    }

    /// Sets the effort of a motor in torque mode, or else the largest effort that the motor may use (its absolute
    /// value): `[N·m]`, `[N]` if the joint is prismatic. In torque mode, unless `signed` (V-REP before 4.3), the effort
    /// takes the sign of the target velocity.
    ///
    /// # Errors
    ///
    /// `handle` is no object or no joint with one coordinate, the joint has no motor, or the effort is not finite.
    pub fn set_target_force(&mut self, handle: Handle, force: f64, signed: bool) -> Result<(), ApiError> {
        let force = finite(force, "force")?;
        if self.parked_mode(handle).is_some() {
            return self.set_parked_effort(handle, force.abs());
        }
        let is_torque = self.joint_motor(handle)?.is_some_and(|m| m.mode == MotorMode::Torque);
        if !is_torque {
            return self.change_motor(handle, |motor| motor.max_torque = force.abs());
        }
        let joint = self.joint_with_motor(handle)?;
        let direction = joint.target_velocity.unwrap_or(0.0);
        let along = if direction < 0.0 { -force.abs() } else { force.abs() };
        joint.target_force = Some(if signed { force } else { along });
        self.command(handle)
    }

    /// Range of a joint: true if it is cyclic (revolute and without limits), then its lower limit and the length of its
    /// range, both `[rad]` or, if it is prismatic, `[m]`. Infinite where there is no limit; a cyclic joint has −π and
    /// 2π.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or no joint with one coordinate.
    pub fn joint_interval(&self, handle: Handle) -> Result<(bool, [f64; 2]), ApiError> {
        if let Some([lower, upper]) = self.parked_stops(handle) {
            return Ok((false, [lower, upper - lower]));
        }
        let joint = self.registry.joint(handle)?;
        let limits = &self.world.model().constraints().limits;
        let bound = |sign: f64| limits.iter().find(|l| l.dof == joint.v_idx && l.sign == sign).map(|l| l.bound);
        Ok(match (bound(1.0), bound(-1.0)) {
            (None, None) if matches!(joint.kind, JointKind::Revolute { .. }) => {
                (true, [-std::f64::consts::PI, 2.0 * std::f64::consts::PI])
            }
            (low, high) => {
                let low = low.unwrap_or(f64::NEG_INFINITY);
                (false, [low, high.map_or(f64::INFINITY, |high| high - low)])
            }
        })
    }

    /// Dependency of a joint on another: the other joint, offset `[rad]` or `[m]`, and factor. Its position is
    /// offset + factor · position of the other. None if no gear of the scene drives it.
    ///
    /// # Errors
    ///
    /// There is no such joint.
    pub(crate) fn joint_dependency(&self, handle: Handle) -> Result<Option<(Handle, f64, f64)>, ApiError> {
        let joint = self.registry.joint(handle)?;
        let mut couplings = self.world.model().constraints().gears.iter();
        let Some(coupling) = couplings.find(|c| c.dofs[1] == joint.v_idx) else { return Ok(None) };
        let master = self.registry.joints().iter().find(|j| j.v_idx == coupling.dofs[0]);
        Ok(master.map(|master| (master.handle, coupling.offset, coupling.ratio)))
    }

    /// The command of a motor whose mode is `mode`; 0 in any other.
    fn commanded(&self, joint: &JointEntry, mode: MotorMode) -> f64 {
        let motor = joint.motor.filter(|_| joint.drive.is_some_and(|d| d.mode == mode));
        let Some(motor) = motor else { return 0.0 };
        let present = || self.registry.present_command(motor, &self.world.state);
        self.registry.held(motor).unwrap_or_else(present)
    }

    /// Holds the command of a motor in its present mode, if there is one; where its target was on its way to is
    /// forgotten.
    pub(super) fn command(&mut self, handle: Handle) -> Result<(), ApiError> {
        self.registry.joint_motions.remove(&handle);
        let joint = self.registry.joint(handle)?;
        let (Some(motor), Some(drive)) = (joint.motor, joint.drive) else { return Ok(()) };
        if self.is_held(handle) {
            self.registry.hold(motor, Some(0.0));
            return Ok(());
        }
        let position = self.world.state.q[joint.q_idx];
        let (told, default) = match drive.mode {
            // no function of the API gives voltages
            MotorMode::Free | MotorMode::Voltage => (None, 0.0),
            MotorMode::Torque => (joint.target_force, 0.0),
            MotorMode::Velocity => (joint.target_velocity, 0.0),
            MotorMode::Position | MotorMode::Spring => (joint.target_position, position),
        };
        // the scene's own command is meant for the scene's own mode
        let unless_told = (joint.scene_mode != Some(drive.mode)).then_some(default);
        self.registry.hold(motor, told.or(unless_told));
        Ok(())
    }

    fn joint_with_motor(&mut self, handle: Handle) -> Result<&mut JointEntry, ApiError> {
        if self.registry.joint(handle)?.motor.is_none() {
            return Err(self.without_motor(handle));
        }
        self.registry.joint_mut(handle)
    }

    fn without_motor(&self, handle: Handle) -> ApiError {
        let path = self.registry.entry(handle).map_or("", |e| e.path.as_str());
        ApiError(format!("joint `{path}` has no motor; give it one in the scene: motor = {{ mode = \"velocity\" }}"))
    }
}

/// Checks the numbers of a motor.
///
/// # Errors
///
/// One is negative or not a number.
pub(super) fn check_motor(motor: &Motor<f64>) -> Result<(), ApiError> {
    match motor.numbers().into_iter().find(|(_, x)| x.is_nan() || *x < 0.0) {
        Some((name, x)) => Err(ApiError(format!("{name} would be {x}, expected a number that is not negative"))),
        None => Ok(()),
    }
}

/// An angle within (−π, π]; what is there already stays as it is.
fn within_a_turn(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle > -PI && angle <= PI { angle } else { angle - TAU * ((angle - PI) / TAU).ceil() }
}

/// A finite number; a negative zero is a zero, since some clients can send no other.
fn finite(x: f64, what: &str) -> Result<f64, ApiError> {
    if x.is_finite() { Ok(x + 0.0) } else { Err(ApiError(format!("the {what} is {x}, expected a finite number"))) }
}

#[cfg(test)]
mod tests {
    use super::within_a_turn;
    use std::f64::consts::PI;

    #[test]
    fn angles_are_told_within_a_turn() {
        for (angle, told) in
            [(0.5, 0.5), (PI, PI), (-PI, PI), (3.0 * PI, PI), (7.0, 7.0 - 2.0 * PI), (-4.0, 2.0 * PI - 4.0)]
        {
            assert!((within_a_turn(angle) - told).abs() < 1e-15, "{angle}");
        }
        assert!(within_a_turn(f64::NAN).is_nan());
    }
}
