//! Block `edge`.

use super::truth::{number, test};
use crate::library::prelude::*;

declare_block! {
    /// Is 1 in the sample in which the input becomes true or false.
    ///
    /// It works component by component. Zero is false, any other number true.
    pub struct Edge("edge", Logic):
        "rising: y[k] = u[k] and not u[k−1]; falling: y[k] = not u[k] and u[k−1]; either: y[k] = u[k] xor u[k−1]" {
        /// Becoming true, becoming false, or both.
        pub direction: Direction as Choice = "rising",
        /// u before the first sample.
        pub initial: bool as Flag = "false",
    }
}

choice! {
    /// Change of a truth.
    pub enum Direction {
        /// From false to true.
        Rising = "rising",
        /// From true to false.
        Falling = "falling",
        /// Any of the two.
        Either = "either",
    }
}

impl Edge {
    /// The input counts as false before the first sample.
    #[must_use]
    pub fn new(direction: Direction) -> Self {
        Self { direction, initial: false }
    }
}

impl Block for Edge {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        memory.fill(R::splat(number(self.initial)));
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::fixed(["1"])
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
