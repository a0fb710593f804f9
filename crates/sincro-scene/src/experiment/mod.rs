//! Experiment file, resolved: duration, recorded signals, checks, variants, sweep.
//!
//! Names of recorded signals are kept as they were written, with their places; whoever knows the model resolves them.

pub mod check;
mod checks;
mod file;
mod grid;
mod resolve;
mod sample_times;
mod schema;
pub mod stop;
pub mod task;
mod task_file;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

#[cfg(test)]
pub(crate) use file::ExperimentFile;
pub(crate) use grid::short;
pub(crate) use resolve::resolve;
pub(crate) use sample_times::check_sample_times;
pub use schema::experiment_schema;

use crate::diagnostic::{Located, Location};
use crate::overrides::Override;
use check::{Check, Reference};
use stop::StopWhen;
use task::Task;

/// Smallest useful accuracy (relative local error tolerance, dimensionless) of the variable-step methods: below, the
/// rounding of double precision in a step is larger than its tolerance, and the steps become shorter without end.
pub const SMALLEST_ACCURACY: f64 = 1e-14;

/// Experiment: everything about a run but the scene, read from `experiment.toml` by [`crate::open::open`].
///
/// ```
/// use sincro_scene::prelude::*;
///
/// # fn main() -> Result<(), Diagnostics> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/double-pendulum");
/// let experiment: Experiment = open(folder.as_ref(), &[], Default::default(), true)?.experiment;
/// assert_eq!(experiment.n_steps as f64, (experiment.duration / experiment.step).round());
/// assert!(experiment.record.iter().any(|name| name.value == "energy.balance"));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Title of the report.
    pub title: String,
    /// Description under the title; may be empty.
    pub description: String,
    /// Path of the scene file, the folder included.
    pub scene_path: PathBuf,
    /// Simulated time of the run `[s]`.
    pub duration: f64,
    /// Base step: the period of a tick `[s]`.
    pub step: f64,
    /// Base steps in `duration`; at least one.
    pub n_steps: u64,
    /// Base steps between two calls of the scripts, and in one step of remote clients; at least one.
    pub simulation_ticks: u64,
    /// Base steps for each recorded row; at least one.
    pub record_every: u64,
    /// Integration method of the equations of motion.
    pub integrator: Integrator,
    /// Local error tolerance of the variable-step methods, relative (dimensionless).
    pub accuracy: f64,
    /// Estimate of the error bar of the recorded signals.
    pub error_bar: ErrorBar,
    /// Seed of everything random in the run.
    pub seed: u64,
    /// Names of the recorded signals, in the order of the columns; not empty, no name twice.
    pub record: Vec<Located<String>>,
    /// Units of recorded float signals, by the name of the column.
    pub units: BTreeMap<String, String>,
    /// Parameters of the formulas in the scene's files: name and value, in the unit that the formulas give them.
    pub parameters: BTreeMap<String, f64>,
    /// Stop conditions: bounds at which the run ends before its duration.
    pub stops: Vec<StopWhen>,
    /// Checks of the main run, in the order of the file.
    pub checks: Vec<Check>,
    /// Repetition of the run over a parameter, if there is one.
    pub sweep: Option<Sweep>,
    /// Variants: the same experiment with other settings, in the order of the file.
    pub variants: Vec<Variant>,
    /// Plots of the report; empty if the report is to choose.
    pub plots: Vec<Plot>,
    /// Task for reinforcement learning, if there is one.
    pub task: Option<Arc<Task>>,
}

impl Experiment {
    /// Removes variants, sweep, and all that plots draw of other runs, so that the experiment is a single run.
    pub fn keep_one_run(&mut self) {
        self.variants.clear();
        self.sweep = None;
        for plot in &mut self.plots {
            plot.signals.retain(|signal| !signal.value.contains(':'));
            plot.variants = None;
        }
        self.plots.retain(|plot| !plot.signals.is_empty());
    }
}

/// Integration method of the equations of motion, key `integrator` of the experiment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Chosen for the scene by stiffness, elements and accuracy; of second order or better.
    #[default]
    Auto,
    /// Semi-implicit Euler method at the base step; first order, as game engines do.
    SemiImplicitEuler,
    /// Classical Runge–Kutta method at the base step; fourth order.
    Rk4,
    /// Method at the base step that treats springs and dampers implicitly, for stiff scenes.
    Implicit,
    /// Explicit Dormand–Prince pair of order 5(4) with error control.
    DormandPrince,
    /// Explicit Dormand–Prince method of order 8(5,3) (DOP853) with error control: fewer steps at high accuracy.
    #[serde(rename = "dormand-prince-8")]
    DormandPrince8,
    /// Linearly implicit extrapolation with error control, for stiff scenes.
    Stiff,
}

impl Integrator {
    /// Returns the name of the method in the file: `auto`, `semi-implicit-euler`, `rk4`, `implicit`, `dormand-prince`,
    /// `dormand-prince-8` or `stiff`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::SemiImplicitEuler => "semi-implicit-euler",
            Self::Rk4 => "rk4",
            Self::Implicit => "implicit",
            Self::DormandPrince => "dormand-prince",
            Self::DormandPrince8 => "dormand-prince-8",
            Self::Stiff => "stiff",
        }
    }
}

/// Method by which the integration error of the recorded signals is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ErrorBar {
    /// Comparison with a second, finer run.
    Refine,
    /// No estimate.
    None,
}

/// Parameter sweep of an experiment: the run is repeated over the values of a parameter, and the final values of the
/// recorded signals are kept (a static characteristic).
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Path of the parameter that is varied, as for `--set`.
    pub parameter: Located<String>,
    /// Paths of further numbers that take the same value.
    pub also: Vec<Located<String>>,
    /// Values of the parameter in its unit, in the order in which they are run.
    pub values: Vec<f64>,
    /// Checks over the whole sweep, the parameter in the place of time.
    pub checks: Vec<Check>,
}

impl Sweep {
    /// Returns the settings for the value `value` of the parameter, in its unit; they are to be added to those that the
    /// experiment was loaded with.
    pub fn settings(&self, value: f64) -> impl Iterator<Item = Override> {
        std::iter::once(&self.parameter).chain(&self.also).map(move |path| {
            let number = Override::new(&path.value, &format!("{value:?}"));
            Override { path: path.clone(), ..number }
        })
    }
}

/// Variant of an experiment: the same files with other settings. To run it, load the experiment again with `set` added
/// to the settings; its checks are then found in that experiment's variant of the same name, with the variant's
/// parameters.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Short name of letters, digits, `_`, `-` and `.`; unique.
    pub name: String,
    /// Description of the difference; may be empty.
    pub description: String,
    /// Settings, in the order of their paths.
    pub set: Vec<Override>,
    /// True if the checks of the main run apply to the variant, too.
    pub inherit_checks: bool,
    /// Checks of the variant alone.
    pub checks: Vec<Check>,
    /// Location of its name in the file, for messages.
    pub location: Location,
}

/// Plot of the report: recorded signals over time, or paths in space.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Title above the plot.
    pub title: String,
    /// True for paths in space: each signal is then a vector of three recorded components, see [`path_components`].
    pub is_path: bool,
    /// Recorded signals, one line each; at least one.
    pub signals: Vec<Located<String>>,
    /// Reference series drawn over the first signal; `None`: the one that the checks compare that signal with, if any.
    pub reference: Option<Reference>,
    /// True if a panel below shows the differences of the variants from the main run; `None`: the report decides.
    pub compares_variants: Option<bool>,
    /// Names of the variants that are drawn; `None`: all.
    pub variants: Option<Vec<String>>,
}

/// Returns the two sets of names under which the x, y and z components of a spatial vector may be recorded: `VECTOR.x`
/// to `VECTOR.z`, and `VECTOR[0]` to `VECTOR[2]`.
#[must_use]
pub fn path_components(vector: &str) -> [[String; 3]; 2] {
    [["x", "y", "z"].map(|a| format!("{vector}.{a}")), ["0", "1", "2"].map(|k| format!("{vector}[{k}]"))]
}
