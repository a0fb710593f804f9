//! The scene that the tests serve: an arm of two links in a vertical plane, and a free ball.

use std::path::PathBuf;
use std::time::Duration;

use sincro_coppelia::session::{Finished, Session};
use sincro_remote::hub::Event;
use sincro_remote::{Options, Server};
use sincro_sim::Extensions;

pub const SCENE: &str = r#"
[[joint]]
name = "joint1"
kind = "revolute"
axis = [0.0, -1.0, 0.0]
motor = { mode = "velocity" }
[[body]]
name = "link1"
parent = "/joint1"
mass = 1.0
center_of_mass = [0.25, 0.0, 0.0]
inertia = { xx = 0.001, yy = 0.02, zz = 0.02 }
[[joint]]
name = "joint2"
parent = "/joint1/link1"
kind = "revolute"
axis = [0.0, -1.0, 0.0]
position = [0.5, 0.0, 0.0]
motor = { mode = "velocity" }
[[body]]
name = "link2"
parent = "/joint1/link1/joint2"
mass = 1.0
center_of_mass = [0.25, 0.0, 0.0]
inertia = { xx = 0.001, yy = 0.02, zz = 0.02 }
[[joint]]
name = "loose"
kind = "free"
[[body]]
name = "ball"
parent = "/loose"
density = 1000.0
shape = [{ sphere = { radius = 0.1 } }]
[[camera]]
name = "eye"
position = [0.0, -2.0, 0.0]
look_at = [0.0, 0.0, 0.0]
resolution = [16, 12]
near = 0.5
far = 4.5
"#;

pub const EXPERIMENT: &str = r#"
title = "Arm"
duration = 2.0
step = 0.005
simulation_step = 0.05
record = ["/joint1.position", "/joint1/link1/joint2.position"]
"#;

/// A folder with the scene, its own for each test; `more` goes to the experiment.
pub fn folder(name: &str, more: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("remote-{name}"));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("scene.toml"), SCENE).unwrap();
    std::fs::write(folder.join("experiment.toml"), format!("{more}{EXPERIMENT}")).unwrap();
    folder
}

/// Loopback, any free ports.
pub fn options() -> Options {
    let client_timeout = Duration::from_secs(600);
    Options { legacy: vec![0], zmq: Some(0), ws: Some(0), client_timeout, ..Options::default() }
}

/// Serves the arm.
pub fn serve(name: &str) -> Server {
    serve_with(name, &options())
}

pub fn serve_with(name: &str, options: &Options) -> Server {
    Server::start(Session::open(&folder(name, ""), &[], Extensions::default(), None).unwrap(), options).unwrap()
}

/// The next run that ends.
pub fn finished(server: &Server) -> Finished {
    loop {
        if let Event::Finished(finished) = server.events().recv_timeout(Duration::from_secs(20)).unwrap() {
            return *finished;
        }
    }
}
