//! What a block is: ports, state and equations, written once over [`Real`].
//!
//! Every block has the same verbs. Before a run: [`Block::ports`], [`Block::widths`], [`Block::memory`], [`Block::start`]. In a
//! run: [`Block::output`] gives the outputs, [`Block::slope`] the rates of the continuous states, [`Block::update`] the memory
//! after a tick. No verb but `update` changes state, and no verb allocates.
//!
//! A block of one's own needs a struct of its parameters, a description, and the verbs that are not the default:
//!
//! ```
//! use sincro_blocks::block::{At, Block, Ports, elementwise};
//! use sincro_blocks::compile::{Interface, compile};
//! use sincro_blocks::diagram::Diagram;
//! use sincro_blocks::kind::{Described, Group, Kind, Parameter, Takes};
//! use sincro_blocks::library::sources::Constant;
//! use sincro_blocks::reader::Reader;
//! use sincro_math::Real;
//!
//! /// A spring that hardens: y = stiffness·u + cubic·u³.
//! #[derive(Clone, Debug)]
//! struct HardSpring {
//!     stiffness: f64,
//!     cubic: f64,
//! }
//!
//! impl Described for HardSpring {
//!     const KIND: &'static Kind = &Kind {
//!         name: "hard-spring",
//!         group: Group::Nonlinear,
//!         summary: "A spring that hardens.",
//!         equation: "y = stiffness·u + cubic·u³",
//!         parameters: &[
//!             Parameter::required("stiffness", Takes::Number, "[N·m/rad]"),
//!             Parameter::optional("cubic", Takes::Number, "[N·m/rad³]", "0"),
//!         ],
//!     };
//!
//!     fn read(p: &mut Reader<'_>) -> Self {
//!         Self { stiffness: p.number("stiffness"), cubic: p.number("cubic") }
//!     }
//! }
//!
//! impl Block for HardSpring {
//!     type Work<R: Real> = ();
//!
//!     fn ports(&self) -> Ports {
//!         Ports::single()
//!     }
//!
//!     fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
//!         Ok(vec![elementwise(inputs, &[])?])
//!     }
//!
//!     fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
//!         for (i, y) in y.iter_mut().enumerate() {
//!             let u = at.component(0, i);
//!             *y = R::splat(self.stiffness) * u + R::splat(self.cubic) * u * u * u;
//!         }
//!     }
//! }
//!
//! let mut diagram = Diagram::new();
//! diagram.block("angle", Constant::new(2.0)).block("spring", HardSpring { stiffness: 1.0, cubic: 0.5 });
//! diagram.wire("angle", "spring");
//! assert_eq!(compile(&diagram, &Interface::new(0.001)).unwrap().order(), ["angle", "spring"]);
//! ```

use core::fmt::Debug;

use sincro_math::Real;

use crate::unit::Unit;

/// A block: an immutable set of parameters with its equations. All that changes is in the state that it is handed.
pub trait Block: Clone + Debug + Send + Sync + 'static {
    /// Memory for intermediate results, such as the stack of a formula; its content never matters. `()` for most blocks.
    type Work<R: Real>: Clone + Debug + Default + Send + Sync;

    /// Names of the inputs and outputs.
    fn ports(&self) -> Ports;

    /// Widths of the outputs, as far as they follow from the parameters and the widths of the inputs that are known so far (`None`:
    /// not yet).
    ///
    /// # Errors
    ///
    /// Widths that do not fit each other, in words.
    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String>;

    /// Units of the outputs, as far as they follow from the units of the inputs that are known.
    ///
    /// # Errors
    ///
    /// Units that do not fit each other, in words.
    fn units(&self, _inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(vec![None; self.ports().outputs.len()])
    }

    /// When it is evaluated.
    fn pace(&self) -> Pace {
        Pace::Any
    }

    /// Whether the outputs depend at once on this input. An input that does not feed through breaks algebraic loops.
    fn feeds_through(&self, _input: usize) -> bool {
        true
    }

    /// How many numbers it keeps.
    fn memory(&self, _node: &Node) -> Memory {
        Memory::default()
    }

    /// Checks what only the compiled diagram tells, such as a delay against the base step.
    ///
    /// # Errors
    ///
    /// What is wrong and what would mend it.
    fn check(&self, _node: &Node) -> Result<(), (String, String)> {
        Ok(())
    }

    /// Writes the initial continuous states and memory (both zero before).
    fn start<R: Real>(&self, _node: &Node, _states: &mut [R], _memory: &mut [R]) {}

    /// Memory for intermediate results.
    fn work<R: Real>(&self) -> Self::Work<R> {
        Self::Work::default()
    }

    /// The outputs, one after the other in `y`. May read only inputs that feed through.
    fn output<R: Real>(&self, at: &At<'_, R>, work: &mut Self::Work<R>, y: &mut [R]);

    /// Rates of the continuous states.
    fn slope<R: Real>(&self, _at: &At<'_, R>, _work: &mut Self::Work<R>, _slope: &mut [R]) {}

    /// −∂slopeᵢ/∂stateᵢ, the rate at which each state decays by itself [1/s]: implicit methods take it at the new state, and
    /// what is too fast for an explicit method is told by it.
    fn decay<R: Real>(&self, _at: &At<'_, R>, _decay: &mut [R]) {}

    /// After all outputs of a tick are known: the memory for the next one. `memory` holds the present one, `states` the continuous
    /// states, which may be set too (a reset); `at.states` is empty here.
    fn update<R: Real>(&self, _at: &At<'_, R>, _work: &mut Self::Work<R>, _memory: &mut [R], _states: &mut [R]) {}

    /// The first instant after `t` at which the outputs jump or have a corner, if that depends on time alone.
    fn next_corner(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// Why its outputs are not finite, if it knows more than they tell.
    fn fault(&self) -> Option<String> {
        None
    }

    /// What stands in its box in a drawing, such as `2.5` or `1/s`; empty for the name of its kind.
    fn label(&self) -> String {
        String::new()
    }
}

/// Names of ports, in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ports {
    /// Of the inputs.
    pub inputs: Vec<String>,
    /// Of the outputs.
    pub outputs: Vec<String>,
}

impl Ports {
    /// From names.
    #[must_use]
    pub fn new(inputs: &[&str], outputs: &[&str]) -> Self {
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        Self { inputs: owned(inputs), outputs: owned(outputs) }
    }

    /// Inputs `u1`, `u2` … (or `u`, if it is one) and the output `y`.
    #[must_use]
    pub fn numbered(n_inputs: usize) -> Self {
        let inputs = if n_inputs == 1 { vec!["u".into()] } else { (1..=n_inputs).map(|k| format!("u{k}")).collect() };
        Self { inputs, outputs: vec!["y".into()] }
    }

    /// No input, output `y`.
    #[must_use]
    pub fn source() -> Self {
        Self::new(&[], &["y"])
    }

    /// Input `u`, output `y`.
    #[must_use]
    pub fn single() -> Self {
        Self::new(&["u"], &["y"])
    }
}

/// When a block is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Once, at the start.
    Constant,
    /// As often as its inputs change; at its sample time if it is given one. Without inputs: as [`Pace::Timed`].
    Any,
    /// Depends on time whatever its inputs: continuous, or at its sample time if it is given one.
    Timed,
    /// Has continuous states: cannot have a sample time.
    Continuous,
    /// At ticks only: at its sample time, or every tick.
    Sampled,
}

/// Lengths of the vectors of a block's state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// States that are integrated together with the world.
    pub continuous: usize,
    /// Numbers that change at ticks.
    pub discrete: usize,
}

/// What the compiled diagram knows of a block.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Widths of the inputs.
    pub inputs: Vec<usize>,
    /// Widths of the outputs.
    pub outputs: Vec<usize>,
    /// Base step `[s]`.
    pub step: f64,
    /// Base steps between two updates: 1 for continuous blocks.
    pub every: u64,
    /// For random numbers: of the run and the block's path.
    pub seed: u64,
}

impl Node {
    /// Time between two updates `[s]`.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.every as f64 * self.step
    }

    /// Number of all outputs together.
    #[must_use]
    pub fn n_out(&self) -> usize {
        self.outputs.iter().sum()
    }
}

/// The present as a block sees it.
#[derive(Clone, Copy, Debug)]
pub struct At<'a, R> {
    /// Time `[s]`.
    pub t: f64,
    /// A corner that the present integration step ends at, else infinite: functions of time take the value before it.
    pub corner: f64,
    /// Base steps since the start, at the last tick.
    pub tick: u64,
    /// What is known of the block.
    pub node: &'a Node,
    /// Its continuous states.
    pub states: &'a [R],
    /// Its memory.
    pub memory: &'a [R],
    pub(crate) signals: &'a [R],
    pub(crate) ports: &'a [(u32, u32)],
}

impl<'a, R: Real> At<'a, R> {
    /// An input.
    #[must_use]
    #[inline(always)]
    pub fn input(&self, k: usize) -> &'a [R] {
        let (start, len) = self.ports[k];
        &self.signals[start as usize..(start + len) as usize]
    }

    /// The first component of an input.
    #[must_use]
    #[inline(always)]
    pub fn scalar(&self, k: usize) -> R {
        self.signals[self.ports[k].0 as usize]
    }

    /// Component `i` of an input; a scalar stands for a vector of equal components.
    #[must_use]
    #[inline(always)]
    pub fn component(&self, k: usize, i: usize) -> R {
        let (start, len) = self.ports[k];
        let i = if len == 1 { 0 } else { i };
        self.signals[start as usize + i]
    }

    /// Time, for functions of time alone: just before the corner that an integration step ends at.
    #[must_use]
    pub fn time(&self) -> f64 {
        if self.t >= self.corner - 2.0 * SAME_INSTANT { self.corner - 2.0 * SAME_INSTANT } else { self.t }
    }
}

/// Times closer than this are the same instant `[s]`: ticks are exact multiples, typed numbers are not.
pub const SAME_INSTANT: f64 = 1e-9;

/// Component `i` of a parameter; one number stands for all.
#[must_use]
#[inline(always)]
pub fn of(parameter: &[f64], i: usize) -> f64 {
    if parameter.len() == 1 { parameter[0] } else { parameter[i] }
}

/// The width of an elementwise block: all inputs and parameters are scalars or have one width in common.
///
/// # Errors
///
/// Two of them that differ.
pub fn elementwise(inputs: &[Option<usize>], parameters: &[(&str, usize)]) -> Result<Option<usize>, String> {
    let mut wide: Option<(String, usize)> = None;
    let named = inputs.iter().enumerate().filter_map(|(k, w)| w.map(|w| (format!("input {}", k + 1), w)));
    let of_parameters = parameters.iter().map(|(name, w)| (format!("`{name}`"), *w));
    for (name, width) in named.chain(of_parameters) {
        match &wide {
            _ if width == 1 => {}
            Some((other, known)) if *known != width => {
                return Err(format!("{other} has {known} components, {name} has {width}"));
            }
            Some(_) => {}
            None => wide = Some((name, width)),
        }
    }
    Ok(match wide {
        Some((_, width)) => Some(width),
        None if inputs.iter().all(Option::is_some) => Some(1),
        None => None,
    })
}
