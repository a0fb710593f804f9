//! Compiled diagram: blocks in the order of evaluation, and the layout of signals and states.
//!
//! The signals stand in one vector, in the order of evaluation: what a block needs at once is always to the left of
//! what it gives, so that inputs can be read while outputs are written, without a copy.

use core::ops::Range;

use crate::block::{Memory, Node};
use crate::compile::{Diagnostic, EARLY, Flat, Interface, LATE};
use crate::instance::DynBlock;
use crate::unit::Unit;

/// Rate at which a block of a [`Program`] is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rate {
    /// Once, at the start of the run.
    Constant,
    /// At every tick and between ticks, wherever the integrator looks.
    Continuous,
    /// At every tick whose number is a multiple of this one; its outputs are held in between.
    Sampled(u64),
}

/// Block of a [`Program`] with its sizes and its ranges in the vectors of a [`State`](crate::runner::State).
#[derive(Clone, Debug)]
pub struct Step {
    /// Path of the block: names of the entries that lead to it, separated by `/`.
    pub path: String,
    /// Block with its parameters, from which instances are created.
    pub template: Box<dyn DynBlock>,
    /// Widths of the ports, sample time and seed.
    pub node: Node,
    /// Rate of evaluation.
    pub rate: Rate,
    /// First index and length of each input in the signals, in the order of the ports.
    pub ports: Vec<(u32, u32)>,
    /// Range of its outputs in the signals, port after port.
    pub out: Range<usize>,
    /// Range of its continuous states.
    pub states: Range<usize>,
    /// Range of its discrete states.
    pub memory: Range<usize>,
    /// Names of its output ports, in their order.
    pub output_names: Vec<String>,
    /// True if continuous states or continuous commands depend on it: it is then evaluated in minor steps too.
    pub is_minor: bool,
}

/// Measurement of the world that a [`Program`] reads; written into the signals by the program that runs it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measured {
    /// Index in [`Interface::measurements`].
    pub terminal: usize,
    /// Range of its components in the signals.
    pub out: Range<usize>,
    /// True if blocks that are evaluated in minor steps read it.
    pub is_minor: bool,
}

/// Command to the world that a [`Program`] gives; read from the signals by the program that runs it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Commanded {
    /// Index in [`Interface::commands`].
    pub terminal: usize,
    /// Range of its components in the signals.
    pub signal: Range<usize>,
    /// True if it changes between ticks.
    pub is_continuous: bool,
}

/// Compiled diagram, from [`compile`](crate::compile::compile): blocks in the order of evaluation, with the layout of
/// signals and states. Immutable; run by a [`Runner`](crate::runner::Runner).
#[derive(Clone, Debug)]
pub struct Program {
    /// Blocks in the order of evaluation.
    pub steps: Vec<Step>,
    /// Number of steps, from the first on, that do not depend on `late` measurements.
    pub n_early: usize,
    /// Measurements that depend on the state of the world alone.
    pub early: Vec<Measured>,
    /// Measurements that depend on the commands of the same instant, such as accelerations.
    pub late: Vec<Measured>,
    /// Commands that the diagram gives.
    pub commands: Vec<Commanded>,
    /// Output ports of inner diagrams: path and name, range in the signals.
    pub aliases: Vec<(String, Range<usize>)>,
    /// Units of the signal components; `None` where unknown.
    pub units: Vec<Option<Unit>>,
    /// Sample times in use, as numbers of base steps.
    pub periods: Vec<u64>,
    /// Number of signal components, the length of `State::signals`.
    pub n_signals: usize,
    /// Number of continuous states.
    pub n_states: usize,
    /// Number of discrete states.
    pub n_memory: usize,
    /// Base step `[s]`.
    pub step: f64,
}

impl Program {
    /// Lays out what the passes of the compiler found.
    pub(crate) fn assemble(
        flat: Flat,
        order: &[usize],
        rates: &[Rate],
        interface: &Interface,
    ) -> Result<Self, Vec<Diagnostic>> {
        let minor = between_ticks(&flat, order, rates);
        // where the outputs of every node begin, port by port
        let mut begins: Vec<Vec<usize>> = vec![Vec::new(); flat.nodes.len()];
        let mut n_signals = 0;
        for &n in order {
            for width in &flat.nodes[n].out_widths {
                begins[n].push(n_signals);
                n_signals += width.expect("widths are inferred");
            }
        }
        let measured = |n: usize| -> Vec<Measured> {
            let ports = flat.measurements[n].iter().enumerate();
            ports
                .map(|(port, &terminal)| {
                    let width = flat.nodes[n].out_widths[port].unwrap_or(0);
                    let reads = |m: &usize| flat.nodes[*m].inputs.iter().any(|i| (i.node, i.port) == (n, port));
                    let is_minor = minor_reads(&flat, &minor, rates, reads);
                    Measured { terminal, out: begins[n][port]..begins[n][port] + width, is_minor }
                })
                .collect()
        };
        let (early, late) = (measured(EARLY), measured(LATE));
        let place = |input: &crate::compile::Input| -> Range<usize> {
            let start = begins[input.node][input.port];
            match &input.range {
                Some(range) => start + range.start..start + range.end,
                None => start..start + flat.nodes[input.node].out_widths[input.port].unwrap_or(0),
            }
        };
        let aliases = flat.aliases.iter().map(|(name, input)| (name.clone(), place(input))).collect();
        let commands = flat.nodes[LATE].inputs.iter().zip(&flat.commands).map(|(input, &terminal)| Commanded {
            terminal,
            signal: place(input),
            is_continuous: rates[input.node] == Rate::Continuous && !interface.commands[terminal].is_special,
        });
        let commands = commands.collect();
        let n_early = order.iter().position(|&n| n == LATE).unwrap_or(order.len()) - 1;
        let ports: Vec<Vec<(u32, u32)>> = flat
            .nodes
            .iter()
            .map(|n| n.inputs.iter().map(place).map(|r| (r.start as u32, r.len() as u32)).collect())
            .collect();
        let mut program = Self {
            steps: Vec::with_capacity(order.len()),
            n_early,
            early,
            late,
            commands,
            aliases,
            units: Vec::new(),
            periods: Vec::new(),
            n_signals,
            n_states: 0,
            n_memory: 0,
            step: interface.step,
        };
        if n_signals > MAX_NUMBERS {
            let widest =
                (LATE + 1..flat.nodes.len()).max_by_key(|&n| flat.nodes[n].out_widths.iter().flatten().sum::<usize>());
            let node = &flat.nodes[widest.unwrap_or(LATE)];
            let message = format!("all signals together have {n_signals} components; {MAX_NUMBERS} are possible");
            let help = format!("the widest is that of `{}`", node.path);
            return Err(vec![Diagnostic { place: node.place.clone(), message, help }]);
        }
        program.units = vec![None; n_signals];
        for &n in order.iter().filter(|&&n| !flat.nodes[n].component_units.is_empty()) {
            let start = begins[n].first().copied().unwrap_or(0);
            let of_node = &flat.nodes[n].component_units;
            program.units[start..start + of_node.len()].clone_from_slice(of_node);
        }
        let mut problems = Vec::new();
        let mut nodes: Vec<Option<crate::compile::FlatNode>> = flat.nodes.into_iter().map(Some).collect();
        for &n in order.iter().filter(|&&n| n != EARLY && n != LATE) {
            let flat_node = nodes[n].take().expect("every node is ordered once");
            let template = flat_node.template.expect("a block, not the world");
            let widths = |list: &[Option<usize>]| list.iter().map(|w| w.unwrap_or(0)).collect::<Vec<_>>();
            let every = if let Rate::Sampled(every) = rates[n] { every } else { 1 };
            let node = Node {
                inputs: ports[n].iter().map(|p| p.1 as usize).collect(),
                outputs: widths(&flat_node.out_widths),
                step: interface.step,
                every,
                seed: seed_of(interface.seed, &flat_node.path),
            };
            if let Err((message, help)) = template.check(&node) {
                let message = format!("`{}`: {message}", flat_node.path);
                problems.push(Diagnostic { place: flat_node.place, message, help });
                continue;
            }
            let Memory { continuous, discrete } = template.memory(&node);
            let numbers = n_signals + program.n_states + program.n_memory;
            if continuous.saturating_add(discrete).saturating_add(numbers) > MAX_NUMBERS {
                let own = continuous.saturating_add(discrete);
                let message = format!("`{}` keeps {own} numbers; a diagram may have {MAX_NUMBERS}", flat_node.path);
                let help = "delay by fewer samples, or a narrower signal".to_owned();
                problems.push(Diagnostic { place: flat_node.place, message, help });
                continue;
            }
            let start = begins[n].first().copied().unwrap_or(0);
            if !program.periods.contains(&every) {
                program.periods.push(every);
            }
            program.steps.push(Step {
                path: flat_node.path,
                out: start..start + node.n_out(),
                node,
                rate: rates[n],
                ports: ports[n].clone(),
                states: program.n_states..program.n_states + continuous,
                memory: program.n_memory..program.n_memory + discrete,
                output_names: flat_node.output_names,
                is_minor: minor[n],
                template,
            });
            program.n_states += continuous;
            program.n_memory += discrete;
        }
        if problems.is_empty() { Ok(program) } else { Err(problems) }
    }

    /// Paths of the blocks, in the order of evaluation.
    #[must_use]
    pub fn order(&self) -> Vec<&str> {
        self.steps.iter().map(|step| step.path.as_str()).collect()
    }

    /// Outputs of all blocks in the order of evaluation, then those of inner diagrams: name (`block`, or `block.port`
    /// where there are several), range in the signals, units of the components.
    pub fn outputs(&self) -> impl Iterator<Item = (String, Range<usize>, &[Option<Unit>])> {
        let of_diagrams = self.aliases.iter().cloned();
        let of_blocks = self.steps.iter().flat_map(|step| {
            let mut start = step.out.start;
            step.output_names.iter().zip(&step.node.outputs).map(move |(port, width)| {
                let name = match step.output_names.len() {
                    1 => step.path.clone(),
                    _ => format!("{}.{port}", step.path),
                };
                let range = start..start + width;
                start = range.end;
                (name, range)
            })
        });
        of_blocks.chain(of_diagrams).map(|(name, range)| (name, range.clone(), &self.units[range]))
    }

    /// Next time event: the first instant after `t` `[s]` at which a function of time that is evaluated between ticks
    /// has a jump or a corner; infinite if there is none.
    #[must_use]
    pub fn next_time_event(&self, t: f64) -> f64 {
        let minor = self.steps.iter().filter(|step| step.is_minor);
        minor.fold(f64::INFINITY, |first, step| first.min(step.template.next_time_event(t)))
    }

    /// Returns true if anything changes between ticks: a continuous state, a continuous command, an event of a block.
    #[must_use]
    pub fn is_continuous(&self) -> bool {
        let has_events = self.steps.iter().any(|step| step.template.zero_crossing_count().is_some());
        has_events || self.n_states > 0 || self.commands.iter().any(|c| c.is_continuous)
    }
}

/// Signals, states and memory of a diagram together: 400 MB.
const MAX_NUMBERS: usize = 50_000_000;

/// Returns true if a node that `reads` is evaluated in minor steps, has continuous states, or is the world that takes
/// commands.
fn minor_reads(flat: &Flat, minor: &[bool], rates: &[Rate], reads: impl Fn(&usize) -> bool) -> bool {
    (0..flat.nodes.len()).filter(|n| reads(n)).any(|n| n == LATE || minor[n] || has_states(flat, rates, n))
}

fn has_states(flat: &Flat, rates: &[Rate], n: usize) -> bool {
    let template = flat.nodes[n].template.as_ref();
    rates[n] == Rate::Continuous
        && template.is_some_and(|t| t.sample_time_kind() == crate::block::SampleTimeKind::Continuous)
}

/// Nodes that the integrator needs: continuous ones that continuous states or the world's commands depend on.
fn between_ticks(flat: &Flat, order: &[usize], rates: &[Rate]) -> Vec<bool> {
    let mut needed = vec![false; flat.nodes.len()];
    for n in 0..flat.nodes.len() {
        if n == LATE || has_states(flat, rates, n) {
            for input in &flat.nodes[n].inputs {
                needed[input.node] = true;
            }
        }
    }
    for &n in order.iter().rev() {
        if needed[n] && rates[n] == Rate::Continuous && n != LATE {
            for (k, input) in flat.nodes[n].inputs.iter().enumerate() {
                needed[input.node] |= flat.has_direct_feedthrough(n, k);
            }
        }
    }
    (0..flat.nodes.len()).map(|n| needed[n] && rates[n] == Rate::Continuous && n > LATE).collect()
}

/// Seed of a random element, derived from the seed of the run and the path of the element (FNV-1a): independent streams
/// for different paths.
#[must_use]
pub fn seed_of(seed: u64, path: &str) -> u64 {
    path.bytes()
        .fold(seed ^ 0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
