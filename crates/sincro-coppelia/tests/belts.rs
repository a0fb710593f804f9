//! Static bodies that carry others along (conveyor belts), and dummies whose link joins the bodies that carry them.

use sincro_coppelia::api::{Search, Value};
use sincro_coppelia::session::Session;
use sincro_sim::Extensions;
use sincro_testing::{OpenSession, SceneFolder};

/// Acceleration of gravity [m/s²].
const G: f64 = 9.81;
/// A belt may be that far from its place [m]: the way of one step at 0.2 m/s.
const STEP: f64 = 1.1e-3;

const EXPERIMENT: &str = r#"
title = "Belts"
duration = 10.0
step = 0.005
record = ["/box_joint/box.position.z", "energy.balance"]
error_bar = "none"
"#;

/// A box on a static slab of 2 m that is 0.1 m high.
/// A block and a band below a frame are static, too.
const BELT: &str = r#"
[[body]]
name = "slab"
position = [0.0, 0.0, 0.05]
shape = [{ cuboid = { size = [2.0, 0.4, 0.1] } }]
contact = { friction = 0.5 }
[[body]]
name = "floor"
shape = [{ plane = {} }]
contact = { friction = 0.5 }
[[joint]]
name = "box_joint"
kind = "free"
initial = { position = [-0.5, 0.0, 0.15, 1.0, 0.0, 0.0, 0.0] }
[[body]]
name = "box"
parent = "/box_joint"
density = 1000.0
shape = [{ cuboid = { size = [0.1, 0.1, 0.1] } }]
contact = { friction = 0.5 }
[[body]]
name = "block"
position = [10.0, 0.0, 0.5]
density = 100.0
shape = [{ cuboid = { size = [0.2, 0.2, 0.2] } }]
contact = { friction = 0.5 }
[[frame]]
name = "line"
position = [0.0, 10.0, 0.0]
[[body]]
name = "band"
parent = "/line"
position = [0.0, 0.0, 0.05]
shape = [{ cuboid = { size = [2.0, 0.4, 0.1] } }]
contact = { friction = 0.5 }
"#;

fn open() -> OpenSession {
    OpenSession::open(SceneFolder::of(BELT, EXPERIMENT), &[], Extensions::default(), None)
}

fn call(session: &mut Session, name: &str, arguments: &[Value]) -> Vec<Value> {
    session.call(name, arguments).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn handle(session: &mut Session, path: &str) -> i64 {
    i64::from(session.registry().find(path, Search::default()).unwrap().0)
}

fn position(session: &mut Session, object: i64) -> [f64; 3] {
    let found = call(session, "sim.getObjectPosition", &[object.into(), (-1_i64).into()]);
    found[0].as_reals().unwrap().try_into().unwrap()
}

fn put(session: &mut Session, object: i64, place: [f64; 3]) {
    call(session, "sim.setObjectPosition", &[object.into(), Value::reals(place), (-1_i64).into()]);
}

fn parent(session: &mut Session, object: i64) -> i64 {
    call(session, "sim.getObjectParent", &[object.into()])[0].as_int().unwrap()
}

fn hang(session: &mut Session, object: i64, parent: i64) {
    call(session, "sim.setObjectParent", &[object.into(), parent.into(), true.into()]);
}

fn steps(session: &mut Session, n: usize) {
    for _ in 0..n {
        session.step().unwrap();
    }
}

/// Gives a belt a velocity along x and y `[m/s]` for the coming step.
fn drive(session: &mut Session, belt: i64, [x, y]: [f64; 2]) {
    for (id, value) in [(3000_i64, x), (3001, y)] {
        call(session, "sim.setObjectFloatParam", &[belt.into(), id.into(), value.into()]);
    }
}

fn is_static(session: &mut Session, body: i64) -> bool {
    call(session, "sim.getObjectInt32Param", &[body.into(), 3003_i64.into()]) == [Value::Int(1)]
}

fn copy(session: &mut Session, object: i64, options: i64) -> i64 {
    let copied = call(session, "sim.copyPasteObjects", &[Value::List(vec![object.into()]), options.into()]);
    let Value::List(list) = &copied[0] else { panic!("a list of handles") };
    list[0].as_int().unwrap()
}

fn is_near(a: [f64; 3], b: [f64; 3], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance)
}

#[test]
fn a_static_body_with_an_initial_velocity_carries_others_along() {
    let mut session = open();
    let (slab, body) = (handle(&mut session, "/slab"), handle(&mut session, "/box"));
    session.start().unwrap();
    let drive = |session: &mut OpenSession, speed: f64| {
        call(session, "sim.resetDynamicObject", &[slab.into()]);
        for (id, value) in [(3000_i64, speed), (3001, 0.0), (3002, 0.0)] {
            call(session, "sim.setObjectFloatParam", &[slab.into(), id.into(), value.into()]);
        }
    };
    for _ in 0..200 {
        drive(&mut session, 0.2);
        steps(&mut session, 1);
    }
    let carried = position(&mut session, body);
    // friction brings it to the speed of the belt within v/(μ g) = 0.04 s
    let slip = 0.2 * 0.2 / (2.0 * 0.5 * G);
    assert!((carried[0] - (-0.5 + 0.2 - slip)).abs() < 2e-3, "{carried:?}");
    assert!((carried[2] - 0.15).abs() < 1e-6);
    assert!(position(&mut session, slab)[0].abs() < 1.1e-3, "it is put back at each step");
    assert_eq!(call(&mut session, "sim.getObjectInt32Param", &[slab.into(), 3003_i64.into()]), [Value::Int(1)]);
    assert_eq!(call(&mut session, "sim.getObjectParent", &[slab.into()])[0].as_int(), Some(-1));
    // without a reset it stands, and what lies on it with it
    steps(&mut session, 40);
    let there = position(&mut session, body);
    steps(&mut session, 40);
    assert!((position(&mut session, body)[0] - there[0]).abs() < 1e-9);
    // across, too
    for _ in 0..100 {
        call(&mut session, "sim.setObjectFloatParam", &[slab.into(), 3000_i64.into(), 0.0.into()]);
        call(&mut session, "sim.setObjectFloatParam", &[slab.into(), 3001_i64.into(), 0.1.into()]);
        steps(&mut session, 1);
    }
    assert!(position(&mut session, body)[1] > 0.04);
    let turned = session.call("sim.setObjectFloatParam", &[slab.into(), 3020_i64.into(), 1.0.into()]).unwrap_err();
    assert!(turned.0.contains("conveyor belts go along a line"), "{turned:?}");
    session.stop().unwrap();
    let run = session.take_finished().remove(0).simulated;
    assert!(sincro_testing::last(&run, "energy.balance").abs() < 1e-6);
    assert_eq!(position(&mut session, slab), [0.0, 0.0, 0.05]);
}

#[test]
fn a_belt_is_put_and_hung_elsewhere_with_its_joint() {
    let mut session = open();
    let [slab, body, floor] = ["/slab", "/box", "/floor"].map(|path| handle(&mut session, path));
    put(&mut session, body, [5.0, 0.0, 0.05]);
    session.start().unwrap();
    let go = |session: &mut OpenSession| {
        for _ in 0..5 {
            drive(session, slab, [0.2, 0.0]);
            steps(session, 1);
        }
    };
    go(&mut session);
    // along the belt and across it
    for place in [[0.3, 0.0, 0.05], [0.3, 0.5, 0.05], [0.0, 0.0, 0.05]] {
        put(&mut session, slab, place);
        assert!(is_near(position(&mut session, slab), place, 1e-12));
        go(&mut session);
        assert!(is_near(position(&mut session, slab), place, STEP), "{:?}", position(&mut session, slab));
    }
    hang(&mut session, slab, floor);
    assert_eq!(parent(&mut session, slab), floor);
    go(&mut session);
    hang(&mut session, slab, -1);
    assert_eq!(parent(&mut session, slab), -1);
    // a turned belt has its joint turned with it, and goes along x again
    let turn = [slab.into(), Value::reals([0.0, 0.0, 1.0]), (-1_i64).into()];
    call(&mut session, "sim.setObjectOrientation", &turn);
    go(&mut session);
    let there = position(&mut session, slab);
    assert!(is_near(there, [0.0, 0.0, 0.05], STEP) && there[1].abs() < 1e-9, "{there:?}");
    session.stop().unwrap();
    let run = session.take_finished().remove(0).simulated;
    assert!(sincro_testing::last(&run, "energy.balance").abs() < 1e-6);
    assert_eq!(position(&mut session, slab), [0.0, 0.0, 0.05]);
}

#[test]
fn a_belt_is_static_until_it_is_made_to_move() {
    let mut session = open();
    let [slab, block] = ["/slab", "/block"].map(|path| handle(&mut session, path));
    session.start().unwrap();
    for _ in 0..3 {
        drive(&mut session, slab, [0.2, 0.0]);
        drive(&mut session, block, [0.1, 0.0]);
        steps(&mut session, 1);
    }
    let set = |session: &mut OpenSession, body: i64, value: i64| {
        session.call("sim.setObjectInt32Param", &[body.into(), 3003_i64.into(), value.into()])
    };
    set(&mut session, slab, 1).unwrap();
    let refused = set(&mut session, slab, 0).unwrap_err();
    assert!(refused.0.contains("has no mass"), "{refused:?}");
    let enabled = |session: &mut OpenSession| call(session, "sim.isDynamicallyEnabled", &[block.into()])[0].clone();
    assert_eq!(enabled(&mut session), Value::Bool(false));
    set(&mut session, block, 0).unwrap();
    assert!(!is_static(&mut session, block));
    assert_eq!(enabled(&mut session), Value::Bool(true));
    steps(&mut session, 20);
    let fallen = 0.5 - 0.5 * G * 0.1 * 0.1;
    assert!(is_near(position(&mut session, block), [10.0, 0.0, fallen], STEP), "it falls");
    let fast = session.call("sim.setObjectFloatParam", &[slab.into(), 3000_i64.into(), 1e300.into()]).unwrap_err();
    assert!(fast.0.contains("is above 1000 m/s"), "{fast:?}");
    steps(&mut session, 1);
}

#[test]
fn a_copy_of_a_belt_is_a_belt() {
    let mut session = open();
    let [slab, line, band] = ["/slab", "/line", "/line/band"].map(|path| handle(&mut session, path));
    session.start().unwrap();
    for _ in 0..3 {
        [slab, band].iter().for_each(|belt| drive(&mut session, *belt, [0.2, 0.0]));
        steps(&mut session, 1);
    }
    let copied = copy(&mut session, slab, 0);
    let copied_line = copy(&mut session, line, 0);
    let copied_band = handle(&mut session, "/line0/band");
    assert_eq!(parent(&mut session, copied_band), copied_line);
    for (belt, place) in [(copied, [0.0, 0.0, 0.05]), (copied_band, [0.0, 10.0, 0.05])] {
        assert!(is_static(&mut session, belt));
        steps(&mut session, 10);
        assert!(is_near(position(&mut session, belt), place, 1e-12), "it stands: {:?}", position(&mut session, belt));
        for _ in 0..3 {
            drive(&mut session, belt, [0.0, 0.2]);
            steps(&mut session, 1);
        }
        assert!(is_near(position(&mut session, belt), place, STEP));
    }
    session.stop().unwrap();
    let run = session.take_finished().remove(0).simulated;
    assert!(sincro_testing::last(&run, "energy.balance").abs() < 1e-6);
}

#[test]
fn dummies_that_are_linked_join_the_bodies_that_carry_them() {
    let mut session = open();
    let (slab, body) = (handle(&mut session, "/slab"), handle(&mut session, "/box"));
    session.start().unwrap();
    steps(&mut session, 2);
    put(&mut session, body, [0.0, 0.0, 0.5]);
    let dummies = [slab, body].map(|carrier| {
        let dummy = call(&mut session, "sim.createDummy", &[0.01.into()])[0].as_int().unwrap();
        put(&mut session, dummy, [0.0, 0.0, 0.4]);
        call(&mut session, "sim.setObjectParent", &[dummy.into(), carrier.into(), true.into()]);
        dummy
    });
    call(&mut session, "sim.setLinkDummy", &[dummies[1].into(), dummies[0].into()]);
    assert_eq!(call(&mut session, "sim.getLinkDummy", &[dummies[0].into()])[0].as_int(), Some(dummies[1]));
    let link_type = |value: i64| [dummies[0].into(), 10_000_i64.into(), value.into()];
    call(&mut session, "sim.setObjectInt32Param", &link_type(0));
    assert!(session.call("sim.setObjectInt32Param", &link_type(5)).unwrap_err().0.contains("join bodies"));
    steps(&mut session, 20);
    assert_eq!(position(&mut session, body), [0.0, 0.0, 0.5]);
    call(&mut session, "sim.setLinkDummy", &[dummies[0].into(), (-1_i64).into()]);
    assert_eq!(call(&mut session, "sim.getLinkDummy", &[dummies[1].into()])[0].as_int(), Some(-1));
    steps(&mut session, 20);
    assert!(position(&mut session, body)[2] < 0.46, "it falls");
}

/// The box above the floor, linked with the slab by a dummy on each; returns the dummies, that of the slab first.
fn linked(session: &mut OpenSession) -> [i64; 2] {
    let carriers = ["/slab", "/box"].map(|path| handle(session, path));
    session.start().unwrap();
    put(session, carriers[1], [0.0, 0.0, 0.5]);
    let dummies = carriers.map(|carrier| {
        let dummy = call(session, "sim.createDummy", &[0.01.into()])[0].as_int().unwrap();
        put(session, dummy, [0.0, 0.0, 0.4]);
        hang(session, dummy, carrier);
        dummy
    });
    call(session, "sim.setLinkDummy", &[dummies[1].into(), dummies[0].into()]);
    dummies
}

fn link_of(session: &mut Session, dummy: i64) -> i64 {
    call(session, "sim.getLinkDummy", &[dummy.into()])[0].as_int().unwrap()
}

#[test]
fn a_link_ends_with_its_dummies_and_the_bodies_that_it_joins() {
    for (name, removed) in
        [("sim.removeObject", None), ("sim.removeObject", Some("/slab")), ("sim.removeModel", Some("/slab"))]
    {
        let mut session = open();
        let [dummy, other] = linked(&mut session);
        let body = handle(&mut session, "/box");
        let removed = removed.map_or(dummy, |path| handle(&mut session, path));
        call(&mut session, name, &[removed.into()]);
        assert_eq!(link_of(&mut session, other), -1);
        assert_eq!(parent(&mut session, body), -1);
        steps(&mut session, 20);
        assert!(position(&mut session, body)[2] < 0.46, "it falls");
    }
}

#[test]
fn a_joined_body_that_is_hung_elsewhere_is_linked_no_more() {
    let mut session = open();
    let dummies = linked(&mut session);
    let [body, slab, block] = ["/box", "/slab", "/block"].map(|path| handle(&mut session, path));
    assert_eq!(parent(&mut session, body), slab);
    hang(&mut session, body, block);
    assert_eq!(dummies.map(|dummy| link_of(&mut session, dummy)), [-1, -1]);
    call(&mut session, "sim.setLinkDummy", &[dummies[0].into(), (-1_i64).into()]);
    assert_eq!(parent(&mut session, body), block);
}
