//! Programs of one action, and their composition.
//!
//! | part | reads | gives |
//! |---|---|---|
//! | command | all rows, the actions as they are given with them | commands, actions as they act |
//! | step, once for each base step | state and commands | state |
//! | programs of the diagram, before and after each step | rows | commands and memory; signals |
//! | finish | rows after the steps | rows with one more action counted, reward, observations, flags |
//! | look | rows at the start of an episode | observations, a flag |

use sincro_compile::native::INPUT_LIMIT;
use sincro_compile::plant;
use sincro_math::record::record;

use super::{ControlPrograms, LaneWorlds, Layout, Obstacle, Plan, Program, Real, Recorded};
use super::{size, values, zero_if_finite};

/// Results for worlds in the state of the first rows, and the rows that follow them.
type Recording<'a> = dyn Fn(&mut LaneWorlds<Recorded>, &[Recorded]) -> Vec<Recorded> + 'a;

/// Programs of the parts of an action.
#[derive(Debug)]
pub(super) struct Parts {
    pub command: Program,
    pub step: Program,
    pub control: Option<ControlPrograms>,
    pub finish: Program,
    pub look: Program,
    pub n_steps: u64,
}

impl Parts {
    /// Records the parts.
    pub fn record(plan: &Plan, layout: Layout) -> Result<Self, Obstacle> {
        let (models, method) = ([&*plan.loaded.scene.model], plan.method);
        let worlds = |n_more: usize, act: &Recording<'_>| plant::worlds(&models, method, n_more, act);
        let after_state = layout.given() - layout.acted();
        Ok(Self {
            command: worlds(layout.n_rows() - layout.acted(), &|worlds, rows| commands(plan, worlds, rows))?,
            step: plant::step(&models, method, plan.loaded.experiment.step).map_err(|why| of_step(&why))?,
            control: ControlPrograms::record(plan, layout)?,
            finish: worlds(after_state, &|worlds, rows| finish(plan, layout, worlds, rows))?,
            look: worlds(after_state, &|worlds, rows| {
                let judged = Judged::of(plan, layout, worlds, rows);
                [&judged.observations[..], &[judged.is_bad]].concat()
            })?,
            n_steps: plan.task.ticks,
        })
    }

    /// Composition of the parts: the inputs are those of the command, the outputs those of the finish. None if it would
    /// be long beyond measure.
    pub fn whole(&self, layout: Layout) -> Result<Option<Program>, Obstacle> {
        let of_step = self.step.n_computed() + self.control.as_ref().map_or(0, ControlPrograms::n_computed);
        if of_step as f64 * self.n_steps as f64 > super::MAX_WHOLE as f64 {
            return Ok(None);
        }
        let whole = record(layout.n_rows(), 1, |inputs| {
            let mut rows = inputs[..layout.given()].to_vec();
            // everything that a program reads, as the parts look at their inputs
            let mut read = Vec::new();
            let mut set = |rows: &mut [Recorded], at: usize, numbers: &[Recorded]| {
                rows[at..at + numbers.len()].copy_from_slice(numbers);
                read.extend_from_slice(numbers);
            };
            set(&mut rows, layout.n_state, &self.command.replay(inputs));
            for step in 0..self.n_steps as usize {
                if let Some(control) = &self.control {
                    let latched = control.programs[control.latch[step]].replay(&rows);
                    let (commands, memory) = latched.split_at(layout.n_commands);
                    set(&mut rows, layout.n_state, commands);
                    set(&mut rows, layout.memory(), memory);
                }
                let stepped = self.step.replay(&rows[..layout.acted()]);
                set(&mut rows, 0, &stepped);
                if let Some(control) = &self.control {
                    let evaluated = control.programs[control.evaluate[step]].replay(&rows);
                    let (finite, signals) = evaluated.split_at(1);
                    set(&mut rows, layout.finite(), finite);
                    set(&mut rows, layout.signals(), signals);
                }
            }
            let mut outputs = self.finish.replay(&rows);
            let first_flag = outputs.len() - super::flags::N;
            let is_bad = &mut outputs[first_flag + super::flags::BAD];
            // the finish has the last state already
            read.retain(|x| !rows.iter().any(|row| x.is_same(*row)));
            *is_bad = size(&read).if_less(Recorded::splat(INPUT_LIMIT), *is_bad, Recorded::one());
            outputs
        })?;
        Ok(Some(whole))
    }
}

/// Reason why the step of a scene has no program, in words that say where it lies.
fn of_step(why: &Obstacle) -> Obstacle {
    Obstacle::new(format!(
        "the step of the scene is no fixed list of operations ({why}); rotors by blade elements, whose inflow is iterated, \
         have none"
    ))
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

/// Formulas of a state, worked out of the rows after the commands.
struct Judged {
    reward: Recorded,
    /// 1 where the episode terminates, else 0.
    terminates: Recorded,
    observations: Vec<Recorded>,
    /// 1 where one of them, the rows or a signal of the diagram is not finite or is huge, else 0.
    is_bad: Recorded,
}

impl Judged {
    fn of(plan: &Plan, layout: Layout, worlds: &mut LaneWorlds<Recorded>, rows: &[Recorded]) -> Self {
        let (zero, one) = (Recorded::zero(), Recorded::one());
        let values = values(plan, worlds, rows);
        let mut stack = Vec::new();
        let reward = plan.reward.eval(&values, &mut stack);
        let end = plan.terminated.as_ref().map_or(zero, |formula| formula.eval(&values, &mut stack));
        let observations: Vec<Recorded> =
            plan.observations.iter().map(|formula| formula.eval(&values, &mut stack)).collect();
        // a lock-step stops where any signal of the task is not finite
        let n_signals = if plan.loaded.controller.is_some() { plan.probes.len() } else { 0 };
        let commands = worlds.view(false).commands.to_vec();
        let state = [worlds.coordinates(), worlds.velocities(), worlds.rotors(), &commands].concat();
        let new = &rows[..layout.n_actions];
        let of_diagram = &rows[layout.signals() - layout.acted()..layout.given() - layout.acted()];
        let huge = size(&[&state[..], new, of_diagram].concat());
        let judged = zero_if_finite(&[&[reward, end][..], &observations, &values[..n_signals]].concat());
        Self {
            reward,
            terminates: zero.if_less(end, one, end.if_less(zero, one, zero)),
            observations,
            is_bad: (huge + judged).if_less(Recorded::splat(INPUT_LIMIT), zero, one),
        }
    }
}

/// Rows after an action, reward, observations and flags, from the rows after its steps.
fn finish(plan: &Plan, layout: Layout, worlds: &mut LaneWorlds<Recorded>, rows: &[Recorded]) -> Vec<Recorded> {
    let mut rows = rows.to_vec();
    let count = &mut rows[layout.count() - layout.acted()];
    *count += Recorded::one();
    let last = Recorded::splat(plan.task.max_actions as f64 - 0.5);
    let at_limit = count.if_less(last, Recorded::zero(), Recorded::one());
    let judged = Judged::of(plan, layout, worlds, &rows);
    let commands = worlds.view(false).commands.to_vec();
    let state = [worlds.coordinates(), worlds.velocities(), worlds.rotors(), &commands].concat();
    let flags = [judged.is_bad, judged.terminates, at_limit];
    [&state[..], &rows, &[judged.reward], &judged.observations, &flags].concat()
}
