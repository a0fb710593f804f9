//! Contact sensors and force sensors in joints against closed forms.

use sincro_sim::run::Simulated;
use sincro_testing::SceneFolder;

const G: f64 = 9.81;

/// A block of 0.2 × 0.2 × 0.1 m and 2 kg on a floor that a wall stands on, pushed against the wall; the sensor is on
/// its top, its z to the right.
const PUSHED: &str = r#"
[[joint]]
name = "air"
kind = "free"
initial = { position = [0.0, 0.0, 0.05, 1.0, 0.0, 0.0, 0.0] }

[[body]]
name = "block"
parent = "/air"
mass = 2.0
shape = [{ cuboid = { size = [0.2, 0.2, 0.1] } }]
contact = { friction = 0.0 }

[[force]]
name = "push"
parent = "/air/block"
force = [7.0, 0.0, 0.0]

[[frame]]
name = "top"
parent = "/air/block"
position = [0.0, 0.0, 0.05]

[[sensor]]
name = "skin"
parent = "/air/block/top"
rotation_deg = [0.0, 90.0, 0.0]
contact = {}

[[sensor]]
name = "wall_only"
parent = "/air/block"
contact = { with = ["/wall"] }

[[sensor]]
name = "deaf"
parent = "/air/block"
contact = { threshold = 1000.0 }

[[body]]
name = "floor"
shape = [{ plane = {} }]
contact = { friction = 0.0 }

[[body]]
name = "wall"
position = [0.1, 0.0, 0.0]
rotation_deg = [0.0, -90.0, 0.0]
shape = [{ plane = {} }]
contact = { friction = 0.0 }
"#;

/// A turntable with a load on an arm: the sensor is 0.3 m from the axis, its x up; the centre of mass of the load 0.2 m
/// further out.
const ARM: &str = r#"
[[joint]]
name = "table"
kind = "revolute"
torque = 1.5
initial = { velocity = 0.0 }

[[body]]
name = "disc"
parent = "/table"
mass = 1.0
inertia = { xx = 0.05, yy = 0.05, zz = 0.1 }

[[joint]]
name = "wrist"
kind = "fixed"
parent = "/table/disc"
position = [0.3, 0.0, 0.0]
rotation_deg = [0.0, -90.0, 0.0]
force_sensor = true

[[body]]
name = "load"
parent = "/table/disc/wrist"
mass = 2.0
center_of_mass = [0.0, 0.0, -0.2]
inertia = { xx = 0.02, yy = 0.01, zz = 0.03 }
"#;

fn folder(scene: &str, record: &[String], duration: f64) -> SceneFolder {
    let folder = SceneFolder::new().with("scene.toml", scene);
    let names = record.iter().map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ");
    let head = format!("title = \"Touch\"\nduration = {duration:?}\nstep = 0.01\naccuracy = 1e-11\n");
    folder.write("experiment.toml", &format!("{head}error_bar = \"none\"\nseed = 3\nrecord = [{names}]\n"));
    folder
}

fn ran(folder: &SceneFolder) -> Simulated {
    let loaded = folder.load(&[]).unwrap_or_else(|e| panic!("{e}"));
    sincro_testing::run(&loaded)
}

fn six(stem: &str, force: &str, torque: &str) -> Vec<String> {
    [force, torque].iter().flat_map(|what| ["x", "y", "z"].map(|axis| format!("{stem}.{what}.{axis}"))).collect()
}

fn last(run: &Simulated, name: &str) -> f64 {
    *run.table.column(name).unwrap_or_else(|| panic!("{name}")).values.last().unwrap()
}

fn assert_last(run: &Simulated, names: &[String], expected: [f64; 6], tolerance: f64) {
    for (name, expected) in names.iter().zip(expected) {
        let found = last(run, name);
        assert!((found - expected).abs() < tolerance, "{name}: {found}, expected {expected}");
    }
}

#[test]
fn a_contact_sensor_feels_floor_and_wall_in_its_own_axes() {
    let (skin, wall) = ("/air/block/top/skin", "/air/block/wall_only");
    let (all, one) = (six(skin, "measured_force", "measured_torque"), six(wall, "measured_force", "measured_torque"));
    let counts =
        [skin, wall, "/air/block/deaf"].into_iter().flat_map(|s| [format!("{s}.touching"), format!("{s}.points")]);
    let names: Vec<String> = all.iter().chain(&one).cloned().chain(counts).collect();
    let run = ran(&folder(PUSHED, &names, 0.1));
    // world: −7 N of the wall, 2·g of the floor; the sensor's z is the world's x, its x the world's −z. The push passes
    // through the centre of mass, the floor's load moves so that nothing turns: about the centre the moments of wall
    // and floor cancel, and so, about the top, (0, 0, −0.05) × (−7, 0, 2·g) is what is felt: 0.35 N·m about y
    assert_last(&run, &all, [-2.0 * G, 0.0, -7.0, 0.0, 0.35, 0.0], 1e-9);
    assert!((last(&run, &one[0]) + 7.0).abs() < 1e-9 && last(&run, &one[2]).abs() < 1e-9);
    assert_eq!([last(&run, &format!("{skin}.touching")), last(&run, &format!("{wall}.touching"))], [1.0; 2]);
    assert_eq!([last(&run, "/air/block/deaf.touching"), last(&run, "/air/block/deaf.points")], [0.0; 2]);
    assert!(last(&run, &format!("{skin}.points")) >= 3.0);
    assert!((1.0..=4.0).contains(&last(&run, &format!("{wall}.points"))));
}

#[test]
fn nothing_touches_in_flight() {
    let flying = PUSHED.replace("[0.0, 0.0, 0.05, 1.0", "[-1.0, 0.0, 9.0, 1.0");
    let names = six("/air/block/top/skin", "measured_force", "measured_torque");
    let names: Vec<String> = names.into_iter().chain(["/air/block/top/skin.touching".to_owned()]).collect();
    let run = ran(&folder(&flying, &names, 0.1));
    assert!(names.iter().all(|name| run.table.column(name).unwrap().values.iter().all(|x| *x == 0.0)));
}

#[test]
fn noise_of_a_contact_sensor_has_its_deviation() {
    let noisy = PUSHED.replace("contact = {}", "contact = { force_noise = 0.5, torque_noise = 0.02 }");
    let names = six("/air/block/top/skin", "measured_force", "measured_torque");
    let run = ran(&folder(&noisy, &names, 20.0));
    for (name, (mean, deviation)) in
        names.iter().zip([(-2.0 * G, 0.5), (0.0, 0.5), (-7.0, 0.5), (0.0, 0.02), (0.35, 0.02), (0.0, 0.02)])
    {
        let x = &run.table.column(name).unwrap().values;
        let n = x.len() as f64;
        let found = x.iter().sum::<f64>() / n;
        let spread = (x.iter().map(|x| (x - found) * (x - found)).sum::<f64>() / n).sqrt();
        // five standard errors of 2001 samples
        assert!((found - mean).abs() < 5.0 * deviation / n.sqrt(), "{name} {found}");
        assert!((spread / deviation - 1.0).abs() < 5.0 / (2.0 * n).sqrt(), "{name} {spread}");
    }
}

#[test]
fn a_contact_sensor_needs_a_body_that_can_be_touched() {
    let says = |from: &str, to: &str, expected: &str| {
        assert!(PUSHED.contains(from));
        let folder = folder(&PUSHED.replacen(from, to, 1), &["energy.total".to_owned()], 0.1);
        let message = folder.load(&[]).map_or_else(|message| message, |_| "loads".into());
        assert!(message.contains(expected), "{message}\nlacks\n{expected}");
    };
    says("with = [\"/wall\"]", "with = [\"/wal\"]", "there is no object `/wal`");
    says("with = [\"/wall\"]", "with = [\"/wal\"]", "did you mean `/wall`?");
    says("with = [\"/wall\"]", "with = [\"/air\"]", "`/air` is a free joint that nothing can touch");
    says(
        "parent = \"/air/block\"\ncontact = { with",
        "parent = \"/air\"\ncontact = { with",
        "contact sensor `/air/wall_only` is on `/air`",
    );
    says("with = [\"/wall\"]", "with = []", "with");
}

#[test]
fn a_force_sensor_feels_weight_and_acceleration() {
    let names = six("/table/disc/wrist", "force", "torque");
    let names: Vec<String> = names.into_iter().chain(["/table.velocity".to_owned()]).collect();
    // radius of the centre of mass, its distance from the sensor, moment of inertia about the vertical of load and of
    // all
    let (m, r, d, own) = (2.0, 0.5, 0.2, 0.02);
    let all = 0.1 + own + m * r * r;
    for (torque, speed) in [(0.0, 0.0), (0.0, 3.0), (1.5, 0.0), (-2.0, 4.0)] {
        let scene = ARM.replace("torque = 1.5", &format!("torque = {torque:?}"));
        let run = ran(&folder(&scene.replace("velocity = 0.0", &format!("velocity = {speed:?}")), &names, 0.5));
        let (turn, w) = (torque / all, last(&run, "/table.velocity"));
        assert!((w - speed - 0.5 * turn).abs() < 1e-10, "{w}");
        // arm axes: outward −m·ω²·r, along the motion m·α·r, up m·g; moments about the sensor d ahead of it. The
        // sensor's x is up, its z inwards.
        let [out, along, up] = [-m * w * w * r, m * turn * r, m * G];
        let about_up = own * turn + d * along;
        assert_last(&run, &names[..6], [up, along, -out, about_up, -d * up, 0.0], 1e-9);
    }
}

#[test]
fn reported_friction_opposes_the_sliding_whatever_its_direction() {
    for [x, y] in [[1.0_f64, 0.0], [0.0, 1.0], [-0.6, 0.8], [0.3, -0.9]] {
        let scene = format!(
            "[[joint]]\nname = \"air\"\nkind = \"free\"\n\
             initial = {{ position = [0.0, 0.0, 0.05, 1.0, 0.0, 0.0, 0.0], velocity = [0.0, 0.0, 0.0, {x:?}, {y:?}, 0.0] }}\n\
             [[body]]\nname = \"block\"\nparent = \"/air\"\nmass = 2.0\nshape = [{{ cuboid = {{ size = [0.2, 0.2, 0.1] }} }}]\n\
             contact = {{ friction = 0.3 }}\n\
             [[body]]\nname = \"floor\"\nshape = [{{ plane = {{}} }}]\ncontact = {{ friction = 0.3 }}\n"
        );
        let names: Vec<String> = ["x", "y", "z"].map(|axis| format!("/air/block.contact_force.{axis}")).into();
        let run = ran(&folder(&scene, &names, 0.1));
        let (speed, weight) = ((x * x + y * y).sqrt(), 2.0 * G);
        let expected = [-0.3 * weight * x / speed, -0.3 * weight * y / speed, weight];
        for (name, expected) in names.iter().zip(expected) {
            let found = last(&run, name);
            assert!(
                (found - expected).abs() < 1e-6,
                "sliding along ({x}, {y}): {name} is {found}, expected {expected}"
            );
        }
    }
}
