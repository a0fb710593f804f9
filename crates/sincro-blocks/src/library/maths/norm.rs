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
    const KEEPS_UNIT: bool = true;

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![Some(1)])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::Uniform
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y[0] = at.input(0).iter().fold(R::zero(), |sum, u| sum + *u * *u).sqrt();
    }

    fn label(&self) -> String {
        "|u|".into()
    }
}
