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

/// Report of a run, the content of `run.json`: settings, status, signals with error bars, checks and findings.
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
/// assert!(report.columns[0].path == "t" && !report.checks.is_empty());
/// assert_eq!(report.trace_hash, done.main.simulated.trace.to_string());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// Version of sincro that made the run.
    pub sincro_version: String,
    /// Name of the scene's folder.
    pub scene: String,
    /// Path of the scene's folder as it was given.
    pub scene_path: String,
    /// Title of the experiment.
    pub title: String,
    /// Status of the main run at its end.
    pub status: Status,
    /// Settings of the main run.
    pub settings: Settings,
    /// Hash of the compiled model, hexadecimal.
    pub model_hash: String,
    /// Hash of the states of all ticks, hexadecimal: the same bits give the same hash.
    pub trace_hash: String,
    /// Degrees of freedom of the mechanism at the start, closed loops counted.
    pub n_dof: usize,
    /// Columns of `signals.csv`, in their order, `t` first.
    pub columns: Vec<ColumnReport>,
    /// Energy balance of the main run.
    pub energy: Option<EnergyReport>,
    /// Audit of the main run.
    #[serde(default)]
    pub audit: AuditReport,
    /// Checks of the main run with their verdicts, in their order.
    pub checks: Vec<CheckReport>,
    /// Report of the sweep, if the experiment has one.
    pub sweep: Option<SweepReport>,
    /// Reports of the variants, in the order of the experiment.
    pub variants: Vec<VariantReport>,
    /// Rotors outside the validity of their theory.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outside_theory: Vec<ValidityReport>,
    /// Warnings about the accuracy of the numbers.
    pub warnings: Vec<String>,
    /// Messages of scripts and controllers, in the order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub messages: Vec<MessageReport>,
    /// Changes of the model by clients and scripts, in the order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub changes: Vec<ChangeReport>,
    /// Wall time of the main run `[s]`.
    #[serde(with = "number")]
    pub wall_time_s: f64,
    /// Simulated time divided by wall time (dimensionless).
    #[serde(with = "number")]
    pub real_time_factor: f64,
    /// Part of the wall time in which the equations were compiled `[s]`; `None` if they were not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compile_time_s: Option<f64>,
}

/// Rotor that ran outside the validity of its theory, for one reason; part of a [`RunReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ValidityReport {
    /// Path of the rotor.
    pub rotor: String,
    /// Reason in English, such as `steep descent`.
    pub reason: String,
    /// Number of base steps that ended outside.
    pub steps: u64,
    /// Total duration of these steps `[s]`.
    pub duration: f64,
    /// Time at the end of the first such step `[s]`.
    pub first: f64,
    /// Time at the end of the last such step `[s]`.
    pub last: f64,
}

impl From<&ValidityViolation> for ValidityReport {
    fn from(o: &ValidityViolation) -> Self {
        let (rotor, reason) = (o.rotor.clone(), o.reason.word().to_owned());
        Self { rotor, reason, steps: o.steps, duration: o.duration, first: o.first, last: o.last }
    }
}

/// Message of a script or controller, part of a [`RunReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MessageReport {
    /// Simulated time of the message `[s]`.
    pub t: f64,
    /// Path of the script's object, or name of the controller.
    pub object: String,
    /// Text of the message.
    pub text: String,
}

/// Change of a number of the model by a client or script, part of a [`RunReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChangeReport {
    /// Simulated time from which the change holds `[s]`; 0 also for changes before the run.
    pub t: f64,
    /// Path of the object; `/` for the world.
    pub object: String,
    /// Name of the quantity, as in the scene file: `mass`, `center_of_mass`, `inertia` (xx, xy, xz, yy, yz, zz),
    /// `limits` (lower, upper), `coupling` (ratio, offset); `gravity`; `respondable` (0: no contact with others).
    pub quantity: String,
    /// New numbers, as many as the quantity has, in the units of the scene file. Of the structure: `added`, `removed`
    /// and
    /// `hung` have none; `momentum` has the jump of the linear `[kg·m/s]` and angular `[kg·m²/s]` momentum of all
    /// bodies,
    /// `energy` that of the energy and the energy lost by joining `[J]`.
    pub value: Vec<f64>,
}

/// Status of a run at its end; part of [`Simulated`](crate::run::Simulated) and of the report.
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
    /// The run lasted its duration.
    Completed,
    /// The run ended as intended, at a bound of `stop_when` or of a check for divergence.
    Ended {
        /// Number of base steps done.
        tick: u64,
        /// Simulated time `[s]`.
        time: f64,
        /// Signal and bound in English.
        reason: String,
    },
    /// The run could not go on.
    Stopped {
        /// Number of base steps up to the last good state.
        tick: u64,
        /// Simulated time of that state `[s]`.
        time: f64,
        /// Cause in English, with the element concerned.
        reason: String,
        /// Remedy, such as the setting that would help; may be empty.
        help: String,
    },
    /// The user ended the run.
    Interrupted {
        /// Number of base steps done.
        tick: u64,
        /// Simulated time `[s]`.
        time: f64,
    },
}

impl Status {
    /// Returns the time `[s]` at which the run stopped or was interrupted, the argument of [`crate::check::evaluate`];
    /// `None` if it completed or ended as intended.
    #[must_use]
    pub fn stopped_at(&self) -> Option<f64> {
        match self {
            Self::Completed => None,
            Self::Ended { time, .. } | Self::Stopped { time, .. } | Self::Interrupted { time, .. } => Some(*time),
        }
    }

    /// Returns true if the run completed, or ended at a bound as intended.
    #[must_use]
    pub fn is_good(&self) -> bool {
        matches!(self, Self::Completed | Self::Ended { .. })
    }
}

/// Settings with which a run was made, part of a [`RunReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Integration method that was used; never `auto`. Where that changed its method, the first one: a warning tells of
    /// the change.
    pub integrator: String,
    /// Base step `[s]`.
    pub step: f64,
    /// Local error tolerance of the variable-step methods (dimensionless).
    pub accuracy: f64,
    /// Requested simulated time `[s]`.
    pub duration: f64,
    /// Number of base steps per recorded row.
    pub record_every: u64,
    /// Seed of everything random.
    pub seed: u64,
    /// Overrides of the files, in the order in which they were applied.
    pub overrides: Vec<Override>,
}

/// Setting `--set PATH=VALUE` of a run, part of its [`Settings`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Override {
    /// Path of the value that was set.
    pub path: String,
    /// New value as it was written.
    pub value: String,
}

/// Recorded signal with its error bar, part of a report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColumnReport {
    /// Name of the signal, such as `/shoulder.position`.
    pub path: String,
    /// Unit as text; may be empty.
    pub unit: String,
    /// Estimated integration error, in `unit`; `None` if it was not estimated.
    pub error_bar: Option<f64>,
    /// Method of the estimate in English, or the reason for its absence.
    pub error_bar_method: String,
}

/// Energy balance of a run, all in `[J]`; part of a [`RunReport`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyReport {
    /// Kinetic energy at the start.
    #[serde(with = "number")]
    pub kinetic_start: f64,
    /// Kinetic energy at the end.
    #[serde(with = "number")]
    pub kinetic_end: f64,
    /// Potential energy of gravity and springs at the start.
    #[serde(with = "number")]
    pub potential_start: f64,
    /// Potential energy at the end.
    #[serde(with = "number")]
    pub potential_end: f64,
    /// Work done by motors and applied forces.
    #[serde(with = "number")]
    pub work: f64,
    /// Energy dissipated by dampers and friction.
    #[serde(with = "number")]
    pub dissipated: f64,
    /// Largest magnitude of total − total at the start − work + dissipated during the run.
    #[serde(with = "number")]
    pub residual: f64,
}

/// Check with its verdict and numbers, part of a report; see [`Outcome`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckReport {
    /// Name of the check.
    pub name: String,
    /// Description of the comparison in English.
    pub about: String,
    /// Verdict on the check.
    pub verdict: VerdictReport,
    /// Reason in English why it was not made, or which number is not finite.
    pub reason: Option<String>,
    /// Measured value, in `unit`.
    pub measured: Option<f64>,
    /// Expected value, in `unit`.
    pub expected: Option<f64>,
    /// Comparison: equal, at most or at least.
    #[serde(default)]
    pub sense: Sense,
    /// Deviation of the measured from the expected value, in `unit`, dimensionless if `relative`.
    pub deviation: Option<f64>,
    /// Largest deviation that holds, in the unit of `deviation`.
    pub limit: f64,
    /// True if deviation and limit are relative.
    pub relative: bool,
    /// Unit of measured and expected; empty if not known.
    pub unit: String,
    /// Time `[s]` of the measured value; in a sweep, value of the parameter.
    pub at: Option<f64>,
    /// Number of rows that were evaluated.
    pub n_rows: usize,
}

/// Verdict on a check, as `run.json` names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VerdictReport {
    /// The deviation is within its limit.
    Holds,
    /// The deviation is beyond its limit or not finite.
    Fails,
    /// The check could not be made.
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

/// Report of a parameter sweep: which signals were recorded over the parameter, and the checks; part of a
/// [`RunReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepReport {
    /// Path of the parameter that was varied.
    pub parameter: String,
    /// Unit of the parameter; may be empty.
    pub unit: String,
    /// Number of runs.
    pub n_runs: usize,
    /// Columns of `sweep.csv` behind the parameter, in their order.
    pub columns: Vec<ColumnReport>,
    /// Runs that stopped, in the order in which they were run.
    pub stops: Vec<SweepStopReport>,
    /// Audit of its runs: of each law the worst value.
    #[serde(default)]
    pub audit: AuditReport,
    /// Checks of the sweep with their verdicts, in their order.
    pub checks: Vec<CheckReport>,
}

/// Run of a sweep that stopped, part of a [`SweepReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepStopReport {
    /// Value of the parameter, in its unit.
    pub value: f64,
    /// Simulated time at which it stopped `[s]`.
    pub time: f64,
    /// Reason in English.
    pub reason: String,
}

impl SweepReport {
    /// Creates the report of a sweep and of the outcomes of its checks; error bars are not estimated.
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

/// Report of a variant: the same experiment with other settings; part of a [`RunReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariantReport {
    /// Name of the variant.
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
    /// Energy balance of the run.
    pub energy: Option<EnergyReport>,
    /// Audit of the variant's run.
    #[serde(default)]
    pub audit: AuditReport,
    /// Checks with their verdicts, in their order.
    pub checks: Vec<CheckReport>,
    /// Rotors outside the validity of their theory.
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
    pub(crate) fn without_error_bar(path: &str, unit: &str) -> Self {
        Self { path: path.into(), unit: unit.into(), error_bar: None, error_bar_method: "not estimated".into() }
    }

    /// Creates the reports of all columns of a table, in their order, without error bars.
    #[must_use]
    pub fn of_table(table: &Table) -> Vec<Self> {
        table.columns.iter().map(|column| Self::without_error_bar(&column.name, &column.unit)).collect()
    }
}

impl RunReport {
    /// Returns the audits of all runs, in this order: main run, sweep if there is one, each variant.
    pub fn audits(&self) -> impl Iterator<Item = &AuditReport> {
        let sweep = self.sweep.iter().map(|sweep| &sweep.audit);
        [&self.audit].into_iter().chain(sweep).chain(self.variants.iter().map(|variant| &variant.audit))
    }

    /// Returns the findings of all runs, each with the name of its run; the name is empty for the main run.
    pub fn findings(&self) -> impl Iterator<Item = (&str, &Finding)> {
        let sweep = self.sweep.iter().map(|sweep| ("sweep", &sweep.audit));
        let variants = self.variants.iter().map(|variant| (variant.name.as_str(), &variant.audit));
        let audits = std::iter::once(("", &self.audit)).chain(sweep).chain(variants);
        audits.flat_map(|(run, audit)| audit.findings.iter().map(move |finding| (run, finding)))
    }

    /// Returns the text of `run.json`: the report as indented JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        number::to_json(self)
    }

    /// Writes `run.json` into the folder `out_dir`, atomically.
    ///
    /// # Errors
    ///
    /// [`FileError`] with the path of the file that cannot be written.
    pub fn write(&self, out_dir: &Path) -> Result<(), FileError> {
        file::write_atomically(&out_dir.join("run.json"), self.to_json().as_bytes())
    }

    /// Reads `run.json` of the folder `out_dir`. A number that was not finite is NaN, or `None` where it may be absent.
    ///
    /// # Errors
    ///
    /// [`FileError`] with the path of the file that cannot be read or is no report of this program.
    pub fn read(out_dir: &Path) -> Result<Self, FileError> {
        let path = out_dir.join("run.json");
        let text = std::fs::read_to_string(&path).map_err(|e| FileError::new("read", &path, e))?;
        serde_json::from_str(&text).map_err(|e| FileError::new("read", &path, e))
    }
}

#[cfg(test)]
mod tests;
