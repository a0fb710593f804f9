//! Model exchange: the equations of a scene that does not switch, for an importer that integrates. In co-simulation
//! they follow the lock-step, for states and derivatives at the communication points.
//!
//! At a tick, which is an event in time where anything is sampled, the diagram measures, commands are latched and
//! memory is updated, as in the lock-step.

use sincro_blocks::program::Rate;
use sincro_dynamics::coupled::{CoupledSystem, NoCoupling};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::world::World;
use sincro_scene::record::{Entry, Probe, Recorder, catalogue};
use sincro_sim::Loaded;
use sincro_sim::controller::{Commands, Controller, Source};
use sincro_sim::diagram_controller::DiagramController;
use sincro_sim::run::{LockStep, method_for, world_of};

use super::derivatives::Duals;
use super::equations::{Equations, Watch};
use crate::tunable::{self, Tunable};
use crate::variables::Catalogue;

/// Times closer than this share of a base step are the same instant.
const SAME_INSTANT: f64 = 1e-9;

/// The equations of a scene at one instant.
#[derive(Debug)]
pub(super) struct Exchange {
    pub(super) world: World,
    equations: Equations<f64>,
    pub(super) control: Option<DiagramController<f64>>,
    commands: Vec<Signal>,
    /// Latched commands of the scene and of sampled blocks.
    pub(super) latched: Vec<f64>,
    recorder: Recorder,
    /// Outputs, in their order.
    pub(super) probes: Vec<Probe>,
    step: f64,
    /// The next tick whose event is due, if anything is sampled.
    next_tick: Option<u64>,
    pub(super) t: f64,
    pub(super) x: Vec<f64>,
    row: Vec<f64>,
    /// The same equations on dual numbers, once derivatives were asked for.
    pub(super) duals: Option<Box<Duals>>,
    is_evaluated: bool,
    is_observed: bool,
}

impl Exchange {
    /// At the start; `commands` are the scene's, with inputs in their places, `tuned` what was changed in the model.
    ///
    /// # Errors
    ///
    /// A block gives what is not a number, a recorded signal does not exist, or a changed number is not allowed.
    pub(super) fn new(
        loaded: &Loaded,
        catalogue_of: &Catalogue,
        commands: &[Signal],
        tuned: &[(Tunable, f64)],
    ) -> Result<Self, String> {
        let model = &loaded.scene.model;
        let (method, _) = method_for(loaded);
        let mut world = world_of(&loaded.scene, &loaded.experiment, method, false);
        for (what, value) in tuned {
            tunable::set(&mut world, what, *value)?;
        }
        let mut control = loaded.controller.as_ref().map(|c| DiagramController::<f64>::new(&c.wiring, model));
        if let Some(control) = &mut control {
            let found = control.evaluate(&mut world, 0, 0.0);
            found.map_err(|culprit| format!("block `{}` gave what is not a number", culprit.block))?;
        }
        let program = loaded.controller.as_ref().map(|c| c.wiring.program());
        let samples = program.is_some_and(|p| p.steps.iter().any(|step| matches!(step.rate, Rate::Sampled(_))));
        let changes = commands.iter().any(|signal| !matches!(signal, Signal::Constant(_)));
        let entries =
            loaded.controller.as_ref().map(sincro_scene::diagram::ControlDiagram::entries).unwrap_or_default();
        let recorder = Recorder::new(&catalogue_of.recorded, model, &entries).map_err(|found| found.to_string())?;
        let n_z = control.as_ref().map_or(0, |control| control.runner.state.continuous.len());
        let mut new = Self {
            equations: Equations::new(world.model().clone(), &world.state, n_z),
            latched: world.state.commands.clone(),
            x: states(&world, control.as_ref()),
            world,
            control,
            commands: commands.to_vec(),
            recorder,
            probes: probes(loaded, catalogue_of, &entries),
            step: loaded.experiment.step,
            next_tick: (samples || changes).then_some(0),
            t: 0.0,
            row: Vec::new(),
            duals: None,
            is_evaluated: false,
            is_observed: false,
        };
        new.latch(0.0);
        Ok(new)
    }

    /// Takes the state that a lock-step is in at a communication point, with the commands that act from there on.
    pub(super) fn follow(&mut self, lockstep: &LockStep) {
        self.world.state.clone_from(lockstep.state());
        self.world.mark_changed();
        self.control = lockstep.control().cloned();
        self.commands.clone_from_slice(lockstep.signals_of_scene());
        self.latched.copy_from_slice(&lockstep.state().commands);
        self.t = lockstep.t();
        self.x = states(&self.world, self.control.as_ref());
        if let Some(control) = &mut self.control {
            let next = control.next_time_event(self.t);
            control.set_time_event(next);
        }
        self.forget_sampled();
        self.latch(self.t);
    }

    /// Notes that samples have changed: dual numbers take them anew.
    fn forget_sampled(&mut self) {
        if let Some(duals) = &mut self.duals {
            duals.is_current = false;
        }
    }

    /// Commands of the scene and of the diagram at an instant.
    fn latch(&mut self, t: f64) {
        let mut sources = vec![Source::Scene; self.latched.len()];
        let mut commands = Commands::of_scene(&mut self.latched, &mut sources);
        for (k, signal) in self.commands.iter().enumerate() {
            commands.set(k, signal.value(t));
        }
        if let Some(control) = &self.control {
            control.latch(&mut commands.by(Source::Diagram));
        }
        self.is_evaluated = false;
        self.is_observed = false;
    }

    /// Puts a number in place of a command of the scene.
    pub(super) fn hold_command(&mut self, command: usize, value: f64) {
        self.commands[command] = Signal::Constant(value);
        self.latch(self.t);
    }

    pub(super) fn time(&self) -> f64 {
        self.t
    }

    pub(super) fn set_time(&mut self, t: f64) {
        self.t = t;
        (self.is_evaluated, self.is_observed) = (false, false);
    }

    pub(super) fn states(&self) -> &[f64] {
        &self.x
    }

    pub(super) fn set_states(&mut self, x: &[f64]) -> Result<(), String> {
        if x.len() != self.x.len() {
            return Err(format!("there are {} continuous states, not {}", self.x.len(), x.len()));
        }
        if let Some(k) = x.iter().position(|x| !x.is_finite()) {
            return Err(format!("the continuous state {k} is {}", x[k]));
        }
        self.x.copy_from_slice(x);
        (self.is_evaluated, self.is_observed) = (false, false);
        Ok(())
    }

    /// Puts the world where the states are.
    fn place(&mut self) {
        self.equations.place(&self.x, &self.latched);
        let (state, placed) = (&mut self.world.state, &self.equations.state);
        state.q.copy_from_slice(&placed.q);
        state.v.copy_from_slice(&placed.v);
        state.rotors.copy_from_slice(&placed.rotors);
        state.commands.copy_from_slice(&placed.commands);
        self.world.mark_changed();
        if let Some(control) = &mut self.control {
            control.runner.state.continuous.copy_from_slice(self.equations.diagram_states());
        }
    }

    /// Evaluates the equations, unless that was done at this instant and state.
    fn evaluate(&mut self) {
        if self.is_evaluated {
            return;
        }
        self.place();
        match self.control.as_mut().filter(|control| control.is_continuous()) {
            Some(system) => self.equations.evaluate(self.t, system),
            None => self.equations.evaluate(self.t, &mut NoCoupling),
        }
        self.is_evaluated = true;
    }

    /// Evaluates the continuous blocks that nothing but outputs needs.
    fn evaluate_signals(&mut self) {
        let control = self.control.as_mut();
        if control.is_some() && self.probes.iter().any(|probe| matches!(probe, Probe::Signal(_))) {
            self.equations.evaluate(self.t, &mut Watch { control, probes: &[], values: &mut [] });
            self.is_evaluated = false;
        }
    }

    pub(super) fn derivatives(&mut self, out: &mut [f64]) -> Result<(), String> {
        if out.len() != self.x.len() {
            return Err(format!("there are {} continuous states, not {}", self.x.len(), out.len()));
        }
        self.evaluate();
        self.equations.derivatives(&self.x, out);
        Ok(())
    }

    /// Value of an output.
    pub(super) fn output(&mut self, k: usize) -> f64 {
        if !self.is_observed {
            self.evaluate();
            self.world.state.commands.copy_from_slice(&self.equations.mechanism.commands);
            self.evaluate_signals();
            let seen = self.world.observe(self.t);
            let signals = self.control.as_ref().map_or(&[][..], DiagramController::signals);
            let row = self.recorder.row(&seen, signals, self.t, true);
            self.row.clear();
            self.row.extend_from_slice(row);
            for (output, probe) in self.probes.iter().enumerate() {
                if let Probe::MotorTorqueMean(motor) = *probe {
                    self.row[output + 1] = seen.motor_torque()[motor];
                }
            }
            self.is_observed = true;
        }
        self.row[k + 1]
    }

    /// Makes the event of the present instant, if one is due; returns the time of the next one.
    ///
    /// # Errors
    ///
    /// A block gives what is not a number.
    pub(super) fn update(&mut self) -> Result<Option<f64>, String> {
        if let Some(tick) = self.next_tick
            && (self.t - tick as f64 * self.step).abs() <= SAME_INSTANT.max(1e-6 * self.step)
        {
            let t = tick as f64 * self.step;
            if tick > 0 {
                self.place();
                if let Some(control) = &mut self.control {
                    // between ticks the world had the commands that continuous blocks give
                    self.world.state.commands.copy_from_slice(&self.equations.mechanism.commands);
                    let found = control.evaluate(&mut self.world, tick, t);
                    found.map_err(|culprit| format!("block `{}` gave what is not a number", culprit.block))?;
                }
            }
            self.latch(t);
            if let Some(control) = &mut self.control {
                control.latched(tick, t);
            }
            self.next_tick = Some(tick + 1);
        }
        let of_tick = self.next_tick.map_or(f64::INFINITY, |tick| tick as f64 * self.step);
        let of_diagram = self.control.as_ref().map_or(f64::INFINITY, |control| control.next_time_event(self.t));
        let of_model = self.world.model().next_time_event(self.t);
        let next = of_tick.min(of_diagram).min(of_model);
        if let Some(control) = &mut self.control {
            // until then, what jumps there has its value from before
            control.set_time_event(if of_diagram <= next { next } else { f64::INFINITY });
        }
        (self.is_evaluated, self.is_observed) = (false, false);
        self.forget_sampled();
        Ok(next.is_finite().then_some(next))
    }
}

/// Continuous states x of a world and its diagram.
fn states(world: &World, control: Option<&DiagramController<f64>>) -> Vec<f64> {
    let state = &world.state;
    let z = control.map_or(&[][..], |control| &control.runner.state.continuous);
    [&state.q[..], &state.v, &state.rotors, z].into_iter().flatten().copied().collect()
}

/// Outputs in their order. Mean torques of motors in co-simulation are, at one instant, the torques now.
fn probes(loaded: &Loaded, of: &Catalogue, of_diagram: &[Entry]) -> Vec<Probe> {
    let all = catalogue(&loaded.scene.model);
    let probe = |name: &str| all.iter().chain(of_diagram).find(|entry| entry.name == name).map(|entry| entry.probe);
    // float signals are of scripts, which no equations have
    of.recorded.iter().enumerate().map(|(k, name)| probe(&name.value).unwrap_or(Probe::FloatSignal(k))).collect()
}
