//! A scene for clients of V-REP and CoppeliaSim.
//!
//! [`open`] makes a session, [`Server::start`] serves it until the server is dropped, and its
//! [`events`](Server::events) give the runs that clients made, which a [`RunArchive`] writes as any other run.

use std::collections::VecDeque;
use std::io::ErrorKind;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use sincro_coppelia::session::{Finished, Session};
use sincro_scene::diagnostic::Diagnostics;
use sincro_scene::overrides::Override;
use sincro_sim::campaign::judge;
use sincro_sim::file::FileError;
use sincro_sim::result_folder::{FolderError, ResultFolder};

pub use sincro_remote::hub::Event;
pub use sincro_remote::limits::Deadlines;
pub use sincro_remote::{Options, Server};

use crate::load::extensions;
use crate::results;

/// Opens a scene for clients, stopped, for [`Server::start`]. A step of a client lasts `sample_time` `[s]`, or
/// `simulation_step` of the experiment for none.
///
/// # Errors
///
/// All problems of the scene and the overrides, each with its place in the file, or a sample time that is no whole
/// multiple of the base step.
pub fn open(scene: &Path, overrides: &[Override], sample_time: Option<f64>) -> Result<Session, Diagnostics> {
    Session::open(scene, overrides, extensions(), sample_time)
}

/// Extent of the results that a [`RunArchive`] keeps of a run that clients made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ArchiveLevel {
    /// Nothing is written.
    None,
    /// `signals.csv` and `run.json`.
    Signals,
    /// All that `sincro run` writes: figures, replay and report too.
    #[default]
    Full,
}

/// Archive of the runs that clients made, in folders `run-1`, `run-2` …, of which the newest are kept. Folders that
/// were there before are neither written into nor deleted: numbers go on behind them.
#[derive(Debug)]
pub struct RunArchive {
    out: PathBuf,
    record: ArchiveLevel,
    keep: usize,
    n_runs: usize,
    /// Number of the next folder that may be free.
    next: u32,
    /// Folders that this recorder made and has not deleted, the oldest first.
    kept: VecDeque<PathBuf>,
}

/// Outcome of [`RunArchive::store`] for one run.
#[derive(Debug)]
pub struct ArchivedRun {
    /// Number of the run among those of this archive, from 1.
    pub number: usize,
    /// File to look at first, the report or the signals; none if nothing is kept.
    pub path: Option<PathBuf>,
}

impl RunArchive {
    /// Creates an archive in folders below `out`; of the runs that it stores the newest `keep` stay. Nothing is written
    /// yet.
    #[must_use]
    pub fn new(out: PathBuf, record: ArchiveLevel, keep: NonZeroUsize) -> Self {
        Self { out, record, keep: keep.get(), n_runs: 0, next: 1, kept: VecDeque::new() }
    }

    /// Judges a run, writes it into the next free folder and deletes the oldest folder of this archive beyond those to
    /// be kept.
    ///
    /// # Errors
    ///
    /// A file cannot be written, or the oldest folder cannot be deleted; the error has the path.
    pub fn store(&mut self, finished: &Finished) -> Result<ArchivedRun, FileError> {
        self.n_runs += 1;
        let number = self.n_runs;
        let file = match self.record {
            ArchiveLevel::None => return Ok(ArchivedRun { number, path: None }),
            ArchiveLevel::Signals => "signals.csv",
            ArchiveLevel::Full => "report.html",
        };
        let folder = ResultFolder::next(&self.out, self.next, |k| format!("run-{k}"), false).map_err(file_error)?;
        write_run(finished, &folder, self.record)?;
        let out = folder.publish()?;
        let name = out.file_name().unwrap_or_default().to_string_lossy();
        self.next = name.strip_prefix("run-").and_then(|k| k.parse().ok()).map_or(1, |k: u32| k + 1);
        let path = Some(out.join(file));
        self.kept.push_back(out);
        while self.kept.len() > self.keep {
            if let Some(oldest) = self.kept.pop_front() {
                delete(&oldest)?;
            }
        }
        Ok(ArchivedRun { number, path })
    }
}

/// The error of a folder that is made anew, of which nothing can be there.
fn file_error(error: FolderError) -> FileError {
    match error {
        FolderError::File(error) => error,
        FolderError::Foreign { folder, .. } | FolderError::Locked(folder) => {
            FileError { path: folder, action: "create the folder", cause: ErrorKind::AlreadyExists.into() }
        }
    }
}

/// Path for the files that clients send: the first of `received`, `received-2` … below `out` that does not exist, so
/// that files of an earlier server do not mix with those of this one's clients. It is not created.
#[must_use]
pub fn received_folder(out: &Path) -> PathBuf {
    let name = |k: usize| if k == 1 { "received".to_owned() } else { format!("received-{k}") };
    let folders = (1..).map(|k| out.join(name(k)));
    folders.into_iter().find(|folder| folder.symlink_metadata().is_err()).unwrap_or_else(|| out.join("received"))
}

/// Deletes a folder; one that is gone already is no error.
fn delete(folder: &Path) -> Result<(), FileError> {
    match std::fs::remove_dir_all(folder) {
        Err(cause) if cause.kind() != ErrorKind::NotFound => {
            Err(FileError { path: folder.to_owned(), action: "delete", cause })
        }
        _ => Ok(()),
    }
}

fn write_run(finished: &Finished, folder: &ResultFolder, record: ArchiveLevel) -> Result<(), FileError> {
    let out = folder.path();
    let loaded = &finished.loaded;
    let scene = loaded.experiment.scene_path.parent().unwrap_or(Path::new("."));
    finished.simulated.table.write_csv(&out.join("signals.csv"))?;
    let campaign = judge(scene, loaded, finished.simulated.clone());
    campaign.report.write(out)?;
    if record == ArchiveLevel::Full {
        results::write_one_of_many(loaded, &campaign, out)
    } else {
        results::write_images(&campaign.main.simulated.images, out)
    }
}
