//! The diagram of a task between two actions: programs of its blocks at each base step.

use std::sync::Arc;

use sincro_blocks::program::{Program as Diagram, Rate};
use sincro_blocks::runner::Runner;
use sincro_compile::diagram::{self, CompiledBlock, Computed, is_due};
use sincro_compile::{Obstacle, plant};
use sincro_dynamics::batch::LaneWorlds;
use sincro_math::Real;
use sincro_math::record::{Program, Recorded};
use sincro_scene::record::Probe;
use sincro_scene::record::probe::{View, of_state};

use super::{Layout, zero_if_finite};
use crate::task::plan::Plan;

/// Programs of a diagram whose blocks run at ticks.
#[derive(Debug)]
pub(super) struct ControlPrograms {
    /// Different programs.
    pub programs: Vec<Program>,
    /// Index of the program of each base step of an action: commands and memory.
    pub latch: Vec<usize>,
    /// Index of the program after each base step: signals.
    pub evaluate: Vec<usize>,
    /// Index of the program of the first signals of an episode.
    pub start: usize,
    /// Signals and memory before the start.
    pub signals: Vec<f64>,
    pub memory: Vec<f64>,
}

/// Any action but the first of an episode: [`diagram::compile`] has seen that a block does the same at all of them.
const LATER_ACTION: u64 = 1_237;

impl ControlPrograms {
    /// Number of operations of the programs, those of one base step at most.
    pub fn n_computed(&self) -> usize {
        self.programs.iter().map(Program::n_computed).sum()
    }

    /// Records the diagram of a task; none if there is none.
    pub fn record(plan: &Plan, layout: Layout) -> Result<Option<Self>, Obstacle> {
        let Some(control) = &plan.loaded.controller else { return Ok(None) };
        let program = control.wiring.program();
        let compiled = diagram::compile(program)?;
        let measured = diagram::measurements(&control.wiring)?;
        let n_steps = plan.task.ticks;
        for block in &compiled.blocks {
            let step = &program.steps[block.step];
            if matches!(block.output, Computed::Source) {
                return Err(Obstacle::new(format!("block `{}` depends on time", step.path)));
            }
            if let Rate::Sampled(every) = step.rate
                && !n_steps.is_multiple_of(every)
            {
                let words = format!("the period of block `{}` does not divide that of the actions", step.path);
                return Err(Obstacle::new(words));
            }
        }
        let recording = Recording { plan, layout, program, blocks: &compiled.blocks, measured: &measured };
        let mut programs: Vec<Program> = Vec::new();
        let mut index = |new: Program| {
            let known = programs.iter().position(|program| *program == new);
            known.unwrap_or_else(|| {
                programs.push(new);
                programs.len() - 1
            })
        };
        let start = index(recording.evaluate(0)?);
        let (mut latch, mut evaluate) = (Vec::new(), Vec::new());
        // blocks that are due together, and their programs; those of the first step know the start of the episode
        let mut known: Vec<(Vec<bool>, usize, usize)> = Vec::new();
        for step in 0..n_steps {
            let [now, after] = [step, step + 1].map(|step| recording.due(LATER_ACTION * n_steps + step));
            let key = [now, after].concat();
            let (latched, evaluated) = match known.iter().find(|(due, ..)| *due == key) {
                Some((_, latched, evaluated)) if step > 1 => (*latched, *evaluated),
                _ => {
                    let latched = index(recording.latch(step)?);
                    (latched, index(recording.evaluate(LATER_ACTION * n_steps + step + 1)?))
                }
            };
            if step > 0 {
                known.push((key, latched, evaluated));
            }
            latch.push(latched);
            evaluate.push(evaluated);
        }
        Ok(Some(Self { programs, latch, evaluate, start, signals: compiled.signals, memory: compiled.memory }))
    }
}

struct Recording<'a> {
    plan: &'a Plan,
    layout: Layout,
    program: &'a Arc<Diagram>,
    blocks: &'a [CompiledBlock],
    measured: &'a [(usize, Probe)],
}

impl Recording<'_> {
    fn worlds(
        &self,
        act: impl FnOnce(&mut LaneWorlds<Recorded>, &[Recorded]) -> Vec<Recorded>,
    ) -> Result<Program, Obstacle> {
        let (scene, layout) = (&self.plan.loaded.scene, self.layout);
        plant::worlds(&[&scene.model], self.plan.method, layout.given() - layout.acted(), act)
    }

    /// Runner in the state of the rows after the commands.
    fn runner(&self, rows: &[Recorded]) -> Runner<Recorded> {
        let (layout, mut runner) = (self.layout, Runner::<Recorded>::new(Arc::clone(self.program)));
        let at = |row: usize| row - layout.acted();
        let (signals, memory) = (&rows[at(layout.signals())..], &rows[at(layout.memory())..at(layout.finite())]);
        // constants stay what they are
        let mut is_constant = vec![false; layout.n_signals];
        for step in self.program.steps.iter().filter(|step| step.rate == Rate::Constant) {
            is_constant[step.out.clone()].fill(true);
        }
        for (k, signal) in runner.state.signals.iter_mut().enumerate().filter(|(k, _)| !is_constant[*k]) {
            *signal = signals[k];
        }
        runner.state.memory.copy_from_slice(memory);
        runner
    }

    /// For each block, true if it is evaluated at tick `tick`.
    fn due(&self, tick: u64) -> Vec<bool> {
        self.blocks.iter().map(|block| is_due(self.program.steps[block.step].rate, tick)).collect()
    }

    /// Commands, then the memory after base step `step` of an action.
    fn latch(&self, step: u64) -> Result<Program, Obstacle> {
        self.worlds(|worlds, rows| {
            let mut commands = worlds.view(false).commands.to_vec();
            for command in &self.program.commands {
                if !self.plan.own_commands().any(|own| own == command.terminal) {
                    commands[command.terminal] =
                        rows[self.layout.signals() - self.layout.acted() + command.signal.start];
                }
            }
            let memory = |tick: u64| {
                let mut runner = self.runner(rows);
                let t = tick as f64 * self.program.step;
                for block in self.blocks.iter().filter(|b| b.update.is_some()) {
                    if is_due(self.program.steps[block.step].rate, tick) {
                        runner.update_step(block.step, tick, t);
                    }
                }
                runner.state.memory
            };
            let later = memory(LATER_ACTION * self.plan.task.ticks + step);
            if step > 0 {
                return [commands, later].concat();
            }
            let count = rows[self.layout.count() - self.layout.acted()];
            let new = memory(0).into_iter().zip(later);
            commands.extend(new.map(|(first, later)| count.if_less(Recorded::splat(0.5), first, later)));
            commands
        })
    }

    /// Number that is 0 if all signals so far were finite, then the signals at tick `tick`.
    fn evaluate(&self, tick: u64) -> Result<Program, Obstacle> {
        let mut unknown = false;
        let program = self.worlds(|worlds, rows| {
            let mut runner = self.runner(rows);
            let seen = worlds.view(true);
            let view = View::of(&seen);
            for (at, probe) in self.measured {
                runner.state.signals[*at] = of_state(&view, *probe).unwrap_or_else(|| {
                    unknown = true;
                    Recorded::zero()
                });
            }
            let t = tick as f64 * self.program.step;
            for block in self.blocks.iter().filter(|b| is_due(self.program.steps[b.step].rate, tick)) {
                runner.evaluate_step(block.step, tick, t);
            }
            let signals = runner.state.signals;
            let finite = rows[self.layout.finite() - self.layout.acted()] + zero_if_finite(&signals);
            [vec![finite], signals].concat()
        })?;
        if unknown {
            return Err(Obstacle::new("a measurement is not a function of the state alone"));
        }
        Ok(program)
    }
}
