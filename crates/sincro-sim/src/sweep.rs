//! The result of a sweep: the final values of many runs that differ in one parameter.

use std::path::Path;

use crate::audit::AuditReport;
use crate::file::FileError;
use crate::table::{Column, Table};

/// Result of a parameter sweep: final values of the recorded signals over the values of a parameter (static
/// characteristic).
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Path of the parameter, as after `--set`: `/shoulder.spring.stiffness`.
    pub parameter: String,
    /// Unit of the parameter; may be empty.
    pub unit: String,
    /// Value of the parameter in each run, in the order in which they were run.
    pub values: Vec<f64>,
    /// Final value of each recorded signal in each run, in the order of `values`; NaN for a run that stopped.
    pub columns: Vec<Column>,
    /// Runs that stopped, in the order in which they were run.
    pub stops: Vec<SweepStop>,
    /// Audit of all runs: of each law the worst value.
    pub audit: AuditReport,
}

/// Run of a sweep that stopped before its time, an entry of [`Sweep::stops`].
#[derive(Clone, Debug, PartialEq)]
pub struct SweepStop {
    /// Index of the run, from 0, in the order of [`Sweep::values`].
    pub run_idx: usize,
    /// Simulated time at which it stopped `[s]`.
    pub time: f64,
    /// Reason in English.
    pub reason: String,
}

impl Sweep {
    /// A sweep without runs yet; `signals` are names and units, without `t`.
    pub(crate) fn new<'a>(
        parameter: &str,
        unit: &str,
        signals: impl IntoIterator<Item = (&'a str, &'a str)>,
        n_runs: usize,
    ) -> Self {
        let column = |(name, unit): (&str, &str)| Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: Vec::with_capacity(n_runs),
        };
        Self {
            parameter: parameter.to_owned(),
            unit: unit.to_owned(),
            values: Vec::with_capacity(n_runs),
            columns: signals.into_iter().map(column).collect(),
            stops: Vec::new(),
            audit: AuditReport::default(),
        }
    }

    /// Adds a run at `value` of the parameter that came to its end, with the final values of the signals in their
    /// order, all in the units of [`Sweep::new`].
    ///
    /// # Panics
    ///
    /// If there are more or fewer values than signals.
    pub(crate) fn push(&mut self, value: f64, finals: &[f64]) {
        assert_eq!(finals.len(), self.columns.len(), "one final value a signal");
        self.values.push(value);
        for (column, value) in self.columns.iter_mut().zip(finals) {
            column.values.push(*value);
        }
    }

    /// Adds a run that stopped at `time` `[s]`: it has no final values.
    pub(crate) fn push_stopped(&mut self, value: f64, time: f64, reason: &str) {
        self.stops.push(SweepStop { run_idx: self.values.len(), time, reason: reason.to_owned() });
        let missing = vec![f64::NAN; self.columns.len()];
        self.push(value, &missing);
    }

    /// Returns the stop of run `run_idx` (from 0); `None` if it came to its end.
    #[must_use]
    pub fn stop(&self, run_idx: usize) -> Option<&SweepStop> {
        self.stops.iter().find(|stop| stop.run_idx == run_idx)
    }

    /// Returns the indices of the runs, from 0, ordered by ascending value of the parameter.
    #[must_use]
    pub fn ascending(&self) -> Vec<usize> {
        let mut runs: Vec<usize> = (0..self.values.len()).collect();
        runs.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
        runs
    }

    /// Returns a table of the runs with the indices `run_idxs`, one row each in that order: the value of the parameter,
    /// then the final values of the signals, each in its unit.
    ///
    /// # Panics
    ///
    /// If the sweep has no run of one of the indices, which count from 0.
    #[must_use]
    pub fn table(&self, run_idxs: &[usize]) -> Table {
        let take = |values: &[f64]| run_idxs.iter().map(|run_idx| values[*run_idx]).collect();
        let parameter = Column { name: self.parameter.clone(), unit: self.unit.clone(), values: take(&self.values) };
        let signal = |c: &Column| Column { values: take(&c.values), ..c.clone() };
        Table { columns: std::iter::once(parameter).chain(self.columns.iter().map(signal)).collect() }
    }

    /// Writes `sweep.csv` into the folder `out_dir`: first the parameter, then the signals; one row per run in the
    /// order in which they were run.
    ///
    /// # Errors
    ///
    /// [`FileError`] with the path of the file that cannot be written.
    pub fn write(&self, out_dir: &Path) -> Result<(), FileError> {
        let runs: Vec<usize> = (0..self.values.len()).collect();
        self.table(&runs).write_csv(&out_dir.join("sweep.csv"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::test_folder;

    #[test]
    fn a_stopped_run_has_no_final_values() {
        let mut sweep = Sweep::new("/j.spring.stiffness", "N·m/rad", [("/j.position", "rad")], 2);
        sweep.push(2.0, &[-0.5]);
        sweep.push_stopped(1.0, 0.3, "not finite");
        assert_eq!(sweep.stop(1).map(|stop| stop.time), Some(0.3));
        assert_eq!(sweep.ascending(), [1, 0]);
        let folder = test_folder("sweep");
        sweep.write(&folder).unwrap();
        let text = std::fs::read_to_string(folder.join("sweep.csv")).unwrap();
        assert_eq!(text, "/j.spring.stiffness,/j.position\n2,-0.5\n1,NaN\n");
    }
}
