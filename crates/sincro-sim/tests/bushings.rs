//! Bushings in scene files: what is recorded, set, copied by instances, refused.

use std::sync::atomic::AtomicBool;

use sincro_sim::Loaded;
use sincro_sim::campaign::run_campaign;
use sincro_testing::{SceneFolder, run};

const SCENE: &str = r#"gravity = [0.0, 0.0, 0.0]

[[frame]]
name = "seat"
position = [0.0, 0.0, 1.0]
rotation_deg = [0.0, 0.0, 90.0]

[[joint]]
name = "free"
kind = "free"
initial = { position = [0.2, 0.0, 1.0, 0.7071067811865476, 0.0, 0.0, 0.7071067811865476] }

[[body]]
name = "cab"
parent = "/free"
mass = 2.0
inertia = { xx = 0.1, yy = 0.2, zz = 0.3 }

[[bushing]]
name = "mount"
between = ["/seat", "cab"]
stiffness = [50.0, 72.0, 20.0]
damping = 1.0
rotational_stiffness = 5.0
rotational_damping = [0.1, 0.1, 0.2]
"#;

const EXPERIMENT: &str = r#"title = "Cab"
duration = 1.0
step = 0.01
record = ["/mount.deflection.y", "/mount.force.y", "/mount.rotation.z", "/mount.torque.z", "energy.balance"]
"#;

fn folder() -> SceneFolder {
    SceneFolder::of(SCENE, EXPERIMENT)
}

fn columns(loaded: &Loaded) -> Vec<Vec<f64>> {
    run(loaded).table.columns[1..].iter().map(|column| column.values.clone()).collect()
}

#[test]
fn its_deflection_and_force_are_in_the_axes_of_the_first_frame() {
    let found = columns(&folder().load(&[]).unwrap());
    // x of the world is −y of the seat, which is turned by a quarter
    assert!(
        (found[0][0] + 0.2).abs() < 1e-12 && (found[1][0] - 0.2 * 72.0).abs() < 1e-9,
        "{} {}",
        found[0][0],
        found[1][0]
    );
    // along y the cab is a damped oscillator of 6 rad/s
    let (decay, w) = (0.25, (36.0_f64 - 0.0625).sqrt());
    let expected = -0.2 * libm::exp(-decay) * (libm::cos(w) + decay / w * libm::sin(w));
    assert!((found[0].last().unwrap() - expected).abs() < 1e-6, "{:?} {expected}", found[0].last());
    assert!(found[2].iter().chain(&found[3]).all(|x| x.abs() < 1e-12));
    assert!(found[4].iter().all(|e| e.abs() < 1e-6));
}

#[test]
fn settings_reach_its_numbers_and_instances_bring_their_own() {
    let folder = folder();
    let found = columns(&folder.load(&["/mount.stiffness=30", "/mount.damping=[0, 0, 0]"]).unwrap());
    assert!((found[1][0] - 0.2 * 30.0).abs() < 1e-9);
    let outer =
        "[[instance]]\nfile = \"inner.toml\"\nname = \"unit\"\nrepeat = { count = 2, step = [0.0, 3.0, 0.0] }\n";
    let folder = SceneFolder::of(outer, &EXPERIMENT.replace("/mount", "/unit1-mount"));
    folder.write("inner.toml", SCENE);
    let found = columns(&folder.load(&[]).unwrap());
    assert!((found[1][0] - 0.2 * 72.0).abs() < 1e-9);
}

#[test]
fn swept_numbers_have_their_units() {
    let units = [
        ("stiffness", "N/m"),
        ("damping", "N·s/m"),
        ("rotational_stiffness", "N·m/rad"),
        ("rotational_damping", "N·m·s/rad"),
    ];
    for (key, unit) in units {
        let sweep = format!("{EXPERIMENT}[sweep]\nparameter = \"/mount.{key}\"\nvalues = [1.0, 2.0]\n");
        let folder = SceneFolder::of(SCENE, &sweep);
        let loaded = folder.load(&[]).unwrap_or_else(|found| panic!("{found}"));
        let campaign = run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap();
        assert_eq!(campaign.sweep.unwrap().0.unit, unit, "{key}");
    }
}

/// Replaced text, replacement, and parts of the message.
const REFUSED: &[(&str, &str, &[&str])] = &[
    ("damping = 1.0", "damping = -1.0", &["scene.toml:23", "damping -1 N·s/m of bushing `mount` is negative"]),
    (
        "[50.0, 72.0, 20.0]",
        "[50.0, 72.0]",
        &["stiffness of bushing `mount` has 2 numbers", "x, y and z of the first frame"],
    ),
    ("between = [\"/seat\", \"cab\"]", "between = [\"/seat\", \"cap\"]", &["there is no object `cap`", "/free/cab"]),
    ("between = [\"/seat\", \"cab\"]", "between = [\"/seat\", \"/\"]", &["both ends of bushing `/mount`"]),
    ("between = [\"/seat\", \"cab\"]", "between = [\"/seat\", \"/free\"]", &["is a free joint, not a body or frame"]),
    ("name = \"mount\"", "name = \"seat\"", &["there are two objects `/seat`"]),
    (
        "stiffness = [50.0, 72.0, 20.0]\ndamping = 1.0\nrotational_stiffness = 5.0\nrotational_damping = [0.1, 0.1, 0.2]",
        "",
        &["bushing `mount` has no force", "rotational_stiffness"],
    ),
    ("rotational_stiffness", "rotation_stiffness", &["unknown key `rotation_stiffness`", "rotational_stiffness"]),
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
