//! Ticks of the input clocks of an instance: when the next one is due, in which order.

use super::description::{ClockRule, ForeignClock};
use super::library::{Component, Functions};

/// Tolerance of instants `[s]`, relative to their size: clocks that tick closer together tick at once.
const SAME: f64 = 1e-12;

/// Input clocks of an instance with their next ticks.
#[derive(Clone, Debug)]
pub(super) struct Clocks {
    clocks: Vec<Clock>,
}

#[derive(Clone, Debug)]
struct Clock {
    reference: u32,
    rule: ClockRule,
    priority: u32,
    /// First tick, time between ticks, number of ticks, next tick.
    first: f64,
    interval: f64,
    count: f64,
    next: f64,
}

impl Clocks {
    pub fn new(of: &[ForeignClock]) -> Self {
        let is_timed = |clock: &&ForeignClock| clock.rule != ClockRule::Triggered;
        let make = |clock: &ForeignClock| Clock {
            reference: clock.reference,
            rule: clock.rule,
            priority: clock.priority,
            first: f64::INFINITY,
            interval: f64::INFINITY,
            count: 0.0,
            next: f64::INFINITY,
        };
        let mut clocks: Vec<Clock> = of.iter().filter(is_timed).map(make).collect();
        clocks.sort_by_key(|clock| clock.priority);
        Self { clocks }
    }

    pub fn is_empty(&self) -> bool {
        self.clocks.is_empty()
    }

    /// Sets the first ticks of an instance that is initialized at time `t` `[s]`.
    pub fn begin(&mut self, functions: &Functions, c: Component, t: f64) -> Result<(), String> {
        for clock in &mut self.clocks {
            let (interval, shift) = match clock.rule {
                ClockRule::Periodic { interval, shift } => (interval, shift),
                ClockRule::Calculated => {
                    (functions.interval(c, clock.reference)?.0, functions.shift(c, clock.reference)?)
                }
                ClockRule::Changing => (f64::INFINITY, 0.0),
                ClockRule::Countdown | ClockRule::Triggered => continue,
            };
            if !(interval > 0.0 && shift >= 0.0) {
                return Err(format!("a clock of the FMU has the interval {interval} s and the shift {shift} s"));
            }
            (clock.interval, clock.first, clock.next, clock.count) = (interval, t + shift, t + shift, 0.0);
        }
        Ok(())
    }

    /// Next tick `[s]`; infinite if there is none.
    pub fn next(&self) -> f64 {
        self.clocks.iter().fold(f64::INFINITY, |next, clock| next.min(clock.next))
    }

    /// Clocks that tick at time `t` `[s]` or before, the most urgent first; their next ticks are set.
    pub fn take_due(&mut self, t: f64) -> Vec<u32> {
        let until = t + SAME * t.abs().max(1.0);
        let due = self.clocks.iter_mut().filter(|clock| clock.next <= until);
        due.map(|clock| {
            clock.count += 1.0;
            // not summed up
            let is_periodic = matches!(clock.rule, ClockRule::Periodic { .. } | ClockRule::Calculated);
            clock.next = if is_periodic { clock.first + clock.count * clock.interval } else { f64::INFINITY };
            clock.reference
        })
        .collect()
    }

    /// Takes the intervals that the FMU has set since, at time `t` `[s]`.
    pub fn poll(&mut self, functions: &Functions, c: Component, t: f64) -> Result<(), String> {
        for clock in self.clocks.iter_mut().filter(|c| matches!(c.rule, ClockRule::Changing | ClockRule::Countdown)) {
            let (interval, has_changed) = functions.interval(c, clock.reference)?;
            if has_changed {
                if interval.is_nan() || interval < 0.0 {
                    return Err(format!("a clock of the FMU has the interval {interval} s"));
                }
                clock.next = t + interval;
            }
        }
        Ok(())
    }

    /// Numbers that change, four for each clock.
    pub fn save(&self) -> Vec<f64> {
        self.clocks.iter().flat_map(|clock| [clock.first, clock.interval, clock.count, clock.next]).collect()
    }

    /// Number of numbers of [`Clocks::save`].
    pub fn n_numbers(&self) -> usize {
        4 * self.clocks.len()
    }

    /// Takes back the numbers of [`Clocks::save`].
    pub fn restore(&mut self, numbers: &[f64]) {
        for (clock, saved) in self.clocks.iter_mut().zip(numbers.chunks_exact(4)) {
            (clock.first, clock.interval, clock.count, clock.next) = (saved[0], saved[1], saved[2], saved[3]);
        }
    }
}
