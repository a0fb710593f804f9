//! A torus as a shape in scene files: mass, contact, what is refused.

use sincro_testing::{SceneFolder, run};

const SCENE: &str = r#"[[body]]
name = "floor"
shape = [{ plane = {} }]
contact = { friction = 0.8 }

[[joint]]
name = "air"
kind = "free"
position = [0.0, 0.0, 0.345]
initial = { velocity = [0, 0, -2.0, 0.69, 0, 0] }

[[body]]
name = "wheel"
parent = "/air"
rotation_deg = [90.0, 0.0, 0.0]
density = 1000.0
shape = [{ torus = { major_radius = 0.32, tube_radius = 0.025 } }]
contact = { friction = 0.8 }
"#;

const EXPERIMENT: &str = r#"title = "Wheel"
duration = 1.0
step = 0.01
record = ["/air.position.x", "/air/wheel.center_of_mass.z", "/air/wheel.normal_force", "energy.kinetic", "energy.balance"]
"#;

#[test]
fn a_wheel_rolls_on_without_loss() {
    let folder = SceneFolder::of(SCENE, EXPERIMENT);
    // turning about y at −v/(R + ρ) in the axes of the joint
    folder.change("scene.toml", "[0, 0, -2.0, 0.69, 0, 0]", "[0, 2.0, 0, 0.69, 0, 0]");
    let simulated = run(&folder.load(&[]).unwrap());
    let column = |name: &str| &simulated.table.columns.iter().find(|c| c.name == name).unwrap().values;
    let (x, z) = (column("/air.position.x"), column("/air/wheel.center_of_mass.z"));
    assert!((x.last().unwrap() - 0.69).abs() < 1e-8, "{:?}", x.last());
    assert!(z.iter().all(|z| (z - 0.345).abs() < 1e-10));
    let mass = 1000.0 * 2.0 * std::f64::consts::PI.powi(2) * 0.32 * 0.025 * 0.025;
    assert!((column("/air/wheel.normal_force")[50] / (mass * 9.81) - 1.0).abs() < 1e-8);
    // about its axis m (R² + ¾ ρ²)
    let axial = mass * (0.32 * 0.32 + 0.75 * 0.025 * 0.025);
    let energy = 0.5 * mass * 0.69 * 0.69 + 0.5 * axial * 4.0;
    assert!((column("energy.kinetic")[0] / energy - 1.0).abs() < 1e-12);
    assert!(column("energy.balance").iter().all(|e| e.abs() < 1e-9));
}

/// Replaced text, replacement, and parts of the message.
const REFUSED: &[(&str, &str, &[&str])] = &[
    ("tube_radius = 0.025", "tube_radius = 0.4", &["the tube of the torus is wider, 0.4, than its circle, 0.32"]),
    ("tube_radius = 0.025", "tube_radius = -0.1", &["`tube_radius` is -0.1", "greater than 0"]),
    ("major_radius = 0.32", "major_radius = nan", &["`major_radius` is not a number"]),
    ("major_radius = 0.32, ", "", &["`major_radius` is missing"]),
    ("tube_radius", "radius", &["unknown key `radius`"]),
];

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    for (from, to, expected) in REFUSED {
        let folder = SceneFolder::of(SCENE, EXPERIMENT);
        folder.change("scene.toml", from, to);
        let message = folder.load(&[]).err().unwrap_or_else(|| panic!("{to} is not refused"));
        assert!(message.starts_with("scene.toml:17:"), "{message}");
        for part in *expected {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
}
