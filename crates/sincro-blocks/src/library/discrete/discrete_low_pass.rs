//! `y[k] = y[k−1] + (1 − e^(−Ts/T))·(dc_gain·u[k] − y[k−1])`: a first-order lag, exact over one sample.
//!
//! The solution of `T·y' = dc_gain·u − y` after the time Ts under a constant input, so it is stable for every T > 0, where forward
//! Euler needs Ts < 2T.

use sincro_math::{Real, elementary};

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// A first-order lag at a sample time. It feeds through: the input of a sample counts for the whole interval that ends at it.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteLowPass {
    /// Time after which a step is answered to 63 % `[s]`, one for all components or one for each.
    pub time_constant: Vec<f64>,
    /// Gain for a constant input.
    pub dc_gain: Vec<f64>,
    /// Value before the first sample.
    pub initial: Vec<f64>,
}

impl DiscreteLowPass {
    /// With gain 1, from zero.
    #[must_use]
    pub fn new(time_constant: f64) -> Self {
        Self { time_constant: vec![time_constant], dc_gain: vec![1.0], initial: vec![0.0] }
    }
}

impl Described for DiscreteLowPass {
    const KIND: &'static Kind = &Kind {
        name: "discrete-low-pass",
        group: Group::Discrete,
        summary: "A first-order lag, discretised exactly.",
        equation: "y[k] = y[k−1] + (1 − e^(−Ts/time_constant))·(dc_gain·u[k] − y[k−1]), y[−1] = initial",
        parameters: &[
            Parameter::required(
                "time_constant",
                Takes::Numbers,
                "time after which a step is answered to 63 % [s]; 0 for none",
            ),
            Parameter::optional("dc_gain", Takes::Numbers, "gain for a constant input", "1"),
            Parameter::optional("initial", Takes::Numbers, "y before the first sample", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let time_constant = p.numbers("time_constant");
        if time_constant.iter().any(|t| *t < 0.0) {
            p.fault("time_constant", "a time constant is negative", "it must be 0 or more");
        }
        Self { time_constant, dc_gain: p.numbers("dc_gain"), initial: p.numbers("initial") }
    }
}

impl Block for DiscreteLowPass {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let parameters = [
            ("time_constant", self.time_constant.len()),
            ("dc_gain", self.dc_gain.len()),
            ("initial", self.initial.len()),
        ];
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
            *x = R::splat(of(&self.initial, i));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let rest = elementary::exp(-at.node.period() / of(&self.time_constant, i)).0;
            let target = R::splat(of(&self.dc_gain, i)) * at.component(0, i);
            *y = target + (at.memory[i] - target) * R::splat(rest);
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        self.output(at, &mut (), memory);
    }

    fn label(&self) -> String {
        "(1 − a)·z/(z − a)".into()
    }
}
