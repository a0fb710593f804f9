//! Shapes that clients make one after the other and that become bodies of the model at once; octrees and point clouds.

use std::sync::Arc;

use sincro_coppelia::api::{Search, Value};
use sincro_coppelia::session::Session;
use sincro_sim::Extensions;
use sincro_testing::scenes::box_above_floor;
use sincro_testing::{OpenSession, SceneFolder};

/// Acceleration of gravity [m/s²].
const G: f64 = 9.81;
/// `sim.shapeintparam_static`, `sim.shapeintparam_respondable`.
const STATIC: i64 = 3003;
const RESPONDABLE: i64 = 3004;

const EXPERIMENT: &str = r#"
title = "Batches"
duration = 10.0
step = 0.005
record = ["energy.balance"]
error_bar = "none"
"#;

fn open() -> OpenSession {
    OpenSession::open(SceneFolder::of(&box_above_floor(0.05), EXPERIMENT), &[], Extensions::default(), None)
}

fn call(session: &mut Session, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn number(session: &mut Session, name: &str, arguments: &[Value]) -> f64 {
    call(session, name, arguments)[0].as_real().unwrap()
}

/// A cube of 0.1 m at a place.
fn cube(session: &mut Session, place: [f64; 3]) -> Value {
    let made = call(session, "sim.createPrimitiveShape", &[3_i64.into(), Value::reals([0.1; 3]), 0_i64.into()]);
    let [own] = <[Value; 1]>::try_from(made).unwrap();
    call(session, "sim.setObjectPosition", &[own.clone(), Value::reals(place), (-1_i64).into()]);
    own
}

fn set(session: &mut Session, shape: &Value, parameter: i64, value: i64) {
    call(session, "sim.setObjectInt32Param", &[shape.clone(), parameter.into(), value.into()]);
}

/// A cube that moves and touches others.
fn dynamic_cube(session: &mut Session, place: [f64; 3]) -> Value {
    let own = cube(session, place);
    set(session, &own, STATIC, 0);
    set(session, &own, RESPONDABLE, 1);
    own
}

fn height(session: &mut Session, shape: &Value) -> f64 {
    call(session, "sim.getObjectPosition", &[shape.clone(), (-1_i64).into()])[0].as_reals().unwrap()[2]
}

#[test]
fn shapes_made_between_two_steps_are_one_change_of_the_scene() {
    let mut session = open();
    session.start().unwrap();
    let before = Arc::clone(session.registry().scene());
    let cubes: Vec<Value> =
        (0..200).map(|k| dynamic_cube(&mut session, [1.0 + f64::from(k % 20), 1.0 + f64::from(k / 20), 2.0])).collect();
    assert!(Arc::ptr_eq(&before, session.registry().scene()), "the scene was compiled before the step");
    session.step().unwrap();
    let after = session.registry().scene();
    // a body and a free joint for each
    assert_eq!(after.objects.len(), before.objects.len() + 400);
    let t = session.registry().sample_time();
    for cube in &cubes {
        let z = height(&mut session, cube);
        assert!((z - (2.0 - 0.5 * G * t * t)).abs() < 1e-9, "z = {z} m");
    }
}

#[test]
fn bodies_removed_one_after_the_other_are_one_change_of_the_scene() {
    let mut session = open();
    session.start().unwrap();
    let cubes: Vec<Value> =
        (0..60).map(|k| dynamic_cube(&mut session, [1.0 + f64::from(k % 20), 1.0 + f64::from(k / 20), 2.0])).collect();
    session.step().unwrap();
    let before = Arc::clone(session.registry().scene());
    for (k, cube) in cubes.iter().enumerate().skip(10) {
        let name = call(&mut session, "sim.getObjectName", std::slice::from_ref(cube)).remove(0);
        let path = format!("/{}", name.as_text().unwrap());
        assert_eq!(&call(&mut session, "sim.getObject", &[path.as_str().into()])[0], cube, "{k}");
        call(&mut session, "sim.removeObject", std::slice::from_ref(cube));
    }
    assert!(Arc::ptr_eq(&before, session.registry().scene()), "the scene was compiled for each");
    // whoever asks finds them gone
    assert_eq!(call(&mut session, "sim.isHandle", std::slice::from_ref(&cubes[59])), [Value::Bool(false)]);
    assert_eq!(session.registry().scene().objects.len(), before.objects.len() - 100);
    let gone = session.call("sim.removeObject", std::slice::from_ref(&cubes[59]));
    assert!(format!("{:?}", gone.unwrap_err()).contains("removeObject"));
    call(&mut session, "sim.removeObject", std::slice::from_ref(&cubes[0]));
    assert!(session.call("sim.removeObject", std::slice::from_ref(&cubes[0])).is_err(), "twice");
    session.step().unwrap();
    assert_eq!(session.registry().scene().objects.len(), before.objects.len() - 102);
}

#[test]
fn shapes_wait_to_be_bodies_while_others_are_removed_and_numbers_are_computed() {
    let mut session = open();
    session.start().unwrap();
    let before = Arc::clone(session.registry().scene());
    let cubes: Vec<Value> = (0..40)
        .map(|k| {
            call(&mut session, "sim.boolOr32", &[1_i64.into(), 2_i64.into()]);
            dynamic_cube(&mut session, [1.0 + f64::from(k), 1.0, 2.0])
        })
        .collect();
    cubes[..10].iter().for_each(|cube| drop(call(&mut session, "sim.removeObject", std::slice::from_ref(cube))));
    assert!(Arc::ptr_eq(&before, session.registry().scene()), "the scene was compiled before the step");
    session.step().unwrap();
    assert_eq!(session.registry().scene().objects.len(), before.objects.len() + 60);
}

#[test]
fn a_function_that_needs_a_body_finds_one() {
    let mut session = open();
    session.start().unwrap();
    let own = dynamic_cube(&mut session, [1.0, 0.0, 1.0]);
    assert_eq!(call(&mut session, "sim.isDynamicallyEnabled", std::slice::from_ref(&own)), [Value::Bool(true)]);
    let mass = number(&mut session, "sim.getShapeMass", std::slice::from_ref(&own));
    assert!((mass - 1.0).abs() < 1e-12, "a litre of water has {mass} kg");
    // typed functions, which have no name
    let other = dynamic_cube(&mut session, [2.0, 0.0, 1.0]);
    let handle = sincro_coppelia::api::Handle(other.as_int().unwrap() as i32);
    assert!((session.sim().mass(handle).unwrap().mass - 1.0).abs() < 1e-12);
}

#[test]
fn a_shape_keeps_the_mass_that_it_was_given_before_it_is_a_body() {
    let mut session = open();
    let own = cube(&mut session, [1.0, 0.0, 1.0]);
    call(&mut session, "sim.setShapeMass", &[own.clone(), 0.25.into()]);
    assert_eq!(number(&mut session, "sim.getShapeMass", std::slice::from_ref(&own)), 0.25);
    set(&mut session, &own, STATIC, 0);
    session.start().unwrap();
    let both = call(&mut session, "sim.getShapeMassAndInertia", std::slice::from_ref(&own));
    assert!((both[0].as_real().unwrap() - 0.25).abs() < 1e-12);
    // m·(a² + a²)/12
    let inertia = both[1].as_reals().unwrap()[0];
    assert!((inertia - 0.25 * 0.02 / 12.0).abs() < 1e-12, "{inertia} kg·m²");
    let refused = session.call("sim.setShapeMass", &[own, 0.0.into()]);
    assert!(refused.is_err());
}

#[test]
fn shapes_grouped_before_they_are_bodies_are_the_body_of_shapes_grouped_after() {
    let grouped = |is_settled: bool| {
        let mut session = open();
        session.start().unwrap();
        let cubes = [[1.0, 0.0, 2.0], [1.1, 0.0, 2.0], [1.1, 0.1, 2.0]].map(|place| dynamic_cube(&mut session, place));
        if is_settled {
            let _ = session.sim();
        }
        let group = call(&mut session, "sim.groupShapes", &[Value::List(cubes.to_vec())]).remove(0);
        let both = call(&mut session, "sim.getShapeMassAndInertia", std::slice::from_ref(&group));
        session.step().unwrap();
        let numbers = both.iter().flat_map(|value| value.as_reals().unwrap_or_else(|| vec![value.as_real().unwrap()]));
        (numbers.collect::<Vec<f64>>(), height(&mut session, &group))
    };
    let (before, after) = (grouped(false), grouped(true));
    assert_eq!(before.0.len(), after.0.len());
    for (x, y) in before.0.iter().zip(&after.0) {
        assert!((x - y).abs() < 1e-12, "{x} and {y}");
    }
    assert!((before.0[0] - 3.0).abs() < 1e-12 && (before.1 - after.1).abs() < 1e-12);
}

#[test]
fn a_shape_without_volume_is_refused_when_it_is_told_to_move() {
    let mut session = open();
    let flat = call(&mut session, "sim.createPrimitiveShape", &[1_i64.into(), Value::reals([1.0; 3]), 0_i64.into()]);
    let refused = session.call("sim.setObjectInt32Param", &[flat[0].clone(), STATIC.into(), 0_i64.into()]);
    assert!(refused.unwrap_err().0.contains("needs a volume"));
    session.start().unwrap();
    session.step().unwrap();
}

#[test]
fn voxels_of_an_octree_are_seen_where_they_are() {
    let mut session = open();
    let octree = call(&mut session, "sim.createOctree", &[0.1.into()]).remove(0);
    assert_eq!(call(&mut session, "sim.getObjectType", std::slice::from_ref(&octree)), [Value::Int(15)]);
    let points = Value::reals([2.01, 0.01, 0.01, 2.09, 0.09, 0.09, 2.11, 0.01, 0.01]);
    let n = call(&mut session, "sim.insertVoxelsIntoOctree", &[octree.clone(), 0_i64.into(), points.clone()]);
    assert_eq!(n, [Value::Int(2)]);
    let centers = call(&mut session, "sim.getOctreeVoxels", std::slice::from_ref(&octree))[0].as_reals().unwrap();
    for (x, y) in centers.iter().zip([2.05, 0.05, 0.05, 2.15, 0.05, 0.05]) {
        assert!((x - y).abs() < 1e-12, "{centers:?}");
    }
    let dummy = call(&mut session, "sim.createPrimitiveShape", &[4_i64.into(), Value::reals([0.1; 3]), 0_i64.into()]);
    let ball = dummy[0].clone();
    call(&mut session, "sim.setObjectPosition", &[ball.clone(), Value::reals([1.0, 0.05, 0.05]), (-1_i64).into()]);
    let distance = |session: &mut Session| {
        let found = call(session, "sim.checkDistance", &[ball.clone(), octree.clone()]);
        found[1].as_reals().unwrap()[6]
    };
    assert!((distance(&mut session) - 0.95).abs() < 1e-9);
    // where it is moved to, points of the world are other voxels
    call(&mut session, "sim.setObjectPosition", &[octree.clone(), Value::reals([1.0, 0.0, 0.0]), (-1_i64).into()]);
    assert!((distance(&mut session) - 1.95).abs() < 1e-9);
    let inside = [octree.clone(), 0_i64.into(), Value::reals([3.01, 0.01, 0.01])];
    assert_eq!(call(&mut session, "sim.checkOctreePointOccupancy", &inside)[0], Value::Int(1));
    assert_eq!(call(&mut session, "sim.removeVoxelsFromOctree", &inside), [Value::Int(1)]);
    assert_eq!(call(&mut session, "sim.checkOctreePointOccupancy", &inside)[0], Value::Int(0));
    assert_eq!(call(&mut session, "sim.removeVoxelsFromOctree", &[octree.clone(), 0_i64.into()]), [Value::Int(0)]);
    let refused = session.call("sim.insertVoxelsIntoOctree", &[ball, 0_i64.into(), points]);
    assert!(refused.unwrap_err().0.contains("is no octree"));
    let refused = session.call("sim.setObjectInt32Param", &[octree, STATIC.into(), 0_i64.into()]);
    assert!(refused.unwrap_err().0.contains("move nothing"));
}

#[test]
fn objects_fill_octrees_and_clouds_by_their_surfaces() {
    let mut session = open();
    let octree = call(&mut session, "sim.createOctree", &[0.1.into()]).remove(0);
    let cloud = call(&mut session, "sim.createPointCloud", &[0.1.into(), 10_i64.into()]).remove(0);
    let of_block = [3_i64.into(), Value::reals([0.38; 3]), 0_i64.into()];
    let block = call(&mut session, "sim.createPrimitiveShape", &of_block).remove(0);
    call(&mut session, "sim.setObjectPosition", &[block.clone(), Value::reals([0.2; 3]), (-1_i64).into()]);
    let given = |first: &Value| [first.clone(), block.clone(), 0_i64.into()];
    // the surface of a cube of four voxels a side: 4³ − 2³
    assert_eq!(call(&mut session, "sim.insertObjectIntoOctree", &given(&octree)), [Value::Int(56)]);
    let grid = [cloud.clone(), octree.clone(), 0_i64.into(), 0.1.into()];
    assert_eq!(call(&mut session, "sim.insertObjectIntoPointCloud", &grid), [Value::Int(56)]);
    // what is there already is not added again within the tolerance
    let again = [cloud.clone(), block.clone(), 0_i64.into(), 0.1.into(), Value::reals([0.0; 3]), 0.01.into()];
    assert_eq!(call(&mut session, "sim.insertObjectIntoPointCloud", &again), [Value::Int(56)]);
    let dummy = call(&mut session, "sim.createDummy", &[0.01.into()]).remove(0);
    call(&mut session, "sim.setObjectPosition", &[dummy.clone(), Value::reals([0.05; 3]), (-1_i64).into()]);
    let corner = [octree.clone(), dummy, 0_i64.into()];
    assert_eq!(call(&mut session, "sim.subtractObjectFromOctree", &corner), [Value::Int(55)]);
    assert_eq!(call(&mut session, "sim.subtractObjectFromOctree", &given(&octree)), [Value::Int(0)]);
    assert_eq!(call(&mut session, "sim.subtractObjectFromPointCloud", &again[..4]), [Value::Int(0)]);
}

#[test]
fn a_shape_that_is_no_body_has_mass_and_inertia_by_its_density() {
    let mut session = open();
    let cube = [3_i64.into(), Value::reals([0.2, 0.3, 0.4]), 0_i64.into()];
    let own = call(&mut session, "sim.createPrimitiveShape", &cube).remove(0);
    assert_eq!(call(&mut session, "sim.computeMassAndInertia", &[own.clone(), 500.0.into()]), [Value::Int(1)]);
    let found = call(&mut session, "sim.getShapeMassAndInertia", std::slice::from_ref(&own));
    let (mass, inertia) = (found[0].as_real().unwrap(), found[1].as_reals().unwrap());
    assert!((mass - 500.0 * 0.024).abs() < 1e-12, "{mass}");
    let about_x = mass / 12.0 * (0.3 * 0.3 + 0.4 * 0.4);
    assert!((inertia[0] - about_x).abs() < 1e-12, "{inertia:?}");
    let refused = session.call("sim.computeMassAndInertia", &[own, 0.0.into()]);
    assert!(refused.unwrap_err().0.contains("not positive"));
}

#[test]
fn points_of_a_cloud_come_back_without_duplicates() {
    let mut session = open();
    let cloud = call(&mut session, "sim.createPointCloud", &[0.02.into(), 20_i64.into()]).remove(0);
    assert_eq!(call(&mut session, "sim.getObjectType", std::slice::from_ref(&cloud)), [Value::Int(16)]);
    let points = Value::reals([1.0, 0.0, 0.0, 1.0, 0.001, 0.0, 1.0, 1.0, 0.0]);
    let color = Value::List([255, 0, 0].map(Value::Int).to_vec());
    let given = [cloud.clone(), 0_i64.into(), points, color, 0.01.into()];
    assert_eq!(call(&mut session, "sim.insertPointsIntoPointCloud", &given), [Value::Int(2)]);
    let kept = call(&mut session, "sim.getPointCloudPoints", std::slice::from_ref(&cloud));
    assert_eq!(kept, [Value::reals([1.0, 0.0, 0.0, 1.0, 1.0, 0.0])]);
    let near = [cloud.clone(), 0_i64.into(), Value::reals([1.0, 1.0, 0.0]), 0.1.into()];
    assert_eq!(call(&mut session, "sim.removePointsFromPointCloud", &near), [Value::Int(1)]);
    let one = [cloud.clone(), 0_i64.into(), Value::reals([0.0; 6]), Value::reals([1.0, 2.0]), 0.0.into()];
    assert!(session.call("sim.insertPointsIntoPointCloud", &one).is_err());
    // made in a run, it goes with it
    session.start().unwrap();
    let other = call(&mut session, "sim.createPointCloud", &[0.02.into(), 20_i64.into()]).remove(0);
    session.stop().unwrap();
    assert!(session.call("sim.getPointCloudPoints", std::slice::from_ref(&other)).is_err());
    assert!(session.call("sim.getPointCloudPoints", &[cloud]).is_ok());
}

#[test]
fn what_a_broken_force_sensor_carried_falls() {
    let scene = r#"
joint = [{ name = "hook", kind = "fixed", force_sensor = true, position = [0.0, 0.0, 2.0] }]
body = [{ name = "lamp", parent = "/hook", mass = 2.0, shape = [{ sphere = { radius = 0.05 } }] }]
"#;
    let experiment = EXPERIMENT;
    let mut session = OpenSession::open(SceneFolder::of(scene, experiment), &[], Extensions::default(), None);
    session.start().unwrap();
    session.step().unwrap();
    let find =
        |session: &mut Session, path: &str| Value::from(session.registry().find(path, Search::default()).unwrap());
    let (hook, lamp) = (find(&mut session, "/hook"), find(&mut session, "/lamp"));
    let force = call(&mut session, "sim.readForceSensor", std::slice::from_ref(&hook))[1].as_reals().unwrap();
    assert!((force[2].abs() - 2.0 * G).abs() < 1e-9, "{force:?} N");
    assert!(session.call("sim.breakForceSensor", std::slice::from_ref(&lamp)).is_err());
    call(&mut session, "sim.breakForceSensor", std::slice::from_ref(&hook));
    assert_eq!(call(&mut session, "sim.readForceSensor", &[hook])[0], Value::Int(3), "it says that it is broken");
    let n = 20;
    for _ in 0..n {
        session.step().unwrap();
    }
    let t = f64::from(n) * session.registry().sample_time();
    let z = height(&mut session, &lamp);
    assert!((z - (2.0 - 0.5 * G * t * t)).abs() < 1e-9, "z = {z} m");
}

#[test]
fn friction_of_an_engine_is_that_of_the_contact() {
    // sim.bullet_body_friction, sim.newton_body_restitution, sim.bullet_body_lineardamping
    let (friction, restitution, damping) = (6003_i64, 33_003_i64, 6004_i64);
    let mut session = open();
    let own = dynamic_cube(&mut session, [1.0, 1.0, 0.05]);
    let get = |session: &mut Session, own: &Value, id: i64| {
        number(session, "sim.getEngineFloatParam", &[id.into(), own.clone()])
    };
    assert_eq!((get(&mut session, &own, friction), get(&mut session, &own, restitution)), (0.71, 0.0));
    call(&mut session, "sim.setEngineFloatParam", &[friction.into(), own.clone(), 0.2.into()]);
    session.start().unwrap();
    session.step().unwrap();
    // it is a body now
    assert_eq!(get(&mut session, &own, friction), 0.2);
    let keys = |session: &mut Session| {
        let path =
            session.registry().entry(sincro_coppelia::api::Handle(own.as_int().unwrap() as i32)).unwrap().path.clone();
        session.registry().scene().object(&path).unwrap().contact.unwrap()
    };
    assert!((keys(&mut session).friction - 0.2).abs() < 1e-12);
    call(&mut session, "sim.setEngineFloatParam", &[friction.into(), own.clone(), 0.5.into()]);
    call(&mut session, "sim.setEngineFloatParam", &[restitution.into(), own.clone(), 0.25.into()]);
    let contact = keys(&mut session);
    assert!((contact.friction - 0.5).abs() < 1e-12 && (contact.restitution - 0.25).abs() < 1e-12);
    let refused = |session: &mut Session, id: i64, value: f64| {
        session.call("sim.setEngineFloatParam", &[id.into(), own.clone(), value.into()]).unwrap_err().0
    };
    assert!(refused(&mut session, damping, 0.1).contains("friction and restitution of shapes are offered"));
    assert!(refused(&mut session, restitution, 1.5).contains("expected 0 to 1"));
    assert!(refused(&mut session, friction, -0.1).contains("expected 0 or more"));
}

#[test]
fn a_shape_that_hangs_on_a_static_one_of_its_batch_falls() {
    // the same if something looks at a body in between, which makes two batches of them
    for looks in [false, true] {
        let mut session = open();
        let table = cube(&mut session, [3.0, 0.0, 1.0]);
        let box_of = cube(&mut session, [3.0, 0.0, 2.0]);
        call(&mut session, "sim.setObjectParent", &[box_of.clone(), table.clone(), true.into()]);
        set(&mut session, &table, RESPONDABLE, 1);
        if looks {
            call(&mut session, "sim.getObjectVelocity", std::slice::from_ref(&table));
        }
        set(&mut session, &box_of, STATIC, 0);
        session.start().unwrap();
        for _ in 0..10 {
            session.step().unwrap();
        }
        let t = 10.0 * session.registry().sample_time();
        let z = height(&mut session, &box_of);
        assert!((z - (2.0 - 0.5 * G * t * t)).abs() < 1e-9, "z = {z} m, looks: {looks}");
        assert!((height(&mut session, &table) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn joints_on_a_force_sensor_are_not_left_in_the_air() {
    let scene = r#"
joint = [
  { name = "wrist", kind = "fixed", force_sensor = true, position = [0.0, 0.0, 2.0] },
  { name = "finger", parent = "/wrist", kind = "revolute" },
]
body = [{ name = "tip", parent = "/wrist/finger", mass = 2.0, shape = [{ sphere = { radius = 0.05 } }] }]
"#;
    let mut session = OpenSession::open(SceneFolder::of(scene, EXPERIMENT), &[], Extensions::default(), None);
    session.start().unwrap();
    session.step().unwrap();
    let wrist = Value::from(session.registry().find("/wrist", Search::default()).unwrap());
    let state = |session: &mut Session| call(session, "sim.readForceSensor", std::slice::from_ref(&wrist)).remove(0);
    let refused = session.call("sim.breakForceSensor", std::slice::from_ref(&wrist)).unwrap_err();
    assert!(format!("{refused:?}").contains("put a body between"), "{refused:?}");
    assert_eq!(state(&mut session), Value::Int(1));
}

#[test]
fn masses_of_shapes_are_kept_in_groups_copies_and_scales() {
    let mut session = open();
    let (a, b) = (cube(&mut session, [3.0, 0.0, 1.0]), cube(&mut session, [3.1, 0.0, 1.0]));
    call(&mut session, "sim.setShapeMass", &[a.clone(), 5.0.into()]);
    call(&mut session, "sim.setShapeMass", &[b.clone(), 3.0.into()]);
    let mass = |session: &mut Session, own: &Value| number(session, "sim.getShapeMass", std::slice::from_ref(own));
    let copied = call(&mut session, "sim.copyPasteObjects", &[Value::List(vec![b.clone()]), 0_i64.into()]).remove(0);
    let Value::List(copies) = copied else { panic!("{copied:?}") };
    assert_eq!(mass(&mut session, &copies[0]), 3.0);
    let group = call(&mut session, "sim.groupShapes", &[Value::List(vec![a, b])]).remove(0);
    assert_eq!(mass(&mut session, &group), 8.0);
    call(&mut session, "sim.scaleObject", &[group.clone(), 0.5.into(), 0.5.into(), 0.5.into()]);
    assert_eq!(mass(&mut session, &group), 1.0);
    set(&mut session, &group, STATIC, 0);
    session.start().unwrap();
    session.step().unwrap();
    assert_eq!(mass(&mut session, &group), 1.0);
}

/// An octree with `n` voxels of 0.1 m in a row along x.
fn octree_of(session: &mut Session, n: usize) -> Value {
    let octree = call(session, "sim.createOctree", &[0.1.into()]).remove(0);
    let row = Value::reals((0..n).flat_map(|k| [0.1 * k as f64 + 0.05, 0.05, 0.05]));
    call(session, "sim.insertVoxelsIntoOctree", &[octree.clone(), 0_i64.into(), row]);
    octree
}

fn refusal(session: &mut Session, name: &str, arguments: &[Value]) -> String {
    session.call(name, arguments).map(|_| ()).expect_err(name).0
}

#[test]
fn comparisons_of_points_are_counted_and_limited() {
    let mut session = open();
    let cloud = call(&mut session, "sim.createPointCloud", &[0.02.into(), 20_i64.into()]).remove(0);
    let row = Value::reals((0..20_000).flat_map(|k| [f64::from(k), 0.0, 0.0]));
    call(&mut session, "sim.insertPointsIntoPointCloud", &[cloud.clone(), 0_i64.into(), row]);
    let many = Value::reals(vec![0.0; 3 * 60_000]);
    for name in ["sim.removePointsFromPointCloud", "sim.intersectPointsWithPointCloud"] {
        let why = refusal(&mut session, name, &[cloud.clone(), 0_i64.into(), many.clone(), 0.1.into()]);
        assert!(why.contains("1200000000 comparisons of points") && why.contains("give fewer points"), "{why}");
    }
    let given = [cloud.clone(), 0_i64.into(), many, Value::Nil, 0.1.into()];
    assert!(refusal(&mut session, "sim.insertPointsIntoPointCloud", &given).contains("comparisons of points"));
    // nothing was removed, and a few points are compared with all: eight comparisons are an instruction
    let few = [cloud, 0_i64.into(), Value::reals(vec![-1.0; 3 * 1_000]), 0.1.into()];
    let remove = sincro_coppelia::api::functions::function("removePointsFromPointCloud").unwrap();
    let mut sim = session.sim();
    let n = remove.call(&mut sim, sincro_coppelia::api::Arguments(&few)).unwrap();
    assert_eq!(n, [Value::Int(20_000)]);
    assert!(sim.work() >= 20_000 * 1_000 / 8, "{}", sim.work());
}

#[test]
fn octrees_and_clouds_are_no_shapes_and_are_copied_as_what_they_are() {
    let mut session = open();
    let octree = octree_of(&mut session, 3);
    let cloud = call(&mut session, "sim.createPointCloud", &[0.02.into(), 20_i64.into()]).remove(0);
    let point = Value::reals([1.0, 2.0, 3.0]);
    call(&mut session, "sim.insertPointsIntoPointCloud", &[cloud.clone(), 0_i64.into(), point.clone()]);
    let shape = cube(&mut session, [0.0, 0.0, 5.0]);
    for (own, what) in [(&octree, "is an octree, no shape"), (&cloud, "is a point cloud, no shape")] {
        let calls: [(&str, Vec<Value>); 5] = [
            ("sim.groupShapes", vec![Value::List(vec![shape.clone(), own.clone()])]),
            ("sim.ungroupShape", vec![own.clone()]),
            ("sim.scaleObject", vec![own.clone(), 2.0.into(), 2.0.into(), 2.0.into()]),
            ("sim.setShapeMass", vec![own.clone(), 1.0.into()]),
            ("sim.getShapeMass", vec![own.clone()]),
        ];
        for (name, arguments) in calls {
            let why = refusal(&mut session, name, &arguments);
            assert!(why.contains(what), "{name}: {why}");
        }
    }
    let both = Value::List(vec![octree.clone(), cloud.clone()]);
    let copies = call(&mut session, "sim.copyPasteObjects", &[both, 0_i64.into()]).remove(0);
    let Value::List(copies) = copies else { panic!("{copies:?}") };
    // the original changes, the copy does not
    call(&mut session, "sim.removeVoxelsFromOctree", &[octree, 0_i64.into()]);
    call(&mut session, "sim.removePointsFromPointCloud", &[cloud, 0_i64.into()]);
    assert_eq!(call(&mut session, "sim.getObjectType", &copies[..1]), [Value::Int(15)]);
    assert_eq!(call(&mut session, "sim.getObjectType", &copies[1..]), [Value::Int(16)]);
    assert_eq!(call(&mut session, "sim.getOctreeVoxels", &copies[..1])[0].as_reals().unwrap().len(), 9);
    assert_eq!(call(&mut session, "sim.getPointCloudPoints", &copies[1..]), [point]);
}

#[test]
fn a_shape_that_has_no_room_for_its_parts_stays_whole() {
    let mut session = open();
    let cubes = Value::List((0..5).map(|k| cube(&mut session, [f64::from(k), 0.0, 3.0])).collect());
    let whole = call(&mut session, "sim.groupShapes", &[cubes]).remove(0);
    while session.registry().created_count() < 9_997 {
        call(&mut session, "sim.createDummy", &[0.01.into()]);
    }
    assert!(refusal(&mut session, "sim.ungroupShape", std::slice::from_ref(&whole)).contains("10000 objects"));
    assert_eq!(session.registry().created_count(), 9_997);
    assert_eq!(call(&mut session, "sim.getShapeGeomInfo", &[whole])[0], Value::Int(1));
}

#[test]
fn voxels_beyond_the_limit_of_corners_are_refused_and_the_others_stay() {
    let mut session = open();
    // all corners but those of some cubes
    let (columns, rows) = (1_660_i64, 1_204_i64);
    let rest = (2_000_000 - columns * rows) / 8;
    let flat = Value::reals(vec![0.0; (columns * rows) as usize]);
    let ground = [0_i64.into(), 0.0.into(), columns.into(), rows.into(), 1.0.into(), flat];
    call(&mut session, "sim.createHeightfieldShape", &ground);
    let octree = octree_of(&mut session, rest as usize);
    let further = [octree.clone(), 0_i64.into(), Value::reals([-5.0, 0.05, 0.05])];
    assert!(refusal(&mut session, "sim.insertVoxelsIntoOctree", &further).contains("2000000 corners"));
    let copy = [Value::List(vec![octree.clone()]), 0_i64.into()];
    assert!(refusal(&mut session, "sim.copyPasteObjects", &copy).contains("2000000 corners"));
    // what was shown still is: the box of the row
    let size = call(&mut session, "sim.getShapeBB", std::slice::from_ref(&octree))[0].as_reals().unwrap();
    assert!((size[0] - 0.1 * rest as f64).abs() < 1e-9, "{size:?}");
    let first = [octree.clone(), 0_i64.into(), Value::reals([0.05; 3])];
    assert_eq!(call(&mut session, "sim.removeVoxelsFromOctree", &first), [Value::Int(rest - 1)]);
    assert_eq!(call(&mut session, "sim.insertVoxelsIntoOctree", &further), [Value::Int(rest)]);
}

#[test]
fn a_shape_that_becomes_no_body_is_named_and_the_others_become_bodies() {
    let mut session = open();
    session.start().unwrap();
    let before = session.registry().scene().objects.len();
    let corners = Value::reals([0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
    let triangles = Value::List([0, 1, 2, 2, 1, 3].map(Value::Int).to_vec());
    let mut shapes: Vec<Value> = (0..15).map(|k| dynamic_cube(&mut session, [f64::from(k), 3.0, 2.0])).collect();
    let flat = call(&mut session, "sim.createMeshShape", &[0_i64.into(), 0.5.into(), corners, triangles]).remove(0);
    call(&mut session, "sim.setObjectAlias", &[flat.clone(), "sheet".into()]);
    let told = session.call("sim.setObjectInt32Param", &[flat, STATIC.into(), 0_i64.into()]);
    shapes.extend((0..16).map(|k| dynamic_cube(&mut session, [f64::from(k), 4.0, 2.0])));
    let why = match told {
        Err(why) => why.0,
        Ok(_) => session.call("sim.getObjectVelocity", &shapes[..1]).expect_err("a sheet has no volume").0,
    };
    assert!(why.contains("/sheet"), "{why}");
    session.step().unwrap();
    // a body and a free joint for each cube
    assert_eq!(session.registry().scene().objects.len(), before + 62);
    assert!(height(&mut session, &shapes[30]) < 2.0);
}

#[test]
fn numbers_are_text_and_texts_numbers_where_they_are_expected() {
    let mut session = open();
    let tube = call(&mut session, "sim.tubeOpen", &[0_i64.into(), 5_i64.into(), 3_i64.into()]).remove(0);
    call(&mut session, "sim.tubeOpen", &[0_i64.into(), "5".into(), 3_i64.into()]);
    assert_eq!(call(&mut session, "sim.tubeWrite", &[tube, 0_i64.into()]), [Value::Int(1)]);
    call(&mut session, "sim.setStringSignal", &["speed".into(), 0.5.into()]);
    let said = call(&mut session, "sim.getStringSignal", &["speed".into()]).remove(0);
    assert_eq!(said.as_text(), Some("0.5"));
    call(&mut session, "sim.setFloatSignal", &["speed".into(), "0.25".into()]);
    assert_eq!(call(&mut session, "sim.getFloatSignal", &["speed".into()]), [Value::Real(0.25)]);
    let dummy = call(&mut session, "sim.createDummy", &["0.01".into()]).remove(0);
    let place = Value::List(vec!["1".into(), 2.0.into(), "3.5".into()]);
    call(&mut session, "sim.setObjectPosition", &[dummy.clone(), place, (-1_i64).into()]);
    assert_eq!(height(&mut session, &dummy), 3.5);
    let why = session.call("sim.setFloatSignal", &["speed".into(), "fast".into()]).unwrap_err().0;
    assert!(why.contains("argument 2 is text, expected a number"), "{why}");
}
