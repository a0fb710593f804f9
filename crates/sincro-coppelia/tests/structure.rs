//! Structure that clients change while a run is on: spawners, grippers, joints and bodies made at run time, models.

use sincro_coppelia::api::{Handle, Search, Value};
use sincro_coppelia::session::Session;
use sincro_sim::Extensions;
use sincro_sim::run::Simulated;
use sincro_testing::scenes::box_above_floor;
use sincro_testing::{OpenSession, SceneFolder};

/// Acceleration of gravity [m/s²].
const G: f64 = 9.81;

const EXPERIMENT: &str = r#"
title = "Structure"
duration = 10.0
step = 0.005
record = ["/box_joint/box.position.z", "energy.balance"]
error_bar = "none"
"#;

fn open(scene: &str) -> OpenSession {
    OpenSession::open(SceneFolder::of(scene, EXPERIMENT), &[], Extensions::default(), None)
}

fn call(session: &mut Session, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn handle(session: &mut Session, path: &str) -> i64 {
    i64::from(session.registry().find(path, Search::default()).unwrap().0)
}

fn handles(list: &Value) -> Vec<i64> {
    let Value::List(list) = list else { panic!("a list of handles") };
    list.iter().map(|value| value.as_int().unwrap()).collect()
}

fn reals(list: &Value) -> Vec<f64> {
    list.as_reals().unwrap()
}

fn position(session: &mut Session, object: i64) -> [f64; 3] {
    let found = call(session, "sim.getObjectPosition", &[object.into(), (-1_i64).into()]);
    reals(&found[0]).try_into().unwrap()
}

fn put(session: &mut Session, object: i64, place: [f64; 3]) {
    call(session, "sim.setObjectPosition", &[object.into(), Value::reals(place), (-1_i64).into()]);
}

fn steps(session: &mut Session, n: usize) {
    for _ in 0..n {
        session.step().unwrap();
    }
}

/// Five copies of a box that fall on the floor; runs until they rest.
fn spawn(session: &mut Session, height: f64) -> Vec<i64> {
    let original = handle(session, "/box");
    session.start().unwrap();
    let mut copies = Vec::new();
    for k in 0..5 {
        let copied = call(session, "sim.copyPasteObjects", &[Value::List(vec![original.into()]), 0_i64.into()]);
        let copy = handles(&copied[0])[0];
        put(session, copy, [0.3 + 0.3 * f64::from(k), 0.0, height]);
        copies.push(copy);
        steps(session, 5);
    }
    steps(session, 150);
    copies
}

#[test]
fn copies_of_a_box_fall_and_rest_on_the_floor() {
    let mut session = open(&box_above_floor(0.05));
    let copies = spawn(&mut session, 0.2);
    for (k, copy) in copies.iter().enumerate() {
        let [x, _, z] = position(&mut session, *copy);
        assert!((z - 0.05).abs() < 1e-9, "copy {k} at z = {z} m");
        assert!((x - (0.3 + 0.3 * k as f64)).abs() < 1e-6, "copy {k} at x = {x} m");
    }
    // the floor carries six boxes of 1 kg
    let force = normal_force(&mut session);
    assert!((force - 6.0 * G).abs() < 1e-6 * G, "the floor carries {force} N");
}

/// Sum of the vertical contact forces now [N].
fn normal_force(session: &mut Session) -> f64 {
    let t = session.t();
    let sim = session.sim();
    sim.world.rates(t);
    sim.world.contacts().map(|point| point.force[2].abs()).sum()
}

#[test]
fn removed_copies_are_gone_and_the_others_stay() {
    let mut session = open(&box_above_floor(0.05));
    let copies = spawn(&mut session, 0.2);
    let gone = Value::List(copies[..2].iter().map(|h| Value::from(*h)).collect());
    call(&mut session, "sim.removeObjects", &[gone]);
    steps(&mut session, 20);
    for copy in &copies[..2] {
        assert!(session.registry().entry(Handle(*copy as i32)).is_err(), "{copy} is there");
    }
    let [_, _, z] = position(&mut session, copies[3]);
    assert!((z - 0.05).abs() < 1e-9);
    let force = normal_force(&mut session);
    assert!((force - 4.0 * G).abs() < 1e-6 * G, "the floor carries {force} N");
    // 24 = 6 × (1 + 5 − 2): the joints of the removed ones have gone
    assert_eq!(session.sim().world.state.v.len(), 24);
}

fn finished(session: &mut Session) -> Simulated {
    session.stop().unwrap();
    session.take_finished().remove(0).simulated
}

#[test]
fn a_changed_run_has_the_same_trace_each_time_and_another_one_without_the_change() {
    let run = |with_copies: bool| {
        let mut session = open(&box_above_floor(0.05));
        if with_copies {
            spawn(&mut session, 0.2);
        } else {
            session.start().unwrap();
            steps(&mut session, 175);
        }
        finished(&mut session).trace
    };
    assert_eq!(run(true), run(true));
    assert_ne!(run(true), run(false));
}

#[test]
fn energy_and_columns_go_on_when_the_structure_changes() {
    let mut session = open(&box_above_floor(0.05));
    let original = handle(&mut session, "/box");
    spawn(&mut session, 0.2);
    call(&mut session, "sim.removeObjects", &[Value::List(vec![original.into()])]);
    steps(&mut session, 20);
    let run = finished(&mut session);
    let height = &run.table.column("/box_joint/box.position.z").unwrap().values;
    let n = height.len();
    assert!(height[..n - 20].iter().all(|z| (z - 0.05).abs() < 1e-9));
    assert!(height[n - 20..].iter().all(|z| z.is_nan()), "the box has gone: {:?}", &height[n - 21..]);
    let balance = &run.table.column("energy.balance").unwrap().values;
    // lifting each copy by 0.15 m is work
    let worst = balance.iter().fold(0.0_f64, |worst, x| worst.max(x.abs()));
    assert!(worst < 1e-6, "balance off by {worst} J");
    let n_added = run.changes.iter().filter(|change| change.quantity == "added").count();
    assert_eq!(n_added, 10, "five bodies with their joints");
    assert!(run.changes.iter().any(|change| change.quantity == "removed" && change.object == "/box_joint/box"));
}

const IN_SPACE: &str = r#"
gravity = [0.0, 0.0, 0.0]
[[joint]]
name = "hand_joint"
kind = "free"
[[body]]
name = "hand"
parent = "/hand_joint"
density = 1000.0
shape = [{ cuboid = { size = [0.1, 0.2, 0.1] } }]
[[joint]]
name = "box_joint"
kind = "free"
initial = { position = [0.3, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], velocity = [0.0, 0.0, 0.0, 0.6, 0.0, 0.0] }
[[body]]
name = "box"
parent = "/box_joint"
density = 1000.0
shape = [{ cuboid = { size = [0.1, 0.1, 0.1] } }]
"#;

fn velocity(session: &mut Session, object: i64) -> [f64; 3] {
    reals(&call(session, "sim.getObjectVelocity", &[object.into()])[0]).try_into().unwrap()
}

#[test]
fn hanging_a_moving_body_on_another_one_is_a_perfectly_inelastic_impact() {
    let mut session = open(IN_SPACE);
    let (hand, body) = (handle(&mut session, "/hand"), handle(&mut session, "/box"));
    session.start().unwrap();
    steps(&mut session, 10);
    call(&mut session, "sim.setObjectParent", &[body.into(), hand.into(), true.into()]);
    // 1 kg at 0.6 m/s joins 2 kg at rest
    for object in [hand, body] {
        let v = velocity(&mut session, object);
        assert!((v[0] - 0.2).abs() < 1e-12 && v[1].abs() < 1e-12, "{v:?}");
    }
    assert_eq!(session.sim().world.state.v.len(), 6, "one body");
    steps(&mut session, 20);
    let (a, b) = (position(&mut session, hand), position(&mut session, body));
    assert!((b[0] - a[0] - 0.3 - 0.6 * 0.05).abs() < 1e-9, "they stay together: {a:?} {b:?}");
    // and are parted with the velocity that they have
    call(&mut session, "sim.setObjectParent", &[body.into(), (-1_i64).into(), true.into()]);
    assert_eq!(session.sim().world.state.v.len(), 12);
    for object in [hand, body] {
        let v = velocity(&mut session, object);
        assert!((v[0] - 0.2).abs() < 1e-12, "{v:?}");
    }
    let parted = position(&mut session, body);
    assert!(parted.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-12));
    steps(&mut session, 20);
    let run = finished(&mut session);
    let energy: Vec<_> = run.changes.iter().filter(|c| c.quantity == "energy").map(|c| c.value.clone()).collect();
    // m₁ m₂ / (m₁ + m₂) v² / 2
    assert!((energy[0][1] - 0.5 * 2.0 / 3.0 * 0.36).abs() < 1e-12, "{energy:?}");
    assert!((energy[0][0] + energy[0][1]).abs() < 1e-12 && energy[1][0].abs() < 1e-12, "{energy:?}");
    let momentum = run.changes.iter().filter(|c| c.quantity == "momentum").count();
    assert_eq!(momentum, 0, "momentum is conserved: {:?}", run.changes);
}

#[test]
fn hanging_a_moving_body_on_the_floor_tells_the_momentum_that_the_floor_took() {
    let mut session = open(&box_above_floor(1.0));
    let (floor, body) = (handle(&mut session, "/floor"), handle(&mut session, "/box"));
    session.start().unwrap();
    steps(&mut session, 20);
    call(&mut session, "sim.setObjectParent", &[body.into(), floor.into(), true.into()]);
    let z = position(&mut session, body)[2];
    steps(&mut session, 20);
    assert_eq!(position(&mut session, body)[2].to_bits(), z.to_bits(), "it hangs there");
    let run = finished(&mut session);
    let jump = run.changes.iter().find(|c| c.quantity == "momentum").expect("a jump");
    assert!((jump.value[2] - 0.1 * G).abs() < 1e-9, "{:?}", jump.value);
}

#[test]
fn a_joint_and_a_body_that_are_made_swing_as_a_pendulum() {
    let mut session = open(&box_above_floor(0.05));
    session.start().unwrap();
    steps(&mut session, 2);
    let joint = call(&mut session, "sim.createJoint", &[10_i64.into(), 5_i64.into(), 0_i64.into()])[0].clone();
    let joint = joint.as_int().unwrap();
    put(&mut session, joint, [0.0, 2.0, 1.0]);
    // its z axis along the world's y
    let angles = Value::reals([-std::f64::consts::FRAC_PI_2, 0.0, 0.0]);
    call(&mut session, "sim.setObjectOrientation", &[joint.into(), angles, (-1_i64).into()]);
    let size = Value::reals([0.1, 0.1, 0.1]);
    let made = call(&mut session, "sim.createPureShape", &[1_i64.into(), 0_i64.into(), size, 2.0.into()])[0].clone();
    let ball = made.as_int().unwrap();
    put(&mut session, ball, [0.5, 2.0, 1.0]);
    call(&mut session, "sim.setObjectParent", &[ball.into(), joint.into(), true.into()]);
    assert_eq!(call(&mut session, "sim.getJointPosition", &[joint.into()]), [Value::Real(0.0)]);
    assert_eq!(call(&mut session, "sim.getShapeMass", &[ball.into()]), [Value::Real(2.0)]);
    // from the horizontal it falls with q̈ = m g l / (m l² + 2/5 m r²)
    let step = 0.005;
    steps(&mut session, 1);
    let q = call(&mut session, "sim.getJointPosition", &[joint.into()])[0].as_real().unwrap();
    let acceleration = G * 0.5 / (0.25 + 0.4 * 0.0025);
    assert!((q.abs() - 0.5 * acceleration * step * step).abs() < 1e-6 * q.abs() + 1e-9, "{q} rad");
    let height = |session: &mut Session| position(session, ball)[2];
    let mut lowest = f64::INFINITY;
    for _ in 0..200 {
        steps(&mut session, 1);
        lowest = lowest.min(height(&mut session));
    }
    assert!((lowest - 0.5).abs() < 1e-3, "it swings down to {lowest} m");
    let [x, y, z] = position(&mut session, ball);
    let distance = (x * x + (z - 1.0) * (z - 1.0)).sqrt();
    assert!((distance - 0.5).abs() < 1e-9 && (y - 2.0).abs() < 1e-9, "it stays on its circle: {distance} m");
}

#[test]
fn shapes_that_are_made_fall_when_they_are_made_dynamic() {
    let mut session = open(&box_above_floor(0.05));
    session.start().unwrap();
    let size = Value::reals([0.2, 0.2, 0.2]);
    let made = call(&mut session, "sim.createPrimitiveShape", &[3_i64.into(), size, 0_i64.into()])[0].clone();
    let cube = made.as_int().unwrap();
    put(&mut session, cube, [1.0, 0.0, 0.5]);
    steps(&mut session, 20);
    assert_eq!(position(&mut session, cube)[2], 0.5, "static it stays");
    for (parameter, value) in [(3003_i64, 0_i64), (3004, 1)] {
        call(&mut session, "sim.setObjectInt32Param", &[cube.into(), parameter.into(), value.into()]);
        let got = call(&mut session, "sim.getObjectInt32Param", &[cube.into(), parameter.into()]);
        assert_eq!(got, [Value::Int(value)]);
    }
    steps(&mut session, 150);
    let z = position(&mut session, cube)[2];
    assert!((z - 0.1).abs() < 1e-9, "it rests at {z} m");
    let force = normal_force(&mut session);
    assert!((force - 9.0 * G).abs() < 1e-6 * G, "8 kg and the box of 1 kg weigh {force} N");
    // static again it stays where it is put
    call(&mut session, "sim.setObjectInt32Param", &[cube.into(), 3003_i64.into(), 1_i64.into()]);
    put(&mut session, cube, [1.0, 0.0, 0.7]);
    steps(&mut session, 20);
    assert_eq!(position(&mut session, cube)[2], 0.7);
}

/// A session of a scene of this program, beside the folder of its models.
fn beside_models() -> Session {
    let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/box-push");
    Session::open(&scene, &[], Extensions::default(), None).unwrap()
}

#[test]
fn robots_are_loaded_while_stopped_and_while_running_several_times() {
    let mut session = beside_models();
    let n = session.sim().world.state.v.len();
    let first = call(&mut session, "sim.loadModel", &["pioneer-p3dx".into()])[0].as_int().unwrap();
    put(&mut session, first, [2.0, 3.0, 0.0]);
    session.start().unwrap();
    steps(&mut session, 5);
    let second = call(&mut session, "sim.loadModel", &["models/robots/Pioneer P3DX.ttm".into()])[0].as_int().unwrap();
    put(&mut session, second, [4.0, 3.0, 0.0]);
    let arm = call(&mut session, "sim.loadModel", &["ur5e".into()])[0].as_int().unwrap();
    put(&mut session, arm, [-3.0, 0.0, 0.0]);
    assert_eq!(session.sim().world.state.v.len(), n + 2 * 8 + 6);
    steps(&mut session, 40);
    for (robot, x) in [(first, 2.0), (second, 4.0)] {
        let below = call(&mut session, "sim.getObjectsInTree", &[robot.into()])[0].clone();
        let of_robot = handles(&below);
        let path = |session: &mut Session, h: &i64| session.registry().entry(Handle(*h as i32)).unwrap().path.clone();
        let chassis = *of_robot.iter().find(|h| path(&mut session, h).ends_with("chassis")).unwrap();
        let [px, py, pz] = position(&mut session, chassis);
        assert!((px - x).abs() < 1e-3 && (py - 3.0).abs() < 1e-6, "{px} {py}");
        assert!((pz - 0.0975).abs() < 1e-4, "it stands on its wheels at {pz} m");
    }
    session.stop().unwrap();
    // what was loaded while stopped stays, what was loaded in the run is gone
    assert_eq!(session.sim().world.state.v.len(), n + 8);
    assert!(session.registry().entry(Handle(first as i32)).is_ok());
    assert!(session.registry().entry(Handle(arm as i32)).is_err());
    session.start().unwrap();
    steps(&mut session, 5);
    session.stop().unwrap();
    let runs = session.take_finished();
    assert!(runs.iter().all(|run| run.simulated.changes.iter().any(|c| c.object == "/pioneer-p3dx" && c.t == 0.0)));
}

#[test]
fn a_model_that_is_saved_can_be_loaded_again() {
    let mut session = open(IN_SPACE);
    let hand = handle(&mut session, "/hand");
    let text = call(&mut session, "sim.saveModel", &[hand.into()])[0].clone();
    let copy = call(&mut session, "sim.loadModel", &[text])[0].as_int().unwrap();
    let below = handles(&call(&mut session, "sim.getObjectsInTree", &[copy.into()])[0]);
    assert_eq!(below.len(), 2, "frame, body: its free joint is not listed");
    let mass = call(&mut session, "sim.getShapeMass", &[below[1].into()])[0].as_real().unwrap();
    assert!((mass - 2.0).abs() < 1e-12);
    for wrong in ["nothing-there", "../../../etc/passwd", ""] {
        let refused = session.call("sim.loadModel", &[wrong.into()]).unwrap_err();
        assert!(refused.to_string().contains("model"), "{refused}");
    }
}

fn momentum_of(session: &mut Session) -> sincro_dynamics::spatial::Vec3<f64> {
    let t = session.t();
    session.sim().world.observe(t).momentum().lin
}

#[test]
fn a_body_is_handed_from_one_hand_to_another_and_keeps_its_joint() {
    let second = IN_SPACE
        [IN_SPACE.find("[[joint]]").unwrap()..IN_SPACE.find("[[joint]]\nname = \"box_joint\"").unwrap()]
        .replace("hand", "other");
    let start = "kind = \"free\"\ninitial = { position = [0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0] }";
    let scene = format!("{IN_SPACE}{}", second.replace("kind = \"free\"", start));
    let mut session = open(&scene);
    let [hand, other, body] = ["/hand", "/other", "/box"].map(|path| handle(&mut session, path));
    let joint = handle(&mut session, "/box_joint");
    session.start().unwrap();
    for parent in [hand, other, hand, -1] {
        let before = position(&mut session, body);
        let momentum = momentum_of(&mut session);
        call(&mut session, "sim.setObjectParent", &[body.into(), parent.into(), true.into()]);
        let after = position(&mut session, body);
        assert!(before.iter().zip(after).all(|(x, y)| (x - y).abs() < 1e-12), "hung on {parent}: {after:?}");
        let now = momentum_of(&mut session);
        assert!((now - momentum).norm() < 1e-12, "hung on {parent}: {now:?}");
        steps(&mut session, 3);
        assert!(session.registry().entry(Handle(joint as i32)).is_ok(), "the joint or frame stays");
    }
    assert_eq!(session.sim().world.state.v.len(), 18);
}

#[test]
fn what_the_diagram_needs_cannot_be_taken_away() {
    let diagram = r#"
wires = ["/hinge.position -> pd.x", "pd -> /hinge"]
[[block]]
name = "pd"
type = "expression"
inputs = ["x"]
expressions = ["-20*x"]
"#;
    let scene = format!(
        "{}\n[[joint]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\nposition = [0.0, 3.0, 1.0]\n\
         motor = {{ mode = \"torque\" }}\n[[body]]\nname = \"arm\"\nparent = \"/hinge\"\nmass = 1.0\n\
         inertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\n",
        box_above_floor(0.05)
    );
    let experiment = format!("{EXPERIMENT}diagram = \"diagram.toml\"\n");
    let folder = SceneFolder::of(&scene, &experiment).with("diagram.toml", diagram);
    let mut session = OpenSession::open(folder, &[], Extensions::default(), None);
    let (arm, body) = (handle(&mut session, "/arm"), handle(&mut session, "/box"));
    let dummy = call(&mut session, "sim.createDummy", &[0.01.into()])[0].clone();
    call(&mut session, "sim.setObjectParent", &[dummy.clone(), arm.into(), true.into()]);
    let gone = Value::List(vec![arm.into()]);
    let why = session.call("sim.removeObjects", &[gone]).unwrap_err().to_string();
    assert!(why.contains("the diagram"), "{why}");
    assert_eq!(call(&mut session, "sim.getObjectParent", &[dummy]), [arm.into()], "it hangs where it did");
    call(&mut session, "sim.removeObjects", &[Value::List(vec![body.into()])]);
    session.start().unwrap();
    steps(&mut session, 10);
    assert!(position(&mut session, arm)[1] > 2.9);
}

#[test]
fn a_diagram_goes_on_measuring_what_joins_bodies_when_something_else_changes() {
    let scene = format!(
        "{}\n[[joint]]\nname = \"slide\"\nkind = \"prismatic\"\naxis = [0.0, 0.0, 1.0]\n\
         position = [0.0, 3.0, 1.0]\nmotor = {{ mode = \"torque\" }}\n[[body]]\nname = \"mass\"\nparent = \"/slide\"\n\
         mass = 1.0\ninertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\n[[spring_damper]]\nname = \"spring\"\n\
         between = [\"/\", \"/slide/mass\"]\npoints = [[0.0, 3.0, 0.0], [0.0, 0.0, 0.0]]\nfree_length = 1.0\nstiffness = 100.0\n",
        box_above_floor(0.05)
    );
    let diagram = "wires = [\"/spring.force -> hold.f\", \"hold -> /slide\"]\n[[block]]\nname = \"hold\"\n\
        type = \"expression\"\ninputs = [\"f\"]\nexpressions = [\"0*f + 9.81\"]\n";
    let experiment = format!("{EXPERIMENT}diagram = \"diagram.toml\"\n");
    let folder = SceneFolder::of(&scene, &experiment).with("diagram.toml", diagram);
    let mut session = OpenSession::open(folder, &[], Extensions::default(), None);
    let (mass, body) = (handle(&mut session, "/mass"), handle(&mut session, "/box"));
    let copied = call(&mut session, "sim.copyPasteObjects", &[Value::List(vec![body.into()]), 0_i64.into()]);
    put(&mut session, handles(&copied[0])[0], [1.0, 0.0, 0.05]);
    session.start().unwrap();
    steps(&mut session, 5);
    call(&mut session, "sim.removeObjects", &[copied[0].clone()]);
    steps(&mut session, 20);
    assert!((position(&mut session, mass)[2] - 1.0).abs() < 1e-9, "the motor carries it at the spring's free length");
    session.stop().unwrap();
    session.start().unwrap();
    steps(&mut session, 5);
}

#[test]
fn a_model_may_have_an_object_of_the_name_that_it_gets() {
    let text = "[[joint]]\nname = \"model\"\nkind = \"free\"\n[[body]]\nname = \"ball\"\nparent = \"/model\"\n\
        density = 1000.0\nshape = [{ sphere = { radius = 0.1 } }]\n[[frame]]\nname = \"tip\"\nparent = \"/model/ball\"\n\
        position = [0.0, 0.0, 0.1]\n[[frame]]\nname = \"beside\"\n";
    let mut session = open(&box_above_floor(0.05));
    let model = call(&mut session, "sim.loadModel", &[text.into()])[0].as_int().unwrap();
    let below = handles(&call(&mut session, "sim.getObjectsInTree", &[model.into()])[0]);
    let mut paths: Vec<String> =
        below.iter().map(|h| session.registry().entry(Handle(*h as i32)).unwrap().path.clone()).collect();
    paths.sort();
    assert_eq!(paths, ["/model", "/model/beside", "/model/model/ball", "/model/model/ball/tip"]);
}

#[test]
fn spawning_and_removing_shapes_has_no_end() {
    let mut session = open(&box_above_floor(0.05));
    session.start().unwrap();
    for _ in 0..40 {
        let made = call(
            &mut session,
            "sim.createPureShape",
            &[0_i64.into(), 8_i64.into(), Value::reals([0.1; 3]), 1.0.into()],
        );
        put(&mut session, made[0].as_int().unwrap(), [1.0, 0.0, 0.5]);
        call(&mut session, "sim.removeObjects", &[Value::List(vec![made[0].clone()])]);
        steps(&mut session, 1);
    }
    assert_eq!(session.registry().created_count(), 0);
}

#[test]
fn files_of_models_need_leave_and_are_looked_for_in_few_places() {
    let mut session = open(IN_SPACE);
    let hand = handle(&mut session, "/hand");
    let why = session.call("sim.saveModel", &[hand.into(), "hand.toml".into()]).unwrap_err().to_string();
    assert!(why.contains("--grant files"), "{why}");
    let mut session = beside_models();
    let here = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    let there = session.call("sim.loadModel", &[here.into()]).unwrap_err().to_string();
    let nowhere = session.call("sim.loadModel", &["/nothing/at/all.toml".into()]).unwrap_err().to_string();
    assert_eq!(
        there.replace(here, "F"),
        nowhere.replace("/nothing/at/all.toml", "F"),
        "nothing is told of files outside"
    );
}

#[test]
fn a_body_that_joins_a_hinged_arm_brings_its_angular_momentum_about_the_hinge() {
    let arm = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
[[body]]
name = "arm"
parent = "/hinge"
mass = 3.0
center_of_mass = [0.25, 0.0, 0.0]
inertia = { xx = 0.01, yy = 0.2, zz = 0.2 }
"#;
    // the box is at x = 0.3 m and moves along z with 0.6 m/s
    let along_z = IN_SPACE.replace("[0.0, 0.0, 0.0, 0.6, 0.0, 0.0]", "[0.0, 0.0, 0.0, 0.0, 0.0, 0.6]");
    let mut session = open(&format!("{along_z}{arm}"));
    let [arm, body, joint] = ["/arm", "/box", "/hinge"].map(|path| handle(&mut session, path));
    session.start().unwrap();
    call(&mut session, "sim.setObjectParent", &[body.into(), arm.into(), true.into()]);
    let rate = call(&mut session, "sim.getJointVelocity", &[joint.into()])[0].as_real().unwrap();
    // about y a velocity along z at +x turns backwards; the box of 1 kg turns about its own centre, too
    let of_box = 1.0 * (0.3 * 0.3 + 0.1 * 0.1 / 6.0);
    let of_arm = 0.2 + 3.0 * 0.25 * 0.25;
    let expected = -0.3 * 0.6 / (of_arm + of_box);
    assert!((rate - expected).abs() < 1e-12, "{rate} rad/s, expected {expected}");
    steps(&mut session, 10);
    let after = call(&mut session, "sim.getJointVelocity", &[joint.into()])[0].as_real().unwrap();
    assert!((after - expected).abs() < 1e-9, "{after}");
}

/// A pendulum on a hinge along y that is released where it is horizontal.
const PENDULUM: &str = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
[[body]]
name = "bob"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.5, 0.0, 0.0]
inertia = { xx = 0.001, yy = 0.001, zz = 0.001 }
"#;

#[test]
fn stops_are_made_and_taken_away() {
    let interval = |lower: f64, upper: f64| [false.into(), Value::reals([lower, upper - lower])];
    let swing = |session: &mut OpenSession, joint: i64| {
        let mut largest = 0.0_f64;
        for _ in 0..200 {
            steps(session, 1);
            let q = call(session, "sim.getJointPosition", &[joint.into()])[0].as_real().unwrap();
            largest = largest.max(q);
        }
        largest
    };
    for stopped in [true, false] {
        let mut session = open(&format!("{}{PENDULUM}", box_above_floor(0.05)));
        let hinge = handle(&mut session, "/hinge");
        let start = |session: &mut OpenSession| {
            session.start().unwrap();
            steps(session, 1);
        };
        if !stopped {
            start(&mut session);
        }
        let [is_cyclic, range] = interval(-0.5, 1.0);
        call(&mut session, "sim.setJointInterval", &[hinge.into(), is_cyclic, range]);
        if stopped {
            start(&mut session);
        }
        let got = call(&mut session, "sim.getJointInterval", &[hinge.into()]);
        assert_eq!(got, [false.into(), Value::reals([-0.5, 1.5])]);
        let reached = swing(&mut session, hinge);
        assert!((reached - 1.0).abs() < 1e-9, "{reached} rad at a stop of 1 rad");
        // other ones in their place, then none
        let [is_cyclic, range] = interval(-0.5, 1.25);
        call(&mut session, "sim.setJointInterval", &[hinge.into(), is_cyclic, range]);
        let reached = swing(&mut session, hinge);
        assert!((reached - 1.25).abs() < 1e-9, "{reached} rad at a stop of 1.25 rad");
        call(&mut session, "sim.setJointInterval", &[hinge.into(), true.into(), Value::reals([0.0; 2])]);
        assert_eq!(call(&mut session, "sim.getJointInterval", &[hinge.into()])[0], true.into());
        let reached = swing(&mut session, hinge);
        assert!(reached > 1.5, "{reached} rad without stops");
        session.stop().unwrap();
        let run = session.take_finished().remove(0).simulated;
        assert!(run.changes.iter().any(|c| c.quantity == "limits"), "{:?}", run.changes);
    }
}

#[test]
fn a_joint_that_is_made_has_the_stops_that_it_was_given() {
    let mut session = open(&box_above_floor(0.05));
    session.start().unwrap();
    let joint = call(&mut session, "sim.createJoint", &[11_i64.into(), 5_i64.into(), 0_i64.into()])[0].clone();
    let joint = joint.as_int().unwrap();
    put(&mut session, joint, [0.0, 2.0, 1.0]);
    call(&mut session, "sim.setJointInterval", &[joint.into(), false.into(), Value::reals([-0.1, 0.2])]);
    let got = call(&mut session, "sim.getJointInterval", &[joint.into()]);
    assert_eq!(got, [false.into(), Value::reals([-0.1, 0.2])]);
    let refused = [joint.into(), false.into(), Value::reals([0.1, 0.2])];
    let told = session.call("sim.setJointInterval", &refused).unwrap_err().0;
    assert!(told.contains("stands at 0"), "{told}");
    let size = Value::reals([0.1, 0.1, 0.1]);
    let made = call(&mut session, "sim.createPureShape", &[1_i64.into(), 0_i64.into(), size, 2.0.into()])[0].clone();
    let ball = made.as_int().unwrap();
    put(&mut session, ball, [0.0, 2.0, 1.0]);
    call(&mut session, "sim.setObjectParent", &[ball.into(), joint.into(), true.into()]);
    // it falls along z onto its lower stop
    steps(&mut session, 100);
    let [.., z] = position(&mut session, ball);
    assert!((z - 0.9).abs() < 1e-9, "{z} m");
}

#[test]
fn a_joint_that_is_made_has_the_motor_that_it_was_given() {
    let mut session = open(&box_above_floor(0.05));
    session.start().unwrap();
    let joint = call(&mut session, "sim.createJoint", &[10_i64.into(), 5_i64.into(), 0_i64.into()])[0].clone();
    let joint = joint.as_int().unwrap();
    put(&mut session, joint, [0.0, 2.0, 1.0]);
    let off = session.call("sim.setJointTargetForce", &[joint.into(), 5.0.into()]).unwrap_err().0;
    assert!(off.contains("is off"), "{off}");
    call(&mut session, "sim.setObjectInt32Param", &[joint.into(), 2000_i64.into(), 1_i64.into()]);
    call(&mut session, "sim.setJointTargetForce", &[joint.into(), 5.0.into()]);
    let size = Value::reals([0.1, 0.1, 0.1]);
    let made = call(&mut session, "sim.createPureShape", &[1_i64.into(), 0_i64.into(), size, 2.0.into()])[0].clone();
    let ball = made.as_int().unwrap();
    put(&mut session, ball, [0.0, 2.0, 1.0]);
    call(&mut session, "sim.setObjectParent", &[ball.into(), joint.into(), true.into()]);
    call(&mut session, "sim.setJointTargetVelocity", &[joint.into(), 0.5.into()]);
    assert_eq!(call(&mut session, "sim.getJointTargetForce", &[joint.into()]), [Value::Real(5.0)]);
    let before = call(&mut session, "sim.getJointPosition", &[joint.into()])[0].as_real().unwrap();
    steps(&mut session, 10);
    let after = call(&mut session, "sim.getJointPosition", &[joint.into()])[0].as_real().unwrap();
    // 10 steps of 5 ms at 0.5 rad/s, which 5 N·m on 2/5 m r² reach at 2500 rad/s²
    assert!((after - before - (0.025 - 0.5 * 0.25 / 2500.0)).abs() < 1e-9, "{} rad", after - before);
}

#[test]
fn a_force_sensor_that_is_made_measures_what_is_hung_on_it() {
    let mut session = open(&box_above_floor(0.05));
    session.start().unwrap();
    steps(&mut session, 2);
    let sensor = call(&mut session, "sim.createForceSensor", &[0_i64.into()])[0].as_int().unwrap();
    assert_eq!(call(&mut session, "sim.getObjectType", &[sensor.into()]), [Value::Int(12)]);
    put(&mut session, sensor, [0.0, 2.0, 1.0]);
    let nothing = call(&mut session, "sim.readForceSensor", &[sensor.into()]);
    assert_eq!(nothing[1..], [Value::reals([0.0; 3]), Value::reals([0.0; 3])]);
    let size = Value::reals([0.1, 0.1, 0.1]);
    let made = call(&mut session, "sim.createPureShape", &[0_i64.into(), 0_i64.into(), size, 2.0.into()])[0].clone();
    let body = made.as_int().unwrap();
    put(&mut session, body, [0.3, 2.0, 1.0]);
    call(&mut session, "sim.setObjectParent", &[body.into(), sensor.into(), true.into()]);
    steps(&mut session, 5);
    let read = call(&mut session, "sim.readForceSensor", &[sensor.into()]);
    let (force, torque) = (reals(&read[1]), reals(&read[2]));
    let weight = 2.0 * G;
    // what the body exerts on the sensor: its weight, 0.3 m along x
    for (value, expected) in force.iter().chain(&torque).zip([0.0, 0.0, -weight, 0.0, 0.3 * weight, 0.0]) {
        assert!((value - expected).abs() < 1e-9, "{force:?} {torque:?}");
    }
    let [x, _, z] = position(&mut session, body);
    assert!((x - 0.3).abs() < 1e-12 && (z - 1.0).abs() < 1e-12, "it stays where it is");
    let hang = |session: &mut Session, on: i64| {
        call(session, "sim.setObjectParent", &[body.into(), on.into(), true.into()]);
        steps(session, 5);
        reals(&call(session, "sim.readForceSensor", &[sensor.into()])[1])
    };
    // parted it falls, and the sensor carries nothing, stays where it is and takes it again
    assert_eq!(hang(&mut session, -1), [0.0; 3]);
    assert_eq!(call(&mut session, "sim.getObjectType", &[sensor.into()]), [Value::Int(12)]);
    assert!(position(&mut session, body)[2] < 1.0 - 1e-4);
    assert_eq!(position(&mut session, sensor), [0.0, 2.0, 1.0]);
    put(&mut session, sensor, [0.0, 2.0, 2.0]);
    let force = hang(&mut session, sensor);
    assert!((force[2] + weight).abs() < 1e-9, "{force:?}");
    assert_eq!(call(&mut session, "sim.getObjectParent", &[body.into()]), [sensor.into()]);
    call(&mut session, "sim.removeObjects", &[Value::List(vec![body.into()])]);
    steps(&mut session, 1);
    let other = call(&mut session, "sim.createForceSensor", &[0_i64.into()])[0].clone();
    let stops = session.call("sim.setJointInterval", &[other, false.into(), Value::reals([-0.1, 0.2])]).unwrap_err().0;
    assert!(stops.contains("only revolute and prismatic joints have stops"), "{stops}");
    let breaks = session.call("sim.createForceSensor", &[1_i64.into()]).unwrap_err().0;
    assert!(breaks.contains("breaks"), "{breaks}");
}

#[test]
fn bodies_that_were_made_are_grouped_to_one() {
    let mut session = open(&box_above_floor(0.05));
    let make = |session: &mut Session, place: [f64; 3], mass: f64, options: i64| {
        let size = Value::reals([0.1, 0.1, 0.1]);
        let made = call(session, "sim.createPureShape", &[0_i64.into(), options.into(), size, mass.into()])[0].clone();
        put(session, made.as_int().unwrap(), place);
        made.as_int().unwrap()
    };
    let first = make(&mut session, [2.0, 0.0, 0.5], 1.0, 8);
    let others = [([2.2, 0.0, 0.5], 1.0), ([2.0, 0.3, 0.5], 2.0)].map(|(at, mass)| make(&mut session, at, mass, 0));
    let dummy = call(&mut session, "sim.createDummy", &[0.01.into()])[0].as_int().unwrap();
    put(&mut session, dummy, [2.3, 0.0, 0.5]);
    call(&mut session, "sim.setObjectParent", &[dummy.into(), others[0].into(), true.into()]);
    let n_before = session.sim().world.state.v.len();
    let list = |all: &[i64]| Value::List(all.iter().map(|h| Value::from(*h)).collect());
    let grouped = call(&mut session, "sim.groupShapes", &[list(&[first, others[0], others[1]]), false.into()]);
    assert_eq!(grouped, [first.into()]);
    assert_eq!(session.sim().world.state.v.len(), n_before - 12, "one body is loose in place of three");
    assert_eq!(call(&mut session, "sim.isHandle", &[others[0].into()]), [false.into()]);
    assert_eq!(call(&mut session, "sim.getObjectParent", &[dummy.into()]), [first.into()]);
    let place = position(&mut session, dummy);
    assert!(place.iter().zip([2.3, 0.0, 0.5]).all(|(x, y)| (x - y).abs() < 1e-12), "{place:?}");
    let mass = call(&mut session, "sim.getShapeMass", &[first.into()])[0].as_real().unwrap();
    assert!((mass - 4.0).abs() < 1e-12);
    let told = call(&mut session, "sim.getShapeInertia", &[first.into()]);
    let (inertia, place) = (reals(&told[0]), reals(&told[1]));
    let own = 0.1 * 0.1 / 6.0;
    // about the common centre of mass (0.05, 0.15) m from the first
    let ix = 2.0 * 0.15 * 0.15 + 2.0 * 0.15 * 0.15 + 4.0 * own;
    let iy = 2.0 * 0.05 * 0.05 + 0.15 * 0.15 + 2.0 * 0.05 * 0.05 - 0.05 * 0.05 + 4.0 * own;
    let xy = -(0.05 * 0.15 - 0.15 * 0.15 - 2.0 * 0.05 * 0.15);
    assert!((place[3] - 0.05).abs() < 1e-12 && (place[7] - 0.15).abs() < 1e-12, "{place:?}");
    for (found, expected) in [(inertia[0], ix), (inertia[4], iy), (inertia[8], ix + iy - 4.0 * own), (inertia[1], xy)] {
        assert!((found - expected).abs() < 1e-12, "{inertia:?}: {expected}");
    }
    session.start().unwrap();
    steps(&mut session, 20);
    let z = position(&mut session, first)[2];
    assert!((z - (0.5 - 0.5 * G * 0.1 * 0.1)).abs() < 1e-6, "it falls: {z} m");
    let moving = make(&mut session, [5.0, 0.0, 1.0], 1.0, 0);
    let why = session.call("sim.groupShapes", &[list(&[first, moving])]).unwrap_err().0;
    assert!(why.contains("move against each other") && why.contains("setObjectParent"), "{why}");
    let shape = call(&mut session, "sim.createPrimitiveShape", &[3_i64.into(), Value::reals([0.1; 3])])[0].clone();
    let why = session.call("sim.groupShapes", &[Value::List(vec![first.into(), shape])]).unwrap_err().0;
    assert!(why.contains("or none"), "{why}");
    let run = finished(&mut session);
    assert!(run.energy.residual < 1e-6, "{:?}", run.energy);
}

/// A cube of 0.1 m that is made at a place.
fn cube(session: &mut Session, place: [f64; 3], mass: f64) -> i64 {
    let size = Value::reals([0.1; 3]);
    let made = call(session, "sim.createPureShape", &[0_i64.into(), 0_i64.into(), size, mass.into()])[0].clone();
    put(session, made.as_int().unwrap(), place);
    made.as_int().unwrap()
}

fn hang(session: &mut Session, object: i64, parent: i64) {
    call(session, "sim.setObjectParent", &[object.into(), parent.into(), true.into()]);
}

fn list(all: &[i64]) -> Value {
    Value::List(all.iter().map(|h| Value::from(*h)).collect())
}

fn mass(session: &mut Session, body: i64) -> f64 {
    call(session, "sim.getShapeMass", &[body.into()])[0].as_real().unwrap()
}

fn paths(session: &mut Session) -> Vec<String> {
    session.registry().entries().map(|entry| entry.path.clone()).collect()
}

#[test]
fn bodies_that_are_joined_in_a_chain_are_grouped_in_any_order() {
    for order in [[0, 2, 1], [0, 1, 2]] {
        let mut session = open(&box_above_floor(0.05));
        let before = paths(&mut session).len();
        let all = [1.0, 2.0, 4.0].map(|mass| cube(&mut session, [2.0 + 0.2 * mass, 0.0, 0.5], mass));
        hang(&mut session, all[1], all[0]);
        hang(&mut session, all[2], all[1]);
        let grouped = call(&mut session, "sim.groupShapes", &[list(&order.map(|k| all[k]))]);
        assert_eq!(grouped, [all[0].into()]);
        assert!((mass(&mut session, all[0]) - 7.0).abs() < 1e-12, "{order:?}: {} kg", mass(&mut session, all[0]));
        let left = paths(&mut session);
        assert_eq!(left.len(), before + 2, "one body with its free joint: {left:?}");
        session.start().unwrap();
        steps(&mut session, 2);
    }
}

#[test]
fn joined_bodies_are_removed_at_once_and_what_is_between_them_stays() {
    let mut session = open(&box_above_floor(0.05));
    let all = [2.0, 3.0, 4.0].map(|x| cube(&mut session, [x, 0.0, 0.5], 1.0));
    let original = handle(&mut session, "/box");
    let copies = call(&mut session, "sim.copyPasteObjects", &[list(&[original]), 0_i64.into()]);
    let last = handles(&copies[0])[0];
    for pair in [[all[1], all[0]], [all[2], all[1]], [last, all[2]]] {
        hang(&mut session, pair[0], pair[1]);
    }
    call(&mut session, "sim.removeObjects", &[list(&[all[1], last])]);
    let _ = session.sim();
    let left = paths(&mut session);
    assert!(session.registry().entry(Handle(last as i32)).is_err(), "{left:?}");
    assert_eq!(call(&mut session, "sim.getObjectParent", &[all[2].into()]), [all[0].into()]);
    assert!((position(&mut session, all[2])[0] - 4.0).abs() < 1e-12);
}

const TAGGED: &str = r#"
[[joint]]
name = "car"
kind = "free"
initial = { position = [0.0, 3.0, 1.0, 1.0, 0.0, 0.0, 0.0] }
[[body]]
name = "chassis"
parent = "/car"
mass = 2.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
[[frame]]
name = "antenna"
parent = "/car"
position = [0.0, 0.0, 0.5]
[[frame]]
name = "mark"
parent = "/car/chassis"
position = [0.2, 0.0, 0.0]
"#;

fn tagged() -> String {
    format!("{}{TAGGED}", box_above_floor(0.05))
}

#[test]
fn what_hangs_on_a_loose_body_that_is_removed_alone_stays_where_it_is() {
    // a force acts on the body: it goes with it
    let push = "[[force]]\nname = \"push\"\nparent = \"/car/chassis\"\nforce = [1.0, 0.0, 0.0]\n";
    let mut session = open(&format!("{}{push}", tagged()));
    let [chassis, antenna, mark] = ["/chassis", "/antenna", "/mark"].map(|path| handle(&mut session, path));
    let dummy = call(&mut session, "sim.createDummy", &[0.01.into()])[0].as_int().unwrap();
    hang(&mut session, dummy, chassis);
    call(&mut session, "sim.removeObjects", &[list(&[chassis])]);
    let left: Vec<String> = paths(&mut session).into_iter().filter(|path| !path.contains("box")).collect();
    assert_eq!(left, ["/floor", "/mark", "/antenna", "/Dummy"]);
    for (object, place) in [(antenna, [0.0, 3.0, 1.5]), (mark, [0.2, 3.0, 1.0])] {
        assert_eq!(call(&mut session, "sim.getObjectParent", &[object.into()]), [Value::Int(-1)]);
        assert!(position(&mut session, object).iter().zip(place).all(|(x, y)| (x - y).abs() < 1e-12));
    }
}

/// Two copies of a body with what is beside it on its joint.
fn two_copies(session: &mut Session) -> [i64; 2] {
    let original = handle(session, "/chassis");
    [(); 2].map(|()| {
        let copies = call(session, "sim.copyPasteObjects", &[list(&[original]), 1_i64.into()]);
        handles(&copies[0])[0]
    })
}

#[test]
fn what_is_beside_a_body_that_is_grouped_hangs_on_the_first_one() {
    let mut session = open(&tagged());
    let [body, _] = two_copies(&mut session);
    let below = call(&mut session, "sim.getObjectsInTree", &[body.into(), (-2_i64).into(), 1_i64.into()]);
    let below = handles(&below[0]);
    let places: Vec<[f64; 3]> = below.iter().map(|object| position(&mut session, *object)).collect();
    assert_eq!(below.len(), 2, "antenna, mark");
    let first = cube(&mut session, [2.0, 3.0, 1.0], 1.0);
    call(&mut session, "sim.groupShapes", &[list(&[first, body])]);
    assert!((mass(&mut session, first) - 3.0).abs() < 1e-12);
    for (object, place) in below.iter().zip(places) {
        assert_eq!(call(&mut session, "sim.getObjectParent", &[(*object).into()]), [first.into()]);
        assert!(position(&mut session, *object).iter().zip(place).all(|(x, y)| (x - y).abs() < 1e-12));
    }
}

#[test]
fn marks_of_bodies_that_are_grouped_get_names_of_their_own() {
    let mut session = open(&tagged());
    let [first, other] = two_copies(&mut session);
    let dummy = call(&mut session, "sim.createDummy", &[0.01.into()])[0].as_int().unwrap();
    hang(&mut session, dummy, other);
    let n = paths(&mut session).len();
    // marks of both would have the same path
    call(&mut session, "sim.groupShapes", &[list(&[first, other])]);
    assert_eq!(call(&mut session, "sim.getObjectParent", &[dummy.into()]), [first.into()]);
    let after = paths(&mut session);
    assert!(after.iter().enumerate().all(|(k, path)| !after[..k].contains(path)), "{after:?}");
    // the other body has gone, and what let it move freely
    assert!(after.len() < n);
}

#[test]
fn meshes_of_bodies_and_shapes_are_given_in_their_own_axes() {
    let mut session = open(&box_above_floor(1.0));
    let body = handle(&mut session, "/box_joint/box");
    let mesh = call(&mut session, "sim.getShapeMesh", &[body.into()]);
    let Value::List(indices) = &mesh[1] else { panic!("indices") };
    assert_eq!((reals(&mesh[0]).len(), indices.len(), reals(&mesh[2]).len()), (24, 36, 108));
    let box_ = call(&mut session, "sim.getShapeBB", &[body.into()]);
    let size = reals(&box_[0]);
    assert!(reals(&mesh[0]).chunks(3).all(|p| (0..3).all(|k| (p[k].abs() - 0.5 * size[k]).abs() < 1e-12)));
    // the mesh makes a shape of the same size
    let shape = call(&mut session, "sim.createShape", &[0_i64.into(), 0.0.into(), mesh[0].clone(), mesh[1].clone()]);
    let again = call(&mut session, "sim.getShapeBB", &[shape[0].clone()]);
    assert!(reals(&again[0]).iter().zip(&size).all(|(a, b)| (a - b).abs() < 1e-12));
    let viz = call(&mut session, "sim.getShapeViz", &[body.into(), 0_i64.into()]);
    let Value::Map(viz) = &viz[0] else { panic!("a map") };
    assert_eq!(viz.iter().find(|(name, _)| name == "vertices").map(|(_, value)| value), Some(&mesh[0]));
    assert_eq!(call(&mut session, "sim.getShapeViz", &[body.into(), 1_i64.into()]), [Value::Nil]);
    let floor = handle(&mut session, "/floor");
    let refused = session.call("sim.getShapeMesh", &[floor.into()]).unwrap_err();
    assert!(refused.0.contains("a plane has no mesh"), "{refused:?}");
}

#[test]
fn copies_of_selected_objects_are_selected() {
    let mut session = open(&box_above_floor(1.0));
    let shape = call(&mut session, "sim.createPrimitiveShape", &[3_i64.into(), Value::reals([0.1, 0.2, 0.3])]);
    let own = shape[0].as_int().unwrap();
    call(&mut session, "sim.setObjectSel", &[Value::List(shape)]);
    call(&mut session, "sim.copyPasteSelectedObjects", &[]);
    let copy = call(&mut session, "sim.getObjectLastSelection", &[])[0].as_int().unwrap();
    assert_ne!(copy, own);
    call(&mut session, "sim.scaleSelectedObjects", &[2.0.into(), false.into()]);
    let box_ = call(&mut session, "sim.getShapeBB", &[copy.into()]);
    assert_eq!(reals(&box_[0]), [0.2, 0.4, 0.6]);
    call(&mut session, "sim.deleteSelectedObjects", &[]);
    assert!(session.call("sim.getShapeBB", &[copy.into()]).is_err());
    assert!(session.call("sim.getShapeBB", &[own.into()]).is_ok());
}

#[test]
fn a_body_hung_on_a_dummy_that_was_made_goes_with_it() {
    let mut session = open(&box_above_floor(1.0));
    let box_ = handle(&mut session, "/box");
    session.start().unwrap();
    let dummies: Vec<i64> =
        (0..2).map(|_| call(&mut session, "sim.createDummy", &[0.01.into()])[0].as_int().unwrap()).collect();
    let [rail, hanger] = dummies[..] else { panic!() };
    put(&mut session, rail, [1.0, 0.0, 2.0]);
    call(&mut session, "sim.setObjectParent", &[hanger.into(), rail.into(), false.into()]);
    call(&mut session, "sim.setObjectParent", &[box_.into(), hanger.into(), true.into()]);
    assert_eq!(call(&mut session, "sim.getObjectChild", &[hanger.into(), 0_i64.into()]), [Value::Int(box_)]);
    assert_eq!(call(&mut session, "sim.getObjectParent", &[box_.into()]), [Value::Int(hanger)]);
    let before = position(&mut session, box_);
    steps(&mut session, 3);
    // it is carried, and goes where each of the dummies is put
    assert_eq!(position(&mut session, box_), before);
    put(&mut session, hanger, [1.5, 0.0, 2.0]);
    put(&mut session, rail, [1.0, 0.25, 2.0]);
    let now = position(&mut session, box_);
    assert!((0..3).all(|k| (now[k] - before[k] - [0.5, 0.25, 0.0][k]).abs() < 1e-12), "{before:?} {now:?}");
    assert_eq!(call(&mut session, "sim.getObjectType", &[hanger.into()]), [Value::Int(4)]);
    // let go it falls; the dummies can be removed
    call(&mut session, "sim.setObjectParent", &[box_.into(), (-1_i64).into(), true.into()]);
    steps(&mut session, 2);
    assert!(position(&mut session, box_)[2] < before[2]);
    call(&mut session, "sim.removeObjects", &[Value::List(vec![(-1_i64).into(), rail.into(), hanger.into()])]);
    assert!(session.call("sim.getObjectPosition", &[hanger.into()]).is_err());
    assert!(session.call("sim.removeObjects", &[Value::List(vec![hanger.into()])]).is_err());
}
