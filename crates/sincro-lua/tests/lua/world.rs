//! Scenes of the tests: a pendulum with a motor, and what scripts say and do in it.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use sincro_scene::diagnostic::Diagnostics;
use sincro_sim::results::Status;
use sincro_sim::run::{RunMonitor, RunOptions, Simulated, simulate};
use sincro_sim::{Extensions, Loaded, load};

/// A pendulum on a motor that takes torques, with a tip.
pub const PENDULUM: &str = r#"
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

[[frame]]
name = "tip"
parent = "/hinge/arm"
position = [0.0, 0.0, -1.0]
"#;

/// The end of every test's experiment.
pub const EXPERIMENT: &str = r#"
title = "test"
duration = 0.05
step = 0.01
error_bar = "none"
record = ["/hinge.position", "/hinge.motor_torque_now"]
"#;

/// A folder of its own with these files.
pub fn folder(files: &[(&str, &str)]) -> PathBuf {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let name = format!("{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
    folder
}

/// Loads a folder made of these files.
pub fn open(files: &[(&str, &str)]) -> Result<Loaded, Diagnostics> {
    let folder = folder(files);
    let loaded = load(&folder, &[], Extensions { scripts: Some(sincro_lua::engine()), ..Extensions::default() });
    std::fs::remove_dir_all(&folder).unwrap();
    loaded
}

/// The pendulum with a script on its arm; `keys` are more keys of the script.
pub fn with_script(code: &str, keys: &str) -> Result<Loaded, Diagnostics> {
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n{keys}\n");
    open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)])
}

/// Runs to the end.
pub fn run(loaded: &Loaded) -> Simulated {
    let interrupt = AtomicBool::new(false);
    let mut watch = RunMonitor { interrupt: &interrupt, progress: &mut |_| {} };
    simulate(loaded, RunOptions::default(), &mut watch).unwrap()
}

/// Messages of the pendulum's script; the run must complete.
pub fn said(code: &str) -> Vec<String> {
    let loaded = with_script(code, "").unwrap_or_else(|problems| panic!("{problems}"));
    let run = run(&loaded);
    assert_eq!(run.status, Status::Completed, "{:?}", run.messages);
    run.messages.into_iter().map(|m| m.text).collect()
}

/// Reason why the run of a script stopped, and the help.
pub fn stop(code: &str) -> (String, String) {
    let loaded = with_script(code, "").unwrap_or_else(|problems| panic!("{problems}"));
    match run(&loaded).status {
        Status::Stopped { reason, help, .. } => (reason, help),
        other => panic!("{other:?}"),
    }
}
