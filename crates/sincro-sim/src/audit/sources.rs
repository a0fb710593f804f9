//! Sines, chirps and sampled series above half the rate at which a run reads them: it sees another, slower signal; and
//! pulses that are shorter than the time between two readings: it may miss them.
//!
//! Commands are read at ticks, blocks of a diagram at their sample times, and what acts inside the step at least once a
//! base step. Steps and ramps are exempt, and so are pulses inside the step: their jumps and corners are located as
//! events.

use sincro_blocks::program::Rate;
use sincro_dynamics::actuation::{Motor, SpringDamper};
use sincro_dynamics::signal::Signal;

use super::{Finding, help};
use crate::load::Loaded;

/// Rounding of typed numbers: a sine at exactly half the rate is none above it.
const ABOVE: f64 = 1.0 + 1e-9;

/// Returns a finding for each signal source with a frequency above half the rate at which it is read (Nyquist
/// frequency), in `[Hz]`; known before a run.
#[must_use]
pub fn source_findings(loaded: &Loaded) -> Vec<Finding> {
    let mut findings: Vec<Finding> = sources(loaded).into_iter().filter(|source| !source.holds()).collect();
    for finding in &mut findings {
        finding.help = help::source(finding, &loaded.experiment);
    }
    findings
}

/// Sources that are not constant, with the highest frequency of each.
#[must_use]
pub fn sources(loaded: &Loaded) -> Vec<Finding> {
    let (model, experiment) = (&loaded.scene.model, &loaded.experiment);
    let (step, until) = (experiment.step, experiment.duration);
    let mut found = Vec::new();
    let mut add = |element: &str, frequency: f64, period: f64| {
        let limit = 0.5 / period;
        if frequency > 0.0 {
            found.push(Finding {
                law: "source-frequency".to_owned(),
                element: element.to_owned(),
                time: 0.0,
                value: if frequency <= limit * ABOVE { frequency.min(limit) } else { frequency },
                limit,
                unit: "Hz".to_owned(),
                help: String::new(),
            });
        }
    };
    for (k, signal) in loaded.scene.commands.iter().enumerate() {
        add(&command_name(loaded, k), signal.highest_frequency(until, true), step);
    }
    let inside = |signals: &[Signal]| signals.iter().map(|s| s.highest_frequency(until, false)).fold(0.0, f64::max);
    for applied in model.applied() {
        add(model.names().dof_name(applied.dof), inside(&applied.signal), step);
    }
    for wrench in model.wrenches() {
        let frequency = wrench.force.iter().chain(&wrench.torque).map(|signals| inside(signals)).fold(0.0, f64::max);
        let frame = model.names().frames.iter().find(|frame| frame.link == Some(wrench.link));
        add(frame.map_or("/", |frame| &frame.name), frequency, step);
    }
    // velocity and position motors latch their target at ticks, whatever gives it between them
    let latches = model.motors().iter().any(Motor::is_drive);
    for block in loaded.controller.iter().flat_map(|controller| &controller.wiring.program().steps) {
        let (period, is_sampled) = match block.rate {
            Rate::Constant => continue,
            Rate::Continuous => (step, latches || !block.is_minor),
            Rate::Sampled(every) => (every as f64 * step, true),
        };
        add(&block.path, block.template.highest_frequency(until, is_sampled), period);
    }
    found
}

/// Name of the motor, rotor or spring and damper of a command.
fn command_name(loaded: &Loaded, command: usize) -> String {
    let model = &loaded.scene.model;
    let joint = model.names().joints.iter().find(|joint| joint.motors().any(|motor| motor.index() == command));
    let rotor = model.rotors().iter().position(|rotor| rotor.speed.command() == Some(command));
    let is_its_own = |line: &SpringDamper<f64>| line.actuator.is_some_and(|a| a.command == command);
    let line = model.spring_dampers().iter().position(is_its_own);
    let name = joint.map(|joint| &joint.name).or_else(|| rotor.map(|rotor| &model.names().rotors[rotor]));
    let name = name.or_else(|| line.map(|line| &model.names().spring_dampers[line]));
    name.map_or_else(|| format!("command {command}"), String::clone)
}
