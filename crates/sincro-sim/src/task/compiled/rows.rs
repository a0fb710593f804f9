//! Numbers of a bundle of worlds as the compiled programs have them: a row of lanes for each.

use sincro_dynamics::state::State;

use super::{CompiledTask, Layout, results};
use crate::task::plan::{Plan, copy_unsigned, unsigned_zero};

/// Worlds of a bundle, one in each lane.
#[derive(Debug)]
pub(in super::super) struct Rows {
    layout: Layout,
    width: usize,
    /// All numbers of [`Layout`], in its order.
    rows: Vec<f64>,
}

/// Working memory of an action, with its results.
#[derive(Debug)]
pub(in super::super) struct CompiledScratch {
    /// The rows before the action.
    saved: Vec<f64>,
    /// Commands and actions as they act.
    commanded: Vec<f64>,
    /// Results of the diagram's programs.
    controlled: Vec<f64>,
    /// Results: see [`results`].
    pub results: Vec<f64>,
}

impl CompiledScratch {
    pub fn new(plan: &Plan, task: &CompiledTask) -> Self {
        let layout = task.layout;
        let of = |n_rows: usize| vec![0.0; n_rows * task.width()];
        let n_signals = if task.has_others() { plan.probes.len() } else { 0 };
        Self {
            saved: of(layout.n_rows()),
            commanded: of(layout.n_commands + layout.n_actions),
            controlled: vec![0.0; task.n_controlled() * task.width()],
            results: of(results::OBSERVATIONS + plan.n_observations() + n_signals),
        }
    }

    /// Row `k` of [`results`].
    #[inline]
    pub fn result(&self, k: usize, width: usize) -> &[f64] {
        &self.results[k * width..][..width]
    }
}

impl Rows {
    pub fn new(task: &CompiledTask) -> Self {
        let (layout, width) = (task.layout, task.width());
        Self { layout, width, rows: vec![0.0; layout.n_rows() * width] }
    }

    /// Coordinates, velocities and rotor states, row by row.
    pub fn state_mut(&mut self) -> &mut [f64] {
        &mut self.rows[..self.layout.n_state * self.width]
    }

    /// Row `k` of [`Layout`].
    #[inline]
    pub fn row(&self, k: usize) -> &[f64] {
        &self.rows[k * self.width..][..self.width]
    }

    #[inline]
    fn row_mut(&mut self, k: usize) -> &mut [f64] {
        &mut self.rows[k * self.width..][..self.width]
    }

    /// Sets number `k` of [`Layout`] of a world.
    pub fn set(&mut self, lane: usize, k: usize, x: f64) {
        self.row_mut(k)[lane] = x;
    }

    /// Puts a world into a state at the start of an episode, before its first action.
    pub fn start(&mut self, task: &CompiledTask, lane: usize, state: &State<f64>, named: &[f64]) {
        let of_diagram = task.control.as_ref().map_or(&[][..], |control| &control.initial);
        let mut k = lane;
        let mut set = |numbers: &[f64]| {
            for x in numbers {
                self.rows[k] = *x;
                k += self.width;
            }
        };
        set(&state.q);
        set(&state.v);
        set(&state.rotors);
        set(&state.commands);
        (0..self.layout.n_actions).for_each(|_| set(&[0.0]));
        set(named);
        set(&[0.0]);
        set(of_diagram);
        set(&[0.0]);
    }

    /// Evaluates the diagram at the start of an episode, in the worlds of a mask; false if a signal is not finite.
    pub fn start_diagram(&mut self, task: &CompiledTask, mask: &[bool], scratch: &mut CompiledScratch) -> bool {
        let Some(control) = &task.control else { return true };
        let (layout, width) = (self.layout, self.width);
        let known = &self.rows[..layout.given() * width];
        let found = &mut scratch.controlled[..(1 + layout.n_signals) * width];
        if !control.programs[control.start].evaluate(known, &[], found) {
            return false;
        }
        let (finite, signals) = found.split_at(width);
        let signals_of_rows = &mut self.rows[layout.signals() * width..];
        for lane in (0..width).filter(|lane| mask[*lane]) {
            for k in (0..layout.n_signals).map(|k| k * width + lane) {
                signals_of_rows[k] = unsigned_zero(signals[k]);
            }
        }
        (0..width).all(|lane| !mask[lane] || finite[lane] == 0.0)
    }

    /// Signals and memory of the diagram of a world.
    pub fn read_diagram(&self, lane: usize, signals: &mut [f64], memory: &mut [f64]) {
        for (k, x) in signals.iter_mut().chain(memory).enumerate() {
            *x = self.row(self.layout.signals() + k)[lane];
        }
    }

    /// State of a world.
    pub fn read_state(&self, lane: usize, state: &mut State<f64>) {
        for (k, x) in state.q.iter_mut().chain(&mut state.v).chain(&mut state.rotors).enumerate() {
            *x = self.row(k)[lane];
        }
    }

    /// Makes one action, `lane × action`, of all worlds but those that `is_over`, and judges all. False, with
    /// everything as it was, where the programs do not have the bits of the recursions or give what is not finite.
    pub fn act(
        &mut self,
        task: &CompiledTask,
        actions: &[f64],
        is_over: &[bool],
        n_steps: u64,
        scratch: &mut CompiledScratch,
    ) -> bool {
        let (layout, n_actions) = (self.layout, self.layout.n_actions);
        for action in 0..n_actions {
            for (lane, x) in self.row_mut(layout.given() + action).iter_mut().enumerate() {
                *x = actions[lane * n_actions + action];
            }
        }
        scratch.saved.copy_from_slice(&self.rows);
        let done = self.advance(task, n_steps, scratch) && {
            self.count_actions(is_over, scratch);
            self.judge(task, scratch)
        };
        if !done {
            self.undo(scratch);
        }
        done
    }

    /// Takes the last action back.
    pub fn undo(&mut self, scratch: &CompiledScratch) {
        self.rows.copy_from_slice(&scratch.saved);
    }

    fn advance(&mut self, task: &CompiledTask, n_steps: u64, scratch: &mut CompiledScratch) -> bool {
        let (layout, width) = (self.layout, self.width);
        if !scratch.commanded.is_empty() {
            if !task.command.evaluate(&self.rows, &[], &mut scratch.commanded) {
                return false;
            }
            copy_unsigned(&mut self.rows[layout.n_state * width..], &scratch.commanded);
        }
        (0..n_steps as usize).all(|step| {
            self.latch(task, step, scratch)
                && task.step.evaluate_in_place(&mut self.rows[..layout.acted() * width], &[])
                && self.evaluate(task, step, scratch)
        })
    }

    /// Commands and memory of the diagram before base step `step` of an action.
    #[inline]
    fn latch(&mut self, task: &CompiledTask, step: usize, scratch: &mut CompiledScratch) -> bool {
        let Some(control) = &task.control else { return true };
        let (layout, width) = (self.layout, self.width);
        let found = &mut scratch.controlled[..(layout.n_commands + layout.n_memory) * width];
        if !control.programs[control.latch[step]].evaluate(&self.rows[..layout.given() * width], &[], found) {
            return false;
        }
        let (commands, memory) = found.split_at(layout.n_commands * width);
        copy_unsigned(&mut self.rows[layout.n_state * width..], commands);
        copy_unsigned(&mut self.rows[layout.memory() * width..], memory);
        true
    }

    /// Signals of the diagram after base step `step` of an action.
    #[inline]
    fn evaluate(&mut self, task: &CompiledTask, step: usize, scratch: &mut CompiledScratch) -> bool {
        let Some(control) = &task.control else { return true };
        let (layout, width) = (self.layout, self.width);
        let found = &mut scratch.controlled[..(1 + layout.n_signals) * width];
        if !control.programs[control.evaluate[step]].evaluate(&self.rows[..layout.given() * width], &[], found) {
            return false;
        }
        let (finite, signals) = found.split_at(width);
        copy_unsigned(&mut self.rows[layout.finite() * width..], finite);
        copy_unsigned(&mut self.rows[layout.signals() * width..], signals);
        true
    }

    /// Counts the action of all worlds but those that `is_over`: these stay where they were.
    #[inline]
    fn count_actions(&mut self, is_over: &[bool], scratch: &CompiledScratch) {
        let (layout, width) = (self.layout, self.width);
        let mut any_over = false;
        for (count, is_over) in self.row_mut(layout.count()).iter_mut().zip(is_over) {
            *count += f64::from(u8::from(!is_over));
            any_over |= *is_over;
        }
        if any_over {
            for lane in (0..width).filter(|lane| is_over[*lane]) {
                for k in (0..layout.acted()).chain(layout.signals()..layout.given()) {
                    self.rows[k * width + lane] = scratch.saved[k * width + lane];
                }
            }
        }
    }

    /// Results of the present state; false if they are not finite, or have other bits than the formulas.
    pub fn judge(&self, task: &CompiledTask, scratch: &mut CompiledScratch) -> bool {
        let known = &self.rows[..self.layout.given() * self.width];
        task.judge.evaluate(known, &[], &mut scratch.results)
            && scratch.result(results::FINITE, self.width).iter().all(|x| *x == 0.0)
    }
}
