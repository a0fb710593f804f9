//! `y = E⁻¹(euler)·w`, or `E⁻ᵀ(euler)·w`, where `w = E(euler)·euler'` is the angular velocity in the axes of the body.

use sincro_math::Real;

use super::algebra::{CONVENTION, Convention, body_torque, euler_rates};
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Rates of Euler angles `[rad/s]` from the angular velocity `w` `[rad/s]` in the axes of the body. They are not finite where the middle
/// angle is ±π/2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EulerRates {
    /// What the three angles mean.
    pub convention: Convention,
    /// Whether the matrix is transposed: torques about the angles' axes become torques about the axes of the body, of the same power.
    pub transposed: bool,
}

impl EulerRates {
    /// In a convention.
    #[must_use]
    pub fn new(convention: Convention) -> Self {
        Self { convention, transposed: false }
    }
}

/// Of both blocks of Euler rates.
pub(super) const TRANSPOSED: Parameter = Parameter::optional(
    "transposed",
    Takes::Flag,
    "whether the matrix is transposed, as it is for torques and in the laws of Lyapunov's method",
    "false",
);

impl Described for EulerRates {
    const KIND: &'static Kind = &Kind {
        name: "euler-rates",
        group: Group::Rotations,
        summary: "Rates of Euler angles from the angular velocity of the body.",
        equation: "y = E⁻¹(euler)·w, or E⁻ᵀ(euler)·w if transposed; w = E(euler)·euler'",
        parameters: &[CONVENTION, TRANSPOSED],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { convention: Convention::read(p), transposed: p.flag("transposed") }
    }
}

impl Block for EulerRates {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["euler", "w"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("euler", 3), ("w", 3)], 3)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let matrix = if self.transposed { body_torque } else { euler_rates };
        y.copy_from_slice(&matrix(array(at, 0), array(at, 1), self.convention));
    }

    fn label(&self) -> String {
        if self.transposed { "E⁻ᵀ·w" } else { "ω → φ'" }.into()
    }
}
