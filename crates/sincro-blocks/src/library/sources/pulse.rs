//! `y = high` for `width` in every `period`, else `low`.

use sincro_math::Real;

use super::cycle::Cycle;
use crate::block::{At, Block, Ports, SAME_INSTANT, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short;
use crate::reader::Reader;

/// A train of rectangular pulses.
#[derive(Clone, Debug, PartialEq)]
pub struct Pulse {
    /// From one rising edge to the next `[s]`.
    pub period: f64,
    /// Length of a pulse `[s]`, at most the period.
    pub width: f64,
    /// Value between pulses and before the first; one for all components or one for each.
    pub low: Vec<f64>,
    /// Value in a pulse; one for all components or one for each.
    pub high: Vec<f64>,
    /// The first rising edge `[s]`.
    pub start: f64,
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

impl Described for Pulse {
    const KIND: &'static Kind = &Kind {
        name: "pulse",
        group: Group::Sources,
        summary: "A train of rectangular pulses.",
        equation: "y = high for 0 ≤ (t − start) mod period < width and t ≥ start, else low",
        parameters: &[
            Parameter::required("period", Takes::Positive, "from one rising edge to the next [s]"),
            Parameter::required("width", Takes::Positive, "length of a pulse, at most the period [s]"),
            Parameter::optional("low", Takes::Numbers, "y between pulses and before the first", "0"),
            Parameter::optional("high", Takes::Numbers, "y in a pulse", "1"),
            Parameter::optional("start", Takes::Number, "the first rising edge [s]", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let new = Self {
            period: p.positive("period"),
            width: p.positive("width"),
            low: p.numbers("low"),
            high: p.numbers("high"),
            start: p.number("start"),
        };
        if new.width > new.period {
            let message = format!("`width` {} s is longer than `period` {} s", new.width, new.period);
            p.fault("width", message, "it must be at most the period");
        }
        new
    }
}

impl Block for Pulse {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(&[], &[("low", self.low.len()), ("high", self.high.len())])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let is_high = self.cycle().phase(at.time()).is_some_and(|phase| phase < self.width - SAME_INSTANT);
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::splat(of(if is_high { &self.high } else { &self.low }, i));
        }
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.cycle().next(t, 0.0).min(self.cycle().next(t, self.width))
    }

    fn label(&self) -> String {
        format!("{} s / {} s", short(self.width), short(self.period))
    }
}
