//! The result of a sweep: the final values of many runs that differ in one parameter.

use std::path::Path;

use crate::audit::AuditReport;
use crate::file::FileError;
use crate::table::{Column, Table};

/// Final values of the recorded signals over the values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Path of the parameter, as after `--set`: `/shoulder.spring.stiffness`.
    pub parameter: String,
    /// Its unit; may be empty.
    pub unit: String,
    /// Its values, one a run, in the order in which they were run.
    pub values: Vec<f64>,
    /// A column a recorded signal: its final value in each run. NaN for a run that stopped.
    pub columns: Vec<Column>,
    /// The runs that stopped.
    pub stops: Vec<SweepStop>,
    /// Audit of the runs: of each law the worst value.
    pub audit: AuditReport,
}

/// A run of a sweep that ended before its time.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepStop {
    /// Which of the runs, counted from 0.
    pub run_idx: usize,
    /// When `[s]`.
    pub time: f64,
    /// Reason.
    pub reason: String,
}

impl Sweep {
    /// A sweep without runs yet; `signals` are names and units, without `t`.
    pub fn new<'a>(
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
    pub fn push(&mut self, value: f64, finals: &[f64]) {
        assert_eq!(finals.len(), self.columns.len(), "one final value a signal");
        self.values.push(value);
        for (column, value) in self.columns.iter_mut().zip(finals) {
            column.values.push(*value);
        }
    }

    /// Adds a run that stopped at `time` `[s]`: it has no final values.
    pub fn push_stopped(&mut self, value: f64, time: f64, reason: &str) {
        self.stops.push(SweepStop { run_idx: self.values.len(), time, reason: reason.to_owned() });
        let missing = vec![f64::NAN; self.columns.len()];
        self.push(value, &missing);
    }

    /// The run that stopped, if this one did.
    #[must_use]
    pub fn stop(&self, run_idx: usize) -> Option<&SweepStop> {
        self.stops.iter().find(|stop| stop.run_idx == run_idx)
    }

    /// The runs in the order of the parameter's values.
    #[must_use]
    pub fn ascending(&self) -> Vec<usize> {
        let mut runs: Vec<usize> = (0..self.values.len()).collect();
        runs.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
        runs
    }

    /// Table of the runs `run_idxs`, one row each in that order: the parameter, then the recorded values, each in its
    /// unit.
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

    /// Writes `sweep.csv` into a folder: first column the parameter, one row a run in the order in which they were run.
    ///
    /// # Errors
    ///
    /// The file cannot be written.
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
