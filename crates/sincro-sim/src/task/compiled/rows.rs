//! Numbers of a bundle of worlds as the compiled programs have them: a row of lanes for each.

use sincro_blocks::runner::State as DiagramState;
use sincro_dynamics::state::State;

use super::{Action, CompiledTask, Layout, native};
use crate::task::plan::{Plan, copy_unsigned, unsigned_zero};

/// Worlds of a bundle, one in each lane.
#[derive(Debug)]
pub(in super::super) struct Rows {
    layout: Layout,
    width: usize,
    /// All numbers of [`Layout`], in its order.
    rows: Vec<f64>,
}

/// Working memory of an action.
#[derive(Debug)]
pub(in super::super) struct CompiledScratch {
    /// Commands and actions as they act.
    commanded: Vec<f64>,
    /// Results of the diagram's programs.
    controlled: Vec<f64>,
    /// Rows after the steps of an action by its parts: it may turn out that it cannot be judged.
    stepped: Vec<f64>,
    /// Rows before an action that leaves some worlds as they are.
    before: Vec<f64>,
    /// Observations of all worlds where some are looked at, world by world.
    observations: Vec<f64>,
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
            before: of(layout.given()),
            observations: of(plan.n_observations()),
        }
    }
}

/// Places of the results of an action of a bundle's worlds.
#[derive(Debug)]
pub(in super::super) struct ResultsMut<'a> {
    /// A reward a world.
    pub rewards: &'a mut [f64],
    /// Observations, world by world.
    pub observations: &'a mut [f64],
}

/// Numbers of the bits that are set.
#[inline]
pub(in super::super) fn set_bits(mut bits: u64) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let first = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (first < u64::BITS).then_some(first as usize)
    })
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

    /// Evaluates the diagram at the start of an episode, in the worlds of the bits `lanes`; false if a signal is not
    /// finite.
    pub fn start_diagram(&mut self, task: &CompiledTask, lanes: u64, scratch: &mut CompiledScratch) -> bool {
        let Some(control) = &task.control else { return true };
        let (layout, width) = (self.layout, self.width);
        let found = &mut scratch.controlled[..(1 + layout.n_signals) * width];
        if !control.start.evaluate(self.known(), &[], found) {
            return false;
        }
        let (finite, signals) = found.split_at(width);
        let signals_of_rows = &mut self.rows[layout.signals() * width..];
        for lane in set_bits(lanes) {
            for k in (0..layout.n_signals).map(|k| k * width + lane) {
                signals_of_rows[k] = unsigned_zero(signals[k]);
            }
        }
        set_bits(lanes).all(|lane| finite[lane] == 0.0)
    }

    /// Writes what the agent sees of the present state in the worlds of the bits `lanes`; false, with nothing written,
    /// if something there is not finite.
    pub fn look(
        &self,
        task: &CompiledTask,
        lanes: u64,
        scratch: &mut CompiledScratch,
        observations: &mut [f64],
    ) -> bool {
        let (seen, n) = (&mut scratch.observations, task.n_observations);
        let bad = task.look.evaluate_in_form(self.known(), &[], &mut [], [&mut [], &mut seen[..]], 0);
        let is_seen = bad.is_some_and(|bad| bad & lanes == 0);
        if is_seen {
            for lane in set_bits(lanes) {
                observations[lane * n..(lane + 1) * n].copy_from_slice(&seen[lane * n..(lane + 1) * n]);
            }
        }
        is_seen
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
    /// the state as it was, where the programs do not have the bits of the recursions or give what is not finite in a
    /// world that is not among those of the bits `over`.
    #[inline]
    pub fn act(
        &mut self,
        task: &CompiledTask,
        actions: &[f64],
        [over, kept]: [u64; 2],
        scratch: &mut CompiledScratch,
        results: ResultsMut<'_>,
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
        if kept != 0 {
            scratch.before.copy_from_slice(self.known());
        }
        let found = match &task.action {
            Action::Whole(whole) => {
                let results = [results.rewards, results.observations];
                whole.evaluate_in_form_in_place(&mut self.rows, &[], results, over)
            }
            Action::Parts { .. } => self.act_in_parts(task, over, scratch, results),
        }?;
        for lane in set_bits(kept) {
            for k in (0..layout.given()).map(|k| k * width + lane) {
                self.rows[k] = scratch.before[k];
            }
        }
        Some(found)
    }

    fn act_in_parts(
        &mut self,
        task: &CompiledTask,
        over: u64,
        scratch: &mut CompiledScratch,
        results: ResultsMut<'_>,
    ) -> Option<u64> {
        let Action::Parts { command, step, finish, control, n_steps } = &task.action else { return None };
        let (layout, width) = (self.layout, self.width);
        let CompiledScratch { commanded, controlled, stepped: new, .. } = scratch;
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
        let next = &mut self.rows[..layout.given() * width];
        finish.evaluate_in_form(new, &[], next, [results.rewards, results.observations], over)
    }
}
