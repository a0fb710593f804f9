//! Block `dead-zone`.

use crate::library::prelude::*;

declare_block! {
    /// Lets small values pass as zero and shortens the others.
    pub struct DeadZone("dead-zone", Nonlinear): "y = u − min(max(u, lower), upper)" {
        /// Lower end of the zone.
        pub lower: Vec<f64> as Limits,
        /// Upper end of the zone.
        pub upper: Vec<f64> as Limits,
    }
}

impl DeadZone {
    /// Creates the block with the same zone for all components.
    #[must_use]
    pub fn new(lower: f64, upper: f64) -> Self {
        Self { lower: vec![lower], upper: vec![upper] }
    }
}

impl Block for DeadZone {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;

    fn validate(&mut self, p: &mut Reader<'_>) {
        super::check_limits(p, &self.lower, &self.upper);
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let u = at.component(0, i);
            *y = u - u.max(R::splat(of(&self.lower, i))).min(R::splat(of(&self.upper, i)));
        }
    }

    fn label(&self) -> String {
        format!("{} … {}", short_list(&self.lower), short_list(&self.upper))
    }
}
