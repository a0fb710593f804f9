//! Contacts that move over both bodies as these slide, roll, tip and sink in, against geometry.

use std::fmt::Write;
use std::sync::atomic::AtomicBool;

use sincro_math::elementary::sin_cos;
use sincro_sim::campaign::run_campaign;
use sincro_testing::random::Draw;
use sincro_testing::{SceneFolder, run};

/// A bar on a hinge leans with its lower edge on the upper edge of a block that slides under it.
const CROSSING: &str = r#"
[[joint]]
name = "arm"
kind = "revolute"
axis = [0, 1, 0]
initial = { position = [ANGLE], velocity = [RATE] }

[[body]]
name = "bar"
parent = "/arm"
density = 1000.0
contact = { friction = 0.0 }
shape = [{ cuboid = { size = [1.2, 0.06, 0.06] }, position = [0.5, 0, 0], rotation_deg = [45, 0, 0] }]

[[joint]]
name = "slide"
kind = "prismatic"
axis = [1, 0, 0]
position = [0.6, 0, -0.3]
initial = { velocity = [SPEED] }

[[body]]
name = "block"
parent = "/slide"
density = 20000.0
contact = { friction = 0.0 }
shape = [{ cuboid = { size = [0.06, 0.5, 0.06] }, rotation_deg = [0, 45, 0] }]
"#;

/// Signals of a run of `duration` seconds.
fn columns<const N: usize>(scene: &str, duration: f64, record: [&str; N]) -> [Vec<f64>; N] {
    let experiment = format!(
        "title = \"Contact\"\nduration = {duration}\nstep = 0.002\nerror_bar = \"none\"\nrecord = {record:?}\n"
    );
    let simulated = run(&SceneFolder::of(scene, &experiment).load(&[]).unwrap());
    record.map(|name| simulated.table.columns.iter().find(|c| c.name == name).unwrap().values.clone())
}

#[test]
fn an_edge_slides_over_an_edge_as_geometry_says() {
    // half diagonal of both sections: the edge of the bar is as far below its axis, that of the block above its own
    let d = 0.03 * 2.0_f64.sqrt();
    let z = d - 0.3;
    for speed in [-1.0, -0.4, 0.3] {
        // x sin θ + z cos θ + d = 0, and its two derivatives
        let gap = |x: f64, angle: f64| {
            let (s, c) = sin_cos(angle);
            x * s + z * c + d
        };
        let rates = |x: f64, v: f64, a: f64, angle: f64| {
            let (s, c) = sin_cos(angle);
            let lever = x * c - z * s;
            let rate = -s * v / lever;
            let lever_rate = v * c - (x * s + z * c) * rate;
            (rate, (-c * rate * v - s * a) / lever + s * v * lever_rate / (lever * lever))
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let at = 0.5 * (low + high);
            (low, high) = if gap(0.6, at) < 0.0 { (at, high) } else { (low, at) };
        }
        let (rate, _) = rates(0.6, speed, 0.0, low);
        let scene = CROSSING.replace("ANGLE", &format!("{low:?}")).replace("RATE", &format!("{rate:?}"));
        let scene = scene.replace("SPEED", &format!("{speed:?}"));
        let [angle, rate, turn] = ["position", "velocity", "acceleration"].map(|of| format!("/arm.{of}"));
        let [x, v, a] = ["position", "velocity", "acceleration"].map(|of| format!("/slide.{of}"));
        let [angle, rate, turn, x, v, a] = columns(&scene, 0.25, [&angle, &rate, &turn, &x, &v, &a]);
        for k in 1..angle.len() {
            let (x, at) = (0.6 + x[k], angle[k]);
            let expected = rates(x, v[k], a[k], at);
            assert!(gap(x, at).abs() < 1e-9, "{speed}: gap {:e} at sample {k}", gap(x, at));
            assert!((rate[k] - expected.0).abs() < 1e-8, "{speed}: {} and {} rad/s at {k}", rate[k], expected.0);
            assert!((turn[k] - expected.1).abs() < 1e-6, "{speed}: {} and {} rad/s² at {k}", turn[k], expected.1);
        }
    }
}

/// A body that rolls, tilted, on a floor.
fn rolling(shape: &str, floor: &str, pose: &str) -> String {
    format!(
        "[[joint]]\nname = \"air\"\nkind = \"free\"\ninitial = {{ position = {pose}, velocity = [0.5, 1.0, 18.0, 1.5, 0.0, 0.2] }}\n\
         [[body]]\nname = \"wheel\"\nparent = \"/air\"\ndensity = 800.0\ncontact = {{ friction = 0.6 }}\n\
         shape = [{{ {shape} }}]\n[[body]]\nname = \"floor\"\ncontact = {{ friction = 0.6 }}\nshape = [{{ {floor} }}]\n"
    )
}

#[test]
fn what_rolls_on_the_face_of_a_cuboid_rolls_as_on_a_plane() {
    let record = ["/air.position.x", "/air.position.y", "/air.position.z", "/air.velocity.x", "energy.balance"];
    // a wheel cambered by 20 degrees, a cone on the rim of its base
    for (shape, pose) in [
        ("cylinder = { radius = 0.1, length = 0.04 }", "[0, 0, 0.1008096649451042, 0.81915204, 0.57357644, 0, 0]"),
        ("cone = { radius = 0.1, length = 0.12 }", "[0, 0, 0.14, 0.81915204, 0.57357644, 0, 0]"),
        ("torus = { major_radius = 0.1, tube_radius = 0.02 }", "[0, 0, 0.14, 0.81915204, 0.57357644, 0, 0]"),
    ] {
        let on = |floor: &str| columns(&rolling(shape, floor, pose), 0.3, record);
        let (plane, cuboid) = (on("plane = {}"), on("cuboid = { size = [6, 6, 1] }, position = [0, 0, -0.5]"));
        for (name, (plane, cuboid)) in record.iter().zip(plane.iter().zip(&cuboid)) {
            assert_eq!(plane, cuboid, "{shape}: {name}");
        }
    }
}

/// A ball falls on a soft platform that turns: it sticks where it touches and sinks in.
const SINKING: &str = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 1, 0]
initial = { velocity = [2.0] }

[[body]]
name = "platform"
parent = "/hinge"
density = 1e6
contact = { stiffness = 2e3, friction = 3.0 }
shape = [{ cuboid = { size = [1, 1, 0.1] } }]

[[joint]]
name = "x"
kind = "prismatic"
axis = [1, 0, 0]
initial = { position = [0.2], velocity = [0.1] }

[[joint]]
name = "z"
kind = "prismatic"
axis = [0, 0, 1]
parent = "/x"
initial = { position = [0.15], velocity = [-1.4] }

[[joint]]
name = "spin"
kind = "revolute"
axis = [0, 1, 0]
parent = "/x/z"

[[body]]
name = "ball"
parent = "/x/z/spin"
density = 500.0
contact = { friction = 3.0 }
shape = [{ sphere = { radius = 0.1 } }]
"#;

#[test]
fn what_sinks_into_a_platform_that_turns_sticks_to_it() {
    let record = ["/hinge.position", "/hinge.velocity", "/x.position", "/x.velocity", "/x/z.position", "/x/z.velocity"];
    let [angle, turn, x, v_x, z, v_z] = columns(SINKING, 0.06, record);
    let [spin] = columns(SINKING, 0.06, ["/x/z/spin.velocity"]);
    let mut deepest = 0.0_f64;
    for k in 1..x.len() {
        let (s, c) = sin_cos(angle[k]);
        // normal (s, c), tangent (c, −s); the contact point is the lowest one of the ball
        let point = [x[k] - 0.1 * s, z[k] - 0.1 * c];
        let depth = 0.05 - (s * point[0] + c * point[1]);
        deepest = deepest.max(depth);
        let of_ball = [v_x[k] - 0.1 * spin[k] * c, v_z[k] + 0.1 * spin[k] * s];
        let of_platform = [turn[k] * point[1], -turn[k] * point[0]];
        let slip = c * (of_ball[0] - of_platform[0]) - s * (of_ball[1] - of_platform[1]);
        assert!(depth <= 0.0 || slip.abs() < 1e-7, "it slips at {slip:e} m/s at sample {k}, {depth} m deep");
    }
    assert!(deepest > 0.01, "it sinks in by {deepest} m");
}

/// Largest penetration of a run `[m]`, as its audit found it.
fn depth_of(scene: &str, experiment: &str) -> f64 {
    let folder = SceneFolder::of(scene, experiment);
    let loaded = folder.load(&[]).unwrap_or_else(|message| panic!("{message}"));
    let done = run_campaign(&folder, &[], &loaded, None, &AtomicBool::new(false), &mut |_, _| {}).unwrap();
    let law = done.main.audit.laws.iter().find(|checked| checked.law == "penetration");
    law.unwrap_or_else(|| panic!("nothing touches\n{scene}")).value
}

/// Scene of two free cuboids, turned at random, one over the other over a floor.
fn falling_pair(random: &mut Draw) -> String {
    let mut scene = String::new();
    for (name, height) in [("low", 0.3), ("high", 0.65)] {
        let [x, y] = [(); 2].map(|()| random.between(-0.03, 0.03));
        let size = [(); 3].map(|()| random.between(0.06, 0.3));
        let turn = [(); 3].map(|()| random.between(-180.0, 180.0));
        let (density, friction) = (random.between(100.0, 2000.0), random.between(0.1, 1.0));
        let restitution = random.one_of(&[0.0, 0.2, 0.5]);
        write!(
            scene,
            "[[joint]]\nname = \"{name}\"\nkind = \"free\"\nposition = [{x:?}, {y:?}, {height:?}]\nrotation_deg = {turn:?}\n\n\
             [[body]]\nname = \"box\"\nparent = \"/{name}\"\ndensity = {density:?}\nshape = [{{ cuboid = {{ size = {size:?} }} }}]\n\
             contact = {{ friction = {friction:?}, restitution = {restitution:?} }}\n\n"
        )
        .unwrap();
    }
    scene + "[[body]]\nname = \"floor\"\nshape = [{ plane = {} }]\ncontact = { friction = 0.5 }\n"
}

/// Whatever corners, edges and faces of two boxes meet, it is an event, and nothing sinks in.
#[test]
fn boxes_that_fall_on_each_other_do_not_sink_in() {
    let mut random = Draw(5);
    for k in 0..24 {
        let scene = falling_pair(&mut random);
        let experiment =
            "title = \"Pair\"\nduration = 0.5\nstep = 0.01\nerror_bar = \"none\"\nrecord = [\"energy.total\"]\n";
        let depth = depth_of(&scene, experiment);
        assert!(depth < 1e-9, "draw {k}: {:e} m deep\n{scene}", depth);
    }
}

/// A body that falls with one end or corner first, on a body whose contacts are found by the general narrow phase: the
/// others strike after it.
#[test]
fn further_points_of_bodies_that_touch_strike_too() {
    let table = "cuboid = { size = [2, 2, 0.2] }";
    let stump = "cylinder = { radius = 0.4, length = 0.2 }";
    let capsule = "capsule = { radius = 0.05, length = 0.4 }";
    let brick = "cuboid = { size = [0.3, 0.2, 0.1] }";
    for (support, shape, tilt) in [
        (table, capsule, 60.0),
        (table, capsule, -35.0),
        (stump, capsule, 60.0),
        (stump, brick, 25.0),
        (stump, brick, -70.0),
    ] {
        for step in [0.01, 0.005, 0.002] {
            let scene = format!(
                "[[body]]\nname = \"support\"\nposition = [0, 0, -0.1]\nshape = [{{ {support} }}]\n\
                 contact = {{ friction = 0.5, restitution = 0.0 }}\n\n\
                 [[joint]]\nname = \"free\"\nkind = \"free\"\nposition = [0.02, 0.01, 0.35]\nrotation_deg = [0, {tilt:?}, 0]\n\n\
                 [[body]]\nname = \"own\"\nparent = \"/free\"\ndensity = 1000.0\nshape = [{{ {shape} }}]\n\
                 contact = {{ friction = 0.5, restitution = 0.0 }}\n"
            );
            let experiment = format!(
                "title = \"Fall\"\nduration = 0.6\nstep = {step:?}\nerror_bar = \"none\"\nrecord = [\"energy.total\"]\n"
            );
            let depth = depth_of(&scene, &experiment);
            assert!(depth < 1e-8, "step {step}: {depth:e} m deep\n{scene}");
        }
    }
}

/// A cylinder that falls on a cuboid and rolls off: of the first one the rim leaves a face, of the second one the flank
/// an edge.
#[test]
fn cylinders_that_fall_on_a_cuboid_do_not_sink_in() {
    let body = |name: &str, start: &str, shape: &str, density: f64, friction: f64| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"free\"\ninitial = {{ position = [{start}] }}\n\n\
             [[body]]\nname = \"of-{name}\"\nparent = \"/{name}\"\ndensity = {density:?}\nshape = [{{ {shape} }}]\n\
             contact = {{ friction = {friction:?}, restitution = RESTITUTION }}\n\n"
        )
    };
    let floor = "[[body]]\nname = \"floor\"\nshape = [{ plane = {} }]\ncontact = { friction = 0.5 }\n";
    let low = "-0.010, -0.019, 0.300, -0.009159, -0.824320, -0.558710, 0.090861";
    let high = "-0.025, 0.012, 0.650, 0.930841, -0.342804, 0.043662, 0.118805";
    let (cuboid, cylinder) =
        ("cuboid = { size = [0.16, 0.23, 0.104] }", "cylinder = { radius = 0.102, length = 0.24 }");
    let first = body("low", low, cuboid, 1878.2, 0.52) + &body("high", high, cylinder, 471.9, 0.93);
    let low = "-0.023, 0.021, 0.300, -0.254571, 0.592390, 0.489618, 0.586977";
    let high = "0.012, -0.014, 0.650, 0.850654, -0.209542, -0.054762, -0.479042";
    let (cylinder, cuboid) =
        ("cylinder = { radius = 0.063, length = 0.144 }", "cuboid = { size = [0.109, 0.288, 0.147] }");
    let second = body("low", low, cylinder, 1986.9, 0.53) + &body("high", high, cuboid, 796.7, 0.42);
    for (scene, restitution) in [(first, "0.5"), (second, "0.1")] {
        let scene = scene.replace("RESTITUTION", restitution) + floor;
        let experiment =
            "title = \"Pair\"\nduration = 0.7\nstep = 0.01\nerror_bar = \"none\"\nrecord = [\"energy.total\"]\n";
        let depth = depth_of(&scene, experiment);
        // points of cylinders are found to 1e-8 m
        assert!(depth < 1e-7, "{depth:e} m deep\n{scene}");
    }
}
