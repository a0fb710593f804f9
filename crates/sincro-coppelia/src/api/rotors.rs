//! Rotors, as clients and scripts know them: joints with an ideal motor that have a speed and no position. What V-REP's
//! propellers have as the joint that turns them.

use sincro_dynamics::aero::rotor::SpeedSource;

use super::registry::{Handle, Kind};
use super::{ApiError, SimApi};

impl SimApi<'_> {
    /// Index of a rotor among the model's; none for any other object.
    pub(super) fn rotor(&self, handle: Handle) -> Result<Option<usize>, ApiError> {
        Ok(match self.registry.entry(handle)?.kind {
            Kind::Rotor(index) => Some(index),
            _ => None,
        })
    }

    /// Speed of a rotor [rad/s].
    pub(super) fn rotor_speed(&self, rotor: usize) -> f64 {
        self.world.rotor_speed(sincro_dynamics::ids::RotorId::new(rotor))
    }

    /// Target speed of a rotor [rad/s].
    pub(super) fn rotor_target(&self, rotor: usize) -> f64 {
        let Some(command) = self.world.model().rotors()[rotor].speed.command() else { return self.rotor_speed(rotor) };
        let present = || self.registry.present_command(command, &self.world.state);
        self.registry.held(command).unwrap_or_else(present)
    }

    /// Tells a rotor its speed [rad/s].
    pub(super) fn set_rotor_target(&mut self, rotor: usize, speed: f64) -> Result<(), ApiError> {
        let model = self.world.model();
        let Some(command) = model.rotors()[rotor].speed.command() else {
            let path = &model.names().rotors[rotor];
            let joint = match model.rotors()[rotor].speed {
                SpeedSource::Joint { dof, .. } => model.names().dof_name(dof),
                _ => "",
            };
            return Err(ApiError(format!(
                "the rotor `{path}` turns with the joint `{joint}`: set that joint's velocity"
            )));
        };
        self.registry.hold(command, Some(speed));
        Ok(())
    }
}
