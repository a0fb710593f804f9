//! The world as a block: which measurements it gives, which commands it takes.
//!
//! Measurements have the names of recorded signals; a vector goes by the name that its components have in common, such
//! as `/body.position`. `world.q` and `world.v` are all coordinates and all velocities. Commands go by the path of the
//! joint or by `path.command`.

use sincro_blocks::compile::Terminal;
use sincro_blocks::unit::Unit;
use sincro_dynamics::actuation::MotorMode;
use sincro_dynamics::model::Model;

use crate::record::probe::{depends_on_command, has_actuated_force, has_commanded_circuit};
use crate::record::{ContactQuantity, EnergyQuantity, Entry, FrameQuantity, Probe, catalogue};

/// A measurement: where its components are read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Measurement {
    pub terminal: Terminal,
    pub probes: Vec<Probe>,
}

/// Everything that can be measured.
pub(crate) fn measurements(model: &Model<f64>) -> Vec<Measurement> {
    let entries: Vec<Entry> = catalogue(model).into_iter().filter(|e| can_be_measured(e.probe)).collect();
    let mut list = vec![
        whole("q", &entries, (0..model.n_q()).map(Probe::Coordinate).collect()),
        whole("v", &entries, (0..model.n_v()).map(Probe::Rate).collect()),
    ];
    list.extend(entries.iter().map(|entry| measurement(model, entry.name.clone(), &entry.unit, vec![entry.probe])));
    list.extend(vectors(model, &entries));
    list
}

/// A vector of the whole world; it has a unit if all its components have the same one.
fn whole(name: &str, entries: &[Entry], probes: Vec<Probe>) -> Measurement {
    let of = |probe: &Probe| entries.iter().find(|e| e.probe == *probe).and_then(|e| unit_of(&e.unit));
    let first = probes.first().and_then(of);
    let unit = first.filter(|first| probes.iter().all(|probe| of(probe).is_some_and(|unit| unit.is_same(first))));
    let terminal = Terminal { names: vec![name.into()], width: probes.len(), unit, is_special: false };
    Measurement { terminal, probes }
}

fn measurement(model: &Model<f64>, name: String, unit: &str, probes: Vec<Probe>) -> Measurement {
    let is_special = probes.iter().any(|p| depends_on_commands(model, *p));
    let unit = unit_of(unit);
    Measurement { terminal: Terminal { names: vec![name], width: probes.len(), unit, is_special }, probes }
}

/// Neighbouring entries `stem.x`, `stem.y`, `stem.z` (or `stem.w` …) as one vector `stem`.
fn vectors(model: &Model<f64>, entries: &[Entry]) -> Vec<Measurement> {
    let mut found = Vec::new();
    let mut k = 0;
    while k < entries.len() {
        let run = run_of(&entries[k..]);
        if run > 1 {
            let stem = entries[k].name.rsplit_once('.').map_or("", |(stem, _)| stem);
            let probes = entries[k..k + run].iter().map(|e| e.probe).collect();
            found.push(measurement(model, stem.to_owned(), &entries[k].unit, probes));
        }
        k += run.max(1);
    }
    found
}

/// Number of entries, from the first on, that are components of one vector.
fn run_of(entries: &[Entry]) -> usize {
    for components in [&["w", "x", "y", "z"][..], &["x", "y", "z"]] {
        let stem = |e: &Entry, c: &str| e.name.strip_suffix(c).and_then(|s| s.strip_suffix('.')).map(str::to_owned);
        let first = entries.first().and_then(|e| stem(e, components[0]));
        let fits = |(k, c): (usize, &&str)| first.is_some() && entries.get(k).and_then(|e| stem(e, c)) == first;
        if first.is_some() && components.iter().enumerate().all(fits) {
            return components.len();
        }
    }
    0
}

/// Returns true if a measurement changes at once when a command does.
pub(crate) fn depends_on_commands(model: &Model<f64>, probe: Probe) -> bool {
    match probe {
        Probe::Acceleration(_) | Probe::MotorTorqueNow(_) | Probe::Frame(FrameQuantity::Acceleration, ..) => true,
        Probe::Rotor(quantity, k) => depends_on_command(model, quantity, k),
        Probe::SpringDamper(quantity, k) => has_actuated_force(model, quantity, k),
        Probe::Winding(quantity, k) => has_commanded_circuit(model, quantity, k),
        _ => false,
    }
}

/// Returns true if a measurement has a value at ticks only and none between: sums over a step, values of sensors,
/// contact forces. Continuous blocks see such a measurement held.
#[must_use]
pub fn is_known_at_ticks_only(probe: Probe) -> bool {
    matches!(
        probe,
        Probe::Sensor(_)
            | Probe::FloatSignal(_)
            | Probe::MotorTorqueMean(_)
            | Probe::Contact(..)
            | Probe::Reaction(_)
            | Probe::Energy(EnergyQuantity::Work | EnergyQuantity::Dissipated)
    )
}

/// Everything that can be commanded, in the order of the world's commands.
pub(crate) fn commands(model: &Model<f64>) -> Vec<Terminal> {
    let entries = catalogue(model);
    let terminal = |command: usize| {
        let entry = entries.iter().find(|e| e.probe == Probe::Command(command)).expect("every command is on offer");
        let motor = model.motors().get(command);
        // the path of a joint stands for its motor, that of a rotor for its speed
        let path = entry.name.strip_suffix(".command").or_else(|| entry.name.strip_suffix(".speed"));
        let names = match motor.map(|m| m.mode) {
            Some(MotorMode::Free) => Vec::new(),
            _ => path.map(str::to_owned).into_iter().chain([entry.name.clone()]).collect(),
        };
        // an ideal motor jumps to what it is told: between ticks it cannot follow
        let is_special = motor.is_some_and(|m| m.is_drive());
        Terminal { names, width: 1, unit: unit_of(&entry.unit), is_special }
    };
    (0..model.n_commands()).map(terminal).collect()
}

/// A unit of the catalogue; none where it has none.
fn unit_of(text: &str) -> Option<Unit> {
    Unit::parse(text).ok().filter(|_| !text.is_empty())
}

/// Returns true if it is known before the commands, or follows from them in one step. The rest can be recorded all the
/// same.
fn can_be_measured(probe: Probe) -> bool {
    !matches!(
        probe,
        Probe::Command(_)
            | Probe::FrictionTorque(_)
            | Probe::LimitTorque(_)
            | Probe::Opening(_)
            | Probe::JointReaction(..)
            | Probe::Contact(ContactQuantity::Point | ContactQuantity::Normal, ..)
            | Probe::Energy(EnergyQuantity::Balance)
            | Probe::Signal(_)
            | Probe::FloatSignal(_)
    )
}
