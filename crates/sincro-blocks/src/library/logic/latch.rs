//! `y[k] = not reset[k] and (set[k] or y[k−1])`; if `set` wins, `set[k] or (y[k−1] and not reset[k])`.

use sincro_math::Real;

use super::truth::number;
use crate::block::{At, Block, Memory, Node, Pace, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Set–reset flip-flop: remembers that it was set until it is reset, component by component. Zero is false, any other number true.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Latch {
    /// Output before the first sample.
    pub initial: bool,
    /// Whether `set` wins if both inputs are true; else `reset` does.
    pub set_wins: bool,
}

impl Latch {
    /// Not set at first; `reset` wins.
    #[must_use]
    pub fn new() -> Self {
        Self { initial: false, set_wins: false }
    }

    /// The output for inputs and the output before; NaN where one of them is.
    fn next(&self, set: f64, reset: f64, before: f64) -> f64 {
        if (set + reset + before).is_nan() {
            return f64::NAN;
        }
        let (set, reset, before) = (set != 0.0, reset != 0.0, before != 0.0);
        number(if self.set_wins { set || (before && !reset) } else { !reset && (set || before) })
    }
}

impl Default for Latch {
    fn default() -> Self {
        Self::new()
    }
}

impl Described for Latch {
    const KIND: &'static Kind = &Kind {
        name: "latch",
        group: Group::Logic,
        summary: "Set–reset flip-flop: remembers that it was set until it is reset.",
        equation: "y[k] = not reset[k] and (set[k] or y[k−1]); set dominant: y[k] = set[k] or (y[k−1] and not reset[k])",
        parameters: &[
            Parameter::optional("initial", Takes::Flag, "y before the first sample", "false"),
            Parameter::optional(
                "dominant",
                Takes::Choice(&["reset", "set"]),
                "which input wins if both are true",
                "reset",
            ),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { initial: p.flag("initial"), set_wins: p.choice("dominant") == 1 }
    }
}

impl Block for Latch {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["set", "reset"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[])?])
    }

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        memory.fill(R::splat(number(self.initial)));
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let (set, reset) = (at.component(0, i), at.component(1, i));
            *y = R::from_lanes(|k| self.next(set.lane(k), reset.lane(k), at.memory[i].lane(k)));
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, work: &mut (), memory: &mut [R], _: &mut [R]) {
        self.output(at, work, memory);
    }

    fn label(&self) -> String {
        "S R".into()
    }
}
