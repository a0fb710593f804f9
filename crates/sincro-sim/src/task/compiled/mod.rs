//! The actions of a task compiled for lanes: programs of commands, of the step, and of what the agent sees after it.
//!
//! Observations, reward and end whose functions are no arithmetic (`exp`, `hypot`, …) are evaluated world by world
//! after the step; all other formulas are part of the programs, and a command of such functions keeps a task from them.

mod control;
mod rows;

use control::ControlPrograms;
use sincro_compile::native::{self, Native, NativeProgram};
use sincro_compile::{Obstacle, plant};
use sincro_dynamics::batch::LaneWorlds;
use sincro_math::Real;
use sincro_math::record::{Program, Recorded, record};
use sincro_scene::record::Probe;
use sincro_scene::record::probe::{View, of_state};

pub(super) use rows::{CompiledScratch, Rows};

use super::plan::{Formula, Plan};
use crate::rollout::StepsBy;

/// Programs of one action of a task.
#[derive(Clone, Debug)]
pub(super) struct CompiledTask {
    /// Commands and actions as they act, of everything known before the step.
    command: NativeProgram,
    /// One base step.
    step: NativeProgram,
    /// Results of everything known after the step: see [`results`].
    judge: NativeProgram,
    control: Option<Control>,
    pub layout: Layout,
    pub reward_is_compiled: bool,
    pub end_is_compiled: bool,
    /// Numbers of the observations that are evaluated world by world.
    pub other_observations: Vec<usize>,
}

/// The diagram of the task, compiled: see [`ControlPrograms`].
#[derive(Clone, Debug)]
struct Control {
    programs: Vec<NativeProgram>,
    latch: Vec<usize>,
    evaluate: Vec<usize>,
    start: usize,
    /// Signals and memory before the start.
    initial: Vec<f64>,
}

/// Rows of the results of the program that judges: first one that is 0 where all of them and the state are finite.
pub(super) mod results {
    pub const FINITE: usize = 0;
    pub const REWARD: usize = 1;
    pub const ENDED: usize = 2;
    pub const OBSERVATIONS: usize = 3;
}

/// Rows of numbers that the programs read, in this order; each has one number a world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Coordinates, velocities and rotor states.
    pub n_state: usize,
    /// Commands of the model.
    pub n_commands: usize,
    /// Actions as they act; the actions as they are given stand last.
    pub n_actions: usize,
    /// Random numbers with names; the number of actions of the episode follows them.
    pub n_named: usize,
    /// Signals of the diagram.
    pub n_signals: usize,
    /// Memory of the diagram; a number that is 0 while all signals were finite follows it.
    pub n_memory: usize,
}

impl Layout {
    fn of(plan: &Plan) -> Self {
        let [n_q, n_v, n_rotors, n_commands] = plant::state_sizes(&plan.loaded.scene.model);
        let diagram = plan.loaded.controller.as_ref().map(|control| control.wiring.program());
        Self {
            n_state: n_q + n_v + n_rotors,
            n_commands,
            n_actions: plan.n_actions(),
            n_named: plan.n_named(),
            n_signals: diagram.map_or(0, |diagram| diagram.n_signals),
            n_memory: diagram.map_or(0, |diagram| diagram.n_memory),
        }
    }

    pub fn acted(&self) -> usize {
        self.n_state + self.n_commands
    }

    pub fn named(&self) -> usize {
        self.acted() + self.n_actions
    }

    pub fn count(&self) -> usize {
        self.named() + self.n_named
    }

    pub fn signals(&self) -> usize {
        self.count() + 1
    }

    pub fn memory(&self) -> usize {
        self.signals() + self.n_signals
    }

    pub fn finite(&self) -> usize {
        self.memory() + self.n_memory
    }

    pub fn given(&self) -> usize {
        self.finite() + 1
    }

    pub fn n_rows(&self) -> usize {
        self.given() + self.n_actions
    }
}

impl CompiledTask {
    /// Compiles the actions of a task: of worlds that lanes can advance, or could without their diagram.
    pub fn new(plan: &Plan) -> Result<(Self, StepsBy), Obstacle> {
        let (scene, method, layout) = (&plan.loaded.scene, plan.method, Layout::of(plan));
        let models = [&*scene.model];
        let after_state = layout.n_rows() - layout.acted();
        let command = plant::worlds(&models, method, after_state, |worlds, rows| commands(plan, worlds, rows))?;
        let step = plant::step(&models, method, plan.loaded.experiment.step)?;
        let control = ControlPrograms::record(plan, layout)?;
        let is_compiled = |formula: &Formula| {
            let recorded = record(plan.task.slots.len(), 1, |values| vec![formula.eval(values, &mut Vec::new())]);
            recorded.is_ok()
        };
        let reward_is_compiled = is_compiled(&plan.reward);
        let end_is_compiled = plan.terminated.as_ref().is_none_or(is_compiled);
        let others = plan.observations.iter().enumerate().filter(|(_, formula)| !is_compiled(formula));
        let other_observations: Vec<usize> = others.map(|(i, _)| i).collect();
        let judge = plant::worlds(&models, method, layout.given() - layout.acted(), |worlds, rows| {
            let values = values(plan, worlds, rows);
            let value = |formula: Option<&Formula>, is_compiled: bool| match formula {
                Some(formula) if is_compiled => formula.eval(&values, &mut Vec::new()),
                _ => Recorded::zero(),
            };
            let mut found = vec![value(Some(&plan.reward), reward_is_compiled)];
            found.push(value(plan.terminated.as_ref(), end_is_compiled));
            for (i, formula) in plan.observations.iter().enumerate() {
                found.push(value(Some(formula), !other_observations.contains(&i)));
            }
            let state = [worlds.coordinates(), worlds.velocities(), worlds.rotors()].concat();
            // a lock-step stops where any signal of the task is not finite
            let n_signals = if plan.loaded.controller.is_some() { plan.probes.len() } else { 0 };
            let all = found.iter().chain(&state).chain(&values[..n_signals]);
            let finite = rows[layout.finite() - layout.acted()] + zero_if_finite(all);
            found.insert(results::FINITE, finite);
            if !(reward_is_compiled && end_is_compiled && other_observations.is_empty()) {
                found.extend(&values[..plan.probes.len()]);
            }
            found
        })?;
        let of_control = control.iter().flat_map(|control| &control.programs);
        let programs = [&command, &step, &judge].into_iter().chain(of_control);
        let programs: Vec<Program> = programs.map(Program::with_folded_parameters).collect();
        let Native { mut programs, elapsed, is_cached } = native::compile(&programs.iter().collect::<Vec<_>>())?;
        let of_control = programs.split_off(3);
        let [command, step, judge] = <[NativeProgram; 3]>::try_from(programs).expect("one for each");
        let control = control.map(|ControlPrograms { latch, evaluate, start, signals, memory, .. }| {
            let initial = [signals, memory].concat();
            Control { programs: of_control, latch, evaluate, start, initial }
        });
        let made =
            Self { command, step, judge, control, layout, reward_is_compiled, end_is_compiled, other_observations };
        Ok((made, StepsBy::Compiled { elapsed, is_cached }))
    }

    /// Number of worlds that are advanced together.
    pub fn width(&self) -> usize {
        self.step.width()
    }

    /// Largest number of results of the diagram's programs.
    fn n_controlled(&self) -> usize {
        let layout = self.layout;
        let latch = layout.n_commands + layout.n_memory;
        if self.control.is_some() { latch.max(1 + layout.n_signals) } else { 0 }
    }

    /// True if formulas are left to be evaluated world by world.
    pub fn has_others(&self) -> bool {
        !(self.reward_is_compiled && self.end_is_compiled && self.other_observations.is_empty())
    }
}

/// 0 where all numbers are finite, else NaN.
fn zero_if_finite<'a>(numbers: impl Iterator<Item = &'a Recorded>) -> Recorded {
    // x − x is 0, or NaN where x is not finite
    sum(&numbers.map(|x| *x + -*x).collect::<Vec<_>>())
}

/// Sum of numbers, by halves: no addition waits for all before it.
fn sum(numbers: &[Recorded]) -> Recorded {
    match numbers {
        [] => Recorded::zero(),
        [x] => *x,
        _ => {
            let (first, second) = numbers.split_at(numbers.len() / 2);
            sum(first) + sum(second)
        }
    }
}

/// Commands of an action, then the actions as they act.
fn commands(plan: &Plan, worlds: &mut LaneWorlds<Recorded>, rows: &[Recorded]) -> Vec<Recorded> {
    let n_given = plan.n_actions();
    let (known, given) = rows.split_at(rows.len() - n_given);
    let mut values = values(plan, worlds, known);
    let acted: Vec<Recorded> = plan.task.actions.iter().zip(given).map(|(action, x)| action.space.acting(*x)).collect();
    let first = plan.probes.len();
    values[first..first + n_given].copy_from_slice(&acted);
    let mut commands: Vec<Recorded> = plan.commands().into_iter().map(Recorded::splat).collect();
    for (action, command) in plan.of_actions.iter().enumerate() {
        if let Some(command) = command {
            commands[*command] = acted[action];
        }
    }
    for (command, formula) in &plan.of_formulas {
        commands[*command] = formula.eval(&values, &mut Vec::new());
    }
    [commands, acted].concat()
}

/// Numbers that formulas see: signals, actions, random numbers with names, time and parameters. `rows` are those after
/// the commands, up to the signals of the diagram at least.
fn values(plan: &Plan, worlds: &mut LaneWorlds<Recorded>, rows: &[Recorded]) -> Vec<Recorded> {
    let layout = Layout::of(plan);
    let seen = worlds.view(plan.needs_kinematics);
    let view = View::of(&seen);
    let of = |probe: &Probe| match *probe {
        Probe::Command(k) => view.commands[k],
        Probe::Signal(k) => rows[layout.signals() - layout.acted() + k],
        probe => of_state(&view, probe).expect("the plan refuses other signals"),
    };
    let mut values: Vec<Recorded> = plan.probes.iter().map(of).collect();
    let n_known = layout.count() - layout.acted();
    values.extend(&rows[..n_known]);
    values.push(rows[n_known] * Recorded::splat(plan.period()));
    values.extend(plan.task.parameters.iter().map(|x| Recorded::splat(*x)));
    values
}
