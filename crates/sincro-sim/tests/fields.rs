//! Gravity and density of the air over the position in scene files: what is recorded, what is refused.

use sincro_testing::{SceneFolder, run};

const SCENE: &str = r#"gravity = { acceleration = ["-x/(x^2 + y^2 + z^2)^1.5", "-y/(x^2 + y^2 + z^2)^1.5", "0"], potential = "-1/sqrt(x^2 + y^2 + z^2)" }
air_density = { formula = "1.225*exp(-z/8500)" }

[[joint]]
name = "orbit"
kind = "free"
initial = { position = [0.7, 0, 0, 1, 0, 0, 0], velocity = [0, 0, 0, 0, 1.3627702877384937, 0] }

[[body]]
name = "ball"
parent = "/orbit"
mass = 2.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[sensor]]
name = "imu"
parent = "/orbit/ball"
sample_time = 0.01
imu = {}
"#;

const EXPERIMENT: &str = r#"title = "Orbit"
duration = 6.28
step = 0.01
accuracy = 1e-12
record = ["/orbit.position.x", "/orbit.position.y", "energy.balance", "energy.work", "energy.total", "/orbit/ball/imu.accelerometer.x"]
"#;

fn folder() -> SceneFolder {
    SceneFolder::of(SCENE, EXPERIMENT)
}

#[test]
fn an_orbit_is_recorded_with_its_energy_and_weightlessness() {
    let simulated = run(&folder().load(&[]).unwrap());
    let column = |name: &str| &simulated.table.columns.iter().find(|c| c.name == name).unwrap().values;
    assert!(column("energy.balance").iter().all(|e| e.abs() < 1e-9));
    assert!(column("energy.work").iter().all(|e| e.abs() < 1e-12));
    // −m μ/2a
    assert!(column("energy.total").iter().all(|e| (e + 1.0).abs() < 1e-9));
    let (x, y) = (column("/orbit.position.x"), column("/orbit.position.y"));
    let nearest = x.iter().zip(y).map(|(x, y)| x.hypot(*y)).fold(f64::INFINITY, f64::min);
    assert!((nearest - 0.7).abs() < 1e-6);
    assert!(column("/orbit/ball/imu.accelerometer.x").iter().all(|a| a.abs() < 1e-9));
}

#[test]
fn without_a_potential_gravity_does_work() {
    let folder = folder();
    folder.change("scene.toml", ", potential = \"-1/sqrt(x^2 + y^2 + z^2)\"", "");
    let simulated = run(&folder.load(&[]).unwrap());
    let column = |name: &str| &simulated.table.columns.iter().find(|c| c.name == name).unwrap().values;
    assert!(column("energy.balance").iter().all(|e| e.abs() < 1e-9));
    assert!(column("energy.work").iter().any(|e| e.abs() > 0.1));
}

/// Replaced text, replacement, and parts of the message.
const REFUSED: &[(&str, &str, &[&str])] = &[
    ("\"0\"]", "\"k*z\"]", &["scene.toml:1:", "formula `k*z`", "`k`"]),
    ("\"0\"]", "\"1/z\"]", &["gravity at `/orbit/ball`, which starts at [0.7, 0.0, 0.0], is inf"]),
    ("\"0\"], ", "\"0\", \"0\"], ", &["`acceleration` has 4 entries, expected"]),
    ("\"0\"], ", "0.0], ", &["acceleration[2]"]),
    ("potential = \"-1/", "potential = \"1/", &["the potential does not fit the acceleration: at `/orbit/ball`"]),
    ("potential = ", "potental = ", &["unknown key `potental`"]),
    ("formula = \"1.225*exp(-z/8500)\"", "formula = \"1.225*exp(-h/8500)\"", &["scene.toml:2:", "`h`"]),
    ("air_density = { formula = \"1.225*exp(-z/8500)\" }", "air_density = -1", &["`air_density` is -1"]),
    (
        "gravity = { acceleration = [\"-x/(x^2 + y^2 + z^2)^1.5\", \"-y/(x^2 + y^2 + z^2)^1.5\", \"0\"], potential = \"-1/sqrt(x^2 + y^2 + z^2)\" }",
        "gravity = nan",
        &["`gravity`"],
    ),
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
    let folder = folder();
    let drag = "[[drag]]\nname = \"sail\"\nparent = \"/orbit/ball\"\narea = [1.0, 1.0, 1.0]\n";
    folder.change("scene.toml", "[[sensor]]", &format!("{drag}\n[[sensor]]"));
    folder.change("scene.toml", "1.225*exp(-z/8500)", "x - 1");
    let message = folder.load(&[]).err().unwrap();
    assert!(message.contains("density of the air at the start of `/orbit/ball/sail` is -0.3"), "{message}");
}
