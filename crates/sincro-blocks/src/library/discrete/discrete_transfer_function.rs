//! `y = numerator(z)/denominator(z)·u`.
//!
//! In direct form II transposed, with the denominator's leading coefficient divided out and memory w₁ … wₙ:
//!
//! ```text
//! y[k] = b₀ u[k] + w₁,   wⱼ ← bⱼ u[k] − aⱼ y[k] + wⱼ₊₁,   wₙ₊₁ = 0
//! ```

use crate::library::continuous::Rational;
use crate::library::prelude::*;

/// Block `discrete-transfer-function`: linear recursion by the polynomials of its transfer function. A vector is
/// processed component by component.
///
/// It has direct feedthrough only if numerator and denominator are of the same degree.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteTransferFunction {
    /// Transfer function, a quotient of polynomials in z (dimensionless).
    pub rational: Rational,
}

impl DiscreteTransferFunction {
    /// Creates the block from coefficients of the polynomials in z (dimensionless), highest power first; initially at
    /// rest.
    ///
    /// # Panics
    ///
    /// If the denominator is zero or of a lower degree than the numerator.
    #[must_use]
    pub fn new(numerator: &[f64], denominator: &[f64]) -> Self {
        Self { rational: Rational::new(numerator, denominator).unwrap_or_else(|words| panic!("{words}")) }
    }
}

/// Returns true if the present output depends on the present input.
pub(super) fn has_direct_feedthrough(g: &Rational) -> bool {
    g.b(0) != 0.0
}

/// The present outputs, the memory of each component lying side by side.
pub(super) fn output<R: Real>(g: &Rational, at: &At<'_, R>, y: &mut [R]) {
    let n = g.order();
    for (i, y) in y.iter_mut().enumerate() {
        let kept = if n == 0 { R::zero() } else { at.memory[i * n] };
        *y = if has_direct_feedthrough(g) { R::splat(g.b(0)) * at.component(0, i) + kept } else { kept };
    }
}

/// The memory for the next sample.
pub(super) fn update<R: Real>(g: &Rational, at: &At<'_, R>, memory: &mut [R]) {
    let n = g.order();
    if n == 0 {
        return;
    }
    for (i, (new, old)) in memory.chunks_exact_mut(n).zip(at.memory.chunks_exact(n)).enumerate() {
        let u = at.component(0, i);
        let y = if has_direct_feedthrough(g) { R::splat(g.b(0)) * u + old[0] } else { old[0] };
        for j in 0..n {
            let own = R::splat(g.b(j + 1)) * u - R::splat(g.a(j + 1)) * y;
            new[j] = if j + 1 < n { own + old[j + 1] } else { own };
        }
    }
}

impl Described for DiscreteTransferFunction {
    const KIND: &'static Kind = &Kind {
        name: "discrete-transfer-function",
        category: Category::Discrete,
        summary: "A linear recursion given by the polynomials in z of its transfer function.",
        equation: "y = numerator(z)/denominator(z)·u",
        parameters: &[
            Parameter::required("numerator", ValueKind::Numbers, "coefficients, highest power of z first"),
            Parameter::required("denominator", ValueKind::Numbers, "coefficients, highest power of z first"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { rational: Rational::read(p, "it would need samples of the future: multiply the denominator by z") }
    }
}

impl Block for DiscreteTransferFunction {
    type Work<R: Real> = ();
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;

    fn has_direct_feedthrough(&self, _: usize) -> bool {
        has_direct_feedthrough(&self.rational)
    }

    fn memory(&self, node: &Node) -> Memory {
        Memory { continuous: 0, discrete: node.n_out() * self.rational.order() }
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        output(&self.rational, at, y);
    }

    fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _: &mut [R]) {
        update(&self.rational, at, memory);
    }

    fn label(&self) -> String {
        self.rational.text('z')
    }
}
