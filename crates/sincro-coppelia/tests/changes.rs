//! Changes of the model by clients: the run is that of a scene which says so, the balance of energy holds, and nothing
//! is left behind.

use sincro_coppelia::api::{Phase, Search, Value};
use sincro_coppelia::session::Session;
use sincro_scene::overrides::Override;
use sincro_sim::Extensions;
use sincro_sim::run::Simulated;
use sincro_testing::{OpenSession, SceneFolder, last};

const SCENE: &str = r#"
gravity = [0.0, 0.0, -9.81]
[[body]]
name = "floor"
shape = [{ plane = {} }]
contact = { friction = 0.5 }
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
position = [0.0, 0.0, 3.0]
limits = { lower = -1.0, upper = 1.2, restitution = 0.5 }
initial = { position = 0.5 }
[[body]]
name = "arm"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.0, 0.0, -0.5]
inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }
[[body]]
name = "bob"
parent = "/hinge/arm"
position = [0.1, 0.0, -1.0]
density = 500.0
shape = [{ cuboid = { size = [0.1, 0.2, 0.3] } }]
[[joint]]
name = "follower"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
position = [5.0, 0.0, 1.0]
initial = { position = 1.0 }
[[body]]
name = "slide"
parent = "/follower"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
[[coupling]]
name = "gear"
joints = ["/hinge", "/follower"]
ratio = 2.0
[[joint]]
name = "loose"
kind = "free"
initial = { position = [10.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0] }
[[body]]
name = "ball"
parent = "/loose"
density = 1000.0
shape = [{ sphere = { radius = 0.1 } }]
contact = { friction = 0.5 }
"#;

const EXPERIMENT: &str = r#"
title = "Changes"
duration = 0.5
step = 0.01
record = ["/hinge.position", "/loose.position.z", "/loose.position.x", "energy.balance", "/hinge/arm/bob.center_of_mass.x"]
"#;

/// A session of the scene with settings, in a folder of its own.
fn session(set: &[(&str, &str)]) -> OpenSession {
    let set: Vec<Override> = set.iter().map(|(path, value)| Override::new(path, value)).collect();
    OpenSession::open(SceneFolder::of(SCENE, EXPERIMENT), &set, Extensions::default(), None)
}

fn call(session: &mut Session, name: &str, object: &str, more: &[Value]) -> Result<Vec<Value>, String> {
    let handle = session.sim().registry.find(object, Search::default()).unwrap();
    let arguments = [&[Value::from(handle)], more].concat();
    session.call(name, &arguments).map_err(|error| error.to_string())
}

fn run(session: &mut Session) -> Simulated {
    session.start().unwrap();
    (0..50).for_each(|_| session.step().unwrap());
    session.stop().unwrap();
    session.take_finished().remove(0).simulated
}

#[test]
fn a_mass_that_is_set_while_stopped_is_that_of_a_scene_which_has_it() {
    let mut changed = session(&[]);
    let plain = run(&mut changed).trace;
    call(&mut changed, "sim.setShapeMass", "/arm", &[Value::Real(2.0)]).unwrap();
    call(&mut changed, "sim.computeMassAndInertia", "/bob", &[Value::Real(800.0)]).unwrap();
    assert_eq!(call(&mut changed, "sim.getShapeMass", "/arm", &[]), Ok(vec![Value::Real(2.0)]));
    let set = [
        ("/hinge/arm.mass", "2.0"),
        ("/hinge/arm.inertia.xx", "0.2"),
        ("/hinge/arm.inertia.yy", "0.2"),
        ("/hinge/arm.inertia.zz", "0.02"),
        ("/hinge/arm/bob.density", "800.0"),
    ];
    let wanted = run(&mut session(&set));
    for _ in 0..2 {
        let run = run(&mut changed);
        assert_eq!(run.trace, wanted.trace, "it stays for all runs");
        assert_eq!(run.method, wanted.method);
        let told: Vec<_> = run.changes.iter().map(|c| (c.t, c.object.as_str(), c.quantity)).collect();
        assert_eq!(told[0], (0.0, "/hinge/arm", "mass"));
        assert_eq!(told.len(), 6);
    }
    assert_ne!(plain, wanted.trace);
    // and is gone with the scene
    let own = changed.folder().file_name().unwrap().to_str().unwrap().to_owned();
    changed.load(&own).unwrap();
    assert_eq!(run(&mut changed).trace, plain);
}

#[test]
fn masses_inertias_and_centres_come_back_as_they_were_given() {
    let mut session = session(&[]);
    let nine = Value::reals([0.3, 0.01, 0.0, 0.01, 0.2, 0.0, 0.0, 0.0, 0.25]);
    // a quarter turn about z, shifted
    let at = Value::reals([0.0, -1.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.2, 0.0, 0.0, 1.0, 0.3]);
    call(&mut session, "sim.setShapeInertia", "/arm", &[nine, at]).unwrap();
    let got = call(&mut session, "sim.getShapeInertia", "/arm", &[]).unwrap();
    let [Value::List(inertia), Value::List(place)] = &got[..] else { panic!("{got:?}") };
    let expected = [0.2, -0.01, 0.0, -0.01, 0.3, 0.0, 0.0, 0.0, 0.25];
    for (x, e) in inertia.iter().zip(expected) {
        assert!((x.as_real().unwrap() - e).abs() < 1e-15, "{inertia:?}");
    }
    assert_eq!([&place[3], &place[7], &place[11]].map(|x| x.as_real().unwrap()), [0.1, 0.2, 0.3]);
    // what the older function gives it takes, in the world and in any frame
    let frame = Value::reals([1.0, 0.0, 0.0, 0.5, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 1.0]);
    for frame in [&[][..], std::slice::from_ref(&frame)] {
        let told = call(&mut session, "sim.getShapeMassAndInertia", "/arm", frame).unwrap();
        call(&mut session, "sim.setShapeMassAndInertia", "/arm", &[&told[..], frame].concat()).unwrap();
        let again = call(&mut session, "sim.getShapeMassAndInertia", "/arm", frame).unwrap();
        let numbers =
            |values: &[Value]| values.iter().flat_map(|v| v.as_reals().unwrap_or_default()).collect::<Vec<_>>();
        let (told, again) = (numbers(&told[1..]), numbers(&again[1..]));
        assert!(told.len() == 12 && told.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-12), "{told:?} {again:?}");
    }
}

#[test]
fn a_mass_that_changes_in_a_run_is_work_and_is_gone_after_it() {
    let mut session = session(&[]);
    let plain = run(&mut session).trace;
    session.start().unwrap();
    (0..20).for_each(|_| session.step().unwrap());
    call(&mut session, "sim.setShapeMass", "/arm", &[Value::Real(3.0)]).unwrap();
    (0..10).for_each(|_| session.step().unwrap());
    session.call("sim.setArrayParam", &[Value::Int(0), Value::reals([0.0, 0.0, -1.62])]).unwrap();
    (0..20).for_each(|_| session.step().unwrap());
    session.stop().unwrap();
    let run = session.take_finished().remove(0).simulated;
    let balance = &run.table.column("energy.balance").unwrap().values;
    assert!(balance.iter().all(|x| x.abs() < 1e-6), "{balance:?}");
    assert!(run.energy.work.abs() > 1.0, "{:?}", run.energy);
    let told: Vec<_> = run.changes.iter().map(|c| ((c.t * 100.0).round(), c.object.as_str(), c.quantity)).collect();
    assert_eq!((told[0], told[3]), ((20.0, "/hinge/arm", "mass"), (30.0, "/", "gravity")));
    assert_eq!(self::run(&mut session).trace, plain, "the next run is that of the scene");
    assert_eq!(call(&mut session, "sim.getShapeMass", "/arm", &[]), Ok(vec![Value::Real(1.0)]));
}

#[test]
fn a_mass_or_gravity_that_changes_before_the_first_step_is_work() {
    let mut session = session(&[]);
    session.start().unwrap();
    call(&mut session, "sim.setShapeMass", "/arm", &[Value::Real(3.0)]).unwrap();
    session.call("sim.setArrayParam", &[Value::Int(0), Value::reals([0.0, 0.0, -1.62])]).unwrap();
    (0..20).for_each(|_| session.step().unwrap());
    session.stop().unwrap();
    let run = session.take_finished().remove(0).simulated;
    assert!(run.energy.residual < 1e-6, "{:?}", run.energy);
    assert!(run.energy.work.abs() > 1.0, "{:?}", run.energy);
}

#[test]
fn stops_and_couplings_are_moved_as_in_a_scene_that_has_them_there() {
    let mut changed = session(&[]);
    let interval = |low: f64, range: f64| [Value::Bool(false), Value::reals([low, range])];
    call(&mut changed, "sim.setJointInterval", "/hinge", &interval(-0.5, 1.25)).unwrap();
    let got = call(&mut changed, "sim.getJointInterval", "/hinge", &[]).unwrap();
    assert_eq!(got, [Value::Bool(false), Value::reals([-0.5, 1.25])]);
    let hinge = Value::from(changed.sim().registry.find("/hinge", Search::default()).unwrap());
    call(&mut changed, "sim.setJointDependency", "/follower", &[hinge.clone(), Value::Real(0.25), Value::Real(3.0)])
        .unwrap();
    assert_eq!(call(&mut changed, "sim.getJointPosition", "/follower", &[]), Ok(vec![Value::Real(1.75)]));
    let set = [
        ("/hinge.limits.lower", "-0.5"),
        ("/hinge.limits.upper", "0.75"),
        ("coupling.0.ratio", "3.0"),
        ("coupling.0.offset", "0.25"),
        ("/follower.initial.position", "1.75"),
    ];
    let (run, wanted) = (self::run(&mut changed), self::run(&mut session(&set)));
    assert_eq!(run.trace, wanted.trace);
    assert!(last(&run, "/hinge.position") >= -0.5 - 1e-9);
    for (name, object, arguments, why) in [
        ("setJointInterval", "/hinge", interval(0.8, 0.1).to_vec(), "beyond 0.8 to 0.9"),
        ("setJointInterval", "/hinge", interval(0.3, f64::NAN).to_vec(), "is no interval"),
        ("setJointDependency", "/hinge", vec![hinge.clone(), Value::Real(0.0), Value::Real(1.0)], "does not couple"),
        ("setJointDependency", "/follower", vec![hinge.clone(), Value::Real(0.0), Value::Real(0.0)], "not zero"),
    ] {
        let told = call(&mut changed, &format!("sim.{name}"), object, &arguments).unwrap_err();
        assert!(told.contains(why), "{told}");
    }
    changed.start().unwrap();
    let told = call(&mut changed, "sim.setJointDependency", "/follower", &[hinge, Value::Real(0.0), Value::Real(2.0)]);
    assert!(told.unwrap_err().contains("stop the run first"));
}

#[test]
fn a_coupling_by_a_polynomial_keeps_it() {
    let mut session = session(&[("coupling.0.polynomial", "[0.5]"), ("/follower.initial.position", "1.125")]);
    let hinge = Value::from(session.sim().registry.find("/hinge", Search::default()).unwrap());
    let before = session.sim().world.model().constraints().gears[0].clone();
    let told = call(&mut session, "sim.setJointDependency", "/follower", &[hinge, Value::Real(0.25), Value::Real(3.0)]);
    assert!(told.as_ref().is_err_and(|why| why.contains("follows `/hinge` by a polynomial")), "{told:?}");
    assert_eq!(session.sim().world.model().constraints().gears[0], before);
}

#[test]
fn a_body_may_pass_through_all_others_and_begin_with_a_velocity() {
    let mut session = session(&[]);
    let plain = run(&mut session).trace;
    call(&mut session, "sim.setObjectInt32Param", "/ball", &[Value::Int(3004), Value::Int(0)]).unwrap();
    assert_eq!(call(&mut session, "sim.getObjectInt32Param", "/ball", &[Value::Int(3004)]), Ok(vec![Value::Int(0)]));
    for (id, x) in [(3000, 2.0), (3002, 1.0), (3021, 3.0)] {
        call(&mut session, "sim.setObjectFloatParam", "/ball", &[Value::Int(id), Value::Real(x)]).unwrap();
    }
    for _ in 0..2 {
        let run = run(&mut session);
        let (x, z) = (last(&run, "/loose.position.x"), last(&run, "/loose.position.z"));
        assert!((x - 11.0).abs() < 1e-9 && (z - (0.1 + 0.5 - 0.5 * 9.81 * 0.25)).abs() < 1e-9, "{x} {z}");
    }
    call(&mut session, "sim.setObjectInt32Param", "/ball", &[Value::Int(3004), Value::Int(1)]).unwrap();
    for id in [3000, 3002, 3021] {
        call(&mut session, "sim.setObjectFloatParam", "/ball", &[Value::Int(id), Value::Real(0.0)]).unwrap();
    }
    assert_eq!(run(&mut session).trace, plain);
    let told = call(&mut session, "sim.setObjectInt32Param", "/arm", &[Value::Int(3004), Value::Int(1)]).unwrap_err();
    assert!(told.contains("`/hinge/arm` has no shape"), "{told}");
    let told =
        call(&mut session, "sim.setObjectFloatParam", "/arm", &[Value::Int(3000), Value::Real(0.0)]).unwrap_err();
    assert!(told.contains("hangs on no free joint"), "{told}");
}

#[test]
fn what_nothing_weighs_is_refused() {
    let mut session = session(&[]);
    let nine = |a: f64, b: f64, c: f64| Value::reals([a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c]);
    let one = Value::reals([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let skew = Value::reals([1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    for (name, object, arguments, why) in [
        ("setShapeMass", "/arm", vec![Value::Real(0.0)], "mass 0 kg of `/hinge/arm` is not positive"),
        ("setShapeMass", "/arm", vec![Value::Real(f64::INFINITY)], "not positive"),
        ("setShapeMass", "/floor", vec![Value::Real(1.0)], "fixed in the world"),
        ("setShapeMass", "/hinge", vec![Value::Real(1.0)], "`/hinge` is no body"),
        ("setShapeInertia", "/arm", vec![nine(1.0, 1.0, 3.0), one.clone()], "no rigid body has the inertia"),
        ("setShapeInertia", "/arm", vec![nine(1.0, 1.0, -0.5), one.clone()], "negative principal moment"),
        ("setShapeInertia", "/arm", vec![skew, one], "not symmetric: 0.5 and 0"),
        ("computeMassAndInertia", "/arm", vec![Value::Real(1.0)], "no solids of closed form"),
        ("computeMassAndInertia", "/bob", vec![Value::Real(-1.0)], "density -1 kg/m³ is not positive"),
    ] {
        let told = call(&mut session, &format!("sim.{name}"), object, &arguments).unwrap_err();
        assert!(told.contains(why), "{told}");
    }
    assert_eq!(session.phase(), Phase::Stopped);
    assert!(run(&mut session).changes.is_empty());
}

fn velocity(session: &mut Session) -> Vec<f64> {
    let told = call(session, "sim.getObjectVelocity", "/ball", &[]).unwrap();
    [told[0].as_reals().unwrap(), told[1].as_reals().unwrap()].concat()
}

#[test]
fn an_initial_velocity_that_is_set_after_a_reset_is_the_whole_velocity() {
    let mut session = session(&[]);
    let set = |session: &mut Session, id: i64, x: f64| {
        call(session, "sim.setObjectFloatParam", "/ball", &[Value::Int(id), Value::Real(x)]).unwrap();
    };
    let near = |session: &mut Session, wanted: [f64; 6]| {
        let told = velocity(session);
        assert!(told.iter().zip(wanted).all(|(x, y)| (x - y).abs() < 1e-12), "{told:?}, expected {wanted:?}");
    };
    call(&mut session, "sim.setObjectInt32Param", "/ball", &[Value::Int(3004), Value::Int(0)]).unwrap();
    set(&mut session, 3002, 5.0);
    set(&mut session, 3021, 3.0);
    session.start().unwrap();
    session.step().unwrap();
    call(&mut session, "sim.resetDynamicObject", "/ball", &[]).unwrap();
    assert!(velocity(&mut session)[2] > 4.0, "nothing was set: it goes on");
    set(&mut session, 3000, 2.0);
    near(&mut session, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    set(&mut session, 3001, 1.0);
    near(&mut session, [2.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    call(&mut session, "sim.resetDynamicObject", "/ball", &[]).unwrap();
    set(&mut session, 3020, 4.0);
    near(&mut session, [2.0, 1.0, 0.0, 4.0, 0.0, 0.0]);
    // in a later step it waits, and is the whole velocity again
    session.step().unwrap();
    set(&mut session, 3001, 6.0);
    assert!((velocity(&mut session)[0] - 2.0).abs() < 1e-9);
    call(&mut session, "sim.resetDynamicObject", "/ball", &[]).unwrap();
    near(&mut session, [0.0, 6.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn flags_and_stops_stay_as_they_are_when_the_run_keeps_no_more_changes() {
    let mut session = session(&[]);
    session.start().unwrap();
    let mut n = 0;
    let told = loop {
        n += 1;
        assert!(n <= 10_001, "there is a limit");
        let gravity = Value::reals([0.0, 0.0, -9.81]);
        match session.call("sim.setArrayParam", &[Value::Int(0), gravity]) {
            Ok(_) => session.step().unwrap(),
            Err(error) => break error.0,
        }
    };
    assert!(told.contains("10000 times"), "{told}");
    for (set, get, value) in [
        ("sim.setObjectSpecialProperty", "sim.getObjectSpecialProperty", 1),
        ("sim.setModelProperty", "sim.getModelProperty", 8),
    ] {
        let before = call(&mut session, get, "/ball", &[]).unwrap();
        let told = call(&mut session, set, "/ball", &[Value::Int(value)]).unwrap_err();
        assert!(told.contains("10000 times"), "{told}");
        assert_eq!(call(&mut session, get, "/ball", &[]), Ok(before), "{get}");
    }
    // so are the stops of a joint
    let before = call(&mut session, "sim.getJointInterval", "/hinge", &[]).unwrap();
    for (is_cyclic, interval) in [(false, [-3.0, 6.0]), (true, [0.0, 0.0])] {
        let arguments = [Value::Bool(is_cyclic), Value::reals(interval)];
        let told = call(&mut session, "sim.setJointInterval", "/hinge", &arguments).unwrap_err();
        assert!(told.contains("10000 times"), "{told}");
        assert_eq!(call(&mut session, "sim.getJointInterval", "/hinge", &[]), Ok(before.clone()));
    }
}

fn position(session: &mut Session, joint: &str) -> f64 {
    call(session, "sim.getJointPosition", joint, &[]).unwrap()[0].as_real().unwrap()
}

#[test]
fn a_kinematic_joint_stays_where_it_was_put_until_it_is_dynamic_again() {
    let mut session = session(&[]);
    // the hinge has no motor in the scene
    call(&mut session, "sim.setJointMode", "/hinge", &[Value::Int(0), Value::Int(0)]).unwrap();
    session.start().unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    assert_eq!(position(&mut session, "/hinge"), 0.5);
    call(&mut session, "sim.setJointTargetVelocity", "/hinge", &[Value::Real(1.0)]).unwrap();
    call(&mut session, "sim.setJointPosition", "/follower", &[Value::Real(1.2)]).unwrap();
    call(&mut session, "sim.setJointPosition", "/hinge", &[Value::Real(0.6)]).unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    assert_eq!(position(&mut session, "/hinge"), 0.6);
    assert_eq!(call(&mut session, "sim.getJointMode", "/hinge", &[]), Ok(vec![Value::Int(0), Value::Int(0)]));
    call(&mut session, "sim.setJointMode", "/hinge", &[Value::Int(5), Value::Int(0)]).unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    assert!(position(&mut session, "/hinge") < 0.599, "it swings");
    assert_eq!(call(&mut session, "sim.getJointMode", "/hinge", &[]), Ok(vec![Value::Int(5), Value::Int(0)]));
    let refused = call(&mut session, "sim.setJointMode", "/hinge", &[Value::Int(7), Value::Int(0)]).unwrap_err();
    assert!(refused.contains("7 is no joint mode: kinematic 0, ik 2, dependent 4, dynamic 5"), "{refused}");
}

#[test]
fn bodies_whose_respondable_masks_have_no_bit_in_common_pass_through_each_other() {
    let mask = |session: &mut Session, bits: i64| {
        call(session, "sim.setObjectInt32Param", "/ball", &[Value::Int(3019), Value::Int(bits)])
    };
    let height = |session: &mut Session| {
        let place = call(session, "sim.getObjectPosition", "/ball", &[Value::Int(-1)]).unwrap();
        place[0].as_reals().unwrap()[2]
    };
    let mut session = session(&[]);
    assert_eq!(
        call(&mut session, "sim.getObjectInt32Param", "/ball", &[Value::Int(3019)]),
        Ok(vec![Value::Int(0xffff)])
    );
    session.start().unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    assert!((height(&mut session) - 0.1).abs() < 1e-9, "it lies on the floor");
    // bits of other trees are in the second byte
    mask(&mut session, 0x01ff).unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    assert!((height(&mut session) - 0.1).abs() < 1e-9);
    mask(&mut session, 0x00ff).unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    let fallen = 0.5 * 9.81 * 0.05 * 0.05;
    assert!((height(&mut session) - (0.1 - fallen)).abs() < 1e-6, "it falls through the floor");
    assert!(mask(&mut session, 0x1_0000).is_err());
    session.stop().unwrap();
    let told = session.take_finished().remove(0).simulated.changes;
    assert_eq!(told.iter().filter(|change| change.quantity == "respondable_mask").count(), 2);
    // the next run begins with the scene's own
    session.start().unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    assert!((height(&mut session) - 0.1).abs() < 1e-9);
}

#[test]
fn parts_of_the_step_that_a_scene_has_not_are_switched_off_and_on() {
    let mut session = session(&[]);
    let put = |session: &mut Session, id: i64, value: bool| {
        session.call("sim.setBoolParam", &[Value::Int(id), Value::Bool(value)]).map(drop)
    };
    let get = |session: &mut Session, id: i64| session.call("sim.getBoolParam", &[Value::Int(id)]).unwrap();
    for id in [2, 3, 4, 5, 8] {
        put(&mut session, id, false).unwrap();
        assert_eq!(get(&mut session, id), [Value::Bool(false)]);
        put(&mut session, id, true).unwrap();
        assert_eq!(get(&mut session, id), [Value::Bool(true)]);
    }
    assert!(put(&mut session, 9, false).is_err());
}

#[test]
fn without_dynamics_objects_stay_and_joints_can_be_put_elsewhere() {
    let mut session = session(&[]);
    session.start().unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    session.call("sim.setBoolParam", &[Value::Int(6), Value::Bool(false)]).unwrap();
    let there = position(&mut session, "/hinge");
    (0..10).for_each(|_| session.step().unwrap());
    assert_eq!(position(&mut session, "/hinge"), there);
    assert_eq!(call(&mut session, "sim.getJointVelocity", "/hinge", &[]), Ok(vec![Value::Real(0.0)]));
    let t = session.call("sim.getSimulationTime", &[]).unwrap()[0].as_real().unwrap();
    assert!((t - 0.15).abs() < 1e-9, "time goes on: {t}");
    call(&mut session, "sim.setObjectPosition", "/ball", &[Value::Int(-1), Value::reals([10.0, 0.0, 0.5])]).unwrap();
    session.step().unwrap();
    session.call("sim.setBoolParam", &[Value::Int(6), Value::Bool(true)]).unwrap();
    (0..5).for_each(|_| session.step().unwrap());
    assert!(position(&mut session, "/hinge") != there, "it swings again");
    session.stop().unwrap();
    let run = session.take_finished().remove(0).simulated;
    assert!(last(&run, "energy.balance").abs() < 1e-6);
}

#[test]
fn a_body_on_a_joint_is_put_where_the_joint_can_bring_it() {
    let mut session = session(&[]);
    let pose = |session: &mut Session, body: &str| {
        call(session, "sim.getObjectPose", body, &[Value::Int(-1)]).unwrap()[0].as_reals().unwrap()
    };
    let (arm, bob) = (pose(&mut session, "/arm"), pose(&mut session, "/bob"));
    session.start().unwrap();
    (0..10).for_each(|_| session.step().unwrap());
    assert!((position(&mut session, "/hinge") - 0.5).abs() > 1e-3, "it has swung");
    // as scripts restore a robot: position, then orientation, of each object
    for (body, at) in [("/arm", &arm), ("/bob", &bob)] {
        let (place, turn) = (Value::reals(at[..3].to_vec()), Value::reals(at[3..].to_vec()));
        call(&mut session, "sim.setObjectPosition", body, &[Value::Int(-1), place]).unwrap();
        call(&mut session, "sim.setObjectQuaternion", body, &[Value::Int(-1), turn]).unwrap();
    }
    assert!((position(&mut session, "/hinge") - 0.5).abs() < 1e-9);
    assert_eq!(call(&mut session, "sim.getJointVelocity", "/hinge", &[]), Ok(vec![Value::Real(0.0)]));
    let away = [Value::Int(-1), Value::reals([0.0, 1.0, 3.0])];
    let refused = call(&mut session, "sim.setObjectPosition", "/arm", &away).unwrap_err();
    assert!(refused.contains("the joint that carries it cannot bring it there"), "{refused}");
    session.step().unwrap();
}

const MOTORS: &str = r#"
gravity = [0.0, 0.0, -9.81]
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
limits = { lower = -3.6, upper = 3.6 }
motor = { mode = "position", kp = 20.0, max_torque = 50.0 }
[[body]]
name = "arm"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.5, 0.0, 0.0]
inertia = { xx = 0.01, yy = 0.1, zz = 0.1 }
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1.0, 0.0, 0.0]
position = [0.0, 5.0, 0.0]
limits = { lower = -0.1, upper = 0.1 }
motor = { mode = "position", kp = 20.0, max_torque = 50.0 }
[[body]]
name = "slide"
parent = "/rail"
mass = 1.0
inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
"#;

fn session_of_motors() -> OpenSession {
    let experiment =
        "title = \"Motors\"\nduration = 1.0\nstep = 0.01\nrecord = [\"/hinge.position\", \"energy.balance\"]\n";
    OpenSession::open(SceneFolder::of(MOTORS, experiment), &[], Extensions::default(), None)
}

#[test]
fn a_body_is_put_back_without_full_turns_and_within_the_limits_of_its_joint() {
    let mut session = session_of_motors();
    session.start().unwrap();
    let pose = |session: &mut Session| {
        call(session, "sim.getObjectPose", "/arm", &[Value::Int(-1)]).unwrap()[0].as_reals().unwrap()
    };
    let set = |session: &mut Session, pose: Vec<f64>| {
        call(session, "sim.setObjectPose", "/arm", &[Value::reals(pose), Value::Int(-1)]).unwrap()
    };
    let begin = pose(&mut session);
    // beyond half a turn: what stands there stays
    call(&mut session, "sim.setJointPosition", "/hinge", &[Value::Real(3.5)]).unwrap();
    let there = pose(&mut session);
    set(&mut session, there);
    assert!((position(&mut session, "/hinge") - 3.5).abs() < 1e-9);
    set(&mut session, begin);
    assert!(position(&mut session, "/hinge").abs() < 1e-9, "{}", position(&mut session, "/hinge"));
    (0..20).for_each(|_| session.step().unwrap());
    assert!(position(&mut session, "/hinge").abs() < 1e-3);
    let beyond = [Value::reals([0.2, 5.0, 0.0]), Value::Int(-1)];
    let refused = call(&mut session, "sim.setObjectPosition", "/slide", &beyond).unwrap_err();
    assert!(refused.contains("its joint would be at 0.2") && refused.contains("beyond its limits"), "{refused}");
    let within = [Value::reals([0.09, 5.0, 0.0]), Value::Int(-1)];
    call(&mut session, "sim.setObjectPosition", "/slide", &within).unwrap();
    assert!((position(&mut session, "/rail") - 0.09).abs() < 1e-9);
}

#[test]
fn the_motor_of_a_kinematic_joint_is_set_for_when_it_is_dynamic() {
    let mut session = session_of_motors();
    let int = |id: i64, value: i64| [Value::Int(id), Value::Int(value)];
    let mode = |session: &mut Session, mode: i64, options: i64| {
        call(session, "sim.setJointMode", "/hinge", &[Value::Int(mode), Value::Int(options)]).unwrap()
    };
    let limit = |session: &mut Session| call(session, "sim.getJointTargetForce", "/hinge", &[]).unwrap();
    mode(&mut session, 0, 0);
    assert_eq!(limit(&mut session), [Value::Real(50.0)]);
    session.start().unwrap();
    call(&mut session, "sim.setJointPosition", "/hinge", &[Value::Real(0.5)]).unwrap();
    let stays = |session: &mut OpenSession| {
        (0..5).for_each(|_| session.step().unwrap());
        assert_eq!(position(session, "/hinge"), 0.5);
    };
    for (id, value) in [(2000, 0), (2000, 1), (2001, 1)] {
        call(&mut session, "sim.setObjectInt32Param", "/hinge", &int(id, value)).unwrap();
        assert_eq!(
            call(&mut session, "sim.getObjectInt32Param", "/hinge", &[Value::Int(id)]),
            Ok(vec![Value::Int(value)])
        );
        stays(&mut session);
    }
    let limits = Value::reals([10.0, 100.0]);
    call(&mut session, "sim.setJointTargetVelocity", "/hinge", &[Value::Real(2.0), limits]).unwrap();
    stays(&mut session);
    // less than the 4.9 N·m of its weight
    call(&mut session, "sim.setJointTargetForce", "/hinge", &[Value::Real(3.0)]).unwrap();
    stays(&mut session);
    assert_eq!(call(&mut session, "sim.getJointMode", "/hinge", &[]), Ok(vec![Value::Int(0), Value::Int(0)]));
    let hinge = session.sim().registry.find("/hinge", Search::default()).unwrap();
    let copied = session.call("sim.copyPasteObjects", &[Value::List(vec![hinge.into()]), Value::Int(1)]).unwrap();
    assert_eq!(copied.len(), 1);
    stays(&mut session);
    assert_eq!(call(&mut session, "sim.getJointMode", "/hinge0", &[]), Ok(vec![Value::Int(0), Value::Int(0)]));
    assert_eq!(position(&mut session, "/hinge0"), 0.5);
    // hybrid, its own motor holds it as far as it can
    mode(&mut session, 0, 1);
    assert_eq!(limit(&mut session), [Value::Real(3.0)]);
    (0..5).for_each(|_| session.step().unwrap());
    assert!(position(&mut session, "/hinge") > 0.5 + 1e-3, "it sinks: {}", position(&mut session, "/hinge"));
    mode(&mut session, 5, 0);
    assert_eq!(limit(&mut session), [Value::Real(3.0)]);
    assert_eq!(position(&mut session, "/hinge0"), 0.5);
}

#[test]
fn a_frame_takes_along_the_points_of_springs_that_it_carries() {
    let scene = r#"
gravity = [0.0, 0.0, 0.0]
[[frame]]
name = "target"
position = [0.0, 0.0, 1.0]
[[joint]]
name = "lift"
kind = "prismatic"
axis = [0.0, 0.0, 1.0]
[[body]]
name = "load"
parent = "/lift"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
[[spring_damper]]
name = "spring"
between = ["/target", "/lift/load"]
points = [[0.0, 0.0, 0.5], [0.0, 0.0, 0.0]]
stiffness = 100.0
"#;
    let experiment =
        "title = \"Frame\"\nscene = \"scene.toml\"\nduration = 1.0\nstep = 0.01\nrecord = [\"/lift.position\"]\n";
    let mut session = OpenSession::open(SceneFolder::of(scene, experiment), &[], Extensions::default(), None);
    session.start().unwrap();
    let there = [Value::Int(-1), Value::reals([0.0, 0.0, 1.1])];
    call(&mut session, "sim.setObjectPosition", "/target", &there).unwrap();
    (0..10).for_each(|_| session.step().unwrap());
    // x = 0.1 (1 − cos ω t), ω = 10 rad/s
    assert!((position(&mut session, "/lift") - 0.046).abs() < 0.005, "{}", position(&mut session, "/lift"));
}

#[test]
fn a_frame_that_a_bushing_ends_at_takes_a_body_along() {
    let scene = "gravity = [0.0, 0.0, 0.0]\n[[frame]]\nname = \"target\"\nposition = [0.0, 0.0, 1.0]\n[[joint]]\n\
        name = \"free\"\nkind = \"free\"\ninitial = { position = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0] }\n[[body]]\n\
        name = \"hand\"\nparent = \"/free\"\nmass = 2.0\ninertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\n[[bushing]]\n\
        name = \"grasp\"\nbetween = [\"/target\", \"/free/hand\"]\nstiffness = 2e4\ndamping = 400.0\n\
        rotational_stiffness = 1e3\nrotational_damping = 20.0\n";
    let experiment = "title = \"Grasp\"\nduration = 10.0\nstep = 0.005\nrecord = [\"/free/hand.position.x\"]\n\
        error_bar = \"none\"\n";
    let mut session = OpenSession::open(SceneFolder::of(scene, experiment), &[], Extensions::default(), None);
    let [target, hand] =
        ["/target", "/hand"].map(|path| i64::from(session.registry().find(path, Search::default()).unwrap().0));
    let world = Value::Int(-1);
    session.start().unwrap();
    let place = [target.into(), Value::reals([0.3, 0.0, 1.0]), world.clone()];
    session.call("sim.setObjectPosition", &place).unwrap();
    // a hundred periods of 1/ω, ω = 100 rad/s, critically damped
    (0..200).for_each(|_| session.step().unwrap());
    let found = session.call("sim.getObjectPosition", &[hand.into(), world]).unwrap()[0].as_reals().unwrap();
    assert!(found.iter().zip([0.3, 0.0, 1.0]).all(|(x, y)| (x - y).abs() < 1e-9), "{found:?}");
}
