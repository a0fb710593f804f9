//! Block `dot`.

use crate::library::prelude::*;

declare_block! {
    /// Dot product of two vectors.
    pub struct Dot("dot", Maths): "y = Σ u1ᵢ·u2ᵢ";
}

impl Block for Dot {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(2)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        elementwise(inputs, &[])?;
        Ok(vec![Some(1)])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::SumOfProducts
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let n = at.input(0).len().max(at.input(1).len());
        y[0] = (0..n).fold(R::zero(), |sum, i| sum + at.component(0, i) * at.component(1, i));
    }

    fn label(&self) -> String {
        "u1·u2".into()
    }
}
