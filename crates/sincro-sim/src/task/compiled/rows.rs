//! Numbers of a bundle of worlds as the compiled programs have them: a row of lanes for each.

use sincro_blocks::runner::State as DiagramState;
use sincro_dynamics::state::State;

use super::{Action, CompiledTask, Layout, flags, native};
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
    /// Commands and actions as they act.
    commanded: Vec<f64>,
    /// Results of the diagram's programs.
    controlled: Vec<f64>,
    /// Rows after the steps of an action by its parts.
    stepped: Vec<f64>,
    /// Rows after an action: it may turn out that it cannot be judged. One place for all bundles stays in the nearest
    /// cache, where two places for each would not fit into the next one.
    next: Vec<f64>,
    /// Reward, then observations.
    results: Vec<f64>,
    width: usize,
}

impl CompiledScratch {
    pub fn new(plan: &Plan, task: &CompiledTask) -> Self {
        let (layout, width) = (task.layout, task.width());
        let of = |n_rows: usize| vec![0.0; n_rows * width];
        let is_whole = matches!(task.action, Action::Whole(_));
        Self {
            commanded: of(layout.n_commands + layout.n_actions),
            controlled: of(task.n_controlled()),
            stepped: of(if is_whole { 0 } else { layout.given() }),
            next: of(layout.given()),
            results: of(1 + plan.n_observations()),
            width,
        }
    }

    /// Rewards of an action.
    #[inline]
    pub fn rewards(&self) -> &[f64] {
        &self.results[..self.width]
    }

    /// Observations, row by row.
    #[inline]
    pub fn observations(&self) -> &[f64] {
        &self.results[self.width..]
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

    /// Number `k` of [`Layout`] of a world.
    #[inline]
    pub fn get(&self, lane: usize, k: usize) -> f64 {
        self.rows[k * self.width + lane]
    }

    /// Sets number `k` of [`Layout`] of a world.
    #[inline]
    pub fn set(&mut self, lane: usize, k: usize, x: f64) {
        self.rows[k * self.width + lane] = x;
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
        // all signals are finite
        set(&[0.0]);
    }

    /// Rows that the programs know before an action is given.
    fn known(&self) -> &[f64] {
        &self.rows[..self.layout.given() * self.width]
    }

    /// Evaluates the diagram at the start of an episode, in the worlds of a mask; false if a signal is not finite.
    pub fn start_diagram(&mut self, task: &CompiledTask, mask: &[bool], scratch: &mut CompiledScratch) -> bool {
        let Some(control) = &task.control else { return true };
        let (layout, width) = (self.layout, self.width);
        let found = &mut scratch.controlled[..(1 + layout.n_signals) * width];
        if !control.start.evaluate(self.known(), &[], found) {
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

    /// Observes the present state; false if those of a world of the mask are not finite.
    pub fn look(&self, task: &CompiledTask, mask: &[bool], scratch: &mut CompiledScratch) -> bool {
        let observations = &mut scratch.results[self.width..];
        let bad = task.look.evaluate_in_form(self.known(), &[], &mut [], observations);
        bad.is_some_and(|bad| (0..self.width).all(|lane| !mask[lane] || bad >> lane & 1 == 0))
    }

    /// Signals and memory of the diagram of a world.
    pub fn read_diagram(&self, lane: usize, diagram: &mut DiagramState<f64>) {
        for (k, x) in diagram.signals.iter_mut().chain(&mut diagram.memory).enumerate() {
            *x = self.get(lane, self.layout.signals() + k);
        }
    }

    /// Sets signals and memory of the diagram of a world.
    pub fn set_diagram(&mut self, lane: usize, diagram: &DiagramState<f64>) {
        for (k, x) in diagram.signals.iter().chain(&diagram.memory).enumerate() {
            self.set(lane, self.layout.signals() + k, *x);
        }
    }

    /// State of a world.
    pub fn read_state(&self, lane: usize, state: &mut State<f64>) {
        for (k, x) in state.q.iter_mut().chain(&mut state.v).chain(&mut state.rotors).enumerate() {
            *x = self.get(lane, k);
        }
    }

    /// Returns true if programs can compute with the rows: they are neither huge nor what is no number.
    pub fn are_computable(&self) -> bool {
        self.known().iter().map(|x| x.abs()).sum::<f64>() < native::INPUT_LIMIT
    }

    /// Makes one action, `lane × action`, of all worlds but those of the bits `kept`. Returns the [`flags`]; none, with
    /// everything as it was, where the programs do not have the bits of the recursions or give what is not finite in a
    /// world that is not among those of the bits `but`.
    #[inline]
    pub fn act(
        &mut self,
        task: &CompiledTask,
        actions: &[f64],
        [but, kept]: [u64; 2],
        scratch: &mut CompiledScratch,
    ) -> Option<u64> {
        let (layout, width, n_actions) = (self.layout, self.width, self.layout.n_actions);
        let given = &mut self.rows[layout.given() * width..];
        if n_actions == 1 {
            given.copy_from_slice(actions);
        } else {
            for (lane, of_lane) in actions.chunks_exact(n_actions.max(1)).enumerate() {
                of_lane.iter().enumerate().for_each(|(action, x)| given[action * width + lane] = *x);
            }
        }
        let found = match &task.action {
            Action::Whole(whole) => whole.evaluate_in_form(&self.rows, &[], &mut scratch.next, &mut scratch.results),
            Action::Parts { .. } => self.act_in_parts(task, scratch),
        }?;
        let bad = found >> (flags::BAD * width) & ((1 << width) - 1) & !but;
        if bad != 0 {
            return None;
        }
        if kept != 0 {
            for lane in (0..width).filter(|lane| kept >> lane & 1 == 1) {
                for k in (0..layout.given()).map(|k| k * width + lane) {
                    scratch.next[k] = self.rows[k];
                }
            }
        }
        self.rows[..layout.given() * width].copy_from_slice(&scratch.next);
        Some(found)
    }

    fn act_in_parts(&mut self, task: &CompiledTask, scratch: &mut CompiledScratch) -> Option<u64> {
        let Action::Parts { command, step, finish, control, n_steps } = &task.action else { return None };
        let (layout, width) = (self.layout, self.width);
        let CompiledScratch { commanded, controlled, stepped: new, next, results, .. } = scratch;
        if !command.evaluate(&self.rows, &[], commanded) {
            return None;
        }
        new.copy_from_slice(self.known());
        copy_unsigned(&mut new[layout.n_state * width..], commanded);
        for k in 0..*n_steps as usize {
            if let Some([latch, _]) = control.get(k) {
                let found = &mut controlled[..(layout.n_commands + layout.n_memory) * width];
                if !latch.evaluate(new, &[], found) {
                    return None;
                }
                let (commands, memory) = found.split_at(layout.n_commands * width);
                copy_unsigned(&mut new[layout.n_state * width..], commands);
                copy_unsigned(&mut new[layout.memory() * width..], memory);
            }
            if !step.evaluate_in_place(&mut new[..layout.acted() * width], &[]) {
                return None;
            }
            if let Some([_, evaluate]) = control.get(k) {
                let found = &mut controlled[..(1 + layout.n_signals) * width];
                if !evaluate.evaluate(new, &[], found) {
                    return None;
                }
                let (finite, signals) = found.split_at(width);
                copy_unsigned(&mut new[layout.finite() * width..], finite);
                copy_unsigned(&mut new[layout.signals() * width..], signals);
            }
        }
        finish.evaluate_in_form(new, &[], next, results)
    }
}
