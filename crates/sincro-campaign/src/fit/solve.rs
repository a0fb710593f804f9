//! Nonlinear least squares: Levenberg–Marquardt with bounds, and robust losses by reweighting.

use sincro_analysis::linear::{DMatrix, DVector};

use super::model::{Model, ModelError, Sensitivities};

/// Iteration limit.
const MAX_ITERATIONS: usize = 60;
/// Relative change of the cost or of all unknowns below which the search has converged.
const CONVERGED: f64 = 1e-10;
/// Scaled gradient below which a point is stationary: the largest cosine of an angle between the residuals and a column
/// of the sensitivities. A relative decrease of the cost by [`CONVERGED`] is one of its square.
const STATIONARY: f64 = 1e-4;
/// Part of the residuals along a column, relative to the data, that is below the accuracy of the runs.
const NOISE: f64 = 1e-8;
/// Damping at the start, and after the weights of a robust loss have changed.
const DAMPING: f64 = 1e-3;
/// Derivative, relative to the data, below which a parameter does nothing.
const DEAD: f64 = 1e-11;

/// Loss function of the weighted residuals of a fit, in standard deviations of the noise; robust ones give outliers
/// less weight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loss {
    /// Least squares: r²/2.
    #[default]
    Squares,
    /// Quadratic, linear beyond 1.345 standard deviations (Huber 1964).
    Huber,
    /// Quadratic near 0, logarithmic beyond 2.385 standard deviations (Cauchy).
    Cauchy,
}

impl Loss {
    /// Returns the loss named `squares`, `huber` or `cauchy`; `None` for any other word.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        match word {
            "squares" => Some(Self::Squares),
            "huber" => Some(Self::Huber),
            "cauchy" => Some(Self::Cauchy),
            _ => None,
        }
    }

    /// Returns the name of the loss in files and on the command line: `squares`, `huber` or `cauchy`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Squares => "squares",
            Self::Huber => "huber",
            Self::Cauchy => "cauchy",
        }
    }

    /// Weight of a residual in the reweighted problem; `r` in standard deviations.
    fn weight(self, r: f64) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::Huber => (1.345 / r.abs()).min(1.0),
            Self::Cauchy => 1.0 / (1.0 + (r / 2.385) * (r / 2.385)),
        }
    }
}

/// Solution of the least-squares problem of a [`Model`]; result of [`solve`]. Residuals are in the order of
/// [`Model::predict`], unknowns in that of [`Model::names`].
#[derive(Clone, Debug)]
pub struct Solution {
    /// Fitted values of the unknowns, in their units.
    pub unknowns: Vec<f64>,
    /// Weighted residuals, weight times (predicted less measured), dimensionless if the weights are 1/σ; NaN where
    /// nothing was measured.
    pub residuals: Vec<f64>,
    /// Weights of the robust loss, 0 to 1, one for each residual; all 1 for least squares.
    pub robust: Vec<f64>,
    /// Derivatives of the weighted residuals by the unknowns.
    pub sensitivities: Sensitivities,
    /// Half the sum of the squared weighted residuals at the start and at the end.
    pub cost: (f64, f64),
    /// Number of Levenberg–Marquardt iterations.
    pub n_iterations: usize,
    /// True if the change or the gradient fell below its tolerance; else no better point was found, or the iteration
    /// limit was reached.
    pub has_converged: bool,
    /// True for each unknown that lies at a bound, in the order of the unknowns.
    pub at_bound: Vec<bool>,
}

/// Failure of a fit, by [`solve`] or [`Fit::new`](super::Fit::new).
#[derive(Debug)]
pub enum SolveError {
    /// The model cannot be run, at the start or for its derivatives.
    Model(ModelError),
    /// Unknowns that change nothing of what was measured: their indices in [`Model::names`], ascending. Fix them, or
    /// measure more.
    Dead(Vec<usize>),
    /// The data within the time of the run are no more than the unknowns; their number.
    TooFew(usize),
}

impl From<ModelError> for SolveError {
    fn from(error: ModelError) -> Self {
        Self::Model(error)
    }
}

/// Measured values and weights in the order of [`Model::predict`].
fn flat(model: &Model<'_>) -> (Vec<f64>, Vec<f64>) {
    let columns = || model.sets.iter().flat_map(|set| &set.columns);
    let measured = columns().flat_map(|c| c.values.iter().copied()).collect();
    let weights = columns().flat_map(|c| c.values.iter().map(|_| c.weight)).collect();
    (measured, weights)
}

/// Fits the unknowns of a model to its data by the Levenberg–Marquardt method with bounds, from the values `start` (one
/// for each unknown); robust losses by iterative reweighting.
///
/// # Errors
///
/// [`SolveError::Model`]: the model cannot be run, or was interrupted. [`SolveError::Dead`]: an unknown has no effect.
/// [`SolveError::TooFew`]: no more data than unknowns.
pub fn solve(model: &Model<'_>, loss: Loss, start: &[f64]) -> Result<Solution, SolveError> {
    let n = model.n_unknowns();
    let (measured, weights) = flat(model);
    let residuals_of = |predicted: &[f64]| -> Vec<f64> {
        predicted.iter().zip(&measured).zip(&weights).map(|((p, m), w)| w * (p - m)).collect()
    };
    let scales: Vec<f64> = (0..n).map(|k| model.bounds(k).3).collect();
    let clamp = |k: usize, value: f64| value.clamp(model.bounds(k).1, model.bounds(k).2);
    let mut x: Vec<f64> = start.iter().enumerate().map(|(k, value)| clamp(k, *value)).collect();
    model.set_coarse(true);
    let mut residuals = residuals_of(&model.predict(&x)?);
    let n_values = residuals.iter().filter(|r| r.is_finite()).count();
    if n_values <= n {
        return Err(SolveError::TooFew(n_values));
    }
    let start_cost = half_square(&residuals);
    let mut robust = weights_of(loss, &residuals);
    let (mut damping, mut converged, mut n_iterations) = (DAMPING, false, 0);
    let size = measured.iter().zip(&weights).map(|(m, w)| (w * m).abs()).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let data_norm =
        measured.iter().zip(&weights).map(|(m, w)| w * m).filter(|x| x.is_finite()).map(|x| x * x).sum::<f64>().sqrt();
    while n_iterations < MAX_ITERATIONS && !converged {
        n_iterations += 1;
        let sensitivities = model.sensitivities(&x, false)?;
        if n_iterations == 1 {
            let dead = dead(&sensitivities.columns, &weights, &scales, size);
            if !dead.is_empty() {
                return Err(SolveError::Dead(dead));
            }
        }
        let (jacobian, r) = reduced(&sensitivities.columns, &weights, &scales, &robust, &residuals);
        let gradient = jacobian.transpose() * &r;
        // an unknown at a bound that the gradient pushes against stays there
        let is_held: Vec<bool> = (0..n)
            .map(|k| {
                (x[k] <= model.bounds(k).1 && gradient[k] > 0.0) || (x[k] >= model.bounds(k).2 && gradient[k] < 0.0)
            })
            .collect();
        let mut hessian = jacobian.transpose() * &jacobian;
        let stationary = is_stationary(&gradient, &hessian, &is_held, r.norm(), data_norm);
        let mut right = -gradient;
        for k in (0..n).filter(|k| is_held[*k]) {
            (0..n).for_each(|j| {
                hessian[(k, j)] = 0.0;
                hessian[(j, k)] = 0.0;
            });
            hessian[(k, k)] = 1.0;
            right[k] = 0.0;
        }
        let cost = 0.5 * r.norm_squared();
        let (mut accepted, mut is_stuck) = (false, false);
        while damping < 1e12 {
            let mut damped = hessian.clone();
            (0..n).for_each(|k| damped[(k, k)] += damping * hessian[(k, k)].max(1e-12));
            let Some(step) = damped.cholesky().map(|factor| factor.solve(&right)) else {
                damping *= 10.0;
                continue;
            };
            let next: Vec<f64> = (0..n).map(|k| clamp(k, x[k] + step[k] * scales[k])).collect();
            let tried = match model.predict(&next) {
                Ok(predicted) => residuals_of(&predicted),
                Err(ModelError::Interrupted) => return Err(ModelError::Interrupted.into()),
                // too far: the scene refuses it, or the run stops
                Err(_) => {
                    damping *= 10.0;
                    continue;
                }
            };
            let tried_cost = weighted_half_square(&tried, &robust);
            if tried_cost.is_finite() && tried_cost <= cost && count(&tried) == n_values {
                let change = (0..n).map(|k| ((next[k] - x[k]) / scales[k]).abs()).fold(0.0, f64::max);
                let is_small = change < CONVERGED || (cost - tried_cost) <= CONVERGED * cost;
                // a small step says nothing if it is the damping that makes it small
                converged = is_small && (stationary || damping <= 1.0);
                is_stuck = is_small && !converged;
                (x, residuals) = (next, tried);
                damping = (damping * 0.2).max(1e-12);
                accepted = true;
                break;
            }
            damping *= 5.0;
        }
        if !accepted {
            (converged, is_stuck) = (stationary, !stationary);
        }
        if loss != Loss::Squares {
            let next = weights_of(loss, &residuals);
            let change = next.iter().zip(&robust).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            robust = next;
            if change >= 1e-6 {
                (converged, is_stuck, damping) = (false, false, DAMPING);
            }
        }
        if is_stuck {
            break;
        }
    }
    model.set_coarse(false);
    let mut sensitivities = model.sensitivities(&x, true)?;
    residuals = residuals_of(&model.predict(&x)?);
    // the last step, a Gauss–Newton step at the tolerance of the solution
    let (jacobian, r) = reduced(&sensitivities.columns, &weights, &scales, &robust, &residuals);
    let is_inside = |k: usize| x[k] > model.bounds(k).1 && x[k] < model.bounds(k).2;
    if (0..n).all(is_inside)
        && let Some(factor) = (jacobian.transpose() * &jacobian).cholesky()
    {
        let step = factor.solve(&-(jacobian.transpose() * r));
        let next: Vec<f64> = (0..n).map(|k| clamp(k, x[k] + step[k] * scales[k])).collect();
        let is_small = step.iter().all(|s| s.abs() < 1e-3);
        let tried = if is_small { model.predict(&next).ok().map(|predicted| residuals_of(&predicted)) } else { None };
        if let Some(tried) = tried
            && weighted_half_square(&tried, &robust) <= weighted_half_square(&residuals, &robust)
        {
            (x, residuals) = (next, tried);
        }
    }
    for column in &mut sensitivities.columns {
        column.iter_mut().zip(&weights).for_each(|(slope, weight)| *slope *= weight);
    }
    let at_bound = (0..n).map(|k| x[k] <= model.bounds(k).1 || x[k] >= model.bounds(k).2).collect();
    Ok(Solution {
        cost: (start_cost, half_square(&residuals)),
        unknowns: x,
        residuals,
        robust,
        sensitivities,
        n_iterations,
        has_converged: converged,
        at_bound,
    })
}

/// True if no unknown that is not held moves the residuals along themselves, beyond the accuracy of the runs.
fn is_stationary(
    gradient: &DVector<f64>,
    hessian: &DMatrix<f64>,
    is_held: &[bool],
    residual_norm: f64,
    data_norm: f64,
) -> bool {
    (0..gradient.len()).filter(|k| !is_held[*k]).all(|k| {
        let along = gradient[k].abs() / hessian[(k, k)].sqrt().max(f64::MIN_POSITIVE);
        along <= STATIONARY * residual_norm || along <= NOISE * data_norm
    })
}

fn count(residuals: &[f64]) -> usize {
    residuals.iter().filter(|r| r.is_finite()).count()
}

fn half_square(residuals: &[f64]) -> f64 {
    0.5 * residuals.iter().filter(|r| r.is_finite()).map(|r| r * r).sum::<f64>()
}

fn weighted_half_square(residuals: &[f64], robust: &[f64]) -> f64 {
    0.5 * residuals.iter().zip(robust).filter(|(r, _)| r.is_finite()).map(|(r, w)| w * r * r).sum::<f64>()
}

/// Weights of a loss, the scale of the noise by the median of the absolute residuals.
fn weights_of(loss: Loss, residuals: &[f64]) -> Vec<f64> {
    let mut sizes: Vec<f64> = residuals.iter().filter(|r| r.is_finite()).map(|r| r.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let sigma = (1.4826 * crate::statistics::quantile(&sizes, 0.5)).max(f64::MIN_POSITIVE);
    residuals.iter().map(|r| if r.is_finite() { loss.weight(r / sigma) } else { 1.0 }).collect()
}

/// Unknowns whose change by their whole scale moves no datum.
fn dead(columns: &[Vec<f64>], weights: &[f64], scales: &[f64], size: f64) -> Vec<usize> {
    let largest = |column: &[f64]| {
        column.iter().zip(weights).map(|(s, w)| (s * w).abs()).filter(|x| x.is_finite()).fold(0.0, f64::max)
    };
    (0..columns.len()).filter(|k| largest(&columns[*k]) * scales[*k] <= DEAD * size.max(f64::MIN_POSITIVE)).collect()
}

/// Rows that have data, in scaled unknowns, with the weights of the loss.
fn reduced(
    columns: &[Vec<f64>],
    weights: &[f64],
    scales: &[f64],
    robust: &[f64],
    residuals: &[f64],
) -> (DMatrix<f64>, DVector<f64>) {
    let rows: Vec<usize> = (0..residuals.len()).filter(|i| residuals[*i].is_finite()).collect();
    let jacobian = DMatrix::from_fn(rows.len(), columns.len(), |i, k| {
        let row = rows[i];
        let slope = columns[k][row];
        robust[row].sqrt() * weights[row] * scales[k] * if slope.is_finite() { slope } else { 0.0 }
    });
    let r = DVector::from_fn(rows.len(), |i, _| robust[rows[i]].sqrt() * residuals[rows[i]]);
    (jacobian, r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_stationary_by_the_angle_of_its_residuals() {
        let hessian = DMatrix::from_fn(2, 2, |i, j| if i == j { 4.0 } else { 0.0 });
        let of = |a: f64, b: f64, held: [bool; 2], data: f64| {
            is_stationary(&DVector::from_fn(2, |i, _| [a, b][i]), &hessian, &held, 1.0, data)
        };
        assert!(of(1e-5, -1e-5, [false; 2], 1.0));
        assert!(!of(1e-5, -0.1, [false; 2], 1.0));
        assert!(of(1e-5, -0.1, [false, true], 1.0) && of(1e-5, -0.1, [false; 2], 1e8));
    }
}
