//! `y[k] = y[k−1] + (1 − e^(−Ts/T))·(dc_gain·u[k] − y[k−1])`: a first-order lag, exact over one sample.
//!
//! The solution of `T·y' = dc_gain·u − y` after the time Ts under a constant input, so it is stable for every T > 0,
//! where forward Euler needs Ts < 2T.

use crate::library::prelude::*;

declare_block! {
    /// A first-order lag, discretised exactly.
    ///
    /// It has direct feedthrough: the input of a sample counts for the whole interval that
    /// ends at it.
    pub struct DiscreteLowPass("discrete-low-pass", Discrete):
        "y[k] = y[k−1] + (1 − e^(−Ts/time_constant))·(dc_gain·u[k] − y[k−1]), y[−1] = initial" {
        /// Time after which a step is answered to 63 % `[s]`; 0 for none.
        pub time_constant: Vec<f64> as PerComponent,
        /// Gain for a constant input.
        pub dc_gain: Vec<f64> as PerComponent = "1",
        /// y before the first sample.
        pub initial: Vec<f64> as PerComponent = "0",
    }
}

impl DiscreteLowPass {
    /// Creates the block with gain 1, from zero.
    #[must_use]
    pub fn new(time_constant: f64) -> Self {
        Self { time_constant: vec![time_constant], dc_gain: vec![1.0], initial: vec![0.0] }
    }
}

impl Block for DiscreteLowPass {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.time_constant.iter().any(|t| *t < 0.0) {
            p.fault("time_constant", "a time constant is negative", "it must be 0 or more");
        }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        fill(memory, &self.initial);
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let rest = elementary::exp(-at.node.period() / of(&self.time_constant, i)).0;
            let target = R::splat(of(&self.dc_gain, i)) * at.component(0, i);
            *y = target + (at.memory[i] - target) * R::splat(rest);
        }
    }

    #[inline(always)]
    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        self.output(at, &mut (), memory);
    }

    fn label(&self) -> String {
        "(1 − a)·z/(z − a)".into()
    }
}
