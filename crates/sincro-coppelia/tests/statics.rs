//! Static bodies (parameter 3003) below joints, on other bodies and on nothing: they stay where they are against what
//! they hang on, and move again.

use sincro_coppelia::api::{Search, Value};
use sincro_sim::Extensions;
use sincro_testing::{OpenSession, SceneFolder};

const SCENE: &str = r#"
gravity = [0.0, 0.0, -9.81]

[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = [0.0, 0.0, 3.0]
initial = { position = 0.5 }

[[body]]
name = "arm"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.0, 0.0, -0.5]
inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }

[[joint]]
name = "elbow"
parent = "/hinge/arm"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = [0.0, 0.0, -1.0]

[[body]]
name = "hand"
parent = "/hinge/arm/elbow"
mass = 0.5
center_of_mass = [0.0, 0.0, -0.2]
inertia = { xx = 0.01, yy = 0.01, zz = 0.001 }

[[joint]]
name = "socket"
kind = "ball"
position = [4.0, 0.0, 3.0]

[[body]]
name = "bell"
parent = "/socket"
mass = 1.0
center_of_mass = [0.1, 0.0, -0.5]
inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }

[[joint]]
name = "loose"
kind = "free"
initial = { position = [10.0, 0.0, 5.0, 1.0, 0.0, 0.0, 0.0] }

[[body]]
name = "ball"
parent = "/loose"
density = 1000.0
shape = [{ sphere = { radius = 0.1 } }]
"#;

const EXPERIMENT: &str = r#"
title = "Statics"
duration = 10.0
step = 0.005
record = ["energy.balance"]
error_bar = "none"
"#;

const STATIC: i64 = 3003;

fn open() -> OpenSession {
    let mut session = OpenSession::open(SceneFolder::of(SCENE, EXPERIMENT), &[], Extensions::default(), None);
    session.start().unwrap();
    session
}

fn object(session: &mut OpenSession, path: &str) -> Value {
    i64::from(session.registry().find(path, Search::default()).unwrap().0).into()
}

fn call(session: &mut OpenSession, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn set_static(session: &mut OpenSession, own: &Value, value: i64) {
    call(session, "sim.setObjectInt32Param", &[own.clone(), STATIC.into(), value.into()]);
    let read = call(session, "sim.getObjectInt32Param", &[own.clone(), STATIC.into()]);
    assert_eq!(read, [Value::Int(value)]);
}

fn hang(session: &mut OpenSession, own: &Value, parent: &Value) {
    call(session, "sim.setObjectParent", &[own.clone(), parent.clone(), true.into()]);
}

fn place(session: &mut OpenSession, own: &Value) -> [f64; 3] {
    let found = call(session, "sim.getObjectPosition", &[own.clone(), (-1_i64).into()]);
    found[0].as_reals().unwrap().try_into().unwrap()
}

fn angle(session: &mut OpenSession, joint: &Value) -> f64 {
    call(session, "sim.getJointPosition", std::slice::from_ref(joint))[0].as_real().unwrap()
}

fn steps(session: &mut OpenSession, n: usize) {
    (0..n).for_each(|_| session.step().unwrap());
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[test]
fn a_static_body_below_a_joint_stays_and_falls_when_it_is_not() {
    let mut s = open();
    let [arm, hand, hinge, elbow] = ["/arm", "/hand", "/hinge", "/elbow"].map(|path| object(&mut s, path));
    steps(&mut s, 20);
    set_static(&mut s, &arm, 1);
    let (q, at) = (angle(&mut s, &hinge), angle(&mut s, &elbow));
    steps(&mut s, 40);
    // the ideal motor that holds it has no slip: rounding of 40 steps is left
    assert!((angle(&mut s, &hinge) - q).abs() < 1e-9, "{} rad, was {q} rad", angle(&mut s, &hinge));
    assert!((angle(&mut s, &elbow) - at).abs() > 1e-3, "the hand swings on");
    // the mode is the one that the joint had
    let mode = call(&mut s, "sim.getJointMode", std::slice::from_ref(&hinge));
    call(&mut s, "sim.setJointMode", &[hinge.clone(), mode[0].clone(), 0_i64.into()]);
    steps(&mut s, 10);
    assert!((angle(&mut s, &hinge) - q).abs() < 1e-9);
    // where kinematics puts it
    call(&mut s, "sim.setJointPosition", &[hinge.clone(), 1.0.into()]);
    steps(&mut s, 10);
    assert!((angle(&mut s, &hinge) - 1.0).abs() < 1e-9);
    set_static(&mut s, &hand, 1);
    set_static(&mut s, &arm, 0);
    let at = angle(&mut s, &elbow);
    steps(&mut s, 20);
    assert!((angle(&mut s, &hinge) - 1.0).abs() > 1e-3, "it falls");
    assert!((angle(&mut s, &elbow) - at).abs() < 1e-9, "the hand goes with the arm");
}

#[test]
fn a_joint_on_the_world_is_dynamic_until_it_is_kinematic() {
    let mut s = open();
    let [hinge, elbow] = ["/hinge", "/elbow"].map(|path| object(&mut s, path));
    let enabled = |s: &mut OpenSession, own: &Value| call(s, "sim.isDynamicallyEnabled", std::slice::from_ref(own));
    assert_eq!(enabled(&mut s, &hinge), [Value::Bool(true)]);
    assert_eq!(enabled(&mut s, &elbow), [Value::Bool(true)]);
    call(&mut s, "sim.setJointMode", &[hinge.clone(), 0_i64.into(), 0_i64.into()]);
    assert_eq!(enabled(&mut s, &hinge), [Value::Bool(false)]);
    call(&mut s, "sim.setJointMode", &[hinge.clone(), 5_i64.into(), 0_i64.into()]);
    assert_eq!(enabled(&mut s, &hinge), [Value::Bool(true)]);
}

#[test]
fn a_static_body_goes_with_a_gripper_and_stays_where_it_is_let_go() {
    let mut s = open();
    let [hand, ball] = ["/hand", "/ball"].map(|path| object(&mut s, path));
    let start = place(&mut s, &ball);
    set_static(&mut s, &ball, 1);
    steps(&mut s, 10);
    assert!(distance(place(&mut s, &ball), start) < 1e-12, "it is fixed in the world");
    hang(&mut s, &ball, &hand);
    let apart = |s: &mut OpenSession| call(s, "sim.getObjectPosition", &[ball.clone(), hand.clone()]);
    let before = apart(&mut s);
    steps(&mut s, 20);
    assert!(distance(place(&mut s, &ball), start) > 1e-3, "it goes with the hand");
    let (now, before) = (apart(&mut s)[0].as_reals().unwrap(), before[0].as_reals().unwrap());
    assert!(now.iter().zip(&before).all(|(a, b)| (a - b).abs() < 1e-9));
    hang(&mut s, &ball, &(-1_i64).into());
    let left = place(&mut s, &ball);
    steps(&mut s, 10);
    assert!(distance(place(&mut s, &ball), left) < 1e-12, "it stays where it was let go");
    set_static(&mut s, &ball, 0);
    steps(&mut s, 10);
    assert!(left[2] - place(&mut s, &ball)[2] > 1e-3, "it falls");
}

#[test]
fn a_body_on_a_ball_joint_is_not_made_static_and_the_error_says_why() {
    let mut s = open();
    let bell = object(&mut s, "/bell");
    let refused = s.call("sim.setObjectInt32Param", &[bell.clone(), STATIC.into(), 1_i64.into()]).unwrap_err();
    assert!(format!("{refused:?}").contains("which no motor can hold"), "{refused:?}");
    let read = call(&mut s, "sim.getObjectInt32Param", &[bell, STATIC.into()]);
    assert_eq!(read, [Value::Int(0)]);
}

#[test]
fn a_ball_joint_is_turned_to_a_rotation() {
    let mut s = open();
    let [socket, hinge] = ["/socket", "/hinge"].map(|path| object(&mut s, path));
    // a quarter turn about x
    let matrix = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    call(&mut s, "sim.setSphericalJointMatrix", &[socket.clone(), Value::reals(matrix)]);
    let read = call(&mut s, "sim.getJointMatrix", &[socket])[0].as_reals().unwrap();
    assert!(read.iter().zip(matrix).all(|(a, b)| (a - b).abs() < 1e-12), "{read:?}");
    let refused = s.call("sim.setSphericalJointMatrix", &[hinge, Value::reals(matrix)]).unwrap_err();
    assert!(refused.0.contains("is no spherical joint"), "{refused:?}");
}

#[test]
fn the_end_of_a_run_takes_the_static_bodies_of_it_back() {
    let mut s = open();
    let arm = object(&mut s, "/arm");
    set_static(&mut s, &arm, 1);
    s.stop().unwrap();
    s.start().unwrap();
    let read = call(&mut s, "sim.getObjectInt32Param", &[arm, STATIC.into()]);
    assert_eq!(read, [Value::Int(0)]);
    let hinge = object(&mut s, "/hinge");
    steps(&mut s, 20);
    assert!((angle(&mut s, &hinge) - 0.5).abs() > 1e-3);
}
