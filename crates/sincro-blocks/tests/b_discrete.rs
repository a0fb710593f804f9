//! Discrete blocks against recursions written out here: equal to the bit.

mod b_common;

use b_common::{Random, answer, block, list, rows};
use sincro_blocks::reader::Value;

const STEP: f64 = 0.01;

#[test]
fn a_discrete_transfer_function_is_its_recursion_to_the_bit() {
    // (0.5z + 0.25)/(z² − 0.5z + 0.75), direct form II transposed
    let u = Random(11).list(50);
    let parameters = [("numerator", list(&[0.5, 0.25])), ("denominator", list(&[1.0, -0.5, 0.75]))];
    let y = answer(&u, STEP, block("discrete-transfer-function", &parameters));
    let (mut w1, mut w2) = (0.0, 0.0);
    for k in 0..50 {
        let expected: f64 = w1;
        assert_eq!(y[k].to_bits(), expected.to_bits());
        (w1, w2) = ((0.5 * u[k] + 0.5 * expected) + w2, 0.25 * u[k] - 0.75 * expected);
    }
}

#[test]
fn a_quotient_by_z_is_a_unit_delay() {
    let u = Random(12).list(20);
    let parameters = [("numerator", 1.0.into()), ("denominator", list(&[1.0, 0.0]))];
    let delayed = block("discrete-transfer-function", &parameters);
    assert!(!delayed.feeds_through(0) && delayed.label() == "1/z");
    let (a, b) = (answer(&u, STEP, delayed), answer(&u, STEP, block("unit-delay", &[])));
    assert_eq!(a, b);
}

#[test]
fn a_discrete_state_space_is_its_recursion_to_the_bit() {
    let u = Random(13).list(50);
    let parameters = [
        ("a", rows(&[&[0.5, 0.25], &[-0.125, 0.75]])),
        ("b", rows(&[&[1.0], &[0.5]])),
        ("c", rows(&[&[2.0, -1.0]])),
        ("d", 0.5.into()),
        ("initial", list(&[1.0, 2.0])),
    ];
    let y = answer(&u, STEP, block("discrete-state-space", &parameters));
    let mut x = [1.0, 2.0];
    for k in 0..50 {
        assert_eq!(y[k], 2.0 * x[0] - x[1] + 0.5 * u[k]);
        x = [0.5 * x[0] + 0.25 * x[1] + u[k], -0.125 * x[0] + 0.75 * x[1] + 0.5 * u[k]];
    }
}

/// ki = 4, Ts = 1/64: all products are exact, so that sums are too.
fn integral(method: &str, u: &[f64]) -> Vec<f64> {
    answer(u, 1.0 / 64.0, block("discrete-pid", &[("ki", 4.0.into()), ("method", method.into())]))
}

#[test]
fn the_three_integrals_differ_by_what_they_take_of_the_present() {
    let u = [1.0, 2.0, 4.0, 8.0];
    assert_eq!(integral("forward-euler", &u), [0.0, 1.0, 3.0, 7.0].map(|x| x / 16.0));
    assert_eq!(integral("backward-euler", &u), [1.0, 3.0, 7.0, 15.0].map(|x| x / 16.0));
    assert_eq!(integral("trapezoidal", &u), [0.5, 2.0, 5.0, 11.0].map(|x| x / 16.0));
}

#[test]
fn a_discrete_pid_is_its_difference_equations() {
    let u = Random(14).list(80);
    let (kp, ki, kd, tf) = (2.0, 3.0, 0.5, 0.02);
    let parameters = [
        ("kp", Value::from(kp)),
        ("ki", ki.into()),
        ("kd", kd.into()),
        ("filter_time_constant", tf.into()),
        ("initial", 0.1.into()),
    ];
    let y = answer(&u, STEP, block("discrete-pid", &parameters));
    let (mut s, mut f) = (0.1, 0.0);
    for k in 0..80 {
        let expected = kp * u[k] + s + kd * (u[k] - f) / (tf + STEP);
        // the block rounds in another order
        assert!((y[k] - expected).abs() < 1e-12, "{k}");
        s += STEP * ki * u[k];
        f = (tf * f + STEP * u[k]) / (tf + STEP);
    }
}

#[test]
fn a_saturated_discrete_pid_does_not_wind_up() {
    // pushed against its limit for a second, then pulled: it leaves the limit at once
    let mut u = vec![1.0; 100];
    u.extend([-0.5; 100]);
    let steps_at_limit = |anti_windup: &str| {
        let parameters =
            [("kp", Value::from(1.0)), ("ki", 5.0.into()), ("upper", 1.0.into()), ("anti_windup", anti_windup.into())];
        let y = answer(&u, STEP, block("discrete-pid", &parameters));
        assert!(y.iter().all(|y| *y <= 1.0));
        y[100..].iter().filter(|y| **y == 1.0).count()
    };
    assert_eq!((steps_at_limit("back-calculation"), steps_at_limit("clamping")), (0, 0));
    assert!(steps_at_limit("none") > 50);
}

#[test]
fn an_output_lag_is_a_backward_euler_step() {
    let parameters = [("kp", Value::from(2.0)), ("output_time_constant", 0.03.into())];
    let y = answer(&[1.0; 10], STEP, block("discrete-pid", &parameters));
    let mut expected = 0.0;
    for y in y {
        expected = (0.03 * expected + STEP * 2.0) / 0.04;
        assert!((y - expected).abs() < 1e-15);
    }
}
