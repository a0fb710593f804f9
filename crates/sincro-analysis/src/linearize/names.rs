//! Meaning of inputs and outputs.

use super::{axis, point::Request};
use crate::linear::Axis;
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located};
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::record::{EnergyQuantity, Entry, Probe, catalogue};
use sincro_scene::suggest;
use sincro_sim::load::Loaded;
use sincro_sim::run::LockStep;

/// An input of the linear system.
#[derive(Clone, Debug)]
pub(super) struct Input {
    pub axis: Axis,
    pub what: InputKind,
}

/// Point at which an input acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InputKind {
    /// Command of a motor.
    Command(usize),
    /// Added to a signal of the diagram.
    Signal(usize),
}

/// An output of the linear system.
#[derive(Clone, Debug)]
pub(super) struct Output {
    pub axis: Axis,
    pub probe: Probe,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    pub inputs: Vec<Input>,
    pub outputs: Vec<Output>,
    pub is_closed: bool,
    /// Motors that are no inputs hold their velocity, position motors too.
    pub holds_motors: bool,
    pub notes: Vec<String>,
}

/// Resolves what is asked for, or chooses: all commands, all coordinates.
pub(super) fn resolve(loaded: &Loaded, at: &LockStep, request: &Request) -> Result<Names, Diagnostics> {
    let of_diagram = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
    let all: Vec<Entry> = catalogue(&loaded.scene.model).into_iter().chain(of_diagram).collect();
    let mut names = Names { is_closed: request.is_closed && loaded.controller.is_some(), ..Names::default() };
    let mut diagnostics = Diagnostics::new();
    match &request.inputs[..] {
        [] => names.inputs = default_inputs(loaded, at, &all, names.is_closed),
        asked => {
            for name in asked {
                match input(at, &all, name, names.is_closed) {
                    Ok(input) => names.inputs.push(input),
                    Err(diagnostic) => diagnostics.push(diagnostic),
                }
            }
        }
    }
    match &request.outputs[..] {
        [] => names.outputs = all.iter().filter(|e| matches!(e.probe, Probe::Coordinate(_))).map(output_of).collect(),
        asked => {
            for name in asked {
                match output(&all, name) {
                    Ok(output) => names.outputs.push(output),
                    Err(diagnostic) => diagnostics.push(diagnostic),
                }
            }
        }
    }
    if names.is_closed {
        note_sampled(at, &mut names.notes);
    } else if names.outputs.iter().any(|o| matches!(o.probe, Probe::Signal(_)))
        || names.inputs.iter().any(|i| matches!(i.what, InputKind::Signal(_)))
    {
        let message = "signals of the diagram are in the closed loop only";
        diagnostics
            .push(Diagnostic::without_location(message).with_help("add --closed-loop, or name signals of the world"));
    }
    let in_diagram = at.control().map_or(0, |c| c.wiring().program().n_states);
    if !names.is_closed && loaded.scene.model.n_v() == 0 && in_diagram > 0 {
        names.notes.push("the scene has no joints; the states of its diagram are seen with --closed-loop".into());
    }
    if names.outputs.is_empty() {
        names.notes.push("no outputs: the scene has no coordinates, and none were named".into());
    }
    if diagnostics.any_error() { Err(diagnostics) } else { Ok(names) }
}

fn default_inputs(loaded: &Loaded, at: &LockStep, all: &[Entry], is_closed: bool) -> Vec<Input> {
    let is_driven = |m: usize| is_closed && drives(at, m);
    let free = (0..loaded.scene.model.n_commands()).filter(|&m| !is_driven(m));
    let entry = |m: usize| all.iter().find(|e| e.probe == Probe::Command(m) && !e.unit.is_empty());
    free.filter_map(|m| entry(m).map(|e| Input { axis: axis(&e.name, &*e.unit), what: InputKind::Command(m) }))
        .collect()
}

/// Returns true if the diagram gives the command of a motor.
fn drives(at: &LockStep, motor: usize) -> bool {
    at.control().is_some_and(|c| c.wiring().program().commands.iter().any(|c| c.terminal == motor))
}

fn input(at: &LockStep, all: &[Entry], name: &Located<String>, is_closed: bool) -> Result<Input, Diagnostic> {
    // a joint's path stands for its motor, a rotor's for its speed, as in a diagram
    let path = |e: &Entry| e.name.strip_suffix(".command").or_else(|| e.name.strip_suffix(".speed")).map(str::to_owned);
    let entry = all.iter().find(|e| e.name == name.value || path(e).as_ref() == Some(&name.value));
    let error = |message: String, help: &str| Err(Diagnostic::error(&name.at, message).with_help(help));
    match entry.map(|e| (e, e.probe)) {
        Some((_, Probe::Command(m))) if is_closed && drives(at, m) => error(
            format!("`{}` is commanded by the diagram", name.value),
            "name the signal of the diagram that something is to be added to, or leave --closed-loop out",
        ),
        Some((entry, Probe::Command(m))) => {
            Ok(Input { axis: axis(&entry.name, &*entry.unit), what: InputKind::Command(m) })
        }
        Some((entry, Probe::Signal(k))) => {
            Ok(Input { axis: axis(&entry.name, &*entry.unit), what: InputKind::Signal(k) })
        }
        Some(_) => error(
            format!("`{}` is a measurement, not an input", name.value),
            "inputs are commands of motors (`/joint.command`) and signals of the diagram",
        ),
        None => {
            let inputs = all.iter().filter(|e| matches!(e.probe, Probe::Command(_) | Probe::Signal(_)));
            let known: Vec<&str> = inputs.map(|e| e.name.as_str()).collect();
            error(format!("there is no input `{}`", name.value), &suggest::help(&name.value, &known, "inputs"))
        }
    }
}

fn output(all: &[Entry], name: &Located<String>) -> Result<Output, Diagnostic> {
    let Some(entry) = all.iter().find(|e| e.name == name.value) else {
        let known: Vec<&str> = all.iter().map(|e| e.name.as_str()).collect();
        let help = suggest::help(&name.value, &known, "signals");
        return Err(Diagnostic::error(&name.at, format!("there is no signal `{}`", name.value)).with_help(help));
    };
    let is_sum = matches!(
        entry.probe,
        Probe::MotorTorqueMean(_)
            | Probe::Sensor(_)
            | Probe::FrictionTorque(_)
            | Probe::Command(_)
            | Probe::Energy(EnergyQuantity::Work | EnergyQuantity::Dissipated | EnergyQuantity::Balance)
    );
    if is_sum {
        let message = format!("`{}` is no function of the state", name.value);
        return Err(Diagnostic::error(&name.at, message).with_help("take a position, velocity, acceleration or torque"));
    }
    if matches!(entry.probe, Probe::JointReaction(..)) {
        let message = format!("`{}` is computed for records only, not linearised", name.value);
        return Err(Diagnostic::error(&name.at, message).with_help("take a position, velocity, acceleration or torque"));
    }
    Ok(output_of(entry))
}

fn output_of(entry: &Entry) -> Output {
    Output { axis: axis(&entry.name, &*entry.unit), probe: entry.probe }
}

/// Blocks with a sample time are constants of the linear system: said where there are any that matter.
fn note_sampled(at: &LockStep, notes: &mut Vec<String>) {
    use sincro_blocks::program::Rate;
    let Some(control) = at.control() else { return };
    let steps = &control.wiring().program().steps;
    let sampled: Vec<&str> = steps
        .iter()
        .filter(|s| matches!(s.rate, Rate::Sampled(_)) && !s.ports.is_empty())
        .map(|s| s.path.as_str())
        .collect();
    if !sampled.is_empty() {
        let list = sampled.iter().take(6).map(|s| format!("`{s}`")).collect::<Vec<_>>().join(", ");
        let more = if sampled.len() > 6 { format!(" and {} more", sampled.len() - 6) } else { String::new() };
        notes.push(format!("sampled blocks hold their outputs and are constants here: {list}{more}"));
    }
}
