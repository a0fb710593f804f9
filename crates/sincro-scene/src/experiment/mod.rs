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

/// Smallest useful accuracy of the variable-step methods: below, the rounding of double precision in a step is larger
/// than its tolerance, and the steps become shorter without end.
pub const SMALLEST_ACCURACY: f64 = 1e-14;

/// An experiment: everything about a run but the scene.
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
    /// The scene file; the folder is part of it.
    pub scene_path: PathBuf,
    /// Simulated time `[s]`.
    pub duration: f64,
    /// Base step `[s]`.
    pub step: f64,
    /// Base steps in `duration`; at least one.
    pub n_steps: u64,
    /// Base steps from one call of the scripts to the next, and in one step of remote clients; at least one.
    pub simulation_ticks: u64,
    /// Base steps for each recorded row; at least one.
    pub record_every: u64,
    /// Integration method of the equations of motion.
    pub integrator: Integrator,
    /// Local tolerance of the variable-step methods.
    pub accuracy: f64,
    /// Estimate of the error bar of the recorded signals.
    pub error_bar: ErrorBar,
    /// Seed of everything random.
    pub seed: u64,
    /// Names of the recorded signals; not empty, no name twice.
    pub record: Vec<Located<String>>,
    /// Names and numbers for formulas.
    pub parameters: BTreeMap<String, f64>,
    /// Bounds at which the run ends before its duration.
    pub stops: Vec<StopWhen>,
    /// Checks of the run.
    pub checks: Vec<Check>,
    /// Repeats the run over a parameter.
    pub sweep: Option<Sweep>,
    /// The same experiment with other settings.
    pub variants: Vec<Variant>,
    /// Plots of the report; empty if the report is to choose.
    pub plots: Vec<Plot>,
    /// A task for reinforcement learning, if there is one.
    pub task: Option<Arc<Task>>,
}

impl Experiment {
    /// Drops variants, sweep, and all that plots draw of other runs: what is left is one run.
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

/// Integration method of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Integrator {
    /// Chosen for the scene; second order or better.
    Auto,
    /// Semi-implicit Euler at the base step.
    SemiImplicitEuler,
    /// The classical Runge–Kutta method at the base step.
    Rk4,
    /// Springs and dampers implicit, at the base step.
    Implicit,
    /// Explicit pair of order 5(4) with error control.
    DormandPrince,
    /// Implicit with error control.
    Stiff,
}

impl Integrator {
    /// The word in the file.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::SemiImplicitEuler => "semi-implicit-euler",
            Self::Rk4 => "rk4",
            Self::Implicit => "implicit",
            Self::DormandPrince => "dormand-prince",
            Self::Stiff => "stiff",
        }
    }
}

/// Estimate of the error bar of the recorded signals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ErrorBar {
    /// By a second, finer run.
    Refine,
    /// Not at all.
    None,
}

/// A static characteristic: the run is repeated over a parameter, and final values are recorded.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Parameter that is varied: a path as for `--set`.
    pub parameter: Located<String>,
    /// Further numbers that take the same value.
    pub also: Vec<Located<String>>,
    /// Its values, in the order in which they are run.
    pub values: Vec<f64>,
    /// Checks over the whole sweep.
    pub checks: Vec<Check>,
}

impl Sweep {
    /// Settings for one value of the parameter, in its unit, to be added to those the experiment was loaded with.
    pub fn settings(&self, value: f64) -> impl Iterator<Item = Override> {
        std::iter::once(&self.parameter).chain(&self.also).map(move |path| {
            let number = Override::new(&path.value, &format!("{value:?}"));
            Override { path: path.clone(), ..number }
        })
    }
}

/// The same experiment with other settings: load it again with `set` added to the settings.
///
/// Its checks then stand in that experiment's variant of the same name, with the variant's parameters.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Short name, letters, digits, `_`, `-` and `.`; none twice.
    pub name: String,
    /// Description of the difference; may be empty.
    pub description: String,
    /// The settings, in the order of their paths.
    pub set: Vec<Override>,
    /// True if the main run's checks are also made on the variant.
    pub inherit_checks: bool,
    /// Checks of the variant.
    pub checks: Vec<Check>,
    /// Its name in the file.
    pub location: Location,
}

/// A plot of the report.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Its title.
    pub title: String,
    /// True if it shows paths in space: its signals are then vectors, see [`path_components`].
    pub is_path: bool,
    /// Recorded signals, one line each; at least one.
    pub signals: Vec<Located<String>>,
    /// Drawn over the first signal; if none is given, what the checks compare that signal with.
    pub reference: Option<Reference>,
    /// True if the panel below shows how the variants differ from the main run; none: as it fits.
    pub compares_variants: Option<bool>,
    /// Names of the variants that are drawn; none: all.
    pub variants: Option<Vec<String>>,
}

/// Names that the components of a vector in space may be recorded under: `/drone.position.x` …, or `block[0]` ….
#[must_use]
pub fn path_components(vector: &str) -> [[String; 3]; 2] {
    [["x", "y", "z"].map(|a| format!("{vector}.{a}")), ["0", "1", "2"].map(|k| format!("{vector}[{k}]"))]
}
