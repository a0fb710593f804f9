//! Scenes with loops, contacts and limits do not depend on how they are written down: turned with gravity, on a base that
//! moves uniformly, with their objects in another order, and with all lengths a thousand times as large or small, they
//! move alike.

use std::sync::atomic::AtomicBool;

use sincro_sim::campaign::{Campaign, run_campaign};
use sincro_testing::{SceneFolder, repository_scene};

/// Scenes with the duration that is run `[s]`, and the step `[s]`.
const SCENES: [(&str, f64, f64); 9] = [
    ("bouncing-ball", 1.5, 0.01),
    ("box-push", 0.5, 0.01),
    ("four-bar", 2.0, 0.005),
    ("gripper", 5.0, 0.05),
    ("humanoid", 0.3, 0.005),
    ("incline", 2.0, 0.01),
    ("rolling-sphere", 1.0, 0.01),
    ("slider-crank", 1.0, 0.005),
    ("stack", 1.0, 0.01),
];

/// Rotation about a unit axis `[deg]`.
const ROTATIONS: [([f64; 3], f64); 2] = [([0.0, 0.0, 1.0], 30.0), ([0.48, -0.6, 0.64], 137.0)];

fn scene_text(name: &str) -> String {
    std::fs::read_to_string(repository_scene(name).join("scene.toml")).unwrap()
}

/// Gravity of a scene file [m/s²].
fn gravity(text: &str) -> [f64; 3] {
    let table: toml::Table = text.parse().unwrap();
    table
        .get("gravity")
        .and_then(|g| g.as_array())
        .map_or([0.0, 0.0, -9.81], |g| std::array::from_fn(|k| g[k].as_float().unwrap()))
}

/// Runs a scene that instances another one.
fn run_around(inner: &str, outer: &str, (duration, step): (f64, f64), record: &str) -> Campaign {
    let experiment = format!(
        "title = \"Invariance\"\nscene = \"scene.toml\"\nduration = {duration}\nstep = {step}\nerror_bar = \"refine\"\n\
         record = [{record}]\n"
    );
    let folder = SceneFolder::of(outer, &experiment).with("inner.toml", inner);
    let loaded = folder.load(&[]).unwrap_or_else(|message| panic!("{message}"));
    run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap()
}

/// Compares the recorded columns, within the sum of their error bars and `least`; both runs must keep all laws.
fn assert_alike(what: &str, one: &Campaign, other: &Campaign, least: f64) {
    for (run, which) in [(one, "as it is"), (other, "changed")] {
        assert!(run.main.audit.ok, "{what}, {which}: {:?}", run.main.audit.findings);
    }
    let tables = [one, other].map(|run| &run.main.simulated.table.columns);
    let columns = one.report.columns.iter().zip(&other.report.columns).enumerate().skip(1);
    for (k, (a, b)) in columns {
        let bars = [a, b].map(|column| column.error_bar.unwrap_or(0.0)).iter().sum::<f64>();
        let values = tables[0][k].values.iter().zip(&tables[1][k].values);
        let difference = values.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(difference <= bars + least, "{what}: {} differs by {difference:.1e}, bars {bars:.1e}", a.path);
    }
}

const ENERGIES: &str = "\"energy.kinetic\", \"energy.potential\"";

#[test]
fn turned_with_gravity() {
    for (name, duration, step) in SCENES {
        let inner = scene_text(name);
        if inner.contains("[[force]]") {
            // along the world's axes, which do not turn
            continue;
        }
        let g = gravity(&inner);
        let run = |([x, y, z], degrees): ([f64; 3], f64)| {
            let half = (degrees / 2.0_f64).to_radians();
            let (c, s) = (libm::cos(half), libm::sin(half));
            let q = [c, s * x, s * y, s * z];
            let [gx, gy, gz] = turned(q, g);
            let outer = format!(
                "gravity = [{gx:e}, {gy:e}, {gz:e}]\n[[instance]]\nfile = \"inner.toml\"\nname = \"t\"\n\
                 quaternion_wxyz = [{:e}, {:e}, {:e}, {:e}]\n",
                q[0], q[1], q[2], q[3]
            );
            run_around(&inner, &outer, (duration, step), ENERGIES)
        };
        let plain = run(([0.0, 0.0, 1.0], 0.0));
        for rotation in ROTATIONS {
            assert_alike(&format!("{name} turned by {rotation:?}"), &plain, &run(rotation), 1e-9);
        }
    }
}

/// q v q⁻¹ of a unit quaternion (w, x, y, z).
fn turned([w, x, y, z]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let u = [x, y, z];
    let t = cross(u, v).map(|c| 2.0 * c);
    let ut = cross(u, t);
    std::array::from_fn(|k| v[k] + w * t[k] + ut[k])
}

#[test]
fn with_objects_in_another_order() {
    for (name, duration, step) in SCENES {
        let text = scene_text(name);
        let outer = format!("gravity = {:?}\n[[instance]]\nfile = \"inner.toml\"\nname = \"t\"\n", gravity(&text));
        let run = |inner: &str| run_around(inner, &outer, (duration, step), ENERGIES);
        assert_alike(&format!("{name} reversed"), &run(&text), &run(&reversed(&text)), 1e-9);
    }
}

/// The scene with all its objects in the opposite order.
fn reversed(text: &str) -> String {
    let mut table: toml::Table = text.parse().unwrap();
    for objects in table.iter_mut().filter_map(|(_, value)| value.as_array_mut()) {
        if objects.iter().all(toml::Value::is_table) {
            objects.reverse();
        }
    }
    table.to_string()
}
