//! Block `norm`.

use crate::library::prelude::*;

declare_block! {
    /// Euclidean length of a vector.
    ///
    /// Its derivative at zero is taken as zero.
    pub struct Norm("norm", Maths): "y = √(Σ uᵢ²)";
}

impl Block for Norm {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;
    const KEEPS_UNIT: bool = true;

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![Some(1)])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Uniform
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let mut sum = R::zero();
        for u in at.input(0) {
            sum += *u * *u;
        }
        y[0] = sum.sqrt();
    }

    fn label(&self) -> String {
        "|u|".into()
    }
}
