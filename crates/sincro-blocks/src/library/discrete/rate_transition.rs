//! `y(t) = u(t_k)`, or `u(t_{k−1})`, for `t_k ≤ t < t_{k+1}`.
//!
//! Give it the sample time of the slower side. From fast to slow it takes the latest sample at once and holds it. From slow to fast,
//! `delayed` hands over what the slow side computed a sample ago: as in a computer whose slow task needs its whole period. A delayed
//! one does not feed through.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::Unit;

/// Hands a signal over between two sample times.
#[derive(Clone, Debug, PartialEq)]
pub struct RateTransition {
    /// Whether it hands over the sample before.
    pub delayed: bool,
    /// Output in the first sample, if delayed.
    pub initial: Vec<f64>,
}

impl RateTransition {
    /// From zero.
    #[must_use]
    pub fn new(delayed: bool) -> Self {
        Self { delayed, initial: vec![0.0] }
    }
}

impl Described for RateTransition {
    const KIND: &'static Kind = &Kind {
        name: "rate-transition",
        group: Group::Discrete,
        summary: "Hands a signal over between two sample times, at once or a sample later.",
        equation: "y[k] = u[k], or y[k] = u[k−1] if delayed, held in between",
        parameters: &[
            Parameter::optional("delayed", Takes::Flag, "whether it hands over the sample before", "false"),
            Parameter::optional("initial", Takes::Numbers, "y in the first sample, if delayed", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { delayed: p.flag("delayed"), initial: p.numbers("initial") }
    }
}

impl Block for RateTransition {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[("initial", self.initial.len())])?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn feeds_through(&self, _: usize) -> bool {
        !self.delayed
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: if self.delayed { node.n_out() } else { 0 } }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = R::splat(of(&self.initial, i));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = if self.delayed { at.memory[i] } else { at.component(0, i) };
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = at.component(0, i);
        }
    }

    fn label(&self) -> String {
        if self.delayed { "z⁻¹".into() } else { "ZOH".into() }
    }
}
