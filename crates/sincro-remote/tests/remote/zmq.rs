//! The ZeroMQ remote API, versions 2 and 1.

use std::io::Write;
use std::net::TcpStream;
use std::thread;
use std::time::{Duration, Instant};

use sincro_coppelia::api::Value;
use sincro_remote::Server;

use super::scene::serve;
use sincro_testing::clients::zmq::{Client, field, frame, map, shake_hands};

fn client(server: &Server, uuid: &str) -> Client {
    Client::connect(server.ports().zmq.unwrap(), Some(uuid))
}

fn version_1(server: &Server) -> Client {
    Client::connect(server.ports().zmq.unwrap(), None)
}

fn time(client: &mut Client) -> f64 {
    client.real("sim.getSimulationTime", &[])
}

#[test]
fn the_transcript_of_the_python_client_is_answered() {
    let server = serve();
    let mut client = client(&server, "a");
    assert_eq!(client.call("zmqRemoteApi.require", &[Value::from("sim")]), Ok(vec![Value::Nil]));
    let info = client.call("zmqRemoteApi.info", &[Value::from("sim")]).unwrap().remove(0);
    let function = map(&[("func", map(&[]))]);
    for name in ["getObject", "setStepping", "step", "setJointMaxForce", "getIntegerSignal", "addForceAndTorque"] {
        assert_eq!(field(&info, name), Some(&function), "{name}");
    }
    assert_eq!(field(&info, "handle_world"), Some(&map(&[("const", Value::Int(-1))])));
    assert_eq!(client.call("sim.setStepping", &[Value::Bool(true)]), Ok(vec![Value::Int(0)]));
    assert_eq!(client.call("sim.startSimulation", &[]), Ok(vec![Value::Int(1)]));
    assert_eq!(time(&mut client), 0.0);
    let joint = client.object("/joint1");
    assert!(matches!(joint, Value::Int(_)), "handles are whole numbers");
    client.call("sim.setJointTargetVelocity", &[joint.clone(), Value::Real(1.5)]).unwrap();
    assert_eq!(client.call("sim.step", &[]), Ok(vec![]));
    assert!((client.real("sim.getJointPosition", &[joint]) - 0.075).abs() < 1e-12);
    assert_eq!(time(&mut client), 0.05);
    let error = client.call("sim.getObject", &[Value::from("/nope")]).unwrap_err();
    assert!(error.starts_with("Object does not exist") && error.ends_with("(in function 'sim.getObject')"), "{error}");
    assert_eq!(client.call("sim.step", &[Value::Int(10)]), Ok(vec![]), "ten steps in one call");
    assert!((time(&mut client) - 0.55).abs() < 1e-12);
    assert_eq!(client.call("sim.stopSimulation", &[]), Ok(vec![Value::Int(1)]));
    assert_eq!(client.call("sim.getSimulationState", &[]), Ok(vec![Value::Int(0)]));
    assert_eq!(client.exchange("_*end*_", &[]), map(&[]));
}

#[test]
fn callbacks_are_run_by_the_client() {
    let server = serve();
    let mut client = client(&server, "a");
    let args = [Value::Int(21), Value::from("cb_7f@func"), Value::Int(21), Value::Int(3)];
    let mut answer = client.exchange("sim.testCB", &args);
    for _ in 0..4 {
        assert_eq!(field(&answer, "func"), Some(&Value::from("cb_7f")));
        assert_eq!(field(&answer, "args"), Some(&Value::List(vec![Value::Int(21), Value::Int(21)])));
        // a call in between does not disturb it
        assert_eq!(client.call("sim.getSimulationState", &[]), Ok(vec![Value::Int(0)]));
        answer = client.exchange("_*executed*_", &[Value::Int(42)]);
    }
    assert_eq!(answer, map(&[("ret", Value::List(vec![Value::Int(42)]))]));
    assert_eq!(client.call("_*executed*_", &[]), Ok(vec![]), "nothing is waited for");
}

#[test]
fn time_advances_when_all_that_step_have_asked() {
    let server = serve();
    let (mut a, mut b) = (client(&server, "a"), client(&server, "b"));
    a.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    assert_eq!(b.call("sim.setStepping", &[Value::Bool(true)]), Ok(vec![Value::Int(0)]));
    a.call("sim.startSimulation", &[]).unwrap();
    a.send("sim.step", &[]);
    thread::sleep(Duration::from_millis(100));
    assert_eq!(time(&mut b), 0.0);
    b.call("sim.step", &[]).unwrap();
    assert_eq!(field(&a.receive(), "ret"), Some(&Value::List(vec![])));
    assert_eq!(time(&mut a), 0.05);
    // one dies in the middle of its turn: the other goes on
    drop(b);
    let start = Instant::now();
    for _ in 0..10 {
        a.call("sim.step", &[]).unwrap();
    }
    assert!(start.elapsed() < Duration::from_secs(60));
    assert!((time(&mut a) - 0.55).abs() < 1e-12);
    // with a run, stepping ends
    a.call("sim.stopSimulation", &[]).unwrap();
    assert_eq!(a.call("sim.setStepping", &[Value::Bool(true)]), Ok(vec![Value::Int(0)]));
}

#[test]
fn sockets_of_one_identity_are_one_client() {
    let server = serve();
    let mut sockets: Vec<Client> = (0..50).map(|_| client(&server, "same")).collect();
    for socket in &mut sockets {
        socket.send("sim.getSimulationTime", &[]);
    }
    for socket in &mut sockets {
        socket.receive();
    }
    assert_eq!((server.hub().connections().len(), server.hub().enter().n_clients()), (50, 1));
    sockets[0].call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    sockets[1].call("sim.startSimulation", &[]).unwrap();
    sockets[2].call("sim.step", &[]).unwrap();
    sockets.remove(0);
    thread::sleep(Duration::from_millis(50));
    assert_eq!(time(&mut sockets[3]), 0.05, "it steps as long as one socket is there");
    drop(sockets);
    let start = Instant::now();
    while !server.hub().connections().is_empty() {
        assert!(start.elapsed() < Duration::from_secs(60), "connections that were closed are gone at once");
        thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(server.hub().enter().n_clients(), 0);
}

#[test]
fn locks_hold_the_simulation_and_waits_are_in_simulation_time() {
    let server = serve();
    let mut a = client(&server, "a");
    a.call("sim.acquireLock", &[]).unwrap();
    a.call("sim.startSimulation", &[]).unwrap();
    thread::sleep(Duration::from_millis(50));
    assert_eq!(time(&mut a), 0.0);
    a.call("sim.releaseLock", &[]).unwrap();
    let before = time(&mut a);
    a.call("sim.wait", &[Value::Real(0.5)]).unwrap();
    assert!(time(&mut a) >= before + 0.5 - 1e-9);
    assert!(a.call("sim.wait", &[Value::Real(f64::NAN)]).is_err());
    a.call("sim.pauseSimulation", &[]).unwrap();
    let paused = time(&mut a);
    a.call("sim.step", &[]).unwrap();
    assert_eq!(time(&mut a), paused, "a step while paused returns");
}

#[test]
fn a_client_that_waits_for_long_is_told_to_go_on_waiting() {
    let server = serve();
    let mut client = client(&server, "a");
    let answer = client.exchange("sim.wait", &[Value::Real(1.2), Value::Bool(false)]);
    assert_eq!(field(&answer, "func"), Some(&Value::from("_*wait*_")));
    let mut answer = client.exchange("_*executed*_", &[]);
    while field(&answer, "func").is_some() {
        answer = client.exchange("_*executed*_", &[]);
    }
    assert_eq!(answer, map(&[("ret", Value::List(vec![Value::Real(0.0)]))]));
    // the first version knows no such answer
    assert_eq!(
        version_1(&server).call("sim.wait", &[Value::Real(1.2), Value::Bool(false)]),
        Ok(vec![Value::Real(0.0)])
    );
}

#[test]
fn what_clients_of_several_versions_leave_to_the_server_is_there() {
    let server = serve();
    let mut client = client(&server, "a");
    let table = map(&[("maxVel", Value::List(vec![Value::Real(0.5); 4]))]);
    assert_eq!(client.call("sim.copyTable", std::slice::from_ref(&table)), Ok(vec![table]));
    assert_eq!(client.call("sim.getScript", &[Value::Int(8)]), Ok(vec![Value::Int(-17)]), "the sandbox");
    // nil would be one result
    for name in ["sim.getStringSignal", "sim.getInt32Signal", "sim.getFloatSignal", "sim.getBufferSignal"] {
        assert_eq!(client.call(name, &[Value::from("never set")]), Ok(vec![]), "{name}");
    }
    client.call("sim.startSimulation", &[]).unwrap();
    client.call("sim.loadScene", &[Value::from("")]).unwrap();
    assert_eq!(client.call("sim.getSimulationState", &[]), Ok(vec![Value::Int(0)]));
}

#[test]
fn clients_of_version_1_wait_for_the_counter() {
    let server = serve();
    let mut client = version_1(&server);
    let mut counter = TcpStream::connect(server.ports().zmq_steps.unwrap()).unwrap();
    shake_hands(&mut counter, "SUB");
    counter.write_all(&[0, 1, 1]).unwrap();
    let answer = client.exchange("zmqRemoteApi.info", &[Value::from("sim")]);
    assert_eq!(field(&answer, "success"), Some(&Value::Bool(true)));
    let uuid = Value::from("u");
    client.call("setStepping", &[Value::Bool(true), uuid.clone()]).unwrap();
    // the counter may be listened to a moment after the hands were shaken
    thread::sleep(Duration::from_millis(500));
    client.call("sim.startSimulation", &[]).unwrap();
    assert_eq!(frame(&mut counter), (0, vec![0; 4]), "the start of a run");
    for k in 1..=3_u32 {
        client.call("step", std::slice::from_ref(&uuid)).unwrap();
        assert_eq!(frame(&mut counter), (0, k.to_le_bytes().to_vec()));
        assert!((time(&mut client) - 0.05 * f64::from(k)).abs() < 1e-12, "what follows is after the step");
    }
    client.call("sim.stopSimulation", &[]).unwrap();
    assert_eq!(frame(&mut counter).1.len(), 4, "the end of it");
    assert!(client.call("sim.nope", &[]).is_err());
}

#[test]
fn what_could_do_harm_or_is_not_there_is_refused_with_a_reason() {
    let server = serve();
    let mut client = client(&server, "a");
    for (name, args, expected) in [
        ("sim.executeScriptString", vec![Value::from("os.exit()")], "--grant scripts"),
        ("sim.launchExecutable", vec![Value::from("sh")], "programs and plug-ins are not started"),
        ("zmqRemoteApi.require", vec![Value::from("simConvex")], "there is no module simConvex"),
        ("zmqRemoteApi.require", vec![Value::from("sim-2")], "there is no module sim-2"),
        ("os.execute", vec![], "No such function: os.execute"),
        ("sim.loadScene", vec![Value::from("/")], "lies outside the folder"),
        ("sim.step", vec![Value::Int(-1)], "expected 1 to"),
        (
            "sim.setJointTargetVelocity",
            vec![Value::Int(1), Value::from("fast")],
            "argument 2 is text, expected a number",
        ),
        ("sim.setJointTargetVelocity", vec![Value::Int(1), Value::Nil], "the target velocity is NaN"),
    ] {
        let error = client.call(name, &args).unwrap_err();
        assert!(error.contains(expected) && !error.contains('\n'), "{name}: {error}");
    }
    client.send_bytes(&[0xff]);
    assert!(field(&client.receive(), "err").is_some());
}
