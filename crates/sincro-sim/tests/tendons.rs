//! Tendons in scene files: against elements that do the same, against their equations, and what is refused.

use sincro_sim::Loaded;
use sincro_sim::replay::SceneView;
use sincro_testing::{SceneFolder, run};

/// Three carts on rails along x, y and z; masses 1, 2 and 3 kg.
const CARTS: &str = r#"gravity = [0.0, 0.0, -9.81]

[[joint]]
name = "x"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
initial = { position = 0.4, velocity = 0.3 }

[[body]]
name = "one"
parent = "/x"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }

[[joint]]
name = "y"
kind = "prismatic"
axis = [0.0, 1.0, 0.0]
position = [0.0, 0.0, 1.0]
initial = { position = 0.3, velocity = -0.5 }

[[body]]
name = "two"
parent = "/y"
mass = 2.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }

[[joint]]
name = "z"
kind = "prismatic"
axis = [0.0, 0.0, 1.0]
position = [1.0, 0.5, 0.0]
initial = { position = -0.2 }

[[body]]
name = "three"
parent = "/z"
mass = 3.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }

[[frame]]
name = "eyelet"
position = [0.5, 0.5, 0.5]
"#;

const EXPERIMENT: &str = r#"title = "Tendon"
duration = 1.5
step = 0.01
record = ["/x.position", "/y.position", "/z.position", "/t.length", "/t.rate", "/t.force", "energy.balance"]
"#;

fn scene(tendon: &str) -> SceneFolder {
    SceneFolder::of(&format!("{CARTS}\n{tendon}"), EXPERIMENT)
}

/// Recorded signals, in their order.
fn columns(loaded: &Loaded) -> Vec<Vec<f64>> {
    run(loaded).table.columns[1..].iter().map(|c| c.values.clone()).collect()
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

const SPATIAL: &str = r#"
[[tendon]]
name = "t"
through = ["one", "/eyelet", "two", "three"]
stiffness = 40.0
damping = 0.7
free_length = 1.2
actuator = { command = -6.0, max_force = 4.0 }
"#;

#[test]
fn a_line_between_two_bodies_is_a_spring_damper_bit_by_bit() {
    let keys = "stiffness = 40.0\ndamping = 0.7\ntension_only = true\nactuator = { command = -2.0 }\n";
    let tendon = scene(&format!("[[tendon]]\nname = \"t\"\nthrough = [\"one\", \"two\"]\n{keys}"));
    let spring = scene(&format!("[[spring_damper]]\nname = \"t\"\nbetween = [\"one\", \"two\"]\n{keys}"));
    for integrator in ["auto", "rk4", "implicit", "semi-implicit-euler"] {
        let setting = format!("integrator={integrator}");
        let of = |folder: &SceneFolder| columns(&folder.load(&[&setting]).unwrap());
        assert_eq!(of(&tendon), of(&spring), "{integrator}");
    }
}

#[test]
fn a_combination_of_two_joints_is_an_elastic_coupling() {
    let tendon = scene(
        "[[tendon]]\nname = \"t\"\njoints = [\"y\", \"x\"]\ncoefficients = [1.0, -0.5]\nfree_length = 0.05\nstiffness = 80.0\ndamping = 0.4\n",
    );
    let coupling = scene(
        "[[coupling]]\nname = \"t\"\njoints = [\"x\", \"y\"]\nratio = 0.5\noffset = 0.05\nstiffness = 80.0\ndamping = 0.4\n",
    );
    coupling.change("experiment.toml", "\"/t.length\", \"/t.rate\", \"/t.force\"", "\"/t.mesh_error\", \"/t.torque\"");
    for integrator in ["auto", "implicit", "semi-implicit-euler"] {
        let setting = format!("integrator={integrator}");
        let [a, b] = [&tendon, &coupling].map(|folder| columns(&folder.load(&[&setting]).unwrap()));
        for k in 0..3 {
            assert!(worst(&a[k], &b[k]) < 1e-12, "{integrator}");
        }
        let length: Vec<f64> = b[3].iter().map(|error| error + 0.05).collect();
        assert!(worst(&a[3], &length) < 1e-12 && worst(&a[5], &b[4]) < 1e-11, "{integrator}");
    }
}

/// Signals of [`SPATIAL`] from the positions and rates of the carts.
fn spatial(q: [f64; 3], v: [f64; 3]) -> (f64, f64, [f64; 3]) {
    let points = [[q[0], 0.0, 0.0], [0.5; 3], [0.0, q[1], 1.0], [1.0, 0.5, q[2]]];
    let slopes = [[1.0, 0.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let owners = [Some(0), None, Some(1), Some(2)];
    let (mut length, mut gradient) = (0.0, [0.0; 3]);
    for s in 0..3 {
        let apart: [f64; 3] = std::array::from_fn(|k| points[s + 1][k] - points[s][k]);
        let distance = apart.iter().map(|x| x * x).sum::<f64>().sqrt();
        length += distance;
        for (end, sign) in [(s, -1.0), (s + 1, 1.0)] {
            if let Some(owner) = owners[end] {
                gradient[owner] += (0..3).map(|k| sign * apart[k] * slopes[end][k]).sum::<f64>() / distance;
            }
        }
    }
    (length, (0..3).map(|k| gradient[k] * v[k]).sum(), gradient)
}

#[test]
fn a_path_through_several_bodies_follows_its_equations() {
    let loaded = scene(SPATIAL).load(&["accuracy=1e-11"]).unwrap();
    let found = columns(&loaded);
    // the equations by a method of their own
    let masses = [1.0, 2.0, 3.0];
    let slope = |q: [f64; 3], v: [f64; 3]| -> [f64; 3] {
        let (length, rate, gradient) = spatial(q, v);
        let force = -40.0 * (length - 1.2) - 0.7 * rate - 4.0;
        std::array::from_fn(|k| force * gradient[k] / masses[k] - if k == 2 { 9.81 } else { 0.0 })
    };
    let (mut q, mut v) = ([0.4, 0.3, -0.2], [0.3, -0.5, 0.0]);
    let h = 1e-4;
    let move_by = |a: [f64; 3], b: [f64; 3], s: f64| -> [f64; 3] { std::array::from_fn(|k| a[k] + s * b[k]) };
    for row in 0..=150 {
        let (length, rate, _) = spatial(q, v);
        for k in 0..3 {
            assert!((found[k][row] - q[k]).abs() < 1e-9, "row {row}, coordinate {k}: {} {}", found[k][row], q[k]);
        }
        assert!((found[3][row] - length).abs() < 1e-9 && (found[4][row] - rate).abs() < 1e-8, "row {row}");
        assert!(found[6][row].abs() < 1e-8, "row {row}: {} J", found[6][row]);
        for _ in 0..100 {
            let k1 = (v, slope(q, v));
            let k2 = (move_by(v, k1.1, h / 2.0), slope(move_by(q, k1.0, h / 2.0), move_by(v, k1.1, h / 2.0)));
            let k3 = (move_by(v, k2.1, h / 2.0), slope(move_by(q, k2.0, h / 2.0), move_by(v, k2.1, h / 2.0)));
            let k4 = (move_by(v, k3.1, h), slope(move_by(q, k3.0, h), move_by(v, k3.1, h)));
            let mean = |a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]| -> [f64; 3] {
                std::array::from_fn(|k| (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]) / 6.0)
            };
            q = move_by(q, mean(k1.0, k2.0, k3.0, k4.0), h);
            v = move_by(v, mean(k1.1, k2.1, k3.1, k4.1), h);
        }
    }
    converges(SPATIAL, &found);
}

/// Linearly implicit methods converge to a motion: by their order, with smaller steps.
fn converges(tendon: &str, exact: &[Vec<f64>]) {
    for (integrator, order) in [("implicit", 2), ("semi-implicit-euler", 1)] {
        let error = |step: &str| {
            let found = columns(&scene(tendon).load(&[&format!("integrator={integrator}"), step]).unwrap());
            let last = |list: &[Vec<f64>], k: usize| *list[k].last().unwrap();
            (0..3).map(|k| (last(&found, k) - last(exact, k)).abs()).fold(0.0, f64::max)
        };
        let [coarse, fine] = ["step=0.002", "step=0.0005"].map(error);
        let gain = coarse / fine;
        let expected = f64::from(4_u32.pow(order));
        assert!((gain / expected - 1.0).abs() < 0.2 && coarse < 0.02, "{integrator}: {coarse:e}, {gain}");
    }
}

#[test]
fn elastic_couplings_stand_beside_paths() {
    let gear = "[[coupling]]\nname = \"gear\"\njoints = [\"x\", \"y\"]\nratio = 0.5\nstiffness = 25.0\ndamping = 0.3\n";
    let both = format!("{SPATIAL}\n{gear}");
    let exact = columns(&scene(&both).load(&["accuracy=1e-11"]).unwrap());
    assert!(exact[6].iter().all(|balance| balance.abs() < 1e-8));
    converges(&both, &exact);
}

#[test]
fn three_joints_share_a_force_by_their_coefficients() {
    let tendon = "[[tendon]]\nname = \"t\"\njoints = [\"x\", \"y\", \"z\"]\ncoefficients = [1.0, -2.0, 0.5]\nstiffness = 30.0\ndamping = 1.0\nfree_length = -0.4\n";
    let explicit = columns(&scene(tendon).load(&["accuracy=1e-11"]).unwrap());
    let length = |row: usize| explicit[0][row] - 2.0 * explicit[1][row] + 0.5 * explicit[2][row];
    for row in 0..=150 {
        assert!((explicit[3][row] - length(row)).abs() < 1e-12);
        let force = -30.0 * (explicit[3][row] + 0.4) - explicit[4][row];
        assert!((explicit[5][row] - force).abs() < 1e-11 && explicit[6][row].abs() < 1e-8);
    }
    // one degree of freedom: m ℓ̈ = −k (ℓ − ℓ₀) − c ℓ̇ − 0.5 g with 1/m = Σ c²/m
    let inverse: f64 = 1.0 + 4.0 / 2.0 + 0.25 / 3.0;
    let (mut x, mut v) = (length(0), 0.3 + 1.0);
    let acceleration = |x: f64, v: f64| (-30.0 * (x + 0.4) - v) * inverse - 0.5 * 9.81;
    for _ in 0..15_000 {
        let h = 1e-4;
        let middle = (x + 0.5 * h * v, v + 0.5 * h * acceleration(x, v));
        (x, v) = (x + h * middle.1, v + h * acceleration(middle.0, middle.1));
    }
    assert!((explicit[3][150] - x).abs() < 1e-6, "{} {x}", explicit[3][150]);
    converges(tendon, &explicit);
}

#[test]
fn limits_and_a_range_of_free_lengths_push_back_only_beyond_them() {
    let tendon = "[[tendon]]\nname = \"t\"\njoints = [\"z\"]\ncoefficients = [1.0]\nfree_length = [-0.3, -0.1]\nstiffness = 50.0\nlimits = { lower = -0.6, stiffness = 5e4, damping = 40.0 }\n";
    let found = columns(&scene(tendon).load(&["accuracy=1e-11"]).unwrap());
    // without a damper all energy comes back
    let elastic = columns(&scene(tendon).load(&["accuracy=1e-11", "/t.limits.damping=0"]).unwrap());
    assert!(elastic[6].iter().all(|balance| balance.abs() < 1e-6) && elastic[3].iter().any(|x| *x < -0.6));
    let mut has_hit = false;
    for row in 0..=150 {
        let (x, v) = (found[3][row], found[4][row]);
        let spring = if x < -0.3 { -50.0 * (x + 0.3) } else { 50.0 * (-0.1 - x).min(0.0) };
        let stop = if x < -0.6 { (-5e4 * (x + 0.6) - 40.0 * v).max(0.0) } else { 0.0 };
        has_hit |= stop > 0.0;
        assert!(
            (found[5][row] - spring - stop).abs() < 1e-9 * (1.0 + stop),
            "{row}: {} {spring} {stop}",
            found[5][row]
        );
        assert!(x > -0.65, "{row}: {x}");
    }
    assert!(has_hit);
}

#[test]
fn settings_and_instances_reach_it() {
    let folder = scene(SPATIAL);
    let stiffer = columns(&folder.load(&["/t.stiffness=80", "t.actuator.command=0"]).unwrap());
    let plain = columns(&folder.load(&[]).unwrap());
    let force = |x: f64, v: f64| -80.0 * (x - 1.2) - 0.7 * v;
    assert!((1..=150).all(|row| (stiffer[5][row] - force(stiffer[3][row], stiffer[4][row])).abs() < 1e-10));
    let outer = "[[instance]]\nfile = \"inner.toml\"\nname = \"unit\"\nposition = [0.0, 0.0, 3.0]\n";
    let names = ["/x.", "/y.", "/z."]
        .iter()
        .fold(EXPERIMENT.to_owned(), |text, name| text.replace(&format!("\"{name}"), &format!("\"/unit{name}")));
    let folder = SceneFolder::of(outer, &names.replace("/t.", "/unit-t."));
    folder.write("inner.toml", &format!("{CARTS}\n{SPATIAL}"));
    let moved = columns(&folder.load(&["gravity=[0.0, 0.0, -9.81]"]).unwrap());
    for k in 0..6 {
        assert!(worst(&moved[k], &plain[k]) < 1e-8, "{k}");
    }
}

/// Tendons of both kinds, with names of joints as they stand in [`CARTS`].
const BOTH: &str = r#"
[[tendon]]
name = "t"
through = ["one", "/eyelet", "two", "three"]
free_length = 1.2
stiffness = 40.0
damping = 0.7
actuator = { command = -6.0, max_force = 4.0 }

[[tendon]]
name = "sum"
joints = ["x", "y", "z"]
coefficients = [1.0, -2.0, 0.5]
free_length = [-0.3, -0.1]
stiffness = 30.0
damping = 0.3
"#;

/// Methods, and how far motions by them may differ that are the same but for rounding: steps chosen by their error also
/// fall differently about the ends of the free range.
const METHODS: [(&str, f64); 3] =
    [("accuracy=1e-11", 1e-7), ("integrator=implicit", 1e-9), ("integrator=semi-implicit-euler", 1e-9)];

#[test]
fn a_turned_scene_moves_as_it_did() {
    // R = Rz·Ry·Rx of the instance takes gravity along
    let [roll, pitch, yaw] = [30.0_f64, -40.0, 70.0].map(|a| sincro_math::elementary::sin_cos(a.to_radians()));
    let down = [yaw.1 * pitch.0 * roll.1 + yaw.0 * roll.0, yaw.0 * pitch.0 * roll.1 - yaw.1 * roll.0, pitch.1 * roll.1];
    let gravity = format!("gravity=[{:?}, {:?}, {:?}]", -9.81 * down[0], -9.81 * down[1], -9.81 * down[2]);
    let outer = "[[instance]]\nfile = \"inner.toml\"\nname = \"unit\"\nposition = [0.3, -0.2, 1.0]\nrotation_deg = [30.0, -40.0, 70.0]\n";
    let names = ["/x.", "/y.", "/z."]
        .iter()
        .fold(EXPERIMENT.to_owned(), |text, name| text.replace(&format!("\"{name}"), &format!("\"/unit{name}")));
    let turned = SceneFolder::of(outer, &names.replace("/t.", "/unit-t."));
    turned.write("inner.toml", &format!("{CARTS}\n{BOTH}"));
    for (method, bound) in METHODS {
        let plain = columns(&scene(BOTH).load(&[method]).unwrap());
        let found = columns(&turned.load(&[&gravity, method]).unwrap());
        for k in 0..6 {
            assert!(worst(&found[k], &plain[k]) < bound, "{method}, {k}: {:e}", worst(&found[k], &plain[k]));
        }
    }
}

#[test]
fn the_order_of_points_joints_and_tendons_does_not_matter() {
    let (first, second) = BOTH.split_at(BOTH.rfind("[[tendon]]").unwrap());
    let reordered = format!("{second}\n{first}")
        .replace("\"one\", \"/eyelet\", \"two\", \"three\"", "\"three\", \"two\", \"/eyelet\", \"one\"")
        .replace("\"x\", \"y\", \"z\"", "\"z\", \"x\", \"y\"")
        .replace("1.0, -2.0, 0.5", "0.5, 1.0, -2.0");
    for (method, bound) in METHODS {
        let plain = columns(&scene(BOTH).load(&[method]).unwrap());
        let found = columns(&scene(&reordered).load(&[method]).unwrap());
        for k in 0..6 {
            assert!(worst(&found[k], &plain[k]) < bound, "{method}, {k}: {:e}", worst(&found[k], &plain[k]));
        }
    }
}

/// A scene with all lengths and forces, in the lines that hold them, times a factor.
fn scaled(text: &str, factor: f64) -> String {
    let has_lengths =
        |line: &str| ["gravity", "initial", "position", "free_length", "actuator"].iter().any(|k| line.starts_with(k));
    let number = |word: &str| word.parse::<f64>().map_or_else(|_| word.to_owned(), |x| format!("{:?}", factor * x));
    let line = |line: &str| match has_lengths(line) {
        true => line
            .split_inclusive([' ', '[', ']', ','])
            .map(|piece| {
                let word = piece.trim_end_matches([' ', '[', ']', ',']);
                number(word) + &piece[word.len()..]
            })
            .collect(),
        false => line.to_owned(),
    };
    text.lines().map(line).collect::<Vec<String>>().join("\n")
}

#[test]
fn lengths_that_are_scaled_scale_the_motion_and_the_forces() {
    for (method, bound) in METHODS {
        let plain = columns(&scene(BOTH).load(&[method]).unwrap());
        for factor in [4.0, 0.125] {
            let text = scaled(&format!("{CARTS}\n{BOTH}"), factor);
            let found = columns(&SceneFolder::of(&text, EXPERIMENT).load(&[method]).unwrap());
            for k in 0..6 {
                let expected: Vec<f64> = plain[k].iter().map(|x| factor * x).collect();
                let difference = worst(&found[k], &expected) / factor;
                assert!(difference < bound, "{method}, {factor}, {k}: {difference:e}");
            }
        }
    }
}

#[test]
fn the_viewer_gets_one_line_for_each() {
    let view = SceneView::new(&scene(BOTH).load(&[]).unwrap().scene);
    let of = |path: &str| -> Vec<_> { view.objects.iter().filter(|object| object.path == path).collect() };
    let (spatial, fixed) = (of("/t"), of("/sum"));
    assert_eq!((spatial.len(), fixed.len()), (1, 1));
    let movers: Vec<_> = spatial[0].line.iter().map(|(mover, _)| *mover).collect();
    assert_eq!(movers, [Some(0), None, Some(1), Some(2)]);
    assert_eq!(spatial[0].line[1].1, [0.5; 3]);
    assert!(fixed[0].line.is_empty() && fixed[0].kind == "tendon");
}

/// Replaced text, replacement, and parts of the message.
const REFUSED: &[(&str, &str, &[&str])] = &[
    ("through = [\"one\", \"/eyelet\", \"two\", \"three\"]", "", &["`t`", "through"]),
    ("\"three\"]", "\"thre\"]", &["there is no object `thre`"]),
    ("[\"one\", \"/eyelet\", \"two\", \"three\"]", "[\"one\"]", &["tendon `t`", "fewer than two points"]),
    ("[\"one\", \"/eyelet\", \"two\", \"three\"]", "[\"/\", \"/eyelet\"]", &["`/t`", "it moves nothing"]),
    ("\"three\"]", "\"three\"]\njoints = [\"x\"]\ncoefficients = [1.0]", &["scene.toml:", "through"]),
    (
        "through = [\"one\", \"/eyelet\", \"two\", \"three\"]",
        "joints = [\"x\"]\ncoefficients = [1.0, 2.0]",
        &["1 joints and 2 coefficients"],
    ),
    (
        "through = [\"one\", \"/eyelet\", \"two\", \"three\"]",
        "joints = [\"x\", \"one\"]\ncoefficients = [1.0, 2.0]",
        &["is a body, not a joint"],
    ),
    (
        "through = [\"one\", \"/eyelet\", \"two\", \"three\"]",
        "joints = [\"x\", \"x\"]\ncoefficients = [1.0, 2.0]",
        &["twice"],
    ),
    (
        "through = [\"one\", \"/eyelet\", \"two\", \"three\"]",
        "joints = [\"x\"]\ncoefficients = [0.0]",
        &["never changes"],
    ),
    ("stiffness = 40.0", "stiffness = -4.0", &["stiffness", "-4"]),
    ("free_length = 1.2", "free_length = [1.2, 1.0]", &["does not increase"]),
    ("free_length = 1.2", "free_length = [1.2]", &["1 numbers"]),
    ("free_length = 1.2", "free_length = 1.2\nlimits = { stiffness = 100.0 }", &["limits of tendon `t` are no range"]),
    ("free_length = 1.2", "limits = { upper = 2.0, stiffness = 100.0 }", &["without a free length"]),
    (
        "stiffness = 40.0\ndamping = 0.7\nfree_length = 1.2\nactuator = { command = -6.0, max_force = 4.0 }",
        "",
        &["tendon `t` has no force"],
    ),
    ("name = \"t\"", "name = \"x\"", &["there are two objects `/x`"]),
];

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    for (from, to, expected) in REFUSED {
        let folder = scene(SPATIAL);
        folder.change("scene.toml", from, to);
        let message = folder.load(&[]).err().unwrap_or_else(|| panic!("{to} is not refused"));
        for part in *expected {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
}
