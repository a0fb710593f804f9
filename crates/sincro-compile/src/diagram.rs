//! Programs of a diagram's blocks: one for the outputs of each, one for its discrete states.
//!
//! Blocks are recorded one by one, so that what runs at different rates stays apart and the code of each can be read.
//! A block may look at tick and time, which are no recorded numbers: it is recorded at several ticks, and the programs
//! must be equal. Exceptions are the first tick, which may have a program of its own, and sources: their outputs are
//! inputs of the compiled diagram.

use sincro_blocks::block::Memory;
use sincro_blocks::program::{Program as Diagram, Rate, Step};
use sincro_blocks::runner::Runner;
use sincro_math::record::{Program, Recorded, Unrecordable, record};
use sincro_scene::diagram::{Wiring, is_known_at_ticks_only};
use sincro_scene::record::Probe;

use std::sync::Arc;

use crate::Obstacle;

/// Diagram as straight-line programs. Inputs of every program are all signals of the diagram, then all of its discrete
/// states; a program reads few of them.
#[derive(Clone, Debug)]
pub struct CompiledDiagram {
    /// Blocks in the order of evaluation; constants are not among them.
    pub blocks: Vec<CompiledBlock>,
    /// Initial signals: constants, and zero for all else.
    pub signals: Vec<f64>,
    /// Initial discrete states.
    pub memory: Vec<f64>,
}

/// Block of a [`CompiledDiagram`].
#[derive(Clone, Debug)]
pub struct CompiledBlock {
    /// Index among the diagram's steps.
    pub step: usize,
    /// Outputs.
    pub output: Computed,
    /// Discrete states of the next tick; none if the block has none.
    pub update: Option<ByTick>,
}

impl CompiledBlock {
    /// All programs of the block.
    pub fn programs(&self) -> impl Iterator<Item = &Program> {
        let output = match &self.output {
            Computed::Program(by_tick) => Some(by_tick),
            Computed::Source => None,
        };
        let both = output.into_iter().chain(&self.update);
        both.flat_map(|by_tick| by_tick.first.iter().chain([&by_tick.later]))
    }
}

/// Origin of a block's outputs.
#[derive(Clone, Debug)]
pub enum Computed {
    /// A source: who runs the diagram writes them.
    Source,
    /// A program.
    Program(ByTick),
}

/// Program at every tick but the first, and that of the first if it is another.
#[derive(Clone, Debug)]
pub struct ByTick {
    /// Program at the first tick, where it differs.
    pub first: Option<Program>,
    /// Program at every later tick, or at every tick.
    pub later: Program,
}

impl ByTick {
    /// Program of tick `tick`.
    #[must_use]
    pub fn at(&self, tick: u64) -> &Program {
        self.first.as_ref().filter(|_| tick == 0).unwrap_or(&self.later)
    }
}

/// Ticks, in samples of a block, at which it is recorded: the first, some near it, and some without pattern.
const SAMPLES: [u64; 8] = [0, 1, 2, 3, 10, 1_237, 100_003, 7_654_321];

/// Compiles a diagram.
///
/// # Errors
///
/// [`Obstacle`] that names the block, if one is continuous, branches, or depends on time.
pub fn compile(diagram: &Arc<Diagram>) -> Result<CompiledDiagram, Obstacle> {
    acts_at_ticks_alone(diagram)?;
    let start = Runner::<f64>::new(Arc::clone(diagram));
    let mut blocks = Vec::new();
    for (k, step) in diagram.steps.iter().enumerate() {
        let why = |reason: String| Obstacle::new(format!("block {}: {reason}", named(step)));
        // what nothing needs between the steps is evaluated at each of them
        if step.rate == Rate::Constant {
            continue;
        }
        let is_source = step.ports.is_empty();
        let output = if is_source {
            Computed::Source
        } else {
            Computed::Program(by_tick(diagram, k, Verb::Output).map_err(why)?)
        };
        let has_memory = !is_source && step.template.memory(&step.node) != Memory::NONE;
        let update = if has_memory { Some(by_tick(diagram, k, Verb::Update).map_err(why)?) } else { None };
        blocks.push(CompiledBlock { step: k, output, update });
    }
    let state = start.state;
    Ok(CompiledDiagram { blocks, signals: state.signals, memory: state.memory })
}

/// Refuses a diagram that acts between the steps, with the blocks because of which it does.
fn acts_at_ticks_alone(diagram: &Diagram) -> Result<(), Obstacle> {
    let list = |found: Vec<&Step>| found.into_iter().map(named).collect::<Vec<_>>().join(", ");
    let with_states: Vec<&Step> = diagram.steps.iter().filter(|step| !step.states.is_empty()).collect();
    if !with_states.is_empty() {
        let reason = "continuous states: take discrete blocks in their place, and a `sample_time` for the others";
        return Err(Obstacle::new(format!("of the diagram {} have {reason}", list(with_states))));
    }
    let is_minor = |step: &&Step| step.rate == Rate::Continuous && step.is_minor;
    let minor: Vec<&Step> = diagram.steps.iter().filter(is_minor).collect();
    if !minor.is_empty() {
        let reason = "act between the steps: with a `sample_time`, their own or the diagram's, they are sampled";
        return Err(Obstacle::new(format!("of the diagram {} {reason}", list(minor))));
    }
    Ok(())
}

/// Path and kind of a block.
fn named(step: &Step) -> String {
    format!("`{}` ({})", step.path, kind(step))
}

/// Measurements of a diagram at ticks: the index of each among the signals, and its probe.
///
/// # Errors
///
/// [`Obstacle`] if the diagram measures what the state at the tick does not decide.
pub fn measurements(wiring: &Wiring) -> Result<Vec<(usize, Probe)>, Obstacle> {
    if !wiring.late.is_empty() {
        return Err(Obstacle::new("the controller measures accelerations or motor torques"));
    }
    let readings: Vec<(usize, Probe)> = (wiring.early.iter())
        .flat_map(|reading| reading.probes.iter().enumerate().map(|(k, probe)| (reading.at + k, *probe)))
        .collect();
    if readings.iter().any(|(_, probe)| is_known_at_ticks_only(*probe)) {
        return Err(Obstacle::new("the controller measures a sensor, a contact, or a mean over the step"));
    }
    Ok(readings)
}

/// Returns true if a block of the rate `rate` is evaluated at tick `tick`.
#[must_use]
pub fn is_due(rate: Rate, tick: u64) -> bool {
    match rate {
        Rate::Constant => false,
        Rate::Continuous => true,
        Rate::Sampled(every) => tick.is_multiple_of(every),
    }
}

/// Name of a block's kind.
fn kind(step: &Step) -> &'static str {
    step.template.kind().name
}

#[derive(Clone, Copy)]
enum Verb {
    Output,
    Update,
}

/// Records one verb of step `k` at several ticks.
fn by_tick(diagram: &Arc<Diagram>, k: usize, verb: Verb) -> Result<ByTick, String> {
    let every = match diagram.steps[k].rate {
        Rate::Sampled(every) => every,
        _ => 1,
    };
    let at = |sample: u64| recorded(diagram, k, verb, sample * every).map_err(|why| why.to_string());
    let (first, later) = (at(SAMPLES[0])?, at(SAMPLES[1])?);
    for sample in &SAMPLES[2..] {
        if at(*sample)? != later {
            return Err("what it does depends on time".to_owned());
        }
    }
    Ok(ByTick { first: (first != later).then_some(first), later })
}

fn recorded(diagram: &Arc<Diagram>, k: usize, verb: Verb, tick: u64) -> Result<Program, Unrecordable> {
    record(diagram.n_signals + diagram.n_memory, 1, |inputs| {
        let mut runner = Runner::<Recorded>::new(Arc::clone(diagram));
        let (signals, memory) = inputs.split_at(diagram.n_signals);
        runner.state.signals.copy_from_slice(signals);
        runner.state.memory.copy_from_slice(memory);
        let (step, t) = (&diagram.steps[k], tick as f64 * diagram.step);
        match verb {
            Verb::Output => {
                runner.evaluate_step(k, tick, t);
                runner.state.signals[step.out.clone()].to_vec()
            }
            Verb::Update => {
                runner.update_step(k, tick, t);
                runner.state.memory[step.memory.clone()].to_vec()
            }
        }
    })
}
