//! Block `trigonometry`.

use crate::library::prelude::*;

declare_block! {
    /// A function of angles in radians, component by component.
    ///
    /// `atan2` has two inputs, first that along y; the others have one.
    /// Outside [−1, 1] `asin` and `acos` are not numbers: the run stops and names this block.
    pub struct Trigonometry("trigonometry", Maths):
        "y = function(u); y = atan2(u1, u2), the angle in [−π, π] of the point x = u2, y = u1" {
        /// Function; angles in `[rad]`.
        pub function: Trigonometric as Choice,
    }
}

choice! {
    /// A trigonometric function or the inverse of one.
    #[allow(missing_docs)]
    pub enum Trigonometric {
        Sin = "sin",
        Cos = "cos",
        Tan = "tan",
        Asin = "asin",
        Acos = "acos",
        Atan = "atan",
        Atan2 = "atan2",
    }
}

use Trigonometric::{Acos, Asin, Atan, Atan2, Cos, Sin, Tan};

impl Trigonometry {
    /// The block of a function.
    #[must_use]
    pub fn new(function: Trigonometric) -> Self {
        Self { function }
    }
}

impl Block for Trigonometry {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::numbered(if self.function == Atan2 { 2 } else { 1 })
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::fixed([if matches!(self.function, Sin | Cos | Tan) { "1" } else { "rad" }])
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let u = at.component(0, i);
            *y = match self.function {
                Sin => u.sin_cos().0,
                Cos => u.sin_cos().1,
                Tan => u.unary(elementary::Unary::Tan),
                Asin => u.unary(elementary::Unary::Asin),
                Acos => u.unary(elementary::Unary::Acos),
                Atan => u.unary(elementary::Unary::Atan),
                Atan2 => u.binary(elementary::Binary::Atan2, at.component(1, i)),
            };
        }
    }

    fn label(&self) -> String {
        self.function.word().into()
    }
}
