//! Programs of a scene, compiled and compared with their algorithms.

use std::sync::Arc;

use sincro_dynamics::ids::BodyId;
use sincro_dynamics::integrate::System;
use sincro_dynamics::kinematics;
use sincro_dynamics::mechanism::Mechanism;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::state::State;
use sincro_math::Real;
use sincro_math::random::splitmix64;
use sincro_math::record::{Program, Recorded};
use sincro_math::signal::Signal;
use sincro_scene::diagram::Wiring;
use sincro_scene::record::probe::{self, View};

use super::names::{comment_text, identifiers};
use super::{ReferenceTick, Request, frames};
use crate::diagram::{ByTick, CompiledDiagram, Computed, is_due};
use crate::{Obstacle, diagram, plant};

/// Largest number of operations of an exported function; the partial derivatives of long chains have more.
const MAX_OPERATIONS: usize = 200_000;

/// Random states at which a function is compared and tested.
pub(super) const N_SAMPLES: u64 = 8;

/// Everything of a scene that could be compiled.
pub(super) struct Parts {
    /// Functions of the plant that keep no state.
    pub functions: Vec<Function>,
    /// One step of the plant.
    pub step: Option<Program>,
    pub controller: Option<CompiledDiagram>,
    /// Measurements of the plant for the controller: indices of signals, and their program of the plant's state.
    pub measure: Option<(Vec<usize>, Program)>,
    /// True if plant and controller run in lock-step as in the reference run.
    pub is_closed: bool,
    pub missing: Vec<(&'static str, Obstacle)>,
}

/// Function of the plant: its program, and what it takes and gives.
pub(super) struct Function {
    /// Kind, for the summary.
    pub kind: &'static str,
    /// Name after the prefix.
    pub name: String,
    /// Comment for users.
    pub comment: String,
    /// Arguments: name, length.
    pub inputs: Vec<(&'static str, usize)>,
    /// Results: name, length.
    pub outputs: Vec<(&'static str, usize)>,
    pub program: Program,
}

impl Parts {
    pub(super) fn compile(request: &Request<'_>) -> Self {
        let Request { model, method, h, .. } = *request;
        let mut parts = Self {
            functions: Vec::new(),
            step: None,
            controller: None,
            measure: None,
            is_closed: false,
            missing: Vec::new(),
        };
        let step = plant::step(&[model], method, h).and_then(without_calls);
        parts.step = parts.keep("step", step);
        parts.add("rates", rates(model));
        parts.add("forward dynamics", forward_dynamics(model));
        parts.add("derivatives of the forward dynamics", forward_dynamics_partials(model));
        parts.add("inverse dynamics", inverse_dynamics(model));
        let names = identifiers(model.names().frames.iter().map(|frame| frame.name.as_str()));
        for (frame, name) in frames(model).zip(names) {
            parts.add("frames", frame_function(model, frame, &name));
        }
        if let Some(of_scene) = request.diagram {
            let compiled = diagram::compile(of_scene.wiring.program()).and_then(|compiled| {
                let call = compiled.blocks.iter().find(|block| block.programs().any(Program::has_calls));
                call.map_or(Ok(()), |block| {
                    let path = &of_scene.wiring.program().steps[block.step].path;
                    Err(Obstacle::new(format!("block `{path}`: {CALLS}")))
                })?;
                Ok(compiled)
            });
            parts.controller = parts.keep("controller", compiled);
            if parts.controller.is_some() {
                let measured = measure(model, &of_scene.wiring);
                parts.measure = parts.keep("measurements", measured);
            }
        }
        if let Err(why) = parts.close(request) {
            parts.missing.push(("closed loop", why));
        }
        parts.is_closed = !parts.missing.iter().any(|(part, _)| *part == "closed loop");
        parts
    }

    /// Parts that are there, with the number of their operations.
    pub(super) fn sizes(&self) -> Vec<(&'static str, usize)> {
        let mut sizes: Vec<(&'static str, usize)> = Vec::new();
        sizes.extend(self.step.as_ref().map(|step| ("step", step.n_computed())));
        for function in &self.functions {
            match sizes.last_mut().filter(|(kind, _)| *kind == function.kind) {
                Some((_, n)) => *n += function.program.n_computed(),
                None => sizes.push((function.kind, function.program.n_computed())),
            }
        }
        let n_of = |by_tick: &ByTick| by_tick.later.n_computed();
        sizes.extend(self.controller.as_ref().map(|controller| {
            let of_blocks = controller.blocks.iter().map(|block| {
                let output = if let Computed::Program(program) = &block.output { n_of(program) } else { 0 };
                output + block.update.as_ref().map_or(0, n_of)
            });
            ("controller", of_blocks.sum())
        }));
        sizes.extend(self.measure.as_ref().map(|(_, program)| ("measurements", program.n_computed())));
        sizes
    }

    fn keep<T>(&mut self, part: &'static str, made: Result<T, Obstacle>) -> Option<T> {
        made.map_err(|why| self.missing.push((part, why))).ok()
    }

    fn add(&mut self, part: &'static str, made: Result<Function, Obstacle>) {
        if let Some(function) = self.keep(part, made) {
            self.functions.push(function);
        }
    }

    /// Runs plant and controller by their programs beside the reference run.
    fn close(&self, request: &Request<'_>) -> Result<(), Obstacle> {
        if let Some(reason) = request.not_closed {
            return Err(Obstacle::new(reason));
        }
        let missing = |part: &str| Obstacle::new(format!("the {part} is missing"));
        let step = self.step.as_ref().ok_or_else(|| missing("step"))?;
        if request.diagram.is_some() && (self.controller.is_none() || self.measure.is_none()) {
            return Err(missing("controller"));
        }
        let mut run = ClosedLoop::new(request, self)?;
        for (tick, reference) in request.reference.iter().enumerate() {
            if tick > 0 {
                run.step(step, tick as u64 - 1);
            }
            run.evaluate(tick as u64, reference);
            if let Some(what) = run.difference(reference) {
                return Err(Obstacle::new(format!(
                    "{what} differs from the run in step {tick}: the export would not be true"
                )));
            }
        }
        Ok(())
    }
}

/// Plant and controller in lock-step, by their programs.
struct ClosedLoop<'a> {
    parts: &'a Parts,
    request: &'a Request<'a>,
    state: [Vec<f64>; 3],
    commands: Vec<f64>,
    signals: Vec<f64>,
    memory: Vec<f64>,
}

impl<'a> ClosedLoop<'a> {
    fn new(request: &'a Request<'a>, parts: &'a Parts) -> Result<Self, Obstacle> {
        let of_diagram = |command: usize| {
            let program = request.diagram.map(|diagram| diagram.wiring.program());
            program.is_some_and(|program| program.commands.iter().any(|c| c.terminal == command))
        };
        let mut commands = Vec::new();
        for (k, signal) in request.commands.iter().enumerate() {
            match signal {
                Signal::Constant(value) => commands.push(*value),
                _ if of_diagram(k) => commands.push(0.0),
                _ => return Err(Obstacle::new("a command of the scene depends on time")),
            }
        }
        let initial = request.initial;
        let controller = parts.controller.as_ref();
        Ok(Self {
            parts,
            request,
            state: [initial.q.clone(), initial.v.clone(), initial.rotors.clone()],
            commands,
            signals: controller.map_or_else(Vec::new, |c| c.signals.clone()),
            memory: controller.map_or_else(Vec::new, |c| c.memory.clone()),
        })
    }

    /// Latches commands, updates the controller, steps the plant.
    fn step(&mut self, step: &Program, tick: u64) {
        if let (Some(diagram), Some(controller)) = (self.request.diagram, &self.parts.controller) {
            let program = diagram.wiring.program();
            for command in &program.commands {
                self.commands[command.terminal] = self.signals[command.signal.start];
            }
            let before = [&self.signals[..], &self.memory].concat();
            for block in controller.blocks.iter().filter(|b| is_due(program.steps[b.step].rate, tick)) {
                if let Some(update) = &block.update {
                    let new = update.at(tick).evaluate(&before, 0);
                    self.memory[program.steps[block.step].memory.clone()].copy_from_slice(&new);
                }
            }
        }
        let inputs = [&self.state.concat()[..], &self.commands].concat();
        let mut after = step.evaluate(&inputs, 0).into_iter();
        for x in self.state.iter_mut().flatten() {
            *x = after.next().expect("a number for each of the state");
        }
    }

    /// Measures, and evaluates the blocks that are due; sources are those of the reference.
    fn evaluate(&mut self, tick: u64, reference: &ReferenceTick) {
        let (Some(diagram), Some(controller)) = (self.request.diagram, &self.parts.controller) else { return };
        if let Some((at, program)) = &self.parts.measure {
            let inputs = [&self.state.concat()[..], &self.commands].concat();
            for (at, x) in at.iter().zip(program.evaluate(&inputs, 0)) {
                self.signals[*at] = x;
            }
        }
        let steps = &diagram.wiring.program().steps;
        for block in controller.blocks.iter().filter(|b| is_due(steps[b.step].rate, tick)) {
            let out = steps[block.step].out.clone();
            match &block.output {
                Computed::Source => self.signals[out.clone()].copy_from_slice(&reference.signals[out]),
                Computed::Program(program) => {
                    let inputs = [&self.signals[..], &self.memory].concat();
                    self.signals[out].copy_from_slice(&program.at(tick).evaluate(&inputs, 0));
                }
            }
        }
    }

    fn difference(&self, reference: &ReferenceTick) -> Option<&'static str> {
        let differ = |a: &[f64], b: &[f64]| a.iter().zip(b).any(|(a, b)| a.to_bits() != b.to_bits());
        let [q, v, rotors] = &self.state;
        [
            (differ(q, &reference.q), "a coordinate"),
            (differ(v, &reference.v), "a velocity"),
            (differ(rotors, &reference.rotors), "the state of an element"),
            (differ(&self.signals, &reference.signals), "a signal of the controller"),
        ]
        .into_iter()
        .find_map(|(differs, what)| differs.then_some(what))
    }
}

/// Inputs of sample `k` for a function of `n` numbers: coordinates that are quaternions are not normalised, which no
/// function asks for.
pub(super) fn sample(k: u64, n: usize) -> Vec<f64> {
    (0..n as u64).map(|i| (splitmix64(k, i) >> 11) as f64 * (4.0 / (1u64 << 53) as f64) - 2.0).collect()
}

/// Reason for which a program with calls is not exported.
const CALLS: &str = "it calls a function that is not made of arithmetic, sines and square roots";

/// Refuses a program that calls elementary functions: the exported text has none of them.
fn without_calls(program: Program) -> Result<Program, Obstacle> {
    if program.has_calls() { Err(Obstacle::new(CALLS)) } else { Ok(program) }
}

/// Refuses a program with a number that `algorithm` does not give at one of the samples. Zeros of either sign are
/// equal: a recording leaves out products with zero.
fn compared(program: Program, algorithm: impl Fn(&[f64]) -> Vec<f64>) -> Result<Program, Obstacle> {
    let program = without_calls(program)?;
    if program.n_computed() > MAX_OPERATIONS {
        let n = program.n_computed();
        return Err(Obstacle::new(format!("it has {n} operations, more than {MAX_OPERATIONS}")));
    }
    for k in 0..N_SAMPLES {
        let inputs = sample(k, program.n_inputs());
        let (ours, theirs) = (program.evaluate(&inputs, 0), algorithm(&inputs));
        if ours.iter().zip(&theirs).any(|(a, b)| a != b && !(a.is_nan() && b.is_nan())) {
            return Err(Obstacle::new("its program does not give the numbers of the algorithm"));
        }
    }
    Ok(program)
}

fn rates(model: &Model<f64>) -> Result<Function, Obstacle> {
    let [n_q, n_v, n_rotors, n_commands] = plant::state_sizes(model);
    let program = plant::rates(model)?;
    Ok(Function {
        kind: "rates",
        name: "rates".into(),
        comment: "Accelerations and rates of the elements' states under all forces of the scene: springs, dampers,\n   motors by their commands, air. Ideal velocity motors hold their speed.".into(),
        inputs: vec![("q", n_q), ("v", n_v), ("elements", n_rotors), ("commands", n_commands)],
        outputs: vec![("acceleration", n_v), ("element_rate", n_rotors)],
        program: compared(program, |x| {
            let mut mechanism = Mechanism::new(model.clone(), false);
            let [q, v, rotors, commands] = plant::parts(x, plant::state_sizes(model));
            let owned = |x: &[f64]| x.to_vec();
            let state = State {
                q: owned(q),
                v: owned(v),
                rotors: owned(rotors),
                commands: owned(commands),
                ..State::new(model)
            };
            let (mut y, mut slope) = (vec![0.0; mechanism.dim()], vec![0.0; mechanism.dim()]);
            mechanism.load(&state, &mut y);
            mechanism.mark_locked();
            mechanism.slope(0.0, &y, &mut slope);
            let layout = mechanism.layout();
            let states = layout.rotor_states();
            mechanism.model().stop_activations(&y[states.clone()], &mut slope[states]);
            [&slope[layout.velocities()], &slope[layout.rotor_states()]].concat()
        })?,
    })
}

fn forward_dynamics(model: &Model<f64>) -> Result<Function, Obstacle> {
    let (n_q, n_v) = (model.n_q(), model.n_v());
    let program = compared(plant::forward_dynamics(model)?, |x| plant::bare_forward_dynamics(model, x))?;
    Ok(Function {
        kind: "forward dynamics",
        name: "forward_dynamics".into(),
        comment: "Accelerations of the bare mechanism under gravity and joint torques (armature included; no springs,\n   dampers, motors, air).".into(),
        inputs: vec![("q", n_q), ("v", n_v), ("torque", n_v)],
        outputs: vec![("acceleration", n_v)],
        program,
    })
}

fn forward_dynamics_partials(model: &Model<f64>) -> Result<Function, Obstacle> {
    let (n_q, n_v) = (model.n_q(), model.n_v());
    let forward = plant::forward_dynamics(model)?;
    let n = forward.n_computed() * (n_q + 2 * n_v);
    if n > 8 * MAX_OPERATIONS {
        return Err(Obstacle::new(format!("it would have some {n} operations, more than {}", 8 * MAX_OPERATIONS)));
    }
    let program = forward.with_partials(0..n_q + 2 * n_v)?;
    let program = compared(program, |x| forward.evaluate(x, 0))?;
    Ok(Function {
        kind: "derivatives of the forward dynamics",
        name: "forward_dynamics_partials".into(),
        comment: format!(
            "Accelerations and their partial derivatives: {n_v} numbers for each coordinate, then for each\n   velocity, then for each torque. Of quaternions the four numbers count as independent."
        ),
        inputs: vec![("q", n_q), ("v", n_v), ("torque", n_v)],
        outputs: vec![("acceleration", n_v), ("by_q", n_v * n_q), ("by_v", n_v * n_v), ("by_torque", n_v * n_v)],
        program,
    })
}

fn inverse_dynamics(model: &Model<f64>) -> Result<Function, Obstacle> {
    let (n_q, n_v) = (model.n_q(), model.n_v());
    let program = compared(plant::inverse_dynamics(model)?, |x| plant::bare_inverse_dynamics(model, x))?;
    Ok(Function {
        kind: "inverse dynamics",
        name: "inverse_dynamics".into(),
        comment: "Joint torques that give the accelerations; the inverse of the forward dynamics.".into(),
        inputs: vec![("q", n_q), ("v", n_v), ("acceleration", n_v)],
        outputs: vec![("torque", n_v)],
        program,
    })
}

fn frame_function(model: &Model<f64>, frame: BodyId, name: &str) -> Result<Function, Obstacle> {
    let n_v = model.n_v();
    let info = &model.names().frames[frame.index()];
    let program = compared(plant::frame(model, frame)?, |q| plant::pose_and_jacobian(model, q, frame))?;
    Ok(Function {
        kind: "frames",
        name: format!("frame_{name}"),
        comment: format!(
            "Pose of {} in the world: position [m], rotation matrix row by row, and the Jacobian of its origin: six\n   rows of {n_v}, angular [rad/s] then linear velocity [m/s] in world axes.",
            comment_text(&info.name)
        ),
        inputs: vec![("q", model.n_q())],
        outputs: vec![("position", 3), ("rotation", 9), ("jacobian", 6 * n_v)],
        program,
    })
}

/// Records the measurements of a diagram.
fn measure(model: &Model<f64>, wiring: &Arc<Wiring>) -> Result<(Vec<usize>, Program), Obstacle> {
    let readings = diagram::measurements(wiring)?;
    let sizes = plant::state_sizes(model);
    let mut unknown = false;
    let program = plant::mechanism(model, sizes.iter().sum(), |model, inputs| {
        let [q, v, rotors, commands] = plant::parts(inputs, sizes);
        let mut scratch = Scratch::new(model);
        kinematics::motions(model, q, v, &vec![Recorded::zero(); sizes[1]], &mut scratch);
        let view = View { t: 0.0, model, q, v, rotors, commands, scratch: &scratch };
        let value = |probe| probe::of_state(&view, probe);
        readings
            .iter()
            .map(|(_, probe)| {
                value(*probe).unwrap_or_else(|| {
                    unknown = true;
                    Recorded::zero()
                })
            })
            .collect()
    });
    if unknown {
        return Err(Obstacle::new("a measurement is not a function of the state alone"));
    }
    Ok((readings.iter().map(|(at, _)| *at).collect(), without_calls(program?)?))
}
