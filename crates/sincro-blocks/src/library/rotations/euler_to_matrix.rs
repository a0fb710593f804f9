//! `y = R(u)`.

use sincro_math::Real;

use super::algebra::{CONVENTION, Convention, euler_to_matrix};
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// The rotation matrix, row by row, of Euler angles `[rad]`: roll, pitch, yaw with R = Rz(yaw)·Ry(pitch)·Rx(roll), or α, β, γ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EulerToMatrix {
    /// What the three angles mean.
    pub convention: Convention,
}

impl EulerToMatrix {
    /// In a convention.
    #[must_use]
    pub fn new(convention: Convention) -> Self {
        Self { convention }
    }
}

impl Described for EulerToMatrix {
    const KIND: &'static Kind = &Kind {
        name: "euler-to-matrix",
        group: Group::Rotations,
        summary: "The rotation matrix of Euler angles.",
        equation: "y = R(u)",
        parameters: &[CONVENTION],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { convention: Convention::read(p) }
    }
}

impl Block for EulerToMatrix {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("u", 3)], 9)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&euler_to_matrix(array(at, 0), self.convention));
    }

    fn label(&self) -> String {
        format!("{} → R", self.convention.text())
    }
}
