//! `y = u1 × u2`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Cross product of two vectors of three components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cross;

impl Cross {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Cross {
    const KIND: &'static Kind = &Kind {
        name: "cross",
        group: Group::Maths,
        summary: "Cross product of two vectors of three components.",
        equation: "y = u1 × u2",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Cross {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(2)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        if let Some(k) = inputs.iter().position(|width| width.is_some_and(|w| w != 3)) {
            return Err(format!("input {} has {} components instead of 3", k + 1, inputs[k].unwrap_or(0)));
        }
        Ok(vec![Some(3)])
    }

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
