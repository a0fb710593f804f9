//! Identification: parameters of a scene from measured data, and how far they can be trusted.

pub mod data;
mod difference;
mod exact;
pub mod excitation;
pub mod free;
pub mod inference;
pub mod model;
mod page;
pub mod shooting;
pub mod solve;

use std::path::Path;

use serde_json::{Value, json};
use sincro_figures::plot::number::{short, significant};
use sincro_sim::file::FileError;

pub use data::{DataSet, SignalChoice};
pub use excitation::{Excitation, Excited, Information};
pub use free::{FreeParameter, parse_all};
pub use inference::{Inference, Whiteness, infer, whiteness};
pub use model::{Model, ModelError, Sensitivities, Sensitivity};
pub use shooting::{Shot, shoot};
pub use solve::{Loss, Solution, SolveError, solve};

/// Identification of parameters from measured data, complete with statistics and validation: all that its report says.
/// Made by [`Fit::new`].
#[derive(Debug)]
pub struct Fit<'a> {
    /// Title of the report, usually that of the scene.
    pub title: String,
    /// Model with its free parameters and its data.
    pub model: Model<'a>,
    /// Loss, confidence, shooting.
    pub options: FitOptions,
    /// Result of multiple shooting, from which the fit started, if it was wanted.
    pub shot: Option<Shot>,
    /// Solution of the least-squares problem.
    pub solution: Solution,
    /// Intervals, correlation and identifiability of the unknowns.
    pub inference: Inference,
    /// Predicted values at the start of the search and at its end, each in the order and units of [`Model::predict`].
    pub predicted: (Vec<f64>, Vec<f64>),
    /// Data sets that were held back, each with the values that the fitted model predicts for it, in the order of
    /// [`Model::predict`] for this set alone.
    pub validation: Vec<(DataSet, Vec<f64>)>,
    /// Wall time of the fit `[s]`.
    pub wall_time: f64,
}

/// Options of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// Loss function that is minimised.
    pub loss: Loss,
    /// Probability of the confidence intervals, in (0, 1).
    pub confidence: f64,
    /// Number of parts of multiple shooting, by which the fit finds its start; `None`: from the starts of the
    /// parameters.
    pub shooting: Option<usize>,
}

impl Default for FitOptions {
    /// Least squares, intervals of 95 %, no shooting.
    fn default() -> Self {
        Self { loss: Loss::Squares, confidence: 0.95, shooting: None }
    }
}

impl<'a> Fit<'a> {
    /// Fits a model to its data, computes the statistics, and predicts the data sets of `validation`, which were held
    /// back.
    ///
    /// # Errors
    ///
    /// [`SolveError`]: the model cannot be run, a parameter has no effect on what was measured, or there are too few
    /// data.
    pub fn new(
        title: String,
        model: Model<'a>,
        options: FitOptions,
        validation: &[DataSet],
    ) -> Result<Self, SolveError> {
        let clock = std::time::Instant::now();
        let start: Vec<f64> = (0..model.n_unknowns()).map(|k| model.bounds(k).0).collect();
        let shot = options.shooting.map(|n_parts| shoot(&model, n_parts)).transpose()?;
        let solution = solve(&model, options.loss, shot.as_ref().map_or(&start, |shot| &shot.unknowns))?;
        let scales: Vec<f64> = (0..model.n_unknowns()).map(|k| model.bounds(k).3).collect();
        let inference = infer(&solution, &scales, options.confidence);
        let wall_time = clock.elapsed().as_secs_f64();
        let predicted = (model.predict(&start)?, model.predict(&solution.unknowns)?);
        let mut held_back = Vec::new();
        for set in validation {
            let sets = std::slice::from_ref(set);
            let own = model.own_settings();
            let other = Model::new(model.loaded, own, model.free.clone(), sets, false, model.interrupt);
            held_back.push((set.clone(), other.predict(&solution.unknowns[..model.free.len()])?));
        }
        Ok(Self { title, model, options, shot, solution, inference, predicted, validation: held_back, wall_time })
    }

    /// Residuals of each column, in the units of the data: the set, the column, predicted less measured.
    pub(crate) fn columns(&self) -> Vec<(&DataSet, &data::DataColumn, std::ops::Range<usize>)> {
        let mut from = 0;
        let mut all = Vec::new();
        for set in self.model.sets {
            for column in &set.columns {
                all.push((set, column, from..from + set.times.len()));
                from += set.times.len();
            }
        }
        all
    }

    /// Returns the test for whiteness of the residuals of each column, set by set in the order of the model's data;
    /// `None` where there are fewer than eight values.
    #[must_use]
    pub fn whiteness(&self) -> Vec<Option<Whiteness>> {
        self.columns().into_iter().map(|(_, _, range)| whiteness(&self.solution.residuals[range])).collect()
    }

    /// Returns the fitted values as arguments of the command line: `--set 'PATH=VALUE'` for each free parameter,
    /// separated by spaces. Time offsets are left out.
    #[must_use]
    pub fn command(&self) -> String {
        let set = self.model.free.iter().zip(&self.solution.unknowns);
        set.map(|(free, value)| format!("--set '{}={value:?}'", free.path)).collect::<Vec<_>>().join(" ")
    }

    /// Returns a summary of the fit for the terminal, several lines of English.
    #[must_use]
    pub fn text(&self) -> String {
        use std::fmt::Write as _;
        let mut out = format!("{}, fitted to {} values\n", self.title, self.inference.n_values);
        let names = self.model.names();
        let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
        for (k, name) in names.iter().enumerate() {
            let of = &self.inference.estimates[k];
            let from = short(self.model.bounds(k).0, 6);
            let interval = match of.is_identifiable {
                true => {
                    format!("± {} at {} %", significant(of.half_width, 2), short(100.0 * self.options.confidence, 4))
                }
                false => "not identifiable from these data".into(),
            };
            let bound = if self.solution.at_bound[k] { ", at its bound" } else { "" };
            let _ = writeln!(out, "  {name:<width$}  {} {interval}{bound}   (start {from})", significant(of.value, 6));
        }
        for unidentifiable in &self.inference.unidentifiable {
            let _ = writeln!(out, "  not identifiable: {}", self.unidentifiable_words(unidentifiable));
        }
        let _ = writeln!(
            out,
            "  {} in {} iterations, {} runs{}, {} s; cost {} → {}",
            if self.solution.has_converged { "converged" } else { "NOT converged" },
            self.solution.n_iterations,
            self.model.n_runs(),
            match self.model.n_dual_runs() {
                0 => String::new(),
                n => format!(" and {n} on dual numbers"),
            },
            significant(self.wall_time, 2),
            significant(self.solution.cost.0, 3),
            significant(self.solution.cost.1, 3)
        );
        if let Some(shot) = &self.shot {
            let _ = writeln!(out, "  {}", shot.words());
        }
        for words in self.solution.sensitivities.words(&names) {
            let _ = writeln!(out, "  sensitivities {words}");
        }
        for ((_, column, _), white) in self.columns().iter().zip(self.whiteness()) {
            if let Some(white) = white {
                let words = if white.p_value > 0.01 { "white" } else { "not white: the model misses something" };
                let _ =
                    writeln!(out, "  residuals of {}: {words} (p = {})", column.column, significant(white.p_value, 2));
            }
        }
        for (set, predicted) in &self.validation {
            let _ = writeln!(
                out,
                "  held back {}: fit {} %",
                set.path.display(),
                significant(100.0 * share(set, predicted), 4)
            );
        }
        let _ = writeln!(out, "  {}", self.command());
        out
    }

    /// Combination that the data do not identify, in words.
    pub(crate) fn unidentifiable_words(&self, unidentifiable: &inference::Unidentifiable) -> String {
        let names = self.model.names();
        let parts: Vec<String> = unidentifiable.parts.iter().map(|(k, _)| format!("`{}`", names[*k])).collect();
        match parts.as_slice() {
            [one] => format!("{one} hardly changes what was measured; excite it more, or measure more"),
            [a, b] => {
                let sign = unidentifiable.parts[0].1 * unidentifiable.parts[1].1;
                let what = if sign > 0.0 { "ratio" } else { "product" };
                let other = if sign > 0.0 { "product" } else { "ratio" };
                format!("{a} and {b} together: the data see their {what} at most, not their {other}; hold one of them")
            }
            all => format!("a combination of {}; hold one of them, or measure more", all.join(", ")),
        }
    }

    /// Writes `fit.json` and `report.html` into a folder, which is created if it is absent.
    ///
    /// # Errors
    ///
    /// [`FileError`] with the path of the file or folder that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), FileError> {
        sincro_sim::file::prepare(folder)?;
        let json = serde_json::to_string_pretty(&self.json()).expect("plain data");
        sincro_sim::file::write_atomically_shared(&folder.join("fit.json"), (json + "\n").as_bytes())?;
        sincro_sim::file::write_atomically_shared(&folder.join("report.html"), page::html(self).as_bytes())
    }

    /// Returns the fit as the JSON object of `fit.json`; numbers that are not finite are null.
    #[must_use]
    pub fn json(&self) -> Value {
        let names = self.model.names();
        let estimates: Vec<Value> = names
            .iter()
            .enumerate()
            .map(|(k, name)| {
                let of = &self.inference.estimates[k];
                json!({
                    "name": name, "value": of.value, "std": of.std, "half_width": of.half_width, "identifiable": of.is_identifiable,
                    "start": self.model.bounds(k).0, "at_bound": self.solution.at_bound[k],
                })
            })
            .collect();
        let white: Vec<Value> = self
            .columns()
            .iter()
            .zip(self.whiteness())
            .map(|((_, c, _), w)| json!({ "column": c.column, "p_value": w.map(|w| w.p_value) }))
            .collect();
        let held: Vec<Value> = self
            .validation
            .iter()
            .map(|(set, predicted)| json!({ "file": set.path.display().to_string(), "fit": share(set, predicted) }))
            .collect();
        json!({
            "title": self.title, "sincro_version": env!("CARGO_PKG_VERSION"), "loss": self.options.loss.word(),
            "confidence": self.options.confidence, "estimates": estimates, "correlation": self.inference.correlation,
            "singular_values": self.inference.singular, "sigma": self.inference.sigma, "n": self.inference.n_values,
            "unidentifiable": self.inference.unidentifiable.iter().map(|u| self.unidentifiable_words(u)).collect::<Vec<_>>(),
            "converged": self.solution.has_converged, "iterations": self.solution.n_iterations,
            "runs": self.model.n_runs(), "cost_start": self.solution.cost.0, "cost": self.solution.cost.1,
            "dual_runs": self.model.n_dual_runs(),
            "shooting": self.shot.as_ref().map(|shot| json!({
                "parts": shot.n_parts, "start": shot.unknowns, "gap": shot.gap, "iterations": shot.n_iterations,
            })),
            "sensitivities": self.solution.sensitivities.words(&names),
            "sensitivity_error": self.solution.sensitivities.error, "whiteness": white, "validation": held,
        })
    }
}

/// Share of the spread of data that a prediction explains: 1 − ‖p − m‖/‖m − mean‖.
pub(crate) fn share(set: &DataSet, predicted: &[f64]) -> f64 {
    let n = set.times.len();
    let (mut left, mut all) = (0.0, 0.0);
    for (c, column) in set.columns.iter().enumerate() {
        let finite: Vec<f64> = column.values.iter().copied().filter(|x| x.is_finite()).collect();
        let mean = finite.iter().sum::<f64>() / finite.len().max(1) as f64;
        for (k, measured) in column.values.iter().enumerate().filter(|(_, x)| x.is_finite()) {
            let (r, d) = (predicted[c * n + k] - measured, measured - mean);
            left += column.weight * column.weight * r * r;
            all += column.weight * column.weight * d * d;
        }
    }
    1.0 - (left / all).sqrt()
}
