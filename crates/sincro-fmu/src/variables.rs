//! Variables of an exported scene: the same list when the FMU is written and when it runs, so that a value reference
//! means the same in both.
//!
//! | variables | causality | variability |
//! |---|---|---|
//! | time | independent | continuous |
//! | numbers of the files | parameter | fixed, or tunable where a running world can change them |
//! | commands of motors, forces and rotors that nothing drives | input | continuous |
//! | recorded signals, or all | output | continuous |
//! | continuous states and their derivatives (model exchange) | local | continuous |

use sincro_dynamics::signal::Signal;
use sincro_scene::diagnostic::{Diagnostics, Located, Location, SourceText};
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::overrides::Override;
use sincro_scene::record::{Entry, Probe, Recorder, catalogue};
use sincro_sim::Loaded;
use std::sync::Arc;

use crate::continuous;
use crate::names::Names;
use crate::numbers::{Number, numbers};
use crate::tunable::{Tunable, tunable};

/// Choice of the signals that become outputs of an FMU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outputs {
    /// The signals of the experiment's `record` list.
    #[default]
    Recorded,
    /// All signals that the scene and its diagram offer, those of the `record` list first.
    All,
}

/// Meaning of a variable of an FMU for the scene: which quantity its value reference reads or sets.
#[derive(Clone, Debug, PartialEq)]
pub enum Role {
    /// Simulation time `[s]`, the independent variable.
    Time,
    /// Parameter that is set before the start: a number of the scene's files, by its path as for `--set`.
    Fixed(String),
    /// Parameter that can also be set while the FMU runs: its path, and the quantity of the world.
    Tunable(String, Tunable),
    /// Input: a command of the scene that nothing drives, by its index among the model's.
    Input(usize),
    /// Output: a recorded signal, by its index among the outputs.
    Output(usize),
    /// Continuous state of model exchange, by its index among the states.
    State(usize),
    /// Time derivative of a continuous state, by the index of that state.
    Derivative(usize),
}

/// Variable of an FMU. Its value reference is its index in [`Catalogue::variables`].
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Name in the structured form of FMI: `arm.joint.position`.
    pub name: String,
    /// Meaning for the scene.
    pub role: Role,
    /// Unit as sincro writes it; empty for none.
    pub unit: String,
    /// Start value in `unit`, of parameters, inputs and states; none for other variables.
    pub start: Option<f64>,
    /// Description; the name of the signal or number in sincro comes first where it differs from `name`.
    pub description: String,
}

/// All variables of an exported scene: the same list when the FMU is written and when it runs.
#[derive(Clone, Debug)]
pub struct Catalogue {
    /// Variables in the order of their value references, from 0.
    pub variables: Vec<Variable>,
    /// Names of the recorded signals behind the outputs, in the order of [`Role::Output`].
    pub recorded: Vec<Located<String>>,
    /// Number of continuous states; 0 unless model exchange was asked for.
    pub n_states: usize,
}

impl Catalogue {
    /// Lists the variables of a loaded scene; `overrides` are those that it was loaded with, `has_states` adds the
    /// continuous states and their derivatives for model exchange. The order is time, parameters, inputs, outputs,
    /// states.
    ///
    /// # Errors
    ///
    /// A recorded signal does not exist, or the files of the scene have changed since and cannot be read; each with its
    /// place.
    pub fn new(
        loaded: &Loaded,
        overrides: &[Override],
        outputs: Outputs,
        has_states: bool,
    ) -> Result<Self, Diagnostics> {
        let mut list = List::default();
        list.add("time", Role::Time, "s", None, "simulated time");
        let inputs = free_commands(loaded);
        for number in numbers(&loaded.folder, overrides)? {
            let is_input = inputs.iter().any(|input| stands_for(&input.entry.name, &number.path));
            if !is_input && number.value.is_finite() {
                list.parameter(number, loaded);
            }
        }
        for input in inputs {
            let unit = input.entry.unit.clone();
            list.add(&input.entry.name, Role::Input(input.command), &unit, Some(input.start), "command");
        }
        let mut recorded = recorded(loaded, outputs);
        if has_states {
            // whoever integrates does not integrate the sums
            recorded.retain(|name| !matches!(&*name.value, "energy.work" | "energy.dissipated" | "energy.balance"));
        }
        let entries = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
        let recorder = Recorder::new(&recorded, &loaded.scene.model, &entries)?;
        for (k, (name, unit)) in recorder.columns().skip(1).enumerate() {
            list.add(name, Role::Output(k), unit, None, "signal");
        }
        let states = if has_states { continuous::states(loaded) } else { Vec::new() };
        for (k, state) in states.iter().enumerate() {
            let description = format!("continuous state {}", state.name);
            list.add(&format!("state.{}", state.name), Role::State(k), &state.unit, Some(state.start), &description);
            let rate = format!("derivative of the continuous state {}", state.name);
            list.add(&format!("derivative.{}", state.name), Role::Derivative(k), "", None, &rate);
        }
        Ok(Self { variables: list.variables, recorded, n_states: states.len() })
    }

    /// Selects variables by their role: value reference, variable and what `pick` returned, in the order of the value
    /// references; those for which `pick` returns none are left out.
    pub fn with_role<T>(&self, pick: impl Fn(&Role) -> Option<T>) -> impl Iterator<Item = (u32, &Variable, T)> {
        let numbered = self.variables.iter().enumerate();
        numbered.filter_map(move |(k, variable)| Some((u32::try_from(k).ok()?, variable, pick(&variable.role)?)))
    }
}

#[derive(Default)]
struct List {
    names: Names,
    variables: Vec<Variable>,
}

impl List {
    fn add(&mut self, name: &str, role: Role, unit: &str, start: Option<f64>, words: &str) {
        let suffix = if matches!(role, Role::Output(_)) { "_held" } else { "_" };
        let structured = self.names.add(name, suffix);
        let description = if structured == name { words.to_owned() } else { format!("{name}: {words}") };
        self.variables.push(Variable { name: structured, role, unit: unit.to_owned(), start, description });
    }

    fn parameter(&mut self, number: Number, loaded: &Loaded) {
        let Number { path, value, unit, description } = number;
        let role = match tunable(&path, loaded) {
            Some(what) => Role::Tunable(path.clone(), what),
            None => Role::Fixed(path.clone()),
        };
        self.add(&path, role, &unit, Some(value), &description);
    }
}

/// A command that nothing drives.
struct FreeCommand {
    command: usize,
    entry: Entry,
    start: f64,
}

/// Commands without a signal that changes, which the diagram does not give.
fn free_commands(loaded: &Loaded) -> Vec<FreeCommand> {
    let program = loaded.controller.as_ref().map(|controller| controller.wiring.program());
    let is_given = |k: usize| program.is_some_and(|p| p.commands.iter().any(|c| c.terminal == k));
    let entries = catalogue(&loaded.scene.model);
    let of = |k: usize| entries.iter().find(|entry| entry.probe == Probe::Command(k)).cloned();
    let commands = loaded.scene.commands.iter().enumerate();
    commands
        .filter_map(|(command, signal)| match signal {
            Signal::Constant(start) if !is_given(command) => {
                Some(FreeCommand { command, entry: of(command)?, start: *start })
            }
            _ => None,
        })
        .collect()
}

/// Returns true if a number of the files is the constant behind a command.
fn stands_for(command: &str, path: &str) -> bool {
    let Some((object, quantity)) = command.split_once('.') else { return false };
    let Some(key) = path.strip_prefix(object).and_then(|rest| rest.strip_prefix('.')) else { return false };
    let of_actuators =
        ["motor.command", "motor.command.constant", "actuator.command", "actuator.command.constant"].contains(&key);
    (quantity == "command" && of_actuators)
        || (matches!(quantity, "speed" | "command") && matches!(key, "speed" | "speed.constant"))
}

/// Names of the signals that become outputs.
fn recorded(loaded: &Loaded, outputs: Outputs) -> Vec<Located<String>> {
    if outputs == Outputs::Recorded {
        return loaded.experiment.record.clone();
    }
    let at = Location { source: Arc::new(SourceText { path: "--all".into(), text: String::new() }), span: 0..0 };
    let entries = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
    let of_world = catalogue(&loaded.scene.model);
    let mut names: Vec<Located<String>> = Vec::new();
    let own = loaded.experiment.record.iter().map(|name| name.value.clone());
    for value in own.chain(of_world.into_iter().chain(entries).map(|entry| entry.name)) {
        if !names.iter().any(|known| known.value == value) {
            names.push(Located { value, at: at.clone() });
        }
    }
    names
}
