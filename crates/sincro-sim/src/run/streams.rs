//! What streams of graphs showed, row by row of a run.

use std::path::{Path, PathBuf};

use crate::file::FileError;
use crate::session::Graphs;
use crate::table::{Column, Table};

/// Values of all streams, not a number before a stream was made.
pub(super) struct Streams {
    values: Vec<Vec<f64>>,
    /// Rows that there will be.
    capacity: usize,
    /// The file that was written without them.
    csv: Option<PathBuf>,
}

impl Streams {
    pub fn new(csv: Option<&Path>, capacity: usize) -> Self {
        Self { values: Vec::new(), capacity, csv: csv.map(Path::to_path_buf) }
    }

    /// After row `n_rows` was recorded.
    pub fn look(&mut self, graphs: Option<&mut Graphs>, n_rows: usize) {
        let Some(graphs) = graphs else { return };
        for cleared in graphs.take_cleared() {
            if let Some(values) = self.values.get_mut(cleared) {
                values.fill(f64::NAN);
            }
        }
        for (k, stream) in graphs.streams().iter().enumerate() {
            if k == self.values.len() {
                self.values.push(Vec::with_capacity(self.capacity));
            }
            self.values[k].resize(n_rows - 1, f64::NAN);
            self.values[k].push(stream.value);
        }
    }

    /// Puts them behind the other columns, in the file too; says how many they are. A stream whose column would have the name of another one is told
    /// apart by `'`.
    ///
    /// # Errors
    ///
    /// The CSV file cannot be written.
    pub fn finish(self, graphs: Option<&mut Graphs>, table: &mut Table) -> Result<usize, FileError> {
        let n_rows = table.n_rows();
        let streams: Vec<_> = graphs.map_or_else(Vec::new, |graphs| graphs.streams().to_vec());
        let n_streams = streams.len().min(self.values.len());
        for (stream, mut values) in streams.into_iter().zip(self.values) {
            values.resize(n_rows, f64::NAN);
            let mut name = stream.column;
            while table.column(&name).is_some() {
                name.push('\'');
            }
            table.columns.push(Column { name, unit: stream.unit, values });
        }
        if n_streams > 0
            && let Some(path) = &self.csv
        {
            table.write_csv(path)?;
        }
        Ok(n_streams)
    }
}
