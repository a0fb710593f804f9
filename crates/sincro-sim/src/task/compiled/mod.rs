//! The actions of a task compiled for lanes: programs of commands, of the step, and of what the agent sees after it,
//! put together to one program of the whole action unless that is too long.

mod act;
mod control;
mod rows;

use act::Parts;
use control::ControlPrograms;
use sincro_compile::native::{self, Native, NativeProgram, OutputForm};
use sincro_compile::{Obstacle, plant};
use sincro_dynamics::batch::LaneWorlds;
use sincro_math::Real;
use sincro_math::record::{Program, Recorded};
use sincro_scene::record::Probe;
use sincro_scene::record::probe::{View, of_state};

pub(super) use rows::{CompiledScratch, ResultsMut, Rows, set_bits};

use super::plan::Plan;
use crate::rollout::StepsBy;

/// Largest number of operations of the program of a whole action: longer ones take compilers seconds, and gain little
/// over one program for each part.
const MAX_WHOLE: usize = 6_000;

/// Programs of one action of a task.
#[derive(Clone, Debug)]
pub(super) struct CompiledTask {
    action: Action,
    /// Observations, and a flag that is true where a result or the state is not finite, at the start of an episode.
    look: NativeProgram,
    control: Option<Control>,
    pub layout: Layout,
    pub n_observations: usize,
}

/// One action: see [`act`].
#[derive(Clone, Debug)]
enum Action {
    /// By one program.
    Whole(NativeProgram),
    /// By programs of its parts.
    Parts {
        command: NativeProgram,
        step: NativeProgram,
        finish: NativeProgram,
        /// Programs of the diagram before and after each base step; none if there is no diagram.
        control: Vec<[NativeProgram; 2]>,
        n_steps: u64,
    },
}

/// The diagram at the start of an episode: see [`ControlPrograms`].
#[derive(Clone, Debug)]
struct Control {
    start: NativeProgram,
    /// Signals and memory before the start.
    initial: Vec<f64>,
}

/// Flags of the program of an action, each a bit a world.
pub(super) mod flags {
    /// The world cannot go on, or not by programs.
    pub const BAD: usize = 0;
    /// Its episode terminates.
    pub const TERMINATES: usize = 1;
    /// Its episode is at its time limit.
    pub const AT_LIMIT: usize = 2;
    /// Number of flags.
    pub const N: usize = 3;
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
        let layout = Layout::of(plan);
        let parts = Parts::record(plan, layout)?;
        let whole = parts.whole(layout)?.filter(|whole| whole.operations().len() <= MAX_WHOLE);
        let n_observations = plan.n_observations();
        // the rows were looked at when the worlds came into them, and after each action
        let of_action = OutputForm {
            n_results: [1, n_observations],
            n_flags: flags::N,
            refuses_by_flag: true,
            inputs_are_checked: true,
        };
        let of_look = OutputForm { n_results: [0, n_observations], n_flags: 1, ..OutputForm::default() };
        let plain = OutputForm::default();
        let mut programs: Vec<(&Program, OutputForm)> = vec![(&parts.look, of_look)];
        let control = parts.control.as_ref();
        programs.extend(control.map(|control| (&control.programs[control.start], plain)));
        let n_common = programs.len();
        match &whole {
            Some(whole) => programs.push((whole, of_action)),
            None => {
                programs.extend([(&parts.command, plain), (&parts.step, plain), (&parts.finish, of_action)]);
                programs.extend(control.iter().flat_map(|control| &control.programs).map(|program| (program, plain)));
            }
        }
        let Native { programs, elapsed, is_cached } = native::compile_in_form(&programs)?;
        let (common, own) = programs.split_at(n_common);
        let action = match own {
            [whole] => Action::Whole(whole.clone()),
            [command, step, finish, of_control @ ..] => Action::Parts {
                command: command.clone(),
                step: step.clone(),
                finish: finish.clone(),
                control: control.map_or_else(Vec::new, |control| {
                    let both = control.latch.iter().zip(&control.evaluate);
                    both.map(|(latch, evaluate)| [*latch, *evaluate].map(|k| of_control[k].clone())).collect()
                }),
                n_steps: parts.n_steps,
            },
            _ => unreachable!("an action has one program, or three and those of the diagram"),
        };
        let control = parts.control.map(|ControlPrograms { signals, memory, .. }| Control {
            start: common[1].clone(),
            initial: [signals, memory].concat(),
        });
        let made = Self { action, look: common[0].clone(), control, layout, n_observations };
        Ok((made, StepsBy::Compiled { elapsed, is_cached }))
    }

    /// Number of worlds that are advanced together.
    #[inline]
    pub fn width(&self) -> usize {
        self.look.width()
    }

    /// Largest number of results of the diagram's programs.
    fn n_controlled(&self) -> usize {
        let layout = self.layout;
        let latch = layout.n_commands + layout.n_memory;
        if self.control.is_some() { latch.max(1 + layout.n_signals) } else { 0 }
    }
}

/// Sum of the magnitudes of numbers, by halves: no addition waits for all before it.
fn size(numbers: &[Recorded]) -> Recorded {
    match numbers {
        [] => Recorded::zero(),
        [x] => x.abs(),
        _ => {
            let (first, second) = numbers.split_at(numbers.len() / 2);
            size(first) + size(second)
        }
    }
}

/// 0 where all numbers are finite, else NaN.
fn zero_if_finite(numbers: &[Recorded]) -> Recorded {
    // x − x is 0, or NaN where x is not finite
    let size = size(numbers);
    size + -size
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
