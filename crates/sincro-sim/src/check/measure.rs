//! One number of a series: its peak, its mean, its integral.
//!
//! A NaN among the values is the result. Means over time follow the trapezoidal rule, that is, they take the series as straight
//! between the rows. The integral does not: a row's value stands for the interval that ends at the row, Σ x_k·(t_k − t_{k−1}),
//! which is exact for mean values of a step such as `motor_torque`.

use crate::experiment::check::Measure;

/// A measure of a series, and the row it stands at if there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) value: f64,
    pub(super) row: Option<usize>,
}

/// The measure of a series of at least one value over its keys. `Measure::Error` is no number of one series and counts as the
/// final value.
pub(super) fn measure(measure: Measure, keys: &[f64], values: &[f64]) -> Result<Measured, String> {
    let of_row = |row: usize| Ok(Measured { value: values[row], row: Some(row) });
    let key_of_row = |row: usize| if values[row].is_nan() { f64::NAN } else { keys[row] };
    let over_time = |value: f64| {
        let enough = keys.len() >= 2;
        let message = || format!("the measure `{}` needs two rows, there is one", measure.word());
        if enough { Ok(Measured { value, row: None }) } else { Err(message()) }
    };
    match measure {
        Measure::Error | Measure::Final => of_row(values.len() - 1),
        Measure::Min => of_row(least(values)),
        Measure::Max => of_row(greatest(values)),
        Measure::MaxAbs => {
            let sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
            let row = greatest(&sizes);
            Ok(Measured { value: sizes[row], row: Some(row) })
        }
        Measure::TimeOfMin => Ok(Measured { value: key_of_row(least(values)), row: None }),
        Measure::TimeOfMax => Ok(Measured { value: key_of_row(greatest(values)), row: None }),
        Measure::Mean => over_time(mean(keys, values)),
        Measure::Rms => over_time(mean_square(keys, values, 0.0).sqrt()),
        Measure::Std => over_time(mean_square(keys, values, mean(keys, values)).sqrt()),
        Measure::Integral => over_time(integral(keys, values)),
    }
}

/// Where the greatest value stands: the first of equals, and the first NaN before any number.
pub(super) fn greatest(values: &[f64]) -> usize {
    first_best(values, |value, best| value > best)
}

fn least(values: &[f64]) -> usize {
    first_best(values, |value, best| value < best)
}

fn first_best(values: &[f64], better: impl Fn(f64, f64) -> bool) -> usize {
    let mut best = 0;
    for (row, value) in values.iter().enumerate() {
        if value.is_nan() {
            return row;
        }
        if better(*value, values[best]) {
            best = row;
        }
    }
    best
}

/// Mean over the keys by the trapezoidal rule.
fn mean(keys: &[f64], values: &[f64]) -> f64 {
    let mut area = 0.0;
    for k in 1..keys.len() {
        area += 0.5 * (values[k - 1] + values[k]) * (keys[k] - keys[k - 1]);
    }
    area / (keys[keys.len() - 1] - keys[0])
}

/// Mean of (x − centre)² over the keys by the trapezoidal rule.
fn mean_square(keys: &[f64], values: &[f64], centre: f64) -> f64 {
    let squares: Vec<f64> = values.iter().map(|value| (value - centre) * (value - centre)).collect();
    mean(keys, &squares)
}

/// Σ x_k·(t_k − t_{k−1}) over the intervals between the rows; the first row has none and only begins one. Its value enters
/// nothing but for being a number.
fn integral(keys: &[f64], values: &[f64]) -> f64 {
    if values[0].is_nan() {
        return f64::NAN;
    }
    (1..keys.len()).map(|k| values[k] * (keys[k] - keys[k - 1])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = 1, 3, −5, 2 at t = 0, 1, 2, 4 s.
    const T: [f64; 4] = [0.0, 1.0, 2.0, 4.0];
    const X: [f64; 4] = [1.0, 3.0, -5.0, 2.0];

    fn value(of: Measure) -> f64 {
        measure(of, &T, &X).unwrap().value
    }

    #[test]
    fn measures_of_single_rows() {
        assert_eq!(measure(Measure::Final, &T, &X), Ok(Measured { value: 2.0, row: Some(3) }));
        assert_eq!(measure(Measure::Min, &T, &X), Ok(Measured { value: -5.0, row: Some(2) }));
        assert_eq!(measure(Measure::Max, &T, &X), Ok(Measured { value: 3.0, row: Some(1) }));
        assert_eq!(measure(Measure::MaxAbs, &T, &X), Ok(Measured { value: 5.0, row: Some(2) }));
        assert_eq!(measure(Measure::TimeOfMin, &T, &X), Ok(Measured { value: 2.0, row: None }));
        assert_eq!(measure(Measure::TimeOfMax, &T, &X), Ok(Measured { value: 1.0, row: None }));
    }

    #[test]
    fn the_integral_takes_each_value_over_the_interval_before_it() {
        // 3·1 − 5·1 + 2·2
        assert_eq!(value(Measure::Integral), 2.0);
    }

    #[test]
    fn means_follow_the_trapezoidal_rule() {
        // (1+3)/2·1 + (3−5)/2·1 + (−5+2)/2·2 = 2 − 1 − 3 = −2, over 4 s
        assert_eq!(value(Measure::Mean), -0.5);
        // squares 1, 9, 25, 4: 5 + 17 + 29 = 51, over 4 s
        assert_eq!(value(Measure::Rms), (51.0_f64 / 4.0).sqrt());
        // (x + 0.5)²: 2.25, 12.25, 20.25, 6.25: 7.25 + 16.25 + 26.5 = 50, over 4 s
        assert_eq!(value(Measure::Std), 12.5_f64.sqrt());
    }

    #[test]
    fn the_first_of_equals_counts() {
        assert_eq!(greatest(&[1.0, 7.0, 7.0]), 1);
        assert_eq!(least(&[0.0, -0.0, 0.0]), 0);
    }

    #[test]
    fn a_nan_is_the_result_of_every_measure() {
        use Measure::{Integral, Max, MaxAbs, Mean, Min, Rms, Std, TimeOfMax, TimeOfMin};
        for (place, of) in [Mean, Min, Max, MaxAbs, Rms, Std, Integral, TimeOfMin, TimeOfMax].into_iter().enumerate() {
            let mut values = X;
            values[place % 3] = f64::NAN;
            assert!(measure(of, &T, &values).unwrap().value.is_nan(), "{of:?}");
        }
    }

    #[test]
    fn one_row_has_no_mean() {
        let message = measure(Measure::Mean, &T[..1], &X[..1]).unwrap_err();
        assert_eq!(message, "the measure `mean` needs two rows, there is one");
        assert_eq!(measure(Measure::Max, &T[..1], &X[..1]).map(|m| m.value), Ok(1.0));
    }
}
