//! Runs of one compiled diagram side by side in lanes, each with a clock of its own: [`LaneRunner`].
//!
//! The verbs of a step are those of a [`Runner`], and each lane has the bits that a runner
//! gives alone. Blocks that do the same operations whatever their numbers ([`Block::IN_LANES`]) compute all lanes
//! together; the others, such as sources, which see the clock of a lane, compute one lane after the other.
//!
//! [`Block::IN_LANES`]: crate::block::Block::IN_LANES

mod each;
mod together;

use std::sync::Arc;

use sincro_math::Real;

use crate::block::At;
use crate::instance::RunningBlock;
use crate::program::{Program, Rate};
use crate::runner::{Runner, State};
use each::{Each, Inputs};
pub(crate) use together::on_lanes;
use together::{Together, select};

/// Maximum number of lanes, one bit each.
const MAX_LANES: usize = 64;

/// Clock of one lane.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// Number of base steps from the start to the last tick.
    pub tick: u64,
    /// Time `[s]`.
    pub t: f64,
    /// Time event at which the present integration step ends `[s]`, else infinite: [`At::time_event`].
    pub time_event: f64,
    /// False for a lane that stays as it is.
    pub is_active: bool,
}

/// Runs of a compiled diagram in the lanes of `R`: signals and states of all of them, and the verbs of a step as a
/// [`Runner`] has them. For code within a [dispatch to lanes](sincro_math::lanes::dispatch_lanes).
pub struct LaneRunner<R> {
    program: Arc<Program>,
    n: usize,
    /// Signals of all blocks and measurements, as [`State::signals`].
    pub signals: Vec<R>,
    /// Continuous states of all blocks, as [`State::continuous`].
    pub continuous: Vec<R>,
    memory: Vec<R>,
    new_memory: Vec<R>,
    /// State of one lane at the start of a run.
    initial: State<f64>,
    blocks: Vec<LaneBlock>,
    together: LaneBlocks<R>,
    buffers: each::Buffers,
    /// Numbers of lanes that stay as they are.
    kept: Vec<R>,
    /// For each of the program's periods: the lanes in which it is due.
    due: Vec<u64>,
    period: Vec<usize>,
    minor: Vec<usize>,
    minor_late: Vec<usize>,
    with_states: Vec<usize>,
    with_memory: Vec<usize>,
}

/// Block that computes all lanes by its instance in [`LaneBlocks`], or each by one of its own.
enum LaneBlock {
    Together,
    Each(Each),
}

/// Instances of the blocks that compute all lanes together, by their steps in the program. They have no state but
/// buffers whose content does not matter: [`LaneRunner`]s of one program may share them, one after the other.
pub struct LaneBlocks<R>(Vec<Option<Box<dyn RunningBlock<R>>>>);

impl<R: Real> LaneBlocks<R> {
    /// Creates the instances of a program.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        Self(program.steps.iter().map(|step| Together::instance(step.template.as_ref())).collect())
    }

    #[inline(always)]
    fn of(&mut self, k: usize) -> &mut dyn RunningBlock<R> {
        self.0[k].as_deref_mut().expect("the runner has the blocks")
    }
}

impl<R> core::fmt::Debug for LaneBlocks<R> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("LaneBlocks")
    }
}

impl<R> core::fmt::Debug for LaneRunner<R> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("LaneRunner")
    }
}

impl<R: Real> LaneRunner<R> {
    /// Creates `n` runs, in the first lanes of `R`, at their start.
    ///
    /// # Panics
    ///
    /// If `R` has fewer lanes, or more than 64, or a block has events of its own.
    #[must_use]
    pub fn new(program: &Arc<Program>, n: usize) -> Self {
        let mut new = Self::without_blocks(program, n);
        new.together = LaneBlocks::new(program);
        new
    }

    /// As [`LaneRunner::new`], without blocks: [`LaneRunner::exchange_blocks`] gives it some before each step.
    ///
    /// # Panics
    ///
    /// As [`LaneRunner::new`].
    #[must_use]
    pub fn without_blocks(program: &Arc<Program>, n: usize) -> Self {
        assert!(n <= R::LANES && R::LANES <= MAX_LANES, "a lane for each run");
        let has_events = program.steps.iter().any(|step| step.template.zero_crossing_count().is_some());
        assert!(!has_events, "events are those of one run alone");
        let zeros = |n: usize| vec![R::zero(); n];
        let those = |wanted: &dyn Fn(usize) -> bool| -> Vec<usize> {
            (0..program.steps.len()).filter(|k| wanted(*k)).collect()
        };
        let steps = &program.steps;
        let blocks = steps.iter().map(|step| match step.template.computes_lanes_together() && !R::IS_SCALAR {
            true => LaneBlock::Together,
            false => LaneBlock::Each(Each::new(step)),
        });
        let blocks: Vec<LaneBlock> = blocks.collect();
        let period = |k: usize| program.periods.iter().position(|p| *p == steps[k].node.every).unwrap_or(0);
        let mut new = Self {
            initial: Runner::<f64>::new(Arc::clone(program)).state,
            n,
            signals: zeros(program.n_signals),
            continuous: zeros(program.n_states),
            memory: zeros(program.n_memory),
            new_memory: zeros(program.n_memory),
            blocks,
            together: LaneBlocks(Vec::new()),
            buffers: each::Buffers::default(),
            kept: Vec::new(),
            due: vec![0; program.periods.len()],
            period: (0..steps.len()).map(period).collect(),
            minor: those(&|k| steps[k].is_minor && k < program.n_early),
            minor_late: those(&|k| steps[k].is_minor && k >= program.n_early),
            with_states: those(&|k| !steps[k].states.is_empty()),
            with_memory: those(&|k| !steps[k].memory.is_empty() || !steps[k].states.is_empty()),
            program: Arc::clone(program),
        };
        (0..n).for_each(|lane| new.begin(lane));
        new
    }

    /// Exchanges the instances of the blocks that compute all lanes together with those of another runner of the same
    /// program.
    pub fn exchange_blocks(&mut self, others: &mut LaneBlocks<R>) {
        core::mem::swap(&mut self.together, others);
    }

    /// Number of runs.
    #[must_use]
    pub fn n_runs(&self) -> usize {
        self.n
    }

    /// Puts one lane to the start of a run, as [`Runner::new`].
    #[inline(always)]
    pub fn begin(&mut self, lane: usize) {
        let has_instances = self.blocks.iter().any(|block| matches!(block, LaneBlock::Each(_)));
        let state = if has_instances {
            let (state, instances) = Runner::<f64>::new(Arc::clone(&self.program)).into_parts();
            for (block, instance) in self.blocks.iter_mut().zip(instances) {
                if let LaneBlock::Each(each) = block {
                    each.put(lane, instance);
                }
            }
            state
        } else {
            self.initial.clone()
        };
        self.set(lane, &state);
    }

    /// State of one lane, as [`Runner::save`].
    #[must_use]
    pub fn save(&self, lane: usize) -> State<f64> {
        let of_lane = |list: &[R]| list.iter().map(|x| x.lane(lane)).collect::<Vec<f64>>();
        let memory = of_lane(&self.memory);
        let outside = self.program.steps.iter().zip(&self.blocks).enumerate().filter_map(|(k, (step, block))| {
            let LaneBlock::Each(each) = block else { return None };
            Some((k, each.instance(lane).save_outside(&memory[step.memory.clone()])?))
        });
        let outside = outside.collect();
        State { signals: of_lane(&self.signals), continuous: of_lane(&self.continuous), memory, outside }
    }

    /// Continues one lane from a `state` of [`LaneRunner::save`].
    pub fn resume(&mut self, lane: usize, state: &State<f64>) {
        for (k, (step, block)) in self.program.steps.iter().zip(&mut self.blocks).enumerate() {
            let LaneBlock::Each(each) = block else { continue };
            let saved = state.outside.iter().find(|(of, _)| *of == k).map(|(_, bytes)| bytes.as_slice());
            each.instance_mut(lane).restore_outside(saved, &state.memory[step.memory.clone()]);
        }
        self.set(lane, state);
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, state: &State<f64>) {
        put(lane, &mut self.signals, &state.signals);
        put(lane, &mut self.continuous, &state.continuous);
        put(lane, &mut self.memory, &state.memory);
    }

    /// Evaluates the outputs of all blocks that are due at the ticks of the active lanes, as [`Runner::evaluate`].
    #[inline(always)]
    pub fn evaluate(&mut self, clocks: &[Clock]) {
        self.find_due(clocks);
        for k in 0..self.program.n_early {
            let lanes = self.due[self.period[k]];
            if lanes != 0 && self.program.steps[k].rate != Rate::Constant {
                self.output(k, lanes, clocks);
            }
        }
    }

    /// Computes the discrete states of the next ticks of the active lanes, as [`Runner::update`].
    #[inline(always)]
    pub fn update(&mut self, clocks: &[Clock]) {
        if self.with_memory.is_empty() {
            return;
        }
        self.find_due(clocks);
        self.new_memory.copy_from_slice(&self.memory);
        for i in 0..self.with_memory.len() {
            let k = self.with_memory[i];
            let lanes = self.due[self.period[k]];
            if lanes == 0 || self.program.steps[k].rate == Rate::Constant {
                continue;
            }
            let step = &self.program.steps[k];
            let memory = &mut self.new_memory[step.memory.clone()];
            let states = &mut self.continuous[step.states.clone()];
            let inputs = Inputs { signals: &self.signals, states: &[], memory: &self.memory[step.memory.clone()] };
            match &mut self.blocks[k] {
                LaneBlock::Together => {
                    let n = memory.len();
                    self.kept.clear();
                    self.kept.extend_from_slice(memory);
                    self.kept.extend_from_slice(states);
                    self.together.of(k).update(&inputs.at(step), memory, states);
                    select(lanes, self.n, memory, &self.kept[..n]);
                    select(lanes, self.n, states, &self.kept[n..]);
                }
                LaneBlock::Each(each) => each.run(
                    (step, &inputs),
                    (lanes, clocks),
                    [memory, states],
                    &mut self.buffers,
                    |instance, at, [memory, states]| instance.update(at, memory, states),
                ),
            }
        }
        core::mem::swap(&mut self.memory, &mut self.new_memory);
    }

    /// Evaluates the outputs of continuous blocks between ticks in the active lanes, as [`Runner::minor`].
    #[inline(always)]
    pub fn minor(&mut self, clocks: &[Clock]) {
        let lanes = active(clocks);
        for i in 0..self.minor.len() {
            self.output(self.minor[i], lanes, clocks);
        }
    }

    /// Evaluates the outputs between ticks that depend on late measurements, as [`Runner::minor_late`].
    #[inline(always)]
    pub fn minor_late(&mut self, clocks: &[Clock]) {
        let lanes = active(clocks);
        for i in 0..self.minor_late.len() {
            self.output(self.minor_late[i], lanes, clocks);
        }
    }

    /// Computes the time derivatives of the continuous states of the active lanes, as [`Runner::derivatives`]; those of
    /// other lanes are 0.
    #[inline(always)]
    pub fn derivatives(&mut self, clocks: &[Clock], derivatives: &mut [R]) {
        derivatives.fill(R::zero());
        for i in 0..self.with_states.len() {
            let k = self.with_states[i];
            let step = &self.program.steps[k];
            let out = &mut derivatives[step.states.clone()];
            let inputs = Inputs {
                signals: &self.signals,
                states: &self.continuous[step.states.clone()],
                memory: &self.memory[step.memory.clone()],
            };
            match &mut self.blocks[k] {
                LaneBlock::Together => self.together.of(k).derivatives(&inputs.at(step), out),
                LaneBlock::Each(each) => each.run(
                    (step, &inputs),
                    (active(clocks), clocks),
                    [out, &mut []],
                    &mut self.buffers,
                    |instance, at, [out, _]| instance.derivatives(at, out),
                ),
            }
        }
        // lanes that stay
        if active(clocks) != all(self.n) {
            let lanes = active(clocks);
            derivatives.iter_mut().for_each(|x| {
                *x = R::from_lanes(|lane| if is_in(lanes, lane) { x.lane(lane) } else { 0.0 });
            });
        }
    }

    /// Computes the diagonal of −∂f/∂x `[1/s]` of the continuous states, as [`Runner::neg_jacobian_diagonal`].
    #[inline(always)]
    pub fn neg_jacobian_diagonal(&mut self, clocks: &[Clock], diagonal: &mut [R]) {
        diagonal.fill(R::zero());
        for i in 0..self.with_states.len() {
            let k = self.with_states[i];
            let step = &self.program.steps[k];
            let out = &mut diagonal[step.states.clone()];
            let inputs = Inputs {
                signals: &self.signals,
                states: &self.continuous[step.states.clone()],
                memory: &self.memory[step.memory.clone()],
            };
            match &mut self.blocks[k] {
                LaneBlock::Together => self.together.of(k).neg_jacobian_diagonal(&inputs.at(step), out),
                LaneBlock::Each(each) => each.run(
                    (step, &inputs),
                    (active(clocks), clocks),
                    [out, &mut []],
                    &mut self.buffers,
                    |instance, at, [out, _]| {
                        let at = At { t: 0.0, time_event: f64::INFINITY, ..*at };
                        instance.neg_jacobian_diagonal(&at, out);
                    },
                ),
            }
        }
    }

    /// Returns 0 in lanes in which all outputs of blocks and all continuous states are finite, else NaN.
    #[must_use]
    #[inline(always)]
    pub fn zero_if_finite(&self) -> R {
        let signals = zero_if_finite(&self.signals);
        let states = zero_if_finite(&self.continuous);
        if signals == R::zero() {
            return states;
        }
        // measurements do not count
        let of_blocks = self.program.steps.iter().map(|step| zero_if_finite(&self.signals[step.out.clone()]));
        of_blocks.fold(states, |sum, x| sum + x)
    }

    /// Periods, in base steps, of the blocks and commands that read signals of a range, each once.
    #[must_use]
    pub fn periods_of_readers(&self, range: core::ops::Range<usize>) -> Vec<u64> {
        let overlaps = |start: usize, end: usize| start < range.end && range.start < end;
        let reads = |(start, len): &(u32, u32)| overlaps(*start as usize, (*start + *len) as usize);
        let steps = self.program.steps.iter().filter(|step| step.ports.iter().any(reads));
        let mut periods: Vec<u64> = steps.map(|step| step.node.every).collect();
        let commands = &self.program.commands;
        periods.extend(commands.iter().filter(|c| overlaps(c.signal.start, c.signal.end)).map(|_| 1));
        periods.sort_unstable();
        periods.dedup();
        periods
    }

    #[inline(always)]
    fn find_due(&mut self, clocks: &[Clock]) {
        let active = active(clocks);
        let tick = clocks.iter().find(|clock| clock.is_active).map_or(0, |clock| clock.tick);
        // runs that began together: one division for all of them
        let is_common = clocks.iter().all(|clock| !clock.is_active || clock.tick == tick);
        for (due, period) in self.due.iter_mut().zip(&self.program.periods) {
            *due = match *period {
                1 => active,
                period if is_common => {
                    if tick.is_multiple_of(period) {
                        active
                    } else {
                        0
                    }
                }
                period => active & bits(clocks, |clock| clock.tick.is_multiple_of(period)),
            };
        }
    }

    #[inline(always)]
    fn output(&mut self, k: usize, lanes: u64, clocks: &[Clock]) {
        let step = &self.program.steps[k];
        let (before, out) = self.signals.split_at_mut(step.out.start);
        let out = &mut out[..step.out.len()];
        let inputs = Inputs {
            signals: before,
            states: &self.continuous[step.states.clone()],
            memory: &self.memory[step.memory.clone()],
        };
        match &mut self.blocks[k] {
            LaneBlock::Together if lanes == all(self.n) => self.together.of(k).output(&inputs.at(step), out),
            LaneBlock::Together => {
                self.kept.clear();
                self.kept.extend_from_slice(out);
                self.together.of(k).output(&inputs.at(step), out);
                select(lanes, self.n, out, &self.kept);
            }
            LaneBlock::Each(each) => each.run(
                (step, &inputs),
                (lanes, clocks),
                [out, &mut []],
                &mut self.buffers,
                |instance, at, [out, _]| instance.output(at, out),
            ),
        }
    }
}

/// Writes numbers of one lane.
#[inline(always)]
fn put<R: Real>(lane: usize, to: &mut [R], from: &[f64]) {
    for (to, x) in to.iter_mut().zip(from) {
        *to = to.with_lane(lane, *x);
    }
}

/// Sum of 0·x: 0 in lanes where all numbers are finite, else NaN.
#[inline(always)]
fn zero_if_finite<R: Real>(numbers: &[R]) -> R {
    let mut sums = [R::zero(); 4];
    for numbers in numbers.chunks(4) {
        for (sum, x) in sums.iter_mut().zip(numbers) {
            *sum += *x * R::zero();
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Bits of the lanes whose clock is `wanted`.
#[inline(always)]
fn bits(clocks: &[Clock], wanted: impl Fn(&Clock) -> bool) -> u64 {
    clocks.iter().enumerate().fold(0, |bits, (lane, clock)| bits | u64::from(wanted(clock)) << lane)
}

/// Bits of the active lanes.
#[inline(always)]
fn active(clocks: &[Clock]) -> u64 {
    bits(clocks, |clock| clock.is_active)
}

/// Bits of the first `n` lanes.
#[inline(always)]
fn all(n: usize) -> u64 {
    u64::MAX >> (MAX_LANES - n)
}

#[inline(always)]
fn is_in(lanes: u64, lane: usize) -> bool {
    lanes >> lane & 1 == 1
}
