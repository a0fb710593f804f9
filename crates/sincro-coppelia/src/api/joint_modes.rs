//! Modes of joints: dynamic, and those in which kinematics moves a joint.
//!
//! | mode | a joint goes |
//! |---|---|
//! | dynamic (5) | by its motor |
//! | kinematic (0), inverse kinematics (2), dependent (4) | where it is put, at once; the dynamics hold it there |
//! | the same, hybrid | to where it would be put, by its motor in position control |
//!
//! A joint that carries a static body is held in any mode. A joint that is held is one with an ideal velocity motor at
//! rest; its own motor is kept for the dynamic mode. What is asked and told of a motor (mode, gains, limits) is of the
//! one that is kept.

use std::collections::BTreeMap;

use sincro_dynamics::actuation::{Motor, MotorMode};

use super::joints::{POSITION_GAIN, check_motor};
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
        let is_dynamic = number == DYNAMIC && !self.carries_static(handle);
        if is_dynamic {
            let Some(mode) = self.registry.joint_modes.remove(&handle) else {
                return self.joint_mode(handle).map(|_| ());
            };
            self.change_driving_motor(handle, |motor| *motor = mode.motor)?;
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
        self.registry
            .joint_modes
            .insert(handle, StaticMode { number, is_hybrid: is_hybrid && number != DYNAMIC, motor });
        self.drive_by_mode(handle)?;
        if is_hybrid && number != DYNAMIC {
            let here = self.joint_position(handle)?;
            return self.set_target_position(handle, here);
        }
        self.command(handle)
    }

    /// Gives the world the motor that drives a joint in its mode, if that is not dynamic: the joint's own one in
    /// position control if it is hybrid, else an ideal one at rest.
    fn drive_by_mode(&mut self, handle: Handle) -> Result<(), ApiError> {
        let Some(mode) = self.registry.joint_modes.get(&handle).copied() else { return Ok(()) };
        let motor = if mode.is_hybrid {
            let kp = if mode.motor.kp == 0.0 { POSITION_GAIN } else { mode.motor.kp };
            Motor { mode: MotorMode::Position, kp, ..mode.motor }
        } else {
            Motor { max_torque: f64::INFINITY, ..Motor::new(MotorMode::Velocity) }
        };
        self.change_driving_motor(handle, |driving| *driving = motor)
    }

    /// Motor of a joint for the dynamic mode, if that is not the mode of the joint.
    pub(super) fn kept_motor(&self, handle: Handle) -> Option<Motor<f64>> {
        self.registry.joint_modes.get(&handle).map(|mode| mode.motor)
    }

    /// Changes the motor of a joint that is kept for the dynamic mode; the motor of a hybrid joint follows.
    ///
    /// # Errors
    ///
    /// A number of the motor is negative or not a number.
    pub(super) fn change_kept_motor(
        &mut self,
        handle: Handle,
        change: impl FnOnce(&mut Motor<f64>),
    ) -> Result<(), ApiError> {
        let Some(mode) = self.registry.joint_modes.get_mut(&handle) else { return Ok(()) };
        let mut motor = mode.motor;
        change(&mut motor);
        check_motor(&motor)?;
        mode.motor = motor;
        if mode.is_hybrid { self.drive_by_mode(handle) } else { Ok(()) }
    }

    /// Gives copies of joints the modes of their originals.
    pub(super) fn copy_joint_modes(&mut self, copies: &BTreeMap<Handle, Handle>) -> Result<(), ApiError> {
        for (original, copy) in copies {
            let Some(mode) = self.registry.joint_modes.get(original).copied() else { continue };
            self.registry.joint_modes.insert(*copy, mode);
            self.drive_by_mode(*copy)?;
            self.command(*copy)?;
        }
        Ok(())
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
