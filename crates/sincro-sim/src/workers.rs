//! Independent jobs on all processors, with results in the order of the jobs.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

/// Time between two looks at threads that are waited for, and two calls of `between` of [`on_all_processors`].
pub(crate) const POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Stack of a thread, as large as that of the first thread of a program.
pub(crate) const STACK_BYTES: usize = 8 << 20;

/// Results of `job(0)` to `job(n − 1)`, made on as many threads as there are processors. Until the last is done
/// `between` is called from time to time, on the calling thread.
///
/// ```
/// use sincro_sim::workers::on_all_processors;
///
/// assert_eq!(on_all_processors(4, &|k| k * k, &mut || ()), [0, 1, 4, 9]);
/// ```
///
/// # Panics
///
/// If a job panics, or no thread can be made.
pub fn on_all_processors<T: Send>(n: usize, job: &(dyn Fn(usize) -> T + Sync), between: &mut dyn FnMut()) -> Vec<T> {
    let n_threads = thread::available_parallelism().map_or(1, usize::from).min(n);
    let (next, caller) = (AtomicUsize::new(0), thread::current());
    let worker = || {
        let mut done = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= n {
                caller.unpark();
                return done;
            }
            done.push((k, job(k)));
        }
    };
    let mut all: Vec<(usize, T)> = thread::scope(|scope| {
        let start = |_| thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, worker);
        let threads: Vec<_> = (0..n_threads).map(start).map(|thread| thread.expect("a thread can be made")).collect();
        while !threads.iter().all(thread::ScopedJoinHandle::is_finished) {
            between();
            thread::park_timeout(POLL_INTERVAL);
        }
        threads.into_iter().flat_map(|thread| thread.join().expect("a job does not panic")).collect()
    });
    all.sort_by_key(|(k, _)| *k);
    all.into_iter().map(|(_, done)| done).collect()
}
