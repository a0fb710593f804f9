//! Diagrams of worlds in lanes, which read what all lanes measure together; continuous ones are integrated with the
//! worlds.

use std::sync::Arc;

use core::any::Any;
use sincro_blocks::lanes::{Clock, LaneBlocks, LaneRunner};
use sincro_blocks::runner::State as DiagramState;
use sincro_dynamics::batch::{CoupledLanes, LaneObserver, LaneSystem, SteppedLanes};
use sincro_dynamics::coupled::{CoupledSystem, MechanismResponse, StateView};
use sincro_dynamics::kinematics;
use sincro_dynamics::world::MethodKind;
use sincro_math::lanes::{LaneVisitor, dispatch_lanes};
use sincro_math::{Real, Task};

use super::measured::Measured;
use super::sensors::LaneSensors;
use crate::task::plan::Plan;
use sincro_scene::diagram::{MeasuredSignals, Wiring};
use sincro_scene::record::Probe;
use sincro_scene::record::probe::{View, needs_kinematics};

/// Diagrams of the worlds of a bundle.
#[derive(Debug)]
pub(super) struct LaneDiagrams {
    /// A [`Diagrams`].
    system: LaneSystem,
    wiring: Arc<Wiring>,
    is_continuous: bool,
    /// True if steps end at time events, and the diagram has some.
    has_time_events: bool,
    clocks: Vec<Clock>,
    step: f64,
    readings: Vec<Reading>,
    /// For each measurement: true if a block that is due reads it.
    is_needed: Vec<bool>,
}

/// Use of a measurement at ticks.
#[derive(Clone, Debug)]
struct Reading {
    /// Periods of what reads it, in base steps.
    periods: Vec<u64>,
    needs_poses: bool,
}

/// Blocks of the diagrams of all bundles of one thread, which have them one after the other: what they compute with,
/// such as the model of a robot, is too much memory for each.
pub(in crate::task) struct SharedBlocks {
    /// A `LaneBlocks<R>`.
    blocks: Box<dyn Any + Send>,
}

impl core::fmt::Debug for SharedBlocks {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("SharedBlocks")
    }
}

impl SharedBlocks {
    /// None if the task has no diagram in lanes.
    pub fn new(plan: &Plan) -> Option<Self> {
        let wiring = &plan.loaded.controller.as_ref()?.wiring;
        plan.recursions_refused().is_none().then(|| Self { blocks: dispatch_lanes(NewBlocks { wiring }) })
    }
}

/// Command that a diagram gives.
#[derive(Clone, Copy, Debug)]
struct Given {
    /// Index of the command.
    command: usize,
    /// Index of the signal that gives it.
    signal: usize,
    is_continuous: bool,
    /// True if the task sets the command from the first action on.
    is_of_task: bool,
}

/// Diagrams of the worlds in lanes of `R`, integrated with them if they are continuous.
struct Diagrams<R> {
    wiring: Arc<Wiring>,
    runner: LaneRunner<R>,
    given: Vec<Given>,
    /// Clocks at the start of a step, and at the instant that the integrator looks at.
    starts: Vec<Clock>,
    now: Vec<Clock>,
    /// Accelerations for poses and twists alone.
    zeros: Vec<R>,
}

impl LaneDiagrams {
    /// None if the task has no diagram.
    pub fn new(plan: &Plan, n_worlds: usize) -> Option<Self> {
        let wiring = &plan.loaded.controller.as_ref()?.wiring;
        let program = wiring.program();
        let mut system = dispatch_lanes(New { plan, wiring, n_worlds });
        let readings = wiring.early.iter().map(|reading| {
            let range = reading.at..reading.at + reading.probes.len();
            let is_seen = |probe: &Probe| matches!(probe, Probe::Signal(k) if range.contains(k));
            let periods = if plan.probes.iter().any(is_seen) {
                vec![1]
            } else {
                dispatch_lanes(PeriodsOfReaders { system: &mut system, range: range.clone() })
            };
            Reading { periods, needs_poses: reading.probes.iter().any(|probe| needs_kinematics(*probe)) }
        });
        let readings: Vec<Reading> = readings.collect();
        let clock = Clock { tick: 0, t: 0.0, time_event: f64::INFINITY, is_active: false };
        Some(Self {
            is_needed: vec![false; readings.len()],
            readings,
            system,
            wiring: Arc::clone(wiring),
            is_continuous: program.is_continuous(),
            has_time_events: plan.method != MethodKind::SemiImplicitEuler && program.next_time_event(-1.0).is_finite(),
            clocks: vec![clock; n_worlds],
            step: plan.loaded.experiment.step,
        })
    }

    /// Takes the blocks of the thread, or gives them back.
    pub fn exchange_blocks(&mut self, shared: &mut SharedBlocks) {
        dispatch_lanes(ExchangeBlocks { system: &mut self.system, shared });
    }

    /// Returns true if the diagram is integrated with the worlds: [`LaneDiagrams::advance`].
    pub fn is_continuous(&self) -> bool {
        self.is_continuous
    }

    /// Begins an episode of one world.
    pub fn begin(&mut self, lane: usize) {
        dispatch_lanes(Begin { system: &mut self.system, lane });
    }

    /// State of the diagram of one world.
    pub fn state(&mut self, lane: usize) -> DiagramState<f64> {
        dispatch_lanes(Save { system: &mut self.system, lane })
    }

    /// Goes on from another state of one world's diagram, as it was after the evaluation of a tick.
    pub fn resume(&mut self, lane: usize, set: impl FnOnce(&mut DiagramState<f64>)) {
        let mut state = self.state(lane);
        set(&mut state);
        dispatch_lanes(Resume { system: &mut self.system, lane, state: &state });
    }

    /// Copies signal `signal` of all worlds to every `stride`-th number of `to`.
    pub fn copy_signal(&mut self, signal: usize, to: &mut [f64], stride: usize) {
        dispatch_lanes(CopySignal { system: &mut self.system, signal, to, stride });
    }

    /// Clocks of the worlds at ticks `ticks`; active are those that `is_active`.
    fn set_clocks(&mut self, ticks: &[u64], is_active: impl Fn(usize) -> bool) {
        for (lane, (clock, tick)) in self.clocks.iter_mut().zip(ticks).enumerate() {
            let t = *tick as f64 * self.step;
            *clock = Clock { tick: *tick, t, time_event: f64::INFINITY, is_active: is_active(lane) };
        }
    }

    /// Writes the commands (`lane × command`) of the worlds that are not over for the steps from ticks `ticks`, and
    /// updates the memory of their diagrams.
    pub fn latch(&mut self, ticks: &[u64], is_over: &[bool], commands: &mut [f64]) {
        self.set_clocks(ticks, |lane| !is_over[lane]);
        dispatch_lanes(Latch { system: &mut self.system, clocks: &self.clocks, commands });
    }

    /// Makes a step of the worlds together with their continuous diagrams, from ticks `ticks`. The commands
    /// (`lane × command`) that change with it are those at its end.
    pub fn advance(&mut self, lanes: &mut SteppedLanes, ticks: &[u64], is_over: &[bool], commands: &mut [f64]) {
        self.set_clocks(ticks, |lane| !is_over[lane]);
        if self.has_time_events {
            for clock in &mut self.clocks {
                let end = clock.t + self.step;
                let is_own = self.wiring.program().next_time_event(clock.t) <= end + SAME_INSTANT;
                clock.time_event = if is_own { end } else { f64::INFINITY };
            }
        }
        dispatch_lanes(SetStart { system: &mut self.system, clocks: &self.clocks });
        lanes.advance_with(self.step, &mut self.system);
        // sampled blocks still hold
        for clock in &mut self.clocks {
            clock.t = (clock.tick + 1) as f64 * self.step;
        }
        let Self { system, clocks, .. } = self;
        lanes.observe(self.wiring.needs_poses[1], EvaluateEnd { system, clocks, commands });
    }

    /// Writes the commands (`lane × command`) of the diagrams that change between ticks, at the start of an episode of
    /// the worlds of a mask: those that the task will set, too.
    pub fn write_outputs(&mut self, mask: &[bool], commands: &mut [f64]) {
        dispatch_lanes(WriteOutputs { system: &mut self.system, mask, commands });
    }

    /// Reads the measurements of all worlds, and evaluates the blocks that are due in those that `is_active`, at ticks
    /// `ticks`. A world whose numbers are not all finite is no longer good.
    pub fn evaluate(
        &mut self,
        (lanes, sensors): (&mut SteppedLanes, Option<&LaneSensors>),
        ticks: &[u64],
        is_active: impl Fn(usize) -> bool,
        is_good: &mut [bool],
    ) {
        self.set_clocks(ticks, is_active);
        let Self { system, clocks, readings, is_needed, .. } = self;
        let mut needs_poses = false;
        for (is_needed, reading) in is_needed.iter_mut().zip(readings) {
            let is_due = |clock: &Clock| reading.periods.iter().any(|period| clock.tick.is_multiple_of(*period));
            *is_needed = reading.periods.contains(&1) || clocks.iter().any(|clock| clock.is_active && is_due(clock));
            needs_poses |= *is_needed && reading.needs_poses;
        }
        lanes.observe(needs_poses, Evaluate { system, clocks, is_needed, sensors, is_good });
    }
}

/// Tolerance of instants `[s]`, as that of a world.
const SAME_INSTANT: f64 = sincro_blocks::block::SAME_INSTANT;

impl<R: Real> Diagrams<R> {
    /// Writes the measurements that are `wanted`, by their numbers, into the signals.
    #[inline(always)]
    fn read(&mut self, view: &View<'_, R>, wanted: impl Fn(usize, &MeasuredSignals) -> bool) {
        let Self { wiring, runner, .. } = self;
        let mut measured = Measured::new(view);
        for (_, reading) in wiring.early.iter().enumerate().filter(|(k, reading)| wanted(*k, reading)) {
            for (k, probe) in reading.probes.iter().enumerate() {
                if let Some(value) = measured.value(*probe) {
                    runner.signals[reading.at + k] = value;
                }
            }
        }
    }

    /// Sets the clocks to `offset` `[s]` after the start of the step.
    #[inline(always)]
    fn set_offset(&mut self, offset: f64) {
        for (now, start) in self.now.iter_mut().zip(&self.starts) {
            now.t = start.t + offset;
        }
    }

    /// Writes commands of one world after the other, of the lanes that are `wanted`.
    #[inline(always)]
    fn write(&self, wanted: impl Fn(&Given) -> bool, lanes: impl Fn(usize) -> bool, commands: &mut [f64]) {
        let n = commands.len() / self.runner.n_runs();
        for given in self.given.iter().filter(|given| wanted(given)) {
            let signal = self.runner.signals[given.signal];
            for (lane, commands) in commands.chunks_exact_mut(n).enumerate() {
                if lanes(lane) {
                    commands[given.command] = signal.lane(lane);
                }
            }
        }
    }
}

struct FindCommands<'a, 'b, R> {
    diagrams: &'a mut Diagrams<R>,
    seen: &'a mut StateView<'b, R>,
    z: &'a [R],
    commands: &'a mut [R],
}

impl<R: Real> Task for FindCommands<'_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { diagrams, seen, z, commands } = self;
        diagrams.set_offset(seen.t);
        diagrams.runner.continuous.copy_from_slice(z);
        if !diagrams.wiring.early.is_empty() {
            if diagrams.wiring.needs_poses[1] {
                kinematics::motions(seen.model, seen.q, seen.v, &diagrams.zeros, seen.scratch);
            }
            diagrams.read(&View::of(seen), |_, reading| reading.is_minor);
        }
        diagrams.runner.minor(&diagrams.now);
        for given in diagrams.given.iter().filter(|given| given.is_continuous && !given.is_of_task) {
            commands[given.command] = diagrams.runner.signals[given.signal];
        }
    }
}

struct FindSlope<'a, R> {
    diagrams: &'a mut Diagrams<R>,
    offset: f64,
    slope: &'a mut [R],
}

impl<R: Real> Task for FindSlope<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { diagrams, offset, slope } = self;
        diagrams.set_offset(offset);
        diagrams.runner.minor_late(&diagrams.now);
        diagrams.runner.derivatives(&diagrams.now, slope);
    }
}

struct FindDiagonal<'a, R> {
    diagrams: &'a mut Diagrams<R>,
    diagonal: &'a mut [R],
}

impl<R: Real> Task for FindDiagonal<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.diagrams.runner.neg_jacobian_diagonal(&self.diagrams.now, self.diagonal);
    }
}

impl<R: Real> CoupledSystem<R> for Diagrams<R> {
    fn states(&mut self) -> &mut [R] {
        &mut self.runner.continuous
    }

    fn set_time_event(&mut self, _: f64) {}

    fn next_time_event(&self, _: f64) -> f64 {
        f64::INFINITY
    }

    fn find_commands(&mut self, seen: &mut StateView<'_, R>, z: &[R], commands: &mut [R]) {
        R::run_hot(FindCommands { diagrams: self, seen, z, commands });
    }

    fn slope(&mut self, seen: &mut StateView<'_, R>, _: MechanismResponse<'_, R>, z: &[R], slope: &mut [R]) {
        if !z.is_empty() {
            R::run_hot(FindSlope { diagrams: self, offset: seen.t, slope });
        }
    }

    fn negated_jacobian_diagonal(&mut self, diagonal: &mut [R]) {
        R::run_hot(FindDiagonal { diagrams: self, diagonal });
    }
}

impl<R: Real> CoupledLanes<R> for Diagrams<R> {}

struct New<'a> {
    plan: &'a Plan,
    wiring: &'a Arc<Wiring>,
    n_worlds: usize,
}

impl LaneVisitor for New<'_> {
    type Output = LaneSystem;

    #[inline(always)]
    fn visit<R: Real>(self) -> LaneSystem {
        let Self { plan, wiring, n_worlds } = self;
        let program = wiring.program();
        let given = program.commands.iter().map(|command| Given {
            command: command.terminal,
            signal: command.signal.start,
            is_continuous: command.is_continuous,
            is_of_task: plan.own_commands().any(|own| own == command.terminal),
        });
        LaneSystem::new(Diagrams::<R> {
            wiring: Arc::clone(wiring),
            runner: LaneRunner::without_blocks(program, n_worlds),
            given: given.collect(),
            starts: Vec::new(),
            now: Vec::new(),
            zeros: vec![R::zero(); plan.loaded.scene.model.n_v()],
        })
    }
}

struct NewBlocks<'a> {
    wiring: &'a Wiring,
}

impl LaneVisitor for NewBlocks<'_> {
    type Output = Box<dyn Any + Send>;

    #[inline(always)]
    fn visit<R: Real>(self) -> Self::Output {
        Box::new(LaneBlocks::<R>::new(self.wiring.program()))
    }
}

struct ExchangeBlocks<'a> {
    system: &'a mut LaneSystem,
    shared: &'a mut SharedBlocks,
}

impl LaneVisitor for ExchangeBlocks<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let blocks = self.shared.blocks.downcast_mut().expect("the dispatch takes the same lanes each time");
        self.system.get::<R, Diagrams<R>>().runner.exchange_blocks(blocks);
    }
}

struct PeriodsOfReaders<'a> {
    system: &'a mut LaneSystem,
    range: core::ops::Range<usize>,
}

impl LaneVisitor for PeriodsOfReaders<'_> {
    type Output = Vec<u64>;

    #[inline(always)]
    fn visit<R: Real>(self) -> Vec<u64> {
        self.system.get::<R, Diagrams<R>>().runner.periods_of_readers(self.range)
    }
}

struct Begin<'a> {
    system: &'a mut LaneSystem,
    lane: usize,
}

impl LaneVisitor for Begin<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        self.system.get::<R, Diagrams<R>>().runner.begin(self.lane);
    }
}

struct Save<'a> {
    system: &'a mut LaneSystem,
    lane: usize,
}

impl LaneVisitor for Save<'_> {
    type Output = DiagramState<f64>;

    #[inline(always)]
    fn visit<R: Real>(self) -> DiagramState<f64> {
        self.system.get::<R, Diagrams<R>>().runner.save(self.lane)
    }
}

struct Resume<'a> {
    system: &'a mut LaneSystem,
    lane: usize,
    state: &'a DiagramState<f64>,
}

impl LaneVisitor for Resume<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        self.system.get::<R, Diagrams<R>>().runner.resume(self.lane, self.state);
    }
}

struct CopySignal<'a> {
    system: &'a mut LaneSystem,
    signal: usize,
    to: &'a mut [f64],
    stride: usize,
}

impl LaneVisitor for CopySignal<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let runner = &self.system.get::<R, Diagrams<R>>().runner;
        let signal = runner.signals[self.signal];
        for (lane, to) in self.to.iter_mut().step_by(self.stride).take(runner.n_runs()).enumerate() {
            *to = signal.lane(lane);
        }
    }
}

struct Latch<'a> {
    system: &'a mut LaneSystem,
    clocks: &'a [Clock],
    commands: &'a mut [f64],
}

impl LaneVisitor for Latch<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let diagrams = self.system.get::<R, Diagrams<R>>();
        diagrams.write(|given| !given.is_of_task, |lane| self.clocks[lane].is_active, self.commands);
        diagrams.runner.update(self.clocks);
    }
}

struct SetStart<'a> {
    system: &'a mut LaneSystem,
    clocks: &'a [Clock],
}

impl LaneVisitor for SetStart<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let diagrams = self.system.get::<R, Diagrams<R>>();
        for to in [&mut diagrams.starts, &mut diagrams.now] {
            to.clear();
            to.extend_from_slice(self.clocks);
        }
    }
}

/// Evaluation of continuous blocks at the end of a step.
struct EvaluateEnd<'a> {
    system: &'a mut LaneSystem,
    clocks: &'a [Clock],
    commands: &'a mut [f64],
}

impl LaneObserver for EvaluateEnd<'_> {
    type Output = ();

    #[inline(always)]
    fn observe<R: Real>(self, seen: &StateView<'_, R>) {
        let diagrams = self.system.get::<R, Diagrams<R>>();
        diagrams.read(&View::of(seen), |_, reading| reading.is_minor);
        diagrams.runner.minor(self.clocks);
        let is_wanted = |given: &Given| given.is_continuous && !given.is_of_task;
        diagrams.write(is_wanted, |lane| self.clocks[lane].is_active, self.commands);
    }
}

struct WriteOutputs<'a> {
    system: &'a mut LaneSystem,
    mask: &'a [bool],
    commands: &'a mut [f64],
}

impl LaneVisitor for WriteOutputs<'_> {
    type Output = ();

    #[inline(always)]
    fn visit<R: Real>(self) {
        let diagrams = self.system.get::<R, Diagrams<R>>();
        diagrams.write(|given| given.is_continuous, |lane| self.mask[lane], self.commands);
    }
}

struct Evaluate<'a> {
    system: &'a mut LaneSystem,
    clocks: &'a [Clock],
    is_needed: &'a [bool],
    sensors: Option<&'a LaneSensors>,
    is_good: &'a mut [bool],
}

impl LaneObserver for Evaluate<'_> {
    type Output = ();

    #[inline(always)]
    fn observe<R: Real>(self, seen: &StateView<'_, R>) {
        let Self { system, clocks, is_needed, sensors, is_good } = self;
        let diagrams = system.get::<R, Diagrams<R>>();
        diagrams.read(&View::of(seen), |k, _| is_needed[k]);
        if let Some(sensors) = sensors {
            for reading in &diagrams.wiring.early {
                for (k, probe) in reading.probes.iter().enumerate() {
                    let Probe::Sensor(value) = *probe else { continue };
                    diagrams.runner.signals[reading.at + k] =
                        R::from_lanes(|lane| if lane < clocks.len() { sensors.values(lane)[value] } else { 0.0 });
                }
            }
        }
        diagrams.runner.evaluate(clocks);
        let zero = diagrams.runner.zero_if_finite();
        for (lane, is_good) in is_good.iter_mut().enumerate() {
            *is_good &= !clocks[lane].is_active || zero.lane(lane) == 0.0;
        }
    }
}
