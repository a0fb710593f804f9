//! Activations of actuators in scene files: what is recorded, balanced, kept in snapshots and refused.

use sincro_testing::{SceneFolder, run};

const SCENE: &str = r#"gravity = [0.0, 0.0, 0.0]

[[joint]]
name = "shaft"
kind = "revolute"
damping = 0.01
motor = { mode = "torque", command = { step = { time = 0.2, from = 2.0, to = -1.0 } }, activation = { kind = "filter", time_constant = 0.05, range = { lower = -0.5, upper = 1.5 }, initial = 0.25 } }

[[body]]
name = "wheel"
parent = "/shaft"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[joint]]
name = "slide"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]

[[body]]
name = "cart"
parent = "/slide"
mass = 2.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[tendon]]
name = "cord"
joints = ["/slide"]
coefficients = [0.5]
actuator = { command = 3.0, max_force = 0.4, activation = { kind = "integrator", input_range = { upper = 2.0 } } }
"#;

const EXPERIMENT: &str = r#"title = "Activations"
duration = 0.4
step = 0.01
record = ["/shaft.activation", "/shaft.command", "/shaft.motor_torque_now", "/shaft.velocity", "/cord.activation", "/cord.command", "/cord.force", "/slide.velocity", "energy.balance"]
"#;

#[test]
fn activations_are_recorded_and_act_in_the_place_of_commands() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    for integrator in ["dormand-prince", "stiff", "rk4", "implicit"] {
        let loaded = folder.load(&[&format!("integrator={integrator}")]).unwrap();
        let simulated = run(&loaded);
        let of = |name: &str| simulated.table.columns.iter().find(|c| c.name == name).unwrap();
        let column = |name: &str| &of(name).values;
        let units = ["/shaft.activation", "/cord.activation", "/cord.command"].map(|name| of(name).unit.to_string());
        assert_eq!(units, ["N·m", "N", "N/s"]);
        let loose = match integrator {
            "implicit" => 0.02,
            // (h/τ)⁵/120 of a step of rk4, with h/τ = 0.2
            "rk4" => 2e-5,
            _ => 1e-6,
        };
        for k in 1..column("/shaft.velocity").len() {
            let t = 0.01 * k as f64;
            let (a, cord) = (column("/shaft.activation")[k], column("/cord.activation")[k]);
            assert_eq!((column("/shaft.motor_torque_now")[k], column("/cord.force")[k]), (a, cord.min(0.4)));
            // u = 2 from a = 0.25, at the end of the range 1.5 from 0.0626 s on, back at once under u = −1
            let free = |t: f64, u: f64, from: f64| u + (from - u) * libm::exp(-t / 0.05);
            let expected = if t <= 0.2 { free(t, 2.0, 0.25).min(1.5) } else { free(t - 0.2, -1.0, 1.5).max(-0.5) };
            assert!((a - expected).abs() < loose, "{integrator} at {t}: {a} {expected}");
            assert!((cord - 2.0 * t).abs() < 1e-10, "{integrator} at {t}: {cord}");
        }
        let worst = column("energy.balance").iter().fold(0.0_f64, |worst, e| worst.max(e.abs()));
        assert!(worst < if integrator == "implicit" { 1e-2 } else { 1e-3 }, "{integrator}: {worst:e}");
    }
}

#[test]
fn what_an_activation_cannot_have_is_refused_where_it_stands() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    for (change, message) in [
        ("/shaft.motor.activation.time_constant=0", "time_constant"),
        ("/shaft.motor.activation={ kind = \"filter\" }", "`time_constant` is missing in the activation"),
        ("/shaft.motor.activation={ kind = \"integrator\", time_constant = 1.0 }", "`time_constant` has no meaning"),
        ("/shaft.motor.activation.range={ lower = 1.0, upper = -1.0 }", "range [1, -1] of the activation"),
        ("/shaft.motor.activation.initial=2.0", "initial activation 2"),
        ("/shaft.motor.mode=velocity", "which is of modes `torque`, `spring` and `voltage`"),
        ("cord.actuator.activation={ kind = \"filter\" }", "in the activation of tendon `cord`"),
    ] {
        let refused = folder.load(&[change]).err().unwrap_or_else(|| panic!("{change} is not refused"));
        assert!(refused.contains(message), "{change}: {refused}");
    }
}

#[test]
fn a_fast_activation_is_a_reason_for_the_stiff_method() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    let method = |integrator: &str| {
        let fast = "/shaft.motor.activation.time_constant=1e-5";
        sincro_sim::prelude::method_for(&folder.load(&[fast, &format!("integrator={integrator}")]).unwrap())
    };
    assert_eq!(method("auto").0, sincro_dynamics::world::MethodKind::Stiff);
    let warned = method("rk4").1.join("\n");
    assert!(
        warned.contains("the activation of the actuator of `/shaft` (1.000e-5 s) is too short for `rk4`"),
        "{warned}"
    );
}
