//! `y[k] = initial + gain·Ts·Σ u`, within limits, with reset.
//!
//! With the sample time Ts and `a = gain·Ts·u[k]`:
//!
//! ```text
//! y[k] = limited(s[k] + α·a),   s[k+1] = limited(y[k] + (1 − α)·a),   s[0] = initial
//! α = 0 forward Euler, 1 backward Euler, ½ trapezoidal
//! ```

use super::Method;
use crate::library::prelude::*;

declare_block! {
    /// Sums its input over time, within limits.
    ///
    /// Only forward Euler has no direct feedthrough. With `reset` it has a second input: while that is greater than
    /// zero at a sample, the next sample starts from the initial value.
    pub struct DiscreteIntegrator("discrete-integrator", Discrete):
        "y[k+1] = y[k] + gain·Ts·u[k] (forward Euler), lower ≤ y ≤ upper; y = initial after reset > 0" {
        /// Rule of the integral.
        pub method: Method as Choice = "forward-euler",
        /// Factor.
        pub gain: Vec<f64> as PerComponent = "1",
        /// y at the start.
        pub initial: Vec<f64> as PerComponent = "0",
        /// Least y.
        pub lower: Vec<f64> as Limits = "-inf",
        /// Greatest y.
        pub upper: Vec<f64> as Limits = "inf",
        /// Adds an input `reset`.
        pub reset: bool as Flag = "false",
    }
}

impl DiscreteIntegrator {
    /// Creates the block: from zero, without limits and reset.
    #[must_use]
    pub fn new(method: Method) -> Self {
        let (lower, upper) = (vec![f64::NEG_INFINITY], vec![f64::INFINITY]);
        Self { method, gain: vec![1.0], initial: vec![0.0], lower, upper, reset: false }
    }

    #[inline(always)]
    fn limited<R: Real>(&self, x: R, i: usize) -> R {
        x.max(R::splat(of(&self.lower, i))).min(R::splat(of(&self.upper, i)))
    }

    /// `part·gain·Ts·u`.
    #[inline(always)]
    fn advance<R: Real>(&self, at: &At<'_, R>, part: f64, i: usize) -> R {
        R::splat(part * at.node.period() * of(&self.gain, i)) * at.component(0, i)
    }

    #[inline(always)]
    fn present<R: Real>(&self, at: &At<'_, R>, i: usize) -> R {
        let weight = self.method.weight();
        let s = at.memory[i];
        self.limited(if weight == 0.0 { s } else { s + self.advance(at, weight, i) }, i)
    }
}

impl Block for DiscreteIntegrator {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
    const STATE: Memory = Memory::DISCRETE;

    fn runs_in_lanes(&self) -> bool {
        !self.reset
    }

    fn validate(&mut self, p: &mut Reader<'_>) {
        crate::library::nonlinear::check_limits(p, &self.lower, &self.upper);
    }

    fn ports(&self) -> Ports {
        Ports::new(if self.reset { &["u", "reset"] } else { &["u"] }, &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(&inputs[..1], &self.parameter_widths())?])
    }

    fn has_direct_feedthrough(&self, input: usize) -> bool {
        input == 0 && self.method != Method::ForwardEuler
    }

    fn start<R: Real>(&self, _: &Node, _: &mut [R], memory: &mut [R]) {
        fill(memory, &self.initial);
    }

    fn unit_rule(&self) -> UnitRule {
        // any other gain may have a unit
        let is_plain = self.gain.iter().all(|g| *g == 1.0);
        if is_plain { UnitRule::TimesSeconds(vec![1]) } else { UnitRule::Unknown }
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.present(at, i);
        }
    }

    #[inline(always)]
    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        if self.reset && at.scalar(1).lane(0) > 0.0 {
            self.start(at.node, &mut [], memory);
            return;
        }
        let rest = 1.0 - self.method.weight();
        for (i, s) in memory.iter_mut().enumerate() {
            let y = self.present(at, i);
            *s = if rest == 0.0 { y } else { self.limited(y + self.advance(at, rest, i), i) };
        }
    }

    fn label(&self) -> String {
        match self.method {
            Method::ForwardEuler => "Ts/(z − 1)",
            Method::BackwardEuler => "Ts·z/(z − 1)",
            Method::Trapezoidal => "Ts/2·(z + 1)/(z − 1)",
        }
        .into()
    }
}
