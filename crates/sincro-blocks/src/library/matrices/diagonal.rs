//! Block `diagonal`.

use crate::library::prelude::*;

declare_block! {
    /// A square matrix with its input on the diagonal, row by row.
    pub struct Diagonal("diagonal", Matrices): "y = diag(u), n × n";
}

impl Block for Diagonal {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![inputs[0].map(|n| n * n)])
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let u = at.input(0);
        y.fill(R::zero());
        for (i, u) in u.iter().enumerate() {
            y[i * at.node.inputs[0] + i] = *u;
        }
    }

    fn label(&self) -> String {
        "diag(u)".into()
    }
}
