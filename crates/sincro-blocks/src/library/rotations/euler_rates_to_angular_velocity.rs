//! `y = E(euler)·rates`, or `Eᵀ(euler)·rates`: the inverse of [`super::EulerRates`].

use sincro_math::Real;

use super::algebra::{CONVENTION, Convention, angular_velocity, euler_torque};
use super::array;
use super::euler_rates::TRANSPOSED;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Angular velocity `[rad/s]` in the axes of the body from rates of Euler angles `[rad/s]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EulerRatesToAngularVelocity {
    /// What the three angles mean.
    pub convention: Convention,
    /// Whether the matrix is transposed: torques about the axes of the body become torques about the angles' axes, of the same power.
    pub transposed: bool,
}

impl EulerRatesToAngularVelocity {
    /// In a convention.
    #[must_use]
    pub fn new(convention: Convention) -> Self {
        Self { convention, transposed: false }
    }
}

impl Described for EulerRatesToAngularVelocity {
    const KIND: &'static Kind = &Kind {
        name: "euler-rates-to-angular-velocity",
        group: Group::Rotations,
        summary: "The angular velocity of a body, in its own axes, from rates of its Euler angles.",
        equation: "y = E(euler)·rates, or Eᵀ(euler)·rates if transposed",
        parameters: &[CONVENTION, TRANSPOSED],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { convention: Convention::read(p), transposed: p.flag("transposed") }
    }
}

impl Block for EulerRatesToAngularVelocity {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["euler", "rates"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("euler", 3), ("rates", 3)], 3)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let matrix = if self.transposed { euler_torque } else { angular_velocity };
        y.copy_from_slice(&matrix(array(at, 0), array(at, 1), self.convention));
    }

    fn label(&self) -> String {
        if self.transposed { "Eᵀ·τ" } else { "φ' → ω" }.into()
    }
}
