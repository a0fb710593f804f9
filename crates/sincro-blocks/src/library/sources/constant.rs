//! `y = value`.

use sincro_math::Real;

use crate::block::{At, Block, Pace, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// The same at all times.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// One number a component.
    pub value: Vec<f64>,
}

impl Constant {
    /// A scalar.
    #[must_use]
    pub fn new(value: f64) -> Self {
        Self { value: vec![value] }
    }
}

impl Described for Constant {
    const KIND: &'static Kind = &Kind {
        name: "constant",
        group: Group::Sources,
        summary: "The same at all times.",
        equation: "y = value",
        parameters: &[Parameter::required("value", Takes::Numbers, "what it gives")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { value: p.numbers("value") }
    }
}

impl Block for Constant {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![Some(self.value.len())])
    }

    fn pace(&self) -> Pace {
        Pace::Constant
    }

    fn output<R: Real>(&self, _: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, value) in y.iter_mut().zip(&self.value) {
            *y = R::splat(*value);
        }
    }

    fn label(&self) -> String {
        crate::library::short_list(&self.value)
    }
}
