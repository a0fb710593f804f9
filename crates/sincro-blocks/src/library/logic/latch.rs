//! Block `latch`.

use super::truth::number;
use crate::library::prelude::*;

declare_block! {
    /// Set–reset flip-flop: remembers that it was set until it is reset.
    ///
    /// It works component by component. Zero is false, any other number true.
    pub struct Latch("latch", Logic):
        "y[k] = not reset[k] and (set[k] or y[k−1]); set dominant: y[k] = set[k] or (y[k−1] and not reset[k])" {
        /// y before the first sample.
        pub initial: bool as Flag = "false",
        /// Input that wins if both are true.
        pub dominant: Dominant as Choice = "reset",
    }
}

choice! {
    /// Input of a latch that wins if both are true.
    pub enum Dominant {
        /// `reset`.
        Reset = "reset",
        /// `set`.
        Set = "set",
    }
}

impl Latch {
    /// Not set at first; `reset` wins.
    #[must_use]
    pub fn new() -> Self {
        Self { initial: false, dominant: Dominant::Reset }
    }

    /// The output for inputs and the output before; NaN where one of them is.
    fn next(&self, set: f64, reset: f64, before: f64) -> f64 {
        if (set + reset + before).is_nan() {
            return f64::NAN;
        }
        let (set, reset, before) = (set != 0.0, reset != 0.0, before != 0.0);
        number(if self.dominant == Dominant::Set { set || (before && !reset) } else { !reset && (set || before) })
    }
}

impl Default for Latch {
    fn default() -> Self {
        Self::new()
    }
}

impl Block for Latch {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn ports(&self) -> Ports {
        Ports::new(&["set", "reset"], &["y"])
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        memory.fill(R::splat(number(self.initial)));
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::fixed(["1"])
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
