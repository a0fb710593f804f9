//! Optimal excitation: the input, of a family with a few numbers, whose data tell most about the free parameters.
//!
//! Notation: S sensitivities of all measured values by the parameters, each in units of its value; W = diag(1/σ²) of
//! the noise; F = SᵀWS Fisher information; D-optimal input: the one with the greatest log det F, that is the smallest
//! volume of the confidence ellipsoid. The square roots of the diagonal of F⁻¹ are the standard deviations, relative to
//! the values, that no unbiased estimate falls below (Cramér and Rao). Source: key `goodwin1977`.
//!
//! The input is found by CMA-ES between its bounds; the same seed gives the same bits.

mod page;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::{Value, json};
use sincro_analysis::linear::DMatrix;
use sincro_figures::plot::number::significant;
use sincro_scene::overrides::Override;
use sincro_sim::Loaded;
use sincro_sim::file::FileError;

use super::data::{DataColumn, DataSet, SignalChoice};
use super::free::FreeParameter;
use super::model::{Model, ModelError, Sensitivity};
use crate::design::inverse_normal;
use crate::tune::cma::Cma;
use crate::tune::{from_unit, to_unit};

/// First step of the search, relative to the width of the bounds.
const FIRST_STEP: f64 = 0.3;
/// Eigenvalue of the information, relative to the largest, below which a combination of parameters is not identifiable.
const SINGULAR: f64 = 1e-13;

/// Search for the input that tells most about parameters of a scene. Fill it in, then call [`Excitation::search`].
#[derive(Debug)]
pub struct Excitation<'a> {
    /// Scene of the experiment.
    pub loaded: &'a Loaded,
    /// Settings of all runs.
    pub set: Vec<Override>,
    /// Parameters that are to be identified; the information is that at their starts.
    pub free: Vec<FreeParameter>,
    /// Numbers of the input, with finite bounds.
    pub input: Vec<FreeParameter>,
    /// Times and columns of the data to be measured, with the weights 1/σ; their values do not matter.
    pub data: Vec<DataSet>,
    /// Probability of the predicted intervals, in (0, 1).
    pub confidence: f64,
    /// Upper limit of the number of inputs tried.
    pub budget: usize,
    /// Seed of the search's random draws.
    pub seed: u64,
}

/// Information that data under one input have about the parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Information {
    /// Numbers of the input, in the order and units of [`Excitation::input`].
    pub input: Vec<f64>,
    /// log det F of the parameters in units of their values (dimensionless); −∞ if they are not identifiable, or the
    /// input cannot be run.
    pub log_det: f64,
    /// Predicted half widths of the confidence intervals of the parameters, in their units; infinite if they are not
    /// identifiable.
    pub half_widths: Vec<f64>,
    /// Smallest eigenvalue of F relative to the largest (dimensionless, 0 to 1).
    pub conditioning: f64,
}

/// Result of [`Excitation::search`].
#[derive(Clone, Debug, PartialEq)]
pub struct Excited {
    /// Input at the start of the search, that of the scene.
    pub before: Information,
    /// Best input.
    pub after: Information,
    /// After how many inputs the best one changed, and its log det F.
    pub history: Vec<(usize, f64)>,
    /// Number of inputs tried.
    pub n_tried: usize,
    /// True if the search converged before its budget was used up.
    pub has_converged: bool,
    /// Sentences about how the sensitivities were computed.
    pub sensitivities: Vec<String>,
    /// Wall time of the search `[s]`.
    pub wall_time: f64,
}

/// Places of data that are to be measured: the signals of `choices` every `every` seconds over the run of a scene.
///
/// # Errors
///
/// The name of a signal whose noise is not given.
pub fn planned(loaded: &Loaded, choices: &[SignalChoice], every: f64) -> Result<DataSet, String> {
    let n = (loaded.experiment.duration / every + 1e-9).floor() as usize;
    let times: Vec<f64> = (1..=n).map(|k| k as f64 * every).collect();
    let column = |choice: &SignalChoice| {
        let sigma = choice.sigma.ok_or_else(|| choice.signal.clone())?;
        Ok(DataColumn {
            column: choice.column.clone(),
            signal: choice.signal.clone(),
            weight: 1.0 / sigma,
            values: vec![0.0; times.len()],
        })
    };
    let columns = choices.iter().map(column).collect::<Result<_, String>>()?;
    Ok(DataSet { path: "the planned data".into(), times, columns })
}

impl Excitation<'_> {
    /// Searches the input from that of the scene. After each generation `progress` receives the share of the budget
    /// used so far, from 0 to about 1, and log det F of the best input. `None` if `interrupt` became true before the
    /// first input was complete.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: the scene cannot be run as it is, or a signal does not exist. An input of the search that cannot
    /// be run tells nothing.
    pub fn search(
        &self,
        interrupt: &AtomicBool,
        progress: &mut dyn FnMut(f64, f64),
    ) -> Result<Option<Excited>, ModelError> {
        let clock = std::time::Instant::now();
        let start: Vec<f64> = self.input.iter().map(|input| to_unit(input, input.start)).collect();
        let values =
            |unit: &[f64]| -> Vec<f64> { self.input.iter().zip(unit).map(|(i, u)| from_unit(i, *u)).collect() };
        let mut ways = None;
        let before = match self.information(&values(&start), &mut ways, interrupt) {
            Err(ModelError::Interrupted) => return Ok(None),
            found => found?,
        };
        let (mut best, mut history) = (before.clone(), vec![(1, before.log_det)]);
        let mut search = Cma::new(&start, FIRST_STEP, self.seed);
        let (mut n_tried, mut has_converged) = (1, false);
        'search: while n_tried < self.budget && !has_converged {
            let points = search.ask();
            let mut tried = Vec::with_capacity(points.len());
            for point in &points {
                match self.information(&values(point), &mut ways, interrupt) {
                    Ok(found) => tried.push(found),
                    Err(ModelError::Interrupted) => break 'search,
                    Err(_) => tried.push(self.nothing(values(point))),
                }
            }
            n_tried += tried.len();
            let mut order: Vec<usize> = (0..tried.len()).collect();
            order.sort_by(|a, b| tried[*b].log_det.total_cmp(&tried[*a].log_det));
            if tried[order[0]].log_det > best.log_det {
                best = tried[order[0]].clone();
                history.push((n_tried, best.log_det));
            }
            search.tell(&order.iter().map(|i| points[*i].clone()).collect::<Vec<_>>());
            has_converged = search.has_converged();
            progress(n_tried as f64 / self.budget as f64, best.log_det);
        }
        has_converged &= !interrupt.load(Ordering::Relaxed);
        let sensitivities = ways.map(|ways| self.words(&ways)).unwrap_or_default();
        let wall_time = clock.elapsed().as_secs_f64();
        Ok(Some(Excited { before, after: best, history, n_tried, has_converged, sensitivities, wall_time }))
    }

    fn words(&self, ways: &[Sensitivity]) -> Vec<String> {
        let sensitivities = super::Sensitivities { columns: Vec::new(), ways: ways.to_vec(), error: 1e-6 };
        sensitivities.words(&self.free.iter().map(|free| free.path.clone()).collect::<Vec<_>>())
    }

    /// Settings of all runs with an input.
    #[must_use]
    pub fn settings(&self, input: &[f64]) -> Vec<Override> {
        let of_input = self.input.iter().zip(input).map(|(number, value)| number.setting(*value));
        self.set.iter().cloned().chain(of_input).collect()
    }

    fn nothing(&self, input: Vec<f64>) -> Information {
        let half_widths = vec![f64::INFINITY; self.free.len()];
        Information { input, log_det: f64::NEG_INFINITY, half_widths, conditioning: 0.0 }
    }

    /// Information under an input; the ways to the derivatives are those of the first one.
    fn information(
        &self,
        input: &[f64],
        ways: &mut Option<Vec<Sensitivity>>,
        interrupt: &AtomicBool,
    ) -> Result<Information, ModelError> {
        let settings = self.settings(input);
        let model = Model::new(self.loaded, &settings, self.free.clone(), &self.data, false, interrupt);
        if let Some(ways) = ways {
            model.take_ways(ways.clone());
        }
        let at: Vec<f64> = self.free.iter().map(|free| free.start).collect();
        model.set_coarse(true);
        let found = model.sensitivities(&at, false)?;
        if ways.is_none() {
            *ways = Some(found.ways.clone());
        }
        let weights: Vec<f64> = self
            .data
            .iter()
            .flat_map(|set| set.columns.iter().flat_map(|c| std::iter::repeat_n(c.weight, set.times.len())))
            .collect();
        let scales: Vec<f64> = self.free.iter().map(|free| free.scale().abs()).collect();
        let n = self.free.len();
        let s = DMatrix::from_fn(weights.len(), n, |i, k| {
            let slope = found.columns[k][i];
            weights[i] * scales[k] * if slope.is_finite() { slope } else { 0.0 }
        });
        Ok(self.of_matrix(input.to_vec(), &(s.transpose() * &s), &scales))
    }

    fn of_matrix(&self, input: Vec<f64>, fisher: &DMatrix<f64>, scales: &[f64]) -> Information {
        let n = scales.len();
        let eigen = fisher.clone().symmetric_eigen();
        let largest = eigen.eigenvalues.iter().fold(0.0_f64, |a, x| a.max(*x));
        let smallest = eigen.eigenvalues.iter().fold(f64::INFINITY, |a, x| a.min(*x));
        if largest <= 0.0 || smallest <= SINGULAR * largest {
            return self.nothing(input);
        }
        let log_det = eigen.eigenvalues.iter().map(|x| sincro_math::elementary::ln(*x).0).sum();
        let z = inverse_normal(0.5 + 0.5 * self.confidence);
        let variance = |k: usize| -> f64 {
            (0..n).map(|i| eigen.eigenvectors[(k, i)] * eigen.eigenvectors[(k, i)] / eigen.eigenvalues[i]).sum()
        };
        let half_widths = (0..n).map(|k| z * variance(k).sqrt() * scales[k]).collect();
        Information { input, log_det, half_widths, conditioning: smallest / largest }
    }

    /// Returns an input as arguments of the command line, `--set 'PATH=VALUE'` each.
    #[must_use]
    pub fn command(&self, input: &[f64]) -> String {
        let set = self.input.iter().zip(input);
        set.map(|(number, value)| format!("--set '{}={value:?}'", number.path)).collect::<Vec<_>>().join(" ")
    }

    /// Returns a summary for the terminal, several lines of English.
    #[must_use]
    pub fn text(&self, excited: &Excited) -> String {
        use std::fmt::Write as _;
        let mut out = format!("{}, the input that tells most\n", self.loaded.experiment.title);
        let width = self.input.iter().chain(&self.free).map(|free| free.path.chars().count()).max().unwrap_or(0);
        let digits = |x: f64, n: usize| if x.is_finite() { significant(x, n) } else { "not identifiable".into() };
        for (k, number) in self.input.iter().enumerate() {
            let (before, after) = (significant(excited.before.input[k], 5), significant(excited.after.input[k], 5));
            let _ = writeln!(out, "  {:<width$}  {before} → {after}", number.path);
        }
        let percent = 100.0 * self.confidence;
        let _ = writeln!(out, "  predicted intervals at {} %", significant(percent, 3));
        for (k, free) in self.free.iter().enumerate() {
            let [before, after] = [&excited.before, &excited.after].map(|of| digits(of.half_widths[k], 2));
            let _ = writeln!(out, "  {:<width$}  {} ± {before} → ± {after}", free.path, significant(free.start, 4));
        }
        for words in &excited.sensitivities {
            let _ = writeln!(out, "  sensitivities {words}");
        }
        let ended = if excited.has_converged { "converged" } else { "ended by its budget" };
        let _ = writeln!(
            out,
            "  {ended} after {} inputs in {} s, seed {}",
            excited.n_tried,
            significant(excited.wall_time, 2),
            self.seed
        );
        let _ = writeln!(out, "  {}", self.command(&excited.after.input));
        out
    }

    /// Writes `design.json` and `report.html` into a folder, which is created if it is absent.
    ///
    /// # Errors
    ///
    /// [`FileError`] with the path of the file or folder that cannot be written.
    pub fn write(&self, excited: &Excited, folder: &Path) -> Result<(), FileError> {
        sincro_sim::file::prepare(folder)?;
        let json = serde_json::to_string_pretty(&self.json(excited)).expect("plain data");
        sincro_sim::file::write_atomically_shared(&folder.join("design.json"), (json + "\n").as_bytes())?;
        sincro_sim::file::write_atomically_shared(&folder.join("report.html"), page::html(self, excited).as_bytes())
    }

    /// Returns the result as the JSON object of `design.json`; numbers that are not finite are null.
    #[must_use]
    pub fn json(&self, excited: &Excited) -> Value {
        let of = |information: &Information| {
            let input = self.input.iter().zip(&information.input).map(|(i, x)| (i.path.clone(), json!(x)));
            let intervals = self.free.iter().zip(&information.half_widths).map(|(f, x)| (f.path.clone(), json!(x)));
            json!({
                "input": input.collect::<serde_json::Map<_, _>>(), "log_det": information.log_det,
                "half_widths": intervals.collect::<serde_json::Map<_, _>>(), "conditioning": information.conditioning,
            })
        };
        json!({
            "title": self.loaded.experiment.title, "sincro_version": env!("CARGO_PKG_VERSION"),
            "confidence": self.confidence, "before": of(&excited.before), "after": of(&excited.after),
            "inputs": excited.n_tried, "converged": excited.has_converged, "seed": self.seed,
            "sensitivities": excited.sensitivities,
        })
    }
}
