//! `y = √u`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Square root, component by component. Of a negative number it is not a number: the run stops and names this block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sqrt;

impl Sqrt {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Sqrt {
    const KIND: &'static Kind = &Kind {
        name: "sqrt",
        group: Group::Maths,
        summary: "Square root, component by component; a negative input stops the run and names the block.",
        equation: "y = √u",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Sqrt {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            *y = u.sqrt();
        }
    }

    fn label(&self) -> String {
        "√u".into()
    }
}
