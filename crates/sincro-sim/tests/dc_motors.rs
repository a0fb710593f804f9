//! Direct-current motors in scene files: what is recorded and commanded, what is refused.

use sincro_testing::{SceneFolder, run};

const SCENE: &str = r#"gravity = [0.0, 0.0, 0.0]

[[joint]]
name = "shaft"
kind = "revolute"
armature = 0.005
motor = { mode = "voltage", command = 30.0, resistance = 1.0, inductance = 0.01, torque_constant = 0.05, gear_ratio = 10.0, rotor_inertia = 5e-5, max_voltage = 12.0 }

[[body]]
name = "wheel"
parent = "/shaft"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
"#;

const EXPERIMENT: &str = r#"title = "Motor"
duration = 0.5
step = 0.01
record = ["/shaft.velocity", "/shaft.command", "/shaft.current", "/shaft.voltage", "/shaft.back_emf", "/shaft.electrical_power", "/shaft.motor_torque_now", "energy.balance", "energy.work", "energy.dissipated", "energy.total"]
"#;

#[test]
fn current_voltage_and_power_are_recorded_and_balanced() {
    for integrator in ["auto", "stiff", "rk4"] {
        let folder = SceneFolder::of(SCENE, EXPERIMENT);
        let step = if integrator == "rk4" { 1e-3 } else { 1e-2 };
        let loaded = folder.load(&[&format!("integrator={integrator}"), &format!("step={step}")]).unwrap();
        let simulated = run(&loaded);
        let column = |name: &str| &simulated.table.columns.iter().find(|c| c.name == name).unwrap().values;
        let [speed, command, current, voltage] =
            ["/shaft.velocity", "/shaft.command", "/shaft.current", "/shaft.voltage"].map(column);
        let [emf, power, torque, balance] =
            ["/shaft.back_emf", "/shaft.electrical_power", "/shaft.motor_torque_now", "energy.balance"].map(column);
        for k in 1..speed.len() {
            assert_eq!((command[k], voltage[k]), (30.0, 12.0));
            assert!((emf[k] - 0.5 * speed[k]).abs() < 1e-12 && (power[k] - 12.0 * current[k]).abs() < 1e-12);
            assert!((torque[k] - 0.5 * current[k]).abs() < 1e-12, "{integrator} row {k}");
        }
        // of 8 J of work; the quadrature of a fixed step is of its order
        let bound = if integrator == "rk4" { 1e-5 } else { 1e-8 };
        let worst = balance.iter().fold(0.0_f64, |worst, e| worst.max(e.abs()));
        assert!(worst < bound, "{integrator}: {worst:e}");
        // the no-load speed, to what is left of the slow exponential exp(−14.6 t)
        let last = *speed.last().unwrap();
        assert!((last / 24.0 - 1.0).abs() < 1e-3, "{integrator}: {last}");
    }
}

#[test]
fn without_inductance_the_current_is_recorded_too() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    let loaded = folder.load(&["/shaft.motor.inductance=0", "/shaft.motor.back_emf_constant=0.06"]).unwrap();
    let simulated = run(&loaded);
    let column = |name: &str| &simulated.table.columns.iter().find(|c| c.name == name).unwrap().values;
    for (speed, current) in column("/shaft.velocity").iter().zip(column("/shaft.current")).skip(1) {
        assert!((current - (12.0 - 0.6 * speed)).abs() < 1e-9);
    }
}

#[test]
fn a_diagram_commands_the_voltage_and_measures_the_current() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    let diagram = r#"
wires = ["/shaft.current -> regulator", "regulator -> /shaft"]

[[block]]
name = "regulator"
type = "gain"
gain = -2.0
"#;
    folder.write("diagram.toml", diagram);
    folder.change("experiment.toml", "record = [", "diagram = \"diagram.toml\"\nrecord = [\"regulator\", ");
    folder.change("scene.toml", "command = 30.0, ", "");
    folder.change("scene.toml", "armature = 0.005", "armature = 0.005\ninitial = { velocity = 10.0 }");
    let loaded = folder.load(&[]).unwrap();
    let simulated = run(&loaded);
    let column = |name: &str| &simulated.table.columns.iter().find(|c| c.name == name).unwrap().values;
    let (voltage, current) = (column("/shaft.voltage"), column("/shaft.current"));
    assert!(current.iter().skip(2).any(|i| *i < -1.0));
    assert!(voltage.iter().zip(current).skip(1).all(|(u, i)| (u + 2.0 * i).abs() < 1e-9));
}

/// Replaced text, replacement, and parts of the message.
const REFUSED: &[(&str, &str, &[&str])] = &[
    ("resistance = 1.0", "resistance = 0.0", &["scene.toml:7:", "`resistance` is 0", "Ω"]),
    ("resistance = 1.0", "resistance = nan", &["scene.toml:7:", "`resistance` is not a number"]),
    ("resistance = 1.0, ", "", &["`resistance` is missing: mode `voltage` needs it", "[Ω]"]),
    ("torque_constant = 0.05, ", "", &["`torque_constant` is missing: mode `voltage` needs it"]),
    ("inductance = 0.01", "inductance = -0.01", &["`inductance` is -0.01"]),
    ("inductance = 0.01", "inductance_mh = 0.01", &["inductance_mh"]),
    ("gear_ratio = 10.0", "gear_ratio = inf", &["`gear_ratio`"]),
    ("max_voltage = 12.0", "max_torque = 12.0", &["`max_torque` has no meaning for a motor in mode `voltage`"]),
    ("\"voltage\", command", "\"torque\", command", &["`resistance` has no meaning for a motor in mode `torque`"]),
    ("rotor_inertia = 5e-5", "efficiency = 0.8", &["efficiency"]),
];

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    for (from, to, expected) in REFUSED {
        let folder = SceneFolder::of(SCENE, EXPERIMENT);
        folder.change("scene.toml", from, to);
        let message = folder.load(&[]).err().unwrap_or_else(|| panic!("{to} is not refused"));
        for part in *expected {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
}
