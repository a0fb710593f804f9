//! Block `interval-test`.

use super::truth::test;
use crate::library::prelude::*;

declare_block! {
    /// Tests if the input is between two bounds, bounds included, component by component.
    pub struct IntervalTest("interval-test", Logic): "y = 1 if lower ≤ u ≤ upper, else 0" {
        /// Lower bound.
        pub lower: f64 as Limit = "-inf",
        /// Upper bound.
        pub upper: f64 as Limit = "inf",
    }
}

impl IntervalTest {
    /// Between two bounds.
    #[must_use]
    pub fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper }
    }
}

impl Block for IntervalTest {
    type Work<R: Real> = ();

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.lower > self.upper {
            p.fault("lower", format!("`lower` {} is above `upper` {}", self.lower, self.upper), "exchange them");
        }
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::fixed(["1"])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            *y = test(*u, *u, |u, _| self.lower <= u && u <= self.upper);
        }
    }

    fn label(&self) -> String {
        format!("{} ≤ u ≤ {}", short(self.lower), short(self.upper))
    }
}
