//! `y = u1/u2`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Divides component by component. A division by zero gives a number that is not finite: the run stops and names this block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Divide;

impl Divide {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Divide {
    const KIND: &'static Kind = &Kind {
        name: "divide",
        group: Group::Maths,
        summary: "Divides component by component; a division by zero stops the run and names the block.",
        equation: "y = u1/u2",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Divide {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(2)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i) / at.component(1, i);
        }
    }

    fn label(&self) -> String {
        "u1/u2".into()
    }
}
