//! `y = interval·round(u/interval)`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::Unit;

/// Rounds to whole multiples of an interval, halves away from zero, zero itself never negative: an encoder, a converter. Its derivative is zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantizer {
    /// Distance of two values, one for all components or one for each.
    pub interval: Vec<f64>,
}

impl Quantizer {
    /// With one interval for all components.
    #[must_use]
    pub fn new(interval: f64) -> Self {
        Self { interval: vec![interval] }
    }
}

impl Described for Quantizer {
    const KIND: &'static Kind = &Kind {
        name: "quantizer",
        group: Group::Nonlinear,
        summary: "Rounds to whole multiples of an interval, as an encoder or a converter does.",
        equation: "y = interval·round(u/interval), halves away from zero",
        parameters: &[Parameter::required("interval", Takes::Numbers, "distance of two values of y")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { interval: p.positives("interval") }
    }
}

impl Block for Quantizer {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[("interval", self.interval.len())])?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let interval = of(&self.interval, i);
            // a zero is a positive one: wires that carry whole numbers know no other
            *y = at.component(0, i).map(|u| (interval * (u / interval).round() + 0.0, 0.0));
        }
    }

    fn label(&self) -> String {
        crate::library::short_list(&self.interval)
    }
}
