//! `y = low + (high − low)·phase/period`, again in every period.

use sincro_math::Real;

use super::cycle::Cycle;
use crate::block::{At, Block, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Rises evenly over a period, then jumps back.
#[derive(Clone, Debug, PartialEq)]
pub struct Sawtooth {
    /// From one jump to the next `[s]`.
    pub period: f64,
    /// Value after a jump and before the start; one for all components or one for each.
    pub low: Vec<f64>,
    /// Value just before a jump; one for all components or one for each.
    pub high: Vec<f64>,
    /// When it begins to rise `[s]`.
    pub start: f64,
}

impl Sawtooth {
    /// From 0 to 1 in a period in `[s]`, from time 0 on.
    #[must_use]
    pub fn new(period: f64) -> Self {
        Self { period, low: vec![0.0], high: vec![1.0], start: 0.0 }
    }

    fn cycle(&self) -> Cycle {
        Cycle { start: self.start, period: self.period }
    }
}

impl Described for Sawtooth {
    const KIND: &'static Kind = &Kind {
        name: "sawtooth",
        group: Group::Sources,
        summary: "Rises evenly over a period, then jumps back.",
        equation: "y = low + (high − low)·((t − start) mod period)/period for t ≥ start, else low",
        parameters: &[
            Parameter::required("period", Takes::Positive, "from one jump to the next [s]"),
            Parameter::optional("low", Takes::Numbers, "y after a jump and before the start", "0"),
            Parameter::optional("high", Takes::Numbers, "y just before a jump", "1"),
            Parameter::optional("start", Takes::Number, "when it begins to rise [s]", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { period: p.positive("period"), low: p.numbers("low"), high: p.numbers("high"), start: p.number("start") }
    }
}

impl Block for Sawtooth {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(&[], &[("low", self.low.len()), ("high", self.high.len())])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let share = self.cycle().phase(at.time()).unwrap_or(0.0) / self.period;
        for (i, y) in y.iter_mut().enumerate() {
            let (low, high) = (of(&self.low, i), of(&self.high, i));
            *y = R::splat(low + (high - low) * share);
        }
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.cycle().next(t, 0.0)
    }
}
