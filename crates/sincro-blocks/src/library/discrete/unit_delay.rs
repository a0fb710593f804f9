//! `y[k] = u[k−1]`.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::Unit;

/// The input of the sample before.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitDelay {
    /// Output in the first sample, one for all components or one for each.
    pub initial: Vec<f64>,
}

impl UnitDelay {
    /// With one initial value for all components.
    #[must_use]
    pub fn new(initial: f64) -> Self {
        Self { initial: vec![initial] }
    }
}

impl Described for UnitDelay {
    const KIND: &'static Kind = &Kind {
        name: "unit-delay",
        group: Group::Discrete,
        summary: "The input of the sample before.",
        equation: "y[k] = u[k−1], y[0] = initial",
        parameters: &[Parameter::optional("initial", Takes::Numbers, "y in the first sample", "0")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { initial: p.numbers("initial") }
    }
}

impl Block for UnitDelay {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let own = self.initial.len();
        Ok(vec![if own > 1 { elementwise(inputs, &[("initial", own)])? } else { inputs[0] }])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn feeds_through(&self, _: usize) -> bool {
        false
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = R::splat(of(&self.initial, i));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(at.memory);
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = at.component(0, i);
        }
    }

    fn label(&self) -> String {
        "z⁻¹".into()
    }
}
