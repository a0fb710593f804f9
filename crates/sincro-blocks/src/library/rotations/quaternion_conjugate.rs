//! `y = (w, −x, −y, −z)`.

use sincro_math::Real;

use super::algebra::conjugate;
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// The conjugate of a quaternion (w, x, y, z): the rotation back, if it is of length 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuaternionConjugate;

impl Described for QuaternionConjugate {
    const KIND: &'static Kind = &Kind {
        name: "quaternion-conjugate",
        group: Group::Rotations,
        summary: "The rotation back.",
        equation: "y = (w, −x, −y, −z)",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for QuaternionConjugate {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("u", 4)], 4)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&conjugate(array(at, 0)));
    }

    fn label(&self) -> String {
        "q*".into()
    }
}
