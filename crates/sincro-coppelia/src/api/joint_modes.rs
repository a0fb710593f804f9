//! Modes of joints: dynamic, and those in which kinematics moves a joint.
//!
//! | mode | a joint goes |
//! |---|---|
//! | dynamic (5) | by its motor |
//! | kinematic (0), inverse kinematics (2), dependent (4) | where it is put, at once; the dynamics hold it there |
//! | the same, hybrid | to where it would be put, by its motor in position control |
//!
//! A joint that is held is one with an ideal velocity motor at rest; its own motor is kept for the dynamic mode.

use sincro_dynamics::actuation::{Motor, MotorMode};

use super::registry::Handle;
use super::{ApiError, SimApi};

/// Numbers of the modes in the API.
const KINEMATIC: i64 = 0;
const INVERSE_KINEMATICS: i64 = 2;
const DEPENDENT: i64 = 4;
const DYNAMIC: i64 = 5;

/// Mode of a joint that is not dynamic.
#[derive(Clone, Copy, Debug)]
pub(super) struct StaticMode {
    /// Its number in the API.
    number: i64,
    /// True if its motor takes it to where it would be put.
    is_hybrid: bool,
    /// Motor of the dynamic mode.
    motor: Motor<f64>,
}

impl SimApi<'_> {
    /// Mode of a joint in the API, and whether it is hybrid.
    ///
    /// # Errors
    ///
    /// `handle` is no object.
    pub(crate) fn kinematic_mode(&self, handle: Handle) -> Result<(i64, bool), ApiError> {
        let own = self.registry.entry(handle)?.handle;
        Ok(self.registry.joint_modes.get(&own).map_or((DYNAMIC, false), |mode| (mode.number, mode.is_hybrid)))
    }

    /// Sets the mode of a joint; `is_hybrid` counts in modes other than the dynamic one. A joint without motor gets
    /// one: a change of the structure.
    ///
    /// # Errors
    ///
    /// There is no such joint or mode, or a dependent joint has no coupling in the scene.
    pub(crate) fn set_kinematic_mode(&mut self, handle: Handle, number: i64, is_hybrid: bool) -> Result<(), ApiError> {
        if !matches!(number, KINEMATIC | INVERSE_KINEMATICS | DEPENDENT | DYNAMIC) {
            return Err(ApiError(format!("{number} is no joint mode: kinematic 0, ik 2, dependent 4, dynamic 5")));
        }
        if self.parked_mode(handle).is_some() {
            let mode = if number == DYNAMIC { MotorMode::Free } else { MotorMode::Velocity };
            return self.set_joint_mode(handle, mode);
        }
        if number == DYNAMIC {
            let Some(mode) = self.registry.joint_modes.remove(&handle) else {
                return self.joint_mode(handle).map(|_| ());
            };
            self.change_motor(handle, |motor| *motor = mode.motor)?;
            return self.command(handle);
        }
        if number == DEPENDENT && self.joint_dependency(handle)?.is_some() {
            // its coupling moves it in any mode
            return Ok(());
        }
        if self.registry.joint(handle)?.motor.is_none() {
            self.give_motor(handle)?;
        }
        let motor = match self.registry.joint_modes.get(&handle) {
            Some(mode) => mode.motor,
            None => self.joint_motor(handle)?.unwrap_or(Motor::new(MotorMode::Free)),
        };
        self.registry.joint_modes.insert(handle, StaticMode { number, is_hybrid, motor });
        if is_hybrid {
            let here = self.joint_position(handle)?;
            self.set_joint_mode(handle, MotorMode::Position)?;
            return self.set_target_position(handle, here);
        }
        let held = Motor { max_torque: f64::INFINITY, ..Motor::new(MotorMode::Velocity) };
        self.change_motor(handle, |motor| *motor = held)?;
        self.command(handle)
    }

    /// Returns true if a joint is held where it was put.
    pub(super) fn is_held(&self, handle: Handle) -> bool {
        self.registry.joint_modes.get(&handle).is_some_and(|mode| !mode.is_hybrid)
    }

    /// Returns true if the motor of a joint takes it to where it would be put.
    pub(super) fn is_hybrid(&self, handle: Handle) -> bool {
        self.registry.joint_modes.get(&handle).is_some_and(|mode| mode.is_hybrid)
    }
}
