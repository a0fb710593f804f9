//! Values of the streams that controllers record, row by row of a run.

use std::path::{Path, PathBuf};

use crate::controller::Controller;
use crate::file::FileError;
use crate::table::{Column, Table};

/// Values of all streams, by controller; not a number before a stream was made.
pub(super) struct Streams {
    values: Vec<Vec<Vec<f64>>>,
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
    pub fn update(&mut self, controllers: &mut [Box<dyn Controller>], n_rows: usize) {
        self.values.resize_with(controllers.len(), Vec::new);
        for (controller, streams) in controllers.iter_mut().zip(&mut self.values) {
            for cleared in controller.take_cleared_streams() {
                if let Some(values) = streams.get_mut(cleared) {
                    values.fill(f64::NAN);
                }
            }
            let mut k = 0;
            controller.streams(&mut |_, _, value| {
                if k == streams.len() {
                    streams.push(Vec::with_capacity(self.capacity));
                }
                streams[k].resize(n_rows - 1, f64::NAN);
                streams[k].push(value);
                k += 1;
            });
        }
    }

    /// Puts them behind the other columns, in the file too; says how many they are. A stream whose column would have
    /// the name of another one is told apart by `'`.
    ///
    /// # Errors
    ///
    /// The CSV file cannot be written.
    pub fn finish(self, controllers: &[Box<dyn Controller>], table: &mut Table) -> Result<usize, FileError> {
        let (n_rows, n_columns) = (table.n_rows(), table.columns.len());
        for (controller, streams) in controllers.iter().zip(self.values) {
            let mut streams = streams.into_iter();
            controller.streams(&mut |column, unit, _| {
                let Some(mut values) = streams.next() else { return };
                values.resize(n_rows, f64::NAN);
                let mut name = column.to_owned();
                while table.column(&name).is_some() {
                    name.push('\'');
                }
                table.columns.push(Column { name, unit: unit.to_owned(), values });
            });
        }
        let n_streams = table.columns.len() - n_columns;
        if n_streams > 0
            && let Some(path) = &self.csv
        {
            table.write_csv(path)?;
        }
        Ok(n_streams)
    }
}
