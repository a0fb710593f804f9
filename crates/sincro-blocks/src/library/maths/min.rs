//! `y = min(u1, u2, …)`.

use sincro_math::Real;

use super::{extremum, n_inputs};
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::{Unit, common};

/// Least of its inputs, component by component; of a single input: the least of its components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Min {
    /// Number of inputs.
    pub inputs: usize,
}

impl Min {
    /// With so many inputs, at least 1.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
    }
}

impl Described for Min {
    const KIND: &'static Kind = &Kind {
        name: "min",
        group: Group::Maths,
        summary: "The least of its inputs, component by component, or the least component of a single input.",
        equation: "y = min(u1, u2, …); of one input y = min uᵢ",
        parameters: &[Parameter::optional("inputs", Takes::Count, "number of inputs", "2")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self::new(n_inputs(p))
    }
}

impl Block for Min {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        extremum::widths(inputs)
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![common(inputs)?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        extremum::output(at, y, extremum::smaller);
    }

    fn label(&self) -> String {
        "min".into()
    }
}
