//! Block `polynomial`.

use crate::library::prelude::*;

declare_block! {
    /// A polynomial of its input, component by component.
    pub struct Polynomial("polynomial", Maths): "y = c₀·uⁿ + c₁·uⁿ⁻¹ + … + cₙ, c = coefficients" {
        /// Coefficients, that of the highest power first.
        pub coefficients: Vec<f64> as List,
    }
}

impl Polynomial {
    /// Creates the block from the coefficients, that of the highest power first.
    #[must_use]
    pub fn new(coefficients: &[f64]) -> Self {
        Self { coefficients: coefficients.to_vec() }
    }
}

impl Block for Polynomial {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            // Horner's scheme; u·0 lets a NaN through where there is only a constant
            *y = self.coefficients.iter().fold(R::zero(), |sum, c| sum * *u + R::splat(*c));
        }
    }

    fn label(&self) -> String {
        "P(u)".into()
    }
}
