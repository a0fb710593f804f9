//! Episodes of a bundle of worlds: actions to commands, formulas, ends, autoreset.

mod compiled;

use compiled::{CompiledScratch, CompiledWorlds};

use super::lanes::{LaneBundle, SharedBlocks};
use super::plan::{Drawn, Plan, copy_unsigned, unsigned_zero};
use super::single::SingleWorld;
use super::{Autoreset, StepMut};

/// Worlds that advance together.
#[derive(Debug)]
pub(super) struct Group {
    worlds: Worlds,
    compiled: Option<CompiledWorlds>,
    episodes: Episodes,
    /// Numbers that formulas see, of one world after the other.
    values: Vec<f64>,
    signals: Vec<f64>,
    is_finite: Vec<bool>,
    commands: Vec<f64>,
    n_slots: usize,
    n_signals: usize,
}

/// Working memory of the steps of the groups of one thread.
#[derive(Debug)]
pub(super) struct Scratch {
    /// Worlds whose episode was over before the step.
    was_over: Vec<bool>,
    /// Worlds that begin a new episode in the step.
    begins_anew: Vec<bool>,
    /// Start of an episode, as drawn last.
    drawn: Drawn,
    default_commands: Vec<f64>,
    single_commands: Vec<Option<f64>>,
    stack: Vec<f64>,
    compiled: Option<CompiledScratch>,
    /// Blocks of diagrams in lanes.
    blocks: Option<SharedBlocks>,
}

impl Scratch {
    /// For groups of up to `n_worlds` worlds.
    pub fn new(plan: &Plan, n_worlds: usize) -> Self {
        let default_commands = plan.commands();
        Self {
            was_over: vec![false; n_worlds],
            begins_anew: vec![false; n_worlds],
            drawn: plan.drawn(0, 0),
            single_commands: vec![None; default_commands.len()],
            default_commands,
            stack: Vec::new(),
            compiled: plan.compiled.as_ref().map(|task| CompiledScratch::new(plan, task)),
            blocks: SharedBlocks::new(plan),
        }
    }
}

#[derive(Debug)]
enum Worlds {
    Lanes(Box<LaneBundle>),
    Single(Vec<SingleWorld>),
}

/// Episodes under way, world by world.
#[derive(Debug)]
struct Episodes {
    seeds: Vec<u64>,
    numbers: Vec<u64>,
    /// Actions since the start; those of worlds whose rows are current stand there.
    actions: Vec<u64>,
    /// True from the end of an episode to the next start.
    is_over: Vec<bool>,
}

impl Group {
    pub fn new(plan: &Plan, n_worlds: usize) -> Self {
        let (n_slots, n_signals) = (plan.task.slots.len(), plan.probes.len());
        let mut values = vec![0.0; n_worlds * n_slots];
        for of_world in values.chunks_mut(n_slots) {
            of_world[n_slots - plan.task.parameters.len()..].copy_from_slice(&plan.task.parameters);
        }
        let commands = &plan.loaded.scene.initial.commands;
        let worlds = match plan.recursions_refused() {
            None => Worlds::Lanes(Box::new(LaneBundle::new(plan, n_worlds))),
            Some(_) => Worlds::Single((0..n_worlds).map(|_| SingleWorld::new()).collect()),
        };
        let (none, no) = (vec![0; n_worlds], vec![false; n_worlds]);
        Self {
            worlds,
            compiled: CompiledWorlds::new(plan, n_worlds),
            episodes: Episodes { seeds: none.clone(), numbers: none.clone(), actions: none, is_over: no },
            values,
            signals: vec![0.0; n_worlds * n_signals],
            is_finite: vec![true; n_worlds],
            commands: commands.repeat(n_worlds),
            n_slots,
            n_signals,
        }
    }

    pub fn n_worlds(&self) -> usize {
        self.is_finite.len()
    }

    /// Returns true if the programs have the state of the worlds.
    pub fn is_compiled(&self) -> bool {
        self.compiled.as_ref().is_some_and(CompiledWorlds::are_current)
    }

    /// Number of base steps that worlds in lanes have made by themselves.
    pub fn steps_alone(&mut self) -> u64 {
        match &mut self.worlds {
            Worlds::Lanes(bundle) => bundle.steps_alone(),
            Worlds::Single(_) => 0,
        }
    }

    /// Coordinates of a world.
    pub fn coordinates(&mut self, plan: &Plan, k: usize) -> Vec<f64> {
        self.leave_rows(plan);
        match &mut self.worlds {
            Worlds::Lanes(bundle) => bundle.coordinates(plan, k),
            Worlds::Single(worlds) => worlds[k].coordinates().unwrap_or_else(|| plan.loaded.scene.initial.q.clone()),
        }
    }

    /// Begins new episodes in the worlds of the mask; see [`super::TaskWorlds::reset`].
    pub fn reset(
        &mut self,
        plan: &Plan,
        seeds: &[Option<u64>],
        mask: &[bool],
        observations: &mut [f64],
        scratch: &mut Scratch,
    ) {
        if !mask.contains(&true) {
            return;
        }
        for k in (0..self.n_worlds()).filter(|k| mask[*k]) {
            if let Some(seed) = seeds[k] {
                (self.episodes.seeds[k], self.episodes.numbers[k]) = (seed, 0);
            }
        }
        if self.reset_compiled(plan, mask, observations, scratch) {
            return;
        }
        self.leave_rows(plan);
        scratch.begins_anew[..mask.len()].copy_from_slice(mask);
        self.start(plan, scratch);
        self.look(plan);
        for k in (0..self.n_worlds()).filter(|k| mask[*k]) {
            self.write(plan, k, observations, &mut scratch.stack);
        }
    }

    /// Steps all worlds by one action each; see [`super::TaskWorlds::step`].
    pub fn step(
        &mut self,
        plan: &Plan,
        actions: &[f64],
        autoreset: Autoreset,
        out: &mut StepMut<'_>,
        scratch: &mut Scratch,
    ) {
        if self.step_compiled(plan, actions, autoreset, out, scratch) {
            return;
        }
        self.leave_rows(plan);
        let n = self.n_worlds();
        scratch.was_over[..n].copy_from_slice(&self.episodes.is_over);
        let n_actions = plan.n_actions();
        for k in (0..n).filter(|k| !self.episodes.is_over[*k]) {
            let of_world = &mut self.values[k * self.n_slots..(k + 1) * self.n_slots];
            plan.acting(&actions[k * n_actions..][..n_actions], &mut of_world[self.n_signals..][..n_actions]);
        }
        self.command(plan, &scratch.default_commands, &mut scratch.stack);
        self.advance(plan, scratch);
        for (actions, was_over) in self.episodes.actions.iter_mut().zip(&scratch.was_over) {
            *actions += u64::from(!was_over);
        }
        self.look(plan);
        for k in 0..n {
            (out.rewards[k], out.terminated[k], out.truncated[k], out.stopped[k]) = (0.0, false, false, false);
            if scratch.was_over[k] {
                scratch.begins_anew[k] = autoreset == Autoreset::NextStep;
                self.write(plan, k, out.observations, &mut scratch.stack);
                continue;
            }
            self.judge(plan, k, out, &mut scratch.stack);
            let is_over = out.terminated[k] || out.truncated[k];
            self.episodes.is_over[k] = is_over;
            scratch.begins_anew[k] = is_over && autoreset == Autoreset::SameStep;
            if scratch.begins_anew[k] {
                let n = plan.n_observations();
                out.final_observations[k * n..(k + 1) * n].copy_from_slice(&out.observations[k * n..(k + 1) * n]);
            }
        }
        if scratch.begins_anew[..n].contains(&true) {
            self.start(plan, scratch);
            self.look(plan);
            for k in (0..n).filter(|k| scratch.begins_anew[*k]) {
                self.write(plan, k, out.observations, &mut scratch.stack);
            }
        }
    }

    /// Reward and end of a world's action, and what the agent sees after it.
    fn judge(&mut self, plan: &Plan, k: usize, out: &mut StepMut<'_>, stack: &mut Vec<f64>) {
        let at_limit = self.episodes.actions[k] >= plan.task.max_actions;
        self.write(plan, k, out.observations, stack);
        if !self.is_finite[k] {
            (out.truncated[k], out.stopped[k]) = (true, true);
            return;
        }
        let of_world = &self.values[k * self.n_slots..(k + 1) * self.n_slots];
        out.rewards[k] = unsigned_zero(plan.reward.eval(of_world, stack));
        let ended = plan.terminated.as_ref().map_or(0.0, |formula| formula.eval(of_world, stack));
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
    fn command(&mut self, plan: &Plan, default: &[f64], stack: &mut Vec<f64>) {
        let n = plan.n_commands();
        for k in 0..self.n_worlds() {
            let of_world = &self.values[k * self.n_slots..(k + 1) * self.n_slots];
            let commands = &mut self.commands[k * n..(k + 1) * n];
            commands.copy_from_slice(default);
            for (action, command) in plan.of_actions.iter().enumerate() {
                if let Some(command) = command {
                    commands[*command] = of_world[self.n_signals + action];
                }
            }
            for (command, formula) in &plan.of_formulas {
                commands[*command] = unsigned_zero(formula.eval(of_world, stack));
            }
        }
    }

    fn advance(&mut self, plan: &Plan, scratch: &mut Scratch) {
        let n = plan.n_commands();
        match &mut self.worlds {
            Worlds::Lanes(bundle) => {
                bundle.exchange_blocks(&mut scratch.blocks);
                bundle.advance(plan, &mut self.commands, &scratch.was_over[..self.is_finite.len()]);
                bundle.exchange_blocks(&mut scratch.blocks);
            }
            Worlds::Single(worlds) => {
                for (k, world) in worlds.iter_mut().enumerate().filter(|(k, _)| !scratch.was_over[*k]) {
                    for command in plan.own_commands() {
                        scratch.single_commands[command] = Some(self.commands[k * n + command]);
                    }
                    world.advance(plan, &scratch.single_commands);
                }
            }
        }
    }

    /// Begins the next episodes of the worlds that begin anew.
    fn start(&mut self, plan: &Plan, scratch: &mut Scratch) {
        for k in 0..self.n_worlds() {
            if !scratch.begins_anew[k] {
                continue;
            }
            self.draw(plan, k, scratch);
            match &mut self.worlds {
                Worlds::Lanes(bundle) => bundle.begin(plan, k, &scratch.drawn),
                Worlds::Single(worlds) => worlds[k].start(plan, &scratch.drawn),
            }
        }
        if let Worlds::Lanes(bundle) = &mut self.worlds {
            bundle.exchange_blocks(&mut scratch.blocks);
            bundle.start(plan, &mut self.commands, &scratch.begins_anew);
            bundle.exchange_blocks(&mut scratch.blocks);
        }
    }

    /// Draws the next episode of a world.
    fn draw(&mut self, plan: &Plan, k: usize, scratch: &mut Scratch) {
        let (episodes, drawn) = (&mut self.episodes, &mut scratch.drawn);
        plan.draw(episodes.seeds[k], episodes.numbers[k], drawn);
        episodes.numbers[k] += 1;
        (episodes.actions[k], episodes.is_over[k]) = (0, false);
        let n_actions = plan.n_actions();
        let of_world = &mut self.values[k * self.n_slots..(k + 1) * self.n_slots];
        of_world[self.n_signals..][..n_actions].fill(0.0);
        of_world[self.n_signals + n_actions..][..drawn.named.len()].copy_from_slice(&drawn.named);
        let n = plan.n_commands();
        self.commands[k * n..(k + 1) * n].copy_from_slice(&drawn.state.commands);
    }

    /// Reads the signals of all worlds, and if each can go on.
    fn observe(&mut self, plan: &Plan) {
        let n = self.n_signals;
        match &mut self.worlds {
            Worlds::Lanes(bundle) => bundle.observe(plan, &mut self.signals, &mut self.is_finite),
            Worlds::Single(worlds) => {
                for (k, world) in worlds.iter_mut().enumerate() {
                    self.is_finite[k] = world.observe(&mut self.signals[k * n..(k + 1) * n]);
                }
            }
        }
    }

    /// Reads the signals of all worlds for the formulas.
    fn look(&mut self, plan: &Plan) {
        self.observe(plan);
        let n = self.n_signals;
        let (period, n_parameters) = (plan.period(), plan.task.parameters.len());
        for k in 0..self.n_worlds() {
            // after its end a world shows what it ended with, and one that cannot go on its last good signals
            if self.episodes.is_over[k] || !self.is_finite[k] {
                continue;
            }
            let of_world = &mut self.values[k * self.n_slots..(k + 1) * self.n_slots];
            copy_unsigned(of_world, &self.signals[k * n..(k + 1) * n]);
            of_world[self.n_slots - n_parameters - 1] = self.episodes.actions[k] as f64 * period;
        }
    }

    /// Writes what the agent sees of a world.
    fn write(&self, plan: &Plan, k: usize, observations: &mut [f64], stack: &mut Vec<f64>) {
        let of_world = &self.values[k * self.n_slots..(k + 1) * self.n_slots];
        let n = plan.n_observations();
        for (out, formula) in observations[k * n..(k + 1) * n].iter_mut().zip(&plan.observations) {
            *out = unsigned_zero(formula.eval(of_world, stack));
        }
    }
}
