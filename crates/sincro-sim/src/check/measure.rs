//! One number of a series: its peak, its mean, its integral.
//!
//! A NaN among the values is the result. Means and integrals over time follow the trapezoidal rule, that is, they take
//! the series as straight between the rows. The integral of mean values of a step, of which `motor_torque` is, takes
//! each for the interval that ends at its row, Σ x_k·(t_k − t_{k−1}), which is exact where every step is recorded.
//!
//! A step response leads from x_0, the first value, to the target x_1; h = x_1 − x_0 is the height of the step.
//! Crossing times are found between two rows on the straight line through them.
//!
//! | measure | |
//! |---|---|
//! | overshoot | the greatest (x − x_1)/h of a row, at least 0 |
//! | rise time | from the first crossing of x_0 + 0.1·h to the first of x_0 + 0.9·h |
//! | divergence | the first \|x\| that is greater than the target, which is the bound; the greatest if none is |
//! | settling time | from the first row to the instant after which \|x − x_1\| stays at most band·\|h\| |
//!
//! A level that is not reached, or a response that has not settled in the last row, gives an infinite time, which never
//! holds.

use sincro_scene::experiment::check::Measure;

/// A measure of a series, and the row it stands at if there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) value: f64,
    pub(super) row: Option<usize>,
}

/// Parameters of the measures of a step response, and of the integral.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepShape {
    /// Final value of the step; the last value if not given.
    pub(super) target: Option<f64>,
    /// Band of the settling time, relative to the step's height.
    pub(super) band: f64,
    /// True if the values are means over the steps that end at the rows.
    pub(super) has_step_means: bool,
}

/// The measure of a series of at least one value over its keys. `Measure::Error` is no number of one series and counts
/// as the final value.
pub(super) fn measure(measure: Measure, shape: &StepShape, keys: &[f64], values: &[f64]) -> Result<Measured, String> {
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
        Measure::Divergence => {
            let sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
            let bound = shape.target.unwrap_or(f64::INFINITY);
            let row = sizes.iter().position(|size| *size > bound).unwrap_or_else(|| greatest(&sizes));
            Ok(Measured { value: sizes[row], row: Some(row) })
        }
        Measure::TimeOfMin => Ok(Measured { value: key_of_row(least(values)), row: None }),
        Measure::TimeOfMax => Ok(Measured { value: key_of_row(greatest(values)), row: None }),
        Measure::Mean => over_time(mean(keys, values)),
        Measure::Rms => over_time(mean_square(keys, values, 0.0).sqrt()),
        Measure::Std => over_time(mean_square(keys, values, mean(keys, values)).sqrt()),
        Measure::Integral if shape.has_step_means => over_time(sum_of_steps(keys, values)),
        Measure::Integral => over_time(integral(keys, values)),
        Measure::Overshoot => {
            let shares = shares(shape, values)?;
            let row = greatest(&shares);
            Ok(Measured { value: nan_or_max(shares[row] - 1.0, 0.0), row: None })
        }
        Measure::RiseTime => Ok(Measured { value: rise_time(keys, &shares(shape, values)?), row: None }),
        Measure::SettlingTime => {
            Ok(Measured { value: settling_time(keys, &shares(shape, values)?, shape.band), row: None })
        }
    }
}

/// (x − x_0)/h: the way from the first value to the target as a share of the step's height.
fn shares(shape: &StepShape, values: &[f64]) -> Result<Vec<f64>, String> {
    let (first, last) = (values[0], shape.target.unwrap_or(values[values.len() - 1]));
    if first == last {
        return Err(format!("there is no step: the first row and the target are both {first}"));
    }
    Ok(values.iter().map(|x| (x - first) / (last - first)).collect())
}

fn nan_or_max(value: f64, least: f64) -> f64 {
    if value < least { least } else { value }
}

fn rise_time(keys: &[f64], shares: &[f64]) -> f64 {
    if shares.iter().any(|s| s.is_nan()) {
        return f64::NAN;
    }
    let first_crossing = |level: f64| {
        let row = shares.iter().position(|s| *s >= level)?;
        // the first share is 0, so that a row stands before the crossing
        Some(crossing(keys, shares, row - 1, level))
    };
    match (first_crossing(0.1), first_crossing(0.9)) {
        (Some(from), Some(to)) => to - from,
        _ => f64::INFINITY,
    }
}

fn settling_time(keys: &[f64], shares: &[f64], band: f64) -> f64 {
    if shares.iter().any(|s| s.is_nan()) {
        return f64::NAN;
    }
    match shares.iter().rposition(|s| (s - 1.0).abs() > band) {
        None => 0.0,
        Some(row) if row + 1 == shares.len() => f64::INFINITY,
        Some(row) => {
            let edge = if shares[row] > 1.0 { 1.0 + band } else { 1.0 - band };
            crossing(keys, shares, row, edge) - keys[0]
        }
    }
}

/// Key at which the line from a row to the next passes a level.
fn crossing(keys: &[f64], values: &[f64], row: usize, level: f64) -> f64 {
    let along = (level - values[row]) / (values[row + 1] - values[row]);
    keys[row] + along * (keys[row + 1] - keys[row])
}

/// Index of the greatest value: the first of equals, and the first NaN before any number.
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
    integral(keys, values) / (keys[keys.len() - 1] - keys[0])
}

/// Integral over the keys by the trapezoidal rule.
fn integral(keys: &[f64], values: &[f64]) -> f64 {
    let mut area = 0.0;
    for k in 1..keys.len() {
        area += 0.5 * (values[k - 1] + values[k]) * (keys[k] - keys[k - 1]);
    }
    area
}

/// Mean of (x − centre)² over the keys by the trapezoidal rule.
fn mean_square(keys: &[f64], values: &[f64], centre: f64) -> f64 {
    let squares: Vec<f64> = values.iter().map(|value| (value - centre) * (value - centre)).collect();
    mean(keys, &squares)
}

/// Σ x_k·(t_k − t_{k−1}) over the intervals between the rows; the first row has none and only begins one. Its value
/// enters nothing but for being a number.
fn sum_of_steps(keys: &[f64], values: &[f64]) -> f64 {
    if values[0].is_nan() {
        return f64::NAN;
    }
    (1..keys.len()).map(|k| values[k] * (keys[k] - keys[k - 1])).sum()
}

#[cfg(test)]
mod tests {
    use sincro_math::elementary;

    use super::*;

    /// x = 1, 3, −5, 2 at t = 0, 1, 2, 4 s.
    const T: [f64; 4] = [0.0, 1.0, 2.0, 4.0];
    const X: [f64; 4] = [1.0, 3.0, -5.0, 2.0];

    const SHAPE: StepShape = StepShape { target: None, band: 0.02, has_step_means: false };

    fn measure(of: Measure, keys: &[f64], values: &[f64]) -> Result<Measured, String> {
        super::measure(of, &SHAPE, keys, values)
    }

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
    fn the_integral_of_step_means_takes_each_value_over_the_interval_before_it() {
        // trapezoids: 2 − 1 − 3; steps: 3·1 − 5·1 + 2·2
        assert_eq!(value(Measure::Integral), -2.0);
        let of_means = StepShape { has_step_means: true, ..SHAPE };
        assert_eq!(super::measure(Measure::Integral, &of_means, &T, &X).unwrap().value, 2.0);
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
        use Measure::{
            Integral, Max, MaxAbs, Mean, Min, Overshoot, RiseTime, Rms, SettlingTime, Std, TimeOfMax, TimeOfMin,
        };
        let all = [Mean, Min, Max, MaxAbs, Rms, Std, Integral, TimeOfMin, TimeOfMax, Overshoot, RiseTime, SettlingTime];
        for (place, of) in all.into_iter().enumerate() {
            let mut values = X;
            values[place % 3] = f64::NAN;
            assert!(measure(of, &T, &values).unwrap().value.is_nan(), "{of:?}");
        }
    }

    /// 1 − e^(−ζωt)·(cos ω_d t + ζω/ω_d·sin ω_d t) every millisecond for 20 s, from `from` to `to`.
    fn second_order(omega: f64, zeta: f64, from: f64, to: f64) -> (Vec<f64>, Vec<f64>) {
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        let keys: Vec<f64> = (0..=20_000).map(|k| f64::from(k) * 1e-3).collect();
        let share = |t: &f64| {
            let (sin, cos) = elementary::sin_cos(damped * t);
            let turn = cos + zeta * omega / damped * sin;
            from + (to - from) * (1.0 - elementary::exp(-zeta * omega * t).0 * turn)
        };
        let values = keys.iter().map(share).collect();
        (keys, values)
    }

    #[test]
    fn overshoot_of_a_second_order_step_is_its_closed_form() {
        for (zeta, from, to) in [(0.2, 0.0, 1.0), (0.5, 1.0, -3.0), (0.7, -2.0, -1.0)] {
            let (keys, values) = second_order(2.0, zeta, from, to);
            let shape = StepShape { target: Some(to), band: 0.02, ..SHAPE };
            let found = super::measure(Measure::Overshoot, &shape, &keys, &values).unwrap();
            let expected = elementary::exp(-zeta * std::f64::consts::PI / (1.0 - zeta * zeta).sqrt()).0;
            // the greatest row is at most half a millisecond from the peak: (ω·0.5 ms)²/2
            assert!((found.value - expected).abs() < 1e-6, "{zeta}: {} {expected}", found.value);
        }
    }

    #[test]
    fn rise_and_settling_time_of_a_first_order_step_are_its_closed_form() {
        let keys: Vec<f64> = (0..=2_000).map(|k| f64::from(k) * 0.01).collect();
        let values: Vec<f64> = keys.iter().map(|t| 5.0 - 3.0 * elementary::exp(-t / 0.8).0).collect();
        let shape = StepShape { target: Some(5.0), band: 0.05, ..SHAPE };
        let found = |of| super::measure(of, &shape, &keys, &values).unwrap().value;
        // straight lines of 10 ms on a curve of time constant 0.8 s: (0.01/0.8)²/8·0.8 s
        assert!((found(Measure::RiseTime) - 0.8 * elementary::ln(9.0).0).abs() < 2e-5);
        assert!((found(Measure::SettlingTime) - 0.8 * elementary::ln(20.0).0).abs() < 2e-5);
        assert_eq!(found(Measure::Overshoot), 0.0);
    }

    #[test]
    fn crossings_are_found_between_rows() {
        let (keys, values) = ([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 0.5, 1.2, 1.1, 1.0]);
        let of = |m| measure(m, &keys, &values).unwrap().value;
        assert!((of(Measure::Overshoot) - 0.2).abs() < 1e-15);
        // 0.1 at 0.2 s; 0.9 at 1 + 0.4/0.7 s; 1.02 on the way down at 3.8 s
        assert!((of(Measure::RiseTime) - (1.0 + 0.4 / 0.7 - 0.2)).abs() < 1e-15);
        assert!((of(Measure::SettlingTime) - 3.8).abs() < 1e-14);
    }

    #[test]
    fn what_is_never_reached_takes_for_ever() {
        let keys = [0.0, 1.0, 2.0];
        let shape = StepShape { target: Some(2.0), band: 0.02, ..SHAPE };
        let of = |m| super::measure(m, &shape, &keys, &[0.0, 0.5, 1.0]).unwrap().value;
        assert_eq!((of(Measure::RiseTime), of(Measure::SettlingTime)), (f64::INFINITY, f64::INFINITY));
        assert_eq!(of(Measure::Overshoot), 0.0);
    }

    #[test]
    fn a_flat_response_is_no_step() {
        let message = measure(Measure::Overshoot, &T[..3], &[1.0, 7.0, 1.0]).unwrap_err();
        assert_eq!(message, "there is no step: the first row and the target are both 1");
    }

    #[test]
    fn one_row_has_no_mean() {
        let message = measure(Measure::Mean, &T[..1], &X[..1]).unwrap_err();
        assert_eq!(message, "the measure `mean` needs two rows, there is one");
        assert_eq!(measure(Measure::Max, &T[..1], &X[..1]).map(|m| m.value), Ok(1.0));
    }
}
