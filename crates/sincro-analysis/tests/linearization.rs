//! Linearisation against closed forms and central differences; trim against statics.

use sincro_analysis::linear::{DMatrix, lqr};
use sincro_analysis::linearize::{
    Linearization, Request, TrimRequest, linearize, linearize_sampled, operating_point, trim,
};
use sincro_math::elementary::sin_cos;
use sincro_scene::diagnostic::{Located, Location, SourceText};
use sincro_scene::overrides::Override;
use sincro_sim::run::LockStep;
use sincro_sim::{Extensions, Loaded, load};

fn scene(name: &str, set: &[(&str, &str)]) -> Loaded {
    let overrides: Vec<Override> = set.iter().map(|(path, value)| Override::new(path, value)).collect();
    let folder = sincro_testing::repository_scene(name);
    load(&folder, &overrides, Extensions::default()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

fn name(text: &str) -> Located<String> {
    let source = std::sync::Arc::new(SourceText { path: "test".into(), text: text.into() });
    Located { value: text.into(), at: Location { source, span: 0..text.len() } }
}

/// The arm with torque motors, moving, under torques.
fn moving_arm() -> Loaded {
    scene(
        "two-dof-position",
        &[
            ("/shoulder.motor.mode", "torque"),
            ("/shoulder/elbow.motor.mode", "torque"),
            ("/shoulder.motor.command", "0.8"),
            ("/shoulder/elbow.motor.command", "-0.3"),
            ("/shoulder.initial", "{ position = 0.1, velocity = 0.7 }"),
            ("/shoulder/elbow.initial", "{ position = 0.9, velocity = -1.3 }"),
            ("diagram.speed.gain", "0"),
        ],
    )
}

fn at_start(loaded: &Loaded, request: &Request) -> (LockStep, Linearization) {
    let at = operating_point(loaded, 0.0).unwrap();
    let linear = linearize(loaded, &at, request).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    (at, linear)
}

#[test]
fn the_two_dof_arm_has_its_closed_form() {
    let loaded = moving_arm();
    let (at, linear) = at_start(&loaded, &Request::default());
    let (q2, v) = (at.state().q[1], [at.state().v[0], at.state().v[1]]);
    let tau = [at.state().commands[0], at.state().commands[1]];
    // M q'' + C = τ with the coefficients of the thesis (4.1)
    let (h, a, b) = (1.064, 2.811, 0.5338);
    let (s, c) = sin_cos(q2);
    let m = DMatrix::from_row_slice(2, 2, &[2.0 * h * c + a, h * c + b, h * c + b, b]);
    let inverse = m.clone().try_inverse().unwrap();
    let bias = DMatrix::from_row_slice(2, 1, &[-h * s * v[1] * v[1] - 2.0 * h * v[0] * v[1] * s, h * v[0] * v[0] * s]);
    let accelerations = &inverse * (DMatrix::from_row_slice(2, 1, &tau) - bias);
    // by q2: M⁻¹(−∂C/∂q2 − ∂M/∂q2 q'')
    let m_q = DMatrix::from_row_slice(2, 2, &[-2.0 * h * s, -h * s, -h * s, 0.0]);
    let c_q = DMatrix::from_row_slice(2, 1, &[-h * c * v[1] * v[1] - 2.0 * h * v[0] * v[1] * c, h * v[0] * v[0] * c]);
    let by_q2 = &inverse * (-c_q - m_q * &accelerations);
    let c_v = DMatrix::from_row_slice(
        2,
        2,
        &[-2.0 * h * v[1] * s, -2.0 * h * s * v[1] - 2.0 * h * v[0] * s, 2.0 * h * v[0] * s, 0.0],
    );
    let by_v = -(&inverse * c_v);
    let mut expected = DMatrix::zeros(4, 4);
    for i in 0..2 {
        expected[(i, 2 + i)] = 1.0;
        expected[(2 + i, 1)] = by_q2[i];
        for k in 0..2 {
            expected[(2 + i, 2 + k)] = by_v[(i, k)];
        }
    }
    // the closed form is of a quotient by det M = 0.08…: 1e-10 leaves 5 digits for that and for rounding
    let scale = expected.amax();
    assert!((&linear.system.a - &expected).amax() <= 1e-10 * scale, "{} {expected}", linear.system.a);
    for i in 0..2 {
        for k in 0..2 {
            assert!((linear.system.b[(2 + i, k)] - inverse[(i, k)]).abs() <= 1e-10 * inverse.amax());
        }
        assert!((linear.rate[2 + i] - accelerations[i]).abs() <= 1e-10 * accelerations.amax());
    }
    assert_eq!(linear.system.inputs[0].name, "/shoulder.command");
    assert_eq!(linear.system.states[3].name, "/shoulder/elbow.velocity");
    assert_eq!(linear.system.states[3].unit, "rad/s");
}

/// A and B by central differences of the same equations of motion on plain numbers, started from displaced scenes.
#[test]
fn derivatives_agree_with_central_differences() {
    for (folder, set) in [
        ("free-body", vec![]),
        ("double-pendulum", vec![]),
        ("spring-dynamic", vec![]),
        ("two-dof-position", vec![("/shoulder.motor.mode", "torque"), ("/shoulder/elbow.motor.mode", "torque")]),
    ] {
        let loaded = scene(folder, &set);
        let at = operating_point(&loaded, 3.0 * loaded.experiment.step).unwrap();
        let linear = linearize(&loaded, &at, &Request::default()).unwrap();
        let n = linear.system.n_states();
        let scale = linear.system.a.amax().max(1.0);
        // error of a central difference: h² of the third derivative against 1e-16/h of rounding
        let h = 1e-5;
        for k in 0..n {
            let at_side = |by: f64| sincro_analysis::linearize::perturbed_rates(&loaded, &at, k, by);
            let (up, down) = (at_side(h), at_side(-h));
            for i in 0..n {
                let difference = (up[i] - down[i]) / (2.0 * h);
                let exact = linear.system.a[(i, k)];
                assert!((difference - exact).abs() <= 1e-6 * scale, "{folder} ({i}, {k}): {difference} {exact}");
            }
        }
    }
}

#[test]
fn a_closed_loop_has_the_states_of_its_controller() {
    let set =
        [("diagram", "\"pid.toml\""), ("/shoulder.motor.mode", "torque"), ("/shoulder/elbow.motor.mode", "torque")];
    let loaded = scene("two-dof-position", &set);
    let request =
        Request { inputs: vec![name("speed[0]")], outputs: vec![name("/shoulder.velocity")], is_closed: true };
    let (_, linear) = at_start(&loaded, &request);
    assert_eq!(linear.system.n_states(), 8);
    assert!(linear.notes[0].contains("sampled blocks hold"), "{:?}", linear.notes);
    // the velocity loop has integral action: a speed asked for is reached, whatever the inertia (the coordinates
    // integrate, so that A is singular, but neither speed nor torque depends on them: they do not enter the channel)
    let gain = linear.system.gain(0, 0).unwrap();
    assert!((gain - 1.0).abs() < 1e-12, "{gain}");
    let slowest = linear.system.poles().iter().map(|p| p.pole.re).fold(f64::NEG_INFINITY, f64::max);
    assert!(slowest < 1e-9, "{slowest}");
}

/// Two-link arm with the shoulder driven at a velocity u: w = v₂ + N u does not jump, N = M₂₁/M₂₂.
#[test]
fn a_velocity_motor_has_direct_feedthrough_in_velocity() {
    let set = [
        ("/shoulder.motor.mode", "velocity"),
        ("/shoulder/elbow.motor.mode", "torque"),
        ("/shoulder.motor.command", "0"),
        ("/shoulder/elbow.motor.command", "0"),
        ("/shoulder/elbow.initial", "{ position = 0.9 }"),
        ("diagram.speed.gain", "0"),
    ];
    let loaded = scene("two-dof-position", &set);
    let outputs = vec![name("/shoulder.velocity"), name("/shoulder/elbow.velocity")];
    let request = Request { inputs: vec![name("/shoulder")], outputs, ..Request::default() };
    let (at, linear) = at_start(&loaded, &request);
    let names: Vec<&str> = linear.system.states.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["/shoulder.position", "/shoulder/elbow.position", "/shoulder/elbow.velocity"]);
    let (h, b) = (1.064, 0.5338);
    let n = (h * sin_cos(at.state().q[1]).1 + b) / b;
    let d = &linear.system.d;
    assert!((d[0] - 1.0).abs() < 1e-14 && (d[1] + n).abs() < 1e-13 * n, "{d} {n}");
    // the coordinate of the elbow moves by w − N u
    assert!((linear.system.b[(1, 0)] + n).abs() < 1e-13 * n && linear.system.a[(1, 2)] == 1.0);
    assert_eq!(linear.system.b[(0, 0)], 1.0);
}

#[test]
fn an_acceleration_is_no_output_of_a_velocity_motor() {
    let set = [("/shoulder.motor.mode", "velocity"), ("/shoulder/elbow.motor.mode", "torque")];
    let loaded = scene("two-dof-position", &set);
    let at = operating_point(&loaded, 0.0).unwrap();
    let request = Request {
        inputs: vec![name("/shoulder")],
        outputs: vec![name("/shoulder/elbow.acceleration")],
        ..Request::default()
    };
    let diagnostics = linearize(&loaded, &at, &request).unwrap_err().to_string();
    assert!(diagnostics.contains("contains the rate of"), "{diagnostics}");
}

#[test]
fn a_pendulum_is_trimmed_by_its_torque_and_by_its_angle() {
    let loaded = scene("spring-static", &[]);
    let at = operating_point(&loaded, 0.0).unwrap();
    let found = trim(&loaded, &at, &TrimRequest::default()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    assert!(found.trim.residual < 1e-9, "{:?}", found.trim);
    // what is trimmed stays where it is
    let mut run = found.at.fork().lockstep;
    let before = run.state().q.clone();
    for _ in 0..100 {
        run.advance().unwrap();
    }
    for (a, b) in before.iter().zip(&run.state().q) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn the_regulator_of_the_double_integrator_is_the_textbook_one() {
    let a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
    let b = DMatrix::from_row_slice(2, 1, &[0.0, 1.0]);
    let k = lqr(&a, &b, &DMatrix::identity(2, 2), &DMatrix::identity(1, 1)).unwrap().k;
    assert!((k[0] - 1.0).abs() < 1e-12 && (k[1] - 3.0_f64.sqrt()).abs() < 1e-12, "{k}");
}

#[test]
fn the_gains_of_the_cart_and_pole_are_those_of_its_linearisation() {
    let loaded = scene("cart-pole-lqr", &[("/rail/cart/hinge.initial.position", "0")]);
    let (_, linear) = at_start(&loaded, &Request::default());
    let q = DMatrix::from_diagonal(&sincro_analysis::linear::DVector::from_column_slice(&[1.0, 10.0, 1.0, 1.0]));
    let design = lqr(&linear.system.a, &linear.system.b, &q, &DMatrix::from_element(1, 1, 0.1)).unwrap();
    let folder = sincro_testing::repository_scene("cart-pole-lqr").join("lqr.toml");
    let text = std::fs::read_to_string(folder).unwrap();
    let list = text.split_once("gain = [[").and_then(|(_, rest)| rest.split_once("]]")).unwrap().0;
    let gains: Vec<f64> = list.split(',').map(|x| x.trim().parse().unwrap()).collect();
    // the block feeds back +K·x for u = −K·x of the design
    for (k, gain) in gains.iter().enumerate() {
        assert!((gain + design.k[k]).abs() < 1e-8 * gain.abs(), "{k}: {gain} {}", design.k[k]);
    }
    assert!(design.poles.iter().all(|p| p.re < -1.0), "{:?}", design.poles);
}

/// Ideal motors with a sampled position loop, q⁺ = q + T·u, u = k·(r − q of the sample before): z² − z + k T = 0.
#[test]
fn a_sampled_position_loop_has_its_discrete_poles() {
    let loaded = scene("two-dof-position", &[]);
    let at = operating_point(&loaded, 2.0).unwrap();
    let found = linearize_sampled(&loaded, &at).unwrap();
    let poles: Vec<_> = found.system.poles().iter().map(|mode| mode.pole).collect();
    assert_eq!(found.system.sample_time, Some(0.005));
    let root = (1.0_f64 - 4.0 * 2.0 * 0.005).sqrt();
    for expected in [0.5 * (1.0 + root), 0.5 * (1.0 - root)] {
        let near = poles.iter().filter(|p| (p.re - expected).abs() < 1e-9 && p.im.abs() < 1e-9).count();
        assert_eq!(near, 2, "{expected}: {poles:?}");
    }
}

/// Growth that is measured: half the difference of two runs that start 2e-4 apart in a coordinate, so that what is of
/// second order in it cancels; one value a period, from period `after` on.
fn difference_of_runs(at: &LockStep, period: u64, coordinate: usize, (after, n): (usize, usize)) -> Vec<f64> {
    let side = |by: f64| {
        let mut run = at.fork().lockstep;
        let mut state = run.state().clone();
        state.q[coordinate] += by;
        run.set_state(state, &[]);
        let mut series = Vec::new();
        for k in 0..after + n {
            for _ in 0..period {
                run.advance().unwrap();
            }
            if k >= after {
                series.push(run.state().q[coordinate]);
            }
        }
        series
    };
    side(1e-4).iter().zip(side(-1e-4)).map(|(up, down)| 0.5 * (up - down)).collect()
}

/// Growth of a difference between two runs at time `t`, by a recurrence of order `order` fitted to a coordinate from
/// period `after` on: all of its roots are poles, to `tolerance`.
fn assert_poles_of_growth(
    loaded: &Loaded,
    t: f64,
    coordinate: usize,
    (after, n): (usize, usize),
    (order, tolerance): (usize, f64),
) {
    let at = operating_point(loaded, t).unwrap();
    let found = linearize_sampled(loaded, &at).unwrap();
    let poles: Vec<_> = found.system.poles().iter().map(|m| m.pole).collect();
    let series = difference_of_runs(&at, found.period, coordinate, (after, n));
    let rows = series.len() - order;
    let m = DMatrix::from_fn(rows, order, |i, j| series[i + order - 1 - j]);
    let r = DMatrix::from_fn(rows, 1, |i, _| series[i + order]);
    let fit = m.svd(true, true).solve(&r, 0.0).unwrap();
    // companion matrix of zⁿ = a₁ zⁿ⁻¹ + … + aₙ
    let companion = DMatrix::from_fn(order, order, |i, j| match i {
        0 => fit[j],
        _ => f64::from(u8::from(i == j + 1)),
    });
    for root in sincro_analysis::linear::modes::eigenvalues(&companion) {
        let distance = |p: &sincro_analysis::linear::Complex<f64>| {
            sincro_math::elementary::hypot(p.re - root.re, p.im - root.im).0
        };
        let nearest = poles.iter().map(distance).fold(f64::INFINITY, f64::min);
        eprintln!(
            "measured {root:.6}, nearest pole {nearest:.1e} away; drift {:.1e}, {} states",
            found.drift,
            poles.len()
        );
        assert!(nearest <= tolerance, "{root}: {nearest:e} {poles:?}");
    }
}

#[test]
fn discrete_poles_are_those_of_measured_growth() {
    let motors = [("/shoulder.motor.mode", "torque"), ("/shoulder/elbow.motor.mode", "torque")];
    let pid = scene("two-dof-position", &[("diagram", "\"pid.toml\""), motors[0], motors[1]]);
    assert_poles_of_growth(&pid, 2.0, 0, (40, 60), (2, 1e-3));
}

#[test]
fn the_sampled_flight_has_the_poles_of_its_measured_growth() {
    // hovering at the first waypoint
    let flight = scene("quadrotor-flight-2", &[("parameters.t1", "1000"), ("parameters.t2", "2000")]);
    // along z a pair, the rotors' lag, and the slow pole of the integral
    assert_poles_of_growth(&flight, 40.0, 2, (5, 80), (4, 1e-5));
}

#[test]
fn a_spring_and_damper_between_two_points_has_the_stiffness_of_its_law() {
    // free body of 2 kg on a line of 1 m under tension: along it −∂F/∂x and −∂F/∂v, across it F/ℓ
    let scene = r#"
gravity = [0.0, 0.0, 0.0]
[[joint]]
name = "rail"
kind = "planar"
initial = { position = [1.0, 0.0, 0.0] }
[[body]]
name = "ring"
parent = "/rail"
mass = 2.0
inertia = { xx = 1.0, yy = 1.0, zz = 1.0 }
[[force]]
name = "pull"
parent = "/rail/ring"
force = [6.0, 0.0, 0.0]
[[spring_damper]]
name = "line"
between = ["/", "/rail/ring"]
free_length = 0.5
damping = 0.3
law = "-10*x - 4*x^2"
"#;
    let experiment = "title = \"t\"\nduration = 1.0\nstep = 0.01\nrecord = [\"/line.force\"]\n";
    let loaded = sincro_testing::SceneFolder::of(scene, experiment).load(&[]).unwrap();
    let (_, linear) = at_start(&loaded, &Request::default());
    let expected = [[-14.0 / 2.0, 0.0, 0.0], [0.0, -6.0 / 2.0, 0.0], [0.0, 0.0, 0.0]];
    for i in 0..3 {
        for j in 0..3 {
            assert!(
                (linear.system.a[(3 + i, j)] - expected[i][j]).abs() < 1e-12,
                "{i} {j}: {}",
                linear.system.a[(3 + i, j)]
            );
        }
    }
    assert!((linear.system.a[(3, 3)] + 0.15).abs() < 1e-12 && linear.system.a[(4, 4)].abs() < 1e-12);
}
