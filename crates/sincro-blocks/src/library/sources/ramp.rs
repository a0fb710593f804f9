//! Block `ramp`.

use crate::library::prelude::*;

declare_block! {
    /// Rises at a constant rate between two instants.
    pub struct Ramp("ramp", Sources): "y = from + slope·(min(t, until) − start) for t ≥ start, else from" {
        /// Rate of y `[1/s]`.
        pub slope: Vec<f64> as PerComponent = "1",
        /// Start of the rise `[s]`.
        pub start: f64 as Number = "0",
        /// y before the start.
        pub from: Vec<f64> as PerComponent = "0",
        /// End of the rise `[s]`.
        pub until: f64 as Limit = "inf",
    }
}

impl Ramp {
    /// Creates the block: from 0 at time 0, for ever.
    #[must_use]
    pub fn new(slope: f64) -> Self {
        Self { start: 0.0, slope: vec![slope], from: vec![0.0], until: f64::INFINITY }
    }
}

impl Block for Ramp {
    type Work<R: Real> = ();

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.until < self.start {
            p.fault("until", format!("`until` {} is before `start` {}", self.until, self.start), "exchange them");
        }
    }

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let rising = (at.t.min(self.until) - self.start).max(0.0);
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::splat(of(&self.from, i) + of(&self.slope, i) * rising);
        }
    }

    fn next_time_event(&self, t: f64) -> f64 {
        let later = [self.start, self.until].into_iter().filter(|event| t + SAME_INSTANT < *event);
        later.fold(f64::INFINITY, f64::min)
    }

    fn label(&self) -> String {
        format!("{}·t", short_list(&self.slope))
    }
}
