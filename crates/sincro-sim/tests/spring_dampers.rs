//! Springs, dampers and actuators between two points in scene files: what is recorded, commanded and linearised, what
//! is refused.

use sincro_scene::record::Recorder;
use sincro_sim::Loaded;
use sincro_sim::run::{LockStep, method_for};
use sincro_testing::{SceneFolder, run};

const SCENE: &str = r#"gravity = [0.0, 0.0, 0.0]

[[joint]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
initial = { position = 2.0 }

[[body]]
name = "cart"
parent = "/rail"
mass = 2.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }

[[spring_damper]]
name = "spring"
between = ["/", "cart"]
points = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]
stiffness = 50.0
damping = 3.0
actuator = { command = 12.0, max_force = 10.0 }
"#;

const EXPERIMENT: &str = r#"title = "Cart"
duration = 1.0
step = 0.01
record = ["/rail.position", "/spring.length", "/spring.rate", "/spring.force", "/spring.command", "energy.balance"]
"#;

fn folder() -> SceneFolder {
    SceneFolder::of(SCENE, EXPERIMENT)
}

fn row(loaded: &Loaded, n: u32) -> Vec<f64> {
    let mut lockstep = LockStep::new(loaded, method_for(loaded).0, false);
    lockstep.start().unwrap();
    (0..n).for_each(|_| lockstep.advance().unwrap());
    let signals = loaded.controller.as_ref().map(|c| c.entries()).unwrap_or_default();
    let mut recorder = Recorder::new(&loaded.experiment.record, &loaded.scene.model, &signals).unwrap();
    let t = lockstep.t();
    let (seen, signals) = lockstep.observe(t);
    recorder.row(&seen, signals, t, true)[1..].to_vec()
}

#[test]
fn the_free_length_is_that_at_the_start_and_the_actuator_is_limited() {
    let loaded = folder().load(&[]).unwrap();
    let [position, length, rate, force, _, _] = row(&loaded, 0)[..] else { panic!() };
    assert_eq!((position, length, rate, force), (2.0, 2.5, 0.0, 0.0));
    let [_, length, rate, force, command, _] = row(&loaded, 1)[..] else { panic!() };
    assert_eq!((command, force), (12.0, -50.0 * (length - 2.5) - 3.0 * rate + 10.0));
    let simulated = run(&loaded);
    let column = |name: &str| &simulated.table.columns.iter().find(|c| c.name == name).unwrap().values;
    assert!(column("energy.balance").iter().all(|e| e.abs() < 1e-8));
    let [x, length] = ["/rail.position", "/spring.length"].map(|name| column(name).last().unwrap());
    assert!((length - x - 0.5).abs() < 1e-12 && *x > 2.1);
}

#[test]
fn settings_reach_its_numbers() {
    let folder = folder();
    // deflection from 2.0 m, rate, and the force beside that of stiffness and damping
    let added = |set: &[&str]| {
        let settings: Vec<&str> = [&["/spring.free_length=2.0"], set].concat();
        let [_, length, rate, force, ..] = row(&folder.load(&settings).unwrap(), 1)[..] else { panic!() };
        (length - 2.0, rate, force + 50.0 * (length - 2.0) + 3.0 * rate)
    };
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    close(added(&["spring.actuator.command=-4"]).2, -4.0);
    close(added(&["/spring.preload=1.5", "/spring.actuator.max_force=2"]).2, 3.5);
    let (x, v, force) = added(&["/spring.law=-x^2 - v", "/spring.actuator.command=0"]);
    close(force, -x * x - v);
    let (x, _, force) = added(&["/spring.table=[[0.0, 0.0], [1.0, -8.0]]", "/spring.actuator.command=0"]);
    close(force, -8.0 * x);
    let slack = ["/spring.free_length=3.0", "/spring.tension_only=true", "/spring.actuator.command=0"];
    assert_eq!(row(&folder.load(&slack).unwrap(), 1)[3], 0.0);
}

#[test]
fn a_diagram_commands_it_and_measures_it() {
    let folder = folder();
    let diagram = r#"
wires = ["/spring.length -> away", "away -> /spring"]

[[block]]
name = "away"
type = "gain"
gain = -2.0
"#;
    folder.write("diagram.toml", diagram);
    folder.change("experiment.toml", "record = [", "diagram = \"diagram.toml\"\nrecord = [\"away\", ");
    folder.change("scene.toml", "command = 12.0, ", "");
    let values = row(&folder.load(&[]).unwrap(), 3);
    assert!(values[0] < -4.5 && values[5] == values[0], "{values:?}");
}

#[test]
fn an_instance_brings_its_own() {
    let outer =
        "[[instance]]\nfile = \"inner.toml\"\nname = \"unit\"\nrepeat = { count = 2, step = [0.0, 3.0, 0.0] }\n";
    let folder =
        SceneFolder::of(outer, &EXPERIMENT.replace("/rail", "/unit1/rail").replace("/spring", "/unit1-spring"));
    folder.write("inner.toml", SCENE);
    let values = row(&folder.load(&[]).unwrap(), 1);
    assert!(values[1] > 2.5 && (values[4] - 12.0).abs() < 1e-15, "{values:?}");
}

/// Replaced text, replacement, and parts of the message.
const REFUSED: &[(&str, &str, &[&str])] = &[
    ("stiffness = 50.0", "stiffness = -1.0", &["scene.toml:", "stiffness", "-1"]),
    ("damping = 3.0", "damping = 3.0\nlaw = \"-k*x\"", &["law of spring_damper `spring`", "`k`"]),
    (
        "damping = 3.0",
        "damping = 3.0\ntable = [[1.0, 0.0], [0.5, 2.0]]",
        &["table of spring_damper `spring`", "increase"],
    ),
    ("between = [\"/\", \"cart\"]", "between = [\"/\", \"card\"]", &["there is no object `card`", "/rail/cart"]),
    ("between = [\"/\", \"cart\"]", "between = [\"/\", \"/\"]", &["both ends of spring_damper `/spring`"]),
    ("between = [\"/\", \"cart\"]", "between = [\"/\", \"/rail\"]", &["is a prismatic joint, not a body or frame"]),
    ("name = \"spring\"", "name = \"rail\"", &["there are two objects `/rail`"]),
    (
        "points = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]",
        "points = [[2.5, 0.0, 0.0], [0.5, 0.0, 0.0]]",
        &["coincide at the start"],
    ),
    (
        "stiffness = 50.0\ndamping = 3.0\nactuator = { command = 12.0, max_force = 10.0 }",
        "tension_only = true",
        &["spring_damper `spring` has no force"],
    ),
    ("damping = 3.0", "tension_only = true\npreload = 1.0", &["its preload 1 N pushes", "tension_only"]),
];

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    for (from, to, expected) in REFUSED {
        let folder = folder();
        folder.change("scene.toml", from, to);
        let message = folder.load(&[]).err().unwrap_or_else(|| panic!("{to} is not refused"));
        for part in *expected {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
}
