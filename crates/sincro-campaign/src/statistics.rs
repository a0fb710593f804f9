//! Statistics of results: intervals, ranks, moments that need no memory.

use crate::design::inverse_normal;

/// Running mean, standard deviation and extremes of numbers that come one by one (Welford 1962), all in the unit of the
/// numbers; [`Moments::add`] takes the next one.
///
/// ```
/// use sincro_campaign::statistics::Moments;
///
/// let mut moments = Moments::default();
/// [1.0, 2.0, 3.0].into_iter().for_each(|x| moments.add(x));
/// assert_eq!((moments.mean, moments.std(), moments.max), (2.0, 1.0, 3.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Number of values added.
    pub n: u64,
    /// Mean; 0 before the first value.
    pub mean: f64,
    /// Sum of squares about the mean.
    squares: f64,
    /// Least value; ∞ before the first.
    pub min: f64,
    /// Greatest value; −∞ before the first.
    pub max: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self { n: 0, mean: 0.0, squares: 0.0, min: f64::INFINITY, max: f64::NEG_INFINITY }
    }
}

impl Moments {
    /// Adds the finite value `x`, in the unit of all others.
    pub fn add(&mut self, x: f64) {
        self.n += 1;
        let before = x - self.mean;
        self.mean += before / self.n as f64;
        self.squares += before * (x - self.mean);
        self.min = self.min.min(x);
        self.max = self.max.max(x);
    }

    /// Returns the sample standard deviation, with the divisor n − 1, in the unit of the values; 0 of fewer than two
    /// values.
    #[must_use]
    pub fn std(&self) -> f64 {
        if self.n < 2 { 0.0 } else { (self.squares / (self.n - 1) as f64).sqrt() }
    }

    /// Returns the half width of the confidence interval of the mean by Student's distribution, in the unit of the
    /// values, for the probability `confidence` in (0, 1); NaN of fewer than two values.
    #[must_use]
    pub fn mean_half_width(&self, confidence: f64) -> f64 {
        if self.n < 2 {
            return f64::NAN;
        }
        student_quantile(0.5 + 0.5 * confidence, (self.n - 1) as f64) * self.std() / (self.n as f64).sqrt()
    }
}

/// Interval of the share `successes / n` (Wilson 1927).
#[must_use]
pub(crate) fn wilson(successes: u64, n: u64, confidence: f64) -> (f64, f64) {
    if n == 0 {
        return (0.0, 1.0);
    }
    let (n, z) = (n as f64, inverse_normal(0.5 + 0.5 * confidence));
    let share = successes as f64 / n;
    let middle = (share + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half = z / (1.0 + z * z / n) * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    // rounding must not exclude what was seen
    ((middle - half).clamp(0.0, share), (middle + half).clamp(share, 1.0))
}

/// Quantile of Student's distribution with `freedom` degrees: exact for 1 and 2; else the expansion of Cornish and
/// Fisher in the normal quantile (Abramowitz and Stegun 26.7.5), and Newton's method from there on the distribution
/// function where the expansion alone is not exact.
#[must_use]
pub(crate) fn student_quantile(u: f64, freedom: f64) -> f64 {
    if u < 0.5 {
        return -student_quantile(1.0 - u, freedom);
    }
    if freedom == 1.0 {
        return sincro_math::elementary::tan(std::f64::consts::PI * (u - 0.5)).0;
    }
    if freedom == 2.0 {
        return (2.0 * u - 1.0) / (2.0 * u * (1.0 - u)).sqrt();
    }
    let (z, v) = (inverse_normal(u), freedom);
    let z2 = z * z;
    let mut t = z
        + z * (z2 + 1.0) / (4.0 * v)
        + z * (5.0 * z2 * z2 + 16.0 * z2 + 3.0) / (96.0 * v * v)
        + z * (3.0 * z2 * z2 * z2 + 19.0 * z2 * z2 + 17.0 * z2 - 15.0) / (384.0 * v * v * v);
    if v > 1e4 || u == 0.5 || !t.is_finite() {
        return t;
    }
    let scale = libm::exp(libm::lgamma(0.5 * (v + 1.0)) - libm::lgamma(0.5 * v)) / (std::f64::consts::PI * v).sqrt();
    // the upper tail is convex: from the second step on each stays on its side
    for _ in 0..50 {
        let density = scale * libm::exp(-0.5 * (v + 1.0) * libm::log1p(t * t / v));
        let change = (student_tail(t, v) - (1.0 - u)) / density;
        t = (t + change).max(0.0);
        if change.abs() <= 1e-13 * t {
            break;
        }
    }
    t
}

/// Probability that Student's distribution exceeds `t`, which is not negative.
fn student_tail(t: f64, freedom: f64) -> f64 {
    let x = freedom / (freedom + t * t);
    0.5 * incomplete_beta(x, 1.0 - x, 0.5 * freedom, 0.5)
}

/// Regularised incomplete beta function of `x` and `y` = 1 − `x`, by its continued fraction (Abramowitz and Stegun
/// 26.5.8, the method of Lentz 1976).
fn incomplete_beta(x: f64, y: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 || y <= 0.0 {
        return if x <= 0.0 { 0.0 } else { 1.0 };
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(y, x, b, a);
    }
    let log_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let front = libm::exp(a * libm::log(x) + b * libm::log(y) - log_beta) / a;
    let away_from_zero = |value: f64| if value.abs() < 1e-300 { 1e-300 } else { value };
    let (mut c, mut d) = (1.0, 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0)));
    let mut fraction = d;
    for m in (1..=2000).map(f64::from) {
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut factor = 1.0;
        for term in [even, odd] {
            d = 1.0 / away_from_zero(1.0 + term * d);
            c = away_from_zero(1.0 + term / c);
            factor = c * d;
            fraction *= factor;
        }
        if (factor - 1.0).abs() < 1e-15 {
            break;
        }
    }
    front * fraction
}

/// Quantile `share` (0 to 1; 0.5 is the median) of ascending values, in their unit: between neighbours on a straight
/// line. NaN if there is no value.
#[must_use]
pub(crate) fn quantile(ascending: &[f64], share: f64) -> f64 {
    let Some(last) = ascending.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let below = (place as usize).min(last);
    let above = (below + 1).min(last);
    ascending[below] + (place - below as f64) * (ascending[above] - ascending[below])
}

/// Interval of a quantile by order statistics, without any assumption on the distribution: their ranks are those of the
/// binomial distribution with equal tails. An end is none where no order statistic reaches the coverage.
#[must_use]
pub(crate) fn quantile_interval(ascending: &[f64], share: f64, confidence: f64) -> (Option<f64>, Option<f64>) {
    if ascending.is_empty() || share <= 0.0 || share >= 1.0 {
        return (None, None);
    }
    let (n, tail) = (ascending.len(), 0.5 * (1.0 - confidence));
    let (log_share, log_rest) = (libm::log(share), libm::log1p(-share));
    let log_all = libm::lgamma(n as f64 + 1.0);
    let probability = |k: usize| {
        let (k, rest) = (k as f64, (n - k) as f64);
        libm::exp(log_all - libm::lgamma(k + 1.0) - libm::lgamma(rest + 1.0) + k * log_share + rest * log_rest)
    };
    // of so many values below the quantile: the chance of at most k of them
    let (mut low, mut high, mut cumulated) = (None, None, 0.0);
    for (k, value) in ascending.iter().enumerate() {
        cumulated += probability(k);
        if cumulated <= tail {
            low = Some(*value);
        }
        if high.is_none() && cumulated >= 1.0 - tail {
            high = Some(*value);
        }
    }
    (low, high)
}

/// Ranks from 1, equal values having their mean rank.
#[must_use]
pub(crate) fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut from = 0;
    while from < order.len() {
        let same = order[from..].iter().take_while(|i| values[**i] == values[order[from]]).count().max(1);
        let rank = from as f64 + 0.5 * (same as f64 + 1.0);
        order[from..from + same].iter().for_each(|i| ranks[*i] = rank);
        from += same;
    }
    ranks
}

/// Correlation of two series; NaN if one is constant.
#[must_use]
pub(crate) fn correlation(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len().min(y.len()) as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let (mut xy, mut xx, mut yy) = (0.0, 0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        xy += (x - mx) * (y - my);
        xx += (x - mx) * (x - mx);
        yy += (y - my) * (y - my);
    }
    xy / (xx * yy).sqrt()
}

/// Interval of a correlation of `n` pairs by Fisher's transformation.
#[must_use]
pub(crate) fn correlation_interval(r: f64, n: usize, confidence: f64) -> (f64, f64) {
    if n < 4 || r.is_nan() {
        return (f64::NAN, f64::NAN);
    }
    let half = inverse_normal(0.5 + 0.5 * confidence) / (n as f64 - 3.0).sqrt();
    let z = libm::atanh(r.clamp(-1.0 + 1e-15, 1.0 - 1e-15));
    (libm::tanh(z - half), libm::tanh(z + half))
}

/// Coefficients of the least-squares fit of `y` by the rows of `a`; none if the rows do not tell them.
#[must_use]
pub(crate) fn least_squares(a: &[Vec<f64>], y: &[f64]) -> Option<Vec<f64>> {
    let n = a.first()?.len();
    let mut normal = vec![vec![0.0; n + 1]; n];
    for (row, y) in a.iter().zip(y) {
        for i in 0..n {
            (0..n).for_each(|j| normal[i][j] += row[i] * row[j]);
            normal[i][n] += row[i] * y;
        }
    }
    for i in 0..n {
        let pivot = (i..n).max_by(|p, q| normal[*p][i].abs().total_cmp(&normal[*q][i].abs()))?;
        normal.swap(i, pivot);
        if normal[i][i].abs() < 1e-12 * a.len() as f64 {
            return None;
        }
        for p in 0..n {
            if p != i {
                let factor = normal[p][i] / normal[i][i];
                (i..=n).for_each(|j| normal[p][j] -= factor * normal[i][j]);
            }
        }
    }
    Some((0..n).map(|i| normal[i][n] / normal[i][i]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_bounds_are_those_of_the_literature() {
        // Newcombe 1998, table I: 81 of 263 and 0 of 20
        let (low, high) = wilson(81, 263, 0.95);
        assert!((low - 0.2553).abs() < 5e-5 && (high - 0.3662).abs() < 5e-5, "{low} {high}");
        let (low, high) = wilson(0, 20, 0.95);
        assert!(low == 0.0 && (high - 0.1611).abs() < 5e-5, "{high}");
    }

    #[test]
    fn student_quantiles_are_those_of_tables() {
        for (freedom, expected) in [(1.0, 12.706), (2.0, 4.303), (5.0, 2.571), (10.0, 2.228), (30.0, 2.042)] {
            let found = student_quantile(0.975, freedom);
            assert!((found / expected - 1.0).abs() < 3e-4, "{freedom}: {found}");
        }
        for (freedom, expected) in [
            (3.0, [3.182_446_305, 5.840_909_310, 12.923_978_637]),
            (4.0, [2.776_445_105, 4.604_094_871, 8.610_301_581]),
        ] {
            for (confidence, expected) in [0.95, 0.99, 0.999].into_iter().zip(expected) {
                let found = student_quantile(0.5 + 0.5 * confidence, freedom);
                assert!((found / expected - 1.0).abs() < 1e-8, "{freedom}, {confidence}: {found}");
            }
        }
        assert!((student_quantile(0.025, 3.0) + 3.182_446_305).abs() < 1e-8);
        // both sides of the change to the expansion alone
        assert!((student_quantile(0.975, 9_999.0) / student_quantile(0.975, 10_001.0) - 1.0).abs() < 1e-7);
    }

    #[test]
    fn intervals_of_quantiles_have_binomial_ranks() {
        let values: Vec<f64> = (1..=20).map(f64::from).collect();
        // the sixth and the fifteenth of twenty hold the median with 95.9 %
        assert_eq!(quantile_interval(&values, 0.5, 0.95), (Some(6.0), Some(15.0)));
        // 0.95^20 = 0.36: no value of twenty is above the 95 % quantile with that confidence
        assert_eq!(quantile_interval(&values, 0.95, 0.95).1, None);
        assert_eq!(quantile_interval(&values[..5], 0.5, 0.95), (None, None));
        assert_eq!(quantile_interval(&[], 0.5, 0.95), (None, None));
    }

    #[test]
    fn moments_of_a_stream_are_those_of_the_list() {
        let values = [1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0];
        let mut moments = Moments::default();
        values.iter().for_each(|x| moments.add(*x));
        assert_eq!((moments.mean, moments.std()), (1e9 + 10.0, 30.0_f64.sqrt()));
    }

    #[test]
    fn equal_values_share_their_rank() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 0.0]), [3.5, 2.0, 3.5, 1.0]);
    }

    #[test]
    fn a_plane_is_found_by_least_squares() {
        let rows: Vec<Vec<f64>> = (0..9).map(|k| vec![1.0, f64::from(k % 3), f64::from(k / 3)]).collect();
        let y: Vec<f64> = rows.iter().map(|r| 2.0 - r[1] + 0.5 * r[2]).collect();
        let found = least_squares(&rows, &y).unwrap();
        assert!(found.iter().zip([2.0, -1.0, 0.5]).all(|(a, b)| (a - b).abs() < 1e-12));
        let flat: Vec<Vec<f64>> = (0..9).map(|k| vec![1.0, f64::from(k), f64::from(2 * k)]).collect();
        assert_eq!(least_squares(&flat, &y), None);
    }
}
