//! Proximity sensors of scenes: what they see, of which bodies, how often and how wrong; and what is refused.

use sincro_sim::run::Simulated;
use sincro_testing::SceneFolder;

/// A sledge that goes 0.5 m/s along x, with an arm that hangs before its sensor; a wall, and a ball that is nearer.
const SLEDGE: &str = r#"
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
motor = { mode = "velocity", command = 0.5 }

[[body]]
name = "sledge"
parent = "/rail"
density = 500.0
shape = [{ cuboid = { size = [0.4, 0.2, 0.2] } }]

[[sensor]]
name = "eye"
parent = "/rail/sledge"
position = [0.1, 0.0, 0.0]          # inside the sledge, which it does not see
rotation_deg = [0.0, 90.0, 0.0]
proximity = { cone = { angle_deg = 20.0 }, range = 2.0 }

[[body]]
name = "wall"
position = [1.6, 0.0, 0.0]
density = 1000.0
shape = [{ cuboid = { size = [0.2, 3.0, 3.0] } }]

[[body]]
name = "ball"
position = [1.3, 0.1, 0.0]
density = 1000.0
shape = [{ sphere = { radius = 0.05 } }]
"#;

const SIGNALS: &str = "\"/rail/sledge/eye.detected\", \"/rail/sledge/eye.distance\", \"/rail/sledge/eye.detected_point.y\", \"/rail/sledge/eye.detected_point.z\"";

fn folder(scene: &str, record: &str) -> SceneFolder {
    let folder = SceneFolder::new().with("scene.toml", scene);
    let experiment = format!(
        "title = \"seen\"\nscene = \"scene.toml\"\nduration = 1.0\nstep = 0.01\nerror_bar = \"none\"\nrecord = [{record}]\n"
    );
    folder.write("experiment.toml", &experiment);
    folder
}

fn run(scene: &str) -> Simulated {
    let loaded = folder(scene, SIGNALS).load(&[]).unwrap_or_else(|words| panic!("{words}"));
    sincro_testing::run(&loaded)
}

fn column(run: &Simulated, k: usize) -> Vec<f64> {
    run.table.columns[k + 1].values.clone()
}

#[test]
fn the_closest_of_all_other_bodies_is_seen() {
    let run = run(SLEDGE);
    let (detected, distance, y) = (column(&run, 0), column(&run, 1), column(&run, 2));
    for (k, d) in distance.iter().enumerate() {
        // the ball while its closest point is within 10° of the axis, then the outermost ray, then the wall
        let (a, b, r) = (1.2 - 0.005 * k as f64, 0.1, 0.05);
        let (sin, cos) = sincro_math::elementary::sin_cos(10.0_f64.to_radians());
        let (across, along) = (a * sin, b * cos);
        let towards = a * cos + b * sin;
        let ball = if along <= across {
            Some((a * a + b * b).sqrt() - r)
        } else {
            let inside = towards * towards - (a * a + b * b - r * r);
            (inside >= 0.0).then(|| towards - inside.sqrt())
        };
        let wall = 1.4 - 0.005 * k as f64;
        let expected = ball.map_or(wall, |ball| ball.min(wall));
        assert!((d - expected).abs() < 1e-9, "{k}: {d} {expected}");
        assert_eq!(detected[k], 1.0);
        assert!(ball.is_none_or(|ball| ball > wall) || y[k] > 0.0, "the point is beside the axis");
    }
}

#[test]
fn only_what_is_named_is_seen_and_nothing_beyond_the_range() {
    let wall = run(&SLEDGE.replace("range = 2.0", "range = 1.0, with = [\"/wall\"]"));
    let (detected, distance) = (column(&wall, 0), column(&wall, 1));
    for k in 0..distance.len() {
        let d = 1.4 - 0.005 * k as f64;
        assert_eq!(detected[k] == 1.0, d < 1.0 + 1e-9, "{k}");
        assert!((distance[k] - d.min(1.0)).abs() < 1e-9);
    }
}

#[test]
fn a_sensor_holds_its_sample_and_its_noise_is_that_of_the_seed() {
    let held =
        run(&SLEDGE.replace("rotation_deg = [0.0, 90.0, 0.0]", "rotation_deg = [0.0, 90.0, 0.0]\nsample_time = 0.05"));
    let distance = column(&held, 1);
    assert!(distance.chunks_exact(5).all(|five| five.iter().all(|d| d.to_bits() == five[0].to_bits())));
    let noisy = SLEDGE.replace("range = 2.0", "range = 2.0, with = [\"/wall\"], noise = 0.01");
    let (one, two) = (run(&noisy), run(&noisy));
    assert_eq!(column(&one, 1), column(&two, 1), "one seed, one noise");
    let off: Vec<f64> = column(&one, 1).iter().enumerate().map(|(k, d)| d - (1.4 - 0.005 * k as f64)).collect();
    let deviation = (off.iter().map(|x| x * x).sum::<f64>() / off.len() as f64).sqrt();
    // 101 samples: their deviation is within five of its own
    assert!((deviation - 0.01).abs() < 5.0 * 0.01 / (2.0 * 101.0_f64).sqrt(), "{deviation}");
    for (d, z) in column(&one, 1).iter().zip(column(&one, 3)) {
        assert!((d - z).abs() < 1e-12, "the point goes with the distance");
    }
}

/// Replaced text, replacement, and expected message.
const REFUSED: [(&str, &str, &str); 12] = [
    ("range = 2.0", "range = 0.0", "`range`"),
    ("range = 2.0", "range = -1.0", "`range`"),
    ("range = 2.0", "range = nan", "range"),
    ("range = 2.0", "range = inf", "range"),
    ("range = 2.0", "range = 2.0, offset = -0.1", "`offset`"),
    ("angle_deg = 20.0", "angle_deg = 200.0", "proximity sensor `eye` has an angle of 200°"),
    ("angle_deg = 20.0", "angle_deg = 0.0", "`angle_deg`"),
    ("cone = { angle_deg = 20.0 }", "cylinder = { radius = 0.0 }", "proximity sensor `eye` has no width"),
    ("cone = { angle_deg = 20.0 }", "pyramid = { size = [0.1, -0.1] }", "proximity sensor `eye` has the widths"),
    ("cone = { angle_deg = 20.0 }, ", "", "one of `ray`, `cylinder`, `disc`, `cone`, `pyramid` is missing"),
    ("range = 2.0", "range = 2.0, with = [\"/wal\"]", "help: did you mean `/wall`?"),
    ("range = 2.0", "range = 2.0, with = [\"/rail\"]", "`/rail` is a prismatic joint without a shape to be seen"),
];

#[test]
fn sensors_that_cannot_see_are_refused_in_words() {
    let mut wrong = Vec::new();
    for (from, to, expected) in REFUSED {
        let words = folder(&SLEDGE.replace(from, to), SIGNALS).load(&[]).expect_err(to);
        wrong.extend((!words.contains(expected)).then(|| format!("{expected}\n--- said\n{words}\n")));
        assert!(words.contains("scene.toml:"), "{words}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let set = folder(SLEDGE, SIGNALS);
    assert!(set.load(&["/rail/sledge/eye.proximity.range=1.0"]).is_ok(), "`--set` reaches a sensor");
}
