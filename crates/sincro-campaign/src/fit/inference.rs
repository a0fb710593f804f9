//! Trust in a fit: covariance, intervals, correlation, identifiability, whiteness of the residuals.

use sincro_analysis::linear::DMatrix;

use super::solve::Solution;
use crate::design::normal_cdf;
use crate::statistics::student_quantile;

/// Singular value of the scaled sensitivities, relative to the largest, below which a combination is not identifiable.
const RANK: f64 = 1e-7;
/// Interval, relative to the value, beyond which a parameter is practically not identifiable.
const LOOSE: f64 = 1.0;
/// Lags of the autocorrelation.
const MAX_LAG: usize = 40;

/// Estimate of one unknown of a fit with its confidence interval, in the unit of the unknown; an entry of
/// [`Inference::estimates`].
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Fitted value.
    pub value: f64,
    /// Standard deviation; infinite if the unknown is not identifiable.
    pub std: f64,
    /// Half width of the confidence interval, by Student's distribution; infinite if the unknown is not identifiable.
    pub half_width: f64,
    /// True if the data determine the unknown; false if it is part of an [`Unidentifiable`] combination.
    pub is_identifiable: bool,
}

/// Combination of unknowns that the data do not determine: a right singular vector of the scaled sensitivities.
#[derive(Clone, Debug, PartialEq)]
pub struct Unidentifiable {
    /// Its singular value relative to the largest (dimensionless, 0 to 1).
    pub share: f64,
    /// Unknowns in the combination: index in [`Model::names`](super::Model::names) and component of the unit vector,
    /// relative to the values of the unknowns; descending in magnitude, those below 0.1 left out.
    pub parts: Vec<(usize, f64)>,
}

/// Statistics of a fit: intervals, correlation and identifiability of its `n` unknowns; result of [`infer`].
#[derive(Clone, Debug, PartialEq)]
pub struct Inference {
    /// Estimates of the `n` unknowns, in the order of [`Model::names`](super::Model::names).
    pub estimates: Vec<Estimate>,
    /// Correlation matrix of the estimates, `n` rows of `n` entries, each −1 to 1; 1 on the diagonal.
    pub correlation: Vec<Vec<f64>>,
    /// Singular values of the scaled sensitivities relative to the largest, descending, `n` of them (dimensionless).
    pub singular: Vec<f64>,
    /// Combinations that the data do not determine, the best determined first; empty if there are none.
    pub unidentifiable: Vec<Unidentifiable>,
    /// Standard deviation of the weighted residuals, over the degrees of freedom; near 1 if the noise was given
    /// correctly.
    pub sigma: f64,
    /// Number of measured values.
    pub n_values: usize,
    /// Degrees of freedom: measured values less unknowns, at least 1.
    pub freedom: f64,
}

/// Computes the statistics of a solution of `n` unknowns: intervals, correlation, identifiability. `scales` holds `n`
/// typical sizes, one for each unknown in its unit and in the order of [`Model::names`](super::Model::names), for
/// unknowns that came out as 0; `confidence` is the probability of the intervals, in (0, 1).
#[must_use]
pub fn infer(solution: &Solution, scales: &[f64], confidence: f64) -> Inference {
    let n = scales.len();
    let rows: Vec<usize> = (0..solution.residuals.len()).filter(|i| solution.residuals[*i].is_finite()).collect();
    let freedom = (rows.len() - n).max(1) as f64;
    let weight = |i: usize| solution.robust[i].sqrt();
    let squares: f64 = rows.iter().map(|i| solution.robust[*i] * solution.residuals[*i] * solution.residuals[*i]).sum();
    let sigma = (squares / freedom).sqrt();
    // relative to what is found, which may be far from the start
    let scales: Vec<f64> =
        scales.iter().zip(&solution.unknowns).map(|(s, x)| if *x == 0.0 { *s } else { x.abs() }).collect();
    let jacobian = DMatrix::from_fn(rows.len(), n, |i, k| {
        let slope = solution.sensitivities.columns[k][rows[i]];
        weight(rows[i]) * scales[k] * if slope.is_finite() { slope } else { 0.0 }
    });
    let svd = jacobian.svd(false, true);
    let v_t = svd.v_t.expect("it was asked for");
    let largest = svd.singular_values.iter().fold(0.0_f64, |a, b| a.max(*b)).max(f64::MIN_POSITIVE);
    let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
    order.sort_by(|a, b| svd.singular_values[*b].total_cmp(&svd.singular_values[*a]));
    let t = student_quantile(0.5 + 0.5 * confidence, freedom);
    let mut covariance = DMatrix::<f64>::zeros(n, n);
    let (mut unidentifiable, mut singular) = (Vec::new(), Vec::new());
    let mut is_identifiable = vec![true; n];
    for i in order {
        let value = svd.singular_values[i];
        singular.push(value / largest);
        // a combination whose own interval is as large as the parameters
        let is_loose = t * sigma / value.max(f64::MIN_POSITIVE) > LOOSE;
        if value <= RANK * largest || is_loose {
            let mut parts: Vec<(usize, f64)> = (0..n).map(|k| (k, v_t[(i, k)])).collect();
            parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
            parts.retain(|(_, part)| part.abs() > 0.1);
            parts.iter().for_each(|(k, _)| is_identifiable[*k] = false);
            unidentifiable.push(Unidentifiable { share: value / largest, parts });
        }
        if value > RANK * largest {
            for a in 0..n {
                (0..n).for_each(|b| covariance[(a, b)] += v_t[(i, a)] * v_t[(i, b)] / (value * value));
            }
        }
    }
    let std_of = |k: usize| sigma * covariance[(k, k)].sqrt() * scales[k];
    let estimates = (0..n)
        .map(|k| {
            let std = if is_identifiable[k] { std_of(k) } else { f64::INFINITY };
            Estimate { value: solution.unknowns[k], std, half_width: t * std, is_identifiable: is_identifiable[k] }
        })
        .collect();
    let correlation = (0..n)
        .map(|a| (0..n).map(|b| covariance[(a, b)] / (covariance[(a, a)] * covariance[(b, b)]).sqrt()).collect())
        .collect();
    Inference { estimates, correlation, singular, unidentifiable, sigma, n_values: rows.len(), freedom }
}

/// Test of the residuals of one column for whiteness: residuals of a model that misses nothing are uncorrelated.
#[derive(Clone, Debug, PartialEq)]
pub struct Whiteness {
    /// Autocorrelation from lag 1 on, one lag being one measured value; 40 lags, or a quarter of the values if these
    /// are fewer.
    pub autocorrelation: Vec<f64>,
    /// Bound `1.96/√n` that white noise exceeds in magnitude at one lag in twenty.
    pub bound: f64,
    /// Probability (p-value) that white noise has a statistic of Ljung and Box (1978) at least as large, over 20 lags
    /// at most. Below 0.01 the residuals are hardly white.
    pub p_value: f64,
}

/// Tests residuals in the order of their times for whiteness; entries that are not finite are left out. `None` of fewer
/// than eight values, or if all are equal.
#[must_use]
pub fn whiteness(residuals: &[f64]) -> Option<Whiteness> {
    let r: Vec<f64> = residuals.iter().copied().filter(|r| r.is_finite()).collect();
    let n = r.len();
    if n < 8 {
        return None;
    }
    let mean = r.iter().sum::<f64>() / n as f64;
    let power: f64 = r.iter().map(|x| (x - mean) * (x - mean)).sum();
    if power <= 0.0 {
        return None;
    }
    let n_lags = MAX_LAG.min(n / 4);
    let at = |lag: usize| (lag..n).map(|k| (r[k] - mean) * (r[k - lag] - mean)).sum::<f64>() / power;
    let autocorrelation: Vec<f64> = (1..=n_lags).map(at).collect();
    let n_tested = n_lags.min(20);
    let statistic = (n * (n + 2)) as f64
        * (1..=n_tested).map(|lag| autocorrelation[lag - 1] * autocorrelation[lag - 1] / (n - lag) as f64).sum::<f64>();
    let freedom = n_tested.max(1) as f64;
    // Wilson and Hilferty 1931
    let third = 2.0 / (9.0 * freedom);
    let z = (libm::cbrt(statistic / freedom) - (1.0 - third)) / third.sqrt();
    Some(Whiteness { autocorrelation, bound: 1.96 / (n as f64).sqrt(), p_value: 1.0 - normal_cdf(z) })
}
