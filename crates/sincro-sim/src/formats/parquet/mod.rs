//! Apache Parquet: plain pages without compression, metadata in Thrift's compact protocol.
//!
//! [`Writer`] writes row group by row group to any sink, so that a file may be larger than memory; the same rows in the
//! same groups give the same bytes. [`ParquetFile`] reads such files again; those of other programs, which compress or
//! encode their pages, are refused by what they use.

mod reader;
mod thrift;

use std::io::{self, Write};

pub use reader::{ParquetError, ParquetFile};
use thrift::{BINARY, I32, I64, STRUCT, Struct, binary, number};

use super::{Limits, little_endian};
use crate::table::Table;

/// Physical type, encodings and repetition of Parquet.
const INT64: i64 = 2;
const DOUBLE: i64 = 5;
const BYTE_ARRAY: i64 = 6;
const UTF8: i64 = 0;
const PLAIN: i64 = 0;
const RLE: i64 = 3;
const REQUIRED: i64 = 0;
const MAGIC: &[u8; 4] = b"PAR1";

/// Values of a column of a Parquet file, of one of three types, row by row.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Floating-point numbers (physical type `DOUBLE`).
    Doubles(Vec<f64>),
    /// Whole numbers (physical type `INT64`).
    Ints(Vec<i64>),
    /// Strings (physical type `BYTE_ARRAY`, UTF-8).
    Texts(Vec<String>),
}

impl Values {
    /// Returns the number of values, one per row.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Doubles(values) => values.len(),
            Self::Ints(values) => values.len(),
            Self::Texts(values) => values.len(),
        }
    }

    /// Returns true if there are no values: the column has no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns an empty list of the same type, as [`Writer::new`] takes it for a column.
    #[must_use]
    pub fn emptied(&self) -> Self {
        match self {
            Self::Doubles(_) => Self::Doubles(Vec::new()),
            Self::Ints(_) => Self::Ints(Vec::new()),
            Self::Texts(_) => Self::Texts(Vec::new()),
        }
    }

    fn physical_type(&self) -> i64 {
        match self {
            Self::Doubles(_) => DOUBLE,
            Self::Ints(_) => INT64,
            Self::Texts(_) => BYTE_ARRAY,
        }
    }

    fn plain(&self) -> Vec<u8> {
        match self {
            Self::Doubles(values) => little_endian(values),
            Self::Ints(values) => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
            Self::Texts(values) => {
                let text = |text: &String| [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat();
                values.iter().flat_map(text).collect()
            }
        }
    }
}

/// Writer of a Parquet file, group by group, without compression: [`Writer::new`], [`Writer::group`] any number of
/// times, [`Writer::finish`].
#[derive(Debug)]
pub struct Writer<W: Write> {
    sink: W,
    /// Name of the table.
    root: String,
    /// Bytes written.
    offset: u64,
    /// Names of the columns, and an empty column of each type.
    columns: Vec<(String, Values)>,
    groups: Vec<Vec<u8>>,
    n_rows: u64,
}

impl<W: Write> Writer<W> {
    /// Begins a file in `sink` with a table named `root`. `columns` gives name and type of each column; the values in
    /// it are ignored.
    ///
    /// # Errors
    ///
    /// The error of the sink that takes no bytes.
    pub fn new(mut sink: W, root: &str, columns: Vec<(String, Values)>) -> io::Result<Self> {
        sink.write_all(MAGIC)?;
        Ok(Self { sink, root: root.to_owned(), offset: 4, columns, groups: Vec::new(), n_rows: 0 })
    }

    /// Writes a row group: the values of each column, in the order of [`Writer::new`], all of the same length.
    ///
    /// # Errors
    ///
    /// The error of the sink that takes no bytes.
    ///
    /// # Panics
    ///
    /// If number, types or lengths of the columns are not those of the file.
    pub fn group(&mut self, values: &[Values]) -> io::Result<()> {
        assert_eq!(values.len(), self.columns.len(), "values of every column");
        let n = values.first().map_or(0, Values::len);
        let (mut chunks, mut total) = (Vec::new(), 0);
        for ((name, kind), values) in self.columns.iter().zip(values) {
            assert_eq!((values.len(), values.physical_type()), (n, kind.physical_type()), "column {name}");
            let data = values.plain();
            let size = data.len() as i64;
            let of_data = Struct::default().int(1, I32, n as i64).int(2, I32, PLAIN).int(3, I32, RLE).int(4, I32, RLE);
            let head = Struct::default().int(1, I32, 0).int(2, I32, size).int(3, I32, size).inner(5, of_data).end();
            let (offset, whole) = (self.offset as i64, head.len() as i64 + size);
            self.sink.write_all(&head)?;
            self.sink.write_all(&data)?;
            self.offset += whole as u64;
            let mut path = Vec::new();
            binary(&mut path, name);
            let meta = Struct::default()
                .int(1, I32, kind.physical_type())
                .list(2, I32, &[number(PLAIN)])
                .list(3, BINARY, &[path])
                .int(4, I32, 0)
                .int(5, I64, n as i64)
                .int(6, I64, whole)
                .int(7, I64, whole)
                .int(9, I64, offset);
            chunks.push(Struct::default().int(2, I64, offset).inner(3, meta).end());
            total += whole;
        }
        self.groups.push(Struct::default().list(1, STRUCT, &chunks).int(2, I64, total).int(3, I64, n as i64).end());
        self.n_rows += n as u64;
        Ok(())
    }

    /// Writes the metadata with the pairs `footer` of key and value, which completes the file, and returns the sink.
    ///
    /// # Errors
    ///
    /// The error of the sink that takes no bytes.
    pub fn finish(mut self, footer: &[(String, String)]) -> io::Result<W> {
        let root = Struct::default().text(4, &self.root).int(5, I32, self.columns.len() as i64).end();
        let columns = self.columns.iter().map(|(name, kind)| {
            let column = Struct::default().int(1, I32, kind.physical_type()).int(3, I32, REQUIRED).text(4, name);
            if kind.physical_type() == BYTE_ARRAY { column.int(6, I32, UTF8) } else { column }.end()
        });
        let schema: Vec<Vec<u8>> = std::iter::once(root).chain(columns).collect();
        let pairs: Vec<Vec<u8>> =
            footer.iter().map(|(key, value)| Struct::default().text(1, key).text(2, value).end()).collect();
        let meta = Struct::default()
            .int(1, I32, 1)
            .list(2, STRUCT, &schema)
            .int(3, I64, self.n_rows as i64)
            .list(4, STRUCT, &self.groups)
            .list(5, STRUCT, &pairs)
            .text(6, concat!("sincro ", env!("CARGO_PKG_VERSION")))
            .end();
        self.sink.write_all(&meta)?;
        self.sink.write_all(&(meta.len() as u32).to_le_bytes())?;
        self.sink.write_all(MAGIC)?;
        Ok(self.sink)
    }
}

/// Sizes of pages and numbers of columns are signed numbers of 32 bits.
pub(super) const LIMITS: Limits =
    Limits { columns: i32::MAX as usize, column_bytes: i32::MAX as u64, bytes: i64::MAX as u64 };

/// The file of a table.
pub(super) fn bytes(table: &Table) -> Vec<u8> {
    let columns = table.columns.iter().map(|c| (c.name.clone(), Values::Doubles(Vec::new()))).collect();
    let values: Vec<Values> = table.columns.iter().map(|c| Values::Doubles(c.values.clone())).collect();
    let units: Vec<(String, String)> =
        table.columns.iter().map(|c| (format!("unit of {}", c.name), c.unit.clone())).collect();
    let write = || {
        let mut writer = Writer::new(Vec::new(), "signals", columns)?;
        writer.group(&values)?;
        writer.finish(&units)
    };
    let written: io::Result<Vec<u8>> = write();
    written.expect("memory takes all bytes")
}

#[cfg(test)]
mod tests;
