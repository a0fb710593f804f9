//! A whole run with its variants, error bars, checks and audit.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use sincro::{Campaign, Override, Verdict};
use sincro_scene::experiment::ErrorBar;
use sincro_sim::Loaded;
use sincro_sim::campaign::{CompletedRun, run_campaign};
use sincro_sim::result_folder::{FolderError, ResultFolder};
use sincro_sim::results::Status;
use sincro_sim::run::RunError;

use crate::function::{Function, Raised};
use crate::live::{raised, with_functions};
use crate::{errors, foreground};

/// Parts of a run that may be left out.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    /// Estimate the error bars by a second, finer run.
    pub error_bars: bool,
    /// Run the variants and the sweep of the experiment.
    pub variants: bool,
}

/// Runs an experiment in memory. An exception of a Python function is raised with what was recorded as its `run`.
pub fn run(
    py: Python<'_>,
    (folder, overrides, loaded): (&Path, &[Override], &Loaded),
    functions: &[Arc<Function>],
    parts: Parts,
) -> PyResult<Run> {
    let slot = Raised::default();
    let mut loaded = with_functions(loaded, functions, &slot);
    // a function with a memory of its own cannot be run twice
    let is_repeatable = functions.iter().all(|function| function.is_repeatable);
    if !(parts.variants && is_repeatable) {
        loaded.experiment.variants.clear();
        loaded.experiment.sweep = None;
    }
    if !(parts.error_bars && is_repeatable) {
        loaded.experiment.error_bar = ErrorBar::None;
    }
    let done =
        foreground::run(py, |interrupt| run_campaign(folder, overrides, &loaded, None, interrupt, &mut |_, _| {}))?;
    loaded.controllers.clear();
    let mut campaign = done.map_err(|error| match error {
        RunError::Diagnostics(found) => errors::scene(py, &found),
        RunError::File(error) => errors::new(py, "SincroError", &error.to_string()),
    })?;
    campaign.report.settings.overrides = overrides
        .iter()
        .map(|s| sincro_sim::results::Override { path: s.path.value.clone(), value: s.value.value.clone() })
        .collect();
    let cause = slot.lock().unwrap_or_else(PoisonError::into_inner).take();
    let status = campaign.main.simulated.status.clone();
    let run = Run { loaded, campaign, arrays: Mutex::default() };
    match (cause, &status) {
        (Some(cause), Status::Stopped { .. }) => Err(errors::with(raised(py, &status, cause), py, "run", run)),
        _ => Ok(run),
    }
}

/// A recorded signal: name, unit, values, error bar and the method of its estimate.
type Column = (String, String, Py<PyArray1<f64>>, Option<f64>, String);

/// Columns of one run.
type Arrays = Vec<Py<PyArray1<f64>>>;

/// Result of a run, all of it.
#[pyclass(frozen, module = "sincro._sincro")]
pub struct Run {
    loaded: Loaded,
    campaign: Campaign,
    /// Columns that were asked for, by run: the numbers are handed to Python once.
    arrays: Mutex<Vec<(Option<String>, Arrays)>>,
}

impl Run {
    fn done(&self, py: Python<'_>, variant: Option<&str>) -> PyResult<&CompletedRun> {
        let Some(name) = variant else { return Ok(&self.campaign.main) };
        let found = self.campaign.variants.iter().find(|(v, _)| v.name == name).map(|(_, done)| done);
        let names: Vec<&str> = self.campaign.variants.iter().map(|(v, _)| v.name.as_str()).collect();
        let message = || format!("there is no variant `{name}`; there are: {}", names.join(", "));
        found.ok_or_else(|| errors::unknown(py, &message()))
    }
}

#[pymethods]
impl Run {
    /// Hash of the states of all ticks, as `sincro run` prints it.
    #[getter]
    fn trace_hash(&self) -> &str {
        &self.campaign.report.trace_hash
    }

    /// Names of the variants that were run.
    #[getter]
    fn variants(&self) -> Vec<String> {
        self.campaign.variants.iter().map(|(variant, _)| variant.name.clone()).collect()
    }

    /// `holds`, `fails` or `stopped`: the exit status of `sincro run` in a word.
    #[getter]
    fn verdict(&self) -> &'static str {
        match Verdict::of(&self.campaign) {
            Verdict::Holds => "holds",
            Verdict::Fails => "fails",
            Verdict::Stopped => "stopped",
        }
    }

    /// Text of `run.json`.
    fn json(&self) -> String {
        self.campaign.report.to_json()
    }

    /// All recorded signals of the main run, or of a variant, `t` first; the arrays cannot be written.
    #[pyo3(signature = (variant=None))]
    fn columns(&self, py: Python<'_>, variant: Option<String>) -> PyResult<Vec<Column>> {
        let done = self.done(py, variant.as_deref())?;
        let mut kept = self.arrays.lock().unwrap_or_else(PoisonError::into_inner);
        if !kept.iter().any(|(name, _)| *name == variant) {
            let columns = &done.simulated.table.columns;
            let arrays = columns.iter().map(|column| {
                let array = PyArray1::from_slice(py, &column.values);
                array.readwrite().make_nonwriteable();
                array.unbind()
            });
            let arrays = arrays.collect();
            kept.push((variant.clone(), arrays));
        }
        let arrays = kept.iter().find(|(name, _)| *name == variant).map_or(&[][..], |(_, arrays)| arrays);
        let of = |(report, array): (&sincro_sim::results::ColumnReport, &Py<PyArray1<f64>>)| {
            let (bar, method) = (report.error_bar, report.error_bar_method.clone());
            (report.path.clone(), report.unit.clone(), array.clone_ref(py), bar, method)
        };
        Ok(done.columns.iter().zip(arrays).map(of).collect())
    }

    /// The page of the run as HTML: replay in 3-D, plots, checks.
    fn html(&self, py: Python<'_>) -> PyResult<String> {
        foreground::contained(py, || sincro::results::report_html(&self.loaded, &self.campaign))
    }

    /// Writes the folder that `sincro run` writes.
    fn write(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        let written = foreground::contained(py, || {
            let output = ResultFolder::replace(&folder)?;
            let folder = output.path();
            let tables = &self.campaign.main.simulated.table;
            tables.write_csv(&folder.join("signals.csv"))?;
            for (variant, done) in &self.campaign.variants {
                let of_variant = folder.join("variants").join(&variant.name);
                sincro_sim::file::prepare(&of_variant)?;
                done.simulated.table.write_csv(&of_variant.join("signals.csv"))?;
            }
            if let Some((sweep, _)) = &self.campaign.sweep {
                sweep.write(folder)?;
            }
            self.campaign.report.write(folder)?;
            sincro::results::write(&self.loaded, &self.campaign, folder, None)?;
            Ok(output.publish().map(|_| ())?)
        })?;
        written.map_err(|error: FolderError| errors::new(py, "SincroError", &error.to_string()))
    }
}
