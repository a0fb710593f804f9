//! Block `dot`.

use crate::library::prelude::*;

declare_block! {
    /// Dot product of two vectors.
    pub struct Dot("dot", Maths): "y = Σ u1ᵢ·u2ᵢ";
}

impl Block for Dot {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

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

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let n = at.input(0).len().max(at.input(1).len());
        y[0] = R::zero();
        for i in 0..n {
            y[0] += at.component(0, i) * at.component(1, i);
        }
    }

    fn label(&self) -> String {
        "u1·u2".into()
    }
}
