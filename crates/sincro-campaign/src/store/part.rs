//! One part of the results: written whole, and verified before it is believed.

use std::fs::File;
use std::hash::Hasher;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::Path;

use sincro_sim::file::{FileError, partial_of_process, put_in_shared_place};
use sincro_sim::formats::parquet::{ParquetFile, Values, Writer};
use twox_hash::XxHash3_64;

use super::{Store, StoreError, damaged};
use crate::row::Row;

/// State of a part.
#[derive(Debug)]
pub(crate) enum PartState {
    /// Its file is not there.
    Missing,
    /// Its file is whole and belongs to this campaign.
    Whole,
    /// Its file is there and cannot be used; the reason.
    Damaged(String),
}

impl Store {
    /// Writes the rows of a part.
    ///
    /// # Errors
    ///
    /// The disk is full, or the folder takes no files.
    pub(crate) fn write_part(&self, part: u64, rows: &[Row]) -> Result<(), StoreError> {
        // before the part: where that is, its series are
        if !self.manifest.signals.is_empty() {
            self.write_signals(part, rows)?;
        }
        let path = self.part_path(part);
        let group = self.layout().group(rows);
        let footer = [
            ("input".to_owned(), self.manifest.input.clone()),
            ("version".to_owned(), self.manifest.sincro_version.clone()),
            ("content".to_owned(), content_hash(&group)),
        ];
        let own = partial_of_process(&path);
        let written = File::create(&own).and_then(|file| {
            let mut writer = Writer::new(BufWriter::new(file), "runs", self.layout().columns())?;
            writer.group(&group)?;
            let mut sink = writer.finish(&footer)?;
            sink.flush()?;
            sink.get_ref().sync_all()
        });
        match put_in_shared_place(&own, &path, written) {
            // another process made the same part, and collected: it took away what it held for incomplete
            Err(error) if error.cause.kind() == ErrorKind::NotFound && path.is_file() => Ok(()),
            placed => Ok(placed?),
        }
    }

    /// Writes the long table of the signals of a part: a row for each run and recorded time.
    ///
    /// # Errors
    ///
    /// The disk is full, or the folder takes no files.
    fn write_signals(&self, part: u64, rows: &[Row]) -> Result<(), StoreError> {
        let path = self.signals_path(part);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| FileError::new("create the folder", folder, e))?;
        }
        let names = ["k", "t"].into_iter().chain(self.manifest.signals.iter().map(String::as_str));
        let mut group: Vec<(String, Values)> = names
            .map(|name| {
                let values = if name == "k" { Values::Ints(Vec::new()) } else { Values::Doubles(Vec::new()) };
                (name.to_owned(), values)
            })
            .collect();
        for row in rows {
            let n = row.series.first().map_or(0, Vec::len);
            for (i, (_, values)) in group.iter_mut().enumerate() {
                match values {
                    Values::Ints(values) => values.extend(std::iter::repeat_n(row.k as i64, n)),
                    Values::Doubles(values) => values.extend(row.series.get(i - 1).into_iter().flatten()),
                    Values::Texts(_) => {}
                }
            }
        }
        let (names, values): (Vec<String>, Vec<Values>) = group.into_iter().unzip();
        let columns = names.into_iter().zip(values.iter().map(Values::emptied)).collect();
        let footer = [
            ("input".to_owned(), self.manifest.input.clone()),
            ("version".to_owned(), self.manifest.sincro_version.clone()),
            ("content".to_owned(), content_hash(&values)),
        ];
        let own = partial_of_process(&path);
        let written = File::create(&own).and_then(|file| {
            let mut writer = Writer::new(BufWriter::new(file), "signals", columns)?;
            if !values[0].is_empty() {
                writer.group(&values)?;
            }
            let mut sink = writer.finish(&footer)?;
            sink.flush()?;
            sink.get_ref().sync_all()
        });
        Ok(put_in_shared_place(&own, &path, written)?)
    }

    /// Refuses a part whose series are not there or were made of other runs.
    fn check_signals(&self, part: u64) -> Result<(), StoreError> {
        if self.manifest.signals.is_empty() {
            return Ok(());
        }
        let path = self.signals_path(part);
        let file = ParquetFile::open(&path).map_err(|error| damaged(&path, error))?;
        let input = file.footer("input").unwrap_or("none");
        if input == self.manifest.input {
            return Ok(());
        }
        Err(StoreError::Damaged(path, format!("it belongs to another campaign, of inputs {input}")))
    }

    /// Reads the rows of a part as columns and verifies them.
    ///
    /// # Errors
    ///
    /// It is not there, damaged, or of another campaign.
    pub(crate) fn read_part(&self, part: u64) -> Result<Vec<Values>, StoreError> {
        let path = self.part_path(part);
        let mut file = ParquetFile::open(&path).map_err(|error| damaged(&path, error))?;
        let refuse = |reason: String| Err(StoreError::Damaged(path.clone(), reason));
        let input = file.footer("input").unwrap_or("none");
        if input != self.manifest.input {
            return refuse(format!("it belongs to another campaign, of inputs {input}"));
        }
        if file.columns != self.layout().columns() || file.n_groups() != 1 {
            return refuse("its columns are others than those of the campaign".into());
        }
        let content = file.footer("content").unwrap_or("").to_owned();
        let group = file.group(0).map_err(|error| damaged(&path, error))?;
        if content != content_hash(&group) {
            return refuse("its content is not what was written: it has another hash".into());
        }
        let (first, last) = self.range(part);
        let is_numbered = matches!(&group[0], Values::Ints(k) if k.iter().copied().eq(first as i64..=last as i64));
        if !is_numbered {
            return refuse(format!("it does not hold each of the runs {first} to {last} once, in their order"));
        }
        self.check_signals(part)?;
        Ok(group)
    }

    /// State of a part; everything in it is read.
    ///
    /// # Errors
    ///
    /// A file that is there cannot be read.
    pub(crate) fn part_state(&self, part: u64) -> Result<PartState, StoreError> {
        match self.read_part(part) {
            Ok(_) => Ok(PartState::Whole),
            Err(StoreError::File(error)) if error.cause.kind() == ErrorKind::NotFound => Ok(PartState::Missing),
            Err(StoreError::Damaged(_, reason)) => Ok(PartState::Damaged(reason)),
            Err(error) => Err(error),
        }
    }

    /// Returns the number of parts whose file is there, without reading them.
    ///
    /// # Errors
    ///
    /// [`FileError`] with the path of the folder, if it cannot be read.
    pub fn n_present(&self) -> Result<u64, FileError> {
        let folder = self.folder.join("parts");
        let entries = std::fs::read_dir(&folder).map_err(|e| FileError::new("read the folder", &folder, e))?;
        let is_part = |path: &Path| path.extension().is_some_and(|e| e == "parquet");
        Ok(entries.flatten().filter(|entry| is_part(&entry.path())).count() as u64)
    }
}

/// Hash of all values, bit by bit.
fn content_hash(group: &[Values]) -> String {
    let mut hasher = XxHash3_64::with_seed(0);
    for values in group {
        match values {
            Values::Doubles(values) => values.iter().for_each(|x| hasher.write(&x.to_bits().to_le_bytes())),
            Values::Ints(values) => values.iter().for_each(|x| hasher.write(&x.to_le_bytes())),
            Values::Texts(values) => values.iter().for_each(|text| {
                hasher.write(&(text.len() as u64).to_le_bytes());
                hasher.write(text.as_bytes());
            }),
        }
    }
    format!("{:016x}", hasher.finish())
}
