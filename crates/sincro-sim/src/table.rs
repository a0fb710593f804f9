//! Recorded table: rows of numbers under named columns, in memory and as CSV.
//!
//! The file has the columns' names in its first line; units stand in `run.json`. Numbers are written with as many
//! digits as bring back the same bits, and no more: `0.005`, `1e-12`, `NaN`, `inf`. The same bits in give the same
//! bytes out.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::file::{FileError, partial, put_in_place};

/// Recorded signal: name, unit, and one value per row; part of a [`Table`].
///
/// ```
/// use sincro_sim::prelude::*;
///
/// let mut table = Table::new([("t", "s"), ("/motor.velocity", "rad/s")], 3);
/// for (t, w) in [(0.0, 0.0), (0.1, 0.8), (0.2, 1.1)] {
///     table.push_row(&[t, w]);
/// }
/// let velocity: &Column = table.column("/motor.velocity").unwrap();
/// let peak = velocity.values.iter().copied().fold(f64::MIN, f64::max);
/// assert_eq!((peak, velocity.unit.as_str()), (1.1, "rad/s"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name of the signal, such as `/shoulder.position`.
    pub name: String,
    /// Unit as text, such as `rad`; may be empty.
    pub unit: String,
    /// Values, one per row, in `unit`.
    pub values: Vec<f64>,
}

/// Table of recorded signals, all of the same length. The first column is the time `t` `[s]`, strictly increasing.
///
/// ```
/// use sincro_sim::table::Table;
///
/// let mut table = Table::new([("t", "s"), ("/shoulder.position", "rad")], 2);
/// table.push_row(&[0.0, 0.1]);
/// table.push_row(&[0.005, 0.2]);
/// assert_eq!(table.times(), [0.0, 0.005]);
/// assert_eq!(table.column("/shoulder.position").map(|c| c.values[1]), Some(0.2));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Columns, at least one.
    pub columns: Vec<Column>,
}

impl Table {
    /// Creates an empty table of columns with these names and units, with room for `row_capacity` rows: filling it up
    /// to there allocates nothing.
    ///
    /// # Panics
    ///
    /// If there is no column.
    pub fn new<'a>(columns: impl IntoIterator<Item = (&'a str, &'a str)>, row_capacity: usize) -> Self {
        let column = |(name, unit): (&str, &str)| Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: Vec::with_capacity(row_capacity),
        };
        let columns: Vec<Column> = columns.into_iter().map(column).collect();
        assert!(!columns.is_empty(), "a table has a first column");
        Self { columns }
    }

    /// Frees the room for rows that have not come.
    pub(crate) fn shrink_to_fit(&mut self) {
        self.columns.iter_mut().for_each(|column| column.values.shrink_to_fit());
    }

    /// Appends a row: one value per column, in the order and units of the columns.
    ///
    /// # Panics
    ///
    /// If there are more or fewer values than columns.
    pub fn push_row(&mut self, row: &[f64]) {
        assert_eq!(row.len(), self.columns.len(), "one value a column");
        for (column, value) in self.columns.iter_mut().zip(row) {
            column.values.push(*value);
        }
    }

    /// Returns this table with the columns of other runs beside its own, named `NAME:COLUMN` with the name given for
    /// each table. Tables that lack one of its times (within 1 ns) are left out.
    #[must_use]
    pub fn with_columns_of(&self, others: &[(&str, &Self)]) -> Self {
        let mut joined = self.clone();
        for (name, other) in others {
            let Some(rows) = self.rows_in(other) else { continue };
            joined.columns.extend(other.columns.iter().skip(1).map(|column| Column {
                name: format!("{name}:{}", column.name),
                unit: column.unit.clone(),
                values: rows.iter().map(|&k| column.values[k]).collect(),
            }));
        }
        joined
    }

    /// For each row, the row of another table at the same time (within 1e-9 s); none if one is missing.
    fn rows_in(&self, other: &Self) -> Option<Vec<usize>> {
        let times = other.times();
        let find = |t: &f64| {
            let k = times.partition_point(|x| *x < t - 1e-9);
            times.get(k).is_some_and(|x| (x - t).abs() <= 1e-9).then_some(k)
        };
        self.times().iter().map(find).collect()
    }

    /// Returns the number of rows, the length of every column.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.times().len()
    }

    /// Returns the first column, one value per row: times `[s]`, in a table of a sweep values of the parameter.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.columns[0].values
    }

    /// Returns the column of this name; `None` if there is none.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// Copies a row, one value a column in its unit, to `row`, whose memory is used again.
    fn copy_row(&self, row_idx: usize, row: &mut Vec<f64>) {
        row.clear();
        row.extend(self.columns.iter().map(|column| column.values[row_idx]));
    }

    /// Writes all rows to a CSV file in the format of [`CsvWriter`], without units.
    ///
    /// # Errors
    ///
    /// [`FileError`]: the file cannot be written.
    ///
    /// ```
    /// use sincro_sim::prelude::*;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// # let path = std::env::temp_dir().join(format!("sincro-table-doc-{}.csv", std::process::id()));
    /// let mut table = Table::new([("t", ""), ("x", "")], 2);
    /// table.push_row(&[0.0, 0.1 + 0.2]);
    /// table.push_row(&[0.005, 1e-12]);
    /// table.write_csv(&path)?;
    /// assert_eq!(Table::read_csv(&path)?, table); // the same bits; units are not in the file
    /// # std::fs::remove_file(&path)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn write_csv(&self, path: &Path) -> Result<(), FileError> {
        let names: Vec<&str> = self.columns.iter().map(|column| column.name.as_str()).collect();
        let mut writer = CsvWriter::create(path, &names)?;
        let mut row = Vec::with_capacity(self.columns.len());
        for row_idx in 0..self.n_rows() {
            self.copy_row(row_idx, &mut row);
            writer.push_row(&row)?;
        }
        writer.finish()
    }

    /// Reads a CSV file with a line of names and rows of numbers, as [`CsvWriter`] writes it; units are not in it and
    /// stay empty.
    ///
    /// # Errors
    ///
    /// [`FileError`]: the file cannot be read, is not CSV, has no column, or a field is not a number.
    pub fn read_csv(path: &Path) -> Result<Self, FileError> {
        let failed = |cause: io::Error| FileError::new("read", path, cause);
        let metadata = std::fs::metadata(path).map_err(failed)?;
        if !metadata.is_file() && !metadata.is_dir() {
            return Err(failed(io::Error::new(io::ErrorKind::InvalidInput, "it is a device or pipe, not a file")));
        }
        let mut reader = csv::Reader::from_path(path).map_err(|e| failed(e.into()))?;
        let header = reader.headers().map_err(|e| failed(e.into()))?.clone();
        if header.is_empty() {
            return Err(failed(io::Error::new(io::ErrorKind::InvalidData, "the file is empty")));
        }
        let mut table = Self::new(header.iter().map(|name| (name, "")), 0);
        for (row_idx, record) in reader.records().enumerate() {
            let record = record.map_err(|e| failed(e.into()))?;
            let row: Result<Vec<f64>, _> = record.iter().map(number).collect();
            let row =
                row.map_err(|what| io::Error::new(io::ErrorKind::InvalidData, format!("row {}: {what}", row_idx + 1)));
            table.push_row(&row.map_err(failed)?);
        }
        Ok(table)
    }
}

fn number(field: &str) -> Result<f64, String> {
    field.trim().parse().map_err(|_| format!("`{field}` is not a number"))
}

/// Writer of a CSV file, row by row as a run goes on.
///
/// Rows go to `<path>.partial`, which [`CsvWriter::finish`] renames to `path`; call it after a stopped run too, so that
/// what was recorded is kept. A file that was never finished keeps the name with `.partial`, and one of an earlier run
/// at `path` stays.
pub struct CsvWriter {
    csv: csv::Writer<File>,
    path: PathBuf,
    n_columns: usize,
    field: Vec<u8>,
}

impl CsvWriter {
    /// Bytes gathered before they go to the system.
    const BUFFER: usize = 1 << 16;

    /// Creates the file with a first line of the columns' names.
    ///
    /// # Errors
    ///
    /// [`FileError`]: the file cannot be written.
    pub fn create(path: &Path, names: &[&str]) -> Result<Self, FileError> {
        let partial = partial(path);
        let file = File::create(&partial).map_err(|e| FileError::new("create", &partial, e))?;
        let mut csv = csv::WriterBuilder::new().buffer_capacity(Self::BUFFER).from_writer(file);
        csv.write_record(names).map_err(|e| FileError::new("write", &partial, e))?;
        Ok(Self { csv, path: path.to_path_buf(), n_columns: names.len(), field: Vec::with_capacity(32) })
    }

    /// Appends a row: one value per column, in their order.
    ///
    /// # Errors
    ///
    /// [`FileError`]: the disk is full or gone; reported when buffered rows are written, which may be some rows later.
    ///
    /// # Panics
    ///
    /// If there are more or fewer values than columns.
    pub fn push_row(&mut self, row: &[f64]) -> Result<(), FileError> {
        assert_eq!(row.len(), self.n_columns, "one value a column");
        for value in row {
            self.field.clear();
            write_number(&mut self.field, *value);
            self.csv.write_field(&self.field).map_err(|e| FileError::new("write", &partial(&self.path), e))?;
        }
        self.csv.write_record(None::<&[u8]>).map_err(|e| FileError::new("write", &partial(&self.path), e))
    }

    /// Writes buffered rows and renames the file to its final name.
    ///
    /// # Errors
    ///
    /// [`FileError`]: the disk is full or gone, or a folder stands in the file's place; then the rows that did get
    /// written are in `<path>.partial`.
    pub fn finish(self) -> Result<(), FileError> {
        let partial = partial(&self.path);
        let file = self.csv.into_inner().map_err(|e| FileError::new("write", &partial, e.into_error()))?;
        put_in_place(&file, &partial, &self.path)
    }
}

/// The shortest text that reads back as the same number; with an exponent where zeros would make it long.
fn write_number(field: &mut Vec<u8>, value: f64) {
    let size = value.abs();
    let written = if size == 0.0 || (1e-5..1e16).contains(&size) || !size.is_finite() {
        write!(field, "{value}")
    } else {
        write!(field, "{value:e}")
    };
    written.expect("a vector takes all bytes");
}

/// A number as it stands in the file.
pub(crate) fn number_text(value: f64) -> String {
    let mut field = Vec::new();
    write_number(&mut field, value);
    String::from_utf8_lossy(&field).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::test_folder;

    #[test]
    fn bits_survive_the_file() {
        let values =
            [0.0, -0.0, 1.0 / 3.0, -1e-12, 5e-324, f64::MAX, 1e16, 123_456.789, f64::INFINITY, f64::NEG_INFINITY];
        let mut table = Table::new([("t", "s"), ("/a, b.position", "rad")], values.len());
        for (k, value) in values.iter().enumerate() {
            table.push_row(&[k as f64 * 0.005, *value]);
        }
        let path = test_folder("bits").join("signals.csv");
        table.write_csv(&path).unwrap();
        let back = Table::read_csv(&path).unwrap();
        assert_eq!(back.columns[1].name, "/a, b.position");
        let bits =
            |table: &Table| table.columns.iter().flat_map(|c| c.values.clone()).map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(&table), bits(&back));
    }

    #[test]
    fn text_is_the_shortest_that_reads_back() {
        let text = number_text;
        assert_eq!(text(0.1 + 0.2), "0.30000000000000004");
        assert_eq!([text(2.0), text(1e-12), text(0.005), text(-2.5e20)], ["2", "1e-12", "0.005", "-2.5e20"]);
        assert_eq!([text(f64::NAN), text(f64::NEG_INFINITY)], ["NaN", "-inf"]);
        assert!(number("NaN").unwrap().is_nan());
    }

    #[test]
    fn an_unfinished_file_has_another_name() {
        let path = test_folder("unfinished").join("signals.csv");
        let mut writer = CsvWriter::create(&path, &["t", "/a.position"]).unwrap();
        writer.push_row(&[0.0, 1.5]).unwrap();
        assert!(!path.exists() && partial(&path).exists());
        writer.finish().unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "t,/a.position\n0,1.5\n");
        assert!(!partial(&path).exists());
    }

    #[test]
    fn a_dropped_writer_leaves_the_earlier_file() {
        let path = test_folder("dropped").join("signals.csv");
        std::fs::write(&path, "earlier").unwrap();
        drop(CsvWriter::create(&path, &["t"]).unwrap());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "earlier");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_reported_with_its_file() {
        let path = test_folder("full").join("signals.csv");
        std::os::unix::fs::symlink("/dev/full", partial(&path)).unwrap();
        let mut writer = CsvWriter::create(&path, &["t"]).unwrap();
        let mut pushed = Ok(());
        for k in 0..20_000 {
            pushed = pushed.and_then(|()| writer.push_row(&[f64::from(k)]));
        }
        let message = pushed.unwrap_err().to_string();
        assert!(message.contains("signals.csv.partial`: No space left on device"), "{message}");
        assert!(writer.finish().is_err() && !path.exists());
    }

    #[test]
    fn what_is_not_a_number_is_refused_with_its_row() {
        let path = test_folder("not-a-number").join("signals.csv");
        std::fs::write(&path, "t,x\n0,1\n1,one\n").unwrap();
        let message = Table::read_csv(&path).unwrap_err().to_string();
        assert!(message.ends_with("row 2: `one` is not a number"), "{message}");
    }
}
