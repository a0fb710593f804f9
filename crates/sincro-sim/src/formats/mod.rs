//! Recorded signals in the formats of other tools: NumPy, MATLAB and Octave, Apache Parquet.
//!
//! The three writers are a page each, without compression: every file has exactly the doubles of the run.

mod mat;
mod npz;
pub mod parquet;

use std::path::Path;

use crate::file::{FileError, write_atomically};
use crate::table::Table;

/// Writes a table as a NumPy archive (`.npz`): an array of doubles for each signal under its name, one entry per row,
/// without units.
///
/// # Errors
///
/// [`FileError`]: the table is larger than the format can hold, or the file cannot be written.
pub fn write_npz(table: &Table, path: &Path) -> Result<(), FileError> {
    npz::LIMITS.check(table, path)?;
    write_atomically(path, &npz::bytes(table))
}

/// Writes a table as a MATLAB 5 file (`.mat`) with the variables `t` (times `[s]`), `signals` (a row for each time, a
/// column for each further signal), `names` and `units` of these columns.
///
/// # Errors
///
/// [`FileError`]: the table is larger than the format can hold, or the file cannot be written.
pub fn write_mat(table: &Table, path: &Path) -> Result<(), FileError> {
    mat::LIMITS.check(table, path)?;
    write_atomically(path, &mat::bytes(table))
}

/// Writes a table as a Parquet file: a column of doubles for each signal under its name; units are in the metadata as
/// `unit of NAME`.
///
/// # Errors
///
/// [`FileError`]: the table is larger than the format can hold, or the file cannot be written.
pub fn write_parquet(table: &Table, path: &Path) -> Result<(), FileError> {
    parquet::LIMITS.check(table, path)?;
    write_atomically(path, &parquet::bytes(table))
}

/// Sizes that a format can hold.
struct Limits {
    columns: usize,
    /// Size of one signal.
    column_bytes: u64,
    /// Size of the whole file.
    bytes: u64,
}

impl Limits {
    /// Bytes beside the numbers that a signal takes: names, units, heads.
    const OVERHEAD: u64 = 1024;

    /// Refuses a table that does not fit: its sizes would be written wrong.
    fn check(&self, table: &Table, path: &Path) -> Result<(), FileError> {
        let (rows, columns) = (table.n_rows() as u64, table.columns.len());
        let of_column = rows.saturating_mul(8).saturating_add(Self::OVERHEAD);
        let of_file = of_column.saturating_mul(columns as u64);
        if columns <= self.columns && of_column <= self.column_bytes && of_file <= self.bytes {
            return Ok(());
        }
        let message = format!(
            "{rows} rows of {columns} signals are more than the format can hold; record fewer, or write another format"
        );
        Err(FileError::new("write", path, std::io::Error::new(std::io::ErrorKind::FileTooLarge, message)))
    }
}

/// The bytes of doubles, least significant first.
fn little_endian(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let mut table = Table::new([("t", "s"), ("/a.position", "rad")], 2);
        table.push_row(&[0.0, 1.5]);
        table.push_row(&[0.1, f64::NAN]);
        table
    }

    #[test]
    fn archives_have_an_array_for_each_signal() {
        let bytes = npz::bytes(&table());
        let text = String::from_utf8_lossy(&bytes);
        assert!(bytes.starts_with(b"PK\x03\x04") && text.contains("/a.position.npy"));
        assert!(text.contains("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }"));
        let end = bytes.len() - 22;
        assert_eq!(bytes[end..end + 4], *b"PK\x05\x06");
        assert_eq!(u16::from_le_bytes([bytes[end + 10], bytes[end + 11]]), 2);
    }

    #[test]
    fn tables_that_do_not_fit_are_refused() {
        let path = Path::new("signals.npz");
        assert!(npz::LIMITS.check(&table(), path).is_ok());
        let names: Vec<String> = (0..70_000).map(|k| format!("s{k}")).collect();
        let wide = Table::new(names.iter().map(|name| (name.as_str(), "")), 0);
        let error = npz::LIMITS.check(&wide, path).unwrap_err().to_string();
        assert!(error.contains("0 rows of 70000 signals are more than the format can hold"), "{error}");
        assert!(mat::LIMITS.check(&wide, path).is_ok() && parquet::LIMITS.check(&wide, path).is_ok());
        let small = Limits { columns: 9, column_bytes: 1030, bytes: 1 << 20 };
        assert!(small.check(&table(), path).is_err());
    }

    #[test]
    fn matlab_files_have_four_variables() {
        let bytes = mat::bytes(&table());
        assert_eq!((&bytes[..6], &bytes[124..128]), (&b"MATLAB"[..], &[0, 1, b'I', b'M'][..]));
        let (mut at, mut n) = (128, 0);
        while at < bytes.len() {
            assert_eq!(u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()), 14);
            at += 8 + u32::from_le_bytes(bytes[at + 4..at + 8].try_into().unwrap()) as usize;
            n += 1;
        }
        assert_eq!((at, n), (bytes.len(), 4));
    }

    #[test]
    fn parquet_files_end_with_the_length_of_their_metadata() {
        let bytes = parquet::bytes(&table());
        assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
        let end = bytes.len() - 8;
        let length = u32::from_le_bytes(bytes[end..end + 4].try_into().unwrap()) as usize;
        assert!(String::from_utf8_lossy(&bytes[end - length..end]).contains("/a.position"));
    }
}
