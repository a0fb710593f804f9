//! All parts in one table: each run once, the same bytes whoever made the parts.

use std::fs::File;
use std::hash::Hasher;
use std::io::{BufWriter, ErrorKind, Write};

use sincro_sim::file::{FileError, partial_of_process, put_in_shared_place};
use sincro_sim::formats::parquet::{Values, Writer};
use twox_hash::XxHash3_64;

use super::{Store, StoreError};

/// Rows of a row group of the table.
const ROWS_PER_GROUP: usize = 1 << 16;

/// Account of [`collect`]: the table of all runs that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Collected {
    /// Number of rows, one for each run.
    pub n_rows: u64,
    /// Hash of the traces of all runs in their order, 16 hexadecimal digits: equal for identical results.
    pub trace: String,
    /// Number of unfinished files that were deleted; processes that were killed while they wrote had left them.
    pub n_partial: usize,
}

/// Collects the parts of a campaign into the table `runs.parquet` in its folder: each run once, in the order of their
/// numbers.
///
/// # Errors
///
/// [`StoreError::Busy`]: another process collects. [`StoreError::Missing`]: parts are missing. [`StoreError::Damaged`]:
/// a part is damaged or of another campaign. [`StoreError::Foreign`]: other files are among the parts.
/// [`StoreError::File`]: a file cannot be read or written. The table is then as it was before.
pub fn collect(store: &Store) -> Result<Collected, StoreError> {
    let lock_path = store.folder.join(".lock");
    let lock = File::create(&lock_path).map_err(|e| FileError::new("write", &lock_path, e))?;
    // the system releases it when the process ends, however it ends
    match lock.try_lock() {
        Ok(()) => {}
        Err(std::fs::TryLockError::WouldBlock) => return Err(StoreError::Busy(store.folder.clone())),
        Err(std::fs::TryLockError::Error(error)) => return Err(FileError::new("lock", &lock_path, error).into()),
    }
    refuse_foreign(store)?;
    let path = store.runs_path();
    let own = partial_of_process(&path);
    let file = File::create(&own).map_err(|e| FileError::new("write", &path, e))?;
    let collected = match write(store, file) {
        Ok(collected) => collected,
        Err(error) => {
            let _ = std::fs::remove_file(&own);
            return Err(error);
        }
    };
    put_in_shared_place(&own, &path, Ok(()))?;
    Ok(Collected { n_partial: remove_partial(store), ..collected })
}

fn write(store: &Store, file: File) -> Result<Collected, StoreError> {
    let cannot = |error: std::io::Error| StoreError::from(FileError::new("write", &store.runs_path(), error));
    let layout = store.layout();
    let columns = layout.columns();
    let mut pending: Vec<Values> = columns.iter().map(|(_, kind)| kind.clone()).collect();
    let trace_column = columns.iter().position(|(name, _)| name == "trace").expect("a fixed column");
    let mut trace = XxHash3_64::with_seed(0);
    let mut writer = Writer::new(BufWriter::new(file), "runs", columns).map_err(cannot)?;
    let (mut missing, mut n_rows) = (Vec::<(u64, u64)>::new(), 0);
    for part in 0..store.n_parts() {
        let group = match store.read_part(part) {
            Ok(group) => group,
            Err(StoreError::File(error)) if error.cause.kind() == ErrorKind::NotFound => {
                let (first, last) = store.range(part);
                match missing.last_mut() {
                    Some((_, end)) if *end + 1 == first => *end = last,
                    _ => missing.push((first, last)),
                }
                continue;
            }
            Err(error) => return Err(error),
        };
        if !missing.is_empty() {
            continue;
        }
        if let Values::Texts(traces) = &group[trace_column] {
            traces.iter().for_each(|text| trace.write(text.as_bytes()));
        }
        n_rows += group[0].len() as u64;
        for (pending, values) in pending.iter_mut().zip(group) {
            append(pending, values);
        }
        while pending[0].len() >= ROWS_PER_GROUP {
            let rest: Vec<Values> = pending.iter_mut().map(|values| split(values, ROWS_PER_GROUP)).collect();
            writer.group(&pending).map_err(cannot)?;
            pending = rest;
        }
    }
    if !missing.is_empty() {
        return Err(StoreError::Missing(missing));
    }
    if !pending[0].is_empty() {
        writer.group(&pending).map_err(cannot)?;
    }
    let trace = format!("{:016x}", trace.finish());
    let manifest = &store.manifest;
    let mut footer = vec![
        ("input".to_owned(), manifest.input.clone()),
        ("version".to_owned(), manifest.sincro_version.clone()),
        ("trace".to_owned(), trace.clone()),
    ];
    let units = manifest.parameters.iter().chain(&manifest.measures).filter(|c| !c.unit.is_empty());
    footer.extend(units.map(|c| (format!("unit of {}", c.name), c.unit.clone())));
    let mut sink = writer.finish(&footer).map_err(cannot)?;
    sink.flush().and_then(|()| sink.get_ref().sync_all()).map_err(cannot)?;
    Ok(Collected { n_rows, trace, n_partial: 0 })
}

fn append(to: &mut Values, from: Values) {
    match (to, from) {
        (Values::Doubles(to), Values::Doubles(from)) => to.extend(from),
        (Values::Ints(to), Values::Ints(from)) => to.extend(from),
        (Values::Texts(to), Values::Texts(from)) => to.extend(from),
        _ => unreachable!("the columns of a part were compared with those of the campaign"),
    }
}

/// Leaves the first `n` values and gives the rest.
fn split(values: &mut Values, n: usize) -> Values {
    match values {
        Values::Doubles(values) => Values::Doubles(values.split_off(n)),
        Values::Ints(values) => Values::Ints(values.split_off(n)),
        Values::Texts(values) => Values::Texts(values.split_off(n)),
    }
}

/// Refuses files among the parts that no shard of this campaign has written.
fn refuse_foreign(store: &Store) -> Result<(), StoreError> {
    let folder = store.folder.join("parts");
    let entries = std::fs::read_dir(&folder).map_err(|e| FileError::new("read the folder", &folder, e))?;
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.ends_with(".partial") {
            continue;
        }
        let of_part = || {
            let (first, last) = name.strip_prefix("part-")?.strip_suffix(".parquet")?.split_once('-')?;
            let (first, last) = (first.parse::<u64>().ok()?, last.parse::<u64>().ok()?);
            let part = first / store.manifest.rows_per_part;
            (part < store.n_parts() && store.range(part) == (first, last)).then_some(())
        };
        if of_part().is_none() {
            let message = format!("`{}` is not a part of this campaign", entry.path().display());
            return Err(StoreError::Foreign(message, "take it away, and collect again".into()));
        }
    }
    Ok(())
}

/// Takes away what killed processes left; the table is complete, so that nobody needs it.
fn remove_partial(store: &Store) -> usize {
    let entries = std::fs::read_dir(store.folder.join("parts")).into_iter().flatten().flatten();
    let partial = entries.filter(|entry| entry.file_name().to_string_lossy().ends_with(".partial"));
    partial.filter(|entry| std::fs::remove_file(entry.path()).is_ok()).count()
}
