//! Measured data: columns of CSV files, each against a recorded signal.

use std::path::{Path, PathBuf};

use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_scene::suggest;
use sincro_sim::table::Table;

/// Column of measured data with the signal that predicts it; an entry of [`DataSet::columns`].
#[derive(Clone, Debug, PartialEq)]
pub struct DataColumn {
    /// Name of the column in the file.
    pub column: String,
    /// Name of the recorded signal, such as `/arm.position`.
    pub signal: String,
    /// Weight of its residuals: 1/σ of its noise `[1 / unit of the signal]`; 1 unless given.
    pub weight: f64,
    /// Measured values, one for each of [`DataSet::times`], in the unit of the signal; NaN where nothing was measured.
    pub values: Vec<f64>,
}

/// Measured data of one experiment, read from a CSV file; what a [`Model`](super::Model) is fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct DataSet {
    /// Path of the file.
    pub path: PathBuf,
    /// Times `[s]`, ascending, on the clock of the simulation.
    pub times: Vec<f64>,
    /// Columns that are fitted.
    pub columns: Vec<DataColumn>,
}

/// Choice of a signal and its column of data, an argument of `--signal`: `SIGNAL` or `SIGNAL=COLUMN`, with `@SIGMA`
/// behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalChoice {
    /// Name of the recorded signal.
    pub signal: String,
    /// Name of its column in the file; that of the signal unless given.
    pub column: String,
    /// Standard deviation of its noise, in the unit of the signal; `None`: unknown, weight 1.
    pub sigma: Option<f64>,
}

impl SignalChoice {
    /// Reads an argument of `--signal`, such as `/arm.position=angle@0.002`.
    ///
    /// # Errors
    ///
    /// A diagnostic if the standard deviation is no positive, finite number.
    ///
    /// ```
    /// use sincro_campaign::fit::SignalChoice;
    ///
    /// let choice = SignalChoice::parse("/arm.position=angle@0.002").unwrap();
    /// assert_eq!((choice.signal.as_str(), choice.column.as_str()), ("/arm.position", "angle"));
    /// assert_eq!(choice.sigma, Some(0.002)); // [rad]
    /// ```
    pub fn parse(text: &str) -> Result<Self, Diagnostic> {
        let (names, sigma) = text.split_once('@').map_or((text, None), |(names, sigma)| (names, Some(sigma)));
        let sigma = match sigma.map(|word| word.trim().parse::<f64>()) {
            None => None,
            Some(Ok(sigma)) if sigma > 0.0 && sigma.is_finite() => Some(sigma),
            Some(_) => {
                let problem = Diagnostic::without_location(format!("the noise in `{text}` is no positive number"));
                return Err(problem.with_help("write SIGNAL=COLUMN@SIGMA, such as /arm.position=angle@0.002"));
            }
        };
        let (signal, column) = names.split_once('=').unwrap_or((names, names));
        Ok(Self { signal: signal.trim().to_owned(), column: column.trim().to_owned(), sigma })
    }
}

impl DataSet {
    /// Reads a CSV file whose first column is the time `[s]`. Of the others it takes those of `choices`; without
    /// choices, every column whose name is one of `recorded`, the names of the recorded signals.
    ///
    /// # Errors
    ///
    /// Diagnostics with the file's name: it cannot be read, it has fewer than three rows or its times do not ascend, a
    /// chosen column is not there, or no number is in the columns taken.
    pub fn read(path: &Path, choices: &[SignalChoice], recorded: &[String]) -> Result<Self, Diagnostics> {
        let table = Table::read_csv(path)
            .map_err(|error| Diagnostics::from(Diagnostic::without_location(error.to_string())))?;
        let shown = path.display();
        let refuse = |message: String| Diagnostic::without_location(message);
        let times = table.times().to_vec();
        if times.len() < 3 || !times.is_sorted_by(|a, b| a < b) || !times[0].is_finite() {
            let message = format!("`{shown}`: its first column is not a time that ascends over three rows or more");
            return Err(refuse(message).into());
        }
        let names: Vec<&str> = table.columns.iter().skip(1).map(|c| c.name.as_str()).collect();
        let choices: Vec<SignalChoice> = if choices.is_empty() {
            let known = names.iter().filter(|name| recorded.iter().any(|signal| signal == **name));
            known.map(|name| SignalChoice { signal: (*name).into(), column: (*name).into(), sigma: None }).collect()
        } else {
            choices.to_vec()
        };
        if choices.is_empty() {
            let problem = refuse(format!("`{shown}`: no column has the name of a recorded signal"));
            return Err(problem.with_help("say which signal a column measures: --signal /arm.position=angle").into());
        }
        let mut found = Diagnostics::new();
        let mut columns = Vec::new();
        for choice in &choices {
            let Some(column) = table.columns.iter().skip(1).find(|c| c.name == choice.column) else {
                let problem = refuse(format!("`{shown}` has no column `{}`", choice.column));
                found.push(problem.with_help(suggest::help(&choice.column, &names, "columns")));
                continue;
            };
            columns.push(DataColumn {
                column: choice.column.clone(),
                signal: choice.signal.clone(),
                weight: 1.0 / choice.sigma.unwrap_or(1.0),
                values: column.values.clone(),
            });
        }
        if found.any_error() {
            return Err(found);
        }
        let set = Self { path: path.to_owned(), times, columns };
        if set.n_values() == 0 {
            return Err(refuse(format!("`{shown}` has no number in the columns that are fitted")).into());
        }
        Ok(set)
    }

    /// Returns the number of measured values in all columns, gaps left out.
    #[must_use]
    pub fn n_values(&self) -> usize {
        self.columns.iter().map(|c| c.values.iter().filter(|x| x.is_finite()).count()).sum()
    }
}

/// Value of a recorded series at a time: exact at its rows, between them the cubic through four of them.
#[must_use]
pub(crate) fn interpolate(times: &[f64], values: &[f64], t: f64) -> f64 {
    let above = times.partition_point(|x| *x < t);
    for near in [above, above.saturating_sub(1)] {
        if times.get(near).is_some_and(|x| (x - t).abs() < 1e-9) {
            return values[near];
        }
    }
    if above == 0 || above == times.len() {
        return f64::NAN;
    }
    let first = above.saturating_sub(2).min(times.len().saturating_sub(4));
    let last = (first + 4).min(times.len());
    let weight = |i: usize| -> f64 {
        (first..last).filter(|j| *j != i).map(|j| (t - times[j]) / (times[i] - times[j])).product()
    };
    (first..last).map(|i| weight(i) * values[i]).sum()
}

/// Slope of [`interpolate`] at a time.
#[must_use]
pub(crate) fn interpolated_slope(times: &[f64], values: &[f64], t: f64) -> f64 {
    let above = times.partition_point(|x| *x < t - 1e-9);
    if above == times.len() || t < times.first().copied().unwrap_or(0.0) - 1e-9 {
        return f64::NAN;
    }
    let first = above.saturating_sub(2).min(times.len().saturating_sub(4));
    let last = (first + 4).min(times.len());
    let others = |i: usize| (first..last).filter(move |j| *j != i);
    let rate = |i: usize| -> f64 {
        let leave_out = |k: usize| -> f64 {
            let rest: f64 = others(i).filter(|j| *j != k).map(|j| (t - times[j]) / (times[i] - times[j])).product();
            rest / (times[i] - times[k])
        };
        others(i).map(leave_out).sum()
    };
    (first..last).map(|i| rate(i) * values[i]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_interpolated_exactly() {
        let times: Vec<f64> = (0..9).map(|k| 0.25 * f64::from(k)).collect();
        let of = |t: f64| t * t * t - 2.0 * t + 1.0;
        let values: Vec<f64> = times.iter().map(|t| of(*t)).collect();
        for t in [0.0, 0.1, 0.6, 1.0, 1.99, 2.0] {
            assert!((interpolate(&times, &values, t) - of(t)).abs() < 1e-13, "{t}");
            assert!((interpolated_slope(&times, &values, t) - (3.0 * t * t - 2.0)).abs() < 1e-12, "{t}");
        }
        assert!(interpolate(&times, &values, 2.1).is_nan() && interpolate(&times, &values, -0.1).is_nan());
    }

    #[test]
    fn choices_name_signal_column_and_noise() {
        let choice = SignalChoice::parse("/arm.position=angle@0.002").unwrap();
        assert_eq!(
            (choice.signal.as_str(), choice.column.as_str(), choice.sigma),
            ("/arm.position", "angle", Some(0.002))
        );
        assert!(SignalChoice::parse("a@-1").is_err());
    }
}
