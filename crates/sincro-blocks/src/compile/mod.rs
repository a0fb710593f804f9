//! From a drawn diagram to a program: names resolved, sizes and units inferred, sample times settled, order found.
//!
//! The passes, each in its file: `flatten` (sub-diagrams dissolve into blocks with paths), `widths`, `rates`, `order`
//! (with the algebraic loops), `units`. All problems of a pass are reported at once; a pass that needs the one before
//! is not begun after an error.

mod deduced_units;
mod flatten;
mod order;
mod rates;
mod units;
mod widths;

use core::fmt;

use crate::diagram::Diagram;
use crate::program::Program;
use crate::unit::Unit;

/// Surroundings of a diagram for [`compile`]: base step, seed, and the ports of the world that its wires may reach.
///
/// ```
/// use sincro_blocks::compile::Terminal;
/// use sincro_blocks::library::maths::Gain;
/// use sincro_blocks::prelude::*;
///
/// // the world: an angle to measure, a torque to command
/// let terminal = |name: &str| Terminal { names: vec![name.into()], width: 1, unit: None, is_special: false };
/// let mut world = Interface::new(0.001);
/// world.measurements.push(terminal("/hinge.position"));
/// world.commands.push(terminal("/hinge"));
/// let mut diagram = Diagram::new();
/// diagram.block("spring", Gain::new(-20.0)).wire("/hinge.position", "spring").wire("spring", "/hinge");
/// assert!(compile(&diagram, &world).is_ok());
/// // without a world there are no such ports
/// assert_eq!(compile(&diagram, &Interface::new(0.001)).unwrap_err().len(), 2);
/// ```
#[derive(Clone, Debug)]
pub struct Interface {
    /// Base step `[s]`.
    pub step: f64,
    /// Seed of the run, from which those of all random blocks are derived.
    pub seed: u64,
    /// Measurements, outputs of the world that the diagram can read. [`Measured::terminal`](crate::program::Measured)
    /// counts them.
    pub measurements: Vec<Terminal>,
    /// Commands, inputs of the world that the diagram can set. [`Commanded::terminal`](crate::program::Commanded)
    /// counts them.
    pub commands: Vec<Terminal>,
}

impl Interface {
    /// Interface without ports, for a diagram alone, with the base step `step` `[s]` and seed 0.
    #[must_use]
    pub fn new(step: f64) -> Self {
        Self { step, seed: 0, measurements: Vec::new(), commands: Vec::new() }
    }
}

/// Port of the world in an [`Interface`]: a measurement or a command.
#[derive(Clone, Debug, PartialEq)]
pub struct Terminal {
    /// Names under which wires find it, the first one being its own, such as `/hinge.position`.
    pub names: Vec<String>,
    /// Number of components.
    pub width: usize,
    /// Unit of all components; `None` if it has none.
    pub unit: Option<Unit>,
    /// True of a measurement that depends on the commands of the same instant, as an acceleration does; true of a
    /// command that is taken at ticks only and held, as the velocity of an ideal motor is.
    pub is_special: bool,
}

/// Place of a [`Diagnostic`] in nested diagrams.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Names of the entries that lead to the diagram, outermost first; empty for the outermost diagram.
    pub diagram: Vec<String>,
    /// Element of that diagram.
    pub element: Element,
}

/// Element of a diagram that a [`Diagnostic`] is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Element {
    /// Entry with this name.
    Entry(String),
    /// Sample time of the entry with this name.
    SampleTime(String),
    /// Unit of the entry with this name.
    Unit(String),
    /// Source of the wire of this index in `Diagram::wires`.
    From(usize),
    /// Target of the wire of this index in `Diagram::wires`.
    To(usize),
    /// Port of the diagram with this name.
    Port(String),
}

/// Error of a diagram, with its place and a help; part of a [`CompileError`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Place in the diagram.
    pub place: Place,
    /// Description of the error.
    pub message: String,
    /// Suggested correction.
    pub help: String,
}

/// Error of [`compile`]: all errors of a diagram that one pass of the compiler found; never empty.
///
/// ```
/// use sincro_blocks::library::maths::{Gain, Sum};
/// use sincro_blocks::prelude::*;
///
/// // y = u − 2 y: the blocks need each other's present output
/// let mut diagram = Diagram::new();
/// diagram.block("u", sincro_blocks::library::sources::Constant::new(1.0));
/// diagram.block("sum", Sum::new("+-")).block("gain", Gain::new(2.0));
/// diagram.wire("u", "sum.u1").wire("sum", "gain").wire("gain", "sum.u2");
/// let error = compile(&diagram, &Interface::new(0.001)).unwrap_err();
/// assert!(error.len() == 1 && error[0].message.contains("algebraic loop"), "{error}");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompileError(pub Vec<Diagnostic>);

impl core::ops::Deref for CompileError {
    type Target = [Diagnostic];

    fn deref(&self) -> &[Diagnostic] {
        &self.0
    }
}

impl IntoIterator for CompileError {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl From<Vec<Diagnostic>> for CompileError {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Self(diagnostics)
    }
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, diagnostic) in self.0.iter().enumerate() {
            write!(f, "{}{diagnostic}", if k == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}

impl std::error::Error for CompileError {}

impl std::error::Error for Diagnostic {}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\nhelp: {}", self.message, self.help)
    }
}

/// Compiles a diagram: resolves names, infers widths and units, finds the order of evaluation and the rates. The result
/// is run by a [`Runner`](crate::runner::Runner).
///
/// # Errors
///
/// [`CompileError`] with everything that one pass found wrong: names, widths, algebraic loops, sample times, units.
///
/// ```
/// use sincro_blocks::library::continuous::Integrator;
/// use sincro_blocks::library::sources::Constant;
/// use sincro_blocks::prelude::*;
///
/// let mut diagram = Diagram::new();
/// diagram.block("speed", Constant::new(2.0)).block("distance", Integrator::new(0.0)).wire("speed", "distance");
/// let program = compile(&diagram, &Interface::new(0.001))?;
/// assert!(program.is_continuous());
/// assert_eq!(program.order(), ["speed", "distance"]);
/// # Ok::<(), CompileError>(())
/// ```
pub fn compile(diagram: &Diagram, interface: &Interface) -> Result<Program, CompileError> {
    let mut flat = flatten::flatten(diagram, interface)?;
    widths::infer(&mut flat)?;
    let order = order::order(&flat)?;
    let rates = rates::infer(&flat, &order, interface.step)?;
    units::infer(&mut flat, &order)?;
    Ok(Program::assemble(flat, &order, &rates, interface)?)
}

/// A diagram without inner diagrams. Node 0 is the world's measurements, node 1 those that depend on its commands.
#[derive(Debug)]
pub(crate) struct Flat {
    pub nodes: Vec<FlatNode>,
    /// The measurements in use: number of the terminal in the interface, by output port of node 0 and 1.
    pub measurements: [Vec<usize>; 2],
    /// The commands in use: number of the terminal, by input port of node 1.
    pub commands: Vec<usize>,
    /// Output ports of inner diagrams and what they give, where that is an output of one block.
    pub aliases: Vec<(String, Input)>,
}

/// The world's measurements that depend on its state alone.
pub(crate) const EARLY: usize = 0;
/// The world: takes the commands, gives what depends on them at once.
pub(crate) const LATE: usize = 1;

#[derive(Debug)]
pub(crate) struct FlatNode {
    /// Names of all entries that lead to it, with `/` between them.
    pub path: String,
    pub place: Place,
    /// None for the world.
    pub template: Option<Box<dyn crate::instance::DynBlock>>,
    /// Sample time `[s]`; true if it is inherited from a diagram around it.
    pub sample_time: Option<(f64, bool)>,
    /// Declared units: one of all components of the outputs, or one of each.
    pub unit: Vec<String>,
    pub inputs: Vec<Input>,
    pub input_names: Vec<String>,
    pub output_names: Vec<String>,
    pub in_widths: Vec<Option<usize>>,
    pub out_widths: Vec<Option<usize>>,
    /// Units of the world's commands; empty for blocks.
    pub in_units: Vec<Option<Unit>>,
    /// Units of the world's measurements; empty for blocks.
    pub out_units: Vec<Option<Unit>>,
    /// Units of the components of all outputs, one after the other; empty if the diagram is too wide.
    pub component_units: Vec<Option<Unit>>,
}

/// Source of an input.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    pub node: usize,
    pub port: usize,
    pub range: Option<core::ops::Range<usize>>,
    /// The wire's end, for messages.
    pub place: Place,
}

impl Flat {
    /// `block.port`, or `block` if it has but one output.
    pub fn output_name(&self, node: usize, port: usize) -> String {
        let n = &self.nodes[node];
        match (node, n.output_names.len()) {
            (EARLY | LATE, _) if n.output_names[port].starts_with('/') => n.output_names[port].clone(),
            (EARLY | LATE, _) => format!("{}.{}", n.path, n.output_names[port]),
            (_, 1) => n.path.clone(),
            _ => format!("{}.{}", n.path, n.output_names[port]),
        }
    }

    /// `block.port`, or `block` if it has but one input.
    pub fn input_name(&self, node: usize, port: usize) -> String {
        let n = &self.nodes[node];
        match (node, n.input_names.len()) {
            (EARLY | LATE, _) => n.input_names[port].clone(),
            (_, 1) => n.path.clone(),
            _ => format!("{}.{}", n.path, n.input_names[port]),
        }
    }

    pub fn has_direct_feedthrough(&self, node: usize, input: usize) -> bool {
        self.nodes[node].template.as_ref().is_none_or(|t| t.has_direct_feedthrough(input))
    }
}

/// `a`, `b` and `c`; of many the first.
pub(crate) fn listed(names: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    const SHOWN: usize = 16;
    let mut names = names.into_iter();
    let quoted: Vec<String> = names.by_ref().take(SHOWN).map(|n| format!("`{}`", n.as_ref())).collect();
    let n_more = names.count();
    if n_more > 0 {
        return format!("{} and {n_more} more", quoted.join(", "));
    }
    match quoted.split_last() {
        None => "none".into(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::continuous::Integrator;
    use crate::library::discrete::UnitDelay;
    use crate::library::maths::{Gain, Sum};
    use crate::library::sources::Constant;
    use crate::simulator::Simulator;

    fn problems(diagram: &Diagram) -> Vec<String> {
        compile(diagram, &Interface::new(0.001)).unwrap_err().iter().map(ToString::to_string).collect()
    }

    fn decay() -> Diagram {
        let mut d = Diagram::new();
        d.block("target", Constant::new(1.0)).block("error", Sum::new("+-")).block("rate", Gain::new(2.0));
        d.block("x", Integrator::new(0.0));
        d.wire("target", "error.u1").wire("error", "rate").wire("rate", "x").wire("x", "error.u2");
        d
    }

    #[test]
    fn first_order_lag_follows_its_exponential() {
        let mut simulator = Simulator::new(&decay(), 0.01).unwrap();
        let x = simulator.record("x", 100);
        let exact = 1.0 - sincro_math::elementary::exp(-2.0).0;
        assert!((x[100] - exact).abs() < 1e-9, "{} {exact}", x[100]);
    }

    #[test]
    fn an_algebraic_loop_is_printed_whole() {
        let mut d = Diagram::new();
        d.block("a", Sum::new("+-"))
            .block("b", Gain::new(2.0))
            .block("c", Gain::new(2.0))
            .block("one", Constant::new(1.0));
        d.wire("one", "a.u1").wire("c", "a.u2").wire("a", "b").wire("b", "c");
        let found = problems(&d);
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("algebraic loop: a -> b -> c -> a"), "{}", found[0]);
        // a delay breaks it
        d.wires.pop();
        d.block("delay", UnitDelay::new(0.0)).wire("b", "delay").wire("delay", "c");
        assert!(compile(&d, &Interface::new(0.001)).is_ok());
    }

    #[test]
    fn an_open_input_an_unknown_block_and_two_wires_are_found_together() {
        let mut d = Diagram::new();
        d.block("one", Constant::new(1.0)).block("gain", Gain::new(2.0));
        d.wire("one", "gain").wire("one", "gain").wire("on", "gain.v").wire("gain.x", "gian");
        let found = problems(&d).join("\n");
        for part in [
            "two wires go into `gain`",
            "there is no block `on`\nhelp: did you mean `one`?",
            "`gain` has no input `v`",
            "`gain` has no output `x`",
            "there is no block `gian`\nhelp: did you mean `gain`?",
        ] {
            assert!(found.contains(part), "{part} in {found}");
        }
        let mut d = Diagram::new();
        d.block("gain", Gain::new(2.0)).block("sum", Sum::new("++")).wire("gain", "sum.u1");
        let found = problems(&d).join("\n");
        assert!(
            found.contains("the input of `gain` is not connected") && found.contains("the input `u2` of `sum`"),
            "{found}"
        );
    }

    #[test]
    fn sizes_that_do_not_fit_name_both_ends() {
        let mut d = Diagram::new();
        d.block("a", Constant { value: vec![1.0, 2.0] }).block("b", Constant { value: vec![1.0, 2.0, 3.0] });
        d.block("sum", Sum::new("++")).wire("a", "sum.u1").wire("b", "sum.u2");
        let found = problems(&d).join("\n");
        assert!(found.contains("`u1` gets 2 from `a`, `u2` gets 3 from `b`"), "{found}");
        d.wires.clear();
        d.wire("a[0:1]", "sum.u1").wire("b[3]", "sum.u2");
        let found = problems(&d).join("\n");
        assert!(found.contains("`b` has 3 components: there is no [3]"), "{found}");
    }

    #[test]
    fn sample_times_are_multiples_of_the_step() {
        let mut d = Diagram::new();
        d.sampled("one", 0.0015, UnitDelay::new(0.0)).wire("one", "one");
        let found = problems(&d).join("\n");
        assert!(found.contains("0.0015 s of `one` is no multiple of the base step 0.001 s"), "{found}");
        assert!(found.contains("use 0.001 s or 0.002 s"), "{found}");
        let mut d = decay();
        d.entries[3].sample_time = Some(0.002);
        assert!(problems(&d)[0].contains("`x` is a continuous block"), "{:?}", problems(&d));
    }

    #[test]
    fn inner_diagrams_dissolve() {
        let mut lag = Diagram { inputs: vec!["r".into()], outputs: vec!["out".into()], ..Diagram::new() };
        lag.block("error", Sum::new("+-")).block("x", Integrator::new(0.0));
        lag.wire("r", "error.u1").wire("x", "error.u2").wire("error", "x").wire("x", "out");
        let mut d = Diagram::new();
        d.block("one", Constant { value: vec![1.0, 3.0] });
        d.diagram("first", lag.clone(), None).diagram("second", lag, None);
        d.block("both", Gain::new(1.0));
        d.wire("one[1]", "first").wire("first", "second").wire("[first, second.out]", "both");
        let mut simulator = Simulator::new(&d, 0.01).unwrap();
        assert_eq!(
            simulator.runner.program().order(),
            ["one", "first/x", "first/error", "second/x", "second/error", "[both]", "both"]
        );
        simulator.record("both", 2000);
        assert!((simulator.output("both")[1] - 3.0).abs() < 1e-6);
        // an inner diagram's output goes by its own name too
        assert_eq!(simulator.output("second"), simulator.output("second/x"));
    }

    #[test]
    fn a_sampled_block_holds_between_its_ticks() {
        let mut d = Diagram::new();
        d.block("one", Constant::new(1.0)).block("x", Integrator::new(0.0)).sampled("held", 0.004, Gain::new(1.0));
        d.wire("one", "x").wire("x", "held");
        let held = Simulator::new(&d, 0.001).unwrap().record("held", 8);
        assert_eq!(held.iter().map(|x| (x * 1000.0).round()).collect::<Vec<_>>(), [0., 0., 0., 0., 4., 4., 4., 4., 8.]);
    }

    #[test]
    fn units_are_compared_where_they_are_known() {
        let mut d = Diagram::new();
        d.block("a", Constant::new(1.0)).block("b", Constant::new(1.0)).block("sum", Sum::new("++"));
        d.wire("a", "sum.u1").wire("b", "sum.u2");
        d.entries[0].unit = vec!["rad".into()];
        assert!(compile(&d, &Interface::new(0.001)).is_ok());
        d.entries[1].unit = vec!["deg".into()];
        assert!(
            problems(&d)[0].contains("units do not fit in `sum`: rad and deg are not the same"),
            "{:?}",
            problems(&d)
        );
    }

    #[test]
    fn what_feeds_commands_alone_is_in_their_unit() {
        let terminal = |name: &str, unit: &str| {
            let unit = (!unit.is_empty()).then(|| Unit::parse(unit).unwrap());
            Terminal { names: vec![name.into()], width: 1, unit, is_special: false }
        };
        let mut world = Interface::new(0.001);
        world.commands =
            vec![terminal("/a", "rad/s"), terminal("/b", "rad/s"), terminal("/c", "N·m"), terminal("/d", "")];
        let mut d = Diagram::new();
        let pair = || Constant { value: vec![1.0, 2.0] };
        d.block("same", pair()).block("other", pair()).block("none", Constant::new(1.0));
        d.wire("same[0]", "/a").wire("same[1]", "/b").wire("none", "/d").wire("other[0]", "/c");
        let units = |d: &Diagram, name: &str| -> Vec<String> {
            let program = compile(d, &world).unwrap();
            let range = program.outputs().find(|(path, ..)| path == name).unwrap().1;
            program.units[range].iter().map(|unit| unit.as_ref().map_or("", |u| u.text()).to_owned()).collect()
        };
        assert_eq!(units(&d, "same"), ["rad/s", "rad/s"]);
        assert_eq!(units(&d, "none"), [""]);
        assert_eq!(units(&d, "other"), ["N·m", ""]);
        d.wires.pop();
        d.wires.remove(1);
        d.wire("other[0]", "/c").wire("other[1]", "/b");
        assert_eq!(units(&d, "other"), ["N·m", "rad/s"]);
    }
}
