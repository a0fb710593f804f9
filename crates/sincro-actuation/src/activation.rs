//! Activation of an actuator: a state between its command and what acts, with dynamics of first order.
//!
//! | dynamics | rate of the activation a under the input u |
//! |---|---|
//! | `Integrator` | ȧ = u |
//! | `Filter` | ȧ = (u − a)/τ |
//!
//! u is the command within its limits. The activation takes the place of the command of a motor or of an actuator along
//! a path, in its unit; under an integrator the command is its rate.
//!
//! Within its range the activation obeys these laws; it stops at the ends of the range and leaves them as soon as its
//! rate points inwards, without windup. What acts is min(max(a, lower), upper), and the state is set back to that at
//! the end of every step: while the command is constant a is monotonic, so that what acts is exact at every instant of
//! the step in which the end is reached. A linearly implicit step of length h takes the filter at its end,
//! ȧ = (u − a)/(τ + h).
//!
//! Source: key `mjcf`, actuators, activation dynamics (`integrator`, `filter` and `filterexact`; `actrange`).

use sincro_math::Real;

/// Dynamics of an [`Activation`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActivationDynamics<R> {
    /// The command is the rate of the activation `[1/s]` times the unit of the actuator.
    Integrator,
    /// The activation follows the command with the time constant τ `[s]`, above 0.
    Filter {
        /// Time constant τ `[s]`.
        time_constant: R,
    },
}

/// Activation of a motor in mode torque, spring or voltage, or of an actuator along a path, in the unit that its
/// command has without; attached by `JointSpec::activation` or `SpringDamperSpec::activation`.
///
/// ```
/// use sincro_actuation::{Activation, ActivationDynamics};
///
/// let lag = Activation::new(ActivationDynamics::Filter { time_constant: 0.1 });
/// assert_eq!(lag.rate(0.5, 1.5, 0.0), (1.5 - 0.5) / 0.1);
/// let lag = Activation { range: [-1.0, 1.0], ..lag };
/// assert_eq!(lag.saturated(1.2), 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Activation<R> {
    /// Index of its command in the model's commands; set when the model is built.
    pub command: usize,
    /// Index in the states of elements; set when the model is built.
    pub state: usize,
    /// Dynamics.
    pub dynamics: ActivationDynamics<R>,
    /// Least and largest input: the command is limited to that; infinite for none.
    pub input_range: [R; 2],
    /// Least and largest activation; infinite for none.
    pub range: [R; 2],
    /// Activation at the start.
    pub initial: R,
}

impl Activation<f64> {
    /// Activation without limits that starts at zero.
    #[must_use]
    pub fn new(dynamics: ActivationDynamics<f64>) -> Self {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        Self { command: 0, state: 0, dynamics, input_range: all, range: all, initial: 0.0 }
    }

    /// Time constant of a filter `[s]`; `None` of an integrator.
    #[must_use]
    pub fn time_constant(&self) -> Option<f64> {
        match self.dynamics {
            ActivationDynamics::Integrator => None,
            ActivationDynamics::Filter { time_constant } => Some(time_constant),
        }
    }

    /// Checks the numbers: for each fault the name of the field, a message about the actuator, and a help; empty if
    /// there is none. `of` is the actuator as messages call it, with its name.
    #[must_use]
    pub fn problems(&self, of: &str) -> Vec<(&'static str, String, &'static str)> {
        let mut found = Vec::new();
        if let ActivationDynamics::Filter { time_constant: x } = self.dynamics
            && !(x.is_finite() && x > 0.0)
        {
            let message = format!("time constant {x} s of the activation of {of} is not positive and finite");
            found.push(("time_constant", message, "give a time above zero; without a lag leave `activation` out"));
        }
        for (key, [low, high]) in [("range", self.range), ("input_range", self.input_range)] {
            let is_range = low < high && low < f64::INFINITY && high > f64::NEG_INFINITY;
            if !is_range {
                let message = format!("{key} [{low}, {high}] of the activation of {of} is no range");
                found.push((key, message, "give a lower end below the upper one"));
            }
        }
        if !self.initial.is_finite() || self.saturated(self.initial) != self.initial {
            let message = format!("initial activation {} of {of} is not finite or outside of its range", self.initial);
            found.push(("initial", message, "give a number within `range`"));
        }
        found
    }
}

impl<R: Real> Activation<R> {
    /// Activation that acts, for its `state`.
    #[inline(always)]
    pub fn saturated(&self, state: R) -> R {
        state.max(self.range[0]).min(self.range[1])
    }

    /// Rate of the activation for a `command` over a linearly implicit step of length `h` `[s]` (0: now), as if it had
    /// no range.
    #[inline(always)]
    pub fn rate(&self, state: R, command: R, h: R) -> R {
        let input = command.max(self.input_range[0]).min(self.input_range[1]);
        match self.dynamics {
            ActivationDynamics::Integrator => input,
            ActivationDynamics::Filter { time_constant } => (input - state) / (time_constant + h),
        }
    }

    /// Rate of the activation at the ends of its range: zero for a `rate` that points outwards.
    #[inline(always)]
    pub fn stopped_rate(&self, state: R, rate: R) -> R {
        let from_below = self.range[0].if_less(state, rate, rate.max(R::zero()));
        state.if_less(self.range[1], from_below, from_below.min(R::zero()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_the_ends_of_its_range_only_the_inward_rate_remains() {
        let lag = Activation { range: [-1.0, 2.0], ..Activation::new(ActivationDynamics::Integrator) };
        for (state, rate, left) in [
            (-1.0, -3.0, 0.0),
            (-1.0, 3.0, 3.0),
            (0.5, -3.0, -3.0),
            (0.5, 3.0, 3.0),
            (2.0, 3.0, 0.0),
            (2.1, -3.0, -3.0),
        ] {
            assert_eq!(lag.stopped_rate(state, rate), left, "{state} {rate}");
        }
    }

    #[test]
    fn numbers_that_are_none_are_named() {
        let lag = Activation::new(ActivationDynamics::Filter { time_constant: 0.0 });
        let bad = Activation { range: [1.0, -1.0], input_range: [f64::NAN, 1.0], initial: f64::INFINITY, ..lag };
        let fields: Vec<_> = bad.problems("motor `m`").into_iter().map(|(field, ..)| field).collect();
        assert_eq!(fields, ["time_constant", "range", "input_range", "initial"]);
        assert!(Activation::new(ActivationDynamics::Integrator).problems("motor `m`").is_empty());
    }
}
