//! Motors of joints that were made and move nothing yet.

use serde_json::{Map, Value};
use sincro_dynamics::actuation::MotorMode;

use crate::api::registry::Handle;
use crate::api::{ApiError, SimApi};

impl SimApi<'_> {
    /// Mode of the motor of a joint that was made and moves nothing yet; none if the joint is part of the model, or
    /// turns in any way.
    pub(in crate::api) fn parked_mode(&self, handle: Handle) -> Option<MotorMode> {
        let motor = self.registry.parked.get(&handle)?.get("motor")?;
        Some(match motor.get("mode").and_then(Value::as_str) {
            Some("velocity") => MotorMode::Velocity,
            Some("position") => MotorMode::Position,
            _ => MotorMode::Free,
        })
    }

    /// Gives the motor of such a joint a mode; a position motor gets the gain `kp` `[1/s]`.
    ///
    /// # Errors
    ///
    /// The mode is another one than free, velocity and position.
    pub(in crate::api) fn set_parked_mode(&mut self, handle: Handle, mode: MotorMode, kp: f64) -> Result<(), ApiError> {
        let word = match mode {
            MotorMode::Free => "free",
            MotorMode::Velocity => "velocity",
            MotorMode::Position => "position",
            _ => return Err(ApiError::new("hang a body on the joint first: then its motor takes any mode")),
        };
        let Some(motor) = self.parked_motor(handle) else { return Ok(()) };
        motor.insert("mode".into(), word.into());
        // the scene's file has these keys only where the mode uses them
        if mode == MotorMode::Free {
            motor.remove("max_torque");
        }
        motor.remove("kp");
        if mode == MotorMode::Position {
            motor.insert("kp".into(), kp.into());
        }
        Ok(())
    }

    /// Limits the effort of the motor of such a joint to `effort` `[N·m]` or `[N]`.
    ///
    /// # Errors
    ///
    /// The motor is off.
    pub(in crate::api) fn set_parked_effort(&mut self, handle: Handle, effort: f64) -> Result<(), ApiError> {
        if self.parked_mode(handle) == Some(MotorMode::Free) {
            return Err(ApiError::new(
                "the motor of the joint is off: give it a mode first (whole-number parameter 2000)",
            ));
        }
        if let Some(motor) = self.parked_motor(handle) {
            motor.insert("max_torque".into(), effort.into());
        }
        Ok(())
    }

    fn parked_motor(&mut self, handle: Handle) -> Option<&mut Map<String, Value>> {
        self.registry.parked.get_mut(&handle)?.get_mut("motor")?.as_object_mut()
    }
}
