//! The thesis's client loops against a server on loopback: the runs of clients have the bits of the same laws in
//! process.
//!
//! The laws are written here once more, apart from the diagrams of the scenes, and computed from what each protocol
//! gives.

mod arm;
#[path = "../../../sincro-remote/tests/remote/legacy_client.rs"]
#[allow(dead_code)]
mod legacy_client;
mod movement;
mod quadrotor;
mod scripts;
#[path = "../../../sincro-remote/tests/remote/zmq_client.rs"]
#[allow(dead_code)]
mod zmq_client;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use sincro_coppelia::session::{Session, Value};
use sincro_remote::hub::Event;
use sincro_remote::{Options, Server};
use sincro_sim::Extensions;
use sincro_sim::load;
use sincro_sim::run::{RunMonitor, RunOptions, simulate};
use sincro_sim::trace::Trace;

use legacy_client::{Client as Legacy, Command, ONCE, STREAM, floats, ints};
use zmq_client::Client as Zmq;

/// A number in the precision of the legacy wire.
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

/// The hash of the scene's own run, its law as a diagram.
fn in_process(name: &str) -> Trace {
    let loaded = load(&scene(name), &[], Extensions { scripts: Some(sincro_lua::engine()), ..Extensions::default() })
        .unwrap_or_else(|p| panic!("{:?}", p.0));
    let watch = &mut RunMonitor { interrupt: &AtomicBool::new(false), progress: &mut |_| {} };
    simulate(&loaded, RunOptions::default(), watch).unwrap().trace
}

fn serve(name: &str) -> Server {
    let session = Session::open(
        &scene(name),
        &[],
        Extensions { scripts: Some(sincro_lua::engine()), ..Extensions::default() },
        None,
    )
    .unwrap_or_else(|p| panic!("{:?}", p.0));
    let client_timeout = Duration::from_secs(600);
    Server::start(session, &Options { legacy: vec![0], zmq: Some(0), ws: None, client_timeout, ..Options::default() })
        .unwrap()
}

/// The hash of the next run that ends, and its steps.
fn finished(server: &Server) -> (Trace, u64) {
    loop {
        if let Event::Finished(run) = server.events().recv_timeout(Duration::from_secs(60)).unwrap() {
            return (run.simulated.trace, run.steps);
        }
    }
}

/// A legacy client that streams what it reads, and sets and triggers in one message, as with `simxPauseCommunication`.
struct Stepper {
    client: Legacy,
    joints: Vec<i32>,
}

impl Stepper {
    /// Attached, in synchronous mode, the run started; `streams` are commands with their identification.
    fn start(server: &Server, joints: &[&str], streams: &[(i32, Vec<u8>)]) -> Self {
        let mut client = Legacy::connect(server.ports().legacy[0]);
        let joints = joints.iter().map(|name| client.handle(name)).collect();
        client.start();
        let streams: Vec<Command> = streams.iter().map(|(f, ident)| Command::new(*f, STREAM, ident, &[])).collect();
        client.exchange(&streams);
        Self { client, joints }
    }

    /// The numbers of a stream as they last came.
    fn read(&self, function: i32, ident: &[i32], n: usize) -> Vec<f64> {
        let reply = &self.client.inbox[&(function as u16, ints(ident))];
        assert!(!reply.failed);
        (0..n).map(|k| reply.float(k).into()).collect()
    }

    fn step(&mut self, velocities: &[f64]) {
        let set = self.joints.iter().zip(velocities);
        let mut message: Vec<Command> =
            set.map(|(joint, v)| Command::new(0x1008, ONCE, &ints(&[*joint]), &floats(&[*v as f32]))).collect();
        message.push(Command::new(0x0003, ONCE, &[], &[]));
        let replies = self.client.exchange(&message);
        assert!(replies.iter().all(|(_, reply)| !reply.failed), "{replies:?}");
    }

    fn stop(mut self) {
        self.client.simulation(2);
    }
}

/// A ZeroMQ client, stepping, the run started.
fn zmq(server: &Server) -> Zmq {
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("scenes"));
    client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
    client
}

fn set_and_step(client: &mut Zmq, joints: &[Value], velocities: &[f64]) {
    for (joint, velocity) in joints.iter().zip(velocities) {
        client.call("sim.setJointTargetVelocity", &[joint.clone(), Value::Real(*velocity)]).unwrap();
    }
    client.call("sim.step", &[]).unwrap();
}
