//! `y[k] = gain·(u[k] − u[k−1])/Ts`.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// The change since the sample before, over the sample time.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteDerivative {
    /// Factor, one for all components or one for each.
    pub gain: Vec<f64>,
    /// Value that the input had before the start.
    pub initial_input: Vec<f64>,
}

impl DiscreteDerivative {
    /// Of an input that was zero before the start.
    #[must_use]
    pub fn new(gain: f64) -> Self {
        Self { gain: vec![gain], initial_input: vec![0.0] }
    }
}

impl Described for DiscreteDerivative {
    const KIND: &'static Kind = &Kind {
        name: "discrete-derivative",
        group: Group::Discrete,
        summary: "The change since the sample before, over the sample time.",
        equation: "y[k] = gain·(u[k] − u[k−1])/Ts, u[−1] = initial_input",
        parameters: &[
            Parameter::optional("gain", Takes::Numbers, "factor", "1"),
            Parameter::optional("initial_input", Takes::Numbers, "value that u had before the start", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { gain: p.numbers("gain"), initial_input: p.numbers("initial_input") }
    }
}

impl Block for DiscreteDerivative {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let parameters = [("gain", self.gain.len()), ("initial_input", self.initial_input.len())];
        Ok(vec![elementwise(inputs, &parameters)?])
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = R::splat(of(&self.initial_input, i));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let change = at.component(0, i) - at.memory[i];
            *y = R::splat(of(&self.gain, i)) * change / R::splat(at.node.period());
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = at.component(0, i);
        }
    }

    fn label(&self) -> String {
        "(z − 1)/(Ts·z)".into()
    }
}
