//! `y = R(u/|u|)`.

use sincro_math::Real;

use super::algebra::quaternion_to_matrix;
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// The rotation matrix, row by row, of a quaternion (w, x, y, z), which need not be of length 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuaternionToMatrix;

impl Described for QuaternionToMatrix {
    const KIND: &'static Kind = &Kind {
        name: "quaternion-to-matrix",
        group: Group::Rotations,
        summary: "The rotation matrix of a quaternion.",
        equation: "y = R(u/|u|)",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for QuaternionToMatrix {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("u", 4)], 9)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&quaternion_to_matrix(array(at, 0)));
    }

    fn label(&self) -> String {
        "q → R".into()
    }
}
