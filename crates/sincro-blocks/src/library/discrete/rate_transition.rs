//! `y(t) = u(t_k)`, or `u(t_{k−1})`, for `t_k ≤ t < t_{k+1}`.
//!
//! Give it the sample time of the slower side. From fast to slow it takes the latest sample at once and holds it. From
//! slow to fast, `delayed` hands over what the slow side computed a sample ago: as in a computer whose slow task needs
//! its whole period. A delayed one has no direct feedthrough.

use crate::library::prelude::*;

declare_block! {
    /// Hands a signal over between two sample times, at once or a sample later.
    pub struct RateTransition("rate-transition", Discrete):
        "y[k] = u[k], or y[k] = u[k−1] if delayed, held in between" {
        /// Hands over the sample before.
        pub delayed: bool as Flag = "false",
        /// y in the first sample, if delayed.
        pub initial: Vec<f64> as PerComponent = "0",
    }
}

impl RateTransition {
    /// Creates the block: from zero.
    #[must_use]
    pub fn new(delayed: bool) -> Self {
        Self { delayed, initial: vec![0.0] }
    }
}

impl Block for RateTransition {
    type Work<R: Real> = ();
    const KEEPS_UNIT: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        !self.delayed
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: if self.delayed { node.n_out() } else { 0 } }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        fill(memory, &self.initial);
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = if self.delayed { at.memory[i] } else { at.component(0, i) };
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        at.copy_input(0, memory);
    }

    fn label(&self) -> String {
        if self.delayed { "z⁻¹".into() } else { "ZOH".into() }
    }
}
