//! `u = q(y)`.

use sincro_math::Real;

use super::algebra::{CONVENTION, Convention, matrix_to_euler, quaternion_to_matrix};
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Euler angles `[rad]` of a quaternion (w, x, y, z), which need not be of length 1. Where the middle angle is ±π/2, yaw (or α) is taken
/// as zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuaternionToEuler {
    /// What the three angles mean.
    pub convention: Convention,
}

impl QuaternionToEuler {
    /// In a convention.
    #[must_use]
    pub fn new(convention: Convention) -> Self {
        Self { convention }
    }
}

impl Described for QuaternionToEuler {
    const KIND: &'static Kind = &Kind {
        name: "quaternion-to-euler",
        group: Group::Rotations,
        summary: "Euler angles of a quaternion.",
        equation: "u = q(y)",
        parameters: &[CONVENTION],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { convention: Convention::read(p) }
    }
}

impl Block for QuaternionToEuler {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("u", 4)], 3)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&matrix_to_euler(quaternion_to_matrix(array(at, 0)), self.convention));
    }

    fn label(&self) -> String {
        format!("q → {}", self.convention.text())
    }
}
