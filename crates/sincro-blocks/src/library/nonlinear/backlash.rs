//! `y` is dragged along by `u` with a play of `width`.

use sincro_math::Real;

use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;
use crate::unit::Unit;

/// Play, as between the teeth of two wheels: the output moves only when the input has reached an end of the gap. It works at
/// samples, or at every tick if it has no sample time.
#[derive(Clone, Debug, PartialEq)]
pub struct Backlash {
    /// Whole width of the gap, one for all components or one for each.
    pub width: Vec<f64>,
    /// Output before the start.
    pub initial: Vec<f64>,
}

impl Backlash {
    /// From zero, with one width for all components.
    #[must_use]
    pub fn new(width: f64) -> Self {
        Self { width: vec![width], initial: vec![0.0] }
    }

    #[inline(always)]
    fn dragged<R: Real>(&self, at: &At<'_, R>, i: usize) -> R {
        let (u, half) = (at.component(0, i), R::splat(0.5 * of(&self.width, i)));
        // in this order a NaN of the input stays
        (u - half).max(at.memory[i]).min(u + half)
    }
}

impl Described for Backlash {
    const KIND: &'static Kind = &Kind {
        name: "backlash",
        group: Group::Nonlinear,
        summary: "Play, as between the teeth of two wheels.",
        equation: "y[k] = min(max(y[k−1], u − width/2), u + width/2)",
        parameters: &[
            Parameter::required("width", Takes::Numbers, "whole width of the gap"),
            Parameter::optional("initial", Takes::Numbers, "y before the start", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { width: p.positives("width"), initial: p.numbers("initial") }
    }
}

impl Block for Backlash {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[("width", self.width.len()), ("initial", self.initial.len())])?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
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
            *y = self.dragged(at, i);
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = self.dragged(at, i);
        }
    }

    fn label(&self) -> String {
        crate::library::short_list(&self.width)
    }
}
