//! Block `unit-delay`.

use crate::library::prelude::*;

declare_block! {
    /// The input of the sample before.
    pub struct UnitDelay("unit-delay", Discrete): "y[k] = u[k−1], y[0] = initial" {
        /// y in the first sample.
        pub initial: Vec<f64> as PerComponent = "0",
    }
}

impl UnitDelay {
    /// Creates the block with one initial value for all components.
    #[must_use]
    pub fn new(initial: f64) -> Self {
        Self { initial: vec![initial] }
    }
}

impl Block for UnitDelay {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        false
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        fill(memory, &self.initial);
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(at.memory);
    }

    #[inline(always)]
    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        at.copy_input(0, memory);
    }

    fn label(&self) -> String {
        "z⁻¹".into()
    }
}
