//! Tasks of scenes: many worlds at once for reinforcement learning, each with its own random starts.
//!
//! [`TaskWorlds`] steps all worlds by one action each and gives observations, rewards and the ends of episodes. Worlds
//! that lanes can advance together do so (fixed steps; no contacts, diagrams, scripts and limited drives), the others
//! are lock-steps of their own; threads share them out. Nothing that a world gives depends on its neighbours: the same
//! seed gives the same episodes on any number of worlds, lanes and threads.
//!
//! | file | content |
//! |---|---|
//! | `plan` | the task with its names resolved, and the draws of an episode |
//! | `lanes` | a bundle of worlds in lanes |
//! | `single` | a world as a lock-step |
//! | `group` | episodes of a bundle: actions to commands, formulas, ends, autoreset |

mod group;
mod lanes;
mod plan;
mod single;

use std::sync::Arc;

use group::{Buffers, Group};
pub use plan::Plan;

use crate::load::Loaded;
use sincro_scene::diagnostic::Diagnostics;

/// Treatment of a world whose episode has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// It begins anew at its next step, which ignores the action and has the reward 0.
    NextStep,
    /// It begins anew in the step that ends it; the last observation of the old episode is kept apart.
    SameStep,
    /// It stays as it is until it is reset; its steps do nothing.
    Disabled,
}

/// Results of a step, world by world.
#[derive(Clone, Debug, Default)]
pub struct Step {
    /// Observations, `n_worlds × n_observations` row by row.
    pub observations: Vec<f64>,
    /// Rewards.
    pub rewards: Vec<f64>,
    /// True where the episode came to its end.
    pub terminated: Vec<bool>,
    /// True where it was cut off by its time limit, or because the world could not go on.
    pub truncated: Vec<bool>,
    /// True where the world could not go on: its state is not finite, a block or the solver failed.
    pub stopped: Vec<bool>,
    /// Last observations of the episodes that ended, where worlds begin anew in the same step.
    pub final_observations: Vec<f64>,
}

impl Step {
    /// Room for `n` worlds with `n_observations` numbers each.
    #[must_use]
    pub fn new(n: usize, n_observations: usize) -> Self {
        Self {
            observations: vec![0.0; n * n_observations],
            rewards: vec![0.0; n],
            terminated: vec![false; n],
            truncated: vec![false; n],
            stopped: vec![false; n],
            final_observations: vec![0.0; n * n_observations],
        }
    }
}

/// Many worlds of a task.
#[derive(Debug)]
pub struct TaskWorlds {
    plan: Arc<Plan>,
    groups: Vec<Group>,
    n: usize,
    threads: usize,
}

impl TaskWorlds {
    /// `n` worlds of the task of an experiment, on `threads` threads (0: one a processor), not started yet.
    ///
    /// # Errors
    ///
    /// The experiment has no task, or a number that is drawn cannot be set.
    pub fn new(loaded: &Loaded, n: usize, threads: usize) -> Result<Self, Diagnostics> {
        let plan = Arc::new(Plan::new(loaded)?);
        let width = if plan.lanes_refused().is_none() { sincro_math::lanes::width() } else { 1 };
        let groups = (0..n).step_by(width).map(|first| Group::new(&plan, width.min(n - first))).collect();
        let available = std::thread::available_parallelism().map_or(1, usize::from);
        Ok(Self { plan, groups, n, threads: if threads == 0 { available } else { threads } })
    }

    /// The task with its names resolved.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Number of worlds that are stepped together.
    #[must_use]
    pub fn n_worlds(&self) -> usize {
        self.n
    }

    /// Coordinates of a world (n_q) `[rad]`, `[m]`, for pictures of it.
    ///
    /// # Panics
    ///
    /// There is no such world.
    pub fn coordinates(&mut self, world: usize) -> Vec<f64> {
        let width = self.groups[0].n_worlds();
        self.groups[world / width].coordinates(&self.plan, world % width)
    }

    /// Begins new episodes in the worlds of the mask, by their seeds, and writes the observations of these worlds, row
    /// by row in the units of the task. A world without a seed goes on with the draws of the one it has.
    pub fn reset(&mut self, seeds: &[Option<u64>], mask: &[bool], observations: &mut [f64]) {
        let n_observations = self.plan.n_observations();
        self.share(seeds, mask, observations, n_observations);
    }

    fn share(&mut self, seeds: &[Option<u64>], mask: &[bool], observations: &mut [f64], n_observations: usize) {
        let (plan, mut first) = (&*self.plan, 0);
        let mut parts = Vec::with_capacity(self.groups.len());
        let mut rest = observations;
        for group in &mut self.groups {
            let n = group.n_worlds();
            let (mine, others) = rest.split_at_mut(n * n_observations);
            parts.push((group, &seeds[first..first + n], &mask[first..first + n], mine));
            (rest, first) = (others, first + n);
        }
        in_threads(&mut parts, self.threads, |(group, seeds, mask, observations)| {
            group.reset(plan, seeds, mask, observations);
        });
    }

    /// Steps all worlds by one action each (`n_worlds × n_actions` row by row, all finite) and writes what came of it.
    ///
    /// # Panics
    ///
    /// The actions are not as many as that, or `out` was made for another number of worlds.
    pub fn step(&mut self, actions: &[f64], autoreset: Autoreset, out: &mut Step) {
        let (n_actions, n_observations) = (self.plan.n_actions(), self.plan.n_observations());
        assert_eq!(actions.len(), self.n * n_actions, "one action a world");
        assert_eq!(out.rewards.len(), self.n, "results of as many worlds");
        let plan = &*self.plan;
        let mut buffers = Buffers::of(out);
        let (mut parts, mut first) = (Vec::with_capacity(self.groups.len()), 0);
        for group in &mut self.groups {
            let n = group.n_worlds();
            let mine = &actions[first * n_actions..(first + n) * n_actions];
            parts.push((group, mine, buffers.take(n, n_observations)));
            first += n;
        }
        in_threads(&mut parts, self.threads, |(group, actions, out)| group.step(plan, actions, autoreset, out));
    }
}

/// Works on all parts, on this thread and others.
fn in_threads<T: Send>(parts: &mut [T], threads: usize, work: impl Fn(&mut T) + Sync) {
    let share = parts.len().div_ceil(threads.max(1)).max(1);
    if share >= parts.len() {
        return parts.iter_mut().for_each(work);
    }
    std::thread::scope(|scope| {
        let (own, others) = parts.split_at_mut(share);
        for part in others.chunks_mut(share) {
            scope.spawn(|| part.iter_mut().for_each(&work));
        }
        own.iter_mut().for_each(&work);
    });
}
