//! Reader of the Parquet files that this program writes.

use std::fmt;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use super::thrift::{Reader, Value};
use super::{BYTE_ARRAY, DOUBLE, INT64, MAGIC, PLAIN, Values};

/// Largest footer that is read: one of a million row groups.
const MAX_FOOTER: u64 = 1 << 30;

/// Error of reading a Parquet file.
#[derive(Debug)]
pub enum ParquetError {
    /// Error of the operating system.
    File(io::Error),
    /// The file is cut off, damaged, or uses features that this program does not write; the reason in English.
    Content(String),
}

impl fmt::Display for ParquetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => write!(f, "{error}"),
            Self::Content(reason) => write!(f, "{reason}"),
        }
    }
}

impl std::error::Error for ParquetError {}

impl From<io::Error> for ParquetError {
    fn from(error: io::Error) -> Self {
        Self::File(error)
    }
}

/// A place of the pages of one column in a row group.
#[derive(Clone, Copy, Debug)]
struct Chunk {
    offset: u64,
    size: u64,
}

/// Open Parquet file as [`Writer`](super::Writer) writes it: columns, metadata, and row groups to be read one by one.
#[derive(Debug)]
pub struct ParquetFile {
    file: File,
    /// Name of each column, with an empty list of its type.
    pub columns: Vec<(String, Values)>,
    /// Key–value pairs of the metadata.
    pub footer: Vec<(String, String)>,
    /// Number of rows of all groups together.
    pub n_rows: u64,
    groups: Vec<(u64, Vec<Chunk>)>,
}

fn content(reason: impl Into<String>) -> ParquetError {
    ParquetError::Content(reason.into())
}

impl ParquetFile {
    /// Opens a file and reads its metadata.
    ///
    /// # Errors
    ///
    /// [`ParquetError::File`]: it cannot be read. [`ParquetError::Content`]: it is cut off, damaged, or of a kind that
    /// this program does not write.
    pub fn open(path: &Path) -> Result<Self, ParquetError> {
        let mut file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut tail = [0; 8];
        if length < 12 {
            return Err(content(format!("it has {length} bytes, fewer than any Parquet file: it was cut off")));
        }
        file.seek(SeekFrom::End(-8))?;
        file.read_exact(&mut tail)?;
        if &tail[4..] != MAGIC {
            return Err(content("it does not end as a Parquet file: it was cut off or is of another kind"));
        }
        let size = u64::from(u32::from_le_bytes([tail[0], tail[1], tail[2], tail[3]]));
        if size > MAX_FOOTER || size + 12 > length {
            return Err(content("its footer is longer than the file"));
        }
        file.seek(SeekFrom::Start(length - 8 - size))?;
        let mut bytes = vec![0; size as usize];
        file.read_exact(&mut bytes)?;
        let meta = Reader::new(&bytes).structure().ok_or_else(|| content("its footer is damaged"))?;
        let columns = columns(&meta)?;
        let groups: Vec<(u64, Vec<Chunk>)> =
            meta.list(4).iter().map(|g| group(g, columns.len())).collect::<Result<_, _>>()?;
        let pair = |pair: &Value| Some((pair.text(1)?, pair.text(2)?));
        let footer = meta.list(5).iter().filter_map(pair).collect();
        let n_rows = groups.iter().try_fold(0_u64, |sum, (n, _)| sum.checked_add(*n));
        let n_rows = n_rows.ok_or_else(|| content("its footer is damaged"))?;
        Ok(Self { file, columns, footer, n_rows, groups })
    }

    /// Returns the value of a key of the metadata; `None` if there is no such key.
    #[must_use]
    pub fn footer(&self, key: &str) -> Option<&str> {
        self.footer.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str())
    }

    /// Returns the number of row groups.
    #[must_use]
    pub fn n_groups(&self) -> usize {
        self.groups.len()
    }

    /// Reads row group `group_idx` (from 0): the values of each column, in the order of `columns`.
    ///
    /// # Errors
    ///
    /// [`ParquetError`], if the file cannot be read or is damaged.
    ///
    /// # Panics
    ///
    /// If there is no such group.
    pub fn group(&mut self, group_idx: usize) -> Result<Vec<Values>, ParquetError> {
        let (n_rows, chunks) = self.groups[group_idx].clone();
        let mut all = Vec::with_capacity(chunks.len());
        for (k, chunk) in chunks.iter().enumerate() {
            let name = &self.columns[k].0;
            let damaged = || content(format!("the pages of column `{name}` are damaged"));
            let length = self.file.metadata()?.len();
            if chunk.offset.checked_add(chunk.size).is_none_or(|end| end > length) {
                return Err(damaged());
            }
            let mut bytes = vec![0; chunk.size as usize];
            self.file.seek(SeekFrom::Start(chunk.offset))?;
            self.file.read_exact(&mut bytes)?;
            let mut reader = Reader::new(&bytes);
            let head = reader.structure().ok_or_else(damaged)?;
            let of_data = head.field(5).ok_or_else(damaged)?;
            if of_data.int(2) != Some(PLAIN) || of_data.int(1) != Some(n_rows as i64) {
                return Err(content(format!("column `{name}` is not in one plain page: another program wrote it")));
            }
            let data = &bytes[reader.position()..];
            all.push(values(&self.columns[k].1, data, n_rows as usize).ok_or_else(damaged)?);
        }
        Ok(all)
    }
}

fn columns(meta: &Value) -> Result<Vec<(String, Values)>, ParquetError> {
    let schema = meta.list(2).get(1..).ok_or_else(|| content("it has no columns"))?;
    let column = |column: &Value| {
        let name = column.text(4).ok_or_else(|| content("a column has no name"))?;
        let kind = match column.int(1) {
            Some(DOUBLE) => Values::Doubles(Vec::new()),
            Some(INT64) => Values::Ints(Vec::new()),
            Some(BYTE_ARRAY) => Values::Texts(Vec::new()),
            _ => return Err(content(format!("column `{name}` is neither of doubles nor whole numbers nor texts"))),
        };
        if column.int(3).is_some_and(|repetition| repetition != 0) {
            return Err(content(format!("column `{name}` may lack values: another program wrote it")));
        }
        Ok((name, kind))
    };
    schema.iter().map(column).collect()
}

fn group(group: &Value, n_columns: usize) -> Result<(u64, Vec<Chunk>), ParquetError> {
    let damaged = || content("its footer is damaged");
    let n = group.int(3).and_then(|n| u64::try_from(n).ok()).ok_or_else(damaged)?;
    let chunk = |chunk: &Value| {
        let meta = chunk.field(3)?;
        let offset = u64::try_from(meta.int(9)?).ok()?;
        let size = u64::try_from(meta.int(7)?).ok()?;
        (meta.int(4) == Some(0)).then_some(Chunk { offset, size })
    };
    let chunks: Option<Vec<Chunk>> = group.list(1).iter().map(chunk).collect();
    let chunks = chunks.ok_or_else(|| content("its pages are compressed: another program wrote it"))?;
    if chunks.len() == n_columns { Ok((n, chunks)) } else { Err(damaged()) }
}

/// Plain values of a page; none if they are more or fewer than said.
fn values(kind: &Values, data: &[u8], n: usize) -> Option<Values> {
    let eights = || (n.checked_mul(8)? == data.len()).then_some(data.as_chunks::<8>().0);
    Some(match kind {
        Values::Doubles(_) => Values::Doubles(eights()?.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect()),
        Values::Ints(_) => Values::Ints(eights()?.iter().map(|bytes| i64::from_le_bytes(*bytes)).collect()),
        Values::Texts(_) => {
            let (mut texts, mut rest) = (Vec::new(), data);
            while let Some((length, behind)) = rest.split_first_chunk::<4>() {
                let (text, next) = behind.split_at_checked(u32::from_le_bytes(*length) as usize)?;
                texts.push(String::from_utf8(text.to_vec()).ok()?);
                rest = next;
            }
            (rest.is_empty() && texts.len() == n).then_some(Values::Texts(texts))?
        }
    })
}
