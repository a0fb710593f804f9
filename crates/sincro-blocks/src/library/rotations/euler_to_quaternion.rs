//! `y = q(u)`.

use sincro_math::Real;

use super::algebra::{CONVENTION, Convention, euler_to_quaternion};
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// The quaternion (w, x, y, z) of Euler angles `[rad]`: roll, pitch, yaw with R = Rz(yaw)·Ry(pitch)·Rx(roll), or α, β, γ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EulerToQuaternion {
    /// What the three angles mean.
    pub convention: Convention,
}

impl EulerToQuaternion {
    /// In a convention.
    #[must_use]
    pub fn new(convention: Convention) -> Self {
        Self { convention }
    }
}

impl Described for EulerToQuaternion {
    const KIND: &'static Kind = &Kind {
        name: "euler-to-quaternion",
        group: Group::Rotations,
        summary: "The quaternion of Euler angles.",
        equation: "y = q(u)",
        parameters: &[CONVENTION],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { convention: Convention::read(p) }
    }
}

impl Block for EulerToQuaternion {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("u", 3)], 4)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&euler_to_quaternion(array(at, 0), self.convention));
    }

    fn label(&self) -> String {
        format!("{} → q", self.convention.text())
    }
}
