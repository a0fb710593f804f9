//! Activations of a model's actuators: their rates, and the values that act in the place of commands.

use sincro_math::Real;

use super::Model;
use crate::actuation::{Activation, MotorMode};

impl<R: Real> Model<R> {
    /// Activations of actuators, in the order of their commands.
    #[must_use]
    pub fn activations(&self) -> &[Activation<R>] {
        &self.activations
    }

    /// Returns true if the activation takes the place of its command: that of a motor in mode torque, spring or
    /// voltage, or of an actuator along a path.
    #[inline(always)]
    pub(crate) fn acts(&self, activation: &Activation<R>) -> bool {
        let mode = self.params.motors.get(activation.command).map(|motor| motor.mode);
        matches!(mode, None | Some(MotorMode::Torque | MotorMode::Spring | MotorMode::Voltage))
    }

    /// Value that acts in the place of command `k` (0 to n_commands − 1): that of `commands`, or the activation in the
    /// states of elements ([`State::rotors`](crate::state::State::rotors)); 0 while the commands are being written, and
    /// the list is empty.
    #[must_use]
    pub fn actuation(&self, k: usize, commands: &[R], states: &[R]) -> R {
        let found = self.activations.iter().find(|activation| activation.command == k && self.acts(activation));
        found.map_or_else(
            || commands.get(k).copied().unwrap_or(R::zero()),
            |activation| activation.saturated(states[activation.state]),
        )
    }

    /// Writes the values that act in the place of the commands into `actuations` (n_commands).
    #[inline(always)]
    pub(crate) fn find_actuations(&self, commands: &[R], states: &[R], actuations: &mut [R]) {
        actuations.copy_from_slice(commands);
        for activation in self.activations.iter().filter(|activation| self.acts(activation)) {
            actuations[activation.command] = activation.saturated(states[activation.state]);
        }
    }

    /// Writes the rates of activations among the states of elements into `rates`, over a linearly implicit step of
    /// length `h` `[s]` (0: now). One that does not act rests.
    #[inline(always)]
    pub(crate) fn activation_rates(&self, commands: &[R], states: &[R], h: R, rates: &mut [R]) {
        for activation in &self.activations {
            let rate = activation.rate(states[activation.state], commands[activation.command], h);
            rates[activation.state] = if self.acts(activation) { rate } else { R::zero() };
        }
    }

    /// Stops activations at the ends of their ranges: their `rates` among those of the states of elements, for one
    /// evaluation that is no stage of a method of this crate, which set them back at the end of a step.
    #[inline(always)]
    pub fn stop_activations(&self, states: &[R], rates: &mut [R]) {
        for activation in &self.activations {
            let k = activation.state;
            rates[k] = activation.stopped_rate(states[k], rates[k]);
        }
    }

    /// Sets activations back to the ends of their ranges, among the states of elements.
    #[inline(always)]
    pub(crate) fn limit_activations(&self, states: &mut [R]) {
        for activation in &self.activations {
            states[activation.state] = activation.saturated(states[activation.state]);
        }
    }
}
