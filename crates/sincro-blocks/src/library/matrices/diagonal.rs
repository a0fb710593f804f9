//! `y = diag(u)`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// A square matrix, row by row, with a vector on its diagonal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Diagonal;

impl Diagonal {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Diagonal {
    const KIND: &'static Kind = &Kind {
        name: "diagonal",
        group: Group::Matrices,
        summary: "A square matrix with its input on the diagonal, row by row.",
        equation: "y = diag(u), n × n",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Diagonal {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![inputs[0].map(|n| n * n)])
    }

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
