//! The flight test: 60 s of `scenes/quadrotor-flight-1` with its controller and all that is recorded, as `sincro run`
//! makes it, but for error bars, variants and checks.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use crate::extensions;
use sincro_sim::run::{RunMonitor, RunOptions, simulate};
use sincro_sim::{Loaded, load};

use super::clock::Subject;

/// Length of the flight `[s]`.
pub(super) const SECONDS: f64 = 60.0;

/// Files of the scene, carried in the program so that it measures anywhere; a test keeps them equal to those of the
/// scene.
const FILES: [(&str, &str); 3] = [
    ("experiment.toml", include_str!("../flight/experiment.toml")),
    ("scene.toml", include_str!("../flight/scene.toml")),
    ("backstepping.toml", include_str!("../flight/backstepping.toml")),
];

/// The experiment without what it is compared with: a folder for temporary files holds it while it is read.
fn loaded() -> Result<Loaded, String> {
    let folder = std::env::temp_dir().join(format!("sincro-bench-flight-{}", std::process::id()));
    let result =
        write(&folder).and_then(|()| load(&folder, &[], extensions()).map_err(|problems| problems.to_string()));
    // nothing is lost if it stays
    let _ = std::fs::remove_dir_all(&folder);
    result
}

fn write(folder: &PathBuf) -> Result<(), String> {
    let failed = |e: std::io::Error| format!("`{}` cannot be written: {e}", folder.display());
    std::fs::create_dir_all(folder).map_err(failed)?;
    for (name, text) in FILES {
        // checks, variants and figures name files that are not here
        let text = text.split("\n[[check]]").next().unwrap_or(text);
        std::fs::write(folder.join(name), text).map_err(failed)?;
    }
    Ok(())
}

/// The whole flight once.
///
/// # Errors
///
/// If the folder for temporary files cannot be written.
pub(super) fn flight() -> Result<Subject, String> {
    let loaded = loaded()?;
    let interrupt = AtomicBool::new(false);
    let once = move || {
        let mut watch = RunMonitor { interrupt: &interrupt, progress: &mut |_| {} };
        let run = simulate(&loaded, RunOptions::default(), &mut watch).expect("every recorded signal is there");
        assert!(run.status.is_good(), "the flight comes to its end");
    };
    Ok(Subject::new(once))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_flight_that_is_timed_is_that_of_the_scene() {
        let loaded = loaded().unwrap();
        assert_eq!(loaded.experiment.duration, SECONDS);
        assert!(loaded.controller.is_some() && loaded.experiment.record.len() > 30);
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/quadrotor-flight-1");
        for (name, text) in FILES {
            assert!(text == std::fs::read_to_string(folder.join(name)).unwrap(), "{name}: copy that of the scene here");
        }
    }
}
