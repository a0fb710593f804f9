//! Groups of worlds shared out to threads that stay from step to step: starting one takes as long as a step of hundreds
//! of worlds.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rayon_core::{ThreadPool, ThreadPoolBuilder};

use super::group::{Group, Scratch};
use super::plan::Plan;

/// Time for which threads stay awake after a step, since the next one comes soon, and the calling one for the others:
/// to wake one takes as long as a step of thousands of small worlds.
const AWAKE: Duration = Duration::from_micros(150);

/// Parts that the groups are cut into for each thread.
const PARTS: usize = 4;

/// Calls after which it is tried again if the other threads are of use, and those of them that try it: first without
/// them, then with them.
const CALLS_OF_TRIALS: u64 = 256;
const TRIALS: u64 = 4;

/// Threads and what each works with; the calling thread is the first.
#[derive(Debug)]
pub(super) struct Threads {
    scratches: Vec<Scratch>,
    others: Option<Pool>,
    trials: Trials,
}

/// Trials of the calling thread alone and of all threads. Small steps take longer with others, and so do all where the
/// system has better uses for its processors; results do not depend on it.
#[derive(Debug, Default)]
struct Trials {
    n_calls: u64,
    /// Shortest call of this round of trials: alone, with all threads.
    shortest: [Duration; 2],
}

impl Trials {
    /// Returns true if the next call is one with all threads.
    fn next_is_shared(&mut self) -> bool {
        let k = self.n_calls % CALLS_OF_TRIALS;
        if k == 0 {
            self.shortest = [Duration::MAX; 2];
        }
        if k < 2 * TRIALS { k >= TRIALS } else { self.shortest[1] < self.shortest[0] }
    }

    /// Notes what a call took.
    fn note(&mut self, is_shared: bool, elapsed: Duration) {
        let k = self.n_calls % CALLS_OF_TRIALS;
        self.n_calls += 1;
        // the first with all threads wakes them
        if k < 2 * TRIALS && k != TRIALS {
            let shortest = &mut self.shortest[usize::from(is_shared)];
            *shortest = elapsed.min(*shortest);
        }
    }
}

/// Threads beyond the calling one.
#[derive(Debug)]
struct Pool {
    pool: Option<ThreadPool>,
    /// Process that they are part of: one that was forked from it has none of them.
    process: u32,
    /// Number of calls so far, which ends the waiting of threads for the next.
    calls: Arc<AtomicU64>,
}

impl Pool {
    /// The threads, in the process that has them.
    fn threads(&self) -> Option<&ThreadPool> {
        self.pool.as_ref().filter(|_| self.process == std::process::id())
    }

    /// Keeps `n` threads awake until the next call comes, or for a short time.
    fn stay_awake(&self, pool: &ThreadPool, n: usize) {
        let call = self.calls.load(Ordering::Relaxed);
        for _ in 0..n {
            let calls = Arc::clone(&self.calls);
            pool.spawn(move || {
                let start = Instant::now();
                while calls.load(Ordering::Relaxed) == call && start.elapsed() < AWAKE {
                    core::hint::spin_loop();
                }
            });
        }
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        if self.threads().is_none() {
            // nobody is there to be told, and locks may be held for ever
            core::mem::forget(self.pool.take());
        }
    }
}

impl Threads {
    /// `n` threads, for groups of up to `width` worlds. Where the system gives none, the calling thread does all.
    pub fn new(plan: &Plan, n: usize, width: usize) -> Self {
        let others = (n > 1).then(|| ThreadPoolBuilder::new().num_threads(n - 1).build().ok()).flatten();
        let others = others.map(|pool| Pool { pool: Some(pool), process: std::process::id(), calls: Arc::default() });
        let scratches = (0..n.max(1)).map(|_| Scratch::new(plan, width)).collect();
        Self { scratches, others, trials: Trials::default() }
    }

    /// Works on all groups. `share` gives each part of them its arguments, by its number of worlds and in their order;
    /// threads take parts as they come to them, so that none waits for one that the system has put aside.
    pub fn share<T: Send>(
        &mut self,
        groups: &mut [Group],
        mut share: impl FnMut(usize) -> T,
        work: impl Fn(&mut [Group], T, &mut Scratch) + Sync,
    ) {
        let start = Instant::now();
        let others = self.others.as_ref().and_then(|others| Some((others, others.threads()?)));
        let is_shared = others.is_some() && self.trials.next_is_shared();
        let others = others.filter(|_| is_shared);
        let n_parts = if others.is_some() { PARTS * self.scratches.len() } else { 1 };
        let size = groups.len().div_ceil(n_parts).max(1);
        let parts = groups.chunks_mut(size).map(|groups| {
            let arguments = share(groups.iter().map(Group::n_worlds).sum());
            (groups, arguments)
        });
        let Some((own_scratch, scratches)) = self.scratches.split_first_mut() else { return };
        let Some((others, pool)) = others else {
            parts.for_each(|(groups, arguments)| work(groups, arguments, own_scratch));
            return self.trials.note(false, start.elapsed());
        };
        others.calls.fetch_add(1, Ordering::Relaxed);
        let parts: Vec<_> = parts.map(|part| Mutex::new(Some(part))).collect();
        let (next, n_done) = (&AtomicUsize::new(0), &AtomicUsize::new(0));
        let work_on_parts = &|scratch: &mut Scratch| {
            while let Some(part) = parts.get(next.fetch_add(1, Ordering::Relaxed)) {
                let part = part.lock().unwrap_or_else(PoisonError::into_inner).take();
                part.into_iter().for_each(|(groups, arguments)| work(groups, arguments, scratch));
            }
        };
        pool.in_place_scope(|scope| {
            let n_others = scratches.len();
            for scratch in scratches {
                scope.spawn(move |_| {
                    work_on_parts(scratch);
                    n_done.fetch_add(1, Ordering::Relaxed);
                });
            }
            work_on_parts(own_scratch);
            // the scope itself waits for all of them, asleep
            let waits = Instant::now();
            while n_done.load(Ordering::Relaxed) < n_others && waits.elapsed() < AWAKE {
                core::hint::spin_loop();
            }
        });
        others.stay_awake(pool, self.scratches.len() - 1);
        self.trials.note(true, start.elapsed());
    }
}
