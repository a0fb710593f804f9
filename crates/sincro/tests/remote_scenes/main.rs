//! The thesis's client loops against a server on loopback: the runs of clients have the bits of the same laws in
//! process.
//!
//! The laws are written here once more, apart from the diagrams of the scenes, and computed from what each protocol
//! gives.

mod arm;
mod movement;
mod quadrotor;
mod scripts;

use sincro_coppelia::api::Value;
use sincro_coppelia::session::Session;
use sincro_remote::Server;
use sincro_sim::load;
use sincro_sim::trace::Trace;
use sincro_testing::clients::legacy::{Client as Legacy, Command, ONCE, STREAM, floats, ints};
use sincro_testing::clients::zmq::Client as Zmq;
use sincro_testing::{options, repository_scene, run, with_scripts};

/// A number in the precision of the legacy wire.
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// The hash of the scene's own run, its law as a diagram.
fn in_process(name: &str) -> Trace {
    let loaded = load(&repository_scene(name), &[], with_scripts()).unwrap_or_else(|p| panic!("{p}"));
    run(&loaded).trace
}

fn serve(name: &str) -> Server {
    let session = Session::open(&repository_scene(name), &[], with_scripts(), None).unwrap_or_else(|p| panic!("{p}"));
    Server::start(session, &options()).unwrap()
}

/// The hash of the next run that ends, and its steps.
fn finished(server: &Server) -> (Trace, u64) {
    let run = sincro_testing::finished(server);
    (run.simulated.trace, run.steps)
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
