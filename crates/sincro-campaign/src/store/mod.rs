//! Folder of a campaign: what it holds, how several processes share it, and what is refused.
//!
//! ```text
//! DIR/campaign.json            description, hash of the inputs
//! DIR/plan.toml                the plan
//! DIR/signals/*.parquet        the long table of signals, if the plan keeps any: a file for each part
//! DIR/parts/part-F-L.parquet   rows F to L, each file whole or not there
//! DIR/runs.parquet             all rows, by `collect`
//! DIR/report.html, summary.json
//! DIR/runs/K/                  runs that were made again, by `--only K`
//! DIR/jobs/                    scripts of `submit`
//! ```
//!
//! A part is a function of the inputs and its number. It is written under a name of its own process, synchronised and
//! renamed: two processes that make the same part leave the same bytes, and one that is killed leaves a file that
//! nobody reads. No time stamp is looked at.

mod collect;
mod part;

use std::fmt;
use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sincro_sim::file::{FileError, partial_of_process, put_in_shared_place, write_atomically_shared};
use sincro_sim::formats::parquet::{ParquetError, ParquetFile, Values};

use crate::campaign::{Campaign, Column};
use crate::row::Layout;

pub use collect::{Collected, collect};
pub(crate) use part::PartState;

/// Name of the description.
const MANIFEST: &str = "campaign.json";
/// Name of the collected table.
pub(crate) const RUNS: &str = "runs.parquet";

/// Description of a campaign beside its results, `campaign.json`: all that [`collect`] and the report need of the plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Hash of the inputs, [`Campaign::input`].
    pub input: String,
    /// Version of the program that began the campaign.
    pub sincro_version: String,
    /// Path of the plan file as it was named on the command line.
    pub plan: String,
    /// Name of the scene's folder.
    pub scene: String,
    /// Title of the report: that of the plan, or of the experiment.
    pub title: String,
    /// Description under the title; may be empty.
    pub description: String,
    /// Name of the design of experiments, [`crate::plan::Design::word`].
    pub design: String,
    /// Seed of all random draws.
    pub seed: u64,
    /// Probability of the confidence intervals, 0.5 to below 1.
    pub confidence: f64,
    /// Number of runs.
    pub n_runs: u64,
    /// Number of draws for each point of the grid.
    pub n_draws: u64,
    /// Number of parameters that are drawn.
    pub n_drawn: usize,
    /// Number of rows in each part; the last has the rest.
    pub rows_per_part: u64,
    /// Signals of which the series are kept, in the order of their columns.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub signals: Vec<String>,
    /// Names of the variants, in the order of the plan.
    pub variants: Vec<String>,
    /// Descriptions of the parameters, in the order of the plan.
    pub parameters: Vec<Column>,
    /// True for each parameter that is drawn, false for one of the grid, in their order.
    pub is_drawn: Vec<bool>,
    /// Descriptions of the measures, in the order of their columns.
    pub measures: Vec<Column>,
}

/// Error of the folder of a campaign. Its text (`Display`) is a message for the user, [`StoreError::help`] the remedy.
#[derive(Debug)]
pub enum StoreError {
    /// A file cannot be written or read.
    File(FileError),
    /// The folder belongs to another campaign, or holds something else; message and remedy.
    Foreign(String, String),
    /// A part, the table or the manifest is damaged: its file and the reason.
    Damaged(PathBuf, String),
    /// Parts are missing: numbers of the first and last run of each missing range, ascending.
    Missing(Vec<(u64, u64)>),
    /// Another process collects this folder.
    Busy(PathBuf),
}

impl fmt::Display for StoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => write!(f, "{error}"),
            Self::Foreign(message, _) => write!(f, "{message}"),
            Self::Damaged(path, reason) => write!(f, "`{}` is no sound part of the results: {reason}", path.display()),
            Self::Missing(ranges) => {
                let n: u64 = ranges.iter().map(|(first, last)| last - first + 1).sum();
                let shown: Vec<String> = ranges.iter().take(5).map(|(first, last)| format!("{first}–{last}")).collect();
                let more = if ranges.len() > 5 { ", …" } else { "" };
                write!(f, "{n} runs are missing: {}{more}", shown.join(", "))
            }
            Self::Busy(folder) => write!(f, "another process collects `{}`", folder.display()),
        }
    }
}

impl std::error::Error for StoreError {}

impl StoreError {
    /// Returns the remedy in English, such as which file to delete; empty if there is none.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Self::File(error) if error.cause.kind() == std::io::ErrorKind::StorageFull => {
                "make room and run the same command again: what is there is kept".into()
            }
            Self::File(_) => String::new(),
            Self::Foreign(_, help) => help.clone(),
            Self::Damaged(..) => "delete that file and run the same command again: only it is made anew".into(),
            Self::Missing(_) => "run `sincro sweep PLAN --out DIR` again: only what is missing is made".into(),
            Self::Busy(_) => "wait until it has finished".into(),
        }
    }
}

impl From<FileError> for StoreError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

/// Folder of a campaign with its manifest and its results, which several processes may fill at the same time.
#[derive(Clone, Debug)]
pub struct Store {
    /// Path of the folder.
    pub folder: PathBuf,
    /// Content of its `campaign.json`.
    pub manifest: Manifest,
}

impl Store {
    /// Opens the folder of a campaign, or creates it; `plan` is the path of the plan file as the user named it, for
    /// reports.
    ///
    /// # Errors
    ///
    /// [`StoreError::Foreign`]: it holds another campaign or other files. [`StoreError::Damaged`]: its manifest cannot
    /// be understood. [`StoreError::File`]: it cannot be read or written.
    pub fn open(folder: &Path, campaign: &Campaign, plan: &str) -> Result<Self, StoreError> {
        let manifest = Manifest::of(campaign, plan);
        if let Some(found) = Manifest::read(folder)? {
            return Self::same(folder, found, &manifest, campaign);
        }
        if let Some(name) = foreign_entry(folder) {
            let message = format!("`{}` holds `{name}`, which is no part of a campaign", folder.display());
            return Err(StoreError::Foreign(message, "name a folder that is absent or empty".into()));
        }
        sincro_sim::file::prepare(folder)?;
        let parts = folder.join("parts");
        std::fs::create_dir_all(&parts).map_err(|e| FileError::new("create the folder", &parts, e))?;
        let json = serde_json::to_string_pretty(&manifest).expect("a description is plain data");
        publish_once(&folder.join(MANIFEST), (json + "\n").as_bytes())?;
        // another process may have been the first, with another plan
        let found = Manifest::read(folder)?.unwrap_or_else(|| manifest.clone());
        Self::same(folder, found, &manifest, campaign)
    }

    /// The store of a description that was found, if it is of this campaign.
    fn same(folder: &Path, found: Manifest, manifest: &Manifest, campaign: &Campaign) -> Result<Self, StoreError> {
        if found.input != manifest.input {
            let message = format!(
                "`{}` holds another campaign: its inputs have the hash {}, those of this plan {}",
                folder.display(),
                found.input,
                manifest.input
            );
            let help = "name another folder, or delete that one; the plan, the scene or the version has changed";
            return Err(StoreError::Foreign(message, help.into()));
        }
        let plan = folder.join("plan.toml");
        if !plan.is_file() {
            write_atomically_shared(&plan, campaign.plan.source.text.as_bytes())?;
        }
        Ok(Self { folder: folder.to_owned(), manifest: found })
    }

    /// Opens the folder of a campaign that was begun.
    ///
    /// # Errors
    ///
    /// [`StoreError::Foreign`]: it has no `campaign.json`. [`StoreError::Damaged`]: that cannot be understood.
    /// [`StoreError::File`]: it cannot be read.
    pub fn existing(folder: &Path) -> Result<Self, StoreError> {
        let manifest = Manifest::read(folder)?.ok_or_else(|| {
            let message = format!("`{}` is no folder of a campaign: it has no `{MANIFEST}`", folder.display());
            StoreError::Foreign(message, "name the folder that was given to `sincro sweep … --out DIR`".into())
        })?;
        Ok(Self { folder: folder.to_owned(), manifest })
    }

    /// Columns of the results.
    #[must_use]
    pub(crate) fn layout(&self) -> Layout {
        self.manifest.layout()
    }

    /// Returns the number of parts (files of [`Manifest::rows_per_part`] rows) of the complete results.
    #[must_use]
    pub fn n_parts(&self) -> u64 {
        self.manifest.n_runs.div_ceil(self.manifest.rows_per_part)
    }

    /// Returns the trace of run `k` (from 0, below the manifest's `n_runs`) in the results,
    /// [`Row::trace`](crate::row::Row::trace); `None` if the run is not there yet.
    ///
    /// # Errors
    ///
    /// [`StoreError::File`] or [`StoreError::Damaged`]: the table or the part that holds the run cannot be read.
    pub fn trace_of(&self, k: u64) -> Result<Option<String>, StoreError> {
        let path =
            [self.runs_path(), self.part_path(k / self.manifest.rows_per_part)].into_iter().find(|p| p.is_file());
        let Some(path) = path else { return Ok(None) };
        let mut file = ParquetFile::open(&path).map_err(|error| damaged(&path, error))?;
        let column = |name: &str| file.columns.iter().position(|(known, _)| known == name);
        let (Some(number), Some(trace)) = (column("k"), column("trace")) else { return Ok(None) };
        for group in 0..file.n_groups() {
            let columns = file.group(group).map_err(|error| damaged(&path, error))?;
            if let (Values::Ints(numbers), Values::Texts(traces)) = (&columns[number], &columns[trace])
                && let Some(row) = numbers.iter().position(|n| *n == k as i64)
            {
                return Ok(Some(traces[row].clone()));
            }
        }
        Ok(None)
    }

    /// First and last run of a part.
    #[must_use]
    pub(crate) fn range(&self, part: u64) -> (u64, u64) {
        let size = self.manifest.rows_per_part;
        (part * size, ((part + 1) * size).min(self.manifest.n_runs) - 1)
    }

    /// File of a part.
    #[must_use]
    pub(crate) fn part_path(&self, part: u64) -> PathBuf {
        let (first, last) = self.range(part);
        self.folder.join("parts").join(format!("part-{first:09}-{last:09}.parquet"))
    }

    /// File of the series of a part.
    #[must_use]
    pub(crate) fn signals_path(&self, part: u64) -> PathBuf {
        let (first, last) = self.range(part);
        self.folder.join("signals").join(format!("signals-{first:09}-{last:09}.parquet"))
    }

    /// Returns the path of the table of all runs, `runs.parquet`, which [`collect`] writes.
    #[must_use]
    pub fn runs_path(&self) -> PathBuf {
        self.folder.join(RUNS)
    }
}

impl Manifest {
    fn of(campaign: &Campaign, plan: &str) -> Self {
        let of = &campaign.plan;
        let title = if of.title.is_empty() { &campaign.loaded.experiment.title } else { &of.title };
        Self {
            input: campaign.input.clone(),
            sincro_version: env!("CARGO_PKG_VERSION").into(),
            plan: plan.to_owned(),
            scene: sincro_scene::open::folder_name(&of.scene),
            title: title.clone(),
            description: of.description.clone(),
            design: of.design.word().into(),
            seed: of.seed,
            confidence: of.confidence,
            n_runs: of.n_runs(),
            n_draws: of.n_draws,
            n_drawn: of.n_drawn(),
            rows_per_part: of.rows_per_part(),
            signals: of.signals.iter().map(|signal| signal.value.clone()).collect(),
            variants: of.variants.iter().map(|v| v.value.clone()).collect(),
            parameters: campaign.parameter_columns(),
            is_drawn: of.parameters.iter().map(|p| !p.distribution.is_grid()).collect(),
            measures: campaign.measure_columns(),
        }
    }

    fn read(folder: &Path) -> Result<Option<Self>, StoreError> {
        let path = folder.join(MANIFEST);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) if error.kind() == std::io::ErrorKind::NotADirectory => {
                let message = format!("`{}` is a file", folder.display());
                return Err(StoreError::Foreign(message, "name a folder".into()));
            }
            Err(error) => return Err(FileError::new("read", &path, error).into()),
        };
        let read: Result<Self, _> = serde_json::from_str(&text);
        match read {
            Ok(found) => match found.problem() {
                None => Ok(Some(found)),
                Some(reason) => Err(StoreError::Damaged(path, reason)),
            },
            Err(error) => Err(StoreError::Damaged(path, error.to_string())),
        }
    }

    /// First thing that no campaign has.
    fn problem(&self) -> Option<String> {
        let counts = [
            ("n_runs", self.n_runs),
            ("n_draws", self.n_draws),
            ("rows_per_part", self.rows_per_part),
            ("variants", self.variants.len() as u64),
        ];
        let wrong = counts.into_iter().find(|(_, n)| *n == 0 || *n > crate::plan::MAX_RUNS);
        wrong.map(|(name, n)| format!("{n} for `{name}`")).or_else(|| {
            let is_sound = self.is_drawn.len() == self.parameters.len()
                && self.n_drawn == self.is_drawn.iter().filter(|is_drawn| **is_drawn).count();
            (!is_sound).then(|| "`is_drawn` does not fit the parameters".to_owned())
        })
    }

    /// Columns of the results.
    #[must_use]
    pub(crate) fn layout(&self) -> Layout {
        let names = |columns: &[Column]| columns.iter().map(|c| c.name.clone()).collect();
        Layout { parameters: names(&self.parameters), measures: names(&self.measures) }
    }
}

/// Something in a folder that no campaign leaves there before its description.
fn foreign_entry(folder: &Path) -> Option<String> {
    let known = [MANIFEST, "plan.toml", "parts", "signals", "runs", "jobs", ".lock"];
    let names = std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    // other processes that begin at the same time
    names.into_iter().find(|name| !known.contains(&name.as_str()) && !name.ends_with(".partial"))
}

/// Writes a file under a name of this process, and gives it its place unless that is taken.
fn publish_once(path: &Path, content: &[u8]) -> Result<(), FileError> {
    let own = partial_of_process(path);
    let written = File::create(&own).and_then(|mut file| {
        std::io::Write::write_all(&mut file, content)?;
        file.sync_all()
    });
    if let Err(error) = written {
        let _ = std::fs::remove_file(&own);
        return Err(FileError::new("write", path, error));
    }
    match std::fs::hard_link(&own, path) {
        // some file systems have no links
        Err(error) if error.kind() != ErrorKind::AlreadyExists && !path.exists() => {
            put_in_shared_place(&own, path, Ok(()))
        }
        _ => {
            let _ = std::fs::remove_file(&own);
            Ok(())
        }
    }
}

fn damaged(path: &Path, error: ParquetError) -> StoreError {
    match error {
        ParquetError::File(cause) => StoreError::File(FileError::new("read", path, cause)),
        ParquetError::Content(reason) => StoreError::Damaged(path.to_owned(), reason),
    }
}
