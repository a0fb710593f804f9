//! The same control law over every protocol gives the same bits.
//!
//! The law is that of a joint that goes to 0.5 rad: velocity 1.93·(0.5 − q), rounded to 1/64 rad/s because the legacy
//! wire has single precision. It is computed 20 times a second by a block diagram, in Rust, by a legacy client and by a
//! ZeroMQ client.

use sincro_coppelia::api::{Search, Value};
use sincro_remote::Server;
use sincro_sim::trace::Trace;

use super::scene::{finished, serve, session};
use sincro_testing::clients::legacy::Client as Legacy;
use sincro_testing::clients::zmq::Client as Zmq;
use sincro_testing::{run, scenes};

const DIAGRAM: &str = r#"
sample_time = 0.05
wires = [
  "goal -> error.u1", "/joint1.position -> error.u2", "error -> gain -> rounded -> /joint1",
]
block = [
  { name = "goal", type = "constant", value = 0.5 },
  { name = "error", type = "sum", signs = "+-" },
  { name = "gain", type = "gain", gain = 1.93 },
  { name = "rounded", type = "quantizer", interval = 0.015625 },
]
"#;

const STEPS: usize = 40;

fn law(q: f64) -> f64 {
    (1.93 * (0.5 - q) * 64.0).round() / 64.0
}

fn by_diagram() -> Trace {
    let folder = scenes::two_link_arm("diagram = \"diagram.toml\"\n").with("diagram.toml", DIAGRAM);
    run(&folder.load(&[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))).trace
}

fn in_rust() -> Trace {
    let mut session = session();
    let joint = session.sim().registry.find("joint1", Search::default()).unwrap();
    session.start().unwrap();
    for _ in 0..STEPS {
        let q = session.sim().joint_position(joint).unwrap();
        session.sim().set_target_velocity(joint, law(q)).unwrap();
        session.step().unwrap();
    }
    session.trace().unwrap()
}

fn by_legacy(server: &Server) -> Trace {
    let mut client = Legacy::connect(server.ports().legacy[0]);
    let joint = client.handle("joint1#");
    client.start();
    for _ in 0..STEPS {
        let q = client.joint_position(joint);
        client.set_velocity(joint, law(q.into()) as f32);
        client.trigger().unwrap();
    }
    client.simulation(2);
    finished(server).simulated.trace
}

fn by_zmq(server: &Server) -> Trace {
    let mut client = Zmq::connect(server.ports().zmq.unwrap(), Some("parity"));
    let joint = client.object("/joint1");
    client.call("sim.setStepping", &[Value::Bool(true)]).unwrap();
    client.call("sim.startSimulation", &[]).unwrap();
    for _ in 0..STEPS {
        let q = client.real("sim.getJointPosition", std::slice::from_ref(&joint));
        client.call("sim.setJointTargetVelocity", &[joint.clone(), Value::Real(law(q))]).unwrap();
        client.call("sim.step", &[]).unwrap();
    }
    client.call("sim.stopSimulation", &[]).unwrap();
    finished(server).simulated.trace
}

#[test]
fn the_same_law_through_every_door_gives_the_same_hash() {
    let in_rust = in_rust();
    assert_eq!(by_diagram(), in_rust, "diagram");
    let server = serve();
    for _ in 0..2 {
        assert_eq!(by_legacy(&server), in_rust, "legacy remote API");
        assert_eq!(by_zmq(&server), in_rust, "ZeroMQ remote API");
    }
}
