//! A diagram and a world in one step.
//!
//! At a tick ([`DiagramController::evaluate`]): measurements are read, every block that is due is evaluated, what
//! depends on accelerations last. The commands are latched from that instant on ([`Controller::latch`]), and memory is
//! updated ([`Controller::latched`]). Between ticks the diagram is an [`CoupledSystem`] of the world: continuous blocks
//! see the state the integrator looks at, sampled ones hold.

use std::sync::Arc;

use sincro_blocks::instance::Number;
use sincro_blocks::runner::{Runner, State};
use sincro_dynamics::coupled::{CoupledSystem, MechanismResponse, StateView};
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model;
use sincro_dynamics::state::State as WorldState;
use sincro_dynamics::world::World;
use sincro_math::Real;

use crate::controller::{Commands, Controller, Forked, Instant, NotFinite, Source};
use crate::restructure::Restructured;
use sincro_scene::diagram::{Wiring, is_known_at_ticks_only};
use sincro_scene::record::probe::{self, View};
use sincro_scene::record::{Probe, ProbeMap};

/// Block diagram that controls a world, with its state, in any number type: plain numbers in a run, dual numbers for
/// linearisation.
#[derive(Clone, Debug)]
pub struct DiagramController<R: Number> {
    wiring: Arc<Wiring>,
    /// Diagram with its signals, continuous states and memory.
    pub runner: Runner<R>,
    tick: u64,
    time_event: f64,
    zero: Vec<R>,
    late_torque: Vec<R>,
    late_accelerations: Vec<R>,
    impulse: Vec<f64>,
    /// Last samples of the sensors.
    sensed: Vec<f64>,
    held: Vec<f64>,
    /// True for each command that a stronger source has set in this step: continuous blocks do not write it.
    is_overridden: Vec<bool>,
    /// Index of each command that the diagram gives.
    terminals: Vec<usize>,
}

impl<R: Number> DiagramController<R> {
    /// Creates the controller of a compiled diagram at the start of a run of `model`, the model that the diagram was
    /// compiled for.
    #[must_use]
    pub fn new(wiring: &Arc<Wiring>, model: &Model<f64>) -> Self {
        let zeros = |n: usize| vec![R::zero(); n];
        Self {
            runner: Runner::new(wiring.program().clone()),
            wiring: wiring.clone(),
            tick: 0,
            time_event: f64::INFINITY,
            zero: zeros(model.n_v()),
            late_torque: zeros(model.motors().len()),
            late_accelerations: zeros(model.n_v()),
            impulse: vec![0.0; model.motors().len()],
            sensed: vec![0.0; model.names().sensors.iter().map(|s| s.values.len()).sum()],
            held: vec![0.0; model.n_commands()],
            is_overridden: vec![false; model.n_commands()],
            terminals: wiring.program().commands.iter().map(|command| command.terminal).collect(),
        }
    }

    /// Returns the connection of the diagram to the measurements and commands of the world.
    #[must_use]
    pub fn wiring(&self) -> &Arc<Wiring> {
        &self.wiring
    }

    /// Returns true if the diagram acts between ticks, so that it must be integrated with the world.
    #[must_use]
    pub fn is_continuous(&self) -> bool {
        self.wiring.program().is_continuous()
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

    fn read_response(&mut self, seen: &mut StateView<'_, R>, response: MechanismResponse<'_, R>, is_minor: bool) {
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

    /// Notes the sources of the commands of a step: continuous blocks leave those of controllers alone.
    pub(crate) fn note_sources(&mut self, sources: &[Source]) {
        for (is_overridden, source) in self.is_overridden.iter_mut().zip(sources) {
            *is_overridden = matches!(source, Source::Controller(_));
        }
    }

    fn write_commands(&self, commands: &mut [R], continuous_only: bool) {
        for (command, terminal) in self.wiring.program().commands.iter().zip(&self.terminals) {
            if (command.is_continuous || !continuous_only) && !self.is_overridden[*terminal] {
                commands[*terminal] = self.runner.signals()[command.signal.start];
            }
        }
    }
}

/// Ticks on any kind of number, for derivatives along a run.
impl<R: Number> DiagramController<R> {
    /// Reads the measurements of the world in the state `seen` and evaluates every block that is due at tick `tick`, as
    /// [`DiagramController::evaluate`] does on plain numbers, for a diagram that measures neither accelerations nor
    /// what is known at ticks alone ([`is_known_at_ticks_only`]).
    pub fn evaluate_at(&mut self, seen: &mut StateView<'_, R>, tick: u64) {
        self.tick = tick;
        self.read_state(seen, false);
        self.runner.evaluate(tick, seen.t);
    }

    /// Writes all commands of the diagram into `commands`, in the order and units of the command vector, as they are
    /// latched at a tick; then updates the memory of blocks, at time `t` `[s]`.
    pub fn latch_into(&mut self, commands: &mut [R], t: f64) {
        self.write_commands(commands, false);
        self.runner.update(self.tick, t);
    }

    /// Computes the continuous blocks at the end of a step, in the state `seen`, and writes their commands into
    /// `commands`; sampled blocks still hold.
    pub fn evaluate_end(&mut self, seen: &mut StateView<'_, R>, commands: &mut [R]) {
        if self.is_continuous() {
            self.read_state(seen, true);
            self.runner.minor(self.tick, seen.t, self.time_event);
            self.write_commands(commands, true);
        }
    }
}

/// Access for linearisation: everything continuous is evaluated, whether or not the integrator needs it.
impl<R: Number> DiagramController<R> {
    /// Creates the same diagram in the same state in another number type, without derivatives; `model` is that of the
    /// diagram.
    pub fn cast_from(other: &DiagramController<f64>, model: &Model<f64>) -> Self {
        let mut new = Self::new(&other.wiring, model);
        let cast = |list: &[f64]| list.iter().map(|x| R::splat(*x)).collect::<Vec<_>>();
        let state = &other.runner.state;
        let state = State {
            signals: cast(&state.signals),
            continuous: cast(&state.continuous),
            memory: cast(&state.memory),
            outside: other.runner.save_outside(),
        };
        new.runner.resume(state, other.tick);
        new.tick = other.tick;
        new
    }

    /// Computes all commands of the continuous diagram into `commands`, in the order and units of the command vector,
    /// as [`CoupledSystem::find_commands`] does in a run: `seen` is the state of the world, `z` holds the diagram's
    /// continuous states. `perturbed` is the index of a signal and a number that is added to it, for derivatives.
    ///
    /// # Panics
    ///
    /// If `z` has another length than the diagram has continuous states.
    pub fn find_all_commands(
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

    /// Computes the derivatives of all continuous states of the diagram into `slope`, in their order
    /// `[unit of the state / s]`, as [`CoupledSystem::slope`] does in a run: `seen` is the state of the world,
    /// `response` its accelerations and motor torques. `perturbed` as in [`DiagramController::find_all_commands`],
    /// which must be called before.
    pub fn all_derivatives(
        &mut self,
        seen: &mut StateView<'_, R>,
        response: MechanismResponse<'_, R>,
        slope: &mut [R],
        perturbed: Option<(usize, R)>,
    ) {
        if !self.wiring.late.is_empty() {
            self.read_response(seen, response, false);
            self.runner.evaluate_continuous(self.tick, seen.t, true, perturbed);
        }
        self.runner.derivatives(self.tick, seen.t, f64::INFINITY, slope);
    }
}

impl DiagramController<f64> {
    /// Reads the measurements of the world and evaluates every block that is due at tick `tick`, time `t` `[s]`.
    ///
    /// # Errors
    ///
    /// [`NotFinite`] with the first block, in the order of evaluation, whose output is not finite.
    pub fn evaluate(&mut self, world: &mut World, tick: u64, t: f64) -> Result<(), NotFinite> {
        self.tick = tick;
        if self.feels_contact() {
            // forces of contact under the commands that led here
            world.rates(t);
        }
        self.read_tick_sums(world, tick);
        world.with_state_view(t, |mut seen| self.read_state(&mut seen, false));
        self.runner.evaluate(tick, t);
        if !self.wiring.late.is_empty() {
            self.evaluate_late(world, tick, t);
        }
        self.not_finite().map_or(Ok(()), Err)
    }

    /// Replaces the last samples of all sensors, in their order and units, as the next evaluation reads them.
    ///
    /// # Panics
    ///
    /// If there are not as many as the model's sensors have values.
    pub fn set_samples(&mut self, samples: &[f64]) {
        self.sensed.copy_from_slice(samples);
    }

    /// Returns the first block, in the order of evaluation, whose output was not finite when it was last evaluated;
    /// `None` if all are.
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

    /// Evaluates the outputs that depend on the accelerations under the new commands.
    fn evaluate_late(&mut self, world: &mut World, tick: u64, t: f64) {
        self.held.copy_from_slice(&world.state.commands);
        let mut commands = core::mem::take(&mut world.state.commands);
        self.write_commands(&mut commands, false);
        world.state.commands = commands;
        let (accelerations, torques) = world.rates(t);
        self.late_accelerations.copy_from_slice(accelerations);
        self.late_torque.copy_from_slice(torques);
        let (accelerations, torques) =
            (core::mem::take(&mut self.late_accelerations), core::mem::take(&mut self.late_torque));
        let response = MechanismResponse { accelerations: &accelerations, motor_torque: &torques };
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
        let step = self.wiring.program().step;
        for reading in &self.wiring.early {
            for (k, probe) in reading.probes.iter().enumerate().filter(|(_, p)| is_known_at_ticks_only(**p)) {
                use sincro_scene::record::EnergyQuantity as E;
                let x = match *probe {
                    Probe::Sensor(i) => self.sensed[i],
                    Probe::MotorTorqueMean(_) if tick == 0 => 0.0,
                    Probe::MotorTorqueMean(m) => (totals[2 + m] - self.impulse[m]) / step,
                    Probe::Contact(quantity, frame, k) => {
                        sincro_scene::record::contact::read(world.model(), world.contacts(), quantity, frame, k)
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

    /// Returns the diagram's signals as they were last evaluated at a tick: all components one after the other, in the
    /// order of the program and in their units.
    /// [`ControlDiagram::entries`](sincro_scene::diagram::ControlDiagram::entries) has their names.
    #[must_use]
    pub fn signals(&self) -> &[f64] {
        self.runner.signals()
    }
}

impl DiagramController<f64> {
    /// Connects measurements and commands to the same objects of a model whose structure has changed.
    fn rewire(&mut self, change: &Restructured) -> Result<(), String> {
        let model = &change.scene.model;
        let map = ProbeMap::new(&change.former, model, &|path| change.renamed.path(path));
        let gone = |name: &str| format!("the diagram measures `{name}`, which has gone");
        let mut wiring = (*self.wiring).clone();
        for reading in wiring.early.iter_mut().chain(&mut wiring.late) {
            for probe in &mut reading.probes {
                *probe = map.probe(*probe).map_err(|name| gone(&name))?;
            }
        }
        let former = &change.transferred.commands;
        let terminals: Option<Vec<usize>> =
            self.terminals.iter().map(|terminal| former.iter().position(|old| *old == Some(*terminal))).collect();
        self.terminals = terminals.ok_or("the diagram commands a motor, rotor or force that has gone")?;
        self.wiring = Arc::new(wiring);
        let fresh = Self::new(&self.wiring, model);
        self.impulse = change.transferred.state.totals[2..].to_vec();
        (self.zero, self.late_torque, self.late_accelerations) =
            (fresh.zero, fresh.late_torque, fresh.late_accelerations);
        (self.sensed, self.held, self.is_overridden) = (fresh.sensed, fresh.held, fresh.is_overridden);
        Ok(())
    }
}

impl Controller for DiagramController<f64> {
    fn name(&self) -> &str {
        "diagram"
    }

    fn latch(&self, commands: &mut Commands<'_>) {
        for (command, terminal) in self.wiring.program().commands.iter().zip(&self.terminals) {
            commands.set(*terminal, self.runner.signals()[command.signal.start]);
        }
    }

    fn latched(&mut self, tick: u64, t: f64) {
        self.runner.update(tick, t);
    }

    fn continuous(&mut self) -> Option<&mut dyn CoupledSystem<f64>> {
        if self.is_continuous() { Some(self) } else { None }
    }

    /// Sampled blocks still hold: what the world is seen with before the next tick acts.
    fn evaluate_outputs(&mut self, at: Instant<'_>) {
        if !self.is_continuous() {
            return;
        }
        at.world.with_state_view(at.t, |mut seen| self.read_state(&mut seen, true));
        self.runner.minor(self.tick, at.t, self.time_event);
        self.write_commands(&mut at.world.state.commands, true);
    }

    fn measure(&mut self, at: Instant<'_>, sensors: &[f64]) -> Result<(), NotFinite> {
        self.set_samples(sensors);
        self.evaluate(at.world, at.tick, at.t)
    }

    fn write_outputs(&self, commands: &mut [f64]) {
        if self.is_continuous() {
            self.write_commands(commands, true);
        }
    }

    fn save(&self) -> Option<State<f64>> {
        Some(self.runner.save())
    }

    fn restore(&mut self, saved: &State<f64>, world: &WorldState<f64>) {
        self.runner.resume(saved.clone(), world.tick);
        self.tick = world.tick;
        self.impulse.copy_from_slice(&world.totals[2..]);
    }

    fn restructured(&mut self, change: &Restructured) -> Result<(), String> {
        self.rewire(change)
    }

    fn fork(&self) -> Forked {
        Forked::Whole(Box::new(self.clone()))
    }
}

impl<R: Number + Real> CoupledSystem<R> for DiagramController<R> {
    fn states(&mut self) -> &mut [R] {
        &mut self.runner.state.continuous
    }

    fn set_time_event(&mut self, time_event: f64) {
        self.time_event = time_event;
    }

    fn next_time_event(&self, t: f64) -> f64 {
        self.wiring.program().next_time_event(t).min(self.runner.scheduled_event())
    }

    fn zero_crossing_count(&self) -> Option<usize> {
        self.runner.zero_crossing_count()
    }

    fn zero_crossings(&mut self, t: f64, values: &mut [R]) {
        self.runner.zero_crossings(self.tick, t, values);
    }

    fn handle_events(&mut self, t: f64, z: &mut [R]) -> bool {
        self.runner.state.continuous.copy_from_slice(z);
        let happened = self.runner.handle_events(self.tick, t);
        z.copy_from_slice(&self.runner.state.continuous);
        happened
    }

    fn find_commands(&mut self, seen: &mut StateView<'_, R>, z: &[R], commands: &mut [R]) {
        self.runner.state.continuous.copy_from_slice(z);
        self.read_state(seen, true);
        self.runner.minor(self.tick, seen.t, self.time_event);
        self.write_commands(commands, true);
    }

    fn slope(&mut self, seen: &mut StateView<'_, R>, response: MechanismResponse<'_, R>, z: &[R], slope: &mut [R]) {
        if z.is_empty() {
            return;
        }
        if self.wiring.late.iter().any(|r| r.is_minor) {
            self.read_response(seen, response, true);
        }
        // also what depends on a held sample of a late measurement and on something that moves
        self.runner.minor_late(self.tick, seen.t, self.time_event);
        self.runner.derivatives(self.tick, seen.t, self.time_event, slope);
    }

    fn negated_jacobian_diagonal(&mut self, decay: &mut [R]) {
        self.runner.neg_jacobian_diagonal(self.tick, 0.0, decay);
    }
}
