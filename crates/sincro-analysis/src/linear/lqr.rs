//! Linear-quadratic regulators: the feedback `u = −K x` of least cost. Cost: some twenty inversions of `2n×2n` and
//! `n×n` matrices.
//!
//! Continuous, `∫ xᵀQx + uᵀRu dt`: `P` from `AᵀP + PA − P B R⁻¹ Bᵀ P + Q = 0` by the sign of the Hamiltonian matrix
//! (key `roberts1980`). Sampled, `Σ xᵀQx + uᵀRu`: by structured doubling (key `chu2004`). Then a few steps of Newton's
//! method: the next `P` is what the feedback of the last one costs (key `kleinman1968`, key `hewer1971`). `K = R⁻¹BᵀP`
//! and `K = (R + BᵀPB)⁻¹ BᵀPA`.

use super::error::{expect_finite, expect_size, expect_symmetric};
use super::lyapunov::{lyapunov, sign, symmetric};
use super::modes::eigenvalues;
use super::{Complex, DMatrix, LinearError, modulus};

/// Share of the weights below which a negative eigenvalue of Q is rounding.
const NOTHING: f64 = 1e-12;
/// A mode whose `[A − λI, B]` has a singular value below this share of its greatest is not reached.
const UNREACHED: f64 = 1e-11;
/// Steps of Newton's method at the end; it doubles the digits, so the second already meets rounding.
const MAX_REFINEMENTS: usize = 4;
/// Doublings: 2⁶⁰ ticks are for ever.
const MAX_DOUBLINGS: usize = 60;

/// Linear-quadratic regulator: the state feedback `u = −K x` of least cost for a system of `n` states and `m` inputs,
/// with its closed-loop poles. Result of [`lqr`] and [`dlqr`].
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// # fn main() -> Result<(), LinearError> {
/// // x' = x + u, cost ∫ x² + u² dt: K = 1 + √2, closed loop −√2
/// let one = DMatrix::identity(1, 1);
/// let regulator: Regulator = lqr(&one, &one, &one, &one)?;
/// assert!((regulator.k[0] - (1.0 + f64::sqrt(2.0))).abs() < 1e-12);
/// assert!((regulator.poles[0].re + f64::sqrt(2.0)).abs() < 1e-12); // [1/s]
/// assert!(regulator.residual < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Regulator {
    /// Feedback gain K, `m×n` `[unit of the input / unit of the state]`.
    pub k: DMatrix<f64>,
    /// Solution P of the Riccati equation, `n×n`, symmetric: `xᵀ P x` is the cost of the return from the state `x` to
    /// 0.
    pub p: DMatrix<f64>,
    /// Closed-loop poles, the `n` eigenvalues of `A − B K`, ascending in modulus: `[1/s]` from [`lqr`], dimensionless
    /// from [`dlqr`].
    pub poles: Vec<Complex<f64>>,
    /// Norm of the residual of the Riccati equation relative to the norm of its greatest term (dimensionless).
    pub residual: f64,
}

/// Returns the regulator of `ẋ = A x + B u` that minimises `∫ xᵀQx + uᵀRu dt`, time in `[s]`.
///
/// `a` is `n×n`, `b` is `n×m`, the weight `q` of the states `n×n`, symmetric and positive semidefinite, the weight `r`
/// of the inputs `m×m`, symmetric and positive definite.
///
/// ```
/// use sincro_analysis::linear::{DMatrix, lqr};
///
/// // double integrator with unit weights: K = [1, √3]
/// let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
/// let b = DMatrix::from_row_slice(2, 1, &[0.0, 1.0]);
/// let regulator = lqr(&a, &b, &DMatrix::identity(2, 2), &DMatrix::identity(1, 1)).unwrap();
/// assert!((regulator.k[0] - 1.0).abs() < 1e-12 && (regulator.k[1] - 3.0_f64.sqrt()).abs() < 1e-12);
/// ```
///
/// # Errors
///
/// [`LinearError::Size`], [`LinearError::NotFinite`], [`LinearError::Empty`]: matrices that do not fit or have no
/// finite entries. [`LinearError::NotSymmetric`], [`LinearError::NotPositiveSemidefinite`],
/// [`LinearError::NotPositiveDefinite`]: an invalid weight. [`LinearError::NotStabilisable`],
/// [`LinearError::NotDetectable`]: no feedback stabilises, or the cost does not see a mode that does not decay.
pub fn lqr(a: &DMatrix<f64>, b: &DMatrix<f64>, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Result<Regulator, LinearError> {
    check(a, b, q, r)?;
    check_stabilisable(a, b, |pole| pole.re >= -NOTHING * a.norm())?;
    let r_inverse = inverse_of_weight(r)?;
    let gain = |p: &DMatrix<f64>| &r_inverse * b.transpose() * p;
    let p = by_sign(a, &symmetric(&(b * &r_inverse * b.transpose())), q).ok_or(LinearError::NotDetectable)?;
    refined(p, |p| {
        let k = gain(p);
        let closed = a - b * &k;
        let poles = eigenvalues(&closed);
        let is_stable = poles.iter().all(|pole| pole.re < 0.0);
        let terms = [a.transpose() * p, p * a, -(k.transpose() * r * &k), q.clone()];
        let regulator = Regulator { residual: imbalance(&terms), p: p.clone(), poles, k };
        // the cost of this feedback is the next P
        let next = || lyapunov(&closed, &symmetric(&(q + regulator.k.transpose() * r * &regulator.k)));
        is_stable.then(|| (next(), regulator.clone()))
    })
}

/// Returns the regulator of the sampled system `x⁺ = A x + B u` that minimises `Σ xᵀQx + uᵀRu` over all samples. Shapes
/// are those of [`lqr`].
///
/// # Errors
///
/// As [`lqr`].
///
/// ```
/// use sincro_analysis::prelude::*;
///
/// # fn main() -> Result<(), LinearError> {
/// // x⁺ = x + u, cost Σ x² + u²: P is the golden ratio, K = P/(1 + P)
/// let one = DMatrix::identity(1, 1);
/// let regulator = dlqr(&one, &one, &one, &one)?;
/// let golden = 0.5 * (1.0 + f64::sqrt(5.0));
/// assert!((regulator.p[0] - golden).abs() < 1e-12);
/// assert!((regulator.k[0] - golden / (1.0 + golden)).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
pub fn dlqr(a: &DMatrix<f64>, b: &DMatrix<f64>, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Result<Regulator, LinearError> {
    check(a, b, q, r)?;
    check_stabilisable(a, b, |pole| modulus(pole) >= 1.0 - NOTHING)?;
    let g = symmetric(&(b * inverse_of_weight(r)? * b.transpose()));
    let gain = |p: &DMatrix<f64>| {
        let weight = symmetric(&(r + b.transpose() * p * b));
        weight.cholesky().map(|factor| factor.solve(&(b.transpose() * p * a)))
    };
    let p = by_doubling(a, &g, q).ok_or(LinearError::NotDetectable)?;
    refined(p, |p| {
        let k = gain(p)?;
        let closed = a - b * &k;
        let poles = eigenvalues(&closed);
        let is_stable = poles.iter().all(|pole| modulus(*pole) < 1.0);
        let terms = [a.transpose() * p * &closed, -p, q.clone()];
        let regulator = Regulator { residual: imbalance(&terms), p: p.clone(), poles, k };
        let cost = symmetric(&(q + regulator.k.transpose() * r * &regulator.k));
        is_stable.then(|| (cost_to_come_back(&closed, &cost), regulator.clone()))
    })
}

/// Newton's method from a `P` that nearly solves the equation: as long as the residual falls, a few steps at most.
/// `step` gives the next `P` and what the present one makes; nothing if it does not stabilise.
fn refined(
    p: DMatrix<f64>,
    step: impl Fn(&DMatrix<f64>) -> Option<(Option<DMatrix<f64>>, Regulator)>,
) -> Result<Regulator, LinearError> {
    let (mut next, mut best) = step(&p).ok_or(LinearError::NotDetectable)?;
    for _ in 0..MAX_REFINEMENTS {
        let Some((after, regulator)) = next.and_then(|p| step(&p)) else { break };
        let falls = regulator.residual < 0.5 * best.residual;
        if regulator.residual <= best.residual {
            best = regulator;
        }
        if !falls {
            break;
        }
        next = after;
    }
    Ok(best)
}

/// `Σ (Aᵏ)ᵀ Q Aᵏ` for an A that decays, by doubling.
fn cost_to_come_back(a: &DMatrix<f64>, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (mut a, mut x) = (a.clone(), q.clone());
    for _ in 0..MAX_DOUBLINGS {
        let added = a.transpose() * &x * &a;
        let settled = added.norm() <= 1e-17 * x.norm();
        x = symmetric(&(x + added));
        a = &a * &a;
        if !x.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        if settled {
            return Some(x);
        }
    }
    None
}

fn check(a: &DMatrix<f64>, b: &DMatrix<f64>, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Result<(), LinearError> {
    let (n, m) = (a.nrows(), b.ncols());
    let all = [("A", a, (n, n)), ("B", b, (n, m)), ("Q", q, (n, n)), ("R", r, (m, m))];
    for (what, matrix, size) in all {
        expect_size(what, matrix, size)?;
        expect_finite(what, matrix)?;
    }
    if n == 0 || m == 0 {
        return Err(LinearError::Empty);
    }
    expect_symmetric("Q", q)?;
    expect_symmetric("R", r)?;
    let least = symmetric(q).symmetric_eigenvalues().iter().copied().fold(0.0, f64::min);
    if least < -NOTHING * q.norm() {
        return Err(LinearError::NotPositiveSemidefinite { what: "Q", eigenvalue: least });
    }
    Ok(())
}

fn inverse_of_weight(r: &DMatrix<f64>) -> Result<DMatrix<f64>, LinearError> {
    let factor = symmetric(r).cholesky().ok_or(LinearError::NotPositiveDefinite { what: "R" })?;
    Ok(factor.inverse())
}

/// Hautus: an eigenvalue is reached if `[A − λI, B]` has full rank.
fn check_stabilisable(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    stays: impl Fn(Complex<f64>) -> bool,
) -> Result<(), LinearError> {
    let n = a.nrows();
    let size = if b.norm() > 0.0 { a.norm() / b.norm() } else { 1.0 };
    let size = if size > 0.0 { size } else { 1.0 };
    for pole in eigenvalues(a).into_iter().filter(|pole| stays(*pole)) {
        let pencil = DMatrix::from_fn(n, n + b.ncols(), |row, column| match column {
            c if c >= n => Complex::new(size * b[(row, c - n)], 0.0),
            c if c == row => Complex::new(a[(row, c)], 0.0) - pole,
            c => Complex::new(a[(row, c)], 0.0),
        });
        let sizes = pencil.singular_values();
        if sizes.min() <= UNREACHED * sizes.max() {
            return Err(LinearError::NotStabilisable { mode: (pole.re, pole.im) });
        }
    }
    Ok(())
}

/// `P` from the sign `S` of `[A, −G; −Q, −Aᵀ]`: `[S₁₂; S₂₂ + I] P = −[S₁₁ + I; S₂₁]`, in the sense of least squares.
fn by_sign(a: &DMatrix<f64>, g: &DMatrix<f64>, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let mut hamiltonian = DMatrix::zeros(2 * n, 2 * n);
    hamiltonian.view_mut((0, 0), (n, n)).copy_from(a);
    hamiltonian.view_mut((0, n), (n, n)).copy_from(&-g);
    hamiltonian.view_mut((n, 0), (n, n)).copy_from(&-q);
    hamiltonian.view_mut((n, n), (n, n)).copy_from(&-a.transpose());
    let mut s = sign(&hamiltonian)?;
    for k in 0..2 * n {
        s[(k, k)] += 1.0;
    }
    let right = -s.columns(0, n).into_owned();
    let qr = s.columns(n, n).into_owned().qr();
    let p = qr.r().solve_upper_triangular(&(qr.q().transpose() * right))?;
    Some(symmetric(&p))
}

/// `A ← A W A`, `G ← G + A W G Aᵀ`, `H ← H + Aᵀ H W A` with `W = (I + G H)⁻¹`: each step covers twice as many ticks; H
/// tends to P.
fn by_doubling(a: &DMatrix<f64>, g: &DMatrix<f64>, q: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (mut a, mut g, mut h) = (a.clone(), g.clone(), q.clone());
    let identity = DMatrix::<f64>::identity(a.nrows(), a.nrows());
    for _ in 0..MAX_DOUBLINGS {
        let w = (&identity + &g * &h).try_inverse()?;
        let wa = &w * &a;
        let added = a.transpose() * &h * &wa;
        let settled = added.norm() <= 1e-15 * h.norm();
        h = symmetric(&(&h + added));
        g = symmetric(&(&g + &a * &w * &g * a.transpose()));
        a = &a * wa;
        if !h.iter().chain(g.iter()).chain(a.iter()).all(|x| x.is_finite()) {
            return None;
        }
        if settled {
            return Some(h);
        }
    }
    None
}

/// Norm of a sum beside the norm of its greatest term.
fn imbalance(terms: &[DMatrix<f64>]) -> f64 {
    let greatest = terms.iter().map(DMatrix::norm).fold(0.0, f64::max);
    let sum = terms.iter().skip(1).fold(terms[0].clone(), |sum, term| sum + term);
    if greatest == 0.0 { 0.0 } else { sum.norm() / greatest }
}
