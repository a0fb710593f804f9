//! Independent jobs on all processors, with results in the order of the jobs.

use std::collections::VecDeque;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
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
    let (next, n_idle, caller) = (AtomicUsize::new(0), AtomicUsize::new(0), thread::current());
    let worker = || {
        let mut done = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= n {
                // said before the caller looks: a thread is not yet finished when it wakes another
                n_idle.fetch_add(1, Ordering::Release);
                caller.unpark();
                return done;
            }
            done.push((k, job(k)));
        }
    };
    let mut all: Vec<(usize, T)> = thread::scope(|scope| {
        let start = |_| thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, worker);
        let threads: Vec<_> = (0..n_threads).map(start).map(|thread| thread.expect("a thread can be made")).collect();
        let are_idle = || n_idle.load(Ordering::Acquire) == n_threads;
        while !(are_idle() || threads.iter().all(thread::ScopedJoinHandle::is_finished)) {
            between();
            thread::park_timeout(POLL_INTERVAL);
        }
        threads.into_iter().flat_map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    });
    all.sort_by_key(|(k, _)| *k);
    all.into_iter().map(|(_, done)| done).collect()
}

/// The processors of the machine, each for one piece of work at a time: a long one is not slowed down by all that begin
/// after it, and does not end last.
#[derive(Debug)]
pub(crate) struct Processors {
    queue: Mutex<Queue>,
    moved: Condvar,
}

/// Who waits for a processor.
#[derive(Debug, Default)]
struct Queue {
    n_free: usize,
    /// Numbers of those that wait, in the order in which they came.
    waiting: VecDeque<u64>,
    next: u64,
}

impl Processors {
    /// As many as there are.
    pub fn new() -> Self {
        Self::of(thread::available_parallelism().map_or(1, usize::from))
    }

    fn of(n_free: usize) -> Self {
        Self { queue: Mutex::new(Queue { n_free, ..Queue::default() }), moved: Condvar::new() }
    }

    /// Does a piece of work once a processor is free and all that have asked before have one.
    pub fn work<T>(&self, work: impl FnOnce() -> T) -> T {
        let mut queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner);
        let own = queue.next;
        queue.next += 1;
        queue.waiting.push_back(own);
        while queue.n_free == 0 || queue.waiting.front() != Some(&own) {
            queue = self.moved.wait(queue).unwrap_or_else(PoisonError::into_inner);
        }
        queue.waiting.pop_front();
        queue.n_free -= 1;
        drop(queue);
        // the next one may have a free processor, too
        self.moved.notify_all();
        let _held = Held(self);
        work()
    }
}

/// A processor that is given back when it is dropped, after a panic, too.
struct Held<'a>(&'a Processors);

impl Drop for Held<'_> {
    fn drop(&mut self) {
        self.0.queue.lock().unwrap_or_else(PoisonError::into_inner).n_free += 1;
        self.0.moved.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_work_is_done_at_a_time_than_there_are_processors_and_in_order() {
        work_on(3);
        // one at a time: strictly in the order in which they came
        assert_eq!(work_on(1), (0..20).collect::<Vec<_>>());
    }

    /// Lets twenty threads, one after the other, ask for one of `n_free` processors, all of which are taken until the
    /// last has asked. Returns the order in which they worked.
    fn work_on(n_free: usize) -> Vec<usize> {
        let processors = Processors::of(n_free);
        let (n_now, n_most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let done: Mutex<Vec<usize>> = Mutex::default();
        let piece = |k: usize| {
            processors.work(|| {
                done.lock().unwrap().push(k);
                n_most.fetch_max(n_now.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                thread::sleep(Duration::from_millis(1));
                n_now.fetch_sub(1, Ordering::SeqCst);
            });
        };
        // all processors are taken while the others come, one after the other
        let (n_taken, is_open) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let take = || {
            processors.work(|| {
                n_taken.fetch_add(1, Ordering::SeqCst);
                while is_open.load(Ordering::SeqCst) == 0 {
                    thread::yield_now();
                }
            });
        };
        thread::scope(|scope| {
            (0..n_free).for_each(|_| drop(scope.spawn(take)));
            while n_taken.load(Ordering::SeqCst) < n_free {
                thread::yield_now();
            }
            for k in 0..20 {
                scope.spawn(move || piece(k));
                while processors.queue.lock().unwrap().waiting.len() <= k {
                    thread::yield_now();
                }
            }
            is_open.store(1, Ordering::SeqCst);
        });
        let done = done.into_inner().unwrap();
        let mut sorted = done.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..20).collect::<Vec<_>>());
        assert!(n_most.load(Ordering::SeqCst) <= n_free);
        done
    }

    #[test]
    fn a_processor_is_given_back_after_a_panic() {
        let processors = Processors::of(2);
        for _ in 0..4 {
            let panics = std::panic::AssertUnwindSafe(|| processors.work(|| panic!("on purpose")));
            assert!(std::panic::catch_unwind(panics).is_err());
        }
        assert_eq!(processors.work(|| 3), 3);
    }
}
