//! Block `pulse`.

use super::cycle::Cycle;
use crate::library::prelude::*;

declare_block! {
    /// A train of rectangular pulses.
    pub struct Pulse("pulse", Sources):
        "y = high for 0 ≤ (t − start) mod period < width and t ≥ start, else low" {
        /// From one rising edge to the next `[s]`.
        pub period: f64 as Positive,
        /// Length of a pulse, at most the period `[s]`.
        pub width: f64 as Positive,
        /// y between pulses and before the first.
        pub low: Vec<f64> as PerComponent = "0",
        /// y in a pulse.
        pub high: Vec<f64> as PerComponent = "1",
        /// The first rising edge `[s]`.
        pub start: f64 as Number = "0",
    }
}

impl Pulse {
    /// Between 0 and 1, from time 0 on; `period` and `width` in `[s]`.
    #[must_use]
    pub fn new(period: f64, width: f64) -> Self {
        Self { period, width, low: vec![0.0], high: vec![1.0], start: 0.0 }
    }

    fn cycle(&self) -> Cycle {
        Cycle { start: self.start, period: self.period }
    }
}

impl Block for Pulse {
    type Work<R: Real> = ();

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.width > self.period {
            let message = format!("`width` {} s is longer than `period` {} s", self.width, self.period);
            p.fault("width", message, "it must be at most the period");
        }
    }

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let is_high = self.cycle().phase(at.time()).is_some_and(|phase| phase < self.width - SAME_INSTANT);
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::splat(of(if is_high { &self.high } else { &self.low }, i));
        }
    }

    fn next_time_event(&self, t: f64) -> f64 {
        self.cycle().next(t, 0.0).min(self.cycle().next(t, self.width))
    }

    fn highest_frequency(&self, until: f64, is_sampled: bool) -> f64 {
        let n = self.low.len().max(self.high.len());
        let moves = (0..n).any(|i| of(&self.low, i) != of(&self.high, i)) && self.width < self.period;
        match is_sampled && moves && self.start < until {
            true => 0.5 / self.width.min(self.period - self.width),
            false => 0.0,
        }
    }

    fn label(&self) -> String {
        format!("{} s / {} s", short(self.width), short(self.period))
    }
}
