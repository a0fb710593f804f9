//! A scene for clients of V-REP and CoppeliaSim.
//!
//! [`open`] makes a session, [`Server::start`] serves it until the server is dropped, and its
//! [`events`](Server::events) give the runs that clients made, which a [`Recorder`] writes as any other run.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use sincro_coppelia::session::{Finished, Session};
use sincro_scene::diagnostic::Diagnostics;
use sincro_scene::overrides::Override;
use sincro_sim::campaign::judge;
use sincro_sim::file::{FileError, prepare};

pub use sincro_remote::hub::Event;
pub use sincro_remote::limits::Deadlines;
pub use sincro_remote::{Options, Server};

use crate::load::extensions;
use crate::results;

/// Opens a scene for clients, stopped. A step of a client lasts `sample_time` `[s]`, or `simulation_step` of the
/// experiment.
///
/// # Errors
///
/// All problems of the scene and the overrides, or a sample time that is no whole multiple of the base step.
pub fn open(scene: &Path, overrides: &[Override], sample_time: Option<f64>) -> Result<Session, Diagnostics> {
    Session::open(scene, overrides, extensions(), sample_time)
}

/// Extent of what is kept of a run that clients made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Record {
    /// Nothing.
    None,
    /// `signals.csv` and `run.json`.
    Signals,
    /// All that `sincro run` writes: figures, replay and report too.
    #[default]
    Full,
}

/// Folders `run-1`, `run-2` … of the runs that clients made, the newest ones kept.
#[derive(Debug)]
pub struct Recorder {
    out: PathBuf,
    record: Record,
    keep: usize,
    n_runs: usize,
}

/// Outcome of [`Recorder::store`].
#[derive(Debug)]
pub struct Stored {
    /// Number of the run, from 1.
    pub number: usize,
    /// File to look at first; none if nothing is kept.
    pub path: Option<PathBuf>,
}

impl Recorder {
    /// Recorder into folders below `out`; of the runs that it stores the newest `keep` stay.
    #[must_use]
    pub fn new(out: PathBuf, record: Record, keep: NonZeroUsize) -> Self {
        Self { out, record, keep: keep.get(), n_runs: 0 }
    }

    /// Judges a run, writes it into the next folder and deletes the one that is too many.
    ///
    /// # Errors
    ///
    /// A file cannot be written, or the oldest folder not be deleted.
    pub fn store(&mut self, finished: &Finished) -> Result<Stored, FileError> {
        self.n_runs += 1;
        let number = self.n_runs;
        let out = self.out.join(format!("run-{number}"));
        let path = match self.record {
            Record::None => return Ok(Stored { number, path: None }),
            Record::Signals => out.join("signals.csv"),
            Record::Full => out.join("report.html"),
        };
        write_run(finished, &out, self.record)?;
        if let Some(oldest) = number.checked_sub(self.keep).filter(|oldest| *oldest > 0) {
            let oldest = self.out.join(format!("run-{oldest}"));
            std::fs::remove_dir_all(&oldest).map_err(|cause| FileError { path: oldest, action: "delete", cause })?;
        }
        Ok(Stored { number, path: Some(path) })
    }
}

fn write_run(finished: &Finished, out: &Path, record: Record) -> Result<(), FileError> {
    prepare(out)?;
    let loaded = &finished.loaded;
    let scene = loaded.experiment.scene_path.parent().unwrap_or(Path::new("."));
    finished.simulated.table.write_csv(&out.join("signals.csv"))?;
    let campaign = judge(scene, loaded, finished.simulated.clone());
    campaign.report.write(out)?;
    if record == Record::Full { results::write_one_of_many(loaded, &campaign, out) } else { Ok(()) }
}
