//! Cost of the adapters: a message of a legacy client, a call of a ZeroMQ client, a call of a script's actuation
//! function.
//!
//! Clients are timed over loopback beside a server that only sends as many bytes back: the difference is the handling.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::PathBuf;

use crate::extensions;
use sincro_coppelia::api::Value;
use sincro_coppelia::session::Session;
use sincro_remote::zmq::wire;
use sincro_remote::{Options, Server, cbor};
use sincro_sim::load;
use sincro_sim::run::{LockStep, method_for};

use super::clock::Subject;

/// A joint with a motor.
const SCENE: &str = r#"
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
initial = { position = 0.5 }
motor = { mode = "torque" }
[[body]]
name = "arm"
parent = "/hinge"
mass = 1.0
center_of_mass = [0.0, 0.0, -0.5]
inertia = { xx = 0.1, yy = 0.1, zz = 0.01 }
"#;

const EXPERIMENT: &str = r#"
title = "adapters"
duration = 1.0
step = 0.005
integrator = "semi-implicit-euler"
error_bar = "none"
record = ["/hinge.position"]
"#;

/// A script that does next to nothing at each step.
const SCRIPT: &str = r#"
[[script]]
object = "/hinge"
code = "n = 0; function sysCall_actuation() n = n + 1 end"
"#;

/// A folder for temporary files with the scene in it, while `act` looks at it.
fn with_folder<T>(name: &str, scene: &str, act: impl FnOnce(&PathBuf) -> Result<T, String>) -> Result<T, String> {
    let folder = std::env::temp_dir().join(format!("sincro-bench-{name}-{}", std::process::id()));
    let failed = |e: std::io::Error| format!("`{}` cannot be written: {e}", folder.display());
    let written = std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(folder.join("scene.toml"), scene))
        .and_then(|()| std::fs::write(folder.join("experiment.toml"), EXPERIMENT));
    let result = written.map_err(failed).and_then(|()| act(&folder));
    // nothing is lost if it stays
    let _ = std::fs::remove_dir_all(&folder);
    result
}

/// A step with a script, and one without.
///
/// # Errors
///
/// If the folder for temporary files cannot be written.
pub(super) fn script() -> Result<(Subject, Subject), String> {
    let with = stepper("script", &[SCENE, SCRIPT].concat())?;
    Ok((with, stepper("no-script", SCENE)?))
}

fn stepper(name: &str, scene: &str) -> Result<Subject, String> {
    let loaded =
        with_folder(name, scene, |folder| load(folder, &[], extensions()).map_err(|problems| problems.to_string()))?;
    let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
    lockstep.start().map_err(|halt| format!("{halt:?}"))?;
    Ok(Subject::new(move || lockstep.advance().expect("a pendulum swings on")))
}

/// A round trip with a server, and one of as many bytes with an echo.
pub(super) type Pair = (Subject, Subject);

/// `simxGetJointPosition`, blocking; and `sim.getJointPosition`.
///
/// # Errors
///
/// If there are no ports or no folder for temporary files.
pub(super) fn clients() -> Result<[Pair; 2], String> {
    let session = with_folder("clients", SCENE, |folder| {
        Session::open(folder, &[], extensions(), None).map_err(|problems| problems.to_string())
    })?;
    let options = Options { legacy: vec![0], zmq: Some(0), ws: None, ..Options::default() };
    let server = Server::start(session, &options).map_err(|error| error.to_string())?;
    let ports = server.ports().clone();
    let failed = |e: std::io::Error| format!("a client cannot connect: {e}");
    let legacy = connect(ports.legacy[0]).map_err(failed)?;
    let mut zmq = connect(ports.zmq.ok_or("there is no port for ZeroMQ")?).map_err(failed)?;
    let greeted = zmq.write_all(&[&wire::greeting()[..], &wire::ready("REQ")].concat());
    greeted.and_then(|()| zmq.read_exact(&mut [0; 64 + 27])).map_err(failed)?;
    let server = std::rc::Rc::new(server);
    let mut pairs = Vec::new();
    for (mut stream, request, n) in [(legacy, legacy_request(), 6 + 18 + 34), (zmq, zmq_request(), 19)] {
        let mut bare = connect(echo(request.len(), n).map_err(failed)?).map_err(failed)?;
        // the server lives as long as somebody asks it
        let (alive, again) = (server.clone(), request.clone());
        let ours = Subject::new(move || {
            let _ = &alive;
            round_trip(&mut stream, &request, n);
        });
        pairs.push((ours, Subject::new(move || round_trip(&mut bare, &again, n))));
    }
    pairs.try_into().map_err(|_| "two clients are measured".to_owned())
}

fn connect(address: SocketAddr) -> std::io::Result<TcpStream> {
    let stream = TcpStream::connect(address)?;
    stream.set_nodelay(true)?;
    Ok(stream)
}

fn round_trip(stream: &mut TcpStream, request: &[u8], n: usize) {
    let mut answer = [0; 64];
    stream.write_all(request).expect("the server takes it");
    stream.read_exact(&mut answer[..n]).expect("the server answers");
}

/// A server that answers requests of `n` bytes with `m` bytes, until its client is gone.
fn echo(n: usize, m: usize) -> std::io::Result<SocketAddr> {
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let address = listener.local_addr()?;
    std::thread::spawn(move || {
        let Ok((mut stream, _)) = listener.accept() else { return };
        let _ = stream.set_nodelay(true);
        let (mut request, answer) = (vec![0; n], vec![0; m]);
        while stream.read_exact(&mut request).is_ok() && stream.write_all(&answer).is_ok() {}
    });
    Ok(address)
}

/// One packet with one message with one command: 0x1001 of the joint with handle 1, blocking.
fn legacy_request() -> Vec<u8> {
    let mut command = Vec::new();
    command.extend([30_i32.to_le_bytes(), 30_i32.to_le_bytes()].concat());
    command.extend([4, 0, 0, 0, 0, 0]);
    command.extend(0x1_1001_i32.to_le_bytes());
    command.extend([0; 8]);
    command.extend(1_i32.to_le_bytes());
    let message = [&[0, 0, 11][..], &[0; 15], &command].concat();
    let head = [1_i16, message.len() as i16, 0].map(i16::to_le_bytes).concat();
    [head, message].concat()
}

fn zmq_request() -> Vec<u8> {
    let fields = [
        ("func", Value::from("sim.getJointPosition")),
        ("args", Value::List(vec![Value::Int(1)])),
        ("uuid", Value::from("bench")),
    ];
    let mut body = Vec::new();
    cbor::encode(&Value::Map(fields.map(|(key, value)| (key.to_owned(), value)).to_vec()), &mut body);
    let mut out = vec![1, 0];
    wire::write_frame(0, &body, &mut out);
    out
}
