//! `y = sign(u)`: 1, 0 or −1.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Sign, component by component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sign;

impl Sign {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Sign {
    const KIND: &'static Kind = &Kind {
        name: "sign",
        group: Group::Maths,
        summary: "Sign, component by component.",
        equation: "y = 1 for u > 0, 0 for u = 0, −1 for u < 0",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Sign {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            // zero and NaN are their own signs
            *y = R::from_lanes(|k| match u.lane(k) {
                u if u > 0.0 => 1.0,
                u if u < 0.0 => -1.0,
                u => u,
            });
        }
    }

    fn label(&self) -> String {
        "sign".into()
    }
}
