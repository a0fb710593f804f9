//! `y = t`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;
use crate::unit::Unit;

/// The time since the start `[s]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clock;

impl Clock {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Clock {
    const KIND: &'static Kind = &Kind {
        name: "clock",
        group: Group::Sources,
        summary: "The time since the start in seconds.",
        equation: "y = t",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Clock {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::source()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![Some(1)])
    }

    fn units(&self, _: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![Unit::parse("s").ok()])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y[0] = R::splat(at.t);
    }

    fn label(&self) -> String {
        "t".into()
    }
}
