//! Steps of a group by the compiled programs, wherever they have the bits of its other steps.

pub(super) use crate::task::compiled::CompiledScratch;

use sincro_dynamics::state::State;

use super::{Group, Scratch, Worlds};
use crate::task::compiled::{CompiledTask, ResultsMut, Rows, flags, set_bits};
use crate::task::plan::{Plan, copy_unsigned, unsigned_zero};
use crate::task::{Autoreset, StepMut};

/// Worlds of a whole bundle whose actions are compiled.
#[derive(Debug)]
pub(super) struct CompiledWorlds {
    rows: Rows,
    /// True while these have the state of the worlds, false while the bundle in lanes has it.
    are_current: bool,
    /// Bits of the worlds whose state stays in the bundle while the rows are current: their episode was over when the
    /// others were moved, and may have ended with what no program can compute.
    away: u64,
    /// Bits of the worlds whose episode is over, while the rows are current.
    over: u64,
}

impl CompiledWorlds {
    /// None where the task is not compiled, or the worlds do not fill the lanes.
    pub fn new(plan: &Plan, n_worlds: usize) -> Option<Self> {
        let task = plan.compiled.as_ref().filter(|task| task.width() == n_worlds)?;
        Some(Self { rows: Rows::new(task), are_current: false, away: 0, over: 0 })
    }
}

impl CompiledWorlds {
    /// Returns true if the rows have the state of the worlds.
    pub fn are_current(&self) -> bool {
        self.are_current
    }
}

impl Group {
    /// Steps all worlds as [`Group::step`]; false, with nothing done, where the programs cannot.
    #[inline]
    pub(super) fn step_compiled(
        &mut self,
        plan: &Plan,
        actions: &[f64],
        autoreset: Autoreset,
        out: &mut StepMut<'_>,
        scratch: &mut Scratch,
    ) -> bool {
        let Some(task) = &plan.compiled else { return false };
        if !self.enter_rows(plan, task) {
            return false;
        }
        let Some(found) = (match task.width() {
            8 => self.act_compiled::<8>(task, actions, autoreset, out, scratch),
            4 => self.act_compiled::<4>(task, actions, autoreset, out, scratch),
            _ => None,
        }) else {
            return false;
        };
        if found != [0, 0] || self.compiled.as_ref().is_some_and(|compiled| compiled.over != 0) {
            self.end_episodes(plan, task, found, autoreset, out, scratch);
        }
        true
    }

    /// Makes an action of all worlds, and writes its results as if no episode was over. Returns the bits of the worlds
    /// whose episode terminates, and of those at its time limit; none, with nothing done, where the programs cannot.
    #[inline]
    fn act_compiled<const WIDTH: usize>(
        &mut self,
        task: &CompiledTask,
        actions: &[f64],
        autoreset: Autoreset,
        out: &mut StepMut<'_>,
        scratch: &mut Scratch,
    ) -> Option<[u64; 2]> {
        let (CompiledWorlds { rows, over, .. }, compiled) = (self.compiled.as_mut()?, scratch.compiled.as_mut()?);
        // those that begin anew have nothing to keep
        let kept = if autoreset == Autoreset::NextStep { 0 } else { *over };
        let results = ResultsMut { rewards: &mut *out.rewards, observations: &mut *out.observations };
        let found = rows.act(task, actions, [*over, kept], compiled, results)?;
        for flags in [&mut *out.terminated, &mut *out.truncated, &mut *out.stopped] {
            *flags.first_chunk_mut::<WIDTH>()? = [false; WIDTH];
        }
        let bits = |flag: usize| found >> (flag * WIDTH) & ((1 << WIDTH) - 1);
        Some([bits(flags::TERMINATES), bits(flags::AT_LIMIT)])
    }

    /// Ends the episodes that the flags of an action say, shows worlds whose episode was over before as they are, and
    /// begins others.
    fn end_episodes(
        &mut self,
        plan: &Plan,
        task: &CompiledTask,
        [terminates, at_limit]: [u64; 2],
        autoreset: Autoreset,
        out: &mut StepMut<'_>,
        scratch: &mut Scratch,
    ) {
        let Some(compiled) = &mut self.compiled else { return };
        let n = plan.n_observations();
        let was_over = compiled.over;
        compiled.over |= terminates | at_limit;
        let (begins, keeps) = match autoreset {
            Autoreset::NextStep => (was_over, 0),
            Autoreset::SameStep => (compiled.over & !was_over, was_over),
            Autoreset::Disabled => (0, was_over),
        };
        for k in set_bits(compiled.over) {
            let is_set = |bits: u64| bits >> k & 1 == 1;
            self.episodes.is_over[k] = true;
            if is_set(was_over) {
                out.rewards[k] = 0.0;
            } else {
                (out.terminated[k], out.truncated[k]) = (is_set(terminates), is_set(at_limit & !terminates));
                if is_set(begins) {
                    out.final_observations[k * n..(k + 1) * n].copy_from_slice(&out.observations[k * n..(k + 1) * n]);
                }
            }
        }
        if keeps != 0 {
            self.show_as_they_are(plan, task, keeps, out.observations, scratch);
        }
        if begins != 0 {
            self.start_compiled(plan, task, begins, out.observations, scratch);
        }
    }

    /// Shows the worlds of the bits `worlds`, which the last action left as they were.
    fn show_as_they_are(
        &mut self,
        plan: &Plan,
        task: &CompiledTask,
        worlds: u64,
        observations: &mut [f64],
        scratch: &mut Scratch,
    ) {
        let Some(CompiledWorlds { rows, away, .. }) = &self.compiled else { return };
        let Some(compiled) = &mut scratch.compiled else { return };
        let away = *away & worlds;
        let is_seen = rows.look(task, worlds & !away, compiled, observations);
        debug_assert!(is_seen, "what ended could be looked at before");
        for k in set_bits(away) {
            self.write(plan, k, observations, &mut scratch.stack);
        }
    }

    /// Begins new episodes as [`Group::reset`]; false, with nothing done, where the programs cannot.
    pub(super) fn reset_compiled(
        &mut self,
        plan: &Plan,
        mask: &[bool],
        observations: &mut [f64],
        scratch: &mut Scratch,
    ) -> bool {
        let Some(task) = &plan.compiled else { return false };
        match &mut self.compiled {
            None => return false,
            // none of the worlds has anything to keep
            Some(compiled) if !mask.contains(&false) => (compiled.are_current, compiled.over) = (true, 0),
            Some(_) => {}
        }
        if !self.enter_rows(plan, task) {
            return false;
        }
        let begins = mask.iter().enumerate().fold(0, |bits, (k, begins)| bits | u64::from(*begins) << k);
        self.start_compiled(plan, task, begins, observations, scratch);
        true
    }

    /// Begins the next episodes of the worlds of the bits `begins`, and writes what the agent sees of them.
    fn start_compiled(
        &mut self,
        plan: &Plan,
        task: &CompiledTask,
        begins: u64,
        observations: &mut [f64],
        scratch: &mut Scratch,
    ) {
        for k in set_bits(begins) {
            self.draw(plan, k, scratch);
            let Some(CompiledWorlds { rows, away, over, .. }) = &mut self.compiled else { return };
            rows.start(task, k, &scratch.drawn.state, &scratch.drawn.named);
            *away &= !(1 << k);
            *over &= !(1 << k);
        }
        let Some(CompiledWorlds { rows, .. }) = &mut self.compiled else { return };
        let Some(compiled) = &mut scratch.compiled else { return };
        if rows.start_diagram(task, begins, compiled) && rows.look(task, begins, compiled, observations) {
            return;
        }
        // a start that the programs cannot judge
        self.leave_rows(plan);
        for (k, begins_anew) in scratch.begins_anew[..task.width()].iter_mut().enumerate() {
            *begins_anew = begins >> k & 1 == 1;
            self.episodes.numbers[k] -= u64::from(*begins_anew);
        }
        self.start(plan, scratch);
        self.look(plan);
        for k in set_bits(begins) {
            self.write(plan, k, observations, &mut scratch.stack);
        }
    }

    /// Moves the state of the worlds into the rows; false where there are none, or the worlds cannot be there now.
    #[inline]
    fn enter_rows(&mut self, plan: &Plan, task: &CompiledTask) -> bool {
        match &self.compiled {
            None => false,
            Some(compiled) if compiled.are_current => true,
            Some(_) => self.move_into_rows(plan, task).is_some(),
        }
    }

    fn move_into_rows(&mut self, plan: &Plan, task: &CompiledTask) -> Option<()> {
        let CompiledWorlds { rows, are_current, away, over } = self.compiled.as_mut()?;
        let layout = task.layout;
        let is_here = |k: &usize| !self.episodes.is_over[*k];
        if (0..task.width()).filter(is_here).any(|k| !self.is_finite[k]) {
            return None;
        }
        match &mut self.worlds {
            Worlds::Lanes(bundle) => {
                bundle.copy_state(plan, rows.state_mut());
                for (k, commands) in self.commands.chunks_exact(layout.n_commands.max(1)).enumerate() {
                    commands.iter().enumerate().for_each(|(i, x)| rows.set(k, layout.n_state + i, *x));
                }
                for k in (0..task.width()).filter(is_here) {
                    bundle.diagram(k).into_iter().for_each(|diagram| rows.set_diagram(k, &diagram));
                }
            }
            Worlds::Single(worlds) => {
                for k in (0..task.width()).filter(is_here) {
                    let (state, diagram) = worlds[k].state()?;
                    let State { q, v, rotors, commands, .. } = state;
                    let numbers = q.iter().chain(v).chain(rotors).chain(commands);
                    numbers.enumerate().for_each(|(i, x)| rows.set(k, i, *x));
                    diagram.into_iter().for_each(|diagram| rows.set_diagram(k, diagram));
                }
            }
        }
        let known = layout.n_actions + layout.n_named;
        *over = 0;
        for k in 0..task.width() {
            let of_world = &self.values[k * self.n_slots + self.n_signals..][..known];
            if !is_here(&k) {
                // a state that programs can compute with, though nobody sees it
                rows.start(task, k, &plan.loaded.scene.initial, &of_world[layout.n_actions..]);
                *over |= 1 << k;
                continue;
            }
            of_world.iter().enumerate().for_each(|(i, x)| rows.set(k, layout.acted() + i, *x));
            rows.set(k, layout.count(), self.episodes.actions[k] as f64);
            rows.set(k, layout.finite(), 0.0);
        }
        *away = *over;
        *are_current = rows.are_computable();
        are_current.then_some(())
    }

    /// Moves the state of the worlds out of the rows, if it is there.
    pub(super) fn leave_rows(&mut self, plan: &Plan) {
        let Some(compiled) = &mut self.compiled else { return };
        let Some(task) = plan.compiled.as_ref().filter(|_| core::mem::take(&mut compiled.are_current)) else { return };
        let (CompiledWorlds { rows, away, .. }, layout, n) = (&*compiled, task.layout, self.n_signals);
        let here = !*away & ((1 << task.width()) - 1);
        let mut state = plan.loaded.scene.initial.clone();
        for k in set_bits(here) {
            rows.read_state(k, &mut state);
            self.episodes.actions[k] = rows.get(k, layout.count()) as u64;
            let commands = &mut self.commands[k * layout.n_commands..][..layout.n_commands];
            commands.iter_mut().enumerate().for_each(|(i, x)| *x = unsigned_zero(rows.get(k, layout.n_state + i)));
            let tick = self.episodes.actions[k] * plan.task.ticks;
            match &mut self.worlds {
                Worlds::Lanes(bundle) => bundle.resume(plan, k, tick, &state, |diagram| rows.read_diagram(k, diagram)),
                Worlds::Single(worlds) => {
                    worlds[k].resume(tick, |now, diagram| {
                        now.q.copy_from_slice(&state.q);
                        now.v.copy_from_slice(&state.v);
                        now.rotors.copy_from_slice(&state.rotors);
                        now.commands.copy_from_slice(commands);
                        if let Some(diagram) = diagram {
                            rows.read_diagram(k, diagram);
                        }
                    });
                }
            }
        }
        if let Worlds::Lanes(bundle) = &mut self.worlds {
            bundle.set_commands(plan, &self.commands);
        }
        self.observe(plan);
        for k in set_bits(here) {
            if !self.is_finite[k] {
                continue;
            }
            copy_unsigned(&mut self.values[k * self.n_slots..], &self.signals[k * n..(k + 1) * n]);
            self.see_actions(plan, task, k);
        }
    }

    /// Actions, random numbers and time that formulas see of a world, from the rows.
    fn see_actions(&mut self, plan: &Plan, task: &CompiledTask, k: usize) {
        let Some(CompiledWorlds { rows, .. }) = &self.compiled else { return };
        let (layout, known) = (task.layout, task.layout.n_actions + task.layout.n_named);
        let of_world = &mut self.values[k * self.n_slots..(k + 1) * self.n_slots][self.n_signals..];
        for (i, x) in of_world[..known].iter_mut().enumerate() {
            *x = unsigned_zero(rows.get(k, layout.acted() + i));
        }
        of_world[known] = rows.get(k, layout.count()) * plan.period();
    }
}
