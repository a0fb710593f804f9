//! `y = E⁻¹(euler)·w`.

use sincro_math::Real;

use super::algebra::{CONVENTION, Convention, euler_rates};
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Rates of Euler angles `[rad/s]` from the angular velocity `w` `[rad/s]` in the axes of the body. They are not finite where the middle
/// angle is ±π/2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EulerRates {
    /// What the three angles mean.
    pub convention: Convention,
}

impl EulerRates {
    /// In a convention.
    #[must_use]
    pub fn new(convention: Convention) -> Self {
        Self { convention }
    }
}

impl Described for EulerRates {
    const KIND: &'static Kind = &Kind {
        name: "euler-rates",
        group: Group::Rotations,
        summary: "Rates of Euler angles from the angular velocity of the body.",
        equation: "y = E⁻¹(euler)·w",
        parameters: &[CONVENTION],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { convention: Convention::read(p) }
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
        y.copy_from_slice(&euler_rates(array(at, 0), array(at, 1), self.convention));
    }

    fn label(&self) -> String {
        "ω → φ'".into()
    }
}
