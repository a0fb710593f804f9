//! Runs of a shard on all processors, part by part.
//!
//! Threads take runs in their order. Whichever completes a part writes it; no more parts are open at a time than there
//! are threads, and one. A part that is whole is not made again, so that a shard can be killed and started at any time.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use sincro_sim::run::RunError;

use crate::campaign::Campaign;
use crate::row::Row;
use crate::store::{PartState, Store, StoreError};

/// Share of a campaign that one process makes: of `count` equal ones, number `index`. Shards of different processes or
/// machines are put together by [`crate::collect`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of the share, 1 to `count`.
    pub index: u64,
    /// Number of shares, at least 1.
    pub count: u64,
}

impl Shard {
    /// Whole campaign as one share, 1/1.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// Reads a shard as `--shard` takes it, `I/N` with 1 ≤ I ≤ N, such as `2/7`.
    ///
    /// # Errors
    ///
    /// A message for the user, if the text is not of this form.
    ///
    /// ```
    /// use sincro_campaign::Shard;
    ///
    /// let shard = Shard::parse("2/7").unwrap();
    /// assert!(shard.has(1) && shard.has(8) && !shard.has(0)); // parts 1, 8, 15 …
    /// assert!(Shard::parse("8/7").is_err());
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) => Ok(Self { index, count }),
            _ => Err(format!("`{text}` is no shard: write I/N with I from 1 to N, such as 2/7")),
        }
    }

    /// Returns true if part `part` of the results (index from 0) belongs to this share: every `count`-th part does.
    #[must_use]
    pub fn has(self, part: u64) -> bool {
        part % self.count == self.index - 1
    }
}

/// Error of [`run_shard`]; whole parts that were written before are kept.
#[derive(Debug)]
pub enum ShardError {
    /// A run could not be begun, such as for a measured signal that does not exist.
    Run(RunError),
    /// The folder of results cannot be read or written, or holds a damaged part.
    Store(StoreError),
}

impl From<StoreError> for ShardError {
    fn from(error: StoreError) -> Self {
        Self::Store(error)
    }
}

/// Account of a shard after [`run_shard`], in numbers of runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShardDone {
    /// Number of runs that were in the folder before.
    pub n_found: u64,
    /// Number of runs that were made and written.
    pub n_made: u64,
    /// Number of runs of the shard that are still missing; 0 unless it was interrupted.
    pub n_left: u64,
}

/// Runs that are to be made and those that are done.
struct Queue {
    /// Parts that are to be made, in their order.
    parts: Vec<u64>,
    /// The part that runs are taken of, and the next run of it.
    part_idx: usize,
    next: u64,
    /// Rows of parts that are not complete.
    open: BTreeMap<u64, Vec<Row>>,
    n_done: u64,
    failure: Option<ShardError>,
}

/// Makes all runs of a shard that are not in the folder yet, on `n_threads` threads (at least one), and writes them
/// part by part. After each run `progress` receives the number of runs of the shard that are done, and of all. Once
/// `interrupt` is true no further run begins; the same call continues later.
///
/// # Errors
///
/// [`ShardError::Store`]: the folder cannot be read or written, or a part is damaged. [`ShardError::Run`]: a run could
/// not be begun. Parts that are complete are kept.
pub fn run_shard(
    campaign: &Campaign,
    store: &Store,
    shard: Shard,
    n_threads: usize,
    interrupt: &AtomicBool,
    progress: &mut (dyn FnMut(u64, u64) + Send),
) -> Result<ShardDone, ShardError> {
    let mine: Vec<u64> = (0..store.n_parts()).filter(|part| shard.has(*part)).collect();
    let size = |part: u64| {
        let (first, last) = store.range(part);
        last - first + 1
    };
    let mut parts = Vec::new();
    for part in &mine {
        match store.part_state(*part)? {
            PartState::Whole => {}
            PartState::Missing => parts.push(*part),
            PartState::Damaged(reason) => {
                return Err(StoreError::Damaged(store.part_path(*part), reason).into());
            }
        }
    }
    let n_all: u64 = mine.iter().map(|part| size(*part)).sum();
    let n_todo: u64 = parts.iter().map(|part| size(*part)).sum();
    let n_found = n_all - n_todo;
    let next = parts.first().map_or(0, |part| store.range(*part).0);
    let queue = Queue { parts, part_idx: 0, next, open: BTreeMap::new(), n_done: 0, failure: None };
    let (queue, progress, stop) = (Mutex::new(queue), Mutex::new(progress), AtomicBool::new(false));
    let take = || {
        let mut queue = queue.lock().expect("no run panics");
        let part = *queue.parts.get(queue.part_idx)?;
        let k = queue.next;
        if k == store.range(part).1 {
            queue.part_idx += 1;
            queue.next = queue.parts.get(queue.part_idx).map_or(0, |part| store.range(*part).0);
        } else {
            queue.next += 1;
        }
        Some((part, k))
    };
    // rows of a part that has become complete
    let give = |part: u64, row: Row| {
        let mut queue = queue.lock().expect("no run panics");
        let rows = queue.open.entry(part).or_default();
        rows.push(row);
        if rows.len() as u64 != size(part) {
            return None;
        }
        let mut rows = queue.open.remove(&part).expect("it was there");
        rows.sort_by_key(|row| row.k);
        Some(rows)
    };
    let fail = |error: ShardError| {
        stop.store(true, Ordering::Relaxed);
        queue.lock().expect("no run panics").failure.get_or_insert(error);
    };
    let worker = || {
        while !interrupt.load(Ordering::Relaxed) && !stop.load(Ordering::Relaxed) {
            let Some((part, k)) = take() else { return };
            let row = match campaign.run(k, interrupt) {
                Ok(Some(row)) => row,
                Ok(None) => return,
                Err(error) => return fail(ShardError::Run(error)),
            };
            let complete = give(part, row);
            if let Some(rows) = complete
                && let Err(error) = store.write_part(part, &rows)
            {
                return fail(error.into());
            }
            let n_done = {
                let mut queue = queue.lock().expect("no run panics");
                queue.n_done += 1;
                queue.n_done
            };
            progress.lock().expect("progress does not panic")(n_found + n_done, n_all);
        }
    };
    std::thread::scope(|scope| {
        let n = n_threads.clamp(1, (n_todo.max(1)) as usize);
        let others: Vec<_> = (1..n).map(|_| scope.spawn(worker)).collect();
        worker();
        others.into_iter().for_each(|thread| thread.join().expect("a run does not panic"));
    });
    let queue = queue.into_inner().expect("no run panics");
    if let Some(failure) = queue.failure {
        return Err(failure);
    }
    let n_open: u64 = queue.open.values().map(|rows| rows.len() as u64).sum();
    let n_made = queue.n_done - n_open;
    Ok(ShardDone { n_found, n_made, n_left: n_todo - n_made })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_the_parts_without_overlap() {
        for count in [1, 2, 7, 20] {
            for part in 0..50 {
                let owners = (1..=count).filter(|index| Shard { index: *index, count }.has(part)).count();
                assert_eq!(owners, 1);
            }
        }
        assert_eq!(Shard::parse("2/7"), Ok(Shard { index: 2, count: 7 }));
        for wrong in ["0/7", "8/7", "2", "a/b", "1/0"] {
            assert!(Shard::parse(wrong).is_err(), "{wrong}");
        }
    }
}
