//! Task of an experiment: observations, actions, reward, end of an episode, random starts.

use std::sync::Arc;

use sincro_dynamics::model::Model;
use sincro_math::Real;
use sincro_math::expression::{Expression, is_name};

use super::checks::CheckReader;
use super::grid::Grid;
use super::task_file::{ActionFile, RandomFile, TaskFile};
use crate::diagnostic::{Diagnostic, Diagnostics, Located};
use crate::document::escape;
use crate::record::{Entry, Probe, Recorder, catalogue};
use crate::suggest;

/// Relative distance at which a time is a whole number of steps.
const SAME_TIME: f64 = 1e-9;

/// Task for reinforcement learning, read from `[task]` of the experiment: observations, actions and reward of an agent.
/// Its formulas share one list of arguments, named by [`Task::slots`].
#[derive(Clone, Debug)]
pub struct Task {
    /// Base steps between two actions; at least one.
    pub ticks: u64,
    /// Number of actions of the longest episode, after which it is truncated; at least one.
    pub max_actions: u64,
    /// Names of the arguments of all formulas, in this order: signals, actions, named random numbers, `t` `[s]`,
    /// parameters.
    pub slots: Vec<String>,
    /// Recorded signals that formulas read, in the order of the first slots.
    pub signals: Vec<Located<String>>,
    /// Formulas of the observations, in the order of the agent's observation vector.
    pub observations: Vec<Expression>,
    /// Formula of the reward of one action.
    pub reward: Expression,
    /// Formula of the end of an episode, which ends where it is not 0; `None`: only the time limit ends it.
    pub terminated: Option<Expression>,
    /// Actions, in the order of the agent's action vector and of their slots.
    pub actions: Vec<Action>,
    /// Commands that formulas give: name of the command and its formula, in the command's unit.
    pub commands: Vec<(Located<String>, Expression)>,
    /// Numbers drawn anew for each episode, in the order of drawing.
    pub random: Vec<Random>,
    /// Values of the parameters, for the last slots.
    pub parameters: Vec<f64>,
}

/// Action of a task: an entry of the agent's action vector, the values it may have and the command that it sets.
#[derive(Clone, Debug)]
pub struct Action {
    /// Name in formulas.
    pub name: String,
    /// Name of the command that the action sets, in the command's unit; `None` if only formulas read it.
    pub command: Option<Located<String>>,
    /// Values that the action may have.
    pub space: Space,
}

/// Space of an action's values.
#[derive(Clone, Debug, PartialEq)]
pub enum Space {
    /// Continuous: all values between the lower and the upper bound, in the unit of the command.
    Range(f64, f64),
    /// Discrete: these values, in the unit of the command; of an action between them the nearest counts.
    Values(Vec<f64>),
}

impl Space {
    /// Returns the action as it acts: within its bounds, or the nearest of its values (of two as near, the first).
    #[must_use]
    pub fn acting<R: Real>(&self, x: R) -> R {
        match self {
            Self::Range(low, high) => {
                let (low, high) = (R::splat(*low), R::splat(*high));
                let x = x.if_less(low, low, x);
                high.if_less(x, high, x)
            }
            Self::Values(values) => {
                let Some((first, others)) = values.split_first() else { return x };
                let mut nearest = R::splat(*first);
                let mut distance = (nearest - x).abs();
                for value in others {
                    let value = R::splat(*value);
                    let apart = (value - x).abs();
                    nearest = apart.if_less(distance, value, nearest);
                    distance = apart.if_less(distance, apart, distance);
                }
                nearest
            }
        }
    }
}

/// Random number that is drawn anew for each episode of a task (domain randomisation).
#[derive(Clone, Debug)]
pub struct Random {
    /// Use of the number.
    pub target: Target,
    /// Distribution that it is drawn from, in the unit of its target.
    pub distribution: Distribution,
}

/// Use of a random number of a task, see [`Random`].
#[derive(Clone, Debug)]
pub enum Target {
    /// Slot of the formulas: index among the named random numbers, from 0.
    Name(usize),
    /// Initial value of a coordinate or velocity, named by its signal, such as `/hinge.position`.
    Start(Located<String>),
    /// Number of the scene or the diagram, named by its path as after `--set`.
    Parameter(Located<String>),
}

/// Distribution of a random number of a task.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// Uniform between the lower and the upper bound.
    Uniform(f64, f64),
    /// Normal, by mean and standard deviation.
    Normal(f64, f64),
}

/// Reads the task of an experiment; none, with problems noted, if something is wrong with it.
pub(super) fn read(file: &TaskFile, grid: Grid, reader: &mut CheckReader<'_>) -> Option<Task> {
    let before = reader.diagnostics.0.len();
    let ticks = whole(file.period.unwrap_or(grid.step), grid.step, "period", reader);
    let period = ticks as f64 * grid.step;
    let limit = file.time_limit.unwrap_or(grid.duration);
    let max_actions = ((limit / period) * (1.0 + SAME_TIME)).floor().max(1.0) as u64;
    let named: Vec<&String> = file.random.iter().filter_map(|random| random.name.as_ref()).collect();
    let slots: Vec<String> = (file.signals.keys())
        .chain(file.action.iter().map(|action| &action.name))
        .chain(named.iter().copied())
        .cloned()
        .chain(["t".to_owned()])
        .chain(reader.parameters.iter().map(|(name, _)| name.clone()))
        .collect();
    check_names(file, &slots, reader);
    let located = |reader: &CheckReader<'_>, text: &str, pointer: &str| Located {
        value: text.to_owned(),
        at: reader.document.at(pointer),
    };
    let signals = (file.signals.iter())
        .map(|(name, signal)| located(reader, signal, &format!("/task/signals/{}", escape(name))))
        .collect();
    let mut observations = Vec::new();
    for (k, text) in file.observations.iter().enumerate() {
        observations.extend(reader.formula(text, &format!("/task/observations/{k}"), &slots));
    }
    let reward = reader.formula(&file.reward, "/task/reward", &slots);
    let terminated = file.terminated.as_ref().and_then(|text| reader.formula(text, "/task/terminated", &slots));
    let actions = file.action.iter().enumerate().map(|(k, action)| read_action(k, action, reader)).collect();
    let mut commands = Vec::new();
    for (name, text) in &file.commands {
        let pointer = format!("/task/commands/{}", escape(name));
        if let Some(formula) = reader.formula(text, &pointer, &slots) {
            commands.push((Located { value: name.clone(), at: reader.document.key_at(&pointer) }, formula));
        }
    }
    let mut n_named = 0;
    let random =
        file.random.iter().enumerate().map(|(k, random)| read_random(k, random, &mut n_named, reader)).collect();
    let parameters = reader.parameters.iter().map(|(_, value)| *value).collect();
    if reader.diagnostics.0[before..].iter().any(Diagnostic::is_error) {
        return None;
    }
    let reward = reward?;
    Some(Task {
        ticks,
        max_actions,
        slots,
        signals,
        observations,
        reward,
        terminated,
        actions,
        commands,
        random,
        parameters,
    })
}

/// Number of base steps in a time; one, with the problem noted, if it is no whole number.
fn whole(time: f64, step: f64, key: &str, reader: &mut CheckReader<'_>) -> u64 {
    let ticks = (time / step).round();
    if (1.0..=1e9).contains(&ticks) && (ticks * step - time).abs() <= SAME_TIME * time {
        return ticks as u64;
    }
    let at = reader.document.at(&format!("/task/{key}"));
    let found = Diagnostic::error(&at, format!("`{key}` is {time} s, no whole multiple of the base step, {step} s"));
    reader.diagnostics.push(found.with_help(format!("{key} = {}, or another `step`", ticks.max(1.0) * step)));
    1
}

/// Refuses names that formulas cannot read, and names that stand twice.
fn check_names(file: &TaskFile, slots: &[String], reader: &mut CheckReader<'_>) {
    let of_signals = file.signals.keys().map(|name| (name, format!("/task/signals/{}", escape(name)), true));
    let of_actions = file.action.iter().enumerate().map(|(k, a)| (&a.name, format!("/task/action/{k}/name"), false));
    let of_random = file.random.iter().enumerate();
    let of_random = of_random.filter_map(|(k, r)| Some((r.name.as_ref()?, format!("/task/random/{k}/name"), false)));
    for (name, pointer, is_key) in of_signals.chain(of_actions).chain(of_random) {
        let help = if !is_name(name) {
            "formulas know names of letters, digits and `_` that begin with a letter"
        } else if name == "t" || name == "pi" {
            "it has a meaning of its own in formulas"
        } else if slots.iter().filter(|slot| *slot == name).count() > 1 {
            "signals, actions, random numbers and parameters have names of their own"
        } else {
            continue;
        };
        let at = if is_key { reader.document.key_at(&pointer) } else { reader.document.at(&pointer) };
        reader.diagnostics.push(Diagnostic::error(&at, format!("`{name}` cannot be a name here")).with_help(help));
    }
}

fn read_action(k: usize, file: &ActionFile, reader: &mut CheckReader<'_>) -> Action {
    let pointer = format!("/task/action/{k}");
    let space = match (&file.range, &file.values) {
        (Some([low, high]), _) => {
            if !(low < high && low.is_finite() && high.is_finite()) {
                let at = reader.document.at(&format!("{pointer}/range"));
                let found = Diagnostic::error(&at, format!("the range from {low} to {high} is empty or unbounded"));
                reader.diagnostics.push(found.with_help("give the least value, then the greatest"));
            }
            Space::Range(*low, *high)
        }
        (None, values) => Space::Values(values.clone().unwrap_or_default()),
    };
    let command = file
        .command
        .as_ref()
        .map(|command| Located { value: command.clone(), at: reader.document.at(&format!("{pointer}/command")) });
    Action { name: file.name.clone(), command, space }
}

fn read_random(k: usize, file: &RandomFile, n_named: &mut usize, reader: &mut CheckReader<'_>) -> Random {
    let pointer = format!("/task/random/{k}");
    let located =
        |text: &String, key: &str| Located { value: text.clone(), at: reader.document.at(&format!("{pointer}/{key}")) };
    let target = match (&file.signal, &file.path) {
        (Some(signal), _) => Target::Start(located(signal, "signal")),
        (None, Some(path)) => Target::Parameter(located(path, "path")),
        (None, None) => {
            *n_named += 1;
            Target::Name(*n_named - 1)
        }
    };
    let (distribution, holds, key) = match (file.range, file.normal) {
        (Some([low, high]), _) => (Distribution::Uniform(low, high), low <= high, "range"),
        (None, normal) => {
            let [mean, deviation] = normal.unwrap_or_default();
            (Distribution::Normal(mean, deviation), deviation >= 0.0, "normal")
        }
    };
    if !holds {
        let at = reader.document.at(&format!("{pointer}/{key}"));
        let (message, help) = match key {
            "range" => ("the upper bound is below the lower one", "give the least value, then the greatest"),
            _ => ("the standard deviation is negative", "give the mean, then the standard deviation"),
        };
        reader.diagnostics.push(Diagnostic::error(&at, message).with_help(help));
    }
    Random { target, distribution }
}

/// Refuses signals, commands and starts of a task that the scene does not have. `entries` are the diagram's signals.
pub(crate) fn check(task: &Task, model: &Model<f64>, entries: &[Entry]) -> Diagnostics {
    let mut found = Recorder::new(&task.signals, model, entries).map_or_else(|found| found, |_| Diagnostics::new());
    let of_actions = task.actions.iter().filter_map(|action| action.command.as_ref());
    for command in of_actions.chain(task.commands.iter().map(|(command, _)| command)) {
        if command_index(model, &command.value).is_none() {
            let names: Vec<String> = command_names(model);
            let help = match suggest::nearest(&command.value, names.iter().map(String::as_str)) {
                Some(near) => format!("did you mean `{near}`?"),
                None if names.is_empty() => "the scene has no motors, rotors or forces that take commands".into(),
                None => format!("commands here: {}", names.join(", ")),
            };
            let message = format!("there is no command `{}`", command.value);
            found.push(Diagnostic::error(&command.at, message).with_help(help));
        }
    }
    for random in &task.random {
        let Target::Start(signal) = &random.target else { continue };
        match catalogue(model).into_iter().find(|entry| entry.name == signal.value).map(|entry| entry.probe) {
            Some(Probe::Coordinate(_) | Probe::Rate(_)) => {}
            Some(_) => {
                let message = format!("an episode cannot start with `{}`", signal.value);
                let help = "name a position or velocity of a joint; `path` draws a number of the scene";
                found.push(Diagnostic::error(&signal.at, message).with_help(help));
            }
            None => found.merge(Recorder::new(std::slice::from_ref(signal), model, &[]).err().unwrap_or_default()),
        }
    }
    found
}

/// Returns the names of a model's commands as they are recorded, such as `/hinge.command`, in the order of the command
/// vector.
#[must_use]
pub fn command_names(model: &Model<f64>) -> Vec<String> {
    let mut named: Vec<(usize, String)> = (catalogue(model).into_iter())
        .filter_map(|entry| if let Probe::Command(k) = entry.probe { Some((k, entry.name)) } else { None })
        .collect();
    named.sort();
    named.dedup_by_key(|(k, _)| *k);
    named.into_iter().map(|(_, name)| name).collect()
}

/// Returns the index in the command vector of the command named `name`, as it is recorded or without its ending
/// `.command`; `None` if there is none.
#[must_use]
pub fn command_index(model: &Model<f64>, name: &str) -> Option<usize> {
    let is_named = |known: &str| known == name || known.strip_suffix(".command") == Some(name);
    let named = catalogue(model).into_iter().find(|e| matches!(e.probe, Probe::Command(_)) && is_named(&e.name));
    named.and_then(|entry| if let Probe::Command(k) = entry.probe { Some(k) } else { None })
}

/// Task of an experiment, if it has one.
pub(super) fn of_file(file: Option<&TaskFile>, grid: Grid, reader: &mut CheckReader<'_>) -> Option<Arc<Task>> {
    read(file?, grid, reader).map(Arc::new)
}
