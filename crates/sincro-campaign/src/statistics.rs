//! Statistics of results: intervals, ranks, moments that need no memory.

use crate::design::inverse_normal;

/// Mean, spread and extremes of numbers that come one by one (Welford 1962).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Number of values.
    pub n: u64,
    /// Mean.
    pub mean: f64,
    /// Sum of squares about the mean.
    squares: f64,
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self { n: 0, mean: 0.0, squares: 0.0, min: f64::INFINITY, max: f64::NEG_INFINITY }
    }
}

impl Moments {
    /// Adds a finite value.
    pub fn add(&mut self, x: f64) {
        self.n += 1;
        let before = x - self.mean;
        self.mean += before / self.n as f64;
        self.squares += before * (x - self.mean);
        self.min = self.min.min(x);
        self.max = self.max.max(x);
    }

    /// Standard deviation, with n − 1; 0 of fewer than two values.
    #[must_use]
    pub fn std(&self) -> f64 {
        if self.n < 2 { 0.0 } else { (self.squares / (self.n - 1) as f64).sqrt() }
    }

    /// Half width of the confidence interval of the mean, by Student's distribution.
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
pub fn wilson(successes: u64, n: u64, confidence: f64) -> (f64, f64) {
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

/// Quantile of Student's distribution with `freedom` degrees: exact for 1 and 2, else the expansion of Hill (1970) in
/// the normal quantile, to better than 1e-3 relative from 3 on.
#[must_use]
pub fn student_quantile(u: f64, freedom: f64) -> f64 {
    if freedom < 1.5 {
        return sincro_math::elementary::tan(std::f64::consts::PI * (u - 0.5)).0;
    }
    if freedom < 2.5 {
        return (2.0 * u - 1.0) / (2.0 * u * (1.0 - u)).sqrt();
    }
    let (z, v) = (inverse_normal(u), freedom);
    let z2 = z * z;
    z + z * (z2 + 1.0) / (4.0 * v)
        + z * (5.0 * z2 * z2 + 16.0 * z2 + 3.0) / (96.0 * v * v)
        + z * (3.0 * z2 * z2 * z2 + 19.0 * z2 * z2 + 17.0 * z2 - 15.0) / (384.0 * v * v * v)
}

/// Quantile of ascending values, between neighbours on a straight line.
#[must_use]
pub fn quantile(ascending: &[f64], share: f64) -> f64 {
    let Some(last) = ascending.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let below = (place as usize).min(last);
    let above = (below + 1).min(last);
    ascending[below] + (place - below as f64) * (ascending[above] - ascending[below])
}

/// Interval of a quantile by order statistics, without any assumption on the distribution.
#[must_use]
pub fn quantile_interval(ascending: &[f64], share: f64, confidence: f64) -> (f64, f64) {
    let n = ascending.len() as f64;
    if ascending.is_empty() {
        return (f64::NAN, f64::NAN);
    }
    let half = inverse_normal(0.5 + 0.5 * confidence) * (n * share * (1.0 - share)).sqrt();
    let at = |rank: f64| ascending[(rank.max(0.0) as usize).min(ascending.len() - 1)];
    (at((n * share - half).floor() - 1.0), at((n * share + half).ceil()))
}

/// Ranks from 1, equal values having their mean rank.
#[must_use]
pub fn ranks(values: &[f64]) -> Vec<f64> {
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
pub fn correlation(x: &[f64], y: &[f64]) -> f64 {
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
pub fn correlation_interval(r: f64, n: usize, confidence: f64) -> (f64, f64) {
    if n < 4 || r.is_nan() {
        return (f64::NAN, f64::NAN);
    }
    let half = inverse_normal(0.5 + 0.5 * confidence) / (n as f64 - 3.0).sqrt();
    let z = libm::atanh(r.clamp(-1.0 + 1e-15, 1.0 - 1e-15));
    (libm::tanh(z - half), libm::tanh(z + half))
}

/// Coefficients of the least-squares fit of `y` by the rows of `a`; none if the rows do not tell them.
#[must_use]
pub fn least_squares(a: &[Vec<f64>], y: &[f64]) -> Option<Vec<f64>> {
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
            assert!((found / expected - 1.0).abs() < 2e-3, "{freedom}: {found}");
        }
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
