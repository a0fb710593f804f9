//! Block `rate-limiter`.

use crate::library::prelude::*;

declare_block! {
    /// Limits how fast a signal changes.
    ///
    /// It works at samples, or at every tick if it has no sample time.
    pub struct RateLimiter("rate-limiter", Nonlinear):
        "y[k] = y[k−1] + min(max(u[k] − y[k−1], −falling·Ts), rising·Ts)" {
        /// Fastest rise `[unit of u / s]`.
        pub rising: Vec<f64> as Limits,
        /// Fastest fall, a positive number `[unit of u / s]`.
        pub falling: Option<Vec<f64>> as OptionalParameter<Limits> = "rising",
        /// y before the start.
        pub initial: Option<Vec<f64>> as OptionalParameter<PerComponent> = "u",
    }
}

impl RateLimiter {
    /// Both ways alike, started at the input; `rate` in `[unit of u / s]`.
    #[must_use]
    pub fn new(rate: f64) -> Self {
        Self { rising: vec![rate], falling: None, initial: None }
    }

    fn falling(&self) -> &[f64] {
        self.falling.as_ref().unwrap_or(&self.rising)
    }

    #[inline(always)]
    fn limited<R: Real>(&self, at: &At<'_, R>, i: usize) -> R {
        let u = at.component(0, i);
        if at.tick == 0 && self.initial.is_none() {
            return u;
        }
        let (before, ts) = (at.memory[i], at.node.period());
        let (low, high) = (R::splat(-of(self.falling(), i) * ts), R::splat(of(&self.rising, i) * ts));
        let change = u - before;
        // within the limits the output is the input to the bit
        let up = high.if_less(change, before + high, u);
        change.if_less(low, before + low, up)
    }
}

impl Block for RateLimiter {
    type Work<R: Real> = ();
    const KEEPS_UNIT: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn validate(&mut self, p: &mut Reader<'_>) {
        for (key, list) in [("rising", &self.rising[..]), ("falling", self.falling())] {
            if let Some(bad) = list.iter().find(|x| **x <= 0.0) {
                p.fault(key, format!("`{key}` is {bad}"), "both rates are positive numbers");
            }
        }
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = R::splat(self.initial.as_ref().map_or(0.0, |initial| of(initial, i)));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.limited(at, i);
        }
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        for (i, x) in memory.iter_mut().enumerate() {
            *x = self.limited(at, i);
        }
    }

    fn label(&self) -> String {
        format!("±{}/s", short_list(&self.rising))
    }
}
