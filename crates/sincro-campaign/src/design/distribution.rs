//! Distributions as their inverse distribution functions: a number of (0, 1) in, a value out.

use std::sync::Arc;

use sincro_math::elementary::{exp, ln};

/// Distribution of a parameter over the runs of a campaign, in the parameter's unit; a key of a `[[parameter]]` of the
/// plan each.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Uniform between two bounds.
    Uniform {
        /// Lower bound.
        from: f64,
        /// Upper bound.
        to: f64,
    },
    /// Uniform in the logarithm between two positive bounds.
    LogUniform {
        /// Lower bound.
        from: f64,
        /// Upper bound.
        to: f64,
    },
    /// Normal, truncated at two bounds, which may be infinite.
    Normal {
        /// Mean before the truncation.
        mean: f64,
        /// Standard deviation before the truncation, positive.
        std: f64,
        /// Lower bound; −∞ if there is none.
        min: f64,
        /// Upper bound; ∞ if there is none.
        max: f64,
    },
    /// Log-normal: the logarithm is normally distributed.
    LogNormal {
        /// Median, positive.
        median: f64,
        /// Standard deviation of the natural logarithm, positive (dimensionless).
        sigma: f64,
    },
    /// Empirical: the values of a table's column, each as likely as the others.
    Table {
        /// Index of the file among those that the plan names, from 0: parameters of the same file take their values
        /// from the same row.
        file: usize,
        /// Values of the column in the order of the rows, at least one.
        values: Arc<[f64]>,
    },
    /// Values that are taken in turn, in this order, at least one: a factor of a full-factorial grid.
    Grid(Arc<[f64]>),
}

impl Distribution {
    /// Returns the quantile of the probability `u` in (0, 1), in the parameter's unit: the inverse distribution
    /// function. Of a table or grid, the value of the interval of `u` among as many equal ones as there are values.
    #[must_use]
    pub fn quantile(&self, u: f64) -> f64 {
        match self {
            Self::Uniform { from, to } => from + u * (to - from),
            Self::LogUniform { from, to } => exp(ln(*from).0 + u * (ln(*to).0 - ln(*from).0)).0,
            Self::Normal { mean, std, min, max } => {
                let (low, high) = (normal_cdf((min - mean) / std), normal_cdf((max - mean) / std));
                // rounding must not lead beyond a bound
                (mean + std * inverse_normal(low + u * (high - low))).clamp(*min, *max)
            }
            Self::LogNormal { median, sigma } => median * exp(sigma * inverse_normal(u)).0,
            Self::Table { values, .. } | Self::Grid(values) => values[index(u, values.len())],
        }
    }

    /// Returns true for [`Distribution::Grid`], whose values are taken in turn and not drawn.
    #[must_use]
    pub fn is_grid(&self) -> bool {
        matches!(self, Self::Grid(_))
    }

    /// Describes the distribution in English for a report, such as `normal 2 ± 0.1, at least 0`.
    #[must_use]
    pub fn words(&self) -> String {
        let short = |x: f64| sincro_figures::plot::number::short(x, 6);
        match self {
            Self::Uniform { from, to } => format!("uniform from {} to {}", short(*from), short(*to)),
            Self::LogUniform { from, to } => format!("log-uniform from {} to {}", short(*from), short(*to)),
            Self::Normal { mean, std, min, max } => {
                let bounds = match (min.is_finite(), max.is_finite()) {
                    (false, false) => String::new(),
                    (true, false) => format!(", at least {}", short(*min)),
                    (false, true) => format!(", at most {}", short(*max)),
                    (true, true) => format!(", between {} and {}", short(*min), short(*max)),
                };
                format!("normal {} ± {}{bounds}", short(*mean), short(*std))
            }
            Self::LogNormal { median, sigma } => {
                format!("log-normal, median {}, σ of the logarithm {}", short(*median), short(*sigma))
            }
            Self::Table { values, .. } => format!("from a table of {} rows", values.len()),
            Self::Grid(values) => match values.as_ref() {
                [first, .., last] => format!("{} values from {} to {}", values.len(), short(*first), short(*last)),
                values => values.iter().map(|x| short(*x)).collect::<Vec<_>>().join(", "),
            },
        }
    }
}

/// Index of the one of `n` equal intervals that `u` lies in.
#[must_use]
fn index(u: f64, n: usize) -> usize {
    ((u * n as f64) as usize).min(n - 1)
}

/// Standard normal distribution function.
#[must_use]
pub(crate) fn normal_cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

/// Standard normal density.
fn normal_density(x: f64) -> f64 {
    exp(-0.5 * x * x).0 / (2.0 * std::f64::consts::PI).sqrt()
}

/// Returns the quantile of the standard normal distribution for the probability `u` (dimensionless); −∞ from 0
/// downwards, ∞ from 1 upwards, NaN of NaN. Rational approximation (Abramowitz and Stegun 26.2.23), improved by
/// Halley's method.
#[must_use]
pub fn inverse_normal(u: f64) -> f64 {
    if u <= 0.0 || u >= 1.0 || u.is_nan() {
        return if u <= 0.0 {
            f64::NEG_INFINITY
        } else if u >= 1.0 {
            f64::INFINITY
        } else {
            f64::NAN
        };
    }
    if u == 0.5 {
        return 0.0;
    }
    let tail = u.min(1.0 - u);
    let t = (-2.0 * ln(tail).0).sqrt();
    let start = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    // the lower tail keeps its digits
    let mut x = -start;
    for _ in 0..4 {
        let step = (normal_cdf(x) - tail) / normal_density(x);
        x -= step / (1.0 + 0.5 * x * step);
    }
    if u < 0.5 { x } else { -x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_undoes_the_distribution_function() {
        for k in 1..2000 {
            let u = f64::from(k) / 2000.0;
            assert!((normal_cdf(inverse_normal(u)) - u).abs() < 1e-15, "{u}");
        }
        for k in 1..300 {
            let u = 10.0_f64.powi(-k);
            let back = normal_cdf(inverse_normal(u));
            assert!((back / u - 1.0).abs() < 1e-12, "{u} {back}");
        }
        // Φ⁻¹(0.975), the constant of every table
        assert!((inverse_normal(0.975) - 1.959963984540054).abs() < 1e-14);
        assert_eq!(inverse_normal(0.5), 0.0);
    }

    #[test]
    fn a_truncated_normal_stays_inside() {
        let cut = Distribution::Normal { mean: 0.0, std: 1.0, min: 2.0, max: 2.5 };
        let values: Vec<f64> = (0..1000).map(|k| cut.quantile((f64::from(k) + 0.5) / 1000.0)).collect();
        assert!(values.iter().all(|x| (2.0..=2.5).contains(x)) && values.is_sorted());
    }

    #[test]
    fn log_uniform_has_its_median_at_the_geometric_mean() {
        let x = Distribution::LogUniform { from: 0.1, to: 10.0 }.quantile(0.5);
        assert!((x - 1.0).abs() < 1e-15);
    }
}
