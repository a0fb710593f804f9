//! `y[k] = u[k] and not u[k−1]` (rising), `not u[k] and u[k−1]` (falling), or either.

use sincro_math::Real;

use super::truth::{number, test};
use crate::block::{At, Block, Memory, Node, Pace, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Is 1 in the sample in which the input becomes true or false, component by component. Zero is false, any other number true.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Which change it looks for.
    pub direction: Direction,
    /// Whether the input counts as true before the first sample.
    pub initial: bool,
}

/// A change of a truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From false to true.
    Rising,
    /// From true to false.
    Falling,
    /// Any of the two.
    Either,
}

impl Edge {
    /// The input counts as false before the first sample.
    #[must_use]
    pub fn new(direction: Direction) -> Self {
        Self { direction, initial: false }
    }
}

impl Described for Edge {
    const KIND: &'static Kind = &Kind {
        name: "edge",
        group: Group::Logic,
        summary: "Is 1 in the sample in which the input becomes true or false.",
        equation: "rising: y[k] = u[k] and not u[k−1]; falling: y[k] = not u[k] and u[k−1]; either: y[k] = u[k] xor u[k−1]",
        parameters: &[
            Parameter::optional(
                "direction",
                Takes::Choice(&["rising", "falling", "either"]),
                "becoming true, becoming false, or both",
                "rising",
            ),
            Parameter::optional("initial", Takes::Flag, "what counts as u before the first sample", "false"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let direction = [Direction::Rising, Direction::Falling, Direction::Either][p.choice("direction")];
        Self { direction, initial: p.flag("initial") }
    }
}

impl Block for Edge {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(inputs.to_vec())
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
            *y = test(at.component(0, i), at.memory[i], |now, before| match self.direction {
                Direction::Rising => now != 0.0 && before == 0.0,
                Direction::Falling => now == 0.0 && before != 0.0,
                Direction::Either => (now != 0.0) != (before != 0.0),
            });
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        memory.copy_from_slice(at.input(0));
    }

    fn label(&self) -> String {
        match self.direction {
            Direction::Rising => "↑",
            Direction::Falling => "↓",
            Direction::Either => "↕",
        }
        .into()
    }
}
