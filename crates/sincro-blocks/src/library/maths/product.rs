//! `y = u1·u2·…`.

use sincro_math::Real;

use super::n_inputs;
use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Multiplies its inputs component by component; a single input: all its components with each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Product {
    /// Number of inputs.
    pub inputs: usize,
}

impl Product {
    /// With so many inputs, at least 1.
    #[must_use]
    pub fn new(inputs: usize) -> Self {
        Self { inputs }
    }
}

impl Described for Product {
    const KIND: &'static Kind = &Kind {
        name: "product",
        group: Group::Maths,
        summary: "Multiplies its inputs component by component, or all components of a single input.",
        equation: "y = u1·u2·…; of one input y = Π uᵢ",
        parameters: &[Parameter::optional("inputs", Takes::Count, "number of inputs", "2")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self::new(n_inputs(p))
    }
}

impl Block for Product {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![if self.inputs == 1 { Some(1) } else { elementwise(inputs, &[])? }])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        if self.inputs == 1 {
            y[0] = at.input(0).iter().fold(R::one(), |product, u| product * *u);
            return;
        }
        for (i, y) in y.iter_mut().enumerate() {
            *y = (1..self.inputs).fold(at.component(0, i), |product, k| product * at.component(k, i));
        }
    }

    fn label(&self) -> String {
        if self.inputs == 1 { "Π".into() } else { "×".into() }
    }
}
