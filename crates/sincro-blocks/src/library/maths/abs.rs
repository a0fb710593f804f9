//! Block `abs`.

use crate::library::prelude::*;

declare_block! {
    /// Absolute value, component by component.
    pub struct Abs("abs", Maths): "y = |u|";
}

impl Block for Abs {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            *y = u.abs();
        }
    }

    fn label(&self) -> String {
        "|u|".into()
    }
}
