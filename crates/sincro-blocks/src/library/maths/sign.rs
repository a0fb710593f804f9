//! Block `sign`.

use crate::library::prelude::*;

declare_block! {
    /// Sign, component by component.
    pub struct Sign("sign", Maths): "y = 1 for u > 0, 0 for u = 0, −1 for u < 0";
}

impl Block for Sign {
    type Work<R: Real> = ();

    fn unit_rule(&self) -> UnitRule {
        UnitRule::fixed(["1"])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            // zero and NaN are their own signs
            *y = R::from_lanes(|k| match u.lane(k) {
                u if u > 0.0 => 1.0,
                u if u < 0.0 => -1.0,
                u => u,
            });
        }
    }

    fn label(&self) -> String {
        "sign".into()
    }
}
