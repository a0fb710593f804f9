//! A scene for clients of V-REP and CoppeliaSim.
//!
//! [`open`] makes a session, [`Server::start`] serves it until the server is dropped, and its
//! [`events`](Server::events) give the runs that clients made, which [`write_run`] writes as any other run.

use std::path::Path;

use sincro_sim::overrides::Override;
use sincro_sim::problem::Problems;
use sincro_sim::results::{FileError, prepare};
use sincro_sim::run::judge;
use sincro_sim::session::{Finished, Session};

pub use sincro_remote::hub::Event;
pub use sincro_remote::{Options, Server};

use crate::load::install_languages;
use crate::results;

/// Opens a scene for clients, stopped. A step of a client lasts `sample_time` `[s]`, or `simulation_step` of the
/// experiment.
///
/// # Errors
///
/// All problems of the scene and the overrides, or a sample time that is no whole multiple of the base step.
pub fn open(scene: &Path, overrides: &[Override], sample_time: Option<f64>) -> Result<Session, Problems> {
    install_languages();
    Session::open(scene, overrides, sample_time)
}

/// Judges a run that clients made and writes `signals.csv`, `run.json`, figures and report into a folder.
///
/// # Errors
///
/// A file cannot be written.
pub fn write_run(finished: &Finished, out: &Path) -> Result<(), FileError> {
    prepare(out)?;
    let loaded = &finished.loaded;
    let scene = loaded.experiment.scene_path.parent().unwrap_or(Path::new("."));
    finished.simulated.table.write_csv(&out.join("signals.csv"))?;
    let campaign = judge(scene, loaded, finished.simulated.clone());
    campaign.report.write(out)?;
    results::write(loaded, &campaign, out, None)
}
