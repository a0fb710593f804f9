//! Block `divide`.

use crate::library::prelude::*;

declare_block! {
    /// Divides component by component; a division by zero stops the run and names the block.
    ///
    /// A division by zero gives a number that is not finite: the run stops and names
    /// this block.
    pub struct Divide("divide", Maths): "y = u1/u2";
}

impl Block for Divide {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::numbered(2)
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Powers(vec![1, -1])
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i) / at.component(1, i);
        }
    }

    fn label(&self) -> String {
        "u1/u2".into()
    }
}
