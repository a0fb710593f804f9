//! Block `sqrt`.

use crate::library::prelude::*;

declare_block! {
    /// Square root, component by component; a negative input stops the run and names the block.
    pub struct Sqrt("sqrt", Maths): "y = √u";
}

impl Block for Sqrt {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn unit_rule(&self) -> UnitRule {
        UnitRule::SquareRoot
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            *y = u.sqrt();
        }
    }

    fn label(&self) -> String {
        "√u".into()
    }
}
