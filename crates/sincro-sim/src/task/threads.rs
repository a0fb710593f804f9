//! Groups of worlds shared out to threads that stay from step to step: starting one takes as long as a step of hundreds
//! of worlds.

use rayon_core::{ThreadPool, ThreadPoolBuilder};

use super::group::{Group, Scratch};
use super::plan::Plan;

/// Threads and what each works with; the calling thread is the first.
#[derive(Debug)]
pub(super) struct Threads {
    scratches: Vec<Scratch>,
    others: Option<Pool>,
}

/// Threads beyond the calling one.
#[derive(Debug)]
struct Pool {
    pool: Option<ThreadPool>,
    /// Process that they are part of: one that was forked from it has none of them.
    process: u32,
}

impl Pool {
    /// The threads, in the process that has them.
    fn threads(&self) -> Option<&ThreadPool> {
        self.pool.as_ref().filter(|_| self.process == std::process::id())
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
        let others = others.map(|pool| Pool { pool: Some(pool), process: std::process::id() });
        Self { scratches: (0..n.max(1)).map(|_| Scratch::new(plan, width)).collect(), others }
    }

    /// Works on all groups. `share` gives each thread its part of the arguments, by its number of worlds and in their
    /// order.
    pub fn share<T: Send>(
        &mut self,
        groups: &mut [Group],
        mut share: impl FnMut(usize) -> T,
        work: impl Fn(&mut [Group], T, &mut Scratch) + Sync,
    ) {
        let others = self.others.as_ref().and_then(Pool::threads);
        let n = if others.is_some() { self.scratches.len() } else { 1 };
        let size = groups.len().div_ceil(n).max(1);
        let mut parts = groups.chunks_mut(size).zip(&mut self.scratches).map(|(groups, scratch)| {
            let part = share(groups.iter().map(Group::n_worlds).sum());
            (groups, part, scratch)
        });
        let Some((own_groups, own_part, own_scratch)) = parts.next() else { return };
        let Some(pool) = others else { return work(own_groups, own_part, own_scratch) };
        let work = &work;
        pool.in_place_scope(|scope| {
            for (groups, part, scratch) in parts {
                scope.spawn(move |_| work(groups, part, scratch));
            }
            work(own_groups, own_part, own_scratch);
        });
    }
}
