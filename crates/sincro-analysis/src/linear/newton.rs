//! Equations for trim: finds `x` with `r(x) = 0`, or says why there is none nearby. Cost: one singular value
//! decomposition a step.
//!
//! Damped Gauss–Newton: the step is `−J⁺ r` with the pseudo-inverse of the Jacobian (key `golub2013`, 5.5), which is
//! Newton's for square systems, the shortest one where unknowns are left over, and the least-squares one where
//! equations are. It is halved until it brings a share of the descent that its slope promises (key `nocedal2006`, 3.1
//! and 10.3).

use std::fmt;

use super::{DMatrix, DVector};

/// Singular values below this share of the greatest count as zero.
const RANK: f64 = 1e-10;
/// Share of the promised descent that a step must bring.
const ENOUGH: f64 = 1e-4;
/// Halvings of a step before it counts as none.
const MAX_HALVINGS: usize = 40;
/// A gradient `|Jᵀr|` below this share of `|J| |r|` leads nowhere.
const LEVEL: f64 = 1e-7;

/// Solution of the nonlinear equations `r(x) = 0`, as [`solve`] returns it.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Unknowns x, in the order and units of `x0`.
    pub x: Vec<f64>,
    /// Greatest magnitude among the residuals, in their units; at most the tolerance.
    pub residual: f64,
    /// Number of Newton steps taken.
    pub iterations: usize,
}

/// Failure of [`solve`], with the last iterate, which has the smallest norm of the residuals found. Its text
/// (`Display`) is a message for the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Reason for the end of the iteration.
    pub reason: Reason,
    /// Unknowns of the last iterate, in the order and units of `x0`.
    pub x: Vec<f64>,
    /// Greatest magnitude among the residuals there, in their units; NaN if one is not a number.
    pub residual: f64,
    /// Index of that residual, from 0.
    pub worst: usize,
    /// Number of Newton steps taken.
    pub iterations: usize,
}

/// Reason why [`solve`] ended without a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// No step makes the residuals smaller: there is no solution nearby. Start elsewhere.
    LocalMinimum,
    /// The Jacobian is rank-deficient: some unknowns change nothing here, and without them the residuals do not get
    /// smaller.
    Singular,
    /// A residual or an entry of the Jacobian is not finite.
    NotFinite,
    /// The limit `max_steps` was reached while the residuals were still getting smaller.
    TooManySteps,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let why = match self.reason {
            Reason::LocalMinimum => "no solution near the start: every step makes the residual greater",
            Reason::Singular => "the equations do not determine a step: some unknowns change nothing here",
            Reason::NotFinite => "a residual or its derivative is not finite",
            Reason::TooManySteps => "the steps ran out while the residual was still getting smaller",
        };
        write!(
            f,
            "{why}; residual {:.3e} in equation {} after {} steps",
            self.residual,
            self.worst + 1,
            self.iterations
        )
    }
}

impl std::error::Error for Failure {}

/// Solves `r(x) = 0` from the start `x0` by the damped Gauss–Newton method, until no residual is greater in magnitude
/// than `tolerance` (in the units of the residuals), in `max_steps` steps at most.
///
/// `residual(x, r)` fills the `n_residuals` values of r; `jacobian(x, J)` adds to the zeroed matrix `∂r/∂x`,
/// `n_residuals` rows by `x0.len()` columns. Fewer residuals than unknowns give the solution near the start.
///
/// ```
/// use sincro_analysis::linear::newton::solve;
///
/// // where the unit circle meets the diagonal
/// let residual = |x: &[f64], r: &mut [f64]| {
///     r[0] = x[0] * x[0] + x[1] * x[1] - 1.0;
///     r[1] = x[0] - x[1];
/// };
/// let jacobian = |x: &[f64], j: &mut sincro_analysis::linear::DMatrix<f64>| {
///     j.copy_from_slice(&[2.0 * x[0], 1.0, 2.0 * x[1], -1.0]); // column by column
/// };
/// let solution = solve(2, residual, jacobian, &[1.0, 0.5], 1e-14, 20).unwrap();
/// assert!((solution.x[0] - 0.5_f64.sqrt()).abs() < 1e-14);
/// ```
///
/// # Errors
///
/// [`Failure`] with the reason and the last iterate.
pub fn solve(
    n_residuals: usize,
    mut residual: impl FnMut(&[f64], &mut [f64]),
    mut jacobian: impl FnMut(&[f64], &mut DMatrix<f64>),
    x0: &[f64],
    tolerance: f64,
    max_steps: usize,
) -> Result<Solution, Failure> {
    let mut x = DVector::from_column_slice(x0);
    let mut r = DVector::zeros(n_residuals);
    let mut j = DMatrix::zeros(n_residuals, x0.len());
    residual(x.as_slice(), r.as_mut_slice());
    let mut iterations = 0;
    loop {
        let fail = |reason| Err(failure(reason, &x, &r, iterations));
        if r.iter().any(|v| !v.is_finite()) {
            return fail(Reason::NotFinite);
        }
        if r.iter().all(|v| v.abs() <= tolerance) {
            return Ok(Solution { residual: largest(&r).1, x: x.as_slice().to_vec(), iterations });
        }
        if iterations == max_steps {
            return fail(Reason::TooManySteps);
        }
        j.fill(0.0);
        jacobian(x.as_slice(), &mut j);
        if j.iter().any(|v| !v.is_finite()) {
            return fail(Reason::NotFinite);
        }
        let Some((step, rank)) = newton_step(&j, &r) else { return fail(Reason::Singular) };
        let stuck = if rank < j.nrows().min(j.ncols()) { Reason::Singular } else { Reason::LocalMinimum };
        let gradient = j.tr_mul(&r);
        if gradient.norm() <= LEVEL * j.norm() * r.norm() {
            return fail(stuck);
        }
        match search(&x, &step, &gradient, r.norm_squared(), &mut residual, &mut r) {
            Some(better) => x = better,
            None => {
                residual(x.as_slice(), r.as_mut_slice());
                return Err(failure(stuck, &x, &r, iterations));
            }
        }
        iterations += 1;
    }
}

/// `−J⁺ r` and the rank of J; `None` if J is zero.
pub(crate) fn newton_step(j: &DMatrix<f64>, r: &DVector<f64>) -> Option<(DVector<f64>, usize)> {
    if j.is_empty() || j.amax() == 0.0 {
        return None;
    }
    let svd = j.clone().svd(true, true);
    let least = RANK * svd.singular_values.max();
    let step = svd.solve(&-r, least).ok()?;
    Some((step, svd.rank(least)))
}

/// Halves the step until it brings enough; leaves the residual of the new unknowns in `r`.
fn search(
    x: &DVector<f64>,
    step: &DVector<f64>,
    gradient: &DVector<f64>,
    square: f64,
    residual: &mut impl FnMut(&[f64], &mut [f64]),
    r: &mut DVector<f64>,
) -> Option<DVector<f64>> {
    let slope = 2.0 * gradient.dot(step);
    let mut share = 1.0;
    for _ in 0..MAX_HALVINGS {
        let trial = x + step * share;
        residual(trial.as_slice(), r.as_mut_slice());
        // |r(x + a p)|² ≤ |r|² + c a slope; what is not finite is never enough
        if r.norm_squared() <= square + ENOUGH * share * slope && trial != *x {
            return Some(trial);
        }
        share *= 0.5;
    }
    None
}

fn failure(reason: Reason, x: &DVector<f64>, r: &DVector<f64>, iterations: usize) -> Failure {
    let (worst, residual) = largest(r);
    Failure { reason, x: x.as_slice().to_vec(), residual, worst, iterations }
}

/// Index and magnitude of the greatest entry; an entry that is not a number is the greatest.
fn largest(r: &DVector<f64>) -> (usize, f64) {
    let greater = |best: (usize, f64), (k, v): (usize, &f64)| {
        if v.abs() > best.1 || v.is_nan() { (k, v.abs()) } else { best }
    };
    r.iter().enumerate().fold((0, 0.0), greater)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_system_takes_one_step() {
        let solution = solve(
            2,
            |x, r| {
                r[0] = 2.0 * x[0] + x[1] - 3.0;
                r[1] = x[0] - x[1];
            },
            |_, j| j.copy_from_slice(&[2.0, 1.0, 1.0, -1.0]),
            &[10.0, -7.0],
            1e-12,
            5,
        )
        .unwrap();
        assert!(solution.iterations <= 2 && (solution.x[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn unknowns_left_over_take_the_shortest_way() {
        // x + y = 2 from the origin: (1, 1)
        let solution = solve(1, |x, r| r[0] = x[0] + x[1] - 2.0, |_, j| j.fill(1.0), &[0.0, 0.0], 1e-14, 5).unwrap();
        assert!((solution.x[0] - 1.0).abs() < 1e-14 && (solution.x[1] - 1.0).abs() < 1e-14);
    }

    #[test]
    fn consistent_equations_left_over_are_solved() {
        // x = 3, 2x = 6, x² = 9
        let solution = solve(
            3,
            |x, r| {
                r[0] = x[0] - 3.0;
                r[1] = 2.0 * x[0] - 6.0;
                r[2] = x[0] * x[0] - 9.0;
            },
            |x, j| j.copy_from_slice(&[1.0, 2.0, 2.0 * x[0]]),
            &[1.0],
            1e-13,
            30,
        )
        .unwrap();
        assert!((solution.x[0] - 3.0).abs() < 1e-13);
    }

    #[test]
    fn the_line_search_tames_an_overshooting_step() {
        // x / √(1 + x²) = 0 from 2: the undamped step goes to −x³ = −8, and further out for ever
        let root = |x: f64| (1.0 + x * x).sqrt();
        let solution = solve(
            1,
            |x, r| r[0] = x[0] / root(x[0]),
            |x, j| j[(0, 0)] = 1.0 / (root(x[0]) * root(x[0]) * root(x[0])),
            &[2.0],
            1e-14,
            30,
        )
        .unwrap();
        assert!(solution.x[0].abs() < 1e-13);
    }

    #[test]
    fn no_solution_is_a_local_minimum_with_its_residual() {
        // x² + 1 = 0: at best 1
        let failure =
            solve(1, |x, r| r[0] = x[0] * x[0] + 1.0, |x, j| j[(0, 0)] = 2.0 * x[0], &[3.0], 1e-12, 200).unwrap_err();
        assert!((failure.residual - 1.0).abs() < 1e-3, "{failure}");
        // x = 1 and x = 2: the middle, half off
        let failure = solve(
            2,
            |x, r| {
                r[0] = x[0] - 1.0;
                r[1] = x[0] - 2.0;
            },
            |_, j| j.fill(1.0),
            &[7.0],
            1e-12,
            20,
        )
        .unwrap_err();
        assert_eq!(failure.reason, Reason::LocalMinimum);
        assert!((failure.residual - 0.5).abs() < 1e-12 && (failure.x[0] - 1.5).abs() < 1e-12);
    }

    #[test]
    fn contradicting_equations_of_one_combination_are_singular() {
        // x + y = 0 and x + y = 1
        let sum = |x: &[f64], r: &mut [f64]| (r[0], r[1]) = (x[0] + x[1], x[0] + x[1] - 1.0);
        let failure = solve(2, sum, |_, j| j.fill(1.0), &[3.0, 0.0], 1e-12, 20).unwrap_err();
        assert_eq!(failure.reason, Reason::Singular);
        assert!((failure.residual - 0.5).abs() < 1e-12, "{failure}");
    }

    #[test]
    fn an_equation_without_unknowns_is_singular() {
        let failure = solve(1, |_, r| r[0] = 1.0, |_, _| {}, &[0.0], 1e-12, 20).unwrap_err();
        assert_eq!(failure.reason, Reason::Singular);
        let failure = solve(1, |_, r| r[0] = f64::NAN, |_, _| {}, &[0.0], 1e-12, 20).unwrap_err();
        assert_eq!(failure.reason, Reason::NotFinite);
        let failure = solve(1, |x, r| r[0] = x[0] * x[0], |x, j| j[(0, 0)] = 2.0 * x[0], &[1.0], 1e-12, 3).unwrap_err();
        assert_eq!(failure.reason, Reason::TooManySteps);
    }
}
