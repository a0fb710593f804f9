//! Model exchange: the equations of a scene that does not switch, for an importer that integrates.
//!
//! The states are q, v, the speeds of rotors with a lag, and those of continuous blocks. Quaternions are four states
//! with q̇ = ½ q ω; whatever their length, the pose is that of the unit quaternion. At a tick, which is an event in
//! time where anything is sampled, the diagram measures, commands are latched and memory is updated, as in the
//! lock-step.

use sincro_blocks::program::Rate;
use sincro_dynamics::coupled::{Coupled, CoupledSystem, NoCoupling};
use sincro_dynamics::integrate::System;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::mechanism::Mechanism;
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::{Quat, Vec3};
use sincro_dynamics::world::World;
use sincro_scene::record::{Probe, Recorder, catalogue};
use sincro_sim::Loaded;
use sincro_sim::controller::{Commands, Controller, Source};
use sincro_sim::diagram_controller::DiagramController;
use sincro_sim::run::{method_for, world_of};

use crate::variables::Catalogue;

/// Times closer than this share of a base step are the same instant.
const SAME_INSTANT: f64 = 1e-9;

/// The equations of a scene at one instant.
#[derive(Debug)]
pub(super) struct Exchange {
    world: World,
    mechanism: Mechanism<f64>,
    control: Option<DiagramController<f64>>,
    commands: Vec<Signal>,
    /// Latched commands of the scene and of sampled blocks.
    latched: Vec<f64>,
    /// Quaternions: place in q, place of their angular velocity in v.
    quaternions: Vec<(usize, usize)>,
    /// Joints that are free: place in q, place in v. Their velocities are in their own axes.
    free: Vec<(usize, usize)>,
    recorder: Recorder,
    /// Outputs that are means over a step in co-simulation, with their motors.
    torques: Vec<(usize, usize)>,
    step: f64,
    /// The next tick whose event is due, if anything is sampled.
    next_tick: Option<u64>,
    t: f64,
    x: Vec<f64>,
    y: Vec<f64>,
    slope: Vec<f64>,
    diagonal: Vec<f64>,
    row: Vec<f64>,
    is_evaluated: bool,
    is_observed: bool,
}

impl Exchange {
    /// At the start; `commands` are the scene's, with inputs in their places.
    ///
    /// # Errors
    ///
    /// A block gives what is not a number, or a recorded signal does not exist.
    pub(super) fn new(loaded: &Loaded, catalogue_of: &Catalogue, commands: &[Signal]) -> Result<Self, String> {
        let model = &loaded.scene.model;
        let (method, _) = method_for(loaded);
        let mut world = world_of(&loaded.scene, &loaded.experiment, method, false);
        let mut control = loaded.controller.as_ref().map(|c| DiagramController::<f64>::new(&c.wiring, model));
        if let Some(control) = &mut control {
            let found = control.evaluate(&mut world, 0, 0.0);
            found.map_err(|culprit| format!("block `{}` gave what is not a number", culprit.block))?;
        }
        let program = loaded.controller.as_ref().map(|c| c.wiring.program());
        let samples = program.is_some_and(|p| p.steps.iter().any(|step| matches!(step.rate, Rate::Sampled(_))));
        let changes = commands.iter().any(|signal| !matches!(signal, Signal::Constant(_)));
        let mechanism = Mechanism::new((**model).clone(), true);
        let z: Vec<f64> = control.as_ref().map_or(Vec::new(), |c| c.runner.state.continuous.clone());
        let dim = mechanism.dim() + z.len();
        let joints = &model.names().joints;
        let quaternion = |kind: JointKind, q: usize, v: usize| match kind {
            JointKind::Ball => Some((q, v)),
            JointKind::Free => Some((q + 3, v)),
            _ => None,
        };
        let quaternions = joints.iter().filter_map(|j| quaternion(j.kind, j.q_idx, j.v_idx)).collect();
        let free = joints.iter().filter(|j| matches!(j.kind, JointKind::Free)).map(|j| (j.q_idx, j.v_idx)).collect();
        let entries =
            loaded.controller.as_ref().map(sincro_scene::diagram::ControlDiagram::entries).unwrap_or_default();
        let recorder = Recorder::new(&catalogue_of.recorded, model, &entries).map_err(|found| found.to_string())?;
        let state = &world.state;
        let x = [&state.q, &state.v, &state.rotors, &z].into_iter().flatten().copied().collect();
        let latched = state.commands.clone();
        let mut new = Self {
            torques: torques(loaded, catalogue_of),
            world,
            mechanism,
            control,
            commands: commands.to_vec(),
            latched,
            quaternions,
            free,
            recorder,
            step: loaded.experiment.step,
            next_tick: (samples || changes).then_some(0),
            t: 0.0,
            x,
            y: vec![0.0; dim],
            slope: vec![0.0; dim],
            diagonal: vec![0.0; z.len()],
            row: Vec::new(),
            is_evaluated: false,
            is_observed: false,
        };
        new.latch(0.0);
        Ok(new)
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
        let state = &mut self.world.state;
        let (n_q, n_v) = (state.q.len(), state.v.len());
        let (q, rest) = self.x.split_at(n_q);
        let (v, rest) = rest.split_at(n_v);
        let (rotors, z) = rest.split_at(state.rotors.len());
        state.q.copy_from_slice(q);
        state.v.copy_from_slice(v);
        state.rotors.copy_from_slice(rotors);
        for &(at, _) in &self.quaternions {
            let unit = Quat::from_slice(&q[at..at + 4]).normalized();
            unit.write(&mut state.q[at..at + 4]);
        }
        state.commands.copy_from_slice(&self.latched);
        self.world.mark_changed();
        if let Some(control) = &mut self.control {
            control.runner.state.continuous.copy_from_slice(z);
        }
    }

    /// Evaluates the equations, unless that was done at this instant and state.
    fn evaluate(&mut self) {
        if self.is_evaluated {
            return;
        }
        self.place();
        self.mechanism.load(&self.world.state, &mut self.y);
        self.mechanism.mark_locked();
        let own = self.mechanism.dim();
        let n_z = self.diagonal.len();
        self.y[own..].copy_from_slice(&self.x[self.x.len() - n_z..]);
        let (mechanism, diagonal) = (&mut self.mechanism, &mut self.diagonal[..]);
        match self.control.as_mut().filter(|control| control.is_continuous()) {
            Some(system) => {
                Coupled { mechanism, system, negated_jacobian_diagonal: diagonal }.slope(
                    self.t,
                    &self.y,
                    &mut self.slope,
                );
            }
            None => {
                let mut none = NoCoupling;
                Coupled { mechanism, system: &mut none, negated_jacobian_diagonal: diagonal }.slope(
                    self.t,
                    &self.y,
                    &mut self.slope,
                );
            }
        }
        self.is_evaluated = true;
    }

    pub(super) fn derivatives(&mut self, out: &mut [f64]) -> Result<(), String> {
        if out.len() != self.x.len() {
            return Err(format!("there are {} continuous states, not {}", self.x.len(), out.len()));
        }
        self.evaluate();
        let (n_q, n_v) = (self.world.state.q.len(), self.world.state.v.len());
        let own = self.mechanism.dim();
        let (q, v) = (&self.x[..n_q], &self.x[n_q..n_q + n_v]);
        let rotors = self.mechanism.layout().rotor_states();
        if self.quaternions.is_empty() {
            out[..n_q].copy_from_slice(v);
        } else {
            self.rates_of_coordinates(q, v, &mut out[..n_q]);
        }
        out[n_q..n_q + n_v].copy_from_slice(&self.slope[n_v..2 * n_v]);
        let n_rotors = rotors.len();
        out[n_q + n_v..n_q + n_v + n_rotors].copy_from_slice(&self.slope[rotors]);
        out[n_q + n_v + n_rotors..].copy_from_slice(&self.slope[own..]);
        Ok(())
    }

    /// q̇ of a scene with quaternions.
    fn rates_of_coordinates(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        for joint in &self.world.model().names().joints {
            let (at, from) = (joint.q_idx, joint.v_idx);
            if !matches!(joint.kind, JointKind::Ball | JointKind::Free) {
                out[at..at + joint.n_v].copy_from_slice(&v[from..from + joint.n_v]);
            }
        }
        for &(at, from) in &self.quaternions {
            // q̇ = ½ q (0, ω), ω in the axes of the child
            let ([w, x, y, z], [p, r, s]) =
                ([q[at], q[at + 1], q[at + 2], q[at + 3]], [v[from], v[from + 1], v[from + 2]]);
            out[at] = 0.5 * (-x * p - y * r - z * s);
            out[at + 1] = 0.5 * (w * p + y * s - z * r);
            out[at + 2] = 0.5 * (w * r - x * s + z * p);
            out[at + 3] = 0.5 * (w * s + x * r - y * p);
        }
        for &(at, from) in &self.free {
            let rotation = Quat::from_slice(&q[at + 3..at + 7]).normalized().matrix();
            let velocity = rotation.mul_vec(Vec3([v[from + 3], v[from + 4], v[from + 5]]));
            out[at..at + 3].copy_from_slice(&velocity.0);
        }
    }

    /// Value of an output.
    pub(super) fn output(&mut self, k: usize) -> f64 {
        if !self.is_observed {
            self.evaluate();
            self.world.state.commands.copy_from_slice(&self.mechanism.commands);
            let seen = self.world.observe(self.t);
            let signals = self.control.as_ref().map_or(&[][..], DiagramController::signals);
            let row = self.recorder.row(&seen, signals, self.t, true);
            self.row.clear();
            self.row.extend_from_slice(row);
            for &(output, motor) in &self.torques {
                self.row[output + 1] = seen.motor_torque()[motor];
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
                    self.world.state.commands.copy_from_slice(&self.mechanism.commands);
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
        Ok(next.is_finite().then_some(next))
    }
}

/// Outputs that are mean torques of motors in co-simulation: at one instant they are the torque now.
fn torques(loaded: &Loaded, of: &Catalogue) -> Vec<(usize, usize)> {
    let entries = catalogue(&loaded.scene.model);
    let motor = |name: &str| match entries.iter().find(|entry| entry.name == name)?.probe {
        Probe::MotorTorqueMean(motor) => Some(motor),
        _ => None,
    };
    of.recorded.iter().enumerate().filter_map(|(k, name)| Some((k, motor(&name.value)?))).collect()
}
