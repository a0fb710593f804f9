//! Proximity sensors, distances, collections and runtime shapes, called by name as clients do.

use sincro_coppelia::api::Value;
use sincro_coppelia::session::Session;
use sincro_sim::Extensions;
use sincro_testing::{OpenSession, SceneFolder};

/// A cart with a sensor before a wall, a box that lies on the ground, a mark.
const SCENE: &str = r#"
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
motor = { mode = "velocity" }
[[body]]
name = "cart"
parent = "/rail"
position = [0.0, 0.0, 1.0]
density = 500.0
shape = [{ cuboid = { size = [0.4, 0.2, 0.2] } }, { sphere = { radius = 0.1 }, position = [0.0, 0.0, 0.2] }]
[[sensor]]
name = "eye"
parent = "/rail/cart"
position = [0.2, 0.0, 0.0]
rotation_deg = [0.0, 90.0, 0.0]
proximity = { cone = { angle_deg = 20.0 }, range = 2.0 }
[[body]]
name = "wall"
position = [1.3, 0.0, 1.0]
density = 1000.0
shape = [{ cuboid = { size = [0.2, 1.0, 1.0] } }]
[[frame]]
name = "mark"
position = [0.0, 0.0, 3.0]
"#;

const EXPERIMENT: &str = r#"
title = "Senses"
scene = "scene.toml"
duration = 1.0
step = 0.005
simulation_step = 0.05
record = ["/rail.position", "/rail/cart/eye.distance"]
"#;

/// Corners of a tetrahedron and its triangles.
const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn session() -> OpenSession {
    SceneFolder::of(SCENE, EXPERIMENT).with("tetrahedron.obj", TETRAHEDRON).session(Extensions::default(), None)
}

fn call(session: &mut Session, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn refused(session: &mut Session, name: &str, arguments: &[Value]) -> String {
    session.call(name, arguments).expect_err(name).0
}

fn object(session: &mut Session, path: &str) -> Value {
    call(session, "sim.getObject", &[Value::from(path)]).remove(0)
}

fn real(value: &Value) -> f64 {
    value.as_real().unwrap()
}

fn near(value: &Value, expected: &[f64]) {
    let found = value.as_reals().unwrap();
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (x, y) in found.iter().zip(expected) {
        assert!((x - y).abs() < 1e-12, "{found:?} {expected:?}");
    }
}

/// Puts something made at run time somewhere.
fn put(session: &mut Session, object: &Value, at: [f64; 3]) {
    call(session, "sim.setObjectPosition", &[object.clone(), Value::reals(at)]);
}

const ALL: Value = Value::Int(-2);

#[test]
fn a_reading_is_that_of_the_last_handling() {
    let mut s = session();
    let (eye, wall, joint) = (object(&mut s, "/eye"), object(&mut s, "/wall"), object(&mut s, "/rail"));
    assert_eq!(call(&mut s, "sim.getObjectType", std::slice::from_ref(&eye)), [Value::Int(5)]);
    assert_eq!(
        call(&mut s, "sim.readProximitySensor", std::slice::from_ref(&eye)),
        [Value::Int(-1), Value::Real(0.0), Value::reals([0.0; 3]), Value::Int(-1), Value::reals([0.0; 3])],
        "nobody has looked"
    );
    let now = call(&mut s, "sim.checkProximitySensor", &[eye.clone(), ALL]);
    assert_eq!(now[0], Value::Int(1));
    s.start().unwrap();
    call(&mut s, "sim.setJointTargetVelocity", &[joint, Value::Real(0.5)]);
    for k in 0..4 {
        let seen = call(&mut s, "simReadProximitySensor", std::slice::from_ref(&eye));
        let distance = 1.0 - 0.025 * f64::from(k);
        assert!((real(&seen[1]) - distance).abs() < 1e-12, "{seen:?}");
        near(&seen[2], &[0.0, 0.0, distance]);
        assert_eq!(seen[3], wall);
        near(&seen[4], &[0.0, 0.0, -1.0]);
        s.step().unwrap();
    }
    // of one entity only; within a threshold
    let cart = object(&mut s, "/cart");
    assert_eq!(call(&mut s, "sim.checkProximitySensor", &[eye.clone(), cart.clone()])[0], Value::Int(0));
    let more = |entity: &Value, mode: i64, most: f64| {
        vec![eye.clone(), entity.clone(), Value::Int(mode), Value::Real(most), Value::Real(0.0)]
    };
    assert_eq!(call(&mut s, "sim.checkProximitySensorEx", &more(&wall, 1, 0.5))[0], Value::Int(0));
    assert_eq!(call(&mut s, "sim.checkProximitySensorEx", &more(&wall, 3, 0.0))[0], Value::Int(1));
    assert!(refused(&mut s, "sim.checkProximitySensorEx", &more(&wall, 9, 0.0)).contains("any angle"));
    call(&mut s, "sim.resetProximitySensor", std::slice::from_ref(&eye));
    assert_eq!(call(&mut s, "sim.readProximitySensor", std::slice::from_ref(&eye))[0], Value::Int(-1));
    assert_eq!(call(&mut s, "sim.handleProximitySensor", &[ALL])[0], Value::Int(1));
    assert!(refused(&mut s, "sim.readProximitySensor", &[cart]).contains("`/rail/cart` is no proximity sensor"));
    s.stop().unwrap();
    assert_eq!(call(&mut s, "sim.readProximitySensor", &[eye])[0], Value::Int(-1), "a run leaves nothing behind");
}

#[test]
fn a_proximity_sensor_with_explicit_handling_reads_what_it_last_handled() {
    let mut s = session();
    let (rail, eye) = (object(&mut s, "/rail"), object(&mut s, "/eye"));
    let distance = |s: &mut Session| real(&call(s, "sim.readProximitySensor", std::slice::from_ref(&eye))[1]);
    call(&mut s, "sim.setJointTargetVelocity", &[rail, Value::Real(0.5)]);
    s.start().unwrap();
    call(&mut s, "sim.setExplicitHandling", &[eye.clone(), Value::Int(1)]);
    assert_eq!(call(&mut s, "sim.getExplicitHandling", std::slice::from_ref(&eye)), [Value::Int(1)]);
    let before = real(&call(&mut s, "sim.handleProximitySensor", std::slice::from_ref(&eye))[1]);
    s.step().unwrap();
    assert_eq!(distance(&mut s), before);
    let now = real(&call(&mut s, "sim.handleProximitySensor", std::slice::from_ref(&eye))[1]);
    // 0.5 m/s for 0.05 s
    assert!((now - (before - 0.025)).abs() < 1e-9, "{now} m");
    call(&mut s, "sim.setExplicitHandling", &[eye.clone(), Value::Int(0)]);
    s.step().unwrap();
    assert!((distance(&mut s) - (before - 0.05)).abs() < 1e-9);
    call(&mut s, "sim.setExplicitHandling", &[eye.clone(), Value::Int(1)]);
    s.stop().unwrap();
    assert_eq!(call(&mut s, "sim.getExplicitHandling", std::slice::from_ref(&eye)), [Value::Int(0)]);
}

#[test]
fn what_is_made_is_seen_by_the_sensors_of_the_scene_and_recorded() {
    let mut s = session();
    let eye = object(&mut s, "/eye");
    s.start().unwrap();
    let ball = call(&mut s, "sim.createPrimitiveShape", &[Value::Int(4), Value::reals([0.2, 0.2, 0.2])]).remove(0);
    put(&mut s, &ball, [0.9, 0.0, 1.0]);
    s.step().unwrap();
    let seen = call(&mut s, "sim.readProximitySensor", std::slice::from_ref(&eye));
    assert_eq!(seen[3], ball);
    assert!((real(&seen[1]) - 0.6).abs() < 1e-12);
    assert_eq!(call(&mut s, "sim.getObjectInt32Param", &[ball.clone(), Value::Int(3003)]), [Value::Int(1)]);
    // its radius is 0.1 m, and it is of water; what is no body yet has the mass that it would have as one
    let mass = call(&mut s, "sim.getShapeMass", std::slice::from_ref(&ball));
    assert!((real(&mass[0]) - 4e3 / 3.0 * std::f64::consts::PI * 1e-3).abs() < 1e-9);
    // hung on the cart it goes with it, and is not seen any more: it is fixed to the sensor
    let cart = object(&mut s, "/cart");
    call(&mut s, "sim.setObjectParent", &[ball.clone(), cart, Value::Bool(true)]);
    s.step().unwrap();
    let seen = call(&mut s, "sim.readProximitySensor", &[eye]);
    assert!((real(&seen[1]) - 1.0).abs() < 1e-12);
    s.stop().unwrap();
    assert_eq!(call(&mut s, "sim.isHandle", &[ball]), [Value::Bool(false)], "made in a run, gone with it");
}

#[test]
fn distances_are_those_of_the_closest_parts() {
    let mut s = session();
    let (cart, wall, mark) = (object(&mut s, "/cart"), object(&mut s, "/wall"), object(&mut s, "/mark"));
    let found = call(&mut s, "sim.checkDistance", &[cart.clone(), wall.clone()]);
    let data = found[1].as_reals().unwrap();
    assert!(
        (data[6] - 1.0).abs() < 1e-12 && (data[0] - 0.2).abs() < 1e-12 && (data[3] - 1.2).abs() < 1e-12,
        "{data:?}"
    );
    assert_eq!(found[2], Value::List(vec![cart.clone(), wall.clone()]));
    // a point against the ball on the cart; the threshold
    let found = call(&mut s, "sim.checkDistance", &[mark.clone(), cart.clone(), Value::Real(0.0)]);
    near(&found[1], &[0.0, 0.0, 3.0, 0.0, 0.0, 1.3, 1.7]);
    assert_eq!(call(&mut s, "sim.checkDistance", &[mark.clone(), cart.clone(), Value::Real(1.6)]), [Value::Int(0)]);
    // everything else: the wall is nearer to the cart than nothing
    let all = call(&mut s, "sim.checkDistance", &[cart.clone(), ALL]);
    assert_eq!(all[2], Value::List(vec![cart.clone(), wall.clone()]));
    let joint = object(&mut s, "/rail");
    assert!(refused(&mut s, "sim.checkDistance", &[joint, cart.clone()]).contains("`/rail` has no shape"));
    assert!(
        refused(&mut s, "sim.checkDistance", &[cart.clone(), wall.clone(), Value::Real(f64::NAN)])
            .contains("not a number")
    );
    // surfaces that meet, without any contact in the scene
    assert_eq!(call(&mut s, "sim.checkCollision", &[cart.clone(), wall.clone()])[0], Value::Int(0));
    let rail = object(&mut s, "/rail");
    call(&mut s, "sim.setJointPosition", &[rail, Value::Real(1.05)]);
    let met = call(&mut s, "sim.checkCollision", &[ALL, cart.clone()]);
    assert_eq!(met, [Value::Int(1), Value::List(vec![wall.clone(), cart.clone()])]);
    assert_eq!(real(&Value::Real(call(&mut s, "sim.checkDistance", &[cart, wall])[1].as_reals().unwrap()[6])), 0.0);
}

#[test]
fn collections_are_looked_up_anew() {
    let mut s = session();
    let (rail, cart, wall) = (object(&mut s, "/rail"), object(&mut s, "/cart"), object(&mut s, "/wall"));
    let robot = call(&mut s, "sim.createCollection", &[Value::Int(0)]).remove(0);
    let objects =
        |s: &mut Session, c: &Value| match call(s, "sim.getCollectionObjects", std::slice::from_ref(c)).remove(0) {
            Value::List(list) => list,
            other => panic!("{other:?}"),
        };
    let item = |c: &Value, what: i64, object: &Value, options: i64| {
        vec![c.clone(), Value::Int(what), object.clone(), Value::Int(options)]
    };
    call(&mut s, "sim.addItemToCollection", &item(&robot, -6, &rail, 0));
    assert_eq!(objects(&mut s, &robot).len(), 3, "joint, cart and sensor");
    call(&mut s, "sim.addItemToCollection", &item(&robot, -8, &rail, 1));
    assert!(!objects(&mut s, &robot).contains(&rail), "taken away again");
    // what is hung on it later belongs to the tree
    let dummy = call(&mut s, "sim.createDummy", &[Value::Real(0.01)]).remove(0);
    call(&mut s, "sim.setObjectParent", &[dummy.clone(), cart.clone(), Value::Bool(false)]);
    assert!(objects(&mut s, &robot).contains(&dummy));
    let found = call(&mut s, "sim.checkDistance", &[robot.clone(), ALL]);
    assert_eq!(found[2], Value::List(vec![cart.clone(), wall.clone()]));
    assert_eq!(call(&mut s, "sim.checkCollision", &[robot.clone(), wall.clone()])[0], Value::Int(0));
    // the chain from the tip up; the old way with a name
    let chain = call(&mut s, "simCreateCollection", &[Value::from("chain"), Value::Int(0)]).remove(0);
    call(&mut s, "simAddObjectToCollection", &[chain.clone(), dummy.clone(), Value::Int(-7), Value::Int(2)]);
    assert_eq!(objects(&mut s, &chain), [rail, cart]);
    assert_eq!(call(&mut s, "simGetCollectionHandle", &[Value::from("chain#")]), std::slice::from_ref(&chain));
    assert!(refused(&mut s, "sim.createCollection", &[Value::from("chain"), Value::Int(0)]).contains("already"));
    call(&mut s, "sim.removeObject", &[dummy]);
    assert!(objects(&mut s, &chain).is_empty(), "the tip is gone");
    call(&mut s, "sim.destroyCollection", std::slice::from_ref(&chain));
    assert!(refused(&mut s, "sim.getCollectionObjects", &[chain]).contains("no collection"));
    assert!(refused(&mut s, "sim.addItemToCollection", &item(&robot, -5, &wall, 0)).contains("handle_tree"));
}

#[test]
fn shapes_are_made_copied_grouped_scaled_and_removed() {
    let mut s = session();
    let mark = object(&mut s, "/mark");
    let make = |s: &mut Session, kind: i64, size: [f64; 3]| {
        call(s, "sim.createPrimitiveShape", &[Value::Int(kind), Value::reals(size)]).remove(0)
    };
    // heights of the topmost point, seen from the mark 3 m up
    let expected = [(1, 0.0), (2, 0.0), (3, 0.25), (4, 0.1), (5, 0.25), (6, 0.25), (8, 0.25)];
    for (kind, top) in expected {
        let size = if kind == 4 { [0.2; 3] } else { [0.2, 0.2, 0.5] };
        let shape = make(&mut s, kind, size);
        let found = call(&mut s, "sim.checkDistance", &[mark.clone(), shape.clone()]);
        assert!((found[1].as_reals().unwrap()[6] - (3.0 - top)).abs() < 1e-12, "{kind} {found:?}");
        let info = call(&mut s, "sim.getShapeGeomInfo", std::slice::from_ref(&shape));
        assert_eq!(info[..2], [Value::Int(2), Value::Int(kind)]);
        let z = if matches!(kind, 1 | 2) { 0.0 } else { size[2] };
        near(&info[2], &[0.2, 0.2, z, 0.0]);
        call(&mut s, "sim.removeObject", &[shape]);
    }
    // two grouped, scaled by two, copied, taken apart
    let (one, two) = (make(&mut s, 4, [0.2; 3]), make(&mut s, 4, [0.2; 3]));
    put(&mut s, &two, [0.0, 0.0, 0.5]);
    let both = call(&mut s, "sim.groupShapes", &[Value::List(vec![one.clone(), two.clone()])]).remove(0);
    assert_eq!(both, one);
    call(&mut s, "sim.scaleObjects", &[Value::List(vec![both.clone()]), Value::Real(2.0), Value::Bool(false)]);
    let top = |s: &mut Session, shape: &Value| {
        let mark = object(s, "/mark");
        3.0 - call(s, "sim.checkDistance", &[mark, shape.clone()])[1].as_reals().unwrap()[6]
    };
    assert!((top(&mut s, &both) - 1.2).abs() < 1e-12);
    let copy = match call(&mut s, "sim.copyPasteObjects", &[Value::List(vec![both.clone()]), Value::Int(0)]).remove(0) {
        Value::List(mut list) => list.remove(0),
        other => panic!("{other:?}"),
    };
    put(&mut s, &copy, [0.0, 0.0, -0.2]);
    assert!((top(&mut s, &copy) - 1.0).abs() < 1e-12 && (top(&mut s, &both) - 1.2).abs() < 1e-12);
    let Value::List(parts) = call(&mut s, "sim.ungroupShape", &[both]).remove(0) else { panic!() };
    assert!((top(&mut s, &parts[0]) - 0.2).abs() < 1e-12 && (top(&mut s, &parts[1]) - 1.2).abs() < 1e-12);
    // a mesh, from numbers and from a file, and ground
    let corners = Value::reals([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let indices = Value::List([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3].map(Value::Int).to_vec());
    let (zero, angle) = (Value::Int(0), Value::Real(0.0));
    let mesh = call(&mut s, "sim.createMeshShape", &[zero.clone(), angle.clone(), corners, indices]).remove(0);
    near(&call(&mut s, "sim.getObjectPosition", std::slice::from_ref(&mesh))[0], &[0.5, 0.5, 0.5]);
    assert!((top(&mut s, &mesh) - 1.0).abs() < 1e-12, "where its corners are");
    let file = [zero.clone(), Value::from("tetrahedron.obj"), zero.clone(), angle.clone(), Value::Real(0.5)];
    let small = call(&mut s, "sim.importShape", &file).remove(0);
    assert!((top(&mut s, &small) - 0.5).abs() < 1e-12);
    assert_eq!(call(&mut s, "sim.importMesh", &file).len(), 2);
    let heights = Value::reals([0.0, 0.1, 0.0, 0.0, 0.3, 0.0]);
    let ground = [zero.clone(), angle.clone(), Value::Int(3), Value::Int(2), Value::Real(2.0), heights.clone()];
    let ground = call(&mut s, "sim.createHeightfieldShape", &ground).remove(0);
    let under = call(&mut s, "sim.checkDistance", &[mark, ground])[1].as_reals().unwrap();
    // its top is half a metre beside
    assert!((under[6] - (0.25_f64 + 2.7 * 2.7).sqrt()).abs() < 1e-12, "{under:?}");
    let words = refused(
        &mut s,
        "sim.createHeightfieldShape",
        &[zero.clone(), angle.clone(), Value::Int(4), Value::Int(2), Value::Real(2.0), heights],
    );
    assert!(words.contains("6 heights for 4 by 2 points"), "{words}");
}

#[test]
fn a_sensor_made_at_run_time_looks_at_every_step() {
    let mut s = session();
    let numbers =
        |angle: f64| Value::reals([0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, angle, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let eight = Value::List(vec![Value::Int(0); 8]);
    let arguments = |kind: i64, options: i64, angle: f64| {
        vec![Value::Int(kind), Value::Int(16), Value::Int(options), eight.clone(), numbers(angle)]
    };
    let eye = call(&mut s, "sim.createProximitySensor", &arguments(33, 0, 0.5)).remove(0);
    let told = call(&mut s, "sim.createProximitySensor", &arguments(34, 1, 0.0)).remove(0);
    // above the cart, looking down
    let down = Value::reals([0.0, 0.0, 2.3, 1.0, 0.0, 0.0, 0.0]);
    for sensor in [&eye, &told] {
        call(&mut s, "sim.setObjectPose", &[sensor.clone(), down.clone()]);
    }
    s.start().unwrap();
    s.step().unwrap();
    let seen = call(&mut s, "sim.readProximitySensor", std::slice::from_ref(&eye));
    assert!((real(&seen[1]) - 1.0).abs() < 1e-12, "{seen:?}");
    assert_eq!(
        call(&mut s, "sim.readProximitySensor", std::slice::from_ref(&told))[0],
        Value::Int(-1),
        "it waits to be told"
    );
    assert_eq!(call(&mut s, "sim.handleProximitySensor", std::slice::from_ref(&told))[0], Value::Int(1));
    for (kind, options, angle, expected) in
        [(33, 0, 4.0, "at most π"), (30, 0, 0.5, "widths"), (35, 0, 0.5, "ray 34"), (33, 64, 0.5, "any angle")]
    {
        let words = refused(&mut s, "sim.createProximitySensor", &arguments(kind, options, angle));
        assert!(words.contains(expected), "{words}");
    }
}

#[test]
fn shapes_are_scaled_along_each_axis() {
    let mut s = session();
    let make = |s: &mut Session, kind: i64, size: [f64; 3]| {
        call(s, "sim.createPrimitiveShape", &[Value::Int(kind), Value::reals(size)]).remove(0)
    };
    let factors = |k: [f64; 3]| k.map(Value::Real);
    let scaled = |s: &mut Session, shape: &Value, k: [f64; 3]| {
        let arguments: Vec<Value> = std::iter::once(shape.clone()).chain(factors(k)).collect();
        call(s, "sim.scaleObject", &arguments);
    };
    let top = |s: &mut Session, shape: &Value| {
        let mark = object(s, "/mark");
        3.0 - call(s, "sim.checkDistance", &[mark, shape.clone()])[1].as_reals().unwrap()[6]
    };
    // kind, lengths, kind afterwards (0: a hull), its top
    let cases = [
        (3, [0.2, 0.2, 0.4], 3, 0.6),
        (4, [0.2; 3], 0, 0.3),
        (5, [0.2, 0.2, 0.4], 0, 0.6),
        (6, [0.2, 0.2, 0.4], 0, 0.6),
    ];
    for (kind, size, after, expected) in cases {
        let shape = make(&mut s, kind, size);
        scaled(&mut s, &shape, [2.0, 0.5, 3.0]);
        let info = call(&mut s, "sim.getShapeGeomInfo", std::slice::from_ref(&shape));
        assert_eq!(info[1], Value::Int(after), "{kind}");
        assert!((top(&mut s, &shape) - expected).abs() < 1e-9, "{kind}: {}", top(&mut s, &shape));
        call(&mut s, "sim.removeObject", &[shape]);
    }
    // still round
    let cylinder = make(&mut s, 5, [0.2, 0.2, 0.4]);
    scaled(&mut s, &cylinder, [2.0, 2.0, 3.0]);
    let info = call(&mut s, "sim.getShapeGeomInfo", std::slice::from_ref(&cylinder));
    assert_eq!(info[1], Value::Int(5));
    near(&info[2], &[0.4, 0.4, 1.2, 0.0]);
    // places of parts are scaled as well, in the axes of the whole
    let (one, two) = (make(&mut s, 3, [0.2; 3]), make(&mut s, 3, [0.2; 3]));
    put(&mut s, &two, [0.0, 0.0, 0.5]);
    let both = call(&mut s, "sim.groupShapes", &[Value::List(vec![one, two])]).remove(0);
    scaled(&mut s, &both, [1.0, 1.0, 2.0]);
    assert!((top(&mut s, &both) - 1.2).abs() < 1e-12);
    let capsule = make(&mut s, 8, [0.2, 0.2, 0.4]);
    let words = refused(&mut s, "sim.scaleObject", &[capsule, Value::Real(1.0), Value::Real(1.0), Value::Real(2.0)]);
    assert!(words.contains("the same way in all directions"), "{words}");
}

#[test]
fn what_cannot_be_made_is_refused_in_words() {
    let mut s = session();
    let sizes = |x: f64, y: f64, z: f64| Value::reals([x, y, z]);
    let wall = object(&mut s, "/wall");
    let ints = |list: &[i64]| Value::List(list.iter().copied().map(Value::Int).collect());
    let (i, r) = (Value::Int, Value::Real);
    let cases: Vec<(&str, Vec<Value>, &str)> = vec![
        ("createPrimitiveShape", vec![i(9), sizes(1.0, 1.0, 1.0)], "cuboid 3"),
        ("createPrimitiveShape", vec![i(3), sizes(1.0, -1.0, 1.0)], "-1 is no length"),
        ("createPrimitiveShape", vec![i(3), sizes(1.0, f64::NAN, 1.0)], "NaN is no length"),
        ("createPrimitiveShape", vec![i(8), sizes(1.0, 2.0, 4.0)], "not round"),
        ("createPrimitiveShape", vec![i(8), sizes(1.0, 1.0, 0.5)], "shorter than it is wide"),
        ("createPureShape", vec![i(0), i(8), sizes(0.1, 0.1, 0.1), r(0.0)], "is not positive"),
        ("createPureShape", vec![i(7), i(16), sizes(0.1, 0.1, 0.1), r(1.0)], "sphere 1"),
        ("createMeshShape", vec![i(0), r(0.0), Value::reals([0.0; 9]), ints(&[0, 1, 3])], "there is no corner 3"),
        ("createMeshShape", vec![i(0), r(0.0), Value::reals([0.0; 8]), ints(&[0, 1, 2])], "three by three"),
        ("createMeshShape", vec![i(0), r(0.0), Value::reals([f64::INFINITY; 9]), ints(&[0, 1, 2])], "not finite"),
        ("importShape", vec![i(0), Value::from("../scene.toml"), i(0), r(0.0), r(1.0)], "path inside it"),
        ("importShape", vec![i(0), Value::from("/etc/passwd"), i(0), r(0.0), r(1.0)], "path inside it"),
        ("importShape", vec![i(0), Value::from("scene.toml"), i(0), r(0.0), r(1.0)], "an STL or an OBJ file"),
        ("importShape", vec![i(0), Value::from("gone.stl"), i(0), r(0.0), r(1.0)], "cannot be read"),
        ("loadModel", vec![Value::from("robot.ttm")], "there is no model"),
        ("createJoint", vec![i(13), i(5), i(0)], "no type of joint"),
        ("groupShapes", vec![Value::List(vec![wall.clone()])], "two shapes"),
        ("groupShapes", vec![Value::List(vec![wall.clone(), i(1)])], "is a body of the scene"),
        ("scaleObject", vec![wall.clone(), r(2.0), r(2.0), r(2.0)], "changed there"),
        ("getShapeGeomInfo", vec![i(1)], "has no shape"),
    ];
    for (name, arguments, expected) in cases {
        let words = refused(&mut s, &format!("sim.{name}"), &arguments);
        assert!(words.contains(expected), "{name}: {words}");
    }
    for _ in 0..10_000 {
        call(&mut s, "sim.createDummy", &[Value::Real(0.01)]);
    }
    let words = refused(&mut s, "sim.createPrimitiveShape", &[i(3), sizes(0.1, 0.1, 0.1)]);
    assert!(words.contains("10000 objects were made already"), "{words}");
}

#[test]
fn meshes_without_area_or_in_one_plane_do_no_harm() {
    let mut s = session();
    let (mark, eye) = (object(&mut s, "/mark"), object(&mut s, "/eye"));
    let flat = Value::reals([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    for indices in [&[0, 0, 0][..], &[0, 1, 1], &[0, 1, 2, 0, 1, 2], &[0, 1, 2, 1, 0, 2], &[0, 1, 2, 1, 3, 2, 0, 1, 3]]
    {
        let list = Value::List(indices.iter().copied().map(Value::Int).collect());
        let arguments = [Value::Int(0), Value::Real(0.0), flat.clone(), list];
        let Ok(made) = s.call("sim.createMeshShape", &arguments) else { continue };
        let found = call(&mut s, "sim.checkDistance", &[mark.clone(), made[0].clone()]);
        let distance = found[1].as_reals().unwrap()[6];
        assert!((3.0..3.5).contains(&distance), "{indices:?}: {distance}");
        call(&mut s, "sim.checkProximitySensor", &[eye.clone(), made[0].clone()]);
        call(&mut s, "sim.removeObject", &[made[0].clone()]);
    }
}

/// Distance that a sensor reads in the last step; none if it detects nothing.
fn reading(session: &mut Session, eye: &Value) -> Option<f64> {
    session.step().unwrap();
    let read = call(session, "sim.readProximitySensor", std::slice::from_ref(eye));
    (read[0] == Value::Int(1)).then(|| real(&read[1]))
}

#[test]
fn a_sensor_detects_the_entity_that_a_client_gives_it() {
    let mut session = session();
    let [eye, wall] = ["/eye", "/wall"].map(|path| object(&mut session, path));
    let id = Value::Int(4002);
    let near_box = call(&mut session, "sim.createPrimitiveShape", &[Value::Int(3), Value::reals([0.1; 3])]).remove(0);
    put(&mut session, &near_box, [0.6, 0.0, 1.0]);
    session.start().unwrap();
    assert!((reading(&mut session, &eye).unwrap() - 0.35).abs() < 1e-9, "the nearest");
    let chosen = |session: &mut Session| call(session, "sim.getObjectInt32Param", &[eye.clone(), id.clone()]).remove(0);
    assert_eq!(chosen(&mut session), Value::Int(-1));
    let set = |session: &mut Session, entity: &Value| {
        call(session, "sim.setObjectInt32Param", &[eye.clone(), id.clone(), entity.clone()]);
        assert_eq!(call(session, "sim.getObjectInt32Param", &[eye.clone(), id.clone()]), std::slice::from_ref(entity));
    };
    set(&mut session, &wall);
    assert!((reading(&mut session, &eye).unwrap() - 1.0).abs() < 1e-9);
    // a collection of all but the wall
    let collection = call(&mut session, "simCreateCollection", &["seen".into(), Value::Int(0)]).remove(0);
    let add = |session: &mut Session, what: i64, own: &Value, options: i64| {
        call(session, "simAddObjectToCollection", &[collection.clone(), own.clone(), what.into(), options.into()]);
    };
    add(&mut session, -2, &wall, 0);
    add(&mut session, -8, &wall, 1);
    set(&mut session, &collection);
    assert!((reading(&mut session, &eye).unwrap() - 0.35).abs() < 1e-9, "the box before the wall");
    call(&mut session, "sim.removeObject", std::slice::from_ref(&near_box));
    assert_eq!(reading(&mut session, &eye), None);
    call(&mut session, "sim.destroyCollection", std::slice::from_ref(&collection));
    assert_eq!(chosen(&mut session), Value::Int(-1), "the collection has gone");
    set(&mut session, &wall);
    assert!((reading(&mut session, &eye).unwrap() - 1.0).abs() < 1e-9);
    session.stop().unwrap();
    let run = session.take_finished().remove(0).simulated;
    let distance = &run.table.column("/rail/cart/eye.distance").unwrap().values;
    assert!((distance.last().unwrap() - 1.0).abs() < 1e-9, "recorded is what is read: {distance:?}");
    assert!(run.changes.iter().any(|change| change.quantity == "detects"));
    assert_eq!(chosen(&mut session), Value::Int(-1), "as before the run");
    let why = refused(&mut session, "sim.setObjectInt32Param", &[eye, id, Value::Int(77_777)]);
    assert!(why.contains("no object or collection"), "{why}");
}

#[test]
fn objects_take_part_in_what_their_flags_say() {
    let mut session = session();
    let [eye, wall, cart] = ["/eye", "/wall", "/rail/cart"].map(|path| object(&mut session, path));
    let property = |session: &mut Session, own: &Value| {
        call(session, "sim.getObjectSpecialProperty", std::slice::from_ref(own))[0].as_int().unwrap()
    };
    let all = property(&mut session, &wall);
    assert_eq!(all, 1 | 2 | 0x1f0 | 0x200);
    let set = |session: &mut Session, name: &str, value: i64| {
        assert_eq!(call(session, name, &[wall.clone(), value.into()]), [Value::Int(1)]);
    };
    session.start().unwrap();
    assert!(reading(&mut session, &eye).is_some());
    let apart = [cart.clone(), wall.clone()];
    set(&mut session, "sim.setObjectSpecialProperty", all & !0x1f0);
    assert_eq!(reading(&mut session, &eye), None, "not detectable");
    assert_eq!(call(&mut session, "sim.checkDistance", &apart)[0], Value::Int(1));
    call(&mut session, "sim.setBoolProperty", &[wall.clone(), "measurable".into(), false.into()]);
    assert_eq!(call(&mut session, "sim.checkDistance", &apart)[0], Value::Int(0));
    call(&mut session, "sim.setBoolProperty", &[wall.clone(), "detectable".into(), true.into()]);
    assert!(reading(&mut session, &eye).is_some());
    assert_eq!(call(&mut session, "sim.getBoolProperty", &[wall.clone(), "collidable".into()]), [true.into()]);
    let meets = call(&mut session, "sim.createPrimitiveShape", &[Value::Int(3), Value::reals([0.3; 3])]).remove(0);
    put(&mut session, &meets, [1.3, 0.0, 1.0]);
    let both = [meets, wall.clone()];
    assert_eq!(call(&mut session, "sim.checkCollision", &both)[0], Value::Int(1));
    set(&mut session, "sim.setModelProperty", 1);
    assert_eq!(call(&mut session, "sim.checkCollision", &both)[0], Value::Int(0), "the model is not collidable");
    set(&mut session, "sim.setModelProperty", 0);
    assert_eq!(call(&mut session, "sim.checkCollision", &both)[0], Value::Int(1));
    set(&mut session, "sim.setObjectSpecialProperty", 0);
    session.stop().unwrap();
    assert_eq!(property(&mut session, &wall), all, "as before the run");
    for (value, word) in [(0x20_i64, "not dynamic"), (0x40, "not respondable"), (0x80, "not reset")] {
        let why = refused(&mut session, "sim.setModelProperty", &[wall.clone(), value.into()]);
        assert!(why.contains(word), "{why}");
    }
    set(&mut session, "sim.setObjectProperty", 32);
    assert_eq!(call(&mut session, "sim.getObjectProperty", std::slice::from_ref(&wall)), [Value::Int(32)]);
    let why = refused(&mut session, "sim.groupShapes", &[Value::List(vec![wall, cart])]);
    assert!(why.contains("body of the scene") && why.contains("setObjectParent"), "{why}");
}
