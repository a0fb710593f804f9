//! `y = |u|`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;
use crate::unit::Unit;

/// Absolute value, component by component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Abs;

impl Abs {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Abs {
    const KIND: &'static Kind = &Kind {
        name: "abs",
        group: Group::Maths,
        summary: "Absolute value, component by component.",
        equation: "y = |u|",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Abs {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(inputs.to_vec())
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            *y = u.abs();
        }
    }

    fn label(&self) -> String {
        "|u|".into()
    }
}
