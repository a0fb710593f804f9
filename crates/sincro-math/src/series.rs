//! Sampled series: numbers given at instants.

/// Reversal below this share of the range of a series counts as noise.
const NOISE: f64 = 0.01;

/// Highest frequency `[Hz]` of a sampled series up to time `until` `[s]`: half the inverse of the shortest time between
/// two turning points. For choosing a sample time or step size.
///
/// `times` are the ascending sample times `[s]`; `value(k)` is the sample at `times[k]`, in any unit. Reversals by less
/// than or equal to a hundredth of the range count as noise; with fewer than two turning points the result is 0.
#[must_use]
pub fn highest_frequency(times: &[f64], value: impl Fn(usize) -> f64, until: f64) -> f64 {
    let n = times.partition_point(|t| *t <= until);
    let (low, high) = (0..n).map(&value).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let noise = NOISE * (high - low);
    if noise.is_nan() || noise <= 0.0 {
        return 0.0;
    }
    // the extreme so far in the present direction, and the last turning point
    let (mut extreme, mut rises, mut turned) = (0, None, None);
    let mut shortest = f64::INFINITY;
    for k in 1..n {
        let change = value(k) - value(extreme);
        match rises {
            None if change.abs() > noise => (extreme, rises) = (k, Some(change > 0.0)),
            Some(up) if change == 0.0 || (change > 0.0) == up => extreme = k,
            Some(up) if change.abs() > noise => {
                if let Some(last) = turned.replace(times[extreme]) {
                    shortest = shortest.min(times[extreme] - last);
                }
                (extreme, rises) = (k, Some(!up));
            }
            _ => {}
        }
    }
    0.5 / shortest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::sin_cos;

    #[test]
    fn a_sine_has_its_frequency_however_finely_it_is_sampled() {
        for n in [10, 100, 1000] {
            let times: Vec<f64> = (0..3 * n).map(|k| f64::from(k) / (2.0 * f64::from(n))).collect();
            let found = highest_frequency(&times, |k| 5.0 + sin_cos(core::f64::consts::TAU * 2.0 * times[k]).0, 9.0);
            assert!((found - 2.0).abs() < 0.5, "{n}: {found}");
        }
    }

    #[test]
    fn steps_ramps_and_noise_have_no_frequency() {
        let times = [0.0, 1.0, 1.1, 2.0, 3.0];
        assert_eq!(highest_frequency(&times, |_| 7.0, 9.0), 0.0);
        assert_eq!(highest_frequency(&times, |k| times[k], 9.0), 0.0);
        assert_eq!(highest_frequency(&times, |k| [0.0, 1.0, 0.999, 1.0, 2.0][k], 9.0), 0.0);
        assert_eq!(highest_frequency(&times, |k| [0.0, 1.0, 0.0, 1.0, 1.0][k], 9.0), 0.5 / (1.1 - 1.0));
        assert_eq!(highest_frequency(&times, |k| [0.0, 1.0, 0.0, 1.0, 1.0][k], 1.05), 0.0);
    }

    #[test]
    fn noise_is_a_share_of_the_range_about_whatever_mean() {
        let times = [0.0, 1.0, 1.1, 1.2, 2.0, 3.0];
        for (mean, scale) in [(0.0, 100.0), (7.0, 100.0), (-3.0, 1e-3)] {
            let value = |k: usize| mean + scale * [-0.5, 0.5, 0.495, 0.5, -0.5, 0.5][k];
            assert_eq!(highest_frequency(&times, value, 9.0), 0.5 / (2.0 - 1.2), "{mean} {scale}");
        }
    }
}
