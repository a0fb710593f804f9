//! Block `sawtooth`.

use super::cycle::Cycle;
use crate::library::prelude::*;

declare_block! {
    /// Rises evenly over a period, then jumps back.
    pub struct Sawtooth("sawtooth", Sources):
        "y = low + (high − low)·((t − start) mod period)/period for t ≥ start, else low" {
        /// From one jump to the next `[s]`.
        pub period: f64 as Positive,
        /// y after a jump and before the start.
        pub low: Vec<f64> as PerComponent = "0",
        /// y just before a jump.
        pub high: Vec<f64> as PerComponent = "1",
        /// Start of the rise `[s]`.
        pub start: f64 as Number = "0",
    }
}

impl Sawtooth {
    /// Creates the block: from 0 to 1 in a period in `[s]`, from time 0 on.
    #[must_use]
    pub fn new(period: f64) -> Self {
        Self { period, low: vec![0.0], high: vec![1.0], start: 0.0 }
    }

    fn cycle(&self) -> Cycle {
        Cycle { start: self.start, period: self.period }
    }
}

impl Block for Sawtooth {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let share = self.cycle().phase(at.time()).unwrap_or(0.0) / self.period;
        for (i, y) in y.iter_mut().enumerate() {
            let (low, high) = (of(&self.low, i), of(&self.high, i));
            *y = R::splat(low + (high - low) * share);
        }
    }

    fn next_time_event(&self, t: f64) -> f64 {
        self.cycle().next(t, 0.0)
    }
}
