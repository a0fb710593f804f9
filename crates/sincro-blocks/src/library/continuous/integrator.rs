//! Block `integrator`.

use crate::library::prelude::*;

declare_block! {
    /// Integrates its input over time, within limits.
    ///
    /// At a limit it stands still as long as the input pushes outwards. With `reset`
    /// it has a second input: while that is greater than zero at a tick, the state is put back to the initial value.
    pub struct Integrator("integrator", Continuous): "y' = u, lower ≤ y ≤ upper; y = initial while reset > 0" {
        /// y at the start.
        pub initial: Vec<f64> as PerComponent = "0",
        /// Least y.
        pub lower: f64 as Limit = "-inf",
        /// Greatest y.
        pub upper: f64 as Limit = "inf",
        /// Adds an input `reset`.
        pub reset: bool as Flag = "false",
    }
}

impl Integrator {
    /// Without limits and reset.
    #[must_use]
    pub fn new(initial: f64) -> Self {
        Self { initial: vec![initial], lower: f64::NEG_INFINITY, upper: f64::INFINITY, reset: false }
    }
}

impl Block for Integrator {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Continuous;
    const STATE: Memory = Memory::CONTINUOUS;

    fn runs_in_lanes(&self) -> bool {
        !self.reset
    }

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.lower > self.upper {
            p.fault("lower", format!("`lower` {} is above `upper` {}", self.lower, self.upper), "exchange them");
        } else if let Some(x) = self.initial.iter().find(|x| **x < self.lower || **x > self.upper) {
            p.fault("initial", format!("`initial` {x} is beyond the limits"), "start between `lower` and `upper`");
        }
    }

    fn ports(&self) -> Ports {
        Ports::new(if self.reset { &["u", "reset"] } else { &["u"] }, &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(&inputs[..1], &self.parameter_widths())?])
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        false
    }

    fn start<R: Real>(&self, _: &Node, states: &mut [R], _: &mut [R]) {
        fill(states, &self.initial);
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::TimesSeconds(vec![1])
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, x) in y.iter_mut().zip(at.states) {
            *y = x.max(R::splat(self.lower)).min(R::splat(self.upper));
        }
    }

    #[inline(always)]
    fn derivatives<R: Real>(&self, at: &At<'_, R>, (): &mut (), derivatives: &mut [R]) {
        let (lower, upper, zero) = (R::splat(self.lower), R::splat(self.upper), R::zero());
        for (i, rate) in derivatives.iter_mut().enumerate() {
            let (x, u) = (at.states[i], at.component(0, i));
            // beyond a limit only the way back is free
            let up = x.if_less(upper, u, u.min(zero));
            *rate = lower.if_less(x, up, up.max(zero));
        }
    }

    #[inline(always)]
    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), _: &mut [R], states: &mut [R]) {
        if self.reset && at.scalar(1).lane(0) > 0.0 {
            self.start(at.node, states, &mut []);
        }
        // the last step may have gone a little beyond a limit
        for x in states {
            *x = x.max(R::splat(self.lower)).min(R::splat(self.upper));
        }
    }

    fn label(&self) -> String {
        "1/s".into()
    }
}
