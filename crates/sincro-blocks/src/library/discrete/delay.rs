//! `y[k] = u[k−samples]`.
//!
//! The input of sample k stands in slot k mod `samples` of a ring. With no sample it is a piece of wire, so that a
//! latency can be set to nothing.

use crate::library::prelude::*;

declare_block! {
    /// The input of some samples before.
    pub struct Delay("delay", Discrete): "y[k] = u[k−samples], y[k] = initial for k < samples" {
        /// Number of samples; 0 for none, it then has direct feedthrough.
        pub samples: usize as Count,
        /// y until the first input has arrived.
        pub initial: Vec<f64> as PerComponent = "0",
    }
}

impl Delay {
    /// Creates the block with zero until the first input has arrived.
    #[must_use]
    pub fn new(samples: usize) -> Self {
        Self { samples, initial: vec![0.0] }
    }

    fn slot<R>(&self, at: &At<'_, R>) -> usize {
        (at.tick / at.node.every % self.samples as u64) as usize * at.node.n_out()
    }
}

impl Block for Delay {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn runs_in_lanes(&self) -> bool {
        self.samples == 0
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        self.samples == 0
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: self.samples * node.n_out() }
    }

    fn start<R: Real>(&self, node: &Node, _: &mut [R], memory: &mut [R]) {
        for slot in memory.chunks_exact_mut(node.n_out()) {
            for (i, x) in slot.iter_mut().enumerate() {
                *x = R::splat(of(&self.initial, i));
            }
        }
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        if self.samples == 0 {
            for (i, y) in y.iter_mut().enumerate() {
                *y = at.component(0, i);
            }
            return;
        }
        let slot = self.slot(at);
        y.copy_from_slice(&at.memory[slot..slot + y.len()]);
    }

    #[inline(always)]
    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        if self.samples == 0 {
            return;
        }
        let slot = self.slot(at);
        for i in 0..at.node.n_out() {
            memory[slot + i] = at.component(0, i);
        }
    }

    fn label(&self) -> String {
        if self.samples == 0 { "no delay".into() } else { super::power_of_delay(self.samples) }
    }
}
