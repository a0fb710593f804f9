//! Scenes of the tests: a pendulum with a motor, and what scripts say and do in it.

use sincro_scene::diagnostic::Diagnostics;
use sincro_sim::results::Status;
use sincro_sim::{Loaded, load};
pub use sincro_testing::run;
pub use sincro_testing::scenes::{MOTOR_PENDULUM as PENDULUM, MOTOR_PENDULUM_EXPERIMENT as EXPERIMENT};
use sincro_testing::{SceneFolder, with_scripts};

/// A folder of its own with these files.
pub fn folder(files: &[(&str, &str)]) -> SceneFolder {
    files.iter().fold(SceneFolder::new(), |folder, (name, text)| folder.with(name, text))
}

/// Loads a folder made of these files.
pub fn open(files: &[(&str, &str)]) -> Result<Loaded, Diagnostics> {
    load(&folder(files), &[], with_scripts())
}

/// The pendulum with a script on its arm; `keys` are more keys of the script.
pub fn with_script(code: &str, keys: &str) -> Result<Loaded, Diagnostics> {
    let scene = format!("{PENDULUM}\n[[script]]\nobject = \"/hinge/arm\"\nfile = \"a.lua\"\n{keys}\n");
    open(&[("scene.toml", &scene), ("experiment.toml", EXPERIMENT), ("a.lua", code)])
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
