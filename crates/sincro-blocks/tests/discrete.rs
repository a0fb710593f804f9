//! Discrete blocks against recursions written out here: equal to the bit.

mod common;

use common::{Random, Samples, add, answer, block, driven, faults, list, rows};
use sincro_blocks::diagram::{Content, Diagram};
use sincro_blocks::instance::DynBlock;
use sincro_blocks::reader::Value;
use sincro_blocks::simulator::Simulator;

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
    assert!(!delayed.has_direct_feedthrough(0) && delayed.label() == "1/z");
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
    // the integral term is 0.5 throughout, and the lag starts there
    let parameters = [("kp", Value::from(2.0)), ("output_time_constant", 0.03.into()), ("initial", 0.5.into())];
    let y = answer(&[1.0; 10], STEP, block("discrete-pid", &parameters));
    let mut expected = 0.5;
    for y in y {
        expected = (0.03 * expected + STEP * 2.5) / 0.04;
        assert!((y - expected).abs() < 1e-15);
    }
}

#[test]
fn a_delay_gives_back_every_sample_to_the_bit() {
    let u = Random(15).list(30);
    let y = answer(&u, STEP, block("delay", &[("samples", 4.0.into()), ("initial", 9.0.into())]));
    assert!((0..30).all(|k| y[k] == if k < 4 { 9.0 } else { u[k - 4] }));
    let one = block("delay", &[("samples", 1.0.into())]);
    assert_eq!(answer(&u, STEP, one), answer(&u, STEP, block("unit-delay", &[])));
    assert!(faults("delay", &[("samples", (-1.0).into())]).contains("it must be a whole number from 0 on"));
    assert_eq!(answer(&[1.0, 2.0, 3.0], STEP, block("delay", &[("samples", 0.0.into())])), [1.0, 2.0, 3.0]);
    assert_eq!(block("delay", &[("samples", 12.0.into())]).label(), "z⁻¹²");
}

/// A ramp of one a tick, through a block with a sample time of three ticks.
fn every_third(block: Box<dyn DynBlock>) -> Vec<f64> {
    let mut d = Diagram::new();
    d.block("u", Samples { values: (0..20).map(f64::from).collect() });
    d.add("y", Content::Block(block), Some(3.0 * STEP));
    d.wire("u", "y");
    Simulator::new(&d, STEP).unwrap().record("y", 10)
}

#[test]
fn holds_and_transitions_between_sample_times_are_at_once_or_a_sample_late() {
    let held = [0.0, 0.0, 0.0, 3.0, 3.0, 3.0, 6.0, 6.0, 6.0, 9.0, 9.0];
    let late = [-1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 3.0, 3.0, 3.0, 6.0, 6.0];
    assert_eq!(every_third(block("zero-order-hold", &[])), held);
    assert_eq!(every_third(block("rate-transition", &[])), held);
    let delayed = block("rate-transition", &[("delayed", true.into()), ("initial", (-1.0).into())]);
    assert!(!delayed.has_direct_feedthrough(0));
    assert_eq!(every_third(delayed), late);
    let two = block("delay", &[("samples", 2.0.into())]);
    assert_eq!(every_third(two), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 3.0]);
}

#[test]
fn discrete_integrators_are_their_rules_and_keep_their_limits() {
    // Ts = 1/8 and gain 8: plain sums
    let of = |method: &str, extra: &[(&str, Value)]| {
        let mut parameters = vec![("method", Value::from(method)), ("gain", 8.0.into())];
        parameters.extend_from_slice(extra);
        answer(&[1.0, 2.0, 4.0, 8.0, -16.0, 0.0], 0.125, block("discrete-integrator", &parameters))
    };
    assert_eq!(of("forward-euler", &[]), [0.0, 1.0, 3.0, 7.0, 15.0, -1.0]);
    assert_eq!(of("backward-euler", &[]), [1.0, 3.0, 7.0, 15.0, -1.0, -1.0]);
    assert_eq!(of("trapezoidal", &[]), [0.5, 2.0, 5.0, 11.0, 7.0, -1.0]);
    let limited = [("upper", Value::from(6.0)), ("initial", 0.5.into())];
    assert_eq!(of("forward-euler", &limited), [0.5, 1.5, 3.5, 6.0, 6.0, -10.0]);
    assert_eq!(of("backward-euler", &limited), [1.5, 3.5, 6.0, 6.0, -10.0, -10.0]);
}

#[test]
fn a_discrete_integrator_starts_again_after_a_reset() {
    let mut d = Diagram::new();
    d.block("u", Samples { values: vec![1.0] }).block("reset", Samples { values: vec![0.0, 0.0, 1.0, 0.0] });
    let parameters = [("gain", Value::from(8.0)), ("initial", 10.0.into()), ("reset", true.into())];
    add(&mut d, "y", block("discrete-integrator", &parameters));
    d.wire("u", "y.u").wire("reset", "y.reset");
    assert_eq!(Simulator::new(&d, 0.125).unwrap().record("y", 5), [10.0, 11.0, 12.0, 10.0, 11.0, 12.0]);
}

#[test]
fn a_discrete_derivative_undoes_the_integral() {
    let u = [3.0, 5.0, 4.0];
    let parameters = [("initial_input", Value::from(1.0))];
    assert_eq!(answer(&u, 0.125, block("discrete-derivative", &parameters)), [16.0, 16.0, -8.0]);
}

#[test]
fn a_filter_without_recursion_answers_an_impulse_with_its_weights() {
    let fir = block("fir-filter", &[("coefficients", list(&[0.5, 0.25, -1.0]))]);
    assert_eq!(answer(&[1.0, 0.0, 0.0, 0.0], STEP, fir), [0.5, 0.25, -1.0, 0.0]);
    let late = block("fir-filter", &[("coefficients", list(&[0.0, 2.0]))]);
    assert!(!late.has_direct_feedthrough(0));
    assert_eq!(answer(&[1.0, 3.0, 0.0], STEP, late), [0.0, 2.0, 6.0]);
}

#[test]
fn a_recursive_filter_is_matlabs_filter_and_its_sections_their_product() {
    // y[k] = (0.5 u[k] + u[k−1] + 0.5 y[k−1] − 0.25 y[k−2])/1
    let u = Random(16).list(40);
    let filter = block("iir-filter", &[("b", list(&[1.0, 2.0])), ("a", list(&[2.0, -1.0, 0.5]))]);
    let y = answer(&u, STEP, filter);
    for k in 2..40 {
        let expected = 0.5 * u[k] + u[k - 1] + 0.5 * y[k - 1] - 0.25 * y[k - 2];
        assert!((y[k] - expected).abs() < 1e-14);
    }
    // (1 + z⁻¹)/(1 − 0.5 z⁻¹) · (2 − z⁻²)/(1 + 0.25 z⁻²)
    let sections = rows(&[&[1.0, 1.0, 0.0, 1.0, -0.5, 0.0], &[2.0, 0.0, -1.0, 1.0, 0.0, 0.25]]);
    let cascade = answer(&u, STEP, block("iir-filter", &[("sections", sections)]));
    let b = list(&[2.0, 2.0, -1.0, -1.0]);
    let a = list(&[1.0, -0.5, 0.25, -0.125]);
    let whole = answer(&u, STEP, block("iir-filter", &[("b", b), ("a", a)]));
    assert!(cascade.iter().zip(&whole).all(|(a, b)| (a - b).abs() < 1e-13));
    assert!(faults("iir-filter", &[("a", list(&[0.0, 1.0]))]).contains("first coefficient of `a` is 0"));
    assert!(faults("iir-filter", &[("sections", list(&[1.0, 2.0]))]).contains("has 2 numbers"));
}

#[test]
fn vectors_keep_their_components_apart() {
    let kinds: [(&str, Vec<(&str, Value)>); 4] = [
        (
            "discrete-transfer-function",
            vec![("numerator", list(&[1.0, 2.0])), ("denominator", list(&[1.0, 0.5, 0.25]))],
        ),
        ("fir-filter", vec![("coefficients", list(&[1.0, 2.0, 3.0]))]),
        ("iir-filter", vec![("b", list(&[1.0, 2.0])), ("a", list(&[1.0, 0.5]))]),
        (
            "discrete-pid",
            vec![("kp", 1.0.into()), ("ki", 2.0.into()), ("kd", 3.0.into()), ("output_time_constant", 0.1.into())],
        ),
    ];
    for (kind, parameters) in kinds {
        let mut d = driven(&[1.0, -2.0, 0.0], block(kind, &parameters));
        d.block("alone", Samples { values: vec![-2.0] });
        add(&mut d, "second", block(kind, &parameters));
        d.wire("alone", "second");
        let mut simulator = Simulator::new(&d, STEP).unwrap();
        for _ in 0..10 {
            let y = simulator.output("y");
            // a factor of −2 is exact
            assert!(y[1] == simulator.output("second")[0] && y[1] == -2.0 * y[0] && y[2] == 0.0, "{kind}");
            simulator.advance();
        }
    }
}

#[test]
fn a_discrete_low_pass_is_the_lag_at_its_samples_whatever_the_time_constant() {
    // 63 % of a step after one time constant; a time constant far below the sample time follows at once
    let step = answer(&[1.0; 40], STEP, block("discrete-low-pass", &[("time_constant", 0.1.into())]));
    for (k, y) in step.iter().enumerate() {
        let expected = 1.0 - sincro_math::elementary::exp(-0.1 * (k + 1) as f64).0;
        assert!((y - expected).abs() < 1e-14, "{k}: {y} {expected}");
    }
    for time_constant in [0.0, 1e-6] {
        let fast = block("discrete-low-pass", &[("time_constant", time_constant.into()), ("dc_gain", 2.0.into())]);
        assert_eq!(answer(&[1.0, -3.0, 0.5], STEP, fast), [2.0, -6.0, 1.0]);
    }
    assert!(faults("discrete-low-pass", &[("time_constant", list(&[0.1, -1.0]))]).contains("is negative"));
}

/// y, y' and y'' of a command filter after `n` samples of a unit step.
fn commanded(damping_ratio: f64, n: usize) -> [f64; 3] {
    let parameters = [("natural_frequency", 2.0.into()), ("damping_ratio", damping_ratio.into())];
    let mut d = driven(&[1.0], block("command-filter", &parameters));
    add(&mut d, "all", block("mux", &[("inputs", 3.0.into())]));
    d.wire("y.y", "all.u1").wire("y.rate", "all.u2").wire("y.acceleration", "all.u3");
    let mut simulator = Simulator::new(&d, STEP).unwrap();
    for _ in 0..n {
        simulator.advance();
    }
    let found = simulator.output("all");
    [found[0], found[1], found[2]]
}

#[test]
fn a_command_filter_is_its_differential_equation_whatever_the_damping() {
    use sincro_math::elementary::{exp, sin_cos};
    let (w, n) = (2.0, 70);
    let t = n as f64 * STEP;
    // closed forms of a step response: 1 − e^(−ζωt)·(…)
    let critical = 1.0 - exp(-w * t).0 * (1.0 + w * t);
    let wd = w * (1.0f64 - 0.25).sqrt();
    let (sin, cos) = sin_cos(wd * t);
    let under = 1.0 - exp(-0.5 * w * t).0 * (cos + 0.5 * w / wd * sin);
    let (slow, fast) = (w * (2.0 - 3f64.sqrt()), w * (2.0 + 3f64.sqrt()));
    let over = 1.0 - (fast * exp(-slow * t).0 - slow * exp(-fast * t).0) / (fast - slow);
    for (damping_ratio, expected) in [(1.0, critical), (0.5, under), (2.0, over)] {
        let [y, rate, acceleration] = commanded(damping_ratio, n);
        assert!((y - expected).abs() < 1e-13, "ζ = {damping_ratio}: {y} {expected}");
        assert!((acceleration + w * w * (y - 1.0) + 2.0 * damping_ratio * w * rate).abs() < 1e-13);
        let [before, after] = [commanded(damping_ratio, n - 1)[0], commanded(damping_ratio, n + 1)[0]];
        // central difference: the third derivative times Ts²/6
        assert!(((after - before) / (2.0 * STEP) - rate).abs() < 1e-3);
    }
    let [near, exact] = [1.0 + 1e-9, 1.0].map(|z| commanded(z, n)[0]);
    assert!((near - exact).abs() < 1e-7, "no jump between the formulas: {near} {exact}");
    assert!(faults("command-filter", &[("natural_frequency", 0.0.into())]).contains("not positive"));
    let negative = [("natural_frequency", 1.0.into()), ("damping_ratio", (-0.1).into())];
    assert!(faults("command-filter", &negative).contains("is negative"));
}
