//! `y = from` before `time`, `to` from it on.

use sincro_math::Real;

use crate::block::{At, Block, Ports, SAME_INSTANT, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short_list;
use crate::reader::Reader;

/// Jumps from one value to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Instant of the jump `[s]`.
    pub time: f64,
    /// Value before, one for all components or one for each.
    pub from: Vec<f64>,
    /// Value from the jump on, one for all components or one for each.
    pub to: Vec<f64>,
}

impl Step {
    /// From 0 to `to` at `time` `[s]`.
    #[must_use]
    pub fn new(time: f64, to: f64) -> Self {
        Self { time, from: vec![0.0], to: vec![to] }
    }
}

impl Described for Step {
    const KIND: &'static Kind = &Kind {
        name: "step",
        group: Group::Sources,
        summary: "Jumps from one value to another.",
        equation: "y = from for t < time, to for t ≥ time",
        parameters: &[
            Parameter::optional("time", Takes::Number, "instant of the jump [s]", "0"),
            Parameter::optional("from", Takes::Numbers, "y before the jump", "0"),
            Parameter::optional("to", Takes::Numbers, "y from the jump on", "1"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { time: p.number("time"), from: p.numbers("from"), to: p.numbers("to") }
    }
}

impl Block for Step {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(&[], &[("from", self.from.len()), ("to", self.to.len())])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let value = if at.time() < self.time - SAME_INSTANT { &self.from } else { &self.to };
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::splat(of(value, i));
        }
    }

    fn next_corner(&self, t: f64) -> f64 {
        if t + SAME_INSTANT < self.time { self.time } else { f64::INFINITY }
    }

    fn label(&self) -> String {
        format!("{} → {}", short_list(&self.from), short_list(&self.to))
    }
}
