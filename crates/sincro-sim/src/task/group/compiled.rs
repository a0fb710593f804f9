//! Steps of a group by the compiled programs, wherever they have the bits of its other steps.

pub(super) use crate::task::compiled::CompiledScratch;

use sincro_dynamics::state::State;

use super::{Buffers, Group, Scratch, Worlds};
use crate::task::Autoreset;
use crate::task::compiled::{CompiledTask, Rows, results};
use crate::task::plan::{Formula, Plan, copy_unsigned, unsigned_zero};

/// Worlds of a whole bundle whose actions are compiled.
#[derive(Debug)]
pub(super) struct CompiledWorlds {
    rows: Rows,
    /// True while these have the state of the worlds, false while the bundle in lanes has it.
    are_current: bool,
}

impl CompiledWorlds {
    /// None where the task is not compiled, or the worlds do not fill the lanes.
    pub fn new(plan: &Plan, n_worlds: usize) -> Option<Self> {
        let task = plan.compiled.as_ref().filter(|task| task.width() == n_worlds)?;
        Some(Self { rows: Rows::new(task), are_current: false })
    }
}

impl Group {
    /// Steps all worlds as [`Group::step`]; false, with nothing done, where the programs cannot.
    pub(super) fn step_compiled(
        &mut self,
        plan: &Plan,
        actions: &[f64],
        autoreset: Autoreset,
        out: &mut Buffers<'_>,
        scratch: &mut Scratch,
    ) -> bool {
        let Some(task) = &plan.compiled else { return false };
        if !self.enter_rows(plan, task) {
            return false;
        }
        let (Some(CompiledWorlds { rows, .. }), Some(compiled)) = (&mut self.compiled, &mut scratch.compiled) else {
            return false;
        };
        if !rows.act(task, actions, &scratch.was_over, plan.task.ticks, compiled) {
            return false;
        }
        if task.has_others() && !self.judge_others(plan, task, out, scratch) {
            if let (Some(CompiledWorlds { rows, .. }), Some(compiled)) = (&mut self.compiled, &scratch.compiled) {
                rows.undo(compiled);
            }
            return false;
        }
        if self.take_results(plan, task, autoreset, out, scratch) {
            self.start_compiled(plan, task, out, scratch);
        }
        true
    }

    /// Formulas that are not compiled; false if one is not finite.
    fn judge_others(&mut self, plan: &Plan, task: &CompiledTask, out: &mut Buffers<'_>, scratch: &mut Scratch) -> bool {
        let n = plan.n_observations();
        for k in 0..self.n_worlds() {
            self.see(plan, task, k, scratch);
            let of_world = &self.values[k * self.n_slots..(k + 1) * self.n_slots];
            let mut value = |formula: &Formula| unsigned_zero(formula.eval(of_world, &mut scratch.stack));
            let mut is_finite = true;
            if !task.reward_is_compiled {
                out.rewards[k] = value(&plan.reward);
                is_finite &= out.rewards[k].is_finite();
            }
            if let (Some(formula), false) = (&plan.terminated, task.end_is_compiled) {
                let ended = value(formula);
                out.terminated[k] = ended != 0.0;
                is_finite &= ended.is_finite();
            }
            for i in &task.other_observations {
                out.observations[k * n + i] = value(&plan.observations[*i]);
                is_finite &= out.observations[k * n + i].is_finite();
            }
            if !is_finite {
                return false;
            }
        }
        true
    }

    /// Numbers that formulas see of a world, from the rows.
    fn see(&mut self, plan: &Plan, task: &CompiledTask, k: usize, scratch: &Scratch) {
        let Some(compiled) = &scratch.compiled else { return };
        let (n, first_signal) = (self.n_signals, results::OBSERVATIONS + plan.n_observations());
        for (i, x) in self.values[k * self.n_slots..][..n].iter_mut().enumerate() {
            *x = unsigned_zero(compiled.result(first_signal + i, task.width())[k]);
        }
        self.see_actions(plan, task, k);
    }

    /// Actions, random numbers and time that formulas see of a world, from the rows.
    fn see_actions(&mut self, plan: &Plan, task: &CompiledTask, k: usize) {
        let Some(CompiledWorlds { rows, .. }) = &self.compiled else { return };
        let (layout, known) = (task.layout, task.layout.n_actions + task.layout.n_named);
        let of_world = &mut self.values[k * self.n_slots..(k + 1) * self.n_slots][self.n_signals..];
        for (i, x) in of_world[..known].iter_mut().enumerate() {
            *x = rows.row(layout.acted() + i)[k];
        }
        of_world[known] = rows.row(layout.count())[k] * plan.period();
    }

    /// Writes the results of the compiled formulas, and what they make of the episodes; true if a world begins anew.
    fn take_results(
        &mut self,
        plan: &Plan,
        task: &CompiledTask,
        autoreset: Autoreset,
        out: &mut Buffers<'_>,
        scratch: &mut Scratch,
    ) -> bool {
        let (Some(CompiledWorlds { rows, .. }), Some(compiled)) = (&self.compiled, &scratch.compiled) else {
            return false;
        };
        let (n, width) = (plan.n_observations(), task.width());
        copy_observations(task, n, compiled, out.observations, None);
        let rewards = compiled.result(results::REWARD, width);
        let ended = compiled.result(results::ENDED, width);
        let count = rows.row(task.layout.count());
        let max = plan.task.max_actions as f64;
        let was_over = &scratch.was_over[..width];
        let begins_anew = &mut scratch.begins_anew[..width];
        let is_over = &mut self.episodes.is_over[..width];
        let (terminated, truncated) = (&mut out.terminated[..width], &mut out.truncated[..width]);
        let (written, stopped) = (&mut out.rewards[..width], &mut out.stopped[..width]);
        let mut any_begins = false;
        for k in 0..width {
            let reward = if task.reward_is_compiled { unsigned_zero(rewards[k]) } else { written[k] };
            let ends = if task.end_is_compiled { ended[k] != 0.0 } else { terminated[k] };
            written[k] = if was_over[k] { 0.0 } else { reward };
            terminated[k] = ends & !was_over[k];
            truncated[k] = (count[k] >= max) & !ends & !was_over[k];
            stopped[k] = false;
            is_over[k] = was_over[k] | terminated[k] | truncated[k];
            begins_anew[k] = match autoreset {
                Autoreset::NextStep => was_over[k],
                Autoreset::SameStep => is_over[k] & !was_over[k],
                Autoreset::Disabled => false,
            };
            any_begins |= begins_anew[k];
        }
        if any_begins && autoreset == Autoreset::SameStep {
            for k in (0..width).filter(|k| begins_anew[*k]) {
                out.finals[k * n..(k + 1) * n].copy_from_slice(&out.observations[k * n..(k + 1) * n]);
            }
        }
        any_begins
    }

    /// Begins the next episodes of the worlds that begin anew, and writes what the agent sees of them.
    fn start_compiled(&mut self, plan: &Plan, task: &CompiledTask, out: &mut Buffers<'_>, scratch: &mut Scratch) {
        for k in 0..task.width() {
            if !scratch.begins_anew[k] {
                continue;
            }
            self.draw(plan, k, scratch);
            let Some(CompiledWorlds { rows, .. }) = &mut self.compiled else { return };
            rows.start(task, k, &scratch.drawn.state, &scratch.drawn.named);
        }
        let Some(CompiledWorlds { rows, .. }) = &mut self.compiled else { return };
        let Some(compiled) = &mut scratch.compiled else { return };
        if rows.start_diagram(task, &scratch.begins_anew, compiled) && rows.judge(task, compiled) {
            copy_observations(task, plan.n_observations(), compiled, out.observations, Some(&scratch.begins_anew));
            if task.other_observations.is_empty() {
                return;
            }
            (0..task.width()).for_each(|k| self.see(plan, task, k, scratch));
        } else {
            // a start that the programs cannot judge
            self.leave_rows(plan);
            for (number, begins_anew) in self.episodes.numbers.iter_mut().zip(&scratch.begins_anew) {
                *number -= u64::from(*begins_anew);
            }
            self.start(plan, scratch);
            self.look(plan);
        }
        for k in (0..task.width()).filter(|k| scratch.begins_anew[*k]) {
            self.write(plan, k, out.observations, &mut scratch.stack);
        }
    }

    /// Moves the state of the worlds into the rows; false where there are none, or the worlds cannot be there now.
    fn enter_rows(&mut self, plan: &Plan, task: &CompiledTask) -> bool {
        let Some(compiled) = &mut self.compiled else { return false };
        if compiled.are_current {
            return true;
        }
        // a world that is over may have moved on behind what it shows
        if self.episodes.is_over.contains(&true) || self.is_finite.contains(&false) {
            return false;
        }
        let (rows, layout) = (&mut compiled.rows, task.layout);
        match &mut self.worlds {
            Worlds::Lanes(bundle) => {
                bundle.copy_state(plan, rows.state_mut());
                for (k, commands) in self.commands.chunks_exact(layout.n_commands.max(1)).enumerate() {
                    commands.iter().enumerate().for_each(|(i, x)| rows.set(k, layout.n_state + i, *x));
                }
            }
            Worlds::Single(worlds) => {
                for (k, world) in worlds.iter().enumerate() {
                    let Some((state, diagram)) = world.state() else { return false };
                    let State { q, v, rotors, commands, .. } = state;
                    for (i, x) in q.iter().chain(v).chain(rotors).chain(commands).enumerate() {
                        rows.set(k, i, *x);
                    }
                    let of_diagram =
                        diagram.into_iter().flat_map(|diagram| diagram.signals.iter().chain(&diagram.memory));
                    of_diagram.enumerate().for_each(|(i, x)| rows.set(k, layout.signals() + i, *x));
                    rows.set(k, layout.finite(), 0.0);
                }
            }
        }
        let known = layout.n_actions + layout.n_named;
        for (k, actions) in self.episodes.actions.iter().enumerate() {
            for (i, x) in self.values[k * self.n_slots + self.n_signals..][..known].iter().enumerate() {
                rows.set(k, layout.acted() + i, *x);
            }
            rows.set(k, layout.count(), *actions as f64);
        }
        compiled.are_current = true;
        true
    }

    /// Moves the state of the worlds out of the rows, if it is there.
    pub(super) fn leave_rows(&mut self, plan: &Plan) {
        let Some(compiled) = &mut self.compiled else { return };
        let Some(task) = plan.compiled.as_ref().filter(|_| core::mem::take(&mut compiled.are_current)) else { return };
        let (rows, layout, n) = (&compiled.rows, task.layout, self.n_signals);
        let mut state = plan.loaded.scene.initial.clone();
        for k in 0..task.width() {
            rows.read_state(k, &mut state);
            self.episodes.actions[k] = rows.row(layout.count())[k] as u64;
            for (i, x) in self.commands[k * layout.n_commands..][..layout.n_commands].iter_mut().enumerate() {
                *x = rows.row(layout.n_state + i)[k];
            }
            match &mut self.worlds {
                Worlds::Lanes(bundle) => bundle.place(plan, k, &state),
                Worlds::Single(worlds) => {
                    let commands = &self.commands[k * layout.n_commands..][..layout.n_commands];
                    worlds[k].resume(self.episodes.actions[k] * plan.task.ticks, |now, diagram| {
                        now.q.copy_from_slice(&state.q);
                        now.v.copy_from_slice(&state.v);
                        now.rotors.copy_from_slice(&state.rotors);
                        now.commands.copy_from_slice(commands);
                        if let Some(diagram) = diagram {
                            rows.read_diagram(k, &mut diagram.signals, &mut diagram.memory);
                        }
                    });
                }
            }
        }
        if let Worlds::Lanes(bundle) = &mut self.worlds {
            bundle.set_commands(plan, &self.commands);
        }
        self.observe(plan);
        for k in 0..task.width() {
            if self.is_finite[k] {
                copy_unsigned(&mut self.values[k * self.n_slots..], &self.signals[k * n..(k + 1) * n]);
                self.see_actions(plan, task, k);
            }
        }
    }
}

/// Copies the compiled observations, of the worlds of a mask or of all.
#[inline]
fn copy_observations(task: &CompiledTask, n: usize, from: &CompiledScratch, to: &mut [f64], mask: Option<&[bool]>) {
    let (width, others) = (task.width(), &task.other_observations[..]);
    if n == 0 {
        return;
    }
    let rows = &from.results[results::OBSERVATIONS * width..][..n * width];
    for (k, to) in to.chunks_exact_mut(n).enumerate().filter(|(k, _)| mask.is_none_or(|mask| mask[*k])) {
        for (i, x) in to.iter_mut().enumerate() {
            if others.is_empty() || !others.contains(&i) {
                *x = unsigned_zero(rows[i * width + k]);
            }
        }
    }
}
