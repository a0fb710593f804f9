//! `u = R(y), w ≥ 0`.

use sincro_math::Real;

use super::algebra::matrix_to_quaternion;
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// The quaternion (w, x, y, z) with w ≥ 0 of a rotation matrix, row by row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MatrixToQuaternion;

impl Described for MatrixToQuaternion {
    const KIND: &'static Kind = &Kind {
        name: "matrix-to-quaternion",
        group: Group::Rotations,
        summary: "The quaternion of a rotation matrix.",
        equation: "u = R(y), w ≥ 0",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for MatrixToQuaternion {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("u", 9)], 4)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&matrix_to_quaternion(array(at, 0)));
    }

    fn label(&self) -> String {
        "R → q".into()
    }
}
