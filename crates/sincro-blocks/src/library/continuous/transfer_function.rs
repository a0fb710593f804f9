//! `y = numerator(s)/denominator(s)·u`.
//!
//! In controllable canonical form (MATLAB's `tf2ss`), with the denominator's leading coefficient divided out:
//!
//! ```text
//! x₁' = u − a₁ x₁ − … − aₙ xₙ,   xₖ₊₁' = xₖ,   y = Σ (bₖ − b₀ aₖ) xₖ + b₀ u
//! ```

use super::Rational;
use crate::library::prelude::*;

/// Block `transfer-function`: continuous linear system by the polynomials of its transfer function. A vector is
/// processed component by component.
///
/// It has direct feedthrough only if numerator and denominator are of the same degree.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferFunction {
    /// Transfer function, a quotient of polynomials in s `[1/s]`.
    pub rational: Rational,
    /// Initial output, in its unit, one number for all components or one for each: the states are at rest at the
    /// constant input that gives it.
    pub initial_output: Vec<f64>,
}

impl TransferFunction {
    /// Creates the block from coefficients of the polynomials in s `[1/s]`, highest power first; its initial output is
    /// zero.
    ///
    /// # Panics
    ///
    /// If the denominator is zero or of a lower degree than the numerator.
    #[must_use]
    pub fn new(numerator: &[f64], denominator: &[f64]) -> Self {
        let rational = Rational::new(numerator, denominator).unwrap_or_else(|words| panic!("{words}"));
        Self { rational, initial_output: vec![0.0] }
    }
}

impl Described for TransferFunction {
    const KIND: &'static Kind = &Kind {
        name: "transfer-function",
        category: Category::Continuous,
        summary: "A linear system given by the polynomials of its transfer function.",
        equation: "y = numerator(s)/denominator(s)·u",
        parameters: &[
            Parameter::required("numerator", ValueKind::Numbers, "coefficients, highest power of s first"),
            Parameter::required("denominator", ValueKind::Numbers, "coefficients, highest power of s first"),
            Parameter::optional("initial_output", ValueKind::Numbers, "y at the start, at rest", "0"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let help = "divide by another pole s·τ + 1 with a small τ, or use `derivative`";
        let new = Self { rational: Rational::read(p, help), initial_output: p.numbers("initial_output") };
        let n = new.rational.order();
        if new.initial_output.iter().any(|y| *y != 0.0) && (n == 0 || new.rational.b(n) == 0.0) {
            let message =
                "it cannot rest at an `initial_output` other than 0: its gain at rest is 0, or it has no state";
            p.fault("initial_output", message, "leave it out");
        }
        new
    }
}

impl Block for TransferFunction {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Continuous;

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[("initial_output", self.initial_output.len())])?])
    }

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        self.rational.b(0) != 0.0
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: node.n_out() * self.rational.order(), discrete: 0 }
    }

    fn start<R: Real>(&self, _: &Node, states: &mut [R], _: &mut [R]) {
        let n = self.rational.order();
        if n == 0 || self.rational.b(n) == 0.0 {
            return;
        }
        for (i, x) in states.chunks_exact_mut(n).enumerate() {
            // at rest all but the last are zero, and y = bₙ xₙ
            x[n - 1] = R::splat(of(&self.initial_output, i) / self.rational.b(n));
        }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (g, n) = (&self.rational, self.rational.order());
        for (i, y) in y.iter_mut().enumerate() {
            let mut sum = R::zero();
            for (k, x) in at.states[i * n..(i + 1) * n].iter().enumerate() {
                sum += R::splat(g.b(k + 1) - g.b(0) * g.a(k + 1)) * *x;
            }
            *y = if g.b(0) == 0.0 { sum } else { sum + R::splat(g.b(0)) * at.component(0, i) };
        }
    }

    fn derivatives<R: Real>(&self, at: &At<'_, R>, (): &mut (), derivatives: &mut [R]) {
        let n = self.rational.order();
        if n == 0 {
            return;
        }
        for (i, (derivatives, x)) in derivatives.chunks_exact_mut(n).zip(at.states.chunks_exact(n)).enumerate() {
            let mut first = at.component(0, i);
            for k in 0..n {
                first -= R::splat(self.rational.a(k + 1)) * x[k];
            }
            derivatives[0] = first;
            derivatives[1..].copy_from_slice(&x[..n - 1]);
        }
    }

    fn neg_jacobian_diagonal<R: Real>(&self, _: &At<'_, R>, diagonal: &mut [R]) {
        let n = self.rational.order();
        if n > 0 {
            diagonal.chunks_exact_mut(n).for_each(|diagonal| diagonal[0] = R::splat(self.rational.a(1)));
        }
    }

    fn label(&self) -> String {
        self.rational.text('s')
    }
}
