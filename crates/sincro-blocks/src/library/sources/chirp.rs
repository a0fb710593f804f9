//! Block `chirp`.

use core::f64::consts::TAU;

use crate::library::prelude::*;

declare_block! {
    /// A sine whose frequency sweeps linearly from one value to another and then stays.
    ///
    /// The phase is continuous throughout.
    pub struct Chirp("chirp", Sources):
        "y = amplitude·sin(2π·c), c = from_hz·t + (to_hz − from_hz)·t²/(2·duration) for t ≤ duration, c = (from_hz + to_hz)/2·duration + to_hz·(t − duration) afterwards" {
        /// Frequency at t = 0 `[Hz]`.
        pub from_hz: f64 as Number,
        /// Frequency from t = duration on `[Hz]`.
        pub to_hz: f64 as Number,
        /// Length of the sweep `[s]`.
        pub duration: f64 as Positive,
        /// Amplitude of y.
        pub amplitude: f64 as Number = "1",
    }
}

impl Chirp {
    /// Creates the block with amplitude 1.
    #[must_use]
    pub fn new(from_hz: f64, to_hz: f64, duration: f64) -> Self {
        Self { from_hz, to_hz, duration, amplitude: 1.0 }
    }

    /// Cycles since time 0: the integral of the frequency.
    fn cycles(&self, t: f64) -> f64 {
        let sweep = t.min(self.duration);
        let mean_hz = self.from_hz + (self.to_hz - self.from_hz) * sweep / (2.0 * self.duration);
        mean_hz * sweep + self.to_hz * (t - sweep)
    }
}

impl Block for Chirp {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (sine, _) = elementary::sin_cos(TAU * self.cycles(at.t));
        y[0] = R::splat(self.amplitude * sine);
    }

    /// End of the sweep: the second derivative jumps.
    fn next_time_event(&self, t: f64) -> f64 {
        if t + SAME_INSTANT < self.duration { self.duration } else { f64::INFINITY }
    }

    fn highest_frequency(&self, until: f64, _: bool) -> f64 {
        if self.amplitude == 0.0 {
            return 0.0;
        }
        let reached = self.from_hz + (self.to_hz - self.from_hz) * (until / self.duration).min(1.0);
        self.from_hz.abs().max(reached.abs())
    }

    fn label(&self) -> String {
        format!("{} … {} Hz", short(self.from_hz), short(self.to_hz))
    }
}
