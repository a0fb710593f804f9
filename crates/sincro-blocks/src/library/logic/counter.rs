//! Block `counter`.

use super::truth::is_true;
use crate::library::prelude::*;

declare_block! {
    /// Counts how often its input became true.
    ///
    /// Zero is false, any other number true.
    pub struct Counter("counter", Logic):
        "y[k] = y[k−1] + (1 if u[k] and not u[k−1], else 0); y[k] = 0 while reset[k]" {
        /// y before the first sample.
        pub initial: usize as Count = "0",
        /// Adds an input `reset`.
        pub reset: bool as Flag = "false",
    }
}

impl Counter {
    /// Creates the block: from 0 on, without reset.
    #[must_use]
    pub fn new() -> Self {
        Self { initial: 0, reset: false }
    }
}

impl Default for Counter {
    fn default() -> Self {
        Self::new()
    }
}

impl Block for Counter {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn ports(&self) -> Ports {
        Ports::new(if self.reset { &["u", "reset"] } else { &["u"] }, &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        match inputs.iter().position(|width| width.is_some_and(|w| w != 1)) {
            Some(k) => Err(format!("input {} has {} components instead of 1", k + 1, inputs[k].unwrap_or(0))),
            None => Ok(vec![Some(1)]),
        }
    }

    /// The count and the input of the sample before.
    fn memory(&self, _: &Node) -> Memory {
        Memory { continuous: 0, discrete: 2 }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        memory[0] = R::splat(self.initial as f64);
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::fixed(["1"])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (u, count) = (at.scalar(0), at.memory[0]);
        // 0, or NaN if an input is
        let poison = R::zero() * if self.reset { u + at.scalar(1) } else { u };
        let has_risen = is_true(u) && !is_true(at.memory[1]);
        let counted = if has_risen { count + R::one() } else { count };
        y[0] = if self.reset && is_true(at.scalar(1)) { R::zero() } else { counted } + poison;
    }

    fn update<R: Real>(&self, at: &At<'_, R>, work: &mut (), memory: &mut [R], _: &mut [R]) {
        self.output(at, work, &mut memory[..1]);
        memory[1] = at.scalar(0);
    }

    fn label(&self) -> String {
        "n + 1".into()
    }
}
