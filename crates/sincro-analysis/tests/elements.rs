//! Linearisation of force elements with states or formulas of their own, against closed forms.

use sincro_analysis::linearize::{Request, TrimRequest, linearize, operating_point, trim};
use sincro_testing::SceneFolder;

const EXPERIMENT: &str = "title = \"Element\"\nduration = 1.0\nstep = 0.01\nrecord = [\"energy.total\"]\n";

/// Poles and names of the states at the start.
fn linear(scene: &str) -> (Vec<(f64, f64)>, Vec<String>) {
    let loaded = SceneFolder::of(scene, EXPERIMENT).load(&[]).unwrap();
    let at = operating_point(&loaded, 0.0).unwrap();
    let linear = linearize(&loaded, &at, &Request::default()).unwrap_or_else(|found| panic!("{found}"));
    let poles = linear.system.poles().iter().map(|mode| (mode.pole.re, mode.pole.im)).collect();
    (poles, linear.system.states.iter().map(|axis| axis.name.clone()).collect())
}

#[test]
fn a_motor_with_inductance_has_the_poles_of_its_equations() {
    // s (s² + (R/L) s + K²/(L D)), K = 0.5, D = 0.02
    let scene = r#"gravity = [0.0, 0.0, 0.0]
[[joint]]
name = "shaft"
kind = "revolute"
armature = 0.005
motor = { mode = "voltage", command = 3.0, resistance = 1.0, inductance = 0.01, torque_constant = 0.05, gear_ratio = 10.0, rotor_inertia = 5e-5 }
[[body]]
name = "wheel"
parent = "/shaft"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
"#;
    let (poles, names) = linear(scene);
    let root = (2500.0_f64 - 1250.0).sqrt();
    for expected in [0.0, -50.0 + root, -50.0 - root] {
        assert!(poles.iter().any(|(re, im)| (re - expected).abs() < 1e-9 && *im == 0.0), "{expected}: {poles:?}");
    }
    assert_eq!(poles.len(), 3);
    assert_eq!(names.last().unwrap(), "/shaft.current");
}

#[test]
fn gravity_over_the_position_is_differentiated_exactly() {
    // x'' = −9 x
    let scene = r#"gravity = { acceleration = ["-9*x", "0", "0"], potential = "4.5*x^2" }
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
[[body]]
name = "cart"
parent = "/rail"
mass = 2.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
"#;
    let (poles, _) = linear(scene);
    assert_eq!(poles.len(), 2);
    assert!(poles.iter().all(|(re, im)| re.abs() < 1e-12 && (im.abs() - 3.0).abs() < 1e-12), "{poles:?}");
}

/// A shaft with a spring, whose motor has an activation that the command drives against the end of its range.
fn with_activation(activation: &str) -> sincro_sim::Loaded {
    let scene = format!(
        r#"gravity = [0.0, 0.0, 0.0]
[[joint]]
name = "shaft"
kind = "revolute"
damping = 0.2
spring = {{ stiffness = 2.0 }}
motor = {{ mode = "torque", command = 3.0, activation = {{ {activation} }} }}
[[body]]
name = "wheel"
parent = "/shaft"
mass = 1.0
inertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}
"#
    );
    SceneFolder::of(&scene, EXPERIMENT).load(&[]).unwrap()
}

#[test]
fn activations_stop_at_the_ends_of_their_ranges() {
    for activation in [
        "kind = \"integrator\", range = { upper = 0.5 }, initial = 0.5",
        "kind = \"filter\", time_constant = 0.1, range = { upper = 0.5 }, initial = 0.5",
    ] {
        let loaded = with_activation(activation);
        let linear = linearize(&loaded, &operating_point(&loaded, 0.0).unwrap(), &Request::default()).unwrap();
        let k = linear.system.states.iter().position(|axis| axis.name == "/shaft.activation").unwrap();
        assert_eq!(linear.rate[k], 0.0, "{activation}");
        assert!(linear.system.poles().iter().any(|mode| mode.pole.re == 0.0 && mode.pole.im == 0.0), "{activation}");
        assert!(linear.system.b.row(k).iter().all(|x| *x == 0.0), "{activation}");
    }
}

/// The stop is left where the free command allows it: 2 q = a = u.
#[test]
fn a_trim_leaves_the_end_of_a_range_with_a_free_command() {
    let named = |name: &str| sincro_scene::overrides::Override::new(name, "").path;
    for activation in [
        "kind = \"filter\", time_constant = 0.1, range = { upper = 0.5 }, initial = 0.5",
        "kind = \"filter\", time_constant = 0.1, range = { upper = 0.5 }",
        "kind = \"integrator\", range = { upper = 0.5 }, initial = 0.5",
    ] {
        let loaded = with_activation(activation);
        let from = operating_point(&loaded, 0.0).unwrap();
        let wanted = |q: f64| TrimRequest {
            free: vec![named("/shaft")],
            wanted: vec![(named("/shaft.position"), q)],
            ..TrimRequest::default()
        };
        let found = trim(&loaded, &from, &wanted(0.1)).unwrap_or_else(|why| panic!("{activation}: {why}"));
        let (state, command) = (found.at.state(), found.trim.inputs[0].1);
        let u = if activation.contains("filter") { 0.2 } else { 0.0 };
        for (x, expected) in [(state.q[0], 0.1), (state.rotors[0], 0.2), (command, u)] {
            assert!((x - expected).abs() < 1e-9, "{activation}: {:?} {:?} {command}", state.q, state.rotors);
        }
        // beyond the end there is nothing
        assert!(trim(&loaded, &from, &wanted(0.4)).is_err(), "{activation}");
    }
}

/// The equilibrium is at the end of the range, where the dynamics stays, too.
#[test]
fn a_trim_ends_where_activations_stop() {
    for (activation, end) in [
        ("kind = \"filter\", time_constant = 0.1, range = { upper = 0.5 }", 0.5),
        ("kind = \"filter\", time_constant = 0.1, range = { upper = 0.5 }, initial = 0.5", 0.5),
        ("kind = \"filter\", time_constant = 0.1, range = { upper = 5.0 }", 3.0),
        ("kind = \"integrator\", range = { upper = 0.5 }, initial = 0.5", 0.5),
    ] {
        let loaded = with_activation(activation);
        let mut found = trim(&loaded, &operating_point(&loaded, 0.0).unwrap(), &TrimRequest::default())
            .unwrap_or_else(|why| panic!("{activation}: {why}"));
        let close = |state: &[f64], q: f64| (state[0] - end).abs() < 1e-9 && (q - end / 2.0).abs() < 1e-9;
        let state = found.at.state();
        assert!(close(&state.rotors, state.q[0]), "{activation}: {:?} {:?}", state.rotors, state.q);
        (0..20).for_each(|_| found.at.advance().unwrap());
        let state = found.at.state();
        assert!(close(&state.rotors, state.q[0]), "{activation}: {:?} {:?}", state.rotors, state.q);
    }
}
