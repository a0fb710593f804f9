//! `run.json`: what a run was, what it gave, and how far to trust it.
//!
//! [`RunReport`] is the file: fields stand in it in the order in which they stand here, numbers with all their digits.
//! JSON has no NaN and no infinity; such a number is null, and `not_finite` at the end of the file says what it was:
//! `"/energy/residual": "NaN"`.

mod number;

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::audit::{AuditReport, Finding};
use crate::check::{Outcome, Verdict};
use crate::file::{self, FileError};
use crate::sweep::Sweep;
use crate::table::Table;
use crate::validity::ValidityViolation;
use sincro_scene::experiment::check::Sense;

/// Content of `run.json`: the run, its settings, signals, checks and findings.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// # let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// # let interrupt = std::sync::atomic::AtomicBool::new(false);
/// # let done = run_campaign(folder.as_ref(), &[], &loaded, None, &interrupt, &mut |_, _| {})?;
/// let report: RunReport = done.report; // of the scene `acrobot`
/// assert_eq!((report.scene.as_str(), report.n_dof), ("acrobot", 2));
/// assert_eq!((report.columns[0].path.as_str(), report.checks.len()), ("t", 1));
/// assert_eq!(report.trace_hash, done.main.simulated.trace.to_string());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// Version of sincro that ran it.
    pub sincro_version: String,
    /// Name of the scene's folder.
    pub scene: String,
    /// The scene's folder as it was given.
    pub scene_path: String,
    /// Title of the experiment.
    pub title: String,
    /// Status at the end of the run.
    pub status: Status,
    /// Settings of the run.
    pub settings: Settings,
    /// Hash of the compiled model, hexadecimal.
    pub model_hash: String,
    /// Hash of the states of all ticks, hexadecimal: the same bits give the same hash.
    pub trace_hash: String,
    /// Degrees of freedom of the mechanism at the start, closed loops counted.
    pub n_dof: usize,
    /// The columns of `signals.csv`, in their order, `t` first.
    pub columns: Vec<ColumnReport>,
    /// The balance of energy.
    pub energy: Option<EnergyReport>,
    /// Audit of the main run.
    #[serde(default)]
    pub audit: AuditReport,
    /// Checks with their measured values.
    pub checks: Vec<CheckReport>,
    /// The static characteristic, if the experiment has one.
    pub sweep: Option<SweepReport>,
    /// The same experiment with other settings.
    pub variants: Vec<VariantReport>,
    /// Rotors outside the validity of their theory; left out if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside_theory: Vec<ValidityReport>,
    /// Warnings about the accuracy of the numbers.
    pub warnings: Vec<String>,
    /// Messages of scripts, if there are any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub messages: Vec<MessageReport>,
    /// Changes of the model by clients and scripts, if there are any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<ChangeReport>,
    /// Wall time `[s]`.
    #[serde(with = "number")]
    pub wall_time_s: f64,
    /// Simulated time by wall time.
    #[serde(with = "number")]
    pub real_time_factor: f64,
}

/// One rotor outside what its theory holds for, for one reason.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ValidityReport {
    /// Its path.
    pub rotor: String,
    /// Reason in words: `steep descent`.
    pub reason: String,
    /// Base steps that ended so.
    pub steps: u64,
    /// Their time in all `[s]`.
    pub duration: f64,
    /// End of the first such step `[s]`.
    pub first: f64,
    /// End of the last `[s]`.
    pub last: f64,
}

impl From<&ValidityViolation> for ValidityReport {
    fn from(o: &ValidityViolation) -> Self {
        let (rotor, reason) = (o.rotor.clone(), o.reason.word().to_owned());
        Self { rotor, reason, steps: o.steps, duration: o.duration, first: o.first, last: o.last }
    }
}

/// Message of a script.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MessageReport {
    /// When `[s]`.
    pub t: f64,
    /// Path of the script's object.
    pub object: String,
    /// Text of the message.
    pub text: String,
}

/// A number of the model that a client or script has changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChangeReport {
    /// From when on `[s]`; 0 also for what was changed before the run.
    pub t: f64,
    /// Path of the object; `/` for the world.
    pub object: String,
    /// Which number, as in the scene file: `mass`, `center_of_mass`, `inertia` (xx, xy, xz, yy, yz, zz), `limits`
    /// (lower, upper), `coupling` (ratio, offset); `gravity`; `respondable` (0: it passes through all others).
    pub quantity: String,
    /// Present value.
    pub value: Vec<f64>,
}

/// Status of a run at its end.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// assert_eq!(Status::Completed.stopped_at(), None);
/// let stopped = Status::Stopped { tick: 40, time: 0.2, reason: "the motor burns".into(), help: String::new() };
/// assert_eq!(stopped.stopped_at(), Some(0.2)); // [s]
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "state", rename_all = "kebab-case")]
pub enum Status {
    /// It lasted its duration.
    Completed,
    /// It came to a bound at which it was to end: of `stop_when`, or of a check that wants a divergence.
    Ended {
        /// The tick.
        tick: u64,
        /// Its time `[s]`.
        time: f64,
        /// Which signal left which bound.
        reason: String,
    },
    /// It could not go on.
    Stopped {
        /// The last good tick.
        tick: u64,
        /// Its time `[s]`.
        time: f64,
        /// Cause, with the element concerned.
        reason: String,
        /// The setting that mends it; may be empty.
        help: String,
    },
    /// The user ended it.
    Interrupted {
        /// The last tick.
        tick: u64,
        /// Its time `[s]`.
        time: f64,
    },
}

impl Status {
    /// When it ended before its duration `[s]`, as [`crate::check::evaluate`] wants it.
    #[must_use]
    pub fn stopped_at(&self) -> Option<f64> {
        match self {
            Self::Completed => None,
            Self::Ended { time, .. } | Self::Stopped { time, .. } | Self::Interrupted { time, .. } => Some(*time),
        }
    }

    /// Returns true if it came to its end, or to a bound at which it was to end.
    #[must_use]
    pub fn is_good(&self) -> bool {
        matches!(self, Self::Completed | Self::Ended { .. })
    }
}

/// Settings of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The integrator that ran, not `auto`.
    pub integrator: String,
    /// Base step `[s]`.
    pub step: f64,
    /// Local tolerance of variable-step methods.
    pub accuracy: f64,
    /// Requested simulated time `[s]`.
    pub duration: f64,
    /// Base steps a recorded row.
    pub record_every: u64,
    /// Seed of everything random.
    pub seed: u64,
    /// Overrides of the files, in the order of setting.
    pub overrides: Vec<Override>,
}

/// A setting `--set PATH=VALUE` of the run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Override {
    /// Path of the number that was set.
    pub path: String,
    /// To what, as it was written.
    pub value: String,
}

/// A recorded signal and how well it is known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColumnReport {
    /// Its path: `/shoulder.position`.
    pub path: String,
    /// Its unit.
    pub unit: String,
    /// Estimated integration error, in the same unit; none if it was not estimated.
    pub error_bar: Option<f64>,
    /// Method of the estimate, or the reason for its absence.
    pub error_bar_method: String,
}

/// The balance of energy over a run `[J]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyReport {
    /// Kinetic energy at the start.
    #[serde(with = "number")]
    pub kinetic_start: f64,
    /// Kinetic energy at the end.
    #[serde(with = "number")]
    pub kinetic_end: f64,
    /// Potential energy at the start: gravity and springs.
    #[serde(with = "number")]
    pub potential_start: f64,
    /// Potential energy at the end.
    #[serde(with = "number")]
    pub potential_end: f64,
    /// Work done by motors and applied torques.
    #[serde(with = "number")]
    pub work: f64,
    /// Energy taken by dampers and friction.
    #[serde(with = "number")]
    pub dissipated: f64,
    /// Greatest |total − total(0) − work + dissipated| during the run.
    #[serde(with = "number")]
    pub residual: f64,
}

/// A check of the experiment with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckReport {
    /// Its name.
    pub name: String,
    /// Description of the comparison.
    pub about: String,
    /// The judgement.
    pub verdict: VerdictReport,
    /// Reason for which it was not made, or the number that is not finite.
    pub reason: Option<String>,
    /// The value measured.
    pub measured: Option<f64>,
    /// The value expected.
    pub expected: Option<f64>,
    /// True if the expected value is a bound.
    #[serde(default)]
    pub sense: Sense,
    /// Deviation between them.
    pub deviation: Option<f64>,
    /// Tolerance.
    pub limit: f64,
    /// True if deviation and limit are relative.
    pub relative: bool,
    /// Unit of measured and expected; empty if not known.
    pub unit: String,
    /// Time `[s]` of the measured value; in a sweep, the value of the parameter.
    pub at: Option<f64>,
    /// Number of rows that entered.
    pub n_rows: usize,
}

/// The judgement of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VerdictReport {
    /// Within its limit.
    Holds,
    /// Beyond it, or not finite.
    Fails,
    /// Nothing to compare.
    NotMade,
}

impl From<&Outcome> for CheckReport {
    fn from(outcome: &Outcome) -> Self {
        let (verdict, reason) = match &outcome.verdict {
            Verdict::Holds => (VerdictReport::Holds, None),
            Verdict::Fails => (VerdictReport::Fails, not_finite_reason(outcome)),
            Verdict::NotMade(reason) => (VerdictReport::NotMade, Some(reason.clone())),
        };
        Self {
            name: outcome.name.clone(),
            about: outcome.about.clone(),
            verdict,
            reason,
            measured: outcome.measured,
            expected: outcome.expected,
            sense: outcome.sense,
            deviation: outcome.deviation,
            limit: outcome.limit,
            relative: outcome.relative,
            unit: outcome.unit.clone(),
            at: outcome.at,
            n_rows: outcome.n_rows,
        }
    }
}

/// `the deviation is inf: measured 1, expected 0`, where a number is not finite.
fn not_finite_reason(outcome: &Outcome) -> Option<String> {
    let (deviation, measured, expected) = (outcome.deviation?, outcome.measured?, outcome.expected?);
    let reason = || format!("the deviation is {deviation}: measured {measured}, expected {expected}");
    (!deviation.is_finite()).then(reason)
}

/// Final values over a swept parameter: the static characteristic.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepReport {
    /// Parameter that was varied.
    pub parameter: String,
    /// Its unit; may be empty.
    pub unit: String,
    /// Number of runs.
    pub n_runs: usize,
    /// The columns of `sweep.csv` after the parameter, in their order.
    pub columns: Vec<ColumnReport>,
    /// The runs that stopped.
    pub stops: Vec<SweepStopReport>,
    /// Audit of its runs: of each law the worst value.
    #[serde(default)]
    pub audit: AuditReport,
    /// Checks with their measured values.
    pub checks: Vec<CheckReport>,
}

/// A run of a sweep that stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepStopReport {
    /// The value of the parameter.
    pub value: f64,
    /// When `[s]`.
    pub time: f64,
    /// Reason.
    pub reason: String,
}

impl SweepReport {
    /// Report of a sweep and of the outcomes of its checks; error bars are not estimated.
    #[must_use]
    pub fn new(sweep: &Sweep, outcomes: &[Outcome]) -> Self {
        let stops = sweep.stops.iter().map(|stop| SweepStopReport {
            value: sweep.values[stop.run_idx],
            time: stop.time,
            reason: stop.reason.clone(),
        });
        Self {
            parameter: sweep.parameter.clone(),
            unit: sweep.unit.clone(),
            n_runs: sweep.values.len(),
            columns: sweep.columns.iter().map(|c| ColumnReport::without_error_bar(&c.name, &c.unit)).collect(),
            stops: stops.collect(),
            audit: sweep.audit.clone(),
            checks: outcomes.iter().map(CheckReport::from).collect(),
        }
    }
}

/// The same experiment with other settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariantReport {
    /// Its name.
    pub name: String,
    /// Description of the difference.
    pub description: String,
    /// Status at the end of the run.
    pub status: Status,
    /// Settings of the run; the overrides are the variant's own, after those of the command line.
    pub settings: Settings,
    /// Hash of the compiled model, hexadecimal.
    pub model_hash: String,
    /// Hash of the states of all ticks, hexadecimal.
    pub trace_hash: String,
    /// The recorded columns, `t` first.
    pub columns: Vec<ColumnReport>,
    /// The balance of energy.
    pub energy: Option<EnergyReport>,
    /// Its audit.
    #[serde(default)]
    pub audit: AuditReport,
    /// Checks with their measured values.
    pub checks: Vec<CheckReport>,
    /// Rotors outside the validity of their theory; left out if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside_theory: Vec<ValidityReport>,
    /// Warnings about the accuracy of the numbers.
    pub warnings: Vec<String>,
    /// Wall time `[s]`.
    #[serde(with = "number")]
    pub wall_time_s: f64,
}

impl ColumnReport {
    /// A column without an estimate of its error.
    #[must_use]
    pub fn without_error_bar(path: &str, unit: &str) -> Self {
        Self { path: path.into(), unit: unit.into(), error_bar: None, error_bar_method: "not estimated".into() }
    }

    /// All columns of a table, without estimates.
    #[must_use]
    pub fn of_table(table: &Table) -> Vec<Self> {
        table.columns.iter().map(|column| Self::without_error_bar(&column.name, &column.unit)).collect()
    }
}

impl RunReport {
    /// Audits of all runs: of the main run, of the sweep, of each variant.
    pub fn audits(&self) -> impl Iterator<Item = &AuditReport> {
        let sweep = self.sweep.iter().map(|sweep| &sweep.audit);
        [&self.audit].into_iter().chain(sweep).chain(self.variants.iter().map(|variant| &variant.audit))
    }

    /// Findings of all runs, each with the name of its run; empty for the main run.
    pub fn findings(&self) -> impl Iterator<Item = (&str, &Finding)> {
        let sweep = self.sweep.iter().map(|sweep| ("sweep", &sweep.audit));
        let variants = self.variants.iter().map(|variant| (variant.name.as_str(), &variant.audit));
        let audits = std::iter::once(("", &self.audit)).chain(sweep).chain(variants);
        audits.flat_map(|(run, audit)| audit.findings.iter().map(move |finding| (run, finding)))
    }

    /// Text of the file `run.json`.
    #[must_use]
    pub fn to_json(&self) -> String {
        number::to_json(self)
    }

    /// Writes `run.json` into a folder, whole or not at all.
    ///
    /// # Errors
    ///
    /// The file cannot be written.
    pub fn write(&self, out_dir: &Path) -> Result<(), FileError> {
        file::write_atomically(&out_dir.join("run.json"), self.to_json().as_bytes())
    }

    /// Reads `run.json` of a folder. A number that was not finite is NaN, or none.
    ///
    /// # Errors
    ///
    /// The file cannot be read or is none of ours.
    pub fn read(out_dir: &Path) -> Result<Self, FileError> {
        let path = out_dir.join("run.json");
        let text = std::fs::read_to_string(&path).map_err(|e| FileError::new("read", &path, e))?;
        serde_json::from_str(&text).map_err(|e| FileError::new("read", &path, e))
    }
}

#[cfg(test)]
mod tests;
