//! Block `backlash`.

use crate::library::prelude::*;

declare_block! {
    /// Play, as between the teeth of two wheels.
    ///
    /// The output moves only when the input has reached an end of the gap. It works at samples, or at every tick if
    /// it has no sample time.
    pub struct Backlash("backlash", Nonlinear): "y[k] = min(max(y[k−1], u − width/2), u + width/2)" {
        /// Whole width of the gap.
        pub width: Vec<f64> as Positives,
        /// y before the start.
        pub initial: Vec<f64> as PerComponent = "0",
    }
}

impl Backlash {
    /// Creates the block: from zero, with one width for all components.
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

impl Block for Backlash {
    type Work<R: Real> = ();
    const KEEPS_UNIT: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        fill(memory, &self.initial);
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
        short_list(&self.width)
    }
}
