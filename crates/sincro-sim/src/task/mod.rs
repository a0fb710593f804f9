//! Tasks of scenes: many worlds at once for reinforcement learning, each with its own random starts.
//!
//! [`TaskWorlds`] steps all worlds by one action each and gives observations, rewards and the ends of episodes. Worlds
//! that lanes can advance together do so (fixed steps; no loop joints and scripts), with a diagram and the noise of
//! sensors for each; the others are lock-steps of their own; threads share them out.
//! Nothing that a world gives depends on its neighbours: the same seed gives the same episodes on any number of worlds,
//! lanes and threads.
//!
//! | file | content |
//! |---|---|
//! | `plan` | the task with its names resolved, and the draws of an episode |
//! | `lanes` | a bundle of worlds in lanes, with their diagrams and sensors |
//! | `single` | a world as a lock-step |
//! | `compiled` | the actions of a task as compiled programs |
//! | `threads` | groups shared out to threads |
//! | `group` | episodes of a bundle: actions to commands, formulas, ends, autoreset; by the programs where there are some |

mod compiled;
mod group;
mod lanes;
mod plan;
mod single;
mod threads;

use std::sync::Arc;

use compiled::CompiledTask;
use group::Group;
pub use plan::Plan;
use sincro_compile::Obstacle;
use threads::Threads;

use crate::load::Loaded;
use crate::rollout::{Compile, StepsBy};
use sincro_scene::diagnostic::Diagnostics;

/// Number of worlds from which a compilation pays: it takes a few tenths of a second, and saves about 0.1 µs a step of
/// each; training takes thousands of steps.
const WORTH_COMPILING: usize = 256;

/// Number of worlds with a diagram from which a compilation pays: these have a diagram each else, and it saves some
/// microseconds a step of each.
const WORTH_COMPILING_A_DIAGRAM: usize = 16;

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
    /// worlds begin anew in the same step, else empty; rows of other worlds have no meaning.
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
            final_observations: Vec::new(),
        }
    }
}

/// Results of one step of [`TaskWorlds`] in arrays of the caller: as those of [`Step`], world by world.
#[derive(Debug)]
pub struct StepMut<'a> {
    /// Observations, `n_worlds × n_observations`.
    pub observations: &'a mut [f64],
    /// Rewards, `n_worlds`.
    pub rewards: &'a mut [f64],
    /// Episodes that terminated, `n_worlds`.
    pub terminated: &'a mut [bool],
    /// Episodes that were truncated, `n_worlds`.
    pub truncated: &'a mut [bool],
    /// Worlds that could not go on, `n_worlds`.
    pub stopped: &'a mut [bool],
    /// Last observations of the episodes that ended: as long as `observations` for [`Autoreset::SameStep`], else of no
    /// use.
    pub final_observations: &'a mut [f64],
}

impl<'a> StepMut<'a> {
    /// Takes those of the next `n` worlds.
    #[inline]
    fn take(&mut self, n: usize, n_observations: usize) -> StepMut<'a> {
        fn front<'a, T>(rest: &mut &'a mut [T], n: usize) -> &'a mut [T] {
            let (mine, others) = std::mem::take(rest).split_at_mut(n);
            *rest = others;
            mine
        }
        StepMut {
            observations: front(&mut self.observations, n * n_observations),
            rewards: front(&mut self.rewards, n),
            terminated: front(&mut self.terminated, n),
            truncated: front(&mut self.truncated, n),
            stopped: front(&mut self.stopped, n),
            final_observations: match self.final_observations.is_empty() {
                true => &mut [],
                false => front(&mut self.final_observations, n * n_observations),
            },
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
    steps_by: StepsBy,
    threads: Threads,
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
        Self::with_steps(loaded, n, threads, Compile::IfItPays)
    }

    /// As [`TaskWorlds::new`], with a choice of the way in which the steps are made; their results are the same.
    ///
    /// # Errors
    ///
    /// As [`TaskWorlds::new`].
    pub fn with_steps(loaded: &Loaded, n: usize, threads: usize, compile: Compile) -> Result<Self, Diagnostics> {
        let mut plan = Plan::new(loaded)?;
        let steps_by = match compile_task(&plan, n, compile) {
            Ok((task, steps_by)) => {
                plan.compiled = Some(task);
                steps_by
            }
            Err(obstacle) => StepsBy::Recursions { reason: obstacle.to_string() },
        };
        let plan = Arc::new(plan);
        let available = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { available } else { threads };
        let width = if plan.lanes_refused().is_none() { sincro_math::lanes::width() } else { 1 };
        // steps that worlds make alone gain from each thread, from lanes they do not
        let makes_steps_alone = width > 1 && !plan.scene().model.constraints().is_empty();
        let size = if makes_steps_alone { width.min(n.div_ceil(threads).max(1)) } else { width };
        let mut groups: Vec<Group> = (0..n / size).map(|_| Group::new(&plan, size)).collect();
        // worlds that do not fill the lanes: lock-steps are shared out one by one
        let rest = n % size;
        let sizes = if plan.recursions_refused().is_some() { vec![1; rest] } else { vec![rest; usize::from(rest > 0)] };
        groups.extend(sizes.into_iter().map(|n| Group::new(&plan, n)));
        let threads = Threads::new(&plan, threads.min(groups.len()), width);
        Ok(Self { plan, groups, n, steps_by, threads })
    }

    /// Returns the way in which the steps are made.
    #[must_use]
    pub fn steps_by(&self) -> &StepsBy {
        &self.steps_by
    }

    /// Returns the task, resolved against its scene; it has the lengths of observations and actions.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the number of base steps that worlds in lanes have made by themselves, because a limit of a joint or a
    /// contact took part in them, or might have.
    pub fn steps_alone(&mut self) -> u64 {
        self.groups.iter_mut().map(Group::steps_alone).sum()
    }

    /// Returns the number of worlds that are stepped together.
    #[must_use]
    pub fn n_worlds(&self) -> usize {
        self.n
    }

    /// Returns the number of worlds whose last step or reset was made by compiled programs. Others were advanced by the
    /// recursions: they do not fill the lanes, or one of their bundle cannot be computed by programs, such as one whose
    /// reward is no number.
    #[must_use]
    pub fn n_compiled(&self) -> usize {
        self.groups.iter().filter(|group| group.is_compiled()).map(Group::n_worlds).sum()
    }

    /// Returns the coordinates of world `world` (from 0), `n_q` numbers `[rad]`, `[m]` in the order of the model's
    /// state, for images of it.
    ///
    /// # Panics
    ///
    /// If there is no such world.
    pub fn coordinates(&mut self, world: usize) -> Vec<f64> {
        let mut first = 0;
        for group in &mut self.groups {
            if world < first + group.n_worlds() {
                return group.coordinates(&self.plan, world - first);
            }
            first += group.n_worlds();
        }
        panic!("there is no world {world} among {}", self.n)
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
        let plan = &*self.plan;
        let (mut first, mut rest) = (0, observations);
        self.threads.share(
            &mut self.groups,
            |n_worlds| {
                let mine = rest.split_off_mut(..n_worlds * n_observations).expect("observations of all worlds");
                let range = first..first + n_worlds;
                first += n_worlds;
                (&seeds[range.clone()], &mask[range], mine)
            },
            |groups, (seeds, mask, observations), scratch| {
                let (mut first, mut rest) = (0, observations);
                for group in groups {
                    let n = group.n_worlds();
                    let (mine, others) = rest.split_at_mut(n * n_observations);
                    group.reset(plan, &seeds[first..first + n], &mask[first..first + n], mine, scratch);
                    (first, rest) = (first + n, others);
                }
            },
        );
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
        let n_finals = if autoreset == Autoreset::SameStep { self.n * self.plan.n_observations() } else { 0 };
        out.final_observations.resize(n_finals, 0.0);
        let Step { observations, rewards, terminated, truncated, stopped, final_observations } = out;
        let out = StepMut { observations, rewards, terminated, truncated, stopped, final_observations };
        self.step_into(actions, autoreset, out);
    }

    /// As [`TaskWorlds::step`], with the results in arrays of the caller.
    ///
    /// # Panics
    ///
    /// If `actions` or an array of `out` has another length.
    pub fn step_into(&mut self, actions: &[f64], autoreset: Autoreset, out: StepMut<'_>) {
        let (n_actions, n_observations) = (self.plan.n_actions(), self.plan.n_observations());
        assert_eq!(actions.len(), self.n * n_actions, "one action a world");
        let lengths = [out.rewards.len(), out.terminated.len(), out.truncated.len(), out.stopped.len()];
        assert_eq!(lengths, [self.n; 4], "results of as many worlds");
        assert_eq!(out.observations.len(), self.n * n_observations, "observations of as many worlds");
        let has_finals = autoreset != Autoreset::SameStep || out.final_observations.len() == self.n * n_observations;
        assert!(has_finals, "last observations of as many worlds");
        let plan = &*self.plan;
        let (mut rest, mut buffers) = (actions, out);
        self.threads.share(
            &mut self.groups,
            |n_worlds| {
                let mine = rest.split_off(..n_worlds * n_actions).expect("actions of all worlds");
                (mine, buffers.take(n_worlds, n_observations))
            },
            |groups, (actions, mut buffers), scratch| {
                let mut first = 0;
                for group in groups {
                    let n = group.n_worlds();
                    let mine = &actions[first * n_actions..(first + n) * n_actions];
                    group.step(plan, mine, autoreset, &mut buffers.take(n, n_observations), scratch);
                    first += n;
                }
            },
        );
    }
}

fn compile_task(plan: &Plan, n: usize, compile: Compile) -> Result<(CompiledTask, StepsBy), Obstacle> {
    if let Some(part) = plan.obstacle_to_programs() {
        return Err(Obstacle::new(format!("there is {part}")));
    }
    let worth = if plan.loaded.controller.is_none() { WORTH_COMPILING } else { WORTH_COMPILING_A_DIAGRAM };
    match compile {
        Compile::Never => Err(Obstacle::new("that is not wanted")),
        Compile::IfItPays if n < worth => Err(Obstacle::new("it would take longer than the steps")),
        _ if n < sincro_math::lanes::width() => Err(Obstacle::new("there are fewer worlds than lanes")),
        _ => CompiledTask::new(plan),
    }
}
