//! `y = amplitude·sin(2π·c(t))`, `dc/dt` rising linearly from `from_hz` to `to_hz`.

use core::f64::consts::TAU;

use sincro_math::{Real, elementary};

use crate::block::{At, Block, Ports, SAME_INSTANT};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short;
use crate::reader::Reader;

/// A sine whose frequency sweeps linearly over a duration and then stays; the phase is continuous throughout.
#[derive(Clone, Debug, PartialEq)]
pub struct Chirp {
    /// Frequency at time 0 `[Hz]`.
    pub from_hz: f64,
    /// Frequency at the end of the sweep and afterwards `[Hz]`.
    pub to_hz: f64,
    /// How long the sweep takes `[s]`.
    pub duration: f64,
    /// Amplitude.
    pub amplitude: f64,
}

impl Chirp {
    /// With amplitude 1.
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

impl Described for Chirp {
    const KIND: &'static Kind = &Kind {
        name: "chirp",
        group: Group::Sources,
        summary: "A sine whose frequency sweeps linearly from one value to another and then stays.",
        equation: "y = amplitude·sin(2π·c), c = from_hz·t + (to_hz − from_hz)·t²/(2·duration) for t ≤ duration, \
                   c = (from_hz + to_hz)/2·duration + to_hz·(t − duration) afterwards",
        parameters: &[
            Parameter::required("from_hz", Takes::Number, "frequency at t = 0 [Hz]"),
            Parameter::required("to_hz", Takes::Number, "frequency from t = duration on [Hz]"),
            Parameter::required("duration", Takes::Positive, "length of the sweep [s]"),
            Parameter::optional("amplitude", Takes::Number, "amplitude of y", "1"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self {
            from_hz: p.number("from_hz"),
            to_hz: p.number("to_hz"),
            duration: p.positive("duration"),
            amplitude: p.number("amplitude"),
        }
    }
}

impl Block for Chirp {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![Some(1)])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (sine, _) = elementary::sin_cos(TAU * self.cycles(at.t));
        y[0] = R::splat(self.amplitude * sine);
    }

    /// Where the sweep ends, the second derivative jumps.
    fn next_corner(&self, t: f64) -> f64 {
        if t + SAME_INSTANT < self.duration { self.duration } else { f64::INFINITY }
    }

    fn label(&self) -> String {
        format!("{} … {} Hz", short(self.from_hz), short(self.to_hz))
    }
}
