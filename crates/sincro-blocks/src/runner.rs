//! Runner of a compiled diagram in lock-step with a world: its state, and the verbs of a step.
//!
//! ```text
//! tick k:   evaluate(k)   outputs of all blocks that are due at t_k, in order; the others hold
//!           update(k)     memory for the next tick, from the signals at t_k
//! between:  minor(t)      outputs of the continuous blocks, wherever the integrator looks
//!           slopes(t)     rates of the continuous states
//! ```
//!
//! Measurements are written before `evaluate` and `minor` ([`Runner::signals_mut`]), commands read after them
//! ([`Runner::signals`]). What depends on the world's accelerations is evaluated apart (`*_late`), when they are known.

use std::sync::Arc;

use crate::block::At;
use crate::instance::{Number, RunningBlock};
use crate::program::{Program, Rate, Step};

/// State of a running diagram: all that changes, and all that a snapshot must hold. [`Program`] has the ranges of each
/// block in these vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct State<R> {
    /// Output components of all blocks and measurements, each in its own unit (`Program::n_signals`); held between
    /// samples.
    pub signals: Vec<R>,
    /// Continuous states of all blocks, each in its own unit (`Program::n_states`).
    pub continuous: Vec<R>,
    /// Discrete states of all blocks, each in its own unit (`Program::n_memory`).
    pub memory: Vec<R>,
    /// States that blocks keep elsewhere ([`Block::save_outside`](crate::block::Block::save_outside)), as bytes with
    /// the index of the step: filled by [`Runner::save`], empty in a run.
    pub outside: Vec<(usize, Vec<u8>)>,
}

/// Signal at which a loop is opened for analysis: all that reads it sees another value than its block gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopOpening<R> {
    /// Index of the component in the signals.
    pub signal: usize,
    /// Value that is seen in its place.
    pub value: R,
    /// Value that the block gave when it was last due.
    pub own: R,
}

/// Compiled diagram with its state, run step by step together with a plant: see the verbs in the [module](self).
///
/// ```
/// use sincro_blocks::compile::Terminal;
/// use sincro_blocks::library::maths::Gain;
/// use sincro_blocks::prelude::*;
///
/// let terminal = |name: &str| Terminal { names: vec![name.into()], width: 1, unit: None, is_special: false };
/// let mut world = Interface::new(0.01);
/// world.measurements.push(terminal("/cart.position"));
/// let mut diagram = Diagram::new();
/// diagram.block("controller", Gain::new(-5.0)).wire("/cart.position", "controller");
/// let mut runner = Runner::<f64>::new(compile(&diagram, &world)?.into());
/// let controller = runner.program().outputs().find(|(name, ..)| name == "controller").unwrap().1;
/// // the plant is one's own: x' = u, from x = 1
/// let mut x = 1.0;
/// for tick in 0..100 {
///     let t = tick as f64 * 0.01;
///     runner.signals_mut()[0] = x; // the measurement
///     runner.evaluate(tick, t);
///     x += 0.01 * runner.signals()[controller.start];
///     runner.update(tick, t);
/// }
/// assert!((x - f64::powi(1.0 - 0.05, 100)).abs() < 1e-15);
/// # Ok::<(), CompileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Runner<R: Number> {
    program: Arc<Program>,
    /// State of the diagram.
    pub state: State<R>,
    /// Signal of a block evaluated at ticks at which a loop is opened; `None` in a run. Not part of the state.
    pub opening: Option<LoopOpening<R>>,
    instances: Vec<Box<dyn RunningBlock<R>>>,
    /// For each of the program's periods: true if it is due.
    due: Vec<bool>,
    /// For each step: its period among the program's.
    period: Vec<usize>,
    new_memory: Vec<R>,
    /// Steps that are evaluated between ticks (before and after the late measurements), those that have continuous
    /// states, those that have anything to update.
    minor: Vec<usize>,
    minor_late: Vec<usize>,
    with_states: Vec<usize>,
    with_memory: Vec<usize>,
    /// Steps that have events of their own.
    with_events: Vec<usize>,
}

impl<R: Number> Runner<R> {
    /// Creates a runner at the start of a run: initial states written, constants evaluated, all other signals zero.
    #[must_use]
    pub fn new(program: Arc<Program>) -> Self {
        let zeros = |n: usize| vec![R::zero(); n];
        let state = State {
            signals: zeros(program.n_signals),
            continuous: zeros(program.n_states),
            memory: zeros(program.n_memory),
            outside: Vec::new(),
        };
        let instances = program.steps.iter().map(|step| R::instance(step.template.as_ref())).collect();
        let period = |step: &Step| program.periods.iter().position(|p| *p == step.node.every).unwrap_or(0);
        let those = |wanted: &dyn Fn(&Step) -> bool| -> Vec<usize> {
            (0..program.steps.len()).filter(|&k| wanted(&program.steps[k])).collect()
        };
        let mut runner = Self {
            period: program.steps.iter().map(period).collect(),
            due: vec![true; program.periods.len()],
            new_memory: zeros(program.n_memory),
            minor: those(&|s| s.is_minor).into_iter().filter(|k| *k < program.n_early).collect(),
            minor_late: those(&|s| s.is_minor).into_iter().filter(|k| *k >= program.n_early).collect(),
            with_states: those(&|s| !s.states.is_empty()),
            with_memory: those(&|s| !s.memory.is_empty() || !s.states.is_empty()),
            with_events: those(&|s| s.template.zero_crossing_count().is_some()),
            state,
            opening: None,
            instances,
            program,
        };
        for (step, instance) in runner.program.steps.iter().zip(&runner.instances) {
            let states = &mut runner.state.continuous[step.states.clone()];
            instance.start(&step.node, states, &mut runner.state.memory[step.memory.clone()]);
        }
        for k in 0..runner.instances.len() {
            if runner.program.steps[k].rate == Rate::Constant {
                runner.output(k, 0.0, f64::INFINITY, 0);
            }
        }
        runner
    }

    /// State and instances of the blocks.
    pub(crate) fn into_parts(self) -> (State<R>, Vec<Box<dyn RunningBlock<R>>>) {
        (self.state, self.instances)
    }

    /// Compiled diagram that is run.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// Signals of all blocks and measurements (`Program::n_signals`), each in its own unit, as last evaluated;
    /// [`Program::outputs`] and [`Program::commands`] have the ranges.
    #[must_use]
    #[inline(always)]
    pub fn signals(&self) -> &[R] {
        &self.state.signals
    }

    /// Signals of all blocks and measurements (`Program::n_signals`), each in its own unit, to write measurements into:
    /// their ranges are in [`Program::early`] and [`Program::late`].
    #[inline(always)]
    pub fn signals_mut(&mut self) -> &mut [R] {
        &mut self.state.signals
    }

    /// Evaluates the outputs at tick `tick` (counted in base steps from 0), at time `t` `[s]`, up to those that depend
    /// on late measurements ([`Program::late`], such as accelerations).
    pub fn evaluate(&mut self, tick: u64, t: f64) {
        self.find_due(tick);
        self.evaluate_range(0..self.program.n_early, tick, t);
    }

    /// Continues from a `state` of [`Runner::save`], as it was after the evaluation of tick `tick` (counted in base
    /// steps from 0).
    pub fn resume(&mut self, state: State<R>, tick: u64) {
        self.state = state;
        let outside = core::mem::take(&mut self.state.outside);
        for (k, (step, instance)) in self.program.steps.iter().zip(&mut self.instances).enumerate() {
            let saved = outside.iter().find(|(of, _)| *of == k).map(|(_, bytes)| bytes.as_slice());
            instance.restore_outside(saved, &self.state.memory[step.memory.clone()]);
        }
        self.find_due(tick);
    }

    /// Returns the state, with what blocks keep elsewhere, for [`Runner::resume`].
    #[must_use]
    pub fn save(&self) -> State<R> {
        State { outside: self.save_outside(), ..self.state.clone() }
    }

    /// States that blocks keep elsewhere, as [`State::outside`] has them.
    #[must_use]
    pub fn save_outside(&self) -> Vec<(usize, Vec<u8>)> {
        let save = |k: usize| {
            let memory = &self.state.memory[self.program.steps[k].memory.clone()];
            Some((k, self.instances[k].save_outside(memory)?))
        };
        (0..self.instances.len()).filter_map(save).collect()
    }

    fn find_due(&mut self, tick: u64) {
        for (due, period) in self.due.iter_mut().zip(&self.program.periods) {
            *due = *period == 1 || tick.is_multiple_of(*period);
        }
    }

    /// Evaluates the outputs at tick `tick`, at time `t` `[s]`, that depend on late measurements, written since
    /// [`Runner::evaluate`].
    pub fn evaluate_late(&mut self, tick: u64, t: f64) {
        self.evaluate_range(self.program.n_early..self.instances.len(), tick, t);
    }

    /// Evaluates the outputs of step `k` of the program alone, due or not, at tick `tick`, time `t` `[s]`; for
    /// compilers.
    pub fn evaluate_step(&mut self, k: usize, tick: u64, t: f64) {
        self.output(k, t, f64::INFINITY, tick);
    }

    /// Computes the discrete states of step `k` of the program alone for the next tick, due or not; for compilers. The
    /// other states, and the continuous ones, stay.
    pub fn update_step(&mut self, k: usize, tick: u64, t: f64) {
        self.new_memory.copy_from_slice(&self.state.memory);
        self.update_memory(k, tick, t);
        core::mem::swap(&mut self.state.memory, &mut self.new_memory);
    }

    fn evaluate_range(&mut self, steps: core::ops::Range<usize>, tick: u64, t: f64) {
        for k in steps {
            if self.program.steps[k].rate != Rate::Constant && self.due[self.period[k]] {
                if self.with_events.contains(&k) {
                    self.handle_events_of(k, tick, t, false);
                }
                self.output(k, t, f64::INFINITY, tick);
                self.replace_opened(k);
            }
        }
    }

    /// Puts the other value in place of the output of step `k`, if a loop is opened there.
    #[inline(always)]
    fn replace_opened(&mut self, k: usize) {
        if let Some(opening) = &mut self.opening
            && self.program.steps[k].out.contains(&opening.signal)
        {
            opening.own = core::mem::replace(&mut self.state.signals[opening.signal], opening.value);
        }
    }

    #[inline(always)]
    fn output(&mut self, k: usize, t: f64, time_event: f64, tick: u64) {
        let step = &self.program.steps[k];
        let (before, out) = self.state.signals.split_at_mut(step.out.start);
        let at = At {
            t,
            time_event,
            tick,
            node: &step.node,
            states: &self.state.continuous[step.states.clone()],
            memory: &self.state.memory[step.memory.clone()],
            signals: before,
            ports: &step.ports,
        };
        self.instances[k].output(&at, &mut out[..step.out.len()]);
    }

    /// Computes the discrete states of the next tick from the signals of tick `tick`, at time `t` `[s]`. To be called
    /// once for every evaluated tick.
    pub fn update(&mut self, tick: u64, t: f64) {
        if self.with_memory.is_empty() {
            return;
        }
        self.new_memory.copy_from_slice(&self.state.memory);
        for i in 0..self.with_memory.len() {
            let k = self.with_memory[i];
            let step = &self.program.steps[k];
            if step.rate == Rate::Constant || !self.due[self.period[k]] {
                continue;
            }
            self.update_memory(k, tick, t);
        }
        core::mem::swap(&mut self.state.memory, &mut self.new_memory);
    }

    /// Writes the discrete states of step `k` for the next tick into the new memory.
    #[inline(always)]
    fn update_memory(&mut self, k: usize, tick: u64, t: f64) {
        let step = &self.program.steps[k];
        let states = &mut self.state.continuous[step.states.clone()];
        let at = At {
            t,
            time_event: f64::INFINITY,
            tick,
            node: &step.node,
            // handed over to be set
            states: &[],
            memory: &self.state.memory[step.memory.clone()],
            signals: &self.state.signals,
            ports: &step.ports,
        };
        self.instances[k].update(&at, &mut self.new_memory[step.memory.clone()], states);
    }

    /// Evaluates the outputs of continuous blocks between ticks, at time `t` `[s]`, with the continuous states in
    /// `state.continuous`, up to those that depend on late measurements. `tick` is the last tick; `time_event` `[s]`
    /// see [`At::time_event`].
    pub fn minor(&mut self, tick: u64, t: f64, time_event: f64) {
        for i in 0..self.minor.len() {
            self.output(self.minor[i], t, time_event, tick);
        }
    }

    /// Evaluates the outputs between ticks, at time `t` `[s]`, that depend on late measurements, written since
    /// [`Runner::minor`]; same arguments.
    pub fn minor_late(&mut self, tick: u64, t: f64, time_event: f64) {
        for i in 0..self.minor_late.len() {
            self.output(self.minor_late[i], t, time_event, tick);
        }
    }

    /// Evaluates all continuous blocks at time `t` `[s]`, even those that the integrator does not need: those that
    /// depend on late measurements if `late`, else the others. For linearisation, `perturbed` is an index in the
    /// signals and the change added to it once it is known, in its unit.
    pub fn evaluate_continuous(&mut self, tick: u64, t: f64, late: bool, perturbed: Option<(usize, R)>) {
        let steps = if late { self.program.n_early..self.instances.len() } else { 0..self.program.n_early };
        for k in steps {
            if self.program.steps[k].rate == Rate::Continuous {
                self.output(k, t, f64::INFINITY, tick);
                if let Some((signal, change)) = perturbed
                    && self.program.steps[k].out.contains(&signal)
                {
                    self.state.signals[signal] += change;
                }
            }
        }
    }

    /// Computes the time derivatives of the continuous states, each in its unit per second, at time `t` `[s]` from the
    /// signals as they now are; `derivatives` has `Program::n_states` entries. `tick` and `time_event` as in
    /// [`Runner::minor`].
    pub fn derivatives(&mut self, tick: u64, t: f64, time_event: f64, derivatives: &mut [R]) {
        self.with_each_state(tick, t, time_event, |instance, at, states| {
            instance.derivatives(at, &mut derivatives[states])
        });
    }

    /// Computes the diagonal of −∂f/∂x `[1/s]` of the continuous states at time `t` `[s]`; `diagonal` has
    /// `Program::n_states` entries, `tick` is the last tick. See [`crate::block::Block::neg_jacobian_diagonal`].
    pub fn neg_jacobian_diagonal(&mut self, tick: u64, t: f64, diagonal: &mut [R]) {
        diagonal.fill(R::zero());
        self.with_each_state(tick, t, f64::INFINITY, |instance, at, states| {
            instance.neg_jacobian_diagonal(at, &mut diagonal[states])
        });
    }

    /// Returns the number of zero-crossing functions of all blocks; `None` if no block has events of its own.
    #[must_use]
    pub fn zero_crossing_count(&self) -> Option<usize> {
        let count = |k: &usize| self.program.steps[*k].template.zero_crossing_count().unwrap_or(0);
        (!self.with_events.is_empty()).then(|| self.with_events.iter().map(count).sum())
    }

    /// Computes the zero-crossing functions of all blocks at time `t` `[s]` from the signals as they now are; see
    /// [`crate::block::Block::zero_crossings`]. `values` has [`Runner::zero_crossing_count`] entries, `tick` is the
    /// last tick.
    pub fn zero_crossings(&mut self, tick: u64, t: f64, values: &mut [R]) {
        let mut start = 0;
        for i in 0..self.with_events.len() {
            let k = self.with_events[i];
            let step = &self.program.steps[k];
            let end = start + step.template.zero_crossing_count().unwrap_or(0);
            let at = everything_known(step, &self.state, (tick, t, f64::INFINITY));
            self.instances[k].zero_crossings(&at, &mut values[start..end]);
            start = end;
        }
    }

    /// Instant of the first time event that blocks have scheduled themselves `[s]`; infinite if there is none.
    #[must_use]
    pub fn scheduled_event(&self) -> f64 {
        let of_step = |k: &usize| {
            let memory = &self.state.memory[self.program.steps[*k].memory.clone()];
            self.instances[*k].scheduled_event(memory)
        };
        self.with_events.iter().map(of_step).fold(f64::INFINITY, f64::min)
    }

    /// Handles the events of all blocks after an accepted step of the integrator that ended at time `t` `[s]`, from the
    /// signals as they now are. Returns true if there was one: discrete and continuous states may then have changed,
    /// and signals follow with the next evaluation.
    pub fn handle_events(&mut self, tick: u64, t: f64) -> bool {
        let mut happened = false;
        for i in 0..self.with_events.len() {
            happened |= self.handle_events_of(self.with_events[i], tick, t, true);
        }
        happened
    }

    fn handle_events_of(&mut self, k: usize, tick: u64, t: f64, is_step_end: bool) -> bool {
        let step = &self.program.steps[k];
        // before the tick is evaluated, only what stands to the left is known
        let known = if is_step_end { self.state.signals.len() } else { step.out.start };
        let at = At {
            t,
            time_event: f64::INFINITY,
            tick,
            node: &step.node,
            states: &[],
            memory: &[],
            signals: &self.state.signals[..known],
            ports: &step.ports,
        };
        let memory = &mut self.state.memory[step.memory.clone()];
        let states = &mut self.state.continuous[step.states.clone()];
        self.instances[k].handle_events(&at, (memory, states), is_step_end)
    }

    #[inline(always)]
    fn with_each_state(
        &mut self,
        tick: u64,
        t: f64,
        time_event: f64,
        mut visit: impl FnMut(&mut dyn RunningBlock<R>, &At<'_, R>, core::ops::Range<usize>),
    ) {
        for &k in &self.with_states {
            let step = &self.program.steps[k];
            let at = everything_known(step, &self.state, (tick, t, time_event));
            visit(self.instances[k].as_mut(), &at, step.states.clone());
        }
    }

    /// Remarks of the blocks on the run so far: path of the block and text, in the order of evaluation.
    #[must_use]
    pub fn notices(&self) -> Vec<(&str, String)> {
        let of_step = |step: &'_ Step| {
            let memory: Vec<f64> = self.state.memory[step.memory.clone()].iter().map(|x| x.lane(0)).collect();
            step.template.notice(&step.node, &memory)
        };
        self.program.steps.iter().filter_map(|step| Some((step.path.as_str(), of_step(step)?))).collect()
    }

    /// First block with an output that is not finite, and the index of the component among its outputs (counted from
    /// 0); `None` if all are finite.
    #[must_use]
    pub fn not_finite(&self) -> Option<(&Step, usize)> {
        // x·0 is 0 for every finite x: one sum tells whether to look closer
        let sum = self.state.signals.iter().fold(R::zero(), |sum, x| sum + *x * R::zero());
        if sum.lane(0) == 0.0 {
            return None;
        }
        self.program.steps.iter().find_map(|step| {
            let bad = self.state.signals[step.out.clone()].iter().position(|x| !x.lane(0).is_finite());
            bad.map(|k| (step, k))
        })
    }
}

/// Instant of a block with all signals and its own states.
#[inline(always)]
fn everything_known<'a, R>(step: &'a Step, state: &'a State<R>, (tick, t, time_event): (u64, f64, f64)) -> At<'a, R> {
    At {
        t,
        time_event,
        tick,
        node: &step.node,
        states: &state.continuous[step.states.clone()],
        memory: &state.memory[step.memory.clone()],
        signals: &state.signals,
        ports: &step.ports,
    }
}
