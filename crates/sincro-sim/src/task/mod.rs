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

/// Treatment of a world of a task whose episode has ended (autoreset mode of Gymnasium).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Autoreset {
    /// The world begins a new episode at its next step, which ignores the action and has the reward 0.
    NextStep,
    /// The world begins a new episode in the step that ends the old one, whose last observation is in
    /// [`Step::final_observations`].
    SameStep,
    /// The world stays as it is until it is reset; its steps do nothing.
    Disabled,
}

/// Results of one step of [`TaskWorlds`], world by world. An observation has one number for each formula of
/// [`Task::observations`](sincro_scene::experiment::task::Task::observations), in their order.
#[derive(Clone, Debug, Default)]
pub struct Step {
    /// Observations, `n_worlds × n_observations`, row by row, one row per world; in the units of the formulas.
    pub observations: Vec<f64>,
    /// Reward of each world, the value of [`Task::reward`](sincro_scene::experiment::task::Task::reward).
    pub rewards: Vec<f64>,
    /// True for each world whose episode terminated: the value of
    /// [`Task::terminated`](sincro_scene::experiment::task::Task::terminated) is not 0.
    pub terminated: Vec<bool>,
    /// True for each world whose episode was truncated, by its time limit or because the world could not go on.
    pub truncated: Vec<bool>,
    /// True for each world that could not go on: its state is not finite, a block or the solver failed.
    pub stopped: Vec<bool>,
    /// Last observations of the episodes that ended in this step, `n_worlds × n_observations` as `observations`, if
    /// worlds begin anew in the same step; rows of other worlds have no meaning.
    pub final_observations: Vec<f64>,
}

impl Step {
    /// Creates results, all zero, for `n` worlds with observations of `n_observations` numbers each
    /// ([`Plan::n_observations`]).
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

/// Worlds of a reinforcement learning task that are stepped together, in SIMD lanes and threads. The results of each
/// world are those that it would have alone.
#[derive(Debug)]
pub struct TaskWorlds {
    plan: Arc<Plan>,
    groups: Vec<Group>,
    n: usize,
    threads: usize,
}

impl TaskWorlds {
    /// Creates `n` worlds of the task of an experiment, on `threads` threads (0: one per processor);
    /// [`TaskWorlds::reset`] begins their episodes.
    ///
    /// # Errors
    ///
    /// Diagnostics: the experiment has no task, a signal of it does not exist, or the scene refuses a number that is
    /// drawn.
    pub fn new(loaded: &Loaded, n: usize, threads: usize) -> Result<Self, Diagnostics> {
        let plan = Arc::new(Plan::new(loaded)?);
        let width = if plan.lanes_refused().is_none() { sincro_math::lanes::width() } else { 1 };
        let groups = (0..n).step_by(width).map(|first| Group::new(&plan, width.min(n - first))).collect();
        let available = std::thread::available_parallelism().map_or(1, usize::from);
        Ok(Self { plan, groups, n, threads: if threads == 0 { available } else { threads } })
    }

    /// Returns the task, resolved against its scene; it has the lengths of observations and actions.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the number of worlds that are stepped together.
    #[must_use]
    pub fn n_worlds(&self) -> usize {
        self.n
    }

    /// Returns the coordinates of world `world` (from 0), `n_q` numbers `[rad]`, `[m]` in the order of the model's
    /// state, for images of it.
    ///
    /// # Panics
    ///
    /// If there is no such world.
    pub fn coordinates(&mut self, world: usize) -> Vec<f64> {
        let width = self.groups[0].n_worlds();
        self.groups[world / width].coordinates(&self.plan, world % width)
    }

    /// Begins new episodes in the worlds whose entry of `mask` is true, and writes their observations into
    /// `observations`, `n_worlds × n_observations` row by row; rows of other worlds stay. `seeds` has one entry per
    /// world: the seed of its random numbers, or `None` to draw the next episode of the seed it has.
    ///
    /// # Panics
    ///
    /// If `seeds`, `mask` or `observations` are shorter than that.
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

    /// Steps all worlds by one action each and writes the results into `out`. `actions` has `n_worlds × n_actions`
    /// finite numbers, row by row, one row per world: one for each of
    /// [`Task::actions`](sincro_scene::experiment::task::Task::actions), in their order and in the units of their
    /// commands. They are clamped to their ranges; of an action with discrete values the nearest counts.
    ///
    /// # Panics
    ///
    /// If `actions` has another length, or `out` was made for another number of worlds.
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
