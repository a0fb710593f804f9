//! Takes a signal that nobody needs.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Takes a signal that nobody needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terminator;

impl Terminator {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Terminator {
    const KIND: &'static Kind = &Kind {
        name: "terminator",
        group: Group::Sinks,
        summary: "Takes a signal that nobody needs.",
        equation: "u goes nowhere",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Terminator {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &[])
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(Vec::new())
    }

    fn output<R: Real>(&self, _: &At<'_, R>, (): &mut (), _: &mut [R]) {}

    fn label(&self) -> String {
        "⊣".into()
    }
}
