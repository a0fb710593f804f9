//! Sensors against closed forms, their noise against its statistics, their rates, snapshots, and what is refused.

use sincro_sim::run::{LockStep, Simulated, method_for};
use sincro_testing::SceneFolder;

/// A turntable with an arm: an IMU 0.4 m from the axis, mounted on its side.
const TURNTABLE: &str = r#"
[[joint]]
name = "table"
kind = "revolute"
motor = { mode = "velocity", command = 3.0 }

[[body]]
name = "arm"
parent = "/table"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }

[[sensor]]
name = "imu"
parent = "/table/arm"
position = [0.4, 0.0, 0.2]
rotation_deg = [90.0, 0.0, 0.0]    # its y is the arm's z
imu = {}
"#;

/// A brick in free flight with every sensor.
const BRICK: &str = r#"
[[joint]]
name = "air"
kind = "free"
initial = { position = [0.0, 0.0, 100.0, 1.0, 0.0, 0.0, 0.0], velocity = [0.3, -2.0, 0.5, 1.0, 2.0, 3.0] }

[[body]]
name = "brick"
parent = "/air"
mass = 2.0
inertia = { xx = 0.01, yy = 0.02, zz = 0.025 }

[[sensor]]
name = "imu"
parent = "/air/brick"
imu = {}

[[sensor]]
name = "camera"
parent = "/air/brick"
position = [0.1, 0.0, 0.0]
pose = {}

[[sensor]]
name = "doppler"
parent = "/air/brick"
position = [0.1, 0.0, 0.0]
velocity = {}

[[sensor]]
name = "barometer"
parent = "/air/brick"
height = { bias = 0.25 }

[[frame]]
name = "lens"
parent = "/air/brick"
position = [0.1, 0.0, 0.0]
"#;

fn folder(scene: &str, record: &str, duration: f64) -> SceneFolder {
    let folder = SceneFolder::new().with("scene.toml", scene);
    let head = format!("title = \"Sensors\"\nduration = {duration:?}\nstep = 0.01\naccuracy = 1e-11\n");
    folder.write("experiment.toml", &format!("{head}error_bar = \"none\"\nseed = 3\nrecord = [{record}]\n"));
    folder
}

fn ran(folder: &SceneFolder) -> Simulated {
    let loaded = folder.load(&[]).unwrap_or_else(|e| panic!("{e}"));
    sincro_testing::run(&loaded)
}

fn quoted(names: &[String]) -> String {
    names.iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ")
}

fn xyz(stem: &str) -> Vec<String> {
    ["x", "y", "z"].map(|a| format!("{stem}.{a}")).to_vec()
}

fn values<'a>(run: &'a Simulated, name: &str) -> &'a [f64] {
    &run.table.column(name).unwrap_or_else(|| panic!("{name}")).values
}

#[test]
fn on_a_turntable_it_feels_gravity_and_the_way_to_the_axis() {
    let names = [xyz("/table/arm/imu.accelerometer"), xyz("/table/arm/imu.gyro")].concat();
    let run = ran(&folder(TURNTABLE, &quoted(&names), 1.0));
    for k in 1..run.table.n_rows() {
        // −ω²r along its x, +g along its y, which points up; it turns about that axis
        let expected = [-9.0 * 0.4, 9.81, 0.0, 0.0, 3.0, 0.0];
        for (name, expected) in names.iter().zip(expected) {
            assert!((values(&run, name)[k] - expected).abs() < 1e-12, "{name} row {k}: {}", values(&run, name)[k]);
        }
    }
    let still = folder(&TURNTABLE.replace("command = 3.0", "command = 0.0"), &quoted(&names), 0.1);
    let run = ran(&still);
    for (name, expected) in names.iter().zip([0.0, 9.81, 0.0, 0.0, 0.0, 0.0]) {
        assert!(values(&run, name).iter().all(|x| (x - expected).abs() < 1e-13), "at rest {name}: {expected}");
    }
}

#[test]
fn in_free_fall_it_feels_nothing_and_the_others_see_what_is_there() {
    let names = [
        xyz("/air/brick/imu.accelerometer"),
        xyz("/air/brick/imu.gyro"),
        xyz("/air.angular_velocity"),
        xyz("/air/brick/camera.measured_position"),
        xyz("/air/brick/lens.position"),
        xyz("/air/brick/doppler.measured_velocity"),
        xyz("/air/brick/lens.velocity"),
        vec!["/air/brick/barometer.measured_height".into(), "/air/brick.position.z".into()],
        ["roll", "pitch", "yaw"].map(|a| format!("/air/brick/camera.measured_{a}")).to_vec(),
        ["roll", "pitch", "yaw"].map(|a| format!("/air/brick.{a}")).to_vec(),
    ]
    .concat();
    let run = ran(&folder(BRICK, &quoted(&names), 2.0));
    let same = |a: &str, b: &str, bias: f64| {
        let worst = values(&run, a).iter().zip(values(&run, b)).fold(0.0_f64, |w, (x, y)| w.max((x - y - bias).abs()));
        assert!(worst < 1e-12, "{a} and {b} differ by {worst}");
    };
    for a in ["x", "y", "z"] {
        assert!(values(&run, &format!("/air/brick/imu.accelerometer.{a}")).iter().all(|f| f.abs() < 1e-12));
        same(&format!("/air/brick/imu.gyro.{a}"), &format!("/air.angular_velocity.{a}"), 0.0);
        same(&format!("/air/brick/camera.measured_position.{a}"), &format!("/air/brick/lens.position.{a}"), 0.0);
        same(&format!("/air/brick/doppler.measured_velocity.{a}"), &format!("/air/brick/lens.velocity.{a}"), 0.0);
    }
    for a in ["roll", "pitch", "yaw"] {
        same(&format!("/air/brick/camera.measured_{a}"), &format!("/air/brick.{a}"), 0.0);
    }
    same("/air/brick/barometer.measured_height", "/air/brick.position.z", 0.25);
}

#[test]
fn noise_has_the_deviation_of_its_density_and_other_numbers_with_another_seed() {
    let noisy = "imu = { accelerometer_bias = [0.1, 0.2, 0.3], accelerometer_noise_density = 0.02, gyro_noise_density = 0.001 }\n\
                 sample_time = 0.04";
    let names = [xyz("/table/arm/imu.accelerometer"), xyz("/table/arm/imu.gyro")].concat();
    let scene = TURNTABLE.replace("imu = {}", noisy).replace("command = 3.0", "command = 0.0");
    let folder = folder(&scene, &quoted(&names), 400.0);
    let run = ran(&folder);
    // 10,000 samples of 0.04 s
    let samples = |name: &str| values(&run, name).iter().step_by(4).skip(1).copied().collect::<Vec<f64>>();
    let n = 10_000.0_f64;
    for (k, name) in names.iter().enumerate() {
        let x = samples(name);
        let std = if k < 3 { 0.02 } else { 0.001 } / 0.04_f64.sqrt();
        let expected = [0.1, 0.2 + 9.81, 0.3, 0.0, 0.0, 0.0][k];
        let mean = x.iter().sum::<f64>() / n;
        let deviation = (x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt();
        // four standard deviations of the estimates: σ/√n and σ/√2n
        assert!((mean - expected).abs() < 4.0 * std / n.sqrt(), "{name}: mean {mean}");
        assert!((deviation - std).abs() < 4.0 * std / (2.0 * n).sqrt(), "{name}: deviation {deviation}, {std}");
        // neither with itself a sample later nor with the next component
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / n;
        let centred: Vec<f64> = x.iter().map(|x| (x - mean) / std).collect();
        assert!(product(&centred, &centred[1..]).abs() < 4.0 / n.sqrt(), "{name} remembers");
        let next = samples(&names[(k + 1) % 6]);
        let next_mean = next.iter().sum::<f64>() / n;
        let next: Vec<f64> = next.iter().map(|x| (x - next_mean) / std).collect();
        assert!(
            product(&centred, &next).abs() < 4.0 * (if k == 2 || k == 5 { 20.0 } else { 1.0 }) / n.sqrt(),
            "{name}"
        );
        // held between samples
        assert!(values(&run, name).chunks_exact(4).all(|held| held.iter().all(|x| *x == held[0])), "{name} is held");
    }
    folder.change("experiment.toml", "seed = 3", "seed = 4");
    folder.change("experiment.toml", "duration = 400.0", "duration = 1.0");
    let other = ran(&folder);
    assert!(values(&other, &names[0]).iter().zip(values(&run, &names[0])).all(|(a, b)| a != b));
    // sample k alone: a run that is shorter has the same first ones
    folder.change("experiment.toml", "seed = 4", "seed = 3");
    let short = ran(&folder);
    assert_eq!(values(&short, &names[0]), &values(&run, &names[0])[..short.table.n_rows()]);
}

#[test]
fn a_noisy_attitude_is_a_rotation_and_turns_by_its_deviation() {
    let quaternion = ["w", "x", "y", "z"].map(|a| format!("/table/arm/imu.measured_quaternion.{a}")).to_vec();
    let scene = TURNTABLE
        .replace("imu = {}", "pose = { angle_noise = 0.02 }")
        .replace("rotation_deg = [90.0, 0.0, 0.0]", "rotation_deg = [0.0, 0.0, 0.0]")
        .replace("command = 3.0", "command = 0.0");
    let run = ran(&folder(&scene, &quoted(&quaternion), 100.0));
    let n = run.table.n_rows();
    let mut sum = [0.0; 3];
    for k in 0..n {
        let q: Vec<f64> = quaternion.iter().map(|name| values(&run, name)[k]).collect();
        assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14);
        (0..3).for_each(|i| sum[i] += (2.0 * q[i + 1]).powi(2));
    }
    for s in sum {
        let deviation = (s / n as f64).sqrt();
        // four standard deviations, and the third order of a turn of 0.02 rad
        assert!((deviation / 0.02 - 1.0).abs() < 4.0 / (2.0 * n as f64).sqrt() + 2e-4, "{deviation}");
    }
}

/// The controller sees what the sensor gave at this tick, and a run goes on from a snapshot with held samples bit for
/// bit.
#[test]
fn a_diagram_measures_with_sensors_and_a_snapshot_keeps_their_samples() {
    let noisy = "sample_time = 0.05\nimu = { gyro_noise_density = 0.01 }";
    let torque = r#"motor = { mode = "torque" }"#;
    let scene = TURNTABLE.replace("imu = {}", noisy).replace(r#"motor = { mode = "velocity", command = 3.0 }"#, torque);
    let folder = folder(&scene, "\"/table/arm/imu.gyro.y\", \"error\", \"/table.velocity\"", 2.0);
    folder.write(
        "diagram.toml",
        r#"
wires = ["target -> error.u1", "/table/arm/imu.gyro[1] -> error.u2", "error -> gain -> /table"]

[[block]]
name = "target"
type = "constant"
value = 3.0

[[block]]
name = "error"
type = "sum"
signs = "+-"

[[block]]
name = "gain"
type = "gain"
gain = 0.5
"#,
    );
    folder.change("experiment.toml", "record = [", "diagram = \"diagram.toml\"\nrecord = [");
    let run = ran(&folder);
    let (gyro, error) = (values(&run, "/table/arm/imu.gyro.y"), values(&run, "error"));
    assert!(gyro.iter().zip(error).all(|(w, e)| 3.0 - w == *e), "no sample of delay between sensor and diagram");
    assert!((values(&run, "/table.velocity").last().unwrap() - 3.0).abs() < 0.2);

    let loaded = folder.load(&[]).unwrap_or_else(|e| panic!("{e}"));
    let mut whole = LockStep::new(&loaded, method_for(&loaded).0, false);
    whole.start().unwrap();
    (0..33).for_each(|_| whole.advance().unwrap());
    let bytes = whole.snapshot(whole.trace()).to_bytes(&loaded);
    let snapshot = sincro_sim::snapshot::Snapshot::from_bytes(&bytes, &loaded).unwrap();
    let mut resumed = LockStep::new(&loaded, method_for(&loaded).0, false);
    resumed.restore(&snapshot);
    for _ in 0..40 {
        whole.advance().unwrap();
        resumed.advance().unwrap();
        assert_eq!(whole.state(), resumed.state());
        let (a, b) = (whole.t(), resumed.t());
        assert_eq!(whole.observe(a).1, resumed.observe(b).1, "sensors hold the same");
    }
}

/// Replaced text, replacement, and expected message.
const REFUSED: &[(&str, &str, &str)] = &[
    (
        "imu = {}",
        "",
        "scene.toml:14:8: error: one of `imu`, `pose`, `velocity`, `height`, `contact`, `proximity` is missing in sensor `imu`",
    ),
    ("imu = {}", "imu = {}\nheight = {}", "scene.toml:"),
    ("imu = {}", "imu = {}\nsample_time = 0.0", "`sample_time`"),
    (
        "imu = {}",
        "imu = {}\nsample_time = 0.025",
        "the sample time of sensor `/table/arm/imu`, 0.025 s, is no whole number of base steps of 0.01 s",
    ),
    ("imu = {}", "imu = {}\nsample_time = 0.025", "help: use 0.02 or 0.03, or another `step`"),
    ("imu = {}", "imu = {}\nsample_time = 0.001", "help: use 0.01 or a smaller `step`"),
    ("imu = {}", "imu = { gyro_noise_density = -1.0 }", "`gyro_noise_density` is -1"),
    ("imu = {}", "imu = { gyro_noise = 1.0 }", "unknown key `gyro_noise`"),
    ("imu = {}", "imu = { gyro_bias = [0.0, nan, 0.0] }", "`gyro_bias[1]` is not a number"),
    ("imu = {}", "pose = { angle_noise = \"a lot\" }", "`angle_noise`"),
    ("parent = \"/table/arm\"", "parent = \"/table/leg\"", "there is no object `/table/leg` to hang `imu` on"),
    ("name = \"imu\"", "name = \"i mu\"", "`i mu` is not a name"),
];

#[test]
fn sensors_that_cannot_be_are_refused_in_words() {
    let mut wrong = Vec::new();
    for (from, to, expected) in REFUSED {
        let scene = TURNTABLE.replace(from, to);
        let folder = folder(&scene, "\"/table.velocity\"", 1.0);
        let words = folder.load(&[]).expect_err(to);
        wrong.extend((!words.contains(expected)).then(|| format!("{expected}\n--- said\n{words}\n")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let unknown = folder(TURNTABLE, "\"/table/arm/imu.gyro.w\"", 1.0);
    let words = unknown.load(&[]).unwrap_err().to_string();
    assert!(words.contains("there is no signal `/table/arm/imu.gyro.w`"), "{words}");
    let set = folder(TURNTABLE, "\"/table.velocity\"", 1.0);
    assert!(set.load(&["/table/arm/imu.imu.gyro_bias=[0.0, 0.0, 1.0]"]).is_ok(), "`--set` reaches a sensor");
}
