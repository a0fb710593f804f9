//! Continuous blocks against their closed forms. The method between ticks is Runge–Kutta of order 4: with a step of 1
//! ms and time constants of 0.1 s its error is far below 1e-9, the tolerance wherever no other is given.

mod common;

use common::{Samples, add, answer, block, driven, faults, list, made, rows, table};
use sincro_blocks::compile::{Interface, compile};
use sincro_blocks::diagram::Diagram;
use sincro_blocks::library::continuous::{Equations, Integrator, LowPass, Pid, TransferFunction, TransportDelay};
use sincro_blocks::library::maths::{Gain, Sum};
use sincro_blocks::library::sources::Constant;
use sincro_blocks::reader::Value;
use sincro_blocks::simulator::Simulator;
use sincro_math::elementary::{exp, sin_cos};

const STEP: f64 = 1e-3;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

fn step_response(block: Box<dyn sincro_blocks::instance::DynBlock>, n: usize) -> Vec<f64> {
    Simulator::new(&driven(&[1.0], block), STEP).unwrap().record("y", n)
}

#[test]
fn a_low_pass_answers_a_step_with_an_exponential() {
    let y = step_response(block("low-pass", &[("time_constant", 0.1.into()), ("dc_gain", 2.0.into())]), 200);
    for k in [0, 50, 200] {
        assert!(close(y[k], 2.0 * (1.0 - exp(-(k as f64) * STEP / 0.1).0)));
    }
}

#[test]
fn a_first_order_transfer_function_is_the_low_pass() {
    let g = block("transfer-function", &[("numerator", 4.0.into()), ("denominator", list(&[0.2, 2.0]))]);
    let lag = block("low-pass", &[("time_constant", 0.1.into()), ("dc_gain", 2.0.into())]);
    let (a, b) = (step_response(g, 200), step_response(lag, 200));
    assert!(a.iter().zip(&b).all(|(a, b)| close(*a, *b)));
}

#[test]
fn an_oscillator_answers_a_step_as_the_textbook_says() {
    // ω²/(s² + 2ζωs + ω²): y = 1 − e^(−ζωt)·(cos ω_d t + ζω/ω_d sin ω_d t)
    let (w, zeta) = (10.0, 0.3);
    let g = TransferFunction::new(&[w * w], &[1.0, 2.0 * zeta * w, w * w]);
    assert_eq!(sincro_blocks::block::Block::label(&g), "100/(s² + 6s + 100)");
    let y = step_response(Box::new(g), 500);
    let damped = w * (1.0f64 - zeta * zeta).sqrt();
    for k in [10, 100, 500] {
        let t = k as f64 * STEP;
        let (s, c) = sin_cos(damped * t);
        assert!(close(y[k], 1.0 - exp(-zeta * w * t).0 * (c + zeta * w / damped * s)), "{k} {}", y[k]);
    }
}

#[test]
fn a_biproper_transfer_function_feeds_through_its_part() {
    // (s + 1)/(0.5s + 1): jumps to 2, then to 1 as 1 + e^(−2t)
    let g = || block("transfer-function", &[("numerator", list(&[1.0, 1.0])), ("denominator", list(&[0.5, 1.0]))]);
    assert!(g().has_direct_feedthrough(0));
    assert!(!TransferFunction::new(&[1.0], &[1.0, 1.0]).on_feed_through());
    let y = step_response(g(), 300);
    assert!(close(y[0], 2.0) && close(y[300], 1.0 + exp(-0.6).0));
}

/// `has_direct_feedthrough` without its trait in scope.
trait FeedThrough {
    fn on_feed_through(&self) -> bool;
}

impl<T: sincro_blocks::instance::DynBlock> FeedThrough for T {
    fn on_feed_through(&self) -> bool {
        self.has_direct_feedthrough(0)
    }
}

#[test]
fn a_transfer_function_takes_vectors_component_by_component() {
    let g = Box::new(TransferFunction::new(&[1.0], &[0.01, 0.2, 1.0]));
    let mut simulator = Simulator::new(&driven(&[1.0, -3.0], g), STEP).unwrap();
    simulator.record("y", 100);
    let y = simulator.output("y");
    assert!(close(y[1], -3.0 * y[0]) && y[0] > 0.1);
}

#[test]
fn a_transfer_function_rests_at_its_initial_output() {
    let parameters =
        [("numerator", 3.0.into()), ("denominator", list(&[1.0, 2.0, 6.0])), ("initial_output", 0.5.into())];
    let y = step_response(block("transfer-function", &parameters), 100);
    assert!(close(y[0], 0.5) && close(y[100], 0.5));
}

#[test]
fn improper_and_empty_transfer_functions_are_refused() {
    let wrong = faults("transfer-function", &[("numerator", list(&[1.0, 0.0])), ("denominator", 2.0.into())]);
    assert!(wrong.contains("numerator of degree 1, denominator of degree 0") && wrong.contains("`derivative`"));
    let wrong = faults("transfer-function", &[("numerator", 1.0.into()), ("denominator", list(&[0.0, 0.0]))]);
    assert!(wrong.contains("the denominator is zero"), "{wrong}");
}

#[test]
fn state_space_and_transfer_function_are_the_same_system() {
    let g = block("transfer-function", &[("numerator", list(&[2.0, 5.0])), ("denominator", list(&[1.0, 3.0, 7.0]))]);
    let parameters =
        [("a", rows(&[&[-3.0, -7.0], &[1.0, 0.0]])), ("b", rows(&[&[1.0], &[0.0]])), ("c", rows(&[&[2.0, 5.0]]))];
    let system = block("state-space", &parameters);
    assert!(!system.has_direct_feedthrough(0));
    let (a, b) = (step_response(g, 300), step_response(system, 300));
    assert!(a.iter().zip(&b).all(|(a, b)| close(*a, *b)));
}

#[test]
fn matrices_that_do_not_fit_are_named_with_their_sizes() {
    let square = rows(&[&[0.0, 1.0], &[0.0, 0.0]]);
    let of = |b: Value, c: Value| faults("state-space", &[("a", square.clone()), ("b", b), ("c", c)]);
    let wrong = of(rows(&[&[1.0], &[2.0], &[3.0]]), rows(&[&[1.0, 0.0]]));
    assert!(wrong.contains("`b` is 3 × 1, `a` is 2 × 2"), "{wrong}");
    assert!(of(list(&[0.0, 1.0]), rows(&[&[1.0]])).contains("`c` is 1 × 1, `a` is 2 × 2"));
    assert!(
        faults("state-space", &[("a", list(&[1.0, 2.0])), ("b", 1.0.into()), ("c", 1.0.into())]).contains("square")
    );
}

#[test]
fn a_derivative_answers_a_ramp_with_its_slope() {
    let mut d = Diagram::new();
    d.block("slope", Constant::new(3.0)).block("ramp", Integrator::new(5.0));
    let parameters = [("time_constant", 0.1.into()), ("initial_input", 5.0.into())];
    add(&mut d, "y", block("derivative", &parameters));
    d.wire("slope", "ramp").wire("ramp", "y");
    let y = Simulator::new(&d, STEP).unwrap().record("y", 100);
    assert!(close(y[0], 0.0) && close(y[100], 3.0 * (1.0 - exp(-1.0).0)));
}

#[test]
fn an_integrator_stops_at_its_limit_and_leaves_it_at_once() {
    let mut samples = vec![1.0; 100];
    samples.extend([-1.0; 50]);
    let parameters = [("upper", 0.05.into()), ("lower", (-1.0).into())];
    let y = answer(&samples, STEP, block("integrator", &parameters));
    assert!(close(y[40], 0.04) && y[60] == 0.05 && y[100] == 0.05);
    assert!(close(y[140], 0.01), "{}", y[140]);
    assert!(faults("integrator", &[("upper", 1.0.into()), ("initial", 2.0.into())]).contains("beyond the limits"));
}

#[test]
fn an_integrator_goes_back_to_its_initial_value_while_it_is_reset() {
    let mut d = Diagram::new();
    d.block("one", Constant::new(1.0));
    let mut resets = vec![0.0; 30];
    resets[20] = 1.0;
    d.block("reset", Samples { values: resets });
    add(&mut d, "y", block("integrator", &[("reset", true.into()), ("initial", 7.0.into())]));
    d.wire("one", "y.u").wire("reset", "y.reset");
    let y = Simulator::new(&d, STEP).unwrap().record("y", 29);
    assert!(close(y[20], 7.02) && close(y[21], 7.001) && close(y[29], 7.009), "{y:?}");
}

/// A lag of 0.1 s held at a setpoint by a PID controller with limits.
fn loop_with(parameters: &[(&str, Value)], setpoint: f64) -> Diagram {
    let mut d = Diagram::new();
    d.block("setpoint", Constant::new(setpoint)).block("error", Sum::new("+-"));
    add(&mut d, "pid", block("pid", parameters));
    d.block("plant", LowPass::new(0.1));
    d.wire("setpoint", "error.u1").wire("plant", "error.u2").wire("error", "pid").wire("pid", "plant");
    d
}

#[test]
fn a_pi_controller_that_cancels_the_pole_makes_a_lag() {
    // kp + ki/s = kp (s + 1/Ti)/s with Ti = 0.1: closed loop 1/(s·0.1/kp + 1)
    let d = loop_with(&[("kp", 2.0.into()), ("ki", 20.0.into())], 1.0);
    let y = Simulator::new(&d, STEP).unwrap().record("plant", 200);
    assert!(close(y[200], 1.0 - exp(-0.2 * 2.0 / 0.1).0), "{}", y[200]);
}

#[test]
fn the_derivative_term_is_a_filtered_derivative() {
    let mut d = Diagram::new();
    d.block("slope", Constant::new(3.0)).block("ramp", Integrator::new(0.0));
    add(&mut d, "y", block("pid", &[("kd", 2.0.into()), ("filter_time_constant", 0.1.into())]));
    d.wire("slope", "ramp").wire("ramp", "y");
    let y = Simulator::new(&d, STEP).unwrap().record("y", 100);
    assert!(close(y[100], 2.0 * 3.0 * (1.0 - exp(-1.0).0)));
}

#[test]
fn a_saturated_pid_does_not_wind_up() {
    let overshoot = |anti_windup: &str| {
        let parameters = [
            ("kp", 4.0.into()),
            ("ki", 80.0.into()),
            ("lower", (-1.2).into()),
            ("upper", 1.2.into()),
            ("anti_windup", anti_windup.into()),
        ];
        let y = Simulator::new(&loop_with(&parameters, 1.0), STEP).unwrap().record("plant", 1500);
        assert!((y[1500] - 1.0).abs() < 1e-3, "{anti_windup} {}", y[1500]);
        y.iter().fold(0.0f64, |most, y| most.max(y - 1.0))
    };
    let (none, back, clamping) = (overshoot("none"), overshoot("back-calculation"), overshoot("clamping"));
    assert!(back < 0.2 * none && clamping < 0.2 * none, "{none} {back} {clamping}");
}

#[test]
fn separate_inputs_with_weights_of_one_are_the_error() {
    let gains = [("kp", Value::from(2.0)), ("ki", 3.0.into()), ("kd", 0.1.into())];
    let mut d = Diagram::new();
    d.block("r", Constant::new(1.0)).block("slope", Constant::new(0.7)).block("m", Integrator::new(0.2));
    d.block("error", Sum::new("+-"));
    add(&mut d, "one", block("pid", &gains));
    let mut two = gains.to_vec();
    two.extend([("separate", true.into()), ("derivative_setpoint_weight", 1.0.into())]);
    add(&mut d, "two", block("pid", &two));
    two.extend([("setpoint_weight", 0.0.into()), ("feedforward", true.into())]);
    two[4].1 = 0.0.into();
    add(&mut d, "no_kick", block("pid", &two));
    d.wire("slope", "m").wire("r", "error.u1").wire("m", "error.u2").wire("error", "one");
    d.wire("r", "two.setpoint").wire("m", "two.measurement");
    d.wire("r", "no_kick.setpoint").wire("m", "no_kick.measurement").wire("r", "no_kick.feedforward");
    let mut simulator = Simulator::new(&d, STEP).unwrap();
    // −kp·m − kd·m/Tf + feedforward
    assert!(close(simulator.output("no_kick")[0], -2.0 * 0.2 - 0.1 * 0.2 / 0.01 + 1.0));
    simulator.record("one", 100);
    assert!(close(simulator.output("one")[0], simulator.output("two")[0]));
}

#[test]
fn an_output_lag_is_the_law_of_the_thesis() {
    // τ_f·y' = kp·e + ki·∫e − y, written out as equations
    // the integral term starts at 0.7, and the lag with it
    let law = [("kp", 5.0.into()), ("ki", 8.0.into()), ("output_time_constant", 0.02.into()), ("initial", 0.7.into())];
    let mut d = Diagram::new();
    d.block("e", Constant::new(0.3));
    let pid = block("pid", &law);
    assert!(!pid.has_direct_feedthrough(0));
    add(&mut d, "pid", pid);
    let parameters = [
        ("inputs", Value::from(vec!["e"])),
        ("equations", vec!["i' = e", "y' = (5*e + 8*i - y)/0.02"].into()),
        ("outputs", table(&[("y", "y".into())])),
        ("initial", table(&[("i", (0.7 / 8.0).into()), ("y", 0.7.into())])),
    ];
    d.block("law", Equations::new(parameters).unwrap());
    d.wire("e", "pid").wire("e", "law");
    let mut simulator = Simulator::new(&d, STEP).unwrap();
    assert_eq!(simulator.output("pid"), [0.7]);
    for _ in 0..100 {
        assert!(close(simulator.output("pid")[0], simulator.output("law")[0]));
        simulator.advance();
    }
}

#[test]
fn pid_parameters_that_make_no_sense_are_refused() {
    assert!(faults("pid", &[("lower", 1.0.into()), ("upper", 0.0.into())]).contains("`lower` 1 is above `upper` 0"));
    let wrong = faults("pid", &[("ki", 1.0.into()), ("upper", 1.0.into())]);
    assert!(wrong.contains("back-calculation needs `tracking_time_constant`"), "{wrong}");
    assert!(faults("pid", &[("kd", 1.0.into()), ("filter_time_constant", 0.0.into())]).contains("is 0"));
    assert!(made("discrete-pid", &[("kd", 1.0.into()), ("filter_time_constant", 0.0.into())]).is_ok());
}

#[test]
fn a_pid_takes_vectors_with_a_gain_for_each() {
    let d = driven(&[1.0, 2.0], block("pid", &[("kp", list(&[3.0, 4.0])), ("upper", list(&[10.0, 5.0]))]));
    assert_eq!(Simulator::new(&d, STEP).unwrap().output("y"), [3.0, 5.0]);
    assert_eq!(sincro_blocks::block::Block::label(&Pid::new(1.0, 0.0, 2.0)), "PD");
}

#[test]
fn a_transport_delay_gives_back_every_sample_to_the_bit() {
    let samples = common::Random(3).list(60);
    let y = answer(&samples, STEP, Box::new(TransportDelay { delay: 0.007, initial: vec![9.0] }));
    for k in 0..60 {
        assert_eq!(y[k], if k < 7 { 9.0 } else { samples[k - 7] });
    }
}

#[test]
fn a_transport_delay_interpolates_what_lies_between_ticks() {
    let ramp: Vec<f64> = (0..50).map(f64::from).collect();
    let y = answer(&ramp, STEP, Box::new(TransportDelay::new(0.0025)));
    assert!((y[30] - 27.5).abs() < 1e-6 && y[2] == 0.0, "{}", y[30]);
}

#[test]
fn a_delay_of_one_step_follows_a_smooth_signal_between_ticks() {
    // through an integrator: the delayed ramp is seen at all stages of the step
    let mut d = Diagram::new();
    d.block("one", Constant::new(1.0)).block("ramp", Integrator::new(0.0)).block("late", TransportDelay::new(STEP));
    d.block("sum", Integrator::new(0.0)).wire("one", "ramp").wire("ramp", "late").wire("late", "sum");
    let sum = Simulator::new(&d, STEP).unwrap().record("sum", 100);
    // ∫ (t − h) from h on
    assert!(close(sum[100], 0.5 * 0.099 * 0.099), "{}", sum[100]);
}

#[test]
fn a_delay_shorter_than_the_step_names_both() {
    let d = driven(&[1.0], Box::new(TransportDelay::new(0.0004)));
    let found = compile(&d, &Interface::new(STEP)).unwrap_err();
    assert!(found[0].message.contains("a delay of 0.0004 s is shorter than the base step of 0.001 s"), "{}", found[0]);
}

#[test]
fn equations_of_second_order_swing_as_their_closed_form() {
    // q'' = −ω² q + u
    let parameters = [
        ("inputs", Value::from(vec!["u"])),
        ("equations", vec!["q'' = u - w2*q"].into()),
        ("parameters", table(&[("w2", 25.0.into())])),
        ("initial", table(&[("q", 0.4.into()), ("q'", (-1.0).into())])),
    ];
    let mut d = Diagram::new();
    d.block("u", Constant::new(5.0)).block("plant", Equations::new(parameters).unwrap()).wire("u", "plant.u");
    let mut simulator = Simulator::new(&d, STEP).unwrap();
    simulator.record("plant.q", 400);
    let (s, c) = sin_cos(5.0 * 0.4);
    assert!(close(simulator.output("plant.q")[0], 0.2 + 0.2 * c - 0.2 * s));
    assert!(close(simulator.output("plant.q_dot")[0], -s - c));
}

#[test]
fn a_mass_matrix_gives_the_accelerations_of_its_inverse() {
    // the two-link arm: closed form of the inverse against the solve
    let common = |equations: &[&'static str], robot: bool| {
        let mut given = vec![
            ("inputs", Value::from(vec!["u1", "u2"])),
            (
                "where",
                table(&[
                    ("c2", "cos(q2)".into()),
                    ("m11", "2*1.064*c2 + 2.811".into()),
                    ("m12", "1.064*c2 + 0.5338".into()),
                ]),
            ),
            ("initial", table(&[("q1", 0.3.into()), ("q2", 1.1.into())])),
        ];
        if robot {
            given.push(("coordinates", vec!["q1", "q2"].into()));
            given.push(("mass_matrix", Value::List(vec![vec!["m11", "m12"].into(), vec!["m12", "0.5338"].into()])));
            given.push(("forces", vec!["u1 + q2'^2", "u2 - q1'^2"].into()));
        } else {
            given.push(("equations", equations.to_vec().into()));
        }
        Equations::new(given).unwrap_or_else(|faults| panic!("{faults:#?}"))
    };
    let det = "(m11*0.5338 - m12^2)";
    let first: &'static str = format!("q1'' = (0.5338*(u1 + q2'^2) - m12*(u2 - q1'^2))/{det}").leak();
    let second: &'static str = format!("q2'' = (m11*(u2 - q1'^2) - m12*(u1 + q2'^2))/{det}").leak();
    let mut d = Diagram::new();
    d.block("u", Constant::new(0.5));
    d.block("solved", common(&[], true)).block("written", common(&[first, second], false));
    for end in ["solved.u1", "solved.u2", "written.u1", "written.u2"] {
        d.wire("u", end);
    }
    let mut simulator = Simulator::new(&d, STEP).unwrap();
    simulator.record("solved.q1", 500);
    for port in ["q1", "q2", "q1_dot", "q2_dot"] {
        let (a, b) = (simulator.output(&format!("solved.{port}"))[0], simulator.output(&format!("written.{port}"))[0]);
        assert!(close(a, b), "{port} {a} {b}");
    }
    assert!((simulator.output("solved.q1")[0] - 0.3).abs() > 0.01);
}

#[test]
fn outputs_feed_through_exactly_the_inputs_that_they_use() {
    let parameters = [
        ("inputs", Value::from(vec!["a", "b", "c"])),
        ("equations", vec!["x' = a + b + c"].into()),
        ("where", table(&[("twice", "2*b".into()), ("unused", "a".into())])),
        ("outputs", table(&[("y", "x + twice".into()), ("x", "x".into()), ("time", "t".into())])),
    ];
    let plant = Equations::new(parameters).unwrap();
    let feeds: Vec<bool> = (0..3).map(|k| sincro_blocks::block::Block::has_direct_feedthrough(&plant, k)).collect();
    assert_eq!(feeds, [false, true, false]);
    let mut d = Diagram::new();
    d.block("u", Constant::new(1.5)).block("plant", plant);
    // `a` and `c` are fed back at once: no loop
    d.block("gain", Gain::new(0.0)).wire("plant.y", "gain").wire("gain", "plant.a").wire("gain", "plant.c");
    d.wire("u", "plant.b");
    let mut simulator = Simulator::new(&d, STEP).unwrap();
    simulator.record("plant.y", 100);
    assert!(close(simulator.output("plant.y")[0], 3.15) && close(simulator.output("plant.time")[0], 0.1));
}

#[test]
fn what_is_wrong_with_equations_is_told_with_its_place() {
    let parameters =
        [("equations", Value::from(vec!["x' = -a*x", "x'' = 1", "y = 3"])), ("initial", table(&[("z", 1.0.into())]))];
    let wrong = faults("equations", &parameters);
    assert!(wrong.contains("equations.1: there are two equations for `x`"), "{wrong}");
    assert!(wrong.contains("equations.2: `y = 3` is no differential equation"), "{wrong}");
    assert!(wrong.contains("initial.z: `z` is no state (the states are x)"), "{wrong}");
    let found = made("equations", &[("equations", Value::from(vec!["x' = -a*x"]))]).unwrap_err();
    assert_eq!((found[0].path.join("."), found[0].span.clone()), ("equations.0".into(), Some(6..7)));
    let robot = [("coordinates", Value::from(vec!["q"])), ("mass_matrix", vec!["1", "2"].into())];
    let wrong = faults("equations", &robot);
    assert!(wrong.contains("`mass_matrix` is 2 × 1") && wrong.contains("`forces` has 0 formulas"), "{wrong}");
    assert!(faults("equations", &[]).contains("there is no equation"));
    let twice = [("inputs", Value::from(vec!["x"])), ("equations", vec!["x' = 1"].into())];
    assert!(faults("equations", &twice).contains("`x` has two meanings"));
}

#[test]
fn equations_know_the_parameters_of_the_diagram_and_the_time() {
    use sincro_blocks::kind::Described;
    use sincro_blocks::reader::{NoFiles, Reader};
    let read = |parameters: &[(&str, Value)]| {
        let given = parameters.iter().map(|(key, x)| ((*key).to_owned(), x.clone())).collect();
        let scope = [("k".to_owned(), 2.0), ("m".to_owned(), 100.0)].into();
        let mut reader = Reader::new(Equations::KIND, &given, &scope, &NoFiles);
        let plant = Equations::read(&mut reader);
        (plant, reader.finish())
    };
    // the block's own `m` hides the diagram's
    let own = table(&[("m", 3.0.into())]);
    let given = [
        ("equations", Value::from(vec!["x' = k*t + n"])),
        ("parameters", own),
        ("where", table(&[("n", "2*m".into())])),
    ];
    let (plant, faults) = read(&given);
    assert!(faults.is_empty(), "{faults:?}");
    let mut d = Diagram::new();
    d.block("plant", plant);
    let x = Simulator::new(&d, STEP).unwrap().record("plant", 500);
    // t² + 6t at 0.5 s
    assert!(close(x[500], 3.25), "{}", x[500]);
    let clash = [("equations", Value::from(vec!["x' = k"])), ("where", table(&[("k", "1".into())]))];
    assert!(read(&clash).1[0].message.contains("`k` has two meanings"));
}
