//! `y = [u1, u2, …]`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::{Unit, common};

/// Puts its inputs one after the other into one vector. A wire from `[a, b]` does the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mux {
    /// Number of inputs.
    pub inputs: usize,
}

impl Mux {
    /// With so many inputs.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
    }
}

impl Described for Mux {
    const KIND: &'static Kind = &Kind {
        name: "mux",
        group: Group::Routing,
        summary: "Puts its inputs one after the other into one vector, as a wire from `[a, b]` does.",
        equation: "y = [u1, u2, …]",
        parameters: &[Parameter::optional("inputs", Takes::Count, "number of inputs", "2")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let inputs = p.port_count("inputs");
        if inputs == 0 {
            p.fault("inputs", "`inputs` is 0", "it must be 1 or more");
        }
        Self::new(inputs.clamp(1, 1000))
    }
}

impl Block for Mux {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![inputs.iter().copied().sum()])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        // components may differ; the vector then has no unit
        Ok(vec![common(inputs).ok().flatten()])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let mut from = 0;
        for k in 0..self.inputs {
            let u = at.input(k);
            y[from..from + u.len()].copy_from_slice(u);
            from += u.len();
        }
    }
}
