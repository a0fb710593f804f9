//! Object tree as clients see it: loose bodies hang on the world, without the joints that let them move.

use sincro_coppelia::api::{Handle, Search, Value};
use sincro_coppelia::session::Session;
use sincro_sim::Extensions;
use sincro_testing::{OpenSession, SceneFolder};

const SCENE: &str = r#"
gravity = [0.0, 0.0, -9.81]

[[joint]]
name = "cube_free"
kind = "free"
initial = { position = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0] }

[[body]]
name = "cube"
parent = "/cube_free"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[frame]]
name = "mark"
parent = "/cube_free/cube"
position = [0.1, 0.0, 0.0]

[[joint]]
name = "other_free"
kind = "free"
initial = { position = [1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0] }

[[body]]
name = "cube"
parent = "/other_free"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }

[[body]]
name = "table"
density = 500.0
shape = [{ cuboid = { size = [1.0, 1.0, 0.1] } }]

[[joint]]
name = "cup_free"
parent = "/table"
kind = "free"

[[body]]
name = "cup"
parent = "/table/cup_free"
mass = 0.1
inertia = { xx = 0.001, yy = 0.001, zz = 0.001 }

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

[[body]]
name = "plate"
parent = "/car/chassis"
position = [0.2, 0.0, 0.0]
mass = 0.5
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
"#;

const EXPERIMENT: &str = "title = \"Tree\"\nduration = 10.0\nstep = 0.005\nrecord = [\"energy.balance\"]\n";

fn open() -> OpenSession {
    OpenSession::open(SceneFolder::of(SCENE, EXPERIMENT), &[], Extensions::default(), None)
}

fn call(session: &mut Session, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn handle(session: &mut Session, path: &str) -> i64 {
    i64::from(session.registry().find(path, Search::default()).unwrap().0)
}

fn int(session: &mut Session, name: &str, arguments: &[Value]) -> i64 {
    call(session, name, arguments)[0].as_int().unwrap()
}

fn list(values: &[Value]) -> Vec<i64> {
    let Value::List(list) = &values[0] else { panic!("a list of handles") };
    list.iter().map(|value| value.as_int().unwrap()).collect()
}

fn position(session: &mut Session, object: i64, of: i64) -> Vec<f64> {
    call(session, "sim.getObjectPosition", &[object.into(), of.into()])[0].as_reals().unwrap()
}

fn near(a: &[f64], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-12)
}

#[test]
fn a_loose_body_hangs_on_the_world() {
    let mut s = open();
    let cube = handle(&mut s, "/cube_free/cube");
    let joint = handle(&mut s, "/cube_free");
    assert_eq!(handle(&mut s, "/cube"), cube);
    assert_eq!(handle(&mut s, "/cube[0]"), cube);
    assert_eq!(handle(&mut s, "/cube[1]"), handle(&mut s, "/other_free/cube"));
    assert_eq!(handle(&mut s, "/cube/mark"), handle(&mut s, "/cube_free/cube/mark"));
    assert_eq!(int(&mut s, "sim.getObjectParent", &[cube.into()]), -1);
    let everything = list(&call(&mut s, "sim.getObjectsInTree", &[(-12_i64).into()]));
    assert!(!everything.contains(&joint) && everything.contains(&cube));
    assert!(session_error(&mut s, "/cube{2}").contains("does not exist"), "each of them is counted once");
}

fn session_error(session: &mut Session, path: &str) -> String {
    session.registry().find(path, Search::default()).unwrap_err().0
}

#[test]
fn aliases_with_paths_find_their_objects() {
    let mut s = open();
    for (path, alias) in [
        ("/cube_free/cube", "/cube[0]"),
        ("/other_free/cube", "/cube[1]"),
        ("/cube_free/cube/mark", "/cube[0]/mark"),
        ("/cube_free", "/cube_free"),
        ("/car/chassis", "/chassis"),
        ("/car/antenna", "/chassis/antenna"),
        ("/car/chassis/plate", "/chassis/plate"),
    ] {
        let own = handle(&mut s, path);
        for option in [1_i64, 2] {
            let found = call(&mut s, "sim.getObjectAlias", &[own.into(), option.into()]);
            assert_eq!(found[0].as_text(), Some(alias), "{path}");
        }
        assert_eq!(handle(&mut s, alias), own, "{alias}");
    }
}

#[test]
fn what_is_beside_a_body_on_its_joint_hangs_on_the_body() {
    let mut s = open();
    let [chassis, antenna, plate] =
        ["/car/chassis", "/car/antenna", "/car/chassis/plate"].map(|path| handle(&mut s, path));
    assert_eq!(int(&mut s, "sim.getObjectParent", &[antenna.into()]), chassis);
    assert!(near(&position(&mut s, antenna, -11), [0.0, 0.0, 0.5]), "in the frame that moves");
    let tree = list(&call(&mut s, "sim.getObjectsInTree", &[chassis.into()]));
    assert_eq!(tree, [chassis, plate, antenna]);
    let children = [0_i64, 1, 2].map(|k| int(&mut s, "sim.getObjectChild", &[chassis.into(), k.into()]));
    assert_eq!(children, [plate, antenna, -1]);
    let joint = handle(&mut s, "/car");
    assert_eq!(int(&mut s, "sim.getObjectChild", &[joint.into(), 0_i64.into()]), chassis);
}

#[test]
fn a_body_is_put_in_the_frame_of_the_world_when_its_parent_is_asked_for() {
    let mut s = open();
    let cube = handle(&mut s, "/cube");
    call(&mut s, "sim.setObjectPosition", &[cube.into(), Value::reals([1.0, 2.0, 3.0]), (-11_i64).into()]);
    assert!(near(&position(&mut s, cube, -1), [1.0, 2.0, 3.0]));
    assert!(near(&position(&mut s, cube, -11), [1.0, 2.0, 3.0]));
}

#[test]
fn a_body_that_is_loose_beside_a_fixed_one_is_moved_by_its_joint() {
    let mut s = open();
    let [table, cup] = ["/table", "/table/cup"].map(|path| handle(&mut s, path));
    assert_eq!(int(&mut s, "sim.getObjectParent", &[cup.into()]), table);
    s.start().unwrap();
    s.step().unwrap();
    call(&mut s, "sim.setObjectPosition", &[cup.into(), Value::reals([0.1, 0.2, 0.3]), table.into()]);
    assert!(near(&position(&mut s, cup, -1), [0.1, 0.2, 0.3]));
    s.step().unwrap();
    s.stop().unwrap();
    let run = s.take_finished().remove(0).simulated;
    assert!(run.changes.is_empty(), "the structure stays: {:?}", run.changes);
}

#[test]
fn a_body_that_is_joined_to_another_one_is_put_elsewhere_alone() {
    let mut s = open();
    let [chassis, plate, cube] = ["/chassis", "/chassis/plate", "/cube"].map(|path| handle(&mut s, path));
    let before = position(&mut s, chassis, -1);
    call(&mut s, "sim.setObjectPosition", &[plate.into(), Value::reals([-0.2, 0.0, 0.0]), chassis.into()]);
    assert!(near(&position(&mut s, plate, chassis), [-0.2, 0.0, 0.0]));
    assert_eq!(position(&mut s, chassis, -1), before);
    // one that was loose, too
    call(&mut s, "sim.setObjectParent", &[cube.into(), chassis.into(), true.into()]);
    assert_eq!(int(&mut s, "sim.getObjectParent", &[cube.into()]), chassis);
    assert!(near(&position(&mut s, cube, -1), [0.0, 0.0, 1.0]));
    call(&mut s, "sim.setObjectPosition", &[cube.into(), Value::reals([0.0, 0.0, 0.3]), chassis.into()]);
    assert!(near(&position(&mut s, cube, chassis), [0.0, 0.0, 0.3]));
    assert_eq!(position(&mut s, chassis, -1), before);
    let tree = list(&call(&mut s, "sim.getObjectsInTree", &[chassis.into(), (-2_i64).into(), 1_i64.into()]));
    assert!(tree.contains(&cube) && tree.len() == 4, "cube, mark, plate, antenna: {tree:?}");
    call(&mut s, "sim.setObjectParent", &[cube.into(), (-1_i64).into(), true.into()]);
    assert_eq!(int(&mut s, "sim.getObjectParent", &[cube.into()]), -1);
    s.start().unwrap();
    for _ in 0..20 {
        s.step().unwrap();
    }
    let fallen = position(&mut s, cube, -1)[2];
    assert!(fallen < 1.3 - 0.5 * 9.81 * 0.1 * 0.1 + 0.01, "it is loose again: z = {fallen} m");
}

#[test]
fn models_are_removed_and_copied_with_all_that_clients_see_below_them() {
    let mut s = open();
    let [chassis, cube] = ["/chassis", "/cube"].map(|path| handle(&mut s, path));
    call(&mut s, "sim.setObjectParent", &[cube.into(), chassis.into(), true.into()]);
    let copies = list(&call(&mut s, "sim.copyPasteObjects", &[Value::List(vec![cube.into()]), 0_i64.into()]));
    assert_eq!(int(&mut s, "sim.getObjectParent", &[copies[0].into()]), -1);
    assert_eq!(int(&mut s, "sim.removeModel", &[chassis.into()]), 5);
    let left: Vec<String> = s.registry().entries().map(|entry| entry.path.clone()).collect();
    assert!(left.iter().all(|path| !path.contains("car") && !path.contains("cube_free")), "{left:?}");
    call(&mut s, "sim.removeObject", &[copies[0].into()]);
    assert_eq!(
        s.sim().registry.entries().map(|entry| &*entry.path).collect::<Vec<_>>(),
        ["/other_free", "/other_free/cube", "/table", "/table/cup_free", "/table/cup_free/cup"]
    );
    assert!(s.registry().entry(Handle(cube as i32)).is_err());
}

#[test]
fn a_model_is_copied_with_what_is_beside_its_body_on_the_joint() {
    let mut s = open();
    let chassis = handle(&mut s, "/chassis");
    let copies = call(&mut s, "sim.copyPasteObjects", &[Value::List(vec![chassis.into()]), 1_i64.into()]);
    let copy = list(&copies)[0];
    assert_eq!(int(&mut s, "sim.getObjectParent", &[copy.into()]), -1);
    let below = call(&mut s, "sim.getObjectsInTree", &[copy.into(), (-2_i64).into(), 1_i64.into()]);
    let below = list(&below[..1]);
    assert_eq!(below.len(), 2, "the plate and the antenna");
    call(&mut s, "sim.setObjectPosition", &[copy.into(), Value::List([5.0, 0.0, 1.0].map(Value::from).to_vec())]);
    let places: Vec<Vec<f64>> = below.iter().map(|object| position(&mut s, *object, -1)).collect();
    assert!(places.iter().any(|place| near(place, [5.0, 0.0, 1.5])), "the antenna: {places:?}");
    assert!(places.iter().any(|place| near(place, [5.2, 0.0, 1.0])), "the plate: {places:?}");
    let saved = call(&mut s, "sim.saveModel", &[copy.into()])[0].clone();
    let loaded = call(&mut s, "sim.loadModel", &[saved])[0].as_int().unwrap();
    let names = |s: &mut Session, of: i64| list(&call(s, "sim.getObjectsInTree", &[of.into()])).len();
    assert_eq!(names(&mut s, loaded), 4, "below the frame of the model: the body, the plate and the antenna");
    // alone without its model
    let alone = call(&mut s, "sim.copyPasteObjects", &[Value::List(vec![chassis.into()]), 0_i64.into()]);
    let alone = list(&alone)[0];
    let below = call(&mut s, "sim.getObjectsInTree", &[alone.into(), (-2_i64).into(), 1_i64.into()]);
    assert!(list(&below[..1]).is_empty());
}

/// Two models, and a frame that hangs on none.
const MODELS: &str = r#"
[[frame]]
name = "robotA"
[[frame]]
name = "gripper"
parent = "/robotA"
[[frame]]
name = "robotB"
[[frame]]
name = "arm"
parent = "/robotB"
[[frame]]
name = "tip"
parent = "/robotB/arm"
[[frame]]
name = "alone"
"#;

#[test]
fn a_path_from_the_model_of_a_script_finds_no_object_of_another_model() {
    let scene = [SCENE, MODELS].concat();
    let mut session = OpenSession::open(SceneFolder::of(&scene, EXPERIMENT), &[], Extensions::default(), None);
    let mut find =
        |path: &str, from: Option<Handle>| session.registry().find(path, Search { from, ..Search::default() });
    let [gripper, arm, tip, alone] = ["/gripper", "/arm", "/tip", "/alone"].map(|path| find(path, None).unwrap());
    assert_eq!(find(":/tip", Some(arm)), Ok(tip));
    assert!(find(":/gripper", Some(arm)).is_err());
    assert_eq!(find(":/gripper", Some(alone)), Ok(gripper));
    assert_eq!(find(":/gripper", None), Ok(gripper));
}
