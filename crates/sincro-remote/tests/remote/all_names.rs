//! Every name and number that a client may call, with arguments right and wrong: an answer with a result or a reason,
//! and the server keeps running.

use sincro_coppelia::api::Value;

use super::arguments::{ELSEWHERE, Made, NEEDS_MORE, Things, arguments, arguments_for, fitting};
use super::scene::serve;
use sincro_testing::clients::legacy::{Client as Legacy, Command, ONCE, floats, ints, text};
use sincro_testing::clients::zmq::{Client as Zmq, field};

#[test]
fn every_listed_name_answers_any_arguments() {
    let server = serve();
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("all"));
    let info = client.call("zmqRemoteApi.info", &[Value::from("sim")]).unwrap().remove(0);
    let Value::Map(members) = &info else { panic!("{info:?}") };
    let names: Vec<&str> =
        members.iter().filter(|(_, m)| field(m, "func").is_some()).map(|(name, _)| &**name).collect();
    assert!(names.len() > 180, "{} functions", names.len());
    let [joint, body, eye] = ["/joint1", "/ball", "/eye"].map(|path| client.object(path));
    let made = Made::new(|name, arguments| client.call(name, arguments).unwrap().remove(0));
    let mut things = Things { joint, body, eye, made };
    let mut refused: Vec<&str> = Vec::new();
    for run in [false, true] {
        if run {
            client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
            client.call("sim.startSimulation", &[]).unwrap();
        }
        let (mut n_results, mut n_reasons) = (0, 0);
        for name in names.iter().filter(|name| !ELSEWHERE.contains(name)) {
            let mut fits = false;
            things.made = Made::new(|name, arguments| client.call(name, arguments).unwrap().remove(0));
            let fitting = fitting(name, &things);
            for args in arguments_for(name, &things.joint, &things.body).into_iter().chain(fitting) {
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
            // some names have removed them already
            for object in things.made.objects() {
                client.exchange("sim.removeObject", &[object]);
            }
            client.exchange("sim.ruckigRemove", &[things.made.motion()]);
        }
        assert!(n_results > 300 && n_reasons > 1000, "{n_results} results, {n_reasons} reasons");
    }
    // what needs a script, a force sensor or a body that touches is tried elsewhere
    let mut wanted = NEEDS_MORE.to_vec();
    wanted.sort_unstable();
    refused.sort_unstable();
    assert_eq!(refused, wanted);
    assert!(client.call("sim.getSimulationTime", &[]).is_ok());
}

#[test]
fn every_name_of_sim_ik_answers_any_arguments_and_what_is_absent_says_why() {
    let server = serve();
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
    for name in sincro_coppelia::api::functions::absent() {
        let why = client.call(&format!("sim.{name}"), &[]).unwrap_err();
        assert!(why.starts_with(&format!("sim.{name} is not offered: ")) && why.len() > 40, "{why}");
        assert!(sincro_coppelia::api::functions::function(name).is_none(), "{name} is there and absent");
    }
    let why = client.call("simHandlePath", &[Value::Int(1)]).unwrap_err();
    assert!(why.contains("sim.handlePath is not offered"), "{why}");
    assert!(client.call("sim.getSimulationTime", &[]).is_ok());
}

#[test]
fn every_name_of_sim_ompl_answers_any_arguments_and_plans() {
    let server = serve();
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("planning"));
    let info = client.call("zmqRemoteApi.info", &[Value::from("simOMPL")]).unwrap().remove(0);
    let number = |table: &str, name: &str| {
        let found = field(&info, table).and_then(|table| field(table, name)).and_then(|x| field(x, "const"));
        found.unwrap_or_else(|| panic!("{table}.{name} in {info:?}")).clone()
    };
    let Value::Map(members) = &info else { panic!("{info:?}") };
    let names: Vec<&str> =
        members.iter().filter(|(_, m)| field(m, "func").is_some()).map(|(name, _)| &**name).collect();
    let (tip, ball) = (client.object("/link2"), client.object("/ball"));
    let task = client.call("simOMPL.createTask", &[Value::from("t")]).unwrap().remove(0);
    let (low, high) = (Value::reals([-9.0, -9.0]), Value::reals([9.0, 9.0]));
    let kind = number("StateSpaceType", "position2d");
    let space = [Value::from("2d"), kind, ball.clone(), low, high, Value::Int(1)];
    let space = client.call("simOMPL.createStateSpace", &space).unwrap().remove(0);
    client.call("simOMPL.setStateSpace", &[task.clone(), Value::List(vec![space])]).unwrap();
    client.call("simOMPL.setAlgorithm", &[task.clone(), number("Algorithm", "RRTstar")]).unwrap();
    let pose = |client: &mut Zmq| client.call("sim.getObjectPose", std::slice::from_ref(&ball)).unwrap();
    let before = pose(&mut client);
    client.call("simOMPL.setGoalState", &[task.clone(), Value::reals([3.0, -2.0])]).unwrap();
    let found =
        client.call("simOMPL.compute", &[task.clone(), Value::Real(1.0), Value::Int(-1), Value::Int(9)]).unwrap();
    assert_eq!(found[0], Value::Bool(true));
    assert_eq!(found[1].as_reals().unwrap().len(), 18);
    assert_eq!(pose(&mut client), before, "a search moves nothing");
    let why = client.call("simOMPL.setStateValidationCallback", &[task.clone(), Value::from("f")]).unwrap_err();
    assert!(why.contains("clients are not called back in a search"), "{why}");
    let state = Value::reals([1e300, f64::NAN]);
    let more = [vec![task.clone(), state.clone(), state], vec![task.clone(), Value::reals([0.1, 0.2])]];
    for name in names.iter().filter(|name| !name.starts_with("destroy")) {
        for args in more.iter().cloned().chain(arguments(&task, &ball)).chain(arguments(&tip, &ball)) {
            let answer = client.exchange(&format!("simOMPL.{name}"), &args);
            let reason = field(&answer, "err").and_then(Value::as_text).unwrap_or("it was done, and no more is said");
            assert!(reason.len() > 15 && !reason.contains('\n'), "{name}: {reason}");
        }
    }
}

#[test]
fn every_name_of_sim_vision_answers_any_arguments() {
    let server = serve();
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("vision"));
    let info = client.call("zmqRemoteApi.info", &[Value::from("simVision")]).unwrap().remove(0);
    let Value::Map(members) = &info else { panic!("{info:?}") };
    let (eye, ball) = (client.object("/eye"), client.object("/ball"));
    let numbers = |x: f64, n: usize| [vec![eye.clone()], vec![Value::Real(x); n]].concat();
    let three = || Value::reals([0.5, 1e300, -1.0]);
    let lists = vec![eye.clone(), three(), three(), Value::Bool(false), Value::Bool(true), Value::Bool(true)];
    let two = vec![eye.clone(), Value::reals([3.0, 2.0]), Value::Bool(true), Value::Bool(true)];
    for with_image in [false, true] {
        for (name, _) in members {
            for args in [numbers(0.5, 12), numbers(f64::NAN, 12), numbers(2.0, 2), lists.clone(), two.clone()]
                .into_iter()
                .chain(arguments(&eye, &ball))
            {
                if with_image {
                    client.call("simVision.sensorImgToWorkImg", std::slice::from_ref(&eye)).unwrap();
                }
                let answer = client.exchange(&format!("simVision.{name}"), &args);
                let reason =
                    field(&answer, "err").and_then(Value::as_text).unwrap_or("it was done, and no more is said");
                assert!(reason.len() > 15 && !reason.contains('\n'), "{name}: {reason}");
            }
        }
    }
    let why = client.call("simVision.rotateWorkImg", std::slice::from_ref(&eye)).unwrap_err();
    assert!(why.starts_with("simVision.rotateWorkImg is not offered: work images are not resampled"), "{why}");
}

#[test]
fn every_command_number_answers_any_data() {
    let server = serve();
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
