//! Matrix sign function, and the Lyapunov equation by it. Cost: some ten inversions.
//!
//! Newton's iteration `Z ← ½ (Z/c + c Z⁻¹)` tends to sign(Z), which has the eigenspaces of Z and the eigenvalues ±1 of
//! their sides of the imaginary axis (key `roberts1980`). The scaling `c = |det Z|^(1/n)` brings far eigenvalues in at
//! the start (key `byers1987`).

use sincro_math::elementary::{exp, ln};

use super::DMatrix;

/// Steps after which an eigenvalue must lie on the imaginary axis; ten are usual.
const MAX_STEPS: usize = 100;
/// Change of Z, beside Z, at which the iteration ends: it converges quadratically, so the next change would be
/// rounding.
const SETTLED: f64 = 1e-9;

/// sign(Z), or `None` if an eigenvalue lies on the imaginary axis or too near to it.
pub(super) fn sign(z: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let mut z = z.clone();
    let mut last_change = f64::INFINITY;
    for _ in 0..MAX_STEPS {
        let (inverse, scale) = inverse_and_scale(&z)?;
        // near the end scaling would only disturb
        let c = if last_change < 1e-2 { 1.0 } else { scale };
        let next = (&z / c + inverse * c) * 0.5;
        let change = (&next - &z).norm() / next.norm();
        z = next;
        if !change.is_finite() {
            return None;
        }
        if change < SETTLED {
            return Some(z);
        }
        last_change = change;
    }
    None
}

/// Solves the Lyapunov equation `Aᵀ X + X A + Q = 0` for the symmetric `X`, `n×n`; `a` is `n×n` with eigenvalues of
/// negative real part, `q` is `n×n` and symmetric. `xᵀ X x` is then `∫ xᵀ Q x dt` along `ẋ = A x`.
///
/// Sign iteration on `[A 0; Q −Aᵀ]`, block by block: `A ← ½ (A/c + c A⁻¹)`, `Q ← ½ (Q/c + c A⁻ᵀ Q A⁻¹)`; A tends to −I
/// and Q to 2 X (key `roberts1980`). `None` if A has an eigenvalue on the imaginary axis; for one of positive real part
/// the result has no meaning. Panics if the shapes do not fit.
///
/// ```
/// use sincro_analysis::linear::{DMatrix, lyapunov::lyapunov};
///
/// // ẍ + 2ẋ + 5x = 0 with Q = diag(0, 4): the energy 5x² + ẋ² falls by 4ẋ²
/// let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -5.0, -2.0]);
/// let q = DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 0.0, 4.0]);
/// let x = lyapunov(&a, &q).unwrap();
/// assert!((x - DMatrix::from_row_slice(2, 2, &[5.0, 0.0, 0.0, 1.0])).amax() < 1e-13);
/// ```
#[must_use]
pub fn lyapunov(a: &DMatrix<f64>, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (mut a, mut q) = (a.clone(), q.clone());
    let identity = DMatrix::identity(a.nrows(), a.nrows());
    for _ in 0..MAX_STEPS {
        let distance = (&a + &identity).norm();
        let (inverse, scale) = inverse_and_scale(&a)?;
        let c = if distance < 1e-2 { 1.0 } else { scale };
        q = (&q / c + inverse.transpose() * &q * &inverse * c) * 0.5;
        a = (a / c + inverse * c) * 0.5;
        if !a.iter().chain(q.iter()).all(|x| x.is_finite()) {
            return None;
        }
        // the step from here would change A by the square of this
        if distance < 1e-10 {
            return Some(symmetric(&(q * 0.5)));
        }
    }
    None
}

/// The symmetric part.
pub(super) fn symmetric(x: &DMatrix<f64>) -> DMatrix<f64> {
    (x + x.transpose()) * 0.5
}

/// `Z⁻¹` and `|det Z|^(1/n)`; `None` if Z is singular.
fn inverse_and_scale(z: &DMatrix<f64>) -> Option<(DMatrix<f64>, f64)> {
    let n = z.nrows();
    if n == 0 {
        return Some((z.clone(), 1.0));
    }
    let lu = z.clone().lu();
    let pivots = lu.u();
    let logarithm: f64 = pivots.diagonal().iter().map(|pivot| ln(pivot.abs()).0).sum();
    let scale = exp(logarithm / n as f64).0;
    (scale.is_finite() && scale > 0.0).then_some(())?;
    Some((lu.try_inverse()?, scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sign_of_a_saddle_is_known() {
        // eigenvalues 3 along (1, 1) and −1 along (1, −1)
        let z = DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 1.0]);
        let expected = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 1.0, 0.0]);
        assert!((sign(&z).unwrap() - expected).amax() < 1e-14);
        // a rotation has no sign
        assert!(sign(&DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -1.0, 0.0])).is_none());
    }

    #[test]
    fn the_energy_of_a_damped_oscillator_solves_its_lyapunov_equation() {
        // ẍ + 2ẋ + 5x = 0, Q = diag(0, 4): X = diag(5, 1), since the energy falls by 2·2·ẋ²
        let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -5.0, -2.0]);
        let q = DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 0.0, 4.0]);
        let expected = DMatrix::from_row_slice(2, 2, &[5.0, 0.0, 0.0, 1.0]);
        assert!((lyapunov(&a, &q).unwrap() - expected).amax() < 1e-13);
    }
}
