//! An experiment with its variants, sweep and checks, run into a folder of results.

use std::fmt;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use sincro_scene::diagnostic::Diagnostics;
use sincro_scene::experiment::check::{Check, Expected};
use sincro_scene::overrides::Override;
use sincro_sim::Loaded;
use sincro_sim::campaign::Progress;
use sincro_sim::campaign::{Campaign, run_campaign};
use sincro_sim::file::FileError;
use sincro_sim::result_folder::{FolderError, ResultFolder};
use sincro_sim::results::{CheckReport, Override as Setting, VerdictReport};
use sincro_sim::run::{RunError, RunMonitor, RunOptions, Simulated};

use crate::results::{Link, write};

/// Experiment to be run, with its results to be written: [`RunRequest::run`] does both.
#[derive(Clone, Copy, Debug)]
pub struct RunRequest<'a> {
    /// Path of the scene folder that `loaded` was read from: variants and sweep points are read from it again.
    pub scene: &'a Path,
    /// The overrides that `loaded` was read with.
    pub overrides: &'a [Override],
    /// The scene, from [`load`](crate::load).
    pub loaded: &'a Loaded,
    /// Link from the report to a page above it, if there is one.
    pub index: Option<Link<'a>>,
}

/// Reason why a run was not made, or its results are not complete. A run that stops is not a failure: see
/// [`Verdict::Stopped`].
#[derive(Debug)]
pub enum RunFailure {
    /// A recorded signal does not exist, or a variant cannot be opened. Nothing was written.
    Diagnostics(Diagnostics),
    /// Rows could not be written while the run was under way. An earlier result is as it was.
    Recording(FileError),
    /// The folder holds something else, or another run is writing it. Nothing was run or written.
    Folder(FolderError),
    /// The report could not be written. An earlier result is as it was.
    Results(FileError),
}

impl fmt::Display for RunFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diagnostics(diagnostics) => write!(f, "{diagnostics}"),
            Self::Recording(error) => write!(f, "the run stopped: {error}"),
            Self::Folder(error) => write!(f, "{error}"),
            Self::Results(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for RunFailure {}

impl From<RunError> for RunFailure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Diagnostics(diagnostics) => Self::Diagnostics(diagnostics),
            RunError::File(error) => Self::Recording(error),
        }
    }
}

impl RunRequest<'_> {
    /// Runs the experiment and writes `signals.csv`, `run.json`, `replay.json`, `report.html` and the figures, and
    /// those of its variants and its sweep, into the folder `out`. It must be absent, empty, or an earlier result,
    /// which is replaced whole once the run is at its end.
    ///
    /// `interrupt` set to true by another thread ends the run after the present step; its results are written all the
    /// same.
    /// `progress` is called with a word for the work in hand and the share of it that is done, 0 to 1.
    ///
    /// # Errors
    ///
    /// See [`RunFailure`].
    ///
    /// ```
    /// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
    /// # let out = std::env::temp_dir().join(format!("sincro-doc-{}", std::process::id()));
    /// use std::sync::atomic::AtomicBool;
    /// use sincro::{RunRequest, Verdict};
    ///
    /// let loaded = sincro::load(&scene, &[])?;
    /// let request = RunRequest { scene: &scene, overrides: &[], loaded: &loaded, index: None };
    /// let campaign = request.run(&out, &AtomicBool::new(false), &mut |_, _| {})?;
    /// assert_eq!(Verdict::of(&campaign), Verdict::Holds);
    /// assert!(out.join("report.html").is_file());
    /// # std::fs::remove_dir_all(&out)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn run(&self, out: &Path, interrupt: &AtomicBool, progress: Progress<'_>) -> Result<Campaign, RunFailure> {
        let folder = ResultFolder::replace(out).map_err(RunFailure::Folder)?;
        let campaign = self.run_into(folder.path(), interrupt, progress)?;
        folder.publish().map_err(RunFailure::Results)?;
        Ok(campaign)
    }

    /// Runs the experiment as [`run`](Self::run) does, into a folder that exists, such as the
    /// [path](ResultFolder::path) of a [`ResultFolder`] to which more is then added before it is published.
    ///
    /// # Errors
    ///
    /// [`RunFailure::Diagnostics`], [`RunFailure::Recording`] or [`RunFailure::Results`]; what was written stays in the
    /// folder.
    pub fn run_into(&self, out: &Path, interrupt: &AtomicBool, progress: Progress<'_>) -> Result<Campaign, RunFailure> {
        let Self { scene, overrides, loaded, .. } = *self;
        let mut campaign = run_campaign(scene, overrides, loaded, Some(out), interrupt, progress)?;
        let set = overrides.iter().map(|s| Setting { path: s.path.value.clone(), value: s.value.value.clone() });
        campaign.report.settings.overrides = set.collect();
        if let Some(found) = unstable_loop(loaded) {
            campaign.main.simulated.warnings.insert(0, found.clone());
            campaign.report.warnings.insert(0, found);
        }
        mark_references(&mut campaign, loaded, overrides);
        campaign.report.write(out).map_err(RunFailure::Results)?;
        write(loaded, &campaign, out, self.index).map_err(RunFailure::Results)?;
        Ok(campaign)
    }
}

/// Settings that change how a run is computed and recorded, and nothing of what is simulated.
const OF_THE_METHOD: [&str; 7] = ["duration", "step", "integrator", "accuracy", "seed", "record_every", "error_bar"];

/// Warning about a loop that is unstable at the start; none without the feature `analysis`.
pub(crate) fn unstable_loop(loaded: &Loaded) -> Option<String> {
    #[cfg(feature = "analysis")]
    return sincro_analysis::linearize::unstable_loop(loaded).map(|found| found.to_string());
    #[cfg(not(feature = "analysis"))]
    {
        let _ = loaded;
        None
    }
}

/// Marks checks against a reference whose scene, diagram or parameters were changed from outside: the reference is that
/// of the files as they are.
fn mark_references(campaign: &mut Campaign, loaded: &Loaded, overrides: &[Override]) {
    let from_outside = |s: &&Override| s.path.at.source.path.as_os_str() == "--set";
    let changed: Vec<&str> = overrides
        .iter()
        .filter(from_outside)
        .map(|s| s.path.value.as_str())
        .filter(|path| !OF_THE_METHOD.contains(path))
        .collect();
    let Some(first) = changed.first() else { return };
    let more = if changed.len() > 1 { format!(" and {} more", changed.len() - 1) } else { String::new() };
    let reason = format!("the reference is for the files as they are, `{first}`{more} is set");
    let mark = |reports: &mut [CheckReport], checks: &[Check]| {
        for (report, check) in reports.iter_mut().zip(checks) {
            if matches!(check.expected, Expected::Reference(_)) && report.reason.is_none() {
                report.reason = Some(reason.clone());
            }
        }
    };
    mark(&mut campaign.report.checks, &loaded.experiment.checks);
    for (report, variant) in campaign.report.variants.iter_mut().zip(&loaded.experiment.variants) {
        mark(&mut report.checks, &variant.checks);
    }
}

/// Runs the main run of an experiment in memory: no variants, no sweep, no checks, no files. The head of this crate has
/// an example.
///
/// # Errors
///
/// [`RunFailure::Diagnostics`]: a recorded signal does not exist. A run that stops is not an error: see
/// [`Simulated::status`].
pub fn simulate(loaded: &Loaded) -> Result<Simulated, RunFailure> {
    let mut watch = RunMonitor { interrupt: &AtomicBool::new(false), progress: &mut |_| {} };
    Ok(sincro_sim::run::simulate(loaded, RunOptions::default(), &mut watch)?)
}

/// Judgement of an experiment that was run, over the main run, its variants and its sweep; the exit status of
/// `sincro run` follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// All checks hold, and the audit has no findings.
    Holds,
    /// A check fails or could not be made, or the audit of a run has findings.
    Fails,
    /// A run stopped before its end: the state is not finite, a script failed, it was interrupted.
    Stopped,
}

impl Verdict {
    /// Judges all runs of an experiment; the worst of them counts, and a stop is worse than a check that fails.
    #[must_use]
    pub fn of(campaign: &Campaign) -> Self {
        let report = &campaign.report;
        let statuses = [&report.status].into_iter().chain(report.variants.iter().map(|v| &v.status));
        let sweep_stopped = report.sweep.as_ref().is_some_and(|s| !s.stops.is_empty());
        if statuses.into_iter().any(|s| !s.is_good()) || sweep_stopped {
            return Self::Stopped;
        }
        if report.audits().any(|audit| !audit.ok) {
            return Self::Fails;
        }
        let of_variants = report.variants.iter().flat_map(|v| &v.checks);
        let of_sweep = report.sweep.iter().flat_map(|s| &s.checks);
        let mut checks = report.checks.iter().chain(of_variants).chain(of_sweep);
        if checks.all(|c| c.verdict == VerdictReport::Holds) { Self::Holds } else { Self::Fails }
    }
}
