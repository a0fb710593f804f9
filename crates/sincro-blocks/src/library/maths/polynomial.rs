//! `y = c₀·uⁿ + c₁·uⁿ⁻¹ + … + cₙ`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// A polynomial of its input, component by component.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    /// Coefficients, that of the highest power first.
    pub coefficients: Vec<f64>,
}

impl Polynomial {
    /// From the coefficients, that of the highest power first.
    #[must_use]
    pub fn new(coefficients: &[f64]) -> Self {
        Self { coefficients: coefficients.to_vec() }
    }
}

impl Described for Polynomial {
    const KIND: &'static Kind = &Kind {
        name: "polynomial",
        group: Group::Maths,
        summary: "A polynomial of its input, component by component.",
        equation: "y = c₀·uⁿ + c₁·uⁿ⁻¹ + … + cₙ, c = coefficients",
        parameters: &[Parameter::required(
            "coefficients",
            Takes::Numbers,
            "coefficients, that of the highest power first",
        )],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { coefficients: p.numbers("coefficients") }
    }
}

impl Block for Polynomial {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(inputs.to_vec())
    }

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
