//! Scenes with loops, contacts and limits do not depend on how they are written down: turned with gravity, on a base
//! that moves uniformly, with their objects in another order, and with all lengths a thousand times as large or small,
//! they move alike.

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

/// Unit quaternions (w, x, y, z): a turn by 30° about z, one about no axis of a scene, and random ones.
fn rotations() -> Vec<[f64; 4]> {
    let draws = std::env::var("SINCRO_DRAWS").ok().and_then(|n| n.parse().ok()).unwrap_or(1);
    let mut seed = 3_u64;
    let mut number = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let random = (0..draws).map(|_| std::array::from_fn(|_| number()));
    let first = [about([0.0, 0.0, 1.0], 30.0), about([0.48, -0.6, 0.64], 137.0)];
    first
        .into_iter()
        .chain(random)
        .map(|q: [f64; 4]| {
            let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            q.map(|x| x / norm)
        })
        .collect()
}

/// Rotation about a unit axis by an angle `[deg]`.
fn about([x, y, z]: [f64; 3], degrees: f64) -> [f64; 4] {
    let half = (degrees / 2.0).to_radians();
    let (c, s) = (libm::cos(half), libm::sin(half));
    [c, s * x, s * y, s * z]
}

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
        let run = |q: [f64; 4]| {
            let [gx, gy, gz] = turned(q, g);
            let outer = format!(
                "gravity = [{gx:e}, {gy:e}, {gz:e}]\n[[instance]]\nfile = \"inner.toml\"\nname = \"t\"\n\
                 quaternion_wxyz = [{:e}, {:e}, {:e}, {:e}]\n",
                q[0], q[1], q[2], q[3]
            );
            run_around(&inner, &outer, (duration, step), ENERGIES)
        };
        let plain = run([1.0, 0.0, 0.0, 0.0]);
        for q in rotations() {
            assert_alike(&format!("{name} turned by {q:?}"), &plain, &run(q), 1e-9);
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

#[test]
fn on_a_base_that_moves_uniformly() {
    let cases = [
        ("four-bar", 2.0, 0.005, "\"/t/rod0.position\", \"/t/rod0.velocity\""),
        ("gripper", 5.0, 0.05, "\"/t/thing.position.z\", \"/t/left/pad.friction_force\""),
        ("slider-crank", 1.0, 0.005, "\"/t/slide.position\", \"/t/crank.motor_torque_now\""),
    ];
    for (name, duration, step, record) in cases {
        let inner = scene_text(name);
        let [x, y, z] = gravity(&inner);
        let run = |speed: f64| {
            let outer = format!(
                "gravity = [{x}, {y}, {z}]\n[[joint]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [0.48, -0.6, 0.64]\n\
                 initial = {{ velocity = {speed} }}\nmotor = {{ mode = \"velocity\", command = {speed} }}\n\
                 [[body]]\nname = \"base\"\nparent = \"/rail\"\ndensity = 500.0\nshape = [ {{ sphere = {{ radius = 0.05 }} }} ]\n\
                 [[instance]]\nfile = \"inner.toml\"\nname = \"t\"\nparent = \"/rail/base\"\n"
            );
            let record = record.replace("/t/", "/rail/base/t/");
            run_around(&inner, &outer, (duration, step), &record)
        };
        assert_alike(&format!("{name} on a base"), &run(0.0), &run(0.7), 1e-9);
    }
}

/// An arm with a limited motor, joint friction, a spring and a joint limit that drops its tip to the floor. All lengths
/// are in units of `s` metres, with the densities and the gravity as they are.
const ARM: &str = r#"
format = 2

[[body]]
name = "floor"
shape = [ { plane = {} } ]
contact = { friction = 0.4 }

[[joint]]
name = "shoulder"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = [0.0, 0.0, "0.35*s"]
initial = { position = -0.3 }
motor = { mode = "velocity", max_torque = "3.0*s^4", command = "0.5/sqrt(s)" }

[[body]]
name = "upper"
parent = "/shoulder"
density = 1000.0
shape = [ { cuboid = { size = ["0.4*s", "0.06*s", "0.06*s"] }, position = ["0.2*s", 0.0, 0.0] } ]

[[joint]]
name = "elbow"
parent = "/shoulder/upper"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = ["0.4*s", 0.0, 0.0]
friction = "0.02*s^4"
spring = { stiffness = "0.5*s^4", rest = 0.2 }
limits = { lower = -0.5, upper = 1.0 }

[[body]]
name = "lower"
parent = "/shoulder/upper/elbow"
density = 1000.0
shape = [
  { cuboid = { size = ["0.3*s", "0.05*s", "0.05*s"] }, position = ["0.15*s", 0.0, 0.0] },
  { sphere = { radius = "0.03*s" }, position = ["0.3*s", 0.0, 0.0] },
]
contact = { friction = 0.4 }
"#;

#[test]
fn with_lengths_a_thousand_times_as_large_or_small() {
    // times are as the root of lengths: angles at the same number of ticks are the same
    let run = |s: f64| {
        let time = s.sqrt();
        let experiment = format!(
            "title = \"Scaled\"\nscene = \"scene.toml\"\nduration = {:?}\nstep = {:?}\nerror_bar = \"refine\"\n\
             record = [\"/shoulder.position\", \"/shoulder/upper/elbow.position\"]\n[parameters]\ns = {s:?}\n",
            128.0 * 0.0078125 * time,
            0.0078125 * time
        );
        let folder = SceneFolder::of(ARM, &experiment);
        let loaded = folder.load(&[]).unwrap_or_else(|message| panic!("{message}"));
        run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap()
    };
    let plain = run(1.0);
    assert!(plain.main.simulated.statistics.impacts > 0, "it meets the floor or its limit");
    // 4^k: the root and the ticks are exact
    for (s, least) in [(1024.0, 1e-8), (1.0 / 1024.0, 1e-5)] {
        assert_alike(&format!("lengths in units of {s} m"), &plain, &run(s), least);
    }
}

/// Joint or other object that a number of a scene belongs to.
#[derive(Clone, Copy, PartialEq)]
enum Owner {
    Revolute,
    Free,
    /// A prismatic joint, and all that is no joint.
    Other,
}

/// Power of a length by which a number of a scene grows, by the path of its keys and its place in a list, where times
/// grow as the root of lengths and masses as their cube.
fn power(owner: Owner, mode: &str, path: &[&str], place: usize) -> f64 {
    let (coordinate, velocity, torque) = if owner == Owner::Revolute { (0.0, -0.5, 4.0) } else { (1.0, 0.5, 3.0) };
    match path {
        ["format" | "gravity"]
        | ["camera", ..]
        | [.., "axis" | "density" | "rotation_deg" | "quaternion_wxyz" | "restitution" | "group"]
        | [.., "contact", "friction"] => 0.0,
        // three lengths and a quaternion; angular velocity and velocity
        [.., "initial", "position"] if owner == Owner::Free => {
            if place < 3 {
                1.0
            } else {
                0.0
            }
        }
        [.., "initial", "velocity"] if owner == Owner::Free => {
            if place < 3 {
                -0.5
            } else {
                0.5
            }
        }
        [.., "initial", "position"] | [.., "limits", _] | [.., "spring", "rest"] => coordinate,
        [.., "initial", "velocity"] => velocity,
        [.., "motor", "command"] => {
            if mode == "torque" {
                torque
            } else {
                velocity
            }
        }
        [.., "spring", "stiffness"] => torque - coordinate,
        [.., "damping"] => torque - velocity,
        [.., "armature"] => torque - velocity + 0.5,
        [.., "max_torque"] => torque,
        [.., "inertia", _] => 5.0,
        [.., "mass"] => 3.0,
        [.., "position" | "size" | "radius" | "length" | "point" | "center_of_mass" | "from" | "to"] => 1.0,
        _ => panic!("power of a length of {path:?}"),
    }
}

/// Makes all lengths of a scene `s` times as large.
fn scale<'a>(value: &'a mut toml::Value, (owner, mode): (Owner, &str), path: &mut Vec<&'a str>, place: usize, s: f64) {
    match value {
        toml::Value::Table(table) => {
            let word = |key: &str| table.get(key).and_then(|x| x.as_str()).unwrap_or("").to_owned();
            let (kind, mode) = (word("kind"), word("mode"));
            let owner = match &*kind {
                "revolute" => Owner::Revolute,
                "free" => Owner::Free,
                "" => owner,
                _ => Owner::Other,
            };
            for (key, value) in table.iter_mut() {
                path.push(key);
                scale(value, (owner, &mode), path, 0, s);
                path.pop();
            }
        }
        toml::Value::Array(list) => {
            for (place, x) in list.iter_mut().enumerate() {
                scale(x, (owner, mode), path, place, s);
            }
        }
        toml::Value::Integer(_) | toml::Value::Float(_) => {
            let x = value.as_float().or(value.as_integer().map(|x| x as f64)).expect("a number");
            let power = power(owner, mode, path, place);
            if power != 0.0 {
                *value = toml::Value::Float(x * libm::pow(s, power));
            }
        }
        _ => {}
    }
}

#[test]
fn scenes_with_lengths_a_thousand_times_as_large_or_small() {
    for (name, duration, step) in SCENES {
        let text = scene_text(name);
        if text.contains("[[force]]") {
            // as in `turned_with_gravity`: its forces are signals
            continue;
        }
        let run = |s: f64| {
            let mut scene = toml::Value::Table(text.parse().unwrap());
            scale(&mut scene, (Owner::Other, ""), &mut Vec::new(), 0, s);
            let table = scene.as_table_mut().unwrap();
            table.insert("rest_speed".into(), (1e-3 * s.sqrt()).into());
            let outer = "[[instance]]\nfile = \"inner.toml\"\nname = \"t\"\n";
            let (mut inner, mut of_world) = (table.clone(), String::new());
            for key in ["gravity", "rest_speed"] {
                if let Some(x) = inner.remove(key) {
                    of_world += &format!("{key} = {x}\n");
                }
            }
            let times = (duration * s.sqrt(), step * s.sqrt());
            run_around(&toml::to_string(&inner).unwrap(), &(of_world + outer), times, ENERGIES)
        };
        let plain = run(1.0);
        // 4^k: the roots are exact
        for s in [1024.0_f64, 1.0 / 1024.0] {
            let scaled = run(s);
            for which in [&plain, &scaled] {
                assert!(which.main.audit.ok, "{name}, {s}: {:?}", which.main.audit.findings);
            }
            let energies = |run: &Campaign, k: usize| run.main.simulated.table.columns[k].values.clone();
            for k in 1..3 {
                let (one, other) = (energies(&plain, k), energies(&scaled, k));
                let unit = s.powi(4);
                let largest = one.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
                let apart = one.iter().zip(&other).map(|(x, y)| (x - y / unit).abs()).fold(0.0, f64::max);
                let bar = |run: &Campaign| run.report.columns[k].error_bar.unwrap_or(0.0);
                let bars = bar(&plain) + bar(&scaled) / unit;
                let what = ["energy.kinetic", "energy.potential"][k - 1];
                // rounding of energies that are sums of larger ones
                let rounding = 1e-12 * largest + 1e-13;
                assert!(apart <= bars + rounding, "{name}, {s}: {what} differs by {apart:.1e}, bars {bars:.1e}");
            }
        }
    }
}
