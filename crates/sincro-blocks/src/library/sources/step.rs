//! Block `step`.

use crate::library::prelude::*;

declare_block! {
    /// Jumps from one value to another.
    pub struct Step("step", Sources): "y = from for t < time, to for t ≥ time" {
        /// Instant of the jump `[s]`.
        pub time: f64 as Number = "0",
        /// y before the jump.
        pub from: Vec<f64> as PerComponent = "0",
        /// y from the jump on.
        pub to: Vec<f64> as PerComponent = "1",
    }
}

impl Step {
    /// Creates a scalar step from 0 to `to` (in the unit of the output) at `time` `[s]`.
    #[must_use]
    pub fn new(time: f64, to: f64) -> Self {
        Self { time, from: vec![0.0], to: vec![to] }
    }
}

impl Block for Step {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let value = if at.time() < self.time - SAME_INSTANT { &self.from } else { &self.to };
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::splat(of(value, i));
        }
    }

    fn next_time_event(&self, t: f64) -> f64 {
        if t + SAME_INSTANT < self.time { self.time } else { f64::INFINITY }
    }

    fn label(&self) -> String {
        format!("{} → {}", short_list(&self.from), short_list(&self.to))
    }
}
