//! Inputs as functions of time: constant, step, ramp, sine, pulse train, table.

use std::sync::Arc;

use crate::elementary::sin_cos;

/// Function of time alone, for forces and torques of a model: a value in the unit of its use (such as N or N·m) over
/// time `[s]`.
///
/// ```
/// use sincro_math::signal::Signal;
///
/// let pulse = Signal::Pulse { period: 2.0, width: 0.5, low: 0.0, high: 3.0, start: 1.0 };
/// assert_eq!([0.9, 1.2, 1.6, 3.1].map(|t| pulse.value(t)), [0.0, 3.0, 0.0, 3.0]);
/// assert_eq!(pulse.next_time_event(1.2), 1.5); // [s]
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// Same value at all times, in the unit of the signal.
    Constant(f64),
    /// `from` before `time`, `to` from then on.
    Step {
        /// Instant of the jump `[s]`.
        time: f64,
        /// Value before `time`.
        from: f64,
        /// Value from `time` on.
        to: f64,
    },
    /// `from` until `start`, then rising by `slope` a second, constant again from `until`.
    Ramp {
        /// Start of the ramp `[s]`.
        start: f64,
        /// Slope, in the value's unit per second.
        slope: f64,
        /// Value at and before the start.
        from: f64,
        /// End of the ramp `[s]`; infinite for none.
        until: f64,
    },
    /// `offset + amplitude·sin(angular_frequency·t + phase)`.
    Sine {
        /// Amplitude, in the value's unit.
        amplitude: f64,
        /// Angular frequency `[rad/s]`.
        angular_frequency: f64,
        /// Phase at t = 0 `[rad]`.
        phase: f64,
        /// Mean value, in the value's unit.
        offset: f64,
    },
    /// From `start` on `high` for the first `width` seconds of every `period`, `low` otherwise.
    Pulse {
        /// Time from one rising edge to the next `[s]`.
        period: f64,
        /// Time at `high` in each period `[s]`.
        width: f64,
        /// Value between pulses.
        low: f64,
        /// Value of a pulse.
        high: f64,
        /// First rising edge `[s]`.
        start: f64,
    },
    /// Given points; before the first and after the last it is constant.
    Table {
        /// Increasing times `[s]`.
        times: Arc<[f64]>,
        /// Values at those times, as many.
        values: Arc<[f64]>,
        /// True for linear interpolation between points, false to hold each value until the next point.
        linear: bool,
    },
}

/// Times closer than this are the same instant `[s]`: ticks are exact multiples, typed numbers are not.
const SAME_INSTANT: f64 = 1e-9;

impl Signal {
    /// Value at time `t` `[s]`, in the signal's unit.
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        match *self {
            Self::Constant(x) => x,
            Self::Step { time, from, to } => {
                if t < time - SAME_INSTANT {
                    from
                } else {
                    to
                }
            }
            Self::Ramp { start, slope, from, until } => from + slope * (t.min(until) - start).max(0.0),
            Self::Sine { amplitude, angular_frequency, phase, offset } => {
                offset + amplitude * sin_cos(angular_frequency * t + phase).0
            }
            Self::Pulse { period, width, low, high, start } => {
                let since = t - start + SAME_INSTANT;
                let within = since - (since / period).floor() * period;
                if since >= 0.0 && within < width { high } else { low }
            }
            Self::Table { ref times, ref values, linear } => table(times, values, linear, t),
        }
    }

    /// Value, in the signal's unit, of a [`Signal::Constant`]; `None` for every other kind.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        match *self {
            Self::Constant(x) => Some(x),
            _ => None,
        }
    }

    /// Highest frequency `[Hz]` of the signal up to time `until` `[s]`, for choosing a step size: of a sine, or of a
    /// table or pulses that are read at ticks only (`is_sampled`); else 0, since jumps and corners are located as time
    /// events. That of pulses is half the inverse of the time at `low` or `high`, whichever is shorter.
    #[must_use]
    pub fn highest_frequency(&self, until: f64, is_sampled: bool) -> f64 {
        match self {
            Self::Sine { amplitude, angular_frequency, .. } if *amplitude != 0.0 => {
                angular_frequency.abs() / core::f64::consts::TAU
            }
            Self::Table { times, values, .. } if is_sampled => {
                crate::series::highest_frequency(times, |k| values[k], until)
            }
            Self::Pulse { period, width, low, high, start } if is_sampled && low != high && *start < until => {
                let shorter = if width < period { width.min(period - width) } else { f64::INFINITY };
                0.5 / shorter
            }
            _ => 0.0,
        }
    }

    /// Next time event: the first instant after `t` `[s]` at which the signal or its slope jumps, so that no
    /// integration step straddles it; infinite if there is none.
    #[must_use]
    pub fn next_time_event(&self, t: f64) -> f64 {
        let after = |x: f64| if x > t + SAME_INSTANT { x } else { f64::INFINITY };
        match *self {
            Self::Constant(_) | Self::Sine { .. } => f64::INFINITY,
            Self::Step { time, .. } => after(time),
            Self::Ramp { start, until, .. } => after(start).min(after(until)),
            Self::Pulse { period, width, start, .. } => {
                let n = ((t - start + SAME_INSTANT) / period).floor().max(0.0);
                let rise = start + n * period;
                after(rise).min(after(rise + width)).min(after(rise + period))
            }
            Self::Table { ref times, .. } => {
                times.get(times.partition_point(|x| *x <= t + SAME_INSTANT)).copied().unwrap_or(f64::INFINITY)
            }
        }
    }
}

fn table(times: &[f64], values: &[f64], linear: bool, t: f64) -> f64 {
    let slack = if linear { 0.0 } else { SAME_INSTANT };
    let after = times.partition_point(|x| *x <= t + slack);
    if after == 0 {
        return values[0];
    }
    let (t0, v0) = (times[after - 1], values[after - 1]);
    if !linear || after == times.len() {
        return v0;
    }
    v0 + (values[after] - v0) * ((t - t0) / (times[after] - t0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_ramps_and_sines_have_their_values() {
        let step = Signal::Step { time: 1.0, from: 2.0, to: 5.0 };
        // what is closer than a nanosecond is the same instant
        let times = [0.5, 1.0 - 2e-9, 1.0 - SAME_INSTANT, 1.0 - 0.5e-9, 1.0, 7.0];
        assert_eq!(times.map(|t| step.value(t)), [2.0, 2.0, 5.0, 5.0, 5.0, 5.0]);
        let ramp = Signal::Ramp { start: 1.0, slope: 3.0, from: 2.0, until: 4.0 };
        assert_eq!([0.0, 1.0, 2.0, 4.0, 9.0].map(|t| ramp.value(t)), [2.0, 2.0, 5.0, 11.0, 11.0]);
        let sine = Signal::Sine { amplitude: 2.0, angular_frequency: 3.0, phase: 0.5, offset: 5.0 };
        assert_eq!(sine.value(0.75), 5.0 + 2.0 * sin_cos(2.75).0);
        assert_eq!([Signal::Constant(3.5).constant(), step.constant()], [Some(3.5), None]);
    }

    #[test]
    fn a_pulse_train_begins_and_ends_its_pulses_within_a_nanosecond() {
        let pulse = |start, width| Signal::Pulse { period: 0.1, width, low: -1.0, high: 2.0, start };
        let late = pulse(0.02, 0.03);
        assert_eq!([0.005, 0.02 - 2e-9, 0.02 - 0.5e-9, 0.021].map(|t| late.value(t)), [-1.0, -1.0, 2.0, 2.0]);
        // at exactly its width a pulse is over
        assert_eq!(pulse(0.0, 0.0625 + SAME_INSTANT).value(0.0625), -1.0);
    }

    #[test]
    fn a_pulse_train_has_its_duty_cycle() {
        let pulse = Signal::Pulse { period: 0.1, width: 0.03, low: -1.0, high: 2.0, start: 0.05 };
        let mut high = 0;
        for k in 0..1000 {
            high += i32::from(pulse.value(0.05 + f64::from(k) * 0.001) > 0.0);
        }
        assert_eq!(high, 300);
        assert_eq!(pulse.value(0.0), -1.0);
    }

    #[test]
    fn corners_are_found_in_order() {
        let pulse = Signal::Pulse { period: 1.0, width: 0.25, low: 0.0, high: 1.0, start: 0.5 };
        let mut t = 0.0;
        let corners: Vec<f64> = std::iter::from_fn(|| {
            t = pulse.next_time_event(t);
            Some(t)
        })
        .take(4)
        .collect();
        assert_eq!(corners, [0.5, 0.75, 1.5, 1.75]);
    }

    #[test]
    fn time_events_are_those_after_an_instant() {
        let pulse = Signal::Pulse { period: 0.25, width: 0.125, low: 0.0, high: 1.0, start: 0.5 };
        assert_eq!([0.0, 0.5, 3.0625, 3.125].map(|t| pulse.next_time_event(t)), [0.5, 0.625, 3.125, 3.25]);
        // an instant that is the same is not after it
        let step = |time| Signal::Step { time, from: 0.0, to: 1.0 };
        let next = [1.0 + 2e-9, 1.0 + SAME_INSTANT, 1.0].map(|time| step(time).next_time_event(1.0));
        assert_eq!(next, [1.0 + 2e-9, f64::INFINITY, f64::INFINITY]);
        let ramp = Signal::Ramp { start: 1.0, slope: 1.0, from: 0.0, until: 4.0 };
        assert_eq!([0.0, 1.0, 4.0].map(|t| ramp.next_time_event(t)), [1.0, 4.0, f64::INFINITY]);
        let table = Signal::Table { times: [0.0, 1.0, 3.0].into(), values: [1.0; 3].into(), linear: true };
        let times = [-1.0, 0.0, 0.5, 1.0 - 0.5e-9, 1.0, 2.0, 3.0];
        assert_eq!(times.map(|t| table.next_time_event(t)), [0.0, 1.0, 1.0, 3.0, 3.0, 3.0, f64::INFINITY]);
    }

    #[test]
    fn a_table_is_constant_outside_and_linear_inside() {
        let (times, values): (Arc<[f64]>, Arc<[f64]>) = ([0.0, 1.0, 3.0].into(), [1.0, 2.0, -2.0].into());
        let linear = Signal::Table { times: times.clone(), values: values.clone(), linear: true };
        let held = Signal::Table { times, values, linear: false };
        for (t, l, h) in [(-1.0, 1.0, 1.0), (0.5, 1.5, 1.0), (2.0, 0.0, 2.0), (9.0, -2.0, -2.0)] {
            assert_eq!((linear.value(t), held.value(t)), (l, h));
        }
        // a held value begins within a nanosecond of its instant
        assert_eq!([1.0 - 2e-9, 1.0 - 0.5e-9].map(|t| held.value(t)), [1.0, 2.0]);
    }

    #[test]
    fn frequencies_are_those_of_sines_and_of_tables_that_are_read_at_ticks() {
        let sine = |amplitude| Signal::Sine { amplitude, angular_frequency: 20.0, phase: 0.0, offset: 1.0 };
        assert_eq!(sine(2.0).highest_frequency(1.0, false), 10.0 / core::f64::consts::PI);
        assert_eq!(sine(0.0).highest_frequency(1.0, false), 0.0);
        let (times, values): (Arc<[f64]>, Arc<[f64]>) = ([0.0, 0.5, 0.625, 3.0].into(), [1.0, 2.0, 1.0, 3.0].into());
        let table = Signal::Table { times, values, linear: true };
        assert_eq!(table.highest_frequency(4.0, true), 4.0);
        assert_eq!(table.highest_frequency(0.6, true), 0.0);
        assert_eq!(table.highest_frequency(4.0, false), 0.0);
        assert_eq!(Signal::Constant(1.0).highest_frequency(1.0, true), 0.0);
        // the pause is shorter than the pulse; read at ticks it may be missed
        let pulse = |width| Signal::Pulse { period: 0.5, width, low: 0.0, high: 1.0, start: 0.2 };
        assert_eq!(pulse(0.375).highest_frequency(1.0, true), 4.0);
        assert_eq!(pulse(0.125).highest_frequency(1.0, true), 4.0);
        let silent = [pulse(0.5).highest_frequency(1.0, true), pulse(0.1).highest_frequency(1.0, false)];
        assert_eq!((silent, pulse(0.1).highest_frequency(0.1, true)), ([0.0, 0.0], 0.0));
    }
}
