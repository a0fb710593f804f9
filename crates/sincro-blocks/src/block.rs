//! The trait of all blocks: ports, state and equations, written once over [`Real`].
//!
//! Every block has the same verbs. Before a run: [`Block::ports`], [`Block::widths`], [`Block::memory`],
//! [`Block::start`]. In a run: [`Block::output`] computes the outputs, [`Block::derivatives`] those of the continuous
//! states, [`Block::update`] the discrete states after a tick. No verb but `update` changes state, and no verb
//! allocates.
//!
//! A block of one's own is a declaration of its parameters ([`declare_block!`](crate::declare_block)) and the verbs
//! that are not the default:
//!
//! ```
//! use sincro_blocks::block::{At, Block};
//! use sincro_blocks::compile::{Interface, compile};
//! use sincro_blocks::declare_block;
//! use sincro_blocks::diagram::Diagram;
//! use sincro_blocks::library::sources::Constant;
//! use sincro_blocks::parameter::Number;
//! use sincro_math::Real;
//!
//! declare_block! {
//!     /// A spring that hardens.
//!     pub struct HardSpring("hard-spring", Nonlinear): "y = stiffness·u + cubic·u³" {
//!         /// Stiffness at rest `[N·m/rad]`.
//!         pub stiffness: f64 as Number,
//!         /// Coefficient of the cubic term `[N·m/rad³]`.
//!         pub cubic: f64 as Number = "0",
//!     }
//! }
//!
//! impl Block for HardSpring {
//!     type Work<R: Real> = ();
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

use crate::kind::Described;
use crate::reader::Reader;
use crate::unit::{Unit, common};
use crate::unit_rule::UnitRule;

/// Kind of block: an immutable set of parameters with its equations, implemented for every block of the library and for
/// one's own. All that changes during a run is in the states and memory that are passed to it.
///
/// ```
/// use sincro_blocks::prelude::*;
///
/// declare_block! {
///     /// Keeps the largest value since the start.
///     pub struct Maximum("maximum", Discrete): "y(k+1) = max(y(k), u(k)), y(0) = initial" {
///         /// y at the start.
///         pub initial: f64 as Number = "0",
///     }
/// }
///
/// impl Block for Maximum {
///     type Work<R: Real> = ();
///     const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Discrete;
///     const STATE: Memory = Memory::DISCRETE;
///
///     fn has_direct_feedthrough(&self, _input: usize) -> bool {
///         false // so that it breaks algebraic loops
///     }
///     fn start<R: Real>(&self, _node: &Node, _states: &mut [R], memory: &mut [R]) {
///         memory.fill(R::splat(self.initial));
///     }
///     fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
///         y.copy_from_slice(at.memory);
///     }
///     fn update<R: Real>(&self, at: &At<'_, R>, (): &mut (), memory: &mut [R], _states: &mut [R]) {
///         for (i, m) in memory.iter_mut().enumerate() {
///             *m = m.if_less(at.component(0, i), at.component(0, i), *m);
///         }
///     }
/// }
///
/// let mut diagram = Diagram::new();
/// diagram.block("wave", sincro_blocks::library::sources::Sine::new(2.0, std::f64::consts::TAU));
/// diagram.block("peak", Maximum { initial: -1.0 }).wire("wave", "peak");
/// let peak = Simulator::new(&diagram, 0.25)?.record("peak", 4); // u = 0, 2, 0, −2, 0
/// assert_eq!(peak, [-1.0, 0.0, 2.0, 2.0, 2.0]);
/// # Ok::<(), CompileError>(())
/// ```
pub trait Block: Described + Clone + Debug + Send + Sync + 'static {
    /// Buffers for intermediate results, such as the stack of a formula; their content never matters. `()` for most
    /// blocks.
    type Work<R: Real>: Clone + Debug + Default + Send + Sync;

    /// Sample time, if it is the same for all parameters; see [`Block::sample_time_kind`].
    const SAMPLE_TIME: SampleTimeKind = SampleTimeKind::Inherited;

    /// State for each component of the outputs, if it does not depend on the parameters; see [`Block::memory`].
    const STATE: Memory = Memory::NONE;

    /// True if all inputs have one unit and the outputs have it too: for blocks that pass a signal on, add or compare.
    const KEEPS_UNIT: bool = false;

    /// True if the block computes lanes of worlds together ([`LaneRunner`](crate::lanes::LaneRunner)): it does the same
    /// operations whatever its numbers, and looks neither at one lane ([`Real::lane`]) nor at time or tick. By default
    /// it computes one world after the other.
    const IN_LANES: bool = false;

    /// Returns false if the parameters of a block with [`Block::IN_LANES`] do not let it compute lanes together.
    fn runs_in_lanes(&self) -> bool {
        true
    }

    /// Checks parameters against each other after they were read, notes errors in the reader ([`Reader::fault`]), and
    /// computes what is derived from them; by default nothing.
    fn validate(&mut self, _parameters: &mut Reader<'_>) {}

    /// Names of the inputs and outputs, in the order of their indices; by default the input `u` and the output `y`.
    fn ports(&self) -> Ports {
        Ports::single()
    }

    /// Widths of the outputs (numbers of components), in the order of the ports, as far as they follow from the
    /// parameters and from the widths of the inputs; `None`: not yet known. By default [`elementwise`].
    ///
    /// # Errors
    ///
    /// A message about widths that do not fit each other, for the error of the diagram.
    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &self.parameter_widths())?; self.ports().outputs.len()])
    }

    /// Units of the outputs, in the order of the ports, as far as they follow from the units of the inputs; `None`: not
    /// known. By default see [`Block::KEEPS_UNIT`].
    ///
    /// # Errors
    ///
    /// A message about units that do not fit each other, for the error of the diagram.
    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        let unit = if Self::KEEPS_UNIT { common(inputs)? } else { None };
        Ok(vec![unit; self.ports().outputs.len()])
    }

    /// Relation between the units of inputs and outputs by which unknown ones are deduced for display; by default
    /// [`UnitRule::Same`] of all inputs where [`Block::KEEPS_UNIT`], nothing otherwise.
    fn unit_rule(&self) -> UnitRule {
        if Self::KEEPS_UNIT { UnitRule::Same((0..self.ports().inputs.len()).collect()) } else { UnitRule::Unknown }
    }

    /// Sample time of the block, as far as it follows from its kind and its parameters; by default
    /// [`Block::SAMPLE_TIME`].
    fn sample_time_kind(&self) -> SampleTimeKind {
        Self::SAMPLE_TIME
    }

    /// Returns true if the outputs depend on the present value of input port `input` (counted from 0): direct
    /// feedthrough, the default. An input without it breaks algebraic loops.
    fn has_direct_feedthrough(&self, _input: usize) -> bool {
        true
    }

    /// Numbers of continuous and discrete states in the compiled diagram; by default [`Block::STATE`] for each
    /// component of the outputs.
    fn memory(&self, node: &Node) -> Memory {
        let n = node.n_out();
        Memory { continuous: n * Self::STATE.continuous, discrete: n * Self::STATE.discrete }
    }

    /// Checks parameters against sizes and sample time in the compiled diagram, such as a delay against the base step;
    /// by default nothing.
    ///
    /// # Errors
    ///
    /// Message and help, in this order, for the error of the diagram.
    fn check(&self, _node: &Node) -> Result<(), (String, String)> {
        Ok(())
    }

    /// Writes the initial continuous states and discrete states (`memory`), each as many as [`Block::memory`] says, in
    /// their own units; zero where nothing is written.
    fn start<R: Real>(&self, _node: &Node, _states: &mut [R], _memory: &mut [R]) {}

    /// Buffers for intermediate results, made once for each instance so that no evaluation allocates; by default empty.
    fn work<R: Real>(&self) -> Self::Work<R> {
        Self::Work::default()
    }

    /// Computes the outputs into `y`: the components of all output ports one after the other, each in its own unit. May
    /// read only inputs with direct feedthrough.
    fn output<R: Real>(&self, at: &At<'_, R>, work: &mut Self::Work<R>, y: &mut [R]);

    /// Computes the time derivatives `f(x, u, t)` of the continuous states `x` into `derivatives`: one for each state,
    /// in its unit per second. By default nothing.
    fn derivatives<R: Real>(&self, _at: &At<'_, R>, _work: &mut Self::Work<R>, _derivatives: &mut [R]) {}

    /// Computes the diagonal of `−∂f/∂x` `[1/s]` into `diagonal`, one entry for each continuous state, `f` as in
    /// [`Block::derivatives`]: implicit integrators damp the new state by it, and warnings about stiffness use it. Zero
    /// where nothing is written.
    fn neg_jacobian_diagonal<R: Real>(&self, _at: &At<'_, R>, _diagonal: &mut [R]) {}

    /// Computes the discrete states of the next tick, after all outputs of a tick are known. `memory` holds the present
    /// ones and takes the new ones; `states` are the continuous states, which may be set too (a reset); `at.states` is
    /// empty here.
    fn update<R: Real>(&self, _at: &At<'_, R>, _work: &mut Self::Work<R>, _memory: &mut [R], _states: &mut [R]) {}

    /// Next time event: the first instant after time `t` `[s]` at which the outputs or one of their derivatives jump,
    /// if that depends on time alone; infinite if there is none, the default.
    fn next_time_event(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// Number of zero-crossing functions of a block with events of its own that are located within a step, 0 if it has
    /// time events alone; `None` for blocks without events, the default. Such a block is evaluated between ticks.
    fn zero_crossing_count(&self) -> Option<usize> {
        None
    }

    /// Computes the zero-crossing functions into `values`, as many as [`Block::zero_crossing_count`]: above zero where
    /// an event has happened since the last [`Block::handle_events`], below zero where it has not; continuous in time
    /// between events. All inputs are known.
    fn zero_crossings<R: Real>(&self, _at: &At<'_, R>, _work: &mut Self::Work<R>, _values: &mut [R]) {}

    /// Instant of the next time event that the block itself has scheduled `[s]`, from its discrete states; infinite if
    /// there is none, the default.
    fn scheduled_event<R: Real>(&self, _memory: &[R]) -> f64 {
        f64::INFINITY
    }

    /// Handles the events that have happened at this instant: time events that are due, zero crossings, jumps of
    /// inputs. Changes discrete states (`memory`) and continuous ones (`states`); `at.memory` and `at.states` are
    /// empty. Called at every tick before [`Block::output`], the first of the run included, where only inputs with
    /// direct feedthrough may be read, and after every accepted step of the integrator (`is_step_end`). Returns true if
    /// there was an event.
    fn handle_events<R: Real>(
        &self,
        _at: &At<'_, R>,
        _work: &mut Self::Work<R>,
        _state: (&mut [R], &mut [R]),
        _is_step_end: bool,
    ) -> bool {
        false
    }

    /// State that the block keeps outside of the diagram, as bytes for a snapshot, such as that of a foreign library;
    /// `None` if it keeps none there, the default, or cannot save it. `memory` are its discrete states.
    fn save_outside<R: Real>(&self, _work: &Self::Work<R>, _memory: &[R]) -> Option<Vec<u8>> {
        None
    }

    /// Takes back the state of [`Block::save_outside`], to go on from the discrete states that were saved with it.
    fn restore_outside<R: Real>(&self, _work: &mut Self::Work<R>, _saved: Option<&[u8]>, _memory: &[R]) {}

    /// Highest frequency `[Hz]` in the outputs of a source up to time `until` `[s]`, for choosing step sizes; 0 for
    /// blocks that are no source. `is_sampled`: it is evaluated at ticks only. Jumps and corners that are located as
    /// time events count as 0.
    fn highest_frequency(&self, _until: f64, _is_sampled: bool) -> f64 {
        0.0
    }

    /// Remark for the report at the end of a run, from the discrete states, such as that the block limited a signal and
    /// when first; `None` without.
    fn notice(&self, _node: &Node, _memory: &[f64]) -> Option<String> {
        None
    }

    /// Reason for outputs that are not finite, such as an error in a script; `None` if the block knows none.
    fn fault(&self) -> Option<String> {
        None
    }

    /// Text in the box of the block in a drawing, such as `2.5` or `1/s`; empty for the name of its kind.
    fn label(&self) -> String {
        String::new()
    }
}

/// Names of the ports of a block, in the order of their indices.
///
/// ```
/// use sincro_blocks::prelude::*;
///
/// assert_eq!(Ports::single(), Ports::new(&["u"], &["y"]));
/// assert_eq!(Ports::numbered(3).inputs, ["u1", "u2", "u3"]);
/// assert!(Ports::source().inputs.is_empty());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ports {
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Names of the outputs.
    pub outputs: Vec<String>,
}

impl Ports {
    /// Ports with the given names of inputs and outputs.
    #[must_use]
    pub fn new(inputs: &[&str], outputs: &[&str]) -> Self {
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        Self { inputs: owned(inputs), outputs: owned(outputs) }
    }

    /// Inputs `u1`, `u2` …, `n_inputs` of them (a single one is `u`), and the output `y`.
    #[must_use]
    pub fn numbered(n_inputs: usize) -> Self {
        let inputs = if n_inputs == 1 { vec!["u".into()] } else { (1..=n_inputs).map(|k| format!("u{k}")).collect() };
        Self { inputs, outputs: vec!["y".into()] }
    }

    /// Ports of a source: no input, output `y`.
    #[must_use]
    pub fn source() -> Self {
        Self::new(&[], &["y"])
    }

    /// Ports of a function of one signal: input `u`, output `y`.
    #[must_use]
    pub fn single() -> Self {
        Self::new(&["u"], &["y"])
    }
}

/// Sample time of a block, as far as its kind determines it: constant, inherited, continuous or discrete.
///
/// ```
/// use sincro_blocks::library::continuous::Integrator;
/// use sincro_blocks::library::discrete::UnitDelay;
/// use sincro_blocks::prelude::*;
///
/// // states are integrated with the plant, memory changes at ticks
/// assert_eq!(Integrator::new(0.0).sample_time_kind(), SampleTimeKind::Continuous);
/// assert_eq!(UnitDelay::new(0.0).sample_time_kind(), SampleTimeKind::Discrete);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleTimeKind {
    /// Evaluated once, at the start.
    Constant,
    /// As often as its inputs change; at its sample time if it is given one. Without inputs: as
    /// [`SampleTimeKind::TimeVarying`].
    Inherited,
    /// Depends on time whatever its inputs: continuous, or at its sample time if it is given one.
    TimeVarying,
    /// Has continuous states: cannot have a sample time.
    Continuous,
    /// At ticks only: at its sample time, or every tick.
    Discrete,
}

/// Numbers of states of a block, continuous and discrete: the lengths of its state vectors.
///
/// ```
/// use sincro_blocks::library::continuous::Integrator;
/// use sincro_blocks::prelude::*;
///
/// assert_eq!(Memory::CONTINUOUS, Memory { continuous: 1, discrete: 0 });
/// // an integrator of a vector has a state for each component
/// let node = Node { inputs: vec![3], outputs: vec![3], step: 0.001, every: 1, seed: 0 };
/// assert_eq!(Integrator::new(0.0).memory(&node), Memory { continuous: 3, discrete: 0 });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Number of continuous states, which are integrated together with the world.
    pub continuous: usize,
    /// Number of discrete states, which change at ticks.
    pub discrete: usize,
}

impl Memory {
    /// No states: for blocks whose outputs follow from their inputs.
    pub const NONE: Self = Self { continuous: 0, discrete: 0 };
    /// One continuous state; as [`Block::STATE`], one for each component of the outputs.
    pub const CONTINUOUS: Self = Self { continuous: 1, discrete: 0 };
    /// One discrete state; as [`Block::STATE`], one for each component of the outputs.
    pub const DISCRETE: Self = Self { continuous: 0, discrete: 1 };
}

/// Sizes and sample time of one block in a compiled diagram.
///
/// ```
/// use sincro_blocks::prelude::*;
///
/// // a block that is evaluated every fifth base step of 1 ms
/// let node = Node { inputs: vec![1], outputs: vec![3, 1], step: 0.001, every: 5, seed: 0 };
/// assert_eq!((node.period(), node.n_out()), (0.005, 4)); // [s], numbers
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Widths of the inputs (numbers of components), in the order of the ports.
    pub inputs: Vec<usize>,
    /// Widths of the outputs, in the order of the ports.
    pub outputs: Vec<usize>,
    /// Base step `[s]`.
    pub step: f64,
    /// Number of base steps between two updates; 1 for continuous blocks.
    pub every: u64,
    /// Seed of its random numbers, derived from that of the run and the path of the block.
    pub seed: u64,
}

impl Node {
    /// Time between two updates, `every` times `step` `[s]`.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.every as f64 * self.step
    }

    /// Number of components of all outputs together.
    #[must_use]
    pub fn n_out(&self) -> usize {
        self.outputs.iter().sum()
    }
}

/// Time, inputs and state of a block at the instant of evaluation: the argument of [`Block::output`] and its siblings.
///
/// ```
/// use sincro_blocks::library::sources::Constant;
/// use sincro_blocks::prelude::*;
///
/// declare_block! {
///     /// Mechanical power of a motor.
///     pub struct Power("power", Maths): "y = efficiency·u·i" {
///         /// Efficiency of the windings, 0 to 1 (dimensionless).
///         pub efficiency: f64 as Positive,
///     }
/// }
///
/// impl Block for Power {
///     type Work<R: Real> = ();
///
///     fn ports(&self) -> Ports {
///         Ports::new(&["u", "i"], &["y"])
///     }
///     fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
///         y[0] = R::splat(self.efficiency) * at.scalar(0) * at.scalar(1); // the first component of each input
///     }
/// }
///
/// let mut diagram = Diagram::new();
/// diagram.block("voltage", Constant::new(24.0)).block("current", Constant::new(1.5));
/// diagram.block("power", Power { efficiency: 0.75 });
/// diagram.wire("voltage", "power.u").wire("current", "power.i");
/// assert_eq!(Simulator::new(&diagram, 0.001)?.output("power"), [27.0]); // [W]
/// # Ok::<(), CompileError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct At<'a, R> {
    /// Time `[s]`.
    pub t: f64,
    /// Time event at which the present integration step ends `[s]`, else infinite: functions of time take the value
    /// before it.
    pub time_event: f64,
    /// Number of base steps from the start to the last tick.
    pub tick: u64,
    /// Sizes and sample time of the block.
    pub node: &'a Node,
    /// Continuous states of the block, each in its own unit; empty in [`Block::update`].
    pub states: &'a [R],
    /// Discrete states of the block, each in its own unit.
    pub memory: &'a [R],
    pub(crate) signals: &'a [R],
    pub(crate) ports: &'a [(u32, u32)],
}

impl<'a, R: Real> At<'a, R> {
    /// Components of input port `k` (counted from 0), in the unit of the signal. Panics if there is no such port.
    #[must_use]
    #[inline(always)]
    pub fn input(&self, k: usize) -> &'a [R] {
        let (start, len) = self.ports[k];
        &self.signals[start as usize..(start + len) as usize]
    }

    /// First component of input port `k` (counted from 0), in the unit of the signal. Panics if there is no such port.
    #[must_use]
    #[inline(always)]
    pub fn scalar(&self, k: usize) -> R {
        self.signals[self.ports[k].0 as usize]
    }

    /// Component `i` of input port `k` (both counted from 0), in the unit of the signal; a scalar stands for a vector
    /// of equal components. `i` must be below the width of the port.
    #[must_use]
    #[inline(always)]
    pub fn component(&self, k: usize, i: usize) -> R {
        let (start, len) = self.ports[k];
        let i = if len == 1 { 0 } else { i };
        self.signals[start as usize + i]
    }

    /// Copies input port `k` (counted from 0) into `to`, component by component; a scalar fills it. `to` is no longer
    /// than the port is wide.
    #[inline(always)]
    pub fn copy_input(&self, k: usize, to: &mut [R]) {
        for (i, x) in to.iter_mut().enumerate() {
            *x = self.component(k, i);
        }
    }

    /// Time `[s]` for functions of time alone: `t`, but at the time event that ends the present integration step the
    /// instant just before it.
    #[must_use]
    pub fn time(&self) -> f64 {
        if self.t >= self.time_event - 2.0 * SAME_INSTANT { self.time_event - 2.0 * SAME_INSTANT } else { self.t }
    }
}

/// Tolerance of instants `[s]`: times closer than this are the same, because ticks are exact multiples and typed
/// numbers are not.
pub const SAME_INSTANT: f64 = 1e-9;

/// Component `i` (counted from 0) of a parameter that is one number for all components or one for each, in its unit.
/// Panics for an index beyond a list.
#[must_use]
#[inline(always)]
pub fn of(parameter: &[f64], i: usize) -> f64 {
    if parameter.len() == 1 { parameter[0] } else { parameter[i] }
}

/// Fills `to` with a parameter that is one number for all components or one for each, in its unit. Panics if such a
/// list is shorter than `to`.
pub fn fill<R: Real>(to: &mut [R], parameter: &[f64]) {
    for (i, x) in to.iter_mut().enumerate() {
        *x = R::splat(of(parameter, i));
    }
}

/// Common width of an elementwise block, whose inputs and parameters are scalars or have one width in common. `inputs`
/// are the widths known so far, `parameters` names and lengths; `None` while it is not determined.
///
/// # Errors
///
/// A message that names two of them with different widths.
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
