//! Block `single-precision`.

use crate::library::prelude::*;

declare_block! {
    /// Rounds to single precision, as a wire or a program does that has four bytes for a number.
    ///
    /// IEEE 754 binary32, ties to even: as V-REP's legacy remote API carries numbers. The derivative is taken as one.
    pub struct SinglePrecision("single-precision", Nonlinear):
        "y = the number of binary32 nearest to u, ties to even";
}

impl Block for SinglePrecision {
    type Work<R: Real> = ();
    const KEEPS_UNIT: bool = true;

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i).map(|u| (f64::from(u as f32), 1.0));
        }
    }
}
