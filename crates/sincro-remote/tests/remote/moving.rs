//! Motions on command (`sim.moveToConfig` …) from clients of every kind: in steps of the simulation, with callbacks,
//! alone and together, and cut short.

use std::time::Duration;

use sincro_coppelia::api::{Handle, Value, functions};
use sincro_motion::{Axis, Goal, Limits, Point, Synchronization, plan};
use sincro_remote::Server;
use sincro_sim::trace::Trace;

use super::scene::{finished, serve, session};
use sincro_testing::clients::zmq::{Client, field, map};

/// Duration of the motion of `parameters` `[s]`.
fn duration() -> f64 {
    let (limits, goal) = (Limits::symmetric(1.0, 2.0, 10.0), Goal::Position(0.5, 0.0));
    plan(&[Axis { start: Point::default(), limits, goal }], Synchronization::None).unwrap()[0].duration()
}

fn real(x: f64) -> Value {
    Value::Real(x)
}

/// Both joints of the arm go somewhere.
fn parameters(joints: &[Value], more: &[(&str, Value)]) -> Value {
    let mut fields = vec![
        ("joints", Value::List(joints.to_vec())),
        ("targetPos", Value::reals([0.5, -0.25])),
        ("maxVel", real(1.0)),
        ("maxAccel", real(2.0)),
        ("maxJerk", real(10.0)),
    ];
    fields.extend(more.iter().cloned());
    map(&fields)
}

fn joints(client: &mut Client) -> [Value; 2] {
    ["/joint1", "/joint2"].map(|path| client.object(path))
}

fn start(client: &mut Client) {
    client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
}

fn stop(client: &mut Client, server: &Server) -> Trace {
    client.call("sim.stopSimulation", &[]).unwrap();
    finished(server).simulated.trace
}

/// Waits until `n` clients step the simulation: until the server has read the call that makes the last of them do so.
fn wait_for_stepping(server: &Server, n: usize) {
    while server.hub().enter().n_stepping() < n {
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Runs the callbacks that the client is asked for, until there is a result.
fn with_callbacks(client: &mut Client, first: Value, mut act: impl FnMut(&mut Client, &[Value]) -> Value) -> Value {
    let mut answer = first;
    while let Some(name) = field(&answer, "func") {
        assert_eq!(name.as_text(), Some("mine_1"));
        let Some(Value::List(arguments)) = field(&answer, "args") else { panic!("{answer:?}") };
        let result = act(client, &arguments.clone());
        answer = client.exchange("_*executed*_", &[result]);
    }
    answer
}

/// The steps of the function itself, in process.
fn in_rust() -> Trace {
    let mut session = session();
    session.start().unwrap();
    let handles = ["/joint1", "/joint2"].map(|path| session.registry().find(path, Default::default()).unwrap());
    let given = parameters(&handles.map(Value::from), &[]);
    let mut data = session.call("sim.moveToConfig_init", &[given]).unwrap().remove(0);
    loop {
        let [Value::Int(result), now] = &session.call("sim.moveToConfig_step", &[data]).unwrap()[..] else { panic!() };
        let (result, now) = (*result, now.clone());
        data = now;
        session.step().unwrap();
        if result != 0 {
            break;
        }
    }
    session.trace().unwrap()
}

#[test]
fn a_motion_is_the_same_through_every_door() {
    let expected = in_rust();
    let server = serve();
    let mut client = Client::connect(server.ports().zmq.unwrap(), Some("moving"));
    let both = joints(&mut client);
    start(&mut client);
    let data = client.call("sim.moveToConfig", &[parameters(&both, &[])]).unwrap().remove(0);
    assert_eq!(field(&data, "pos").unwrap(), &Value::reals([0.5, -0.25]));
    let t = client.real("sim.getSimulationTime", &[]);
    assert!((t - (duration() / 0.05).ceil() * 0.05).abs() < 1e-12, "{t}");
    assert_eq!(stop(&mut client, &server), expected, "ZeroMQ");

    // step by step by itself
    start(&mut client);
    let mut data = client.call("sim.moveToConfig_init", &[parameters(&both, &[])]).unwrap().remove(0);
    loop {
        let mut answer = client.call("sim.moveToConfig_step", &[data]).unwrap();
        data = answer.pop().unwrap();
        client.call("sim.step", &[]).unwrap();
        if answer[0] != Value::Int(0) {
            break;
        }
    }
    client.call("sim.moveToConfig_cleanup", &[data]).unwrap();
    assert_eq!(stop(&mut client, &server), expected, "its steps");

    // with a callback that puts the joints where they are to be
    start(&mut client);
    let given = parameters(&both, &[("callback", Value::from("mine_1@func")), ("auxData", Value::from("here"))]);
    let first = client.exchange("sim.moveToConfig", &[given]);
    let own = both.clone();
    let answer = with_callbacks(&mut client, first, |client, arguments| {
        assert_eq!(field(&arguments[0], "auxData"), Some(&Value::from("here")));
        let Some(Value::List(pos)) = field(&arguments[0], "pos") else { panic!() };
        for (joint, x) in own.iter().zip(pos.clone()) {
            client.call("sim.setJointPosition", &[joint.clone(), x]).unwrap();
        }
        Value::Nil
    });
    assert!(field(&answer, "ret").is_some(), "{answer:?}");
    assert_eq!(stop(&mut client, &server), expected, "a callback");

    // version 1 of the client
    let mut old = Client::connect(server.ports().zmq.unwrap(), None);
    old.call("setStepping", &[Value::Bool(true), Value::from("old")]).unwrap();
    old.call("sim.startSimulation", &[]).unwrap();
    old.call("sim.moveToConfig", &[parameters(&both, &[])]).unwrap();
    assert_eq!(stop(&mut old, &server), expected, "version 1");
}

#[test]
fn a_client_that_does_not_step_does_while_its_motion_lasts() {
    let expected = in_rust();
    let server = serve();
    let mut client = Client::connect(server.ports().zmq.unwrap(), Some("free"));
    let mut other = Client::connect(server.ports().zmq.unwrap(), Some("other"));
    let both = joints(&mut client);
    // asked for before the start: it waits for it, so that it begins at time 0
    client.send("sim.moveToConfig", &[parameters(&both, &[])]);
    wait_for_stepping(&server, 1);
    start(&mut other);
    let n = (duration() / 0.05).ceil() as i64;
    other.call("sim.step", &[Value::Int(n)]).unwrap();
    let answer = client.receive();
    assert!(field(&answer, "ret").is_some(), "{answer:?}");
    assert_eq!(stop(&mut other, &server), expected);
    // and no longer
    other.call("sim.startSimulation", &[]).unwrap();
    while other.real("sim.getSimulationTime", &[]) < 0.2 {}
    stop(&mut other, &server);
}

#[test]
fn a_callback_can_stop_a_motion_and_call_while_it_runs() {
    let server = serve();
    let mut client = Client::connect(server.ports().zmq.unwrap(), Some("callback"));
    let both = joints(&mut client);
    start(&mut client);
    let given = parameters(&both, &[("callback", Value::from("mine_1@func"))]);
    let (mut n, mut times) = (0, Vec::new());
    let first = client.exchange("sim.moveToConfig", &[given]);
    let answer = with_callbacks(&mut client, first, |client, _| {
        n += 1;
        times.push(client.real("sim.getSimulationTime", &[]));
        Value::Bool(n == 3)
    });
    assert!(field(&answer, "ret").is_some() && n == 3, "{answer:?}");
    assert_eq!(times, [0.0, 0.05, 0.1]);
    // as before 4.7: position, velocity, acceleration and data one by one
    let list = |x: f64| Value::reals([x]);
    let old = [
        Value::Int(-1),
        list(0.0),
        Value::Nil,
        Value::Nil,
        list(1.0),
        list(2.0),
        list(10.0),
        list(0.01),
        Value::Nil,
        Value::from("mine_1@func"),
        Value::Int(42),
    ];
    let first = client.exchange("sim.moveToConfig", &old);
    let answer = with_callbacks(&mut client, first, |_, arguments| {
        assert_eq!((arguments.len(), &arguments[3]), (4, &Value::Int(42)));
        Value::Bool(false)
    });
    let Some(Value::List(results)) = field(&answer, "ret") else { panic!("{answer:?}") };
    assert_eq!(results[..3], [list(0.01), list(0.0), list(0.0)]);
    // a single step with a callback
    let given = parameters(&both, &[("callback", Value::from("mine_1@func"))]);
    let data = client.call("sim.moveToConfig_init", &[given]).unwrap().remove(0);
    let first = client.exchange("sim.moveToConfig_step", &[data]);
    let answer = with_callbacks(&mut client, first, |_, _| Value::Bool(true));
    let Some(Value::List(results)) = field(&answer, "ret") else { panic!("{answer:?}") };
    assert_eq!(results[0], Value::Int(2), "stopped");
    stop(&mut client, &server);
}

#[test]
fn a_client_that_is_gone_or_a_stop_ends_its_motion() {
    let server = serve();
    let mut client = Client::connect(server.ports().zmq.unwrap(), Some("goes"));
    let mut other = Client::connect(server.ports().zmq.unwrap(), Some("stays"));
    let both = joints(&mut client);
    client.call("sim.startSimulation", &[]).unwrap();
    let given = parameters(&both, &[("callback", Value::from("mine_1@func"))]);
    client.exchange("sim.moveToConfig", &[given]);
    let t = other.real("sim.getSimulationTime", &[]);
    assert_eq!(other.real("sim.getSimulationTime", &[]), t, "it holds the simulation");
    drop(client);
    while other.real("sim.getSimulationTime", &[]) < t + 0.2 {}
    stop(&mut other, &server);
    // nothing is left of it
    start(&mut other);
    for _ in 0..1_000 {
        let limits = Value::reals([1.0, 1.0, 1.0]);
        let target = Value::reals([1.0, 0.0]);
        let given =
            [Value::Int(1), real(1e-4), Value::Int(-1), Value::reals([0.0; 3]), limits, Value::reals([1.0]), target];
        other.call("sim.ruckigPos", &given).unwrap();
    }
    let refused = other.call("sim.moveToConfig", &[parameters(&both, &[])]).unwrap_err();
    assert!(refused.contains("there are 1000 motions already"), "{refused}");
    stop(&mut other, &server);
    // a run that is ended by somebody else
    let mut third = Client::connect(server.ports().zmq.unwrap(), Some("third"));
    start(&mut third);
    other.send("sim.moveToConfig", &[parameters(&both, &[])]);
    wait_for_stepping(&server, 2);
    // made when both have asked for it: the motion has begun
    third.call("sim.step", &[]).unwrap();
    stop(&mut third, &server);
    let answer = other.receive();
    let error = field(&answer, "err").and_then(Value::as_text).unwrap();
    assert!(error.contains("the simulation was stopped before the motion had ended"), "{error}");
}

#[test]
fn what_cannot_be_done_is_refused() {
    let server = serve();
    let mut client = Client::connect(server.ports().zmq.unwrap(), Some("refused"));
    let both = joints(&mut client);
    start(&mut client);
    let ball = client.object("/loose/ball");
    let mut refused = |name: &str, given: Value| client.call(name, &[given]).unwrap_err();
    assert!(refused("sim.moveToConfig", Value::Int(3)).contains("argument 2 is no list of numbers"));
    assert!(refused("sim.moveToConfig", Value::from("x")).contains("argument 1 is text, expected a map"));
    assert!(refused("sim.moveToConfig", parameters(&[ball], &[])).contains("`/loose/ball` is no joint"));
    let wrong = parameters(&both, &[("targetVel", Value::reals([9.0, 0.0]))]);
    assert!(refused("sim.moveToConfig", wrong).contains("its target velocity 9 is not within its limits, -1 to 1"));
    assert!(refused("sim.moveToPose", map(&[])).contains("one of `object`, `pose` and `ik` is needed"));
    let wrong = map(&[("ruckigObj", Value::Int(7))]);
    assert!(refused("sim.moveToConfig_step", wrong).contains("there is no motion with the handle 7"));
    // after all of that the client holds the simulation no more often than before
    client.call("sim.setStepping", &[Value::Bool(false)]).unwrap();
    while client.real("sim.getSimulationTime", &[]) < 0.2 {}
    let listed = client.call("zmqRemoteApi.info", &[Value::from("sim")]).unwrap().remove(0);
    for (name, _, _) in functions::MOVES {
        assert!(field(&listed, name).is_some(), "{name}");
    }
    for name in ["ruckigPos", "rmlPos", "moveToConfig_init", "moveToPose_cleanup", "ruckig_phasesync"] {
        assert!(field(&listed, name).is_some(), "{name}");
    }
}

#[test]
fn a_browser_moves_things_without_callbacks() {
    let server = serve();
    let mut client = sincro_testing::clients::ws::Client::connect(server.ports().ws.unwrap());
    let mut call = |text: String| {
        client.send_text(&text);
        client.text()
    };
    let joints = [Handle(1), Handle(3)].map(|h| h.0);
    let given = |more: &str| {
        format!(
            r#"{{"func":"sim.moveToConfig","args":[{{"joints":{joints:?},"targetPos":[0.5,-0.25],"maxVel":1.0,"maxAccel":2.0,"maxJerk":10.0{more}}}]}}"#
        )
    };
    call(r#"{"func":"setStepping","args":[true]}"#.into());
    call(r#"{"func":"sim.startSimulation"}"#.into());
    let refused = call(given(r#","callback":"mine""#));
    assert!(refused.contains("there are no callbacks over WebSocket"), "{refused}");
    let moved = call(given(""));
    assert!(moved.contains(r#""pos":[0.5,-0.25]"#) && moved.contains(r#""success":true"#), "{moved}");
    call(r#"{"func":"sim.stopSimulation"}"#.into());
    assert_eq!(finished(&server).simulated.trace, in_rust());
}

#[test]
fn three_clients_move_at_once() {
    let server = serve();
    let runs: Vec<Vec<f64>> = (0..2)
        .map(|_| {
            let mut first = Client::connect(server.ports().zmq.unwrap(), Some("first"));
            let [a, b] = joints(&mut first);
            let ball = first.object("/loose/ball");
            let mut clients: Vec<Client> =
                ["a", "b", "c"].map(|uuid| Client::connect(server.ports().zmq.unwrap(), Some(uuid))).into();
            for client in &mut clients {
                client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
            }
            first.call("sim.startSimulation", &[]).unwrap();
            let one = |joint: &Value, target: f64| {
                map(&[
                    ("joints", Value::List(vec![joint.clone()])),
                    ("targetPos", Value::reals([target])),
                    ("maxVel", real(1.0)),
                    ("maxAccel", real(2.0)),
                    ("maxJerk", real(10.0)),
                ])
            };
            let goal = Value::reals([0.3, 0.2, 0.1, 0.0, 0.0, 0.0, 1.0]);
            let pose = map(&[
                ("object", ball),
                ("targetPose", goal),
                ("maxVel", real(0.5)),
                ("maxAccel", real(1.0)),
                ("maxJerk", real(5.0)),
            ]);
            let threads: Vec<_> = clients
                .into_iter()
                .zip([
                    ("sim.moveToConfig", one(&a, 0.5)),
                    ("sim.moveToConfig", one(&b, -0.8)),
                    ("sim.moveToPose", pose),
                ])
                .map(|(mut client, (name, given))| {
                    std::thread::spawn(move || {
                        client.call(name, &[given]).unwrap();
                        client.call("sim.setStepping", &[Value::Bool(false)]).unwrap();
                        client
                    })
                })
                .collect();
            let clients: Vec<Client> = threads.into_iter().map(|thread| thread.join().unwrap()).collect();
            // all hold it no more; where it is now depends on the clock
            let t = first.real("sim.getSimulationTime", &[]);
            assert!(t > 0.9, "{t}");
            first.call("sim.stopSimulation", &[]).unwrap();
            drop(clients);
            let run = finished(&server);
            let table = &run.simulated.table;
            let end = table.times().iter().position(|t| (t - 0.9).abs() < 1e-9).unwrap();
            let columns = ["/joint1.position", "/joint1/link1/joint2.position"].map(|name| table.column(name).unwrap());
            assert_eq!(columns.map(|column| column.values[table.times().len() - 1]), [0.5, -0.8]);
            columns.iter().flat_map(|column| column.values[..end].to_vec()).collect()
        })
        .collect();
    assert_eq!(runs[0], runs[1], "as long as one of them moves, nothing depends on the clock");
}
