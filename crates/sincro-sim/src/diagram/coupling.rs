//! A diagram and a world in one step.
//!
//! At a tick ([`Control::look`]): measurements are read, every block that is due is evaluated, what depends on accelerations last. The commands
//! are latched from that instant on ([`Control::latch`]), and memory is updated ([`Control::update`]). Between ticks the diagram is an
//! [`CoupledSystem`] of the world: continuous blocks see the state the integrator looks at, sampled ones hold.

use std::sync::Arc;

use sincro_blocks::instance::Number;
use sincro_blocks::program::{Measured, Program};
use sincro_blocks::runner::{Runner, State};
use sincro_dynamics::coupled::{CoupledSystem, Response, StateView};
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model;
use sincro_dynamics::state::State as WorldState;
use sincro_dynamics::world::World;
use sincro_math::Real;

use super::ports::{Measurement, is_known_at_ticks_only};
use crate::record::Probe;
use crate::record::probe::{self, View};

/// A measurement in use: where its components are read and where they go.
#[derive(Clone, Debug)]
struct Reading {
    probes: Vec<Probe>,
    at: usize,
    is_minor: bool,
}

/// What a compiled diagram is connected to.
#[derive(Clone, Debug)]
pub struct Wiring {
    program: Arc<Program>,
    early: Vec<Reading>,
    late: Vec<Reading>,
    /// Whether any measurement needs poses and twists: at ticks, and between them.
    needs_poses: [bool; 2],
}

impl Wiring {
    pub(super) fn new(program: Arc<Program>, measurements: &[Measurement]) -> Self {
        let reading = |m: &Measured| Reading {
            probes: measurements[m.terminal].probes.clone(),
            at: m.out.start,
            is_minor: m.is_minor,
        };
        let early: Vec<Reading> = program.early.iter().map(reading).collect();
        let late = program.late.iter().map(reading).collect();
        let needs = |r: &Reading| r.probes.iter().any(|p| probe::needs_kinematics(*p));
        let needs_poses = [early.iter().any(needs), early.iter().any(|r| r.is_minor && needs(r))];
        Self { early, late, needs_poses, program }
    }

    /// Which measurement of the world a signal is, if it is one.
    pub(super) fn measured(&self, signal: usize) -> Option<Probe> {
        let all = self.early.iter().chain(&self.late);
        let reading = all.into_iter().find(|r| (r.at..r.at + r.probes.len()).contains(&signal))?;
        Some(reading.probes[signal - reading.at])
    }

    /// The compiled diagram.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }
}

/// A diagram that controls a world.
#[derive(Clone, Debug)]
pub struct Control<R: Number> {
    wiring: Arc<Wiring>,
    /// The diagram with its state.
    pub runner: Runner<R>,
    tick: u64,
    corner: f64,
    zero: Vec<R>,
    late_torque: Vec<R>,
    late_accelerations: Vec<R>,
    impulse: Vec<f64>,
    /// What sensors gave last.
    sensed: Vec<f64>,
    held: Vec<f64>,
}

/// A block whose output is not a finite number.
#[derive(Clone, Debug, PartialEq)]
pub struct NotFinite {
    /// Its path.
    pub block: String,
    /// Its kind.
    pub kind: &'static str,
    /// Its outputs.
    pub outputs: Vec<f64>,
    /// Its inputs.
    pub inputs: Vec<f64>,
    /// What the block itself says of it.
    pub fault: Option<Box<str>>,
}

impl<R: Number> Control<R> {
    /// At the start of a run of `model`.
    #[must_use]
    pub fn new(wiring: &Arc<Wiring>, model: &Model<f64>) -> Self {
        let zeros = |n: usize| vec![R::zero(); n];
        Self {
            runner: Runner::new(wiring.program.clone()),
            wiring: wiring.clone(),
            tick: 0,
            corner: f64::INFINITY,
            zero: zeros(model.n_v()),
            late_torque: zeros(model.motors().len()),
            late_accelerations: zeros(model.n_v()),
            impulse: vec![0.0; model.motors().len()],
            sensed: vec![0.0; model.names().sensors.iter().map(|s| s.values.len()).sum()],
            held: vec![0.0; model.n_commands()],
        }
    }

    /// What it is connected to.
    #[must_use]
    pub fn wiring(&self) -> &Arc<Wiring> {
        &self.wiring
    }

    /// Whether anything happens between ticks, so that the world must take it along.
    #[must_use]
    pub fn is_continuous(&self) -> bool {
        self.wiring.program.is_continuous()
    }

    fn read_state(&mut self, seen: &mut StateView<'_, R>, is_minor: bool) {
        if self.wiring.early.is_empty() {
            return;
        }
        if self.wiring.needs_poses[usize::from(is_minor)] {
            kinematics::motions(seen.model, seen.q, seen.v, &self.zero, seen.scratch);
        }
        let view = View::of(seen);
        for reading in self.wiring.early.iter().filter(|r| r.is_minor || !is_minor) {
            for (k, probe) in reading.probes.iter().enumerate() {
                if let Some(x) = probe::of_state(&view, *probe) {
                    self.runner.signals_mut()[reading.at + k] = x;
                }
            }
        }
    }

    fn read_response(&mut self, seen: &mut StateView<'_, R>, response: Response<'_, R>, is_minor: bool) {
        kinematics::motions(seen.model, seen.q, seen.v, response.accelerations, seen.scratch);
        let view = View::of(seen);
        for reading in self.wiring.late.iter().filter(|r| r.is_minor || !is_minor) {
            for (k, probe) in reading.probes.iter().enumerate() {
                if let Some(x) = probe::of_response(&view, response, *probe) {
                    self.runner.signals_mut()[reading.at + k] = x;
                }
            }
        }
    }

    fn write_commands(&self, commands: &mut [R], continuous_only: bool) {
        for command in &self.wiring.program.commands {
            if command.is_continuous || !continuous_only {
                commands[command.terminal] = self.runner.signals()[command.signal.start];
            }
        }
    }
}

/// What linearisation needs: everything continuous is evaluated, whether or not the integrator needs it.
impl<R: Number> Control<R> {
    /// The same diagram in the same state on other numbers, without derivatives.
    pub(crate) fn like(other: &Control<f64>, model: &Model<f64>) -> Self {
        let mut new = Self::new(&other.wiring, model);
        let cast = |list: &[f64]| list.iter().map(|x| R::splat(*x)).collect::<Vec<_>>();
        let state = &other.runner.state;
        let state =
            State { signals: cast(&state.signals), continuous: cast(&state.continuous), memory: cast(&state.memory) };
        new.runner.resume(state, other.tick);
        new.tick = other.tick;
        new
    }

    /// As [`CoupledSystem::find_commands`]; `perturbed` is a signal and its change.
    pub(crate) fn drive_whole(
        &mut self,
        seen: &mut StateView<'_, R>,
        z: &[R],
        commands: &mut [R],
        perturbed: Option<(usize, R)>,
    ) {
        self.runner.state.continuous.copy_from_slice(z);
        self.read_state(seen, false);
        self.runner.evaluate_continuous(self.tick, seen.t, false, perturbed);
        self.write_commands(commands, true);
    }

    /// As [`CoupledSystem::slope`].
    pub(crate) fn slope_whole(
        &mut self,
        seen: &mut StateView<'_, R>,
        response: Response<'_, R>,
        slope: &mut [R],
        perturbed: Option<(usize, R)>,
    ) {
        if !self.wiring.late.is_empty() {
            self.read_response(seen, response, false);
            self.runner.evaluate_continuous(self.tick, seen.t, true, perturbed);
        }
        self.runner.slopes(self.tick, seen.t, f64::INFINITY, slope);
    }
}

impl Control<f64> {
    /// Measures and evaluates everything that is due at a tick.
    ///
    /// # Errors
    ///
    /// The first block, in the order of evaluation, whose output is not finite.
    pub fn look(&mut self, world: &mut World, tick: u64, t: f64) -> Result<(), NotFinite> {
        self.tick = tick;
        if self.feels_contact() {
            // forces of contact under the commands that led here
            world.rates(t);
        }
        self.read_tick_sums(world, tick);
        world.with_state_view(t, |mut seen| self.read_state(&mut seen, false));
        self.runner.evaluate(tick, t);
        if !self.wiring.late.is_empty() {
            self.look_late(world, tick, t);
        }
        self.not_finite().map_or(Ok(()), Err)
    }

    /// The first block, in the order of evaluation, whose output is not finite as it was last evaluated.
    #[must_use]
    pub fn not_finite(&self) -> Option<NotFinite> {
        let (step, _) = self.runner.not_finite()?;
        let signals = self.runner.signals();
        let inputs = step.ports.iter().flat_map(|&(at, len)| &signals[at as usize..(at + len) as usize]);
        Some(NotFinite {
            block: step.path.clone(),
            kind: step.template.kind().name,
            outputs: signals[step.out.clone()].to_vec(),
            inputs: inputs.copied().collect(),
            fault: step.template.fault().map(String::into_boxed_str),
        })
    }

    /// What depends on the accelerations that the new commands cause.
    fn look_late(&mut self, world: &mut World, tick: u64, t: f64) {
        self.held.copy_from_slice(&world.state.commands);
        let mut commands = core::mem::take(&mut world.state.commands);
        self.write_commands(&mut commands, false);
        world.state.commands = commands;
        let (accelerations, torques) = world.rates(t);
        self.late_accelerations.copy_from_slice(accelerations);
        self.late_torque.copy_from_slice(torques);
        let (accelerations, torques) =
            (core::mem::take(&mut self.late_accelerations), core::mem::take(&mut self.late_torque));
        let response = Response { accelerations: &accelerations, motor_torque: &torques };
        world.with_state_view(t, |mut seen| self.read_response(&mut seen, response, false));
        (self.late_accelerations, self.late_torque) = (accelerations, torques);
        world.state.commands.copy_from_slice(&self.held);
        self.runner.evaluate_late(tick, t);
    }

    fn feels_contact(&self) -> bool {
        self.wiring.early.iter().any(|r| r.probes.iter().any(|p| matches!(p, Probe::Contact(..) | Probe::Reaction(_))))
    }

    /// Means and sums over the step that ended, and forces of contact at its end.
    fn read_tick_sums(&mut self, world: &World, tick: u64) {
        let totals = &world.state.totals;
        let step = self.wiring.program.step;
        for reading in &self.wiring.early {
            for (k, probe) in reading.probes.iter().enumerate().filter(|(_, p)| is_known_at_ticks_only(**p)) {
                use crate::record::EnergyQuantity as E;
                let x = match *probe {
                    Probe::Sensor(i) => self.sensed[i],
                    Probe::MotorTorqueMean(_) if tick == 0 => 0.0,
                    Probe::MotorTorqueMean(m) => (totals[2 + m] - self.impulse[m]) / step,
                    Probe::Contact(quantity, frame, k) => {
                        crate::record::contact::read(world.model(), world.contacts(), quantity, frame, k)
                    }
                    Probe::Reaction(k) => world.reaction(k),
                    Probe::Energy(E::Work) => totals[0],
                    Probe::Energy(E::Dissipated) => totals[1],
                    _ => 0.0,
                };
                self.runner.signals_mut()[reading.at + k] = x;
            }
        }
        self.impulse.copy_from_slice(&totals[2..]);
    }

    /// Brings the continuous commands to the end of a step, sampled blocks still holding: what the world is seen with before the next
    /// tick acts.
    pub fn arrive(&mut self, world: &mut World, t: f64) {
        world.with_state_view(t, |mut seen| self.read_state(&mut seen, true));
        self.runner.minor(self.tick, t, self.corner);
        self.write_commands(&mut world.state.commands, true);
    }

    /// What sensors gave last, to be measured at the next tick.
    pub fn sense(&mut self, values: &[f64]) {
        self.sensed.copy_from_slice(values);
    }

    /// The continuous commands as they were last evaluated; sampled ones are not seen before they act.
    pub fn show(&self, commands: &mut [f64]) {
        self.write_commands(commands, true);
    }

    /// Latches the commands of the diagram, from this tick on.
    pub fn latch(&self, commands: &mut [f64]) {
        self.write_commands(commands, false);
    }

    /// Memory for the next tick.
    pub fn update(&mut self, tick: u64, t: f64) {
        self.runner.update(tick, t);
    }

    /// The signals of the diagram as they were last evaluated at a tick.
    #[must_use]
    pub fn signals(&self) -> &[f64] {
        self.runner.signals()
    }

    /// Goes back to a state of the diagram that belongs to a state of the world.
    pub(crate) fn resume(&mut self, state: State<f64>, world: &WorldState<f64>) {
        self.runner.resume(state, world.tick);
        self.tick = world.tick;
        self.impulse.copy_from_slice(&world.totals[2..]);
    }
}

impl<R: Number + Real> CoupledSystem<R> for Control<R> {
    fn states(&mut self) -> &mut [R] {
        &mut self.runner.state.continuous
    }

    fn set_time_event(&mut self, corner: f64) {
        self.corner = corner;
    }

    fn next_time_event(&self, t: f64) -> f64 {
        self.wiring.program.next_corner(t)
    }

    fn find_commands(&mut self, seen: &mut StateView<'_, R>, z: &[R], commands: &mut [R]) {
        self.runner.state.continuous.copy_from_slice(z);
        self.read_state(seen, true);
        self.runner.minor(self.tick, seen.t, self.corner);
        self.write_commands(commands, true);
    }

    fn slope(&mut self, seen: &mut StateView<'_, R>, response: Response<'_, R>, z: &[R], slope: &mut [R]) {
        if z.is_empty() {
            return;
        }
        if self.wiring.late.iter().any(|r| r.is_minor) {
            self.read_response(seen, response, true);
        }
        // also what depends on a held sample of a late measurement and on something that moves
        self.runner.minor_late(self.tick, seen.t, self.corner);
        self.runner.slopes(self.tick, seen.t, self.corner, slope);
    }

    fn negated_jacobian_diagonal(&mut self, decay: &mut [R]) {
        self.runner.decays(self.tick, 0.0, decay);
    }
}
