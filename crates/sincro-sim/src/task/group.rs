//! Episodes of a bundle of worlds: actions to commands, formulas, ends, autoreset.

use super::lanes::LaneBundle;
use super::plan::{Drawn, Plan};
use super::single::SingleWorld;
use super::{Autoreset, Step};

/// Worlds that advance together.
#[derive(Debug)]
pub(super) struct Group {
    worlds: Worlds,
    episodes: Vec<Episode>,
    /// Numbers that formulas see, of one world after the other.
    values: Vec<f64>,
    signals: Vec<f64>,
    is_finite: Vec<bool>,
    commands: Vec<f64>,
    single_commands: Vec<Option<f64>>,
    stack: Vec<f64>,
    /// Starts of the next episodes, one a world, and what a step needs to know of each world.
    drawn: Vec<Drawn>,
    was_over: Vec<bool>,
    begins_anew: Vec<bool>,
    n_slots: usize,
    n_signals: usize,
}

#[derive(Debug)]
enum Worlds {
    Lanes(LaneBundle),
    Single(Vec<SingleWorld>),
}

/// An episode under way.
#[derive(Clone, Debug, Default)]
struct Episode {
    seed: u64,
    number: u64,
    actions: u64,
    /// True from its end to the next start.
    is_over: bool,
}

/// Results of the worlds of one group.
#[derive(Debug)]
pub(super) struct Buffers<'a> {
    observations: &'a mut [f64],
    rewards: &'a mut [f64],
    terminated: &'a mut [bool],
    truncated: &'a mut [bool],
    stopped: &'a mut [bool],
    finals: &'a mut [f64],
}

impl<'a> Buffers<'a> {
    /// All results of a step.
    pub fn of(step: &'a mut Step) -> Self {
        Self {
            observations: &mut step.observations,
            rewards: &mut step.rewards,
            terminated: &mut step.terminated,
            truncated: &mut step.truncated,
            stopped: &mut step.stopped,
            finals: &mut step.final_observations,
        }
    }

    /// Takes those of the next `n` worlds.
    pub fn take(&mut self, n: usize, n_observations: usize) -> Buffers<'a> {
        fn front<'a, T>(rest: &mut &'a mut [T], n: usize) -> &'a mut [T] {
            let (mine, others) = std::mem::take(rest).split_at_mut(n);
            *rest = others;
            mine
        }
        Buffers {
            observations: front(&mut self.observations, n * n_observations),
            rewards: front(&mut self.rewards, n),
            terminated: front(&mut self.terminated, n),
            truncated: front(&mut self.truncated, n),
            stopped: front(&mut self.stopped, n),
            finals: front(&mut self.finals, n * n_observations),
        }
    }
}

impl Group {
    pub fn new(plan: &Plan, n_worlds: usize) -> Self {
        let (n_slots, n_signals) = (plan.task.slots.len(), plan.probes.len());
        let mut values = vec![0.0; n_worlds * n_slots];
        for of_world in values.chunks_mut(n_slots) {
            of_world[n_slots - plan.task.parameters.len()..].copy_from_slice(&plan.task.parameters);
        }
        let commands: Vec<f64> = plan.loaded.scene.commands.iter().map(|signal| signal.value(0.0)).collect();
        let n_commands = commands.len();
        let worlds = match plan.lanes_refused() {
            None => Worlds::Lanes(LaneBundle::default()),
            Some(_) => Worlds::Single((0..n_worlds).map(|_| SingleWorld::new()).collect()),
        };
        Self {
            worlds,
            episodes: vec![Episode::default(); n_worlds],
            values,
            signals: vec![0.0; n_worlds * n_signals],
            is_finite: vec![true; n_worlds],
            commands: commands.iter().copied().cycle().take(n_worlds * n_commands).collect(),
            single_commands: vec![None; n_commands],
            stack: Vec::new(),
            drawn: (0..n_worlds).map(|_| plan.drawn(0, 0)).collect(),
            was_over: vec![false; n_worlds],
            begins_anew: vec![false; n_worlds],
            n_slots,
            n_signals,
        }
    }

    pub fn n_worlds(&self) -> usize {
        self.episodes.len()
    }

    /// Coordinates of a world.
    pub fn coordinates(&mut self, plan: &Plan, k: usize) -> Vec<f64> {
        match &mut self.worlds {
            Worlds::Lanes(bundle) => bundle.coordinates(plan, k),
            Worlds::Single(worlds) => worlds[k].coordinates().unwrap_or_else(|| plan.loaded.scene.initial.q.clone()),
        }
    }

    /// Begins new episodes in the worlds of the mask; see [`super::TaskWorlds::reset`].
    pub fn reset(&mut self, plan: &Plan, seeds: &[Option<u64>], mask: &[bool], observations: &mut [f64]) {
        for (episode, seed) in
            self.episodes.iter_mut().zip(seeds).zip(mask).filter(|(_, chosen)| **chosen).map(|(e, _)| e)
        {
            if let Some(seed) = seed {
                (episode.seed, episode.number) = (*seed, 0);
            }
        }
        self.begins_anew.copy_from_slice(mask);
        self.start(plan);
        self.look(plan);
        for k in (0..self.n_worlds()).filter(|k| mask[*k]) {
            self.write(plan, k, observations);
        }
    }

    /// Steps all worlds by one action each; see [`super::TaskWorlds::step`].
    pub fn step(&mut self, plan: &Plan, actions: &[f64], autoreset: Autoreset, out: &mut Buffers<'_>) {
        let n_actions = plan.n_actions();
        for k in 0..self.n_worlds() {
            self.was_over[k] = self.episodes[k].is_over;
            let of_world = &mut self.values[k * self.n_slots..(k + 1) * self.n_slots];
            plan.acting(&actions[k * n_actions..][..n_actions], &mut of_world[self.n_signals..][..n_actions]);
        }
        self.command(plan);
        self.advance(plan);
        for (episode, _) in self.episodes.iter_mut().zip(&self.was_over).filter(|(_, was_over)| !**was_over) {
            episode.actions += 1;
        }
        self.look(plan);
        for k in 0..self.n_worlds() {
            (out.rewards[k], out.terminated[k], out.truncated[k], out.stopped[k]) = (0.0, false, false, false);
            if self.was_over[k] {
                self.begins_anew[k] = autoreset == Autoreset::NextStep;
                self.write(plan, k, out.observations);
                continue;
            }
            self.judge(plan, k, out);
            let is_over = out.terminated[k] || out.truncated[k];
            self.episodes[k].is_over = is_over;
            self.begins_anew[k] = is_over && autoreset == Autoreset::SameStep;
            if self.begins_anew[k] {
                let n = plan.n_observations();
                out.finals[k * n..(k + 1) * n].copy_from_slice(&out.observations[k * n..(k + 1) * n]);
            }
        }
        if self.begins_anew.contains(&true) {
            self.start(plan);
            self.look(plan);
            for k in 0..self.n_worlds() {
                if self.begins_anew[k] {
                    self.write(plan, k, out.observations);
                }
            }
        }
    }

    /// Reward and end of a world's action, and what the agent sees after it.
    fn judge(&mut self, plan: &Plan, k: usize, out: &mut Buffers<'_>) {
        let at_limit = self.episodes[k].actions >= plan.task.max_actions;
        self.write(plan, k, out.observations);
        if !self.is_finite[k] {
            (out.truncated[k], out.stopped[k]) = (true, true);
            return;
        }
        let of_world = &self.values[k * self.n_slots..(k + 1) * self.n_slots];
        out.rewards[k] = plan.reward.eval(of_world, &mut self.stack);
        let ended = plan.terminated.as_ref().map_or(0.0, |formula| formula.eval(of_world, &mut self.stack));
        let n = plan.n_observations();
        let seen = &out.observations[k * n..(k + 1) * n];
        if !(out.rewards[k].is_finite() && ended.is_finite() && seen.iter().all(|x| x.is_finite())) {
            (out.rewards[k], out.truncated[k], out.stopped[k]) = (0.0, true, true);
            return;
        }
        out.terminated[k] = ended != 0.0;
        out.truncated[k] = at_limit && !out.terminated[k];
    }

    /// Commands of all worlds, from their actions and the signals last seen.
    fn command(&mut self, plan: &Plan) {
        let n = self.single_commands.len();
        for k in 0..self.episodes.len() {
            let of_world = &self.values[k * self.n_slots..(k + 1) * self.n_slots];
            let commands = &mut self.commands[k * n..(k + 1) * n];
            for (action, command) in plan.of_actions.iter().enumerate() {
                if let Some(command) = command {
                    commands[*command] = of_world[self.n_signals + action];
                }
            }
            for (command, formula) in &plan.of_formulas {
                commands[*command] = formula.eval(of_world, &mut self.stack);
            }
        }
    }

    fn advance(&mut self, plan: &Plan) {
        match &mut self.worlds {
            Worlds::Lanes(bundle) => bundle.advance(plan, &self.commands),
            Worlds::Single(worlds) => {
                let n = self.single_commands.len();
                for (k, world) in worlds.iter_mut().enumerate().filter(|(k, _)| !self.was_over[*k]) {
                    let own = plan.of_actions.iter().flatten().chain(plan.of_formulas.iter().map(|(c, _)| c));
                    for command in own {
                        self.single_commands[*command] = Some(self.commands[k * n + command]);
                    }
                    world.advance(plan, &self.single_commands);
                }
            }
        }
    }

    /// Begins the next episodes of the worlds that begin anew.
    fn start(&mut self, plan: &Plan) {
        let n_actions = plan.n_actions();
        for k in (0..self.episodes.len()).filter(|k| self.begins_anew[*k]) {
            let (episode, drawn) = (&mut self.episodes[k], &mut self.drawn[k]);
            plan.draw(episode.seed, episode.number, drawn);
            episode.number += 1;
            (episode.actions, episode.is_over) = (0, false);
            let of_world = &mut self.values[k * self.n_slots..(k + 1) * self.n_slots];
            of_world[self.n_signals..][..n_actions].fill(0.0);
            of_world[self.n_signals + n_actions..][..drawn.named.len()].copy_from_slice(&drawn.named);
            if let Worlds::Single(worlds) = &mut self.worlds {
                worlds[k].start(plan, drawn);
            }
        }
        if let Worlds::Lanes(bundle) = &mut self.worlds {
            bundle.place(plan, &self.drawn, &self.begins_anew);
        }
    }

    /// Reads the signals of all worlds.
    fn look(&mut self, plan: &Plan) {
        let n = self.n_signals;
        match &mut self.worlds {
            Worlds::Lanes(bundle) => bundle.observe(plan, &mut self.signals, &mut self.is_finite),
            Worlds::Single(worlds) => {
                for (k, world) in worlds.iter_mut().enumerate() {
                    self.is_finite[k] = world.observe(&mut self.signals[k * n..(k + 1) * n]);
                }
            }
        }
        let (period, n_parameters) = (plan.period(), plan.task.parameters.len());
        for (k, episode) in self.episodes.iter().enumerate() {
            // after its end a world shows what it ended with, and one that cannot go on its last good signals
            if episode.is_over || !self.is_finite[k] {
                continue;
            }
            let of_world = &mut self.values[k * self.n_slots..(k + 1) * self.n_slots];
            of_world[..n].copy_from_slice(&self.signals[k * n..(k + 1) * n]);
            of_world[self.n_slots - n_parameters - 1] = episode.actions as f64 * period;
        }
    }

    /// Writes what the agent sees of a world.
    fn write(&mut self, plan: &Plan, k: usize, observations: &mut [f64]) {
        let of_world = &self.values[k * self.n_slots..(k + 1) * self.n_slots];
        let n = plan.n_observations();
        for (out, formula) in observations[k * n..(k + 1) * n].iter_mut().zip(&plan.observations) {
            *out = formula.eval(of_world, &mut self.stack);
        }
    }
}
