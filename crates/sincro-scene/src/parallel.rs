//! Independent pieces of work on several threads; the result does not depend on how many there are.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Limit of threads: what they work on is in memory at the same time.
const MAX_THREADS: usize = 8;

/// Returns `f(0)`, …, `f(n − 1)` in this order, computed on as many threads as the machine has cores, 8 at most.
///
/// ```
/// let squares = sincro_scene::parallel::map(4, |k| k * k);
/// assert_eq!(squares, [0, 1, 4, 9]);
/// ```
///
/// # Panics
///
/// If `f` panics.
pub fn map<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let n_threads = std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS).min(n);
    if n_threads <= 1 {
        return (0..n).map(f).collect();
    }
    let (next, results) = (AtomicUsize::new(0), Mutex::new((0..n).map(|_| None).collect::<Vec<Option<T>>>()));
    let work = || {
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= n {
                break;
            }
            let result = f(k);
            results.lock().unwrap_or_else(PoisonError::into_inner)[k] = Some(result);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..n_threads {
            scope.spawn(work);
        }
        work();
    });
    let results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.into_iter().map(|result| result.expect("every index was taken by a thread")).collect()
}
