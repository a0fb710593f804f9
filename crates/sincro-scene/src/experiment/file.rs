//! The experiment file as it is written. Doc comments here become the descriptions in the JSON Schema.

use std::collections::BTreeMap;

#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::Integrator;
use super::check::Measure;

/// An experiment: what is run, recorded and checked. SI units and radians.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(title = "sincro experiment"))]
pub(crate) struct ExperimentFile {
    /// Version of the format: 2, or 1 where it is left out.
    #[allow(dead_code)] // read from the document
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub format: u64,
    /// Title of the report.
    pub title: String,
    /// One or two sentences that stand under the title.
    #[serde(default)]
    pub description: String,
    /// Scene file, its path relative to the folder.
    #[serde(default = "scene_toml")]
    pub scene: String,
    /// Diagram file of the controller, its path relative to the folder.
    #[allow(dead_code)] // read from the document, with its position
    pub diagram: Option<String>,
    /// How long is simulated: a whole number of steps [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub duration: f64,
    /// Base step: commands are held over it, rows are recorded at its ends [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub step: f64,
    /// V-REP's simulation time step, at which child scripts are called and remote clients step: a whole number of base steps; one base
    /// step if left out [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub simulation_step: Option<f64>,
    /// Base steps for each recorded row.
    #[serde(default = "one")]
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub record_every: u64,
    /// How the equations of motion are integrated.
    #[serde(default)]
    pub integrator: Integrator,
    /// Local tolerance of the variable-step methods.
    #[serde(default = "fine")]
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub accuracy: f64,
    /// How the error bar of the recorded signals is found.
    #[serde(default)]
    pub error_bar: ErrorBarFile,
    /// Seed of everything random.
    #[serde(default)]
    pub seed: u64,
    /// Names of the signals to be recorded, such as `/shoulder.position` or `energy.total`.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub record: Vec<String>,
    /// Units of recorded float signals of scripts and clients, by name; all other signals have their own.
    #[serde(default)]
    pub units: BTreeMap<String, String>,
    /// Names and numbers for formulas.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
    /// What must come out.
    #[serde(default)]
    pub check: Vec<CheckFile>,
    /// A static characteristic: the run is repeated over a parameter, and final values are recorded.
    pub sweep: Option<SweepFile>,
    /// A campaign of runs, which `sincro sweep` makes of this folder: the keys of a plan file without `scene`.
    #[allow(dead_code)] // read by whoever runs campaigns
    #[cfg_attr(test, schemars(with = "Option<BTreeMap<String, Value>>"))]
    pub campaign: Option<Value>,
    /// The same experiment with other settings.
    #[serde(default)]
    pub variant: Vec<VariantFile>,
    /// Bounds at which the run ends: no failure, but nothing more to be seen.
    #[serde(default)]
    pub stop_when: Vec<StopFile>,
    /// Plots of the report; one for each recorded unit if none is given.
    #[serde(default)]
    pub plot: Vec<PlotFile>,
    /// A task for reinforcement learning.
    pub task: Option<super::task_file::TaskFile>,
}

/// How the error bar of the recorded signals is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ErrorBarFile {
    /// By a second run with a finer step or tolerance, and a third where several sets of contact forces keep all laws.
    #[default]
    Refine,
    /// Not at all.
    None,
}

/// One expectation.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("allOf" = [
    {"oneOf": [{"required": ["signal"]}, {"required": ["signals"]}]},
    {"oneOf": [
        {"required": ["value"]}, {"required": ["reference"]}, {"required": ["at_most"]}, {"required": ["at_least"]},
        {"required": ["diverges"]}
    ]},
    {"not": {"required": ["at", "window"]}}
])))]
pub(crate) struct CheckFile {
    /// What the report calls it.
    pub name: String,
    /// The recorded signal that is checked.
    pub signal: Option<String>,
    /// Short names of recorded signals, for `formula` and `value`.
    pub signals: Option<BTreeMap<String, String>>,
    /// What is checked: a formula of the short names, `t` and the parameters.
    pub formula: Option<String>,
    /// Unit of the formula, such as `N·m`, where it does not follow from those of its signals.
    pub unit: Option<String>,
    /// What it must be: a number or a formula.
    pub value: Option<NumberOrFormula>,
    /// What it must be: a column of a CSV file.
    pub reference: Option<ReferenceFile>,
    /// What it must not exceed: a number or a formula.
    pub at_most: Option<NumberOrFormula>,
    /// What it must not fall below: a number or a formula.
    pub at_least: Option<NumberOrFormula>,
    /// Holds if the signal leaves a bound: its magnitude becomes greater than this number, or formula of the parameters, and within the
    /// `window` for the first time. The run ends there.
    pub diverges: Option<NumberOrFormula>,
    /// What of the series is compared.
    #[serde(default)]
    pub measure: MeasureFile,
    /// Of `overshoot`, `rise-time` and `settling-time`: where the step ends, a number or a formula of the parameters; default the
    /// last row.
    pub target: Option<NumberOrFormula>,
    /// Of `settling-time`: half the width of the band around the target, as a share of the step's height; default 0.02.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub band: Option<f64>,
    /// The one time that is looked at [s]; in a sweep, the one value of the parameter.
    pub at: Option<f64>,
    /// First and last time that are looked at [s], default all; in a sweep, values of the parameter.
    pub window: Option<[f64; 2]>,
    /// With `value` or `reference`: largest difference that holds, in the unit of what is checked (without unit if `relative`).
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub tolerance: Option<f64>,
    /// Whether the difference is divided by max(|expected|, floor).
    #[serde(default)]
    pub relative: bool,
    /// Least divisor of a relative difference.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub floor: Option<f64>,
}

/// A number or a formula.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub(crate) enum NumberOrFormula {
    /// A number.
    Number(f64),
    /// A formula of the short names, `t` and the parameters.
    Formula(String),
}

/// A column of a CSV file.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("not" = {"required": ["time", "parameter"]})))]
pub(crate) struct ReferenceFile {
    /// CSV file, its path relative to the folder.
    pub file: String,
    /// Column of times; default `t`.
    pub time: Option<String>,
    /// In a sweep: column of the values of the swept parameter.
    pub parameter: Option<String>,
    /// Column of values.
    pub column: String,
    /// Factor on the values.
    #[serde(default = "unity")]
    pub scale: f64,
    /// Added after scaling.
    #[serde(default)]
    pub offset: f64,
}

/// What of a series is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum MeasureFile {
    /// Every row; the largest difference counts.
    #[default]
    Error,
    /// The last row.
    Final,
    /// Mean over time.
    Mean,
    /// Least value.
    Min,
    /// Greatest value.
    Max,
    /// Greatest absolute value.
    MaxAbs,
    /// Root of the mean square over time.
    Rms,
    /// Standard deviation over time.
    Std,
    /// Integral over time: trapezoidal rule; of `motor_torque` the sum of the means over the steps.
    Integral,
    /// Time of the least value [s].
    TimeOfMin,
    /// Time of the greatest value [s].
    TimeOfMax,
    /// How far a step response goes beyond its target, as a share of the step's height.
    Overshoot,
    /// Time from 10 % to 90 % of the step's height [s].
    RiseTime,
    /// Time until a step response stays within a band around its target [s].
    SettlingTime,
}

impl From<MeasureFile> for Measure {
    fn from(file: MeasureFile) -> Self {
        match file {
            MeasureFile::Error => Self::Error,
            MeasureFile::Final => Self::Final,
            MeasureFile::Mean => Self::Mean,
            MeasureFile::Min => Self::Min,
            MeasureFile::Max => Self::Max,
            MeasureFile::MaxAbs => Self::MaxAbs,
            MeasureFile::Rms => Self::Rms,
            MeasureFile::Std => Self::Std,
            MeasureFile::Integral => Self::Integral,
            MeasureFile::TimeOfMin => Self::TimeOfMin,
            MeasureFile::TimeOfMax => Self::TimeOfMax,
            MeasureFile::Overshoot => Self::Overshoot,
            MeasureFile::RiseTime => Self::RiseTime,
            MeasureFile::SettlingTime => Self::SettlingTime,
        }
    }
}

/// A bound at which the run ends. Recorded rows are looked at.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["above"]}, {"required": ["below"]}, {"required": ["beyond"]}])))]
pub(crate) struct StopFile {
    /// The recorded signal.
    pub signal: String,
    /// The run ends when the signal is greater than this number, or formula of the parameters.
    pub above: Option<NumberOrFormula>,
    /// The run ends when the signal is less.
    pub below: Option<NumberOrFormula>,
    /// The run ends when the magnitude of the signal is greater.
    pub beyond: Option<NumberOrFormula>,
}

/// Repeats the run over a parameter and records final values.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("oneOf" = [{"required": ["range"]}, {"required": ["values"]}])))]
pub(crate) struct SweepFile {
    /// What is varied: a path as for `--set`.
    pub parameter: String,
    /// More paths that take the same value: a parameter of the diagram that goes with a key of the scene.
    #[serde(default)]
    pub also: Vec<String>,
    /// Evenly spaced values.
    pub range: Option<RangeFile>,
    /// The values themselves.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub values: Option<Vec<f64>>,
    /// What must come out over the whole sweep.
    #[serde(default)]
    pub check: Vec<CheckFile>,
}

/// Evenly spaced values, ends included.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct RangeFile {
    /// First value.
    pub from: f64,
    /// Last value: a whole number of steps from the first.
    pub to: f64,
    /// From one to the next.
    pub step: f64,
}

/// The same experiment with other settings, drawn over the main run.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct VariantFile {
    /// Short name for the report and the command line.
    pub name: String,
    /// What is different.
    #[serde(default)]
    pub description: String,
    /// Settings, each as PATH = VALUE of `--set`.
    #[serde(default)]
    pub set: BTreeMap<String, Value>,
    /// Whether the main run's checks are also made on the variant.
    #[serde(default)]
    pub inherit_checks: bool,
    /// What must come out of the variant.
    #[serde(default)]
    pub check: Vec<CheckFile>,
}

/// A plot of the report.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct PlotFile {
    /// Title of the plot.
    pub title: String,
    /// What is drawn: lines over time, or paths in space.
    #[serde(default)]
    pub kind: PlotKindFile,
    /// Recorded signals, one line each, with the variants over them; `NAME:SIGNAL` is that of one variant. Of a path, the vector whose
    /// three components are recorded, such as `/drone.position`.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub signals: Vec<String>,
    /// Drawn over the first signal; default what the checks compare it with.
    pub reference: Option<ReferenceFile>,
    /// What the panel below shows: the difference from what is expected, or that of the variants from the main run; default the first,
    /// where something is expected.
    pub difference: Option<DifferenceFile>,
    /// Names of the variants that are drawn; default all.
    pub variants: Option<Vec<String>>,
}

/// What a plot draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum PlotKindFile {
    /// Signals over time.
    #[default]
    Lines,
    /// Positions in space, in parallel projection, with their shadows on the floor.
    Path,
}

/// Difference from what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum DifferenceFile {
    /// Of the main run from what is expected.
    Reference,
    /// Of the variants from the main run.
    Variants,
}

fn scene_toml() -> String {
    "scene.toml".into()
}

fn one() -> u64 {
    1
}

fn fine() -> f64 {
    1e-9
}

fn unity() -> f64 {
    1.0
}
