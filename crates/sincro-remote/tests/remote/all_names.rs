//! Every name and number that a client may call, with arguments right and wrong: an answer with a result or a reason, and the server goes on.

use sincro_sim::session::Value;

use super::legacy_client::{Client as Legacy, Command, ONCE, floats, ints, text};
use super::scene::serve;
use super::zmq_client::{Client as Zmq, field};

/// What starts and stops runs is tried elsewhere: here one is to go on.
const ELSEWHERE: [&str; 5] = ["startSimulation", "stopSimulation", "closeScene", "loadScene", "pauseSimulation"];

/// Functions that need what is not here: a script, a force sensor, bodies that touch, a simulation that stands still.
const NEEDS_MORE: [&str; 8] = [
    "setFloatParam",
    "getContactInfo",
    "checkCollision",
    "readForceSensor",
    "callScriptFunction",
    "executeScriptString",
    "setFloatingParameter",
    "setFloatParameter",
];

/// Arguments that fit where none of the others do.
fn fitting(name: &str, joint: &Value, body: &Value, point: &Value) -> Option<Vec<Value>> {
    let three = || Value::reals([0.1, 0.2, 0.3]);
    let turn = || Value::reals([0.0, 0.0, 0.0, 1.0]);
    let pose = || Value::reals([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]);
    let matrix = || Value::reals([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let (int, text) = (Value::Int, || Value::from("tag"));
    Some(match name {
        "getObject" | "getObjectHandle" => vec![Value::from("/ball")],
        "getObjectChild" => vec![joint.clone(), int(0)],
        "readCustomDataBlock" => vec![joint.clone(), text()],
        "writeCustomDataBlock" => vec![joint.clone(), text(), Value::Bytes(vec![1])],
        "getScriptSimulationParameter" => vec![joint.clone(), text()],
        "setScriptSimulationParameter" => vec![joint.clone(), text(), text()],
        "setObjectParent" => vec![point.clone(), int(-1), Value::Bool(true)],
        "copyPasteObjects" | "removeObjects" => vec![Value::List(vec![point.clone()])],
        "removeObject" => vec![point.clone()],
        "setObjectQuaternion" => vec![body.clone(), int(-1), turn()],
        "setObjectPose" => vec![body.clone(), pose(), int(-1)],
        "setObjectMatrix" => vec![body.clone(), int(-1), matrix()],
        "buildMatrix" | "buildPose" => vec![three(), three()],
        "buildMatrixQ" => vec![three(), turn()],
        "rotateAroundAxis" => vec![matrix(), three(), three(), Value::Real(0.1)],
        "setJointMode" => vec![joint.clone(), int(5), int(0)],
        "addForceAndTorque" | "addForce" => vec![body.clone(), three(), three()],
        "getShapeMassAndInertia" => vec![body.clone(), matrix()],
        "getPathInterpolatedConfig" => vec![Value::reals([0.0, 1.0]), Value::reals([0.0, 1.0]), Value::Real(0.5)],
        "wait" => vec![Value::Real(0.05)],
        "testCB" => vec![int(1), Value::from("cb@func"), int(2), int(0)],
        _ if name.starts_with("getObjectInt") => vec![joint.clone(), int(2000)],
        _ if name.starts_with("setObjectInt") => vec![joint.clone(), int(2000), int(1)],
        _ if name.starts_with("getObjectFloat") => vec![joint.clone(), int(2012)],
        _ if name.starts_with("setObjectFloat") => vec![joint.clone(), int(2017), Value::Real(1.0)],
        _ => return None,
    })
}

/// Arguments of many kinds; the first ones fit most functions.
fn arguments(joint: &Value, body: &Value) -> Vec<Vec<Value>> {
    let three = || Value::reals([0.1, 0.2, 0.3]);
    let matrix = || Value::reals([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    vec![
        vec![joint.clone()],
        vec![body.clone(), Value::Int(-1)],
        vec![joint.clone(), Value::Real(0.1)],
        vec![body.clone(), three(), three()],
        vec![body.clone(), three(), Value::Int(-1)],
        vec![matrix(), matrix(), Value::Real(0.5)],
        vec![Value::Int(450), Value::from("text")],
        vec![Value::from("name"), Value::Real(1.0)],
        vec![Value::from("name"), joint.clone()],
        vec![three(), Value::Int(3)],
        vec![Value::Int(0), Value::Int(0), Value::Int(0)],
        vec![],
        vec![Value::Nil; 3],
        vec![Value::Real(f64::NAN); 3],
        vec![Value::Int(i64::MIN), Value::Int(i64::MAX), Value::Int(-1)],
        vec![Value::Int(0x00ff_ffff), Value::Int(-5)],
        vec![Value::Bool(true), Value::List(vec![Value::List(vec![])]), Value::Map(vec![])],
        vec![Value::Bytes(vec![0xff; 3]), Value::from("\u{1f600}\0")],
        vec![Value::reals([f64::INFINITY; 7]), Value::reals([0.0; 12]), Value::Real(-0.0)],
        vec![Value::from("x".repeat(5000).as_str()); 2],
    ]
}

#[test]
fn every_listed_name_answers_any_arguments() {
    let server = serve("all-names");
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("all"));
    let info = client.call("zmqRemoteApi.info", &[Value::from("sim")]).unwrap().remove(0);
    let Value::Map(members) = &info else { panic!("{info:?}") };
    let names: Vec<&str> =
        members.iter().filter(|(_, m)| field(m, "func").is_some()).map(|(name, _)| &**name).collect();
    assert!(names.len() > 160, "{} functions", names.len());
    let (joint, body) = (client.object("/joint1"), client.object("/ball"));
    let mut refused: Vec<&str> = Vec::new();
    for run in [false, true] {
        if run {
            client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
            client.call("sim.startSimulation", &[]).unwrap();
        }
        let (mut n_results, mut n_reasons) = (0, 0);
        for name in names.iter().filter(|name| !ELSEWHERE.contains(name)) {
            let mut fits = false;
            let point = client.call("sim.createDummy", &[Value::Real(0.01)]).unwrap().remove(0);
            let fitting = fitting(name, &joint, &body, &point);
            for args in arguments(&joint, &body).into_iter().chain(fitting) {
                let answer = client.exchange(&format!("sim.{name}"), &args);
                if let Some(Value::Text(reason)) = field(&answer, "err") {
                    assert!(!reason.is_empty() && !reason.contains('\n'), "{name}: {reason}");
                    n_reasons += 1;
                } else if field(&answer, "func").is_some() {
                    client.exchange("_*executed*_", &[]);
                    fits = true;
                } else {
                    assert!(field(&answer, "ret").is_some(), "{name}: {answer:?}");
                    fits = true;
                    n_results += 1;
                }
            }
            if !fits && run {
                refused.push(*name);
            }
        }
        assert!(n_results > 300 && n_reasons > 1000, "{n_results} results, {n_reasons} reasons");
    }
    // what needs a script, a force sensor or a body that touches is tried elsewhere
    assert_eq!(refused, NEEDS_MORE);
    assert!(client.call("sim.getSimulationTime", &[]).is_ok());
}

#[test]
fn every_name_of_sim_ik_answers_any_arguments_and_what_is_absent_says_why() {
    let server = serve("all-ik");
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("ik"));
    let info = client.call("zmqRemoteApi.info", &[Value::from("simIK")]).unwrap().remove(0);
    let Value::Map(members) = &info else { panic!("{info:?}") };
    let names: Vec<&str> =
        members.iter().filter(|(_, m)| field(m, "func").is_some()).map(|(name, _)| &**name).collect();
    let (tip, target) = (client.object("/link2"), client.object("/ball"));
    client.call("simIK.createEnvironment", &[]).unwrap();
    client.call("simIK.createGroup", &[Value::Int(0)]).unwrap();
    let element = [Value::Int(0), Value::Int(0), Value::Int(-1), tip.clone(), target.clone(), Value::Int(31)];
    client.call("simIK.addElementFromScene", &element).unwrap();
    let zeros = || vec![Value::Int(0); 5];
    let mut more =
        vec![zeros(), vec![Value::Int(0), Value::Int(0), Value::Int(0), Value::reals([1e-9, 1e300])], element.to_vec()];
    more.push(vec![Value::Int(0), Value::Int(0), Value::Int(1), Value::Real(1e-300), Value::Int(1_000)]);
    for name in names.iter().filter(|name| !name.starts_with("erase")) {
        for args in more.iter().cloned().chain(arguments(&tip, &target)) {
            let answer = client.exchange(&format!("simIK.{name}"), &args);
            let reason = field(&answer, "err").and_then(Value::as_text).unwrap_or("it was done, and no more is said");
            assert!(reason.len() > 15 && !reason.contains('\n'), "{name}: {reason}");
        }
    }
    for name in sincro_sim::session::api::absent() {
        let why = client.call(&format!("sim.{name}"), &[]).unwrap_err();
        assert!(why.starts_with(&format!("sim.{name} is not offered: ")) && why.len() > 40, "{why}");
        assert!(sincro_sim::session::api::function(name).is_none(), "{name} is there and absent");
    }
    let why = client.call("simReadProximitySensor", &[Value::Int(1)]).unwrap_err();
    assert!(why.contains("sim.readProximitySensor is not offered"), "{why}");
    assert!(client.call("sim.getSimulationTime", &[]).is_ok());
}

#[test]
fn every_command_number_answers_any_data() {
    let server = serve("all-numbers");
    let mut client = Legacy::connect(server.ports().legacy[0]);
    let (joint, ball) = (client.handle("joint1"), client.handle("ball"));
    client.start();
    let idents: [Vec<u8>; 6] = [
        vec![],
        ints(&[joint]),
        ints(&[ball, -1]),
        text("signal"),
        [ints(&[1]), text("ball"), text("f")].concat(),
        vec![0xff; 9],
    ];
    let data: [Vec<u8>; 6] = [
        vec![],
        ints(&[-1]),
        [ints(&[-1]), floats(&[0.1; 4])].concat(),
        floats(&[f32::NAN; 12]),
        ints(&[i32::MAX; 8]),
        vec![0xff; 3],
    ];
    let mut n_done = 0;
    for function in (0..0x3500).filter(|f| f % 0x100 < 0x60) {
        // synchronous mode off, trigger, close, start and stop: they are tried elsewhere
        if [0x0002, 0x0003, 0x0005, 0x000a, 0x1007].contains(&function) {
            continue;
        }
        let commands: Vec<Command> =
            idents.iter().flat_map(|ident| data.iter().map(move |d| Command::new(function, ONCE, ident, d))).collect();
        let replies = client.exchange(&commands);
        assert_eq!(replies.len(), commands.len(), "0x{function:04x}");
        let failed = replies.iter().filter(|(_, reply)| reply.failed).count();
        if failed > 0 {
            let errors = client.last_errors();
            assert!(errors.iter().all(|e| e.len() > 20), "0x{function:04x}: {errors:?}");
        }
        n_done += replies.len() - failed;
    }
    assert!(n_done > 100, "{n_done}");
    client.trigger().unwrap();
    assert_eq!(client.ping(), 40_501);
}
