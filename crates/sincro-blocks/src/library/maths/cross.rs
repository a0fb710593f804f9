//! Block `cross`.

use crate::library::prelude::*;

declare_block! {
    /// Cross product of two vectors of three components.
    pub struct Cross("cross", Maths): "y = u1 × u2";
}

impl Block for Cross {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn ports(&self) -> Ports {
        Ports::numbered(2)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        if let Some(k) = inputs.iter().position(|width| width.is_some_and(|w| w != 3)) {
            return Err(format!("input {} has {} components instead of 3", k + 1, inputs[k].unwrap_or(0)));
        }
        Ok(vec![Some(3)])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::SumOfProducts
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (a, b) = (at.input(0), at.input(1));
        y[0] = a[1] * b[2] - a[2] * b[1];
        y[1] = a[2] * b[0] - a[0] * b[2];
        y[2] = a[0] * b[1] - a[1] * b[0];
    }

    fn label(&self) -> String {
        "u1 × u2".into()
    }
}
