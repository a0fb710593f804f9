//! Compatibility beyond joints and bodies: targets that are moved and hung elsewhere, copies by number, boxes,
//! properties and stored data, settings that are refused.

use sincro_coppelia::api::Value;
use sincro_sim::Extensions;
use sincro_testing::{OpenSession, scenes};

/// Below a free body: a target, a second point on it, four arms with a point each, and a frame that carries a joint.
const MORE: &str = r#"
[[frame]]
name = "target"
parent = "/loose/ball"
position = [0.0, 0.0, 0.5]

[[frame]]
name = "mark"
parent = "/loose/ball/target"
position = [0.1, 0.0, 0.0]

[[frame]]
name = "propeller1"
parent = "/loose/ball"
position = [0.1, 0.0, 0.0]

[[frame]]
name = "respondable"
parent = "/loose/ball/propeller1"

[[frame]]
name = "propeller2"
parent = "/loose/ball"
position = [0.2, 0.0, 0.0]

[[frame]]
name = "respondable"
parent = "/loose/ball/propeller2"
position = [0.0, 0.0, 0.03]

[[body]]
name = "solid"
position = [1.0, 0.0, 0.0]
density = 1000.0
shape = [
  { cuboid = { size = [0.2, 0.4, 0.6] } },
  { cylinder = { radius = 0.1, length = 0.5 }, position = [0.3, 0.0, 0.0] },
]

[[frame]]
name = "stand"

[[joint]]
name = "lever"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
parent = "/stand"

[[body]]
name = "bar"
parent = "/stand/lever"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
"#;

fn scene() -> OpenSession {
    let folder = scenes::two_link_arm("");
    folder.write("scene.toml", &format!("{}{MORE}", scenes::TWO_LINK_ARM));
    folder.session(Extensions::default(), Some(0.01))
}

fn call(session: &mut OpenSession, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(&format!("sim.{name}"), arguments).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn refused(session: &mut OpenSession, name: &str, arguments: &[Value]) -> String {
    session.call(&format!("sim.{name}"), arguments).expect_err(name).0
}

fn object(session: &mut OpenSession, path: &str) -> Value {
    call(session, "getObject", &[path.into()]).remove(0)
}

fn position(session: &mut OpenSession, object: &Value, of: i64) -> [f64; 3] {
    let result = call(session, "getObjectPosition", &[object.clone(), Value::Int(of)]).remove(0);
    result.as_reals().unwrap().try_into().unwrap()
}

fn near(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
}

#[test]
fn a_target_is_hung_on_the_world_moved_and_back_when_the_run_ends() {
    let mut session = scene();
    let (ball, target, mark) =
        (object(&mut session, "/ball"), object(&mut session, "./target"), object(&mut session, "/ball/target/mark"));
    let from = position(&mut session, &target, -1);
    session.start().unwrap();
    call(&mut session, "setObjectParent", &[target.clone(), Value::Int(-1), true.into()]);
    assert_eq!(call(&mut session, "getObjectParent", std::slice::from_ref(&target)), [Value::Int(-1)]);
    assert!(near(position(&mut session, &target, -1), from), "it stays in place");
    for _ in 0..10 {
        session.step().unwrap();
    }
    assert!(near(position(&mut session, &target, -1), from), "the ball has fallen without it");
    assert!(position(&mut session, &ball, -1)[2] < from[2] - 0.5);
    call(&mut session, "setObjectPosition", &[target.clone(), Value::reals([1.0, 2.0, 3.0]), Value::Int(-1)]);
    assert!(near(position(&mut session, &mark, -1), [1.1, 2.0, 3.0]), "points below move with it");
    assert_eq!(object(&mut session, "/target/mark"), mark);
    session.stop().unwrap();
    assert_eq!(call(&mut session, "getObjectParent", std::slice::from_ref(&target)), [ball]);
    assert!(near(position(&mut session, &target, -1), from));
    assert_eq!(object(&mut session, "/ball/target"), target);
}

#[test]
fn bases_are_put_elsewhere_with_all_that_they_carry_and_joints_keep_something_to_move() {
    let mut session = scene();
    let (bar, stand, ball) =
        (object(&mut session, "/bar"), object(&mut session, "/stand"), object(&mut session, "/ball"));
    let why = refused(&mut session, "setObjectParent", &[bar.clone(), ball.clone(), true.into()]);
    assert!(why.contains("would carry nothing"), "{why}");
    let (before, of_stand) = (position(&mut session, &bar, -1), position(&mut session, &stand, -1));
    let place = [of_stand[0] + 0.5, of_stand[1], of_stand[2]];
    call(&mut session, "setObjectPosition", &[stand.clone(), Value::reals(place), Value::Int(-1)]);
    let after = position(&mut session, &bar, -1);
    assert!(near(after, [before[0] + 0.5, before[1], before[2]]), "{before:?} {after:?}");
    // nothing changes where it hangs there already
    call(&mut session, "setObjectParent", &[stand, Value::Int(-1), true.into()]);
}

#[test]
fn copies_of_the_scene_language_are_siblings_of_one_name() {
    let mut session = scene();
    for k in 0..2 {
        let by_index = object(&mut session, &format!("./propeller[{k}]/respondable"));
        assert_eq!(by_index, object(&mut session, &format!("/ball/propeller{}/respondable", k + 1)));
    }
    assert!(refused(&mut session, "getObject", &["/propeller[2]".into()]).contains("does not exist"));
    assert!(refused(&mut session, "getObject", &["/propeller".into()]).contains("does not exist"));
}

#[test]
fn the_box_of_a_shape_holds_all_its_parts() {
    let mut session = scene();
    let solid = object(&mut session, "/solid");
    let both = call(&mut session, "getShapeBB", std::slice::from_ref(&solid));
    let [size, pose] = [0, 1].map(|k| both[k].as_reals().unwrap());
    // along x from −0.1 to 0.4
    assert!(near([size[0], size[1], size[2]], [0.5, 0.4, 0.6]), "{size:?}");
    assert!(near([pose[0], pose[1], pose[2]], [0.15, 0.0, 0.0]) && pose[6] == 1.0, "{pose:?}");
    assert!(refused(&mut session, "getShapeBB", &[Value::Int(1)]).contains("no shape"));
    assert_eq!(call(&mut session, "getObjectSizeFactor", &[solid]), [Value::Real(1.0)]);
}

#[test]
fn properties_are_the_functions_under_other_names() {
    let mut session = scene();
    let (joint, ball) = (object(&mut session, "/joint1"), object(&mut session, "/ball"));
    let mass = call(&mut session, "getFloatProperty", &[ball.clone(), "mass".into()]);
    assert_eq!(mass, call(&mut session, "getShapeMass", std::slice::from_ref(&ball)));
    call(&mut session, "setFloatProperty", &[joint.clone(), "jointPosition".into(), Value::Real(0.25)]);
    assert_eq!(call(&mut session, "getJointPosition", std::slice::from_ref(&joint)), [Value::Real(0.25)]);
    let place = call(&mut session, "getVector3Property", &[ball.clone(), "absPosition".into()]);
    assert_eq!(place[0].as_reals().unwrap(), position(&mut session, &ball, -1));
    let gravity = call(&mut session, "getVector3Property", &[Value::Int(-12), "gravity".into()]);
    assert_eq!(gravity, [Value::reals([0.0, 0.0, -9.81])]);
    let why = refused(&mut session, "getIntProperty", &[ball.clone(), "mass".into()]);
    assert!(why.contains("a number, not a whole number") || why.contains("is a number"), "{why}");
    assert!(refused(&mut session, "getFloatProperty", &[ball.clone(), "colour".into()]).contains("no property"));
    let tolerant = Value::Map(vec![("noError".into(), true.into())]);
    assert_eq!(call(&mut session, "getFloatProperty", &[ball, "colour".into(), tolerant]), [Value::Nil]);
    let why = refused(&mut session, "setFloatProperty", &[joint, "calcVelocity".into(), Value::Real(1.0)]);
    assert!(why.contains("read only"), "{why}");
}

#[test]
fn stored_properties_keep_their_kind_and_share_their_names_with_data_blocks_and_signals() {
    let mut session = scene();
    let ball = object(&mut session, "/ball");
    let tag = || Value::from("customData.settings");
    call(&mut session, "setIntProperty", &[ball.clone(), tag(), Value::Int(7)]);
    assert_eq!(call(&mut session, "getIntProperty", &[ball.clone(), tag()]), [Value::Int(7)]);
    call(&mut session, "setTableProperty", &[ball.clone(), tag(), Value::reals([1.0, 2.0])]);
    assert_eq!(call(&mut session, "getTableProperty", &[ball.clone(), tag()]), [Value::reals([1.0, 2.0])]);
    call(&mut session, "setBufferProperty", &[ball.clone(), tag(), Value::Bytes(vec![1, 2])]);
    let block = call(&mut session, "readCustomDataBlock", &[ball.clone(), "settings".into()]);
    assert_eq!(block, [Value::Bytes(vec![1, 2])]);
    assert_eq!(
        call(&mut session, "readCustomDataTags", std::slice::from_ref(&ball)),
        [Value::List(vec!["settings".into()])]
    );
    call(&mut session, "removeProperty", &[ball.clone(), tag()]);
    assert!(refused(&mut session, "getProperty", &[ball, tag()]).contains("no value"));
    call(&mut session, "setFloatProperty", &[Value::Int(-13), "signal.speed".into(), Value::Real(2.5)]);
    assert_eq!(call(&mut session, "getFloatSignal", &["speed".into()]), [Value::Real(2.5)]);
    call(
        &mut session,
        "writeCustomTableData",
        &[Value::Int(-12), "t".into(), Value::Map(vec![("a".into(), 1_i64.into())])],
    );
    let table = call(&mut session, "readCustomTableData", &[Value::Int(-12), "t".into()]);
    assert_eq!(table, [Value::Map(vec![("a".into(), 1_i64.into())])]);
    call(&mut session, "setBufferSignal", &["b".into(), Value::Bytes(vec![9])]);
    assert_eq!(call(&mut session, "getStringSignal", &["b".into()]), [Value::Bytes(vec![9])]);
}

#[test]
fn string_signals_are_text_unless_they_were_set_as_buffers() {
    let mut session = scene();
    let mut set = |name: &str, value: Value| {
        call(&mut session, name, &["s".into(), value]);
        let read = ["getStringSignal", "getBufferSignal"].map(|get| call(&mut session, get, &["s".into()]).remove(0));
        let typed = call(&mut session, "getStringProperty", &[Value::Int(-12), "signal.s".into()]).remove(0);
        assert!(typed.as_bytes() == read[1].as_bytes());
        read
    };
    let text = |text: &str| [Value::from(text), Value::Bytes(text.into())];
    assert_eq!(set("setStringSignal", "forward\tπ".into()), text("forward\tπ"));
    assert_eq!(set("setStringSignal", Value::Bytes(b"abc".to_vec())), [(); 2].map(|()| Value::Bytes(b"abc".to_vec())));
    assert_eq!(set("setBufferSignal", "abc".into()), [(); 2].map(|()| Value::Bytes(b"abc".to_vec())));
    // packed numbers that happen to be UTF-8
    let packed = "\0\0\0\0";
    assert_eq!(set("setStringSignal", packed.into()), [(); 2].map(|()| Value::Bytes(packed.into())));
    call(&mut session, "clearBufferSignal", &["s".into()]);
    assert_eq!(call(&mut session, "getStringSignal", &["s".into()]), []);
}

#[test]
fn settings_that_would_change_the_physics_are_refused_and_others_taken() {
    let mut session = scene();
    let ball = object(&mut session, "/ball");
    // proximity sensors off, vision sensors off
    for id in [9, 10] {
        let why = refused(&mut session, "setBoolParam", &[Value::Int(id), false.into()]);
        assert!(why.contains("part of every step"), "{why}");
        call(&mut session, "setBoolParam", &[Value::Int(id), true.into()]);
    }
    call(&mut session, "setBoolParam", &[Value::Int(16), false.into()]);
    call(&mut session, "setBoolParam", &[Value::Int(16), true.into()]);
    for name in ["setEngineInt32Param", "setEngineBoolParam", "setShapeMaterial"] {
        let why = refused(&mut session, name, &[Value::Int(1), ball.clone(), Value::Int(1)]);
        assert!(why.contains("not offered") && why.contains("materials"), "{name}: {why}");
    }
    assert_eq!(call(&mut session, "getSimulatorMessage", &[])[0], Value::Int(-1));
    let masks = [(0xf0_i64, 0x0f_i64), (-1, 1)];
    let or = masks.map(|(a, b)| call(&mut session, "boolOr32", &[a.into(), b.into()]).remove(0));
    assert_eq!(or, [Value::Int(0xff), Value::Int(-1)]);
}

#[test]
fn plug_ins_are_listed_until_there_is_no_further_one() {
    let mut session = scene();
    let mut names = Vec::new();
    for index in 0..10_i64 {
        match call(&mut session, "getModuleName", &[index.into()]).remove(0) {
            Value::Nil => break,
            name => names.push(name),
        }
    }
    assert_eq!(names, [Value::from("RemoteApi"), "IK".into(), "UI".into()]);
    assert_eq!(call(&mut session, "getPluginName", &[Value::Int(-1)]), [Value::Nil, Value::Nil]);
}
