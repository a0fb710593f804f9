//! `u = R(y)`.

use sincro_math::Real;

use super::algebra::{CONVENTION, Convention, matrix_to_euler};
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Euler angles `[rad]` of a rotation matrix, row by row. Where the middle angle is ±π/2, yaw (or α) is taken as zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MatrixToEuler {
    /// What the three angles mean.
    pub convention: Convention,
}

impl MatrixToEuler {
    /// In a convention.
    #[must_use]
    pub fn new(convention: Convention) -> Self {
        Self { convention }
    }
}

impl Described for MatrixToEuler {
    const KIND: &'static Kind = &Kind {
        name: "matrix-to-euler",
        group: Group::Rotations,
        summary: "Euler angles of a rotation matrix.",
        equation: "u = R(y)",
        parameters: &[CONVENTION],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { convention: Convention::read(p) }
    }
}

impl Block for MatrixToEuler {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("u", 9)], 3)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&matrix_to_euler(array(at, 0), self.convention));
    }

    fn label(&self) -> String {
        format!("R → {}", self.convention.text())
    }
}
