//! Live sessions: the same motion as a run, and objects as V-REP's clients know them.

use sincro_coppelia::api::{Handle, Phase, Reference, Search, Value};
use sincro_coppelia::session::Session;
use sincro_dynamics::actuation::MotorMode;
use sincro_sim::Extensions;
use sincro_sim::load;
use sincro_testing::{OpenSession, repository_scene, run, scenes};

const TIP: &str = r#"
[[frame]]
name = "tip"
parent = "/joint1/link1/joint2/link2"
position = [0.5, 0.0, 0.0]
"#;

/// A session of the arm with a tip, clients stepping 50 ms.
fn arm() -> OpenSession {
    let folder = scenes::two_link_arm("");
    folder.write("scene.toml", &format!("{}{TIP}", scenes::TWO_LINK_ARM));
    folder.session(Extensions::default(), Some(0.05))
}

fn find(session: &mut Session, name: &str) -> Handle {
    session.sim().registry.find(name, Search::default()).unwrap()
}

#[test]
fn a_session_without_clients_is_the_run_of_its_scene() {
    for (scene, sample) in [("two-dof-open-loop", 0.01), ("pid-tuning", 0.01)] {
        let folder = repository_scene(scene);
        let loaded = load(&folder, &[], Extensions::default()).unwrap();
        let run = run(&loaded);
        let mut session = Session::open(&folder, &[], Extensions::default(), Some(sample)).unwrap();
        for _ in 0..2 {
            session.start().unwrap();
            while session.t() < loaded.experiment.duration - 1e-9 {
                session.step().unwrap();
            }
            session.stop().unwrap();
            let finished = session.take_finished().pop().unwrap().simulated;
            assert_eq!(finished.trace, run.trace, "{scene}");
            assert_eq!(finished.table.columns.last().unwrap().values, run.table.columns.last().unwrap().values);
            assert_eq!((session.t(), session.phase()), (0.0, Phase::Stopped));
        }
    }
}

#[test]
fn an_arm_that_is_held_reports_minus_the_effort_of_its_motors() {
    let mut arm = arm();
    let [joint1, joint2] = ["joint1", "joint2#"].map(|name| find(&mut arm, name));
    assert_eq!(arm.sim().joint_force(joint1).unwrap(), None);
    arm.start().unwrap();
    assert_eq!((arm.t(), arm.sim().simulation_state()), (0.0, 16));
    arm.step().unwrap();
    assert_eq!((arm.t(), arm.sim().simulation_state()), (0.05, 17));
    // measured on CoppeliaSim, both engines: −9.810 and −2.452 N·m; gravity alone: m·g·(0.25 + 0.75), m·g·0.25
    let forces = [joint1, joint2].map(|joint| arm.sim().joint_force(joint).unwrap().unwrap());
    assert!((forces[0] + 9.81).abs() < 1e-9 && (forces[1] + 2.4525).abs() < 1e-9, "{forces:?}");
    arm.sim().set_target_velocity(joint1, 1.0).unwrap();
    arm.step().unwrap();
    assert!((arm.sim().joint_position(joint1).unwrap() - 0.05).abs() < 1e-12);
    let link2 = find(&mut arm, "link2");
    let (_, angular) = arm.sim().velocity(link2).unwrap();
    assert!((angular[1] + 1.0).abs() < 1e-12, "plain angular velocity of the world: {angular:?}");
    arm.stop().unwrap();
    assert_eq!(arm.sim().joint_position(joint1).unwrap(), 0.0);
    arm.start().unwrap();
    arm.step().unwrap();
    assert_eq!(arm.sim().joint_position(joint1).unwrap(), 0.0, "the first run's target is forgotten");
}

#[test]
fn objects_are_found_by_old_names_and_by_paths() {
    let mut arm = arm();
    let joint2 = find(&mut arm, "joint2");
    let names =
        ["joint2#", "/joint2", "/joint1/joint2", "/joint1/link1/joint2", "/joint1[0]//joint2", "/jo?nt2", "/*2"];
    for name in names.iter().filter(|n| !n.contains("//")) {
        assert_eq!(find(&mut arm, name), joint2, "{name}");
    }
    for missing in [
        "joint3",
        "/joint2/link1",
        "/joint1[1]",
        "joint2#0",
        "",
        "/[0]",
        "/joint2{7}",
        "./x",
        "/a[99999999999999999999]",
    ] {
        assert!(arm.sim().registry.find(missing, Search::default()).is_err(), "{missing}");
    }
    let message = arm.sim().registry.find("/joimt2", Search::default()).unwrap_err().0;
    assert!(message.contains("did you mean `joint2`"), "{message}");
    let search = Search { index: Some(1), ..Search::default() };
    let second = arm.sim().registry.find("/joint*", search).unwrap();
    assert_eq!(second, joint2);
}

#[test]
fn poses_follow_the_conventions_of_vrep() {
    let mut arm = arm();
    let call =
        |arm: &mut Session, name: &str, args: &[Value]| arm.call(name, args).unwrap().remove(0).as_reals().unwrap();
    let [joint1, joint2, tip] = ["joint1", "joint2", "tip"].map(|name| Value::from(find(&mut arm, name)));
    arm.call("sim.setJointPosition", &[joint1.clone(), Value::Real(std::f64::consts::FRAC_PI_2)]).unwrap();
    let near =
        |got: &[f64], want: &[f64]| got.len() == want.len() && got.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-12);
    // about −y, x goes up
    let p = call(&mut arm, "sim.getObjectPosition", std::slice::from_ref(&tip));
    assert!(near(&p, &[0.0, 0.0, 1.0]), "{p:?}");
    let m = call(&mut arm, "simGetObjectMatrix", &[joint2.clone(), Value::Int(-1)]);
    assert!(near(&[m[2], m[6], m[10]], &[0.0, -1.0, 0.0]), "z of a joint is its axis: {m:?}");
    let against_joint = call(&mut arm, "sim.getObjectPosition", &[tip.clone(), joint1.clone()]);
    let at_zero = {
        arm.call("sim.setJointPosition", &[joint1.clone(), Value::Real(0.0)]).unwrap();
        call(&mut arm, "sim.getObjectPosition", &[tip, joint1])
    };
    assert!(near(&against_joint, &at_zero), "against a joint means against what it moves");
}

#[test]
fn a_push_lasts_one_step_and_does_its_work() {
    let mut arm = arm();
    let ball = find(&mut arm, "ball");
    assert!(arm.sim().add_force_and_torque(ball, [1.0; 3], [0.0; 3]).is_err(), "nothing runs");
    arm.start().unwrap();
    let mass = arm.sim().mass(ball).unwrap().mass;
    arm.sim().add_force_and_torque(ball, [0.0, 0.0, mass * 9.81], [0.0; 3]).unwrap();
    arm.sim().add_force_and_torque(ball, [mass * 2.0, 0.0, 0.0], [0.0; 3]).unwrap();
    arm.step().unwrap();
    let v = arm.sim().velocity(ball).unwrap().0;
    assert!((v[0] - 0.1).abs() < 1e-12 && v[2].abs() < 1e-12, "{v:?}");
    arm.step().unwrap();
    let v = arm.sim().velocity(ball).unwrap().0;
    assert!((v[0] - 0.1).abs() < 1e-12 && (v[2] + 9.81 * 0.05).abs() < 1e-12, "{v:?}");
    arm.stop().unwrap();
    let finished = arm.take_finished().pop().unwrap().simulated;
    assert!(finished.energy.residual < 1e-9, "the work of the push is counted: {}", finished.energy.residual);
}

#[test]
fn a_free_body_can_be_put_anywhere_and_a_link_cannot() {
    let mut arm = arm();
    let [ball, link] = ["ball", "link2"].map(|name| Value::from(find(&mut arm, name)));
    let list = Value::reals([1.0, 2.0, 3.0]);
    arm.call("sim.setObjectPosition", &[ball.clone(), Value::Int(-1), list.clone()]).unwrap();
    assert_eq!(
        arm.call("sim.getObjectPosition", &[ball.clone(), Value::Int(-1)]).unwrap(),
        *std::slice::from_ref(&list)
    );
    arm.start().unwrap();
    arm.step().unwrap();
    arm.stop().unwrap();
    assert_eq!(
        arm.call("sim.getObjectPosition", &[ball]).unwrap(),
        *std::slice::from_ref(&list),
        "edits while stopped stay"
    );
    let message = arm.call("sim.setObjectPosition", &[link, list]).unwrap_err().0;
    assert!(message.contains("cannot be put anywhere"), "{message}");
}

#[test]
fn modes_and_limits_of_motors_can_be_changed() {
    let mut arm = arm();
    let joint2 = find(&mut arm, "joint2");
    arm.start().unwrap();
    arm.sim().set_joint_mode(joint2, MotorMode::Free).unwrap();
    arm.step().unwrap();
    let falling = arm.sim().joint_velocity(joint2).unwrap();
    assert!(falling < -0.1, "about −y a link along x falls with negative velocity: {falling}");
    arm.sim().set_joint_mode(joint2, MotorMode::Position).unwrap();
    arm.sim().set_target_position(joint2, 0.3).unwrap();
    for _ in 0..40 {
        arm.step().unwrap();
    }
    assert!((arm.sim().joint_position(joint2).unwrap() - 0.3).abs() < 1e-6);
    arm.sim().set_target_force(joint2, 0.1, true).unwrap();
    arm.step().unwrap();
    let force = arm.sim().joint_force(joint2).unwrap().unwrap();
    assert!((force + 0.1).abs() < 1e-9, "too weak to hold: {force}");
    let link1 = find(&mut arm, "link1");
    assert!(arm.sim().set_target_velocity(link1, 1.0).is_err());
    assert!(arm.sim().set_target_velocity(joint2, f64::NAN).is_err());
}

#[test]
fn points_are_made_hung_and_removed() {
    let mut arm = arm();
    let tip = find(&mut arm, "tip");
    let dummy = arm.sim().registry.create_dummy("Dummy").unwrap();
    arm.sim().set_parent(dummy, Some(tip), false).unwrap();
    assert_eq!(arm.sim().pose(dummy, Reference::World).unwrap().pos.0, [1.0, 0.0, 0.0]);
    assert_eq!(arm.sim().registry.entry(dummy).unwrap().path, "/joint1/link1/joint2/link2/tip/Dummy");
    assert!(arm.sim().set_parent(tip, Some(dummy), true).is_err());
    assert!(arm.sim().registry.remove(tip).is_err());
    arm.sim().registry.remove(dummy).unwrap();
    assert!(arm.sim().pose(dummy, Reference::World).is_err());
}

#[test]
fn what_means_nothing_is_refused_with_a_reason() {
    let mut arm = arm();
    let refused = [
        ("sim.noSuch", vec![], "No such function: sim.noSuch"),
        (
            "sim.getJointPosition",
            vec![],
            "argument 1 is nothing, expected a handle (in function 'sim.getJointPosition')",
        ),
        ("sim.getJointPosition", vec![Value::Int(77)], "there is no object with the handle 77"),
        ("sim.getJointPosition", vec![Value::Text("x".into())], "argument 1 is text, expected a handle"),
        ("sim.loadScene", vec![Value::Text("nowhere".into())], "does not exist"),
        ("sim.loadScene", vec![Value::Text("..".into())], "lies outside"),
        ("sim.setFloatParam", vec![Value::Int(1), Value::Real(0.003)], "no whole multiple"),
    ];
    for (name, arguments, expected) in refused {
        let message = arm.call(name, &arguments).unwrap_err().0;
        assert!(message.contains(expected), "{name}: {message}");
    }
}

#[test]
fn a_time_step_that_is_set_in_a_run_stays_as_it_is() {
    let mut arm = arm();
    let before = arm.call("sim.getSimulationTimeStep", &[]).unwrap();
    arm.start().unwrap();
    arm.registry().take_log();
    for _ in 0..2 {
        arm.call("sim.setFloatParam", &[Value::Int(1), Value::Real(0.003)]).unwrap();
    }
    let told: Vec<String> = arm.registry().take_log().into_iter().map(|line| line.text).collect();
    assert_eq!(told.iter().filter(|line| line.contains("0.003 s is not taken")).count(), 1, "{told:?}");
    assert_eq!(arm.call("sim.getSimulationTimeStep", &[]).unwrap(), before);
}
