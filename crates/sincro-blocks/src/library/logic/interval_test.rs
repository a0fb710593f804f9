//! `y = lower ≤ u ≤ upper`: 1 if it holds, else 0.

use sincro_math::Real;

use super::truth::test;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::library::short;
use crate::reader::Reader;

/// Whether the input is between two bounds, bounds included, component by component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntervalTest {
    /// Lower bound; may be −∞.
    pub lower: f64,
    /// Upper bound; may be ∞.
    pub upper: f64,
}

impl IntervalTest {
    /// Between two bounds.
    #[must_use]
    pub fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper }
    }
}

impl Described for IntervalTest {
    const KIND: &'static Kind = &Kind {
        name: "interval-test",
        group: Group::Logic,
        summary: "Whether the input is between two bounds, bounds included, component by component.",
        equation: "y = 1 if lower ≤ u ≤ upper, else 0",
        parameters: &[
            Parameter::optional("lower", Takes::Number, "lower bound", "-inf"),
            Parameter::optional("upper", Takes::Number, "upper bound", "inf"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let new = Self { lower: p.limit("lower"), upper: p.limit("upper") };
        if new.lower > new.upper {
            p.fault("lower", format!("`lower` {} is above `upper` {}", new.lower, new.upper), "exchange them");
        }
        new
    }
}

impl Block for IntervalTest {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            *y = test(*u, *u, |u, _| self.lower <= u && u <= self.upper);
        }
    }

    fn label(&self) -> String {
        format!("{} ≤ u ≤ {}", short(self.lower), short(self.upper))
    }
}
