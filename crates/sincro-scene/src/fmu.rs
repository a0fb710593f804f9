//! FMUs of a scene: functional mock-up units as blocks of its diagram, loaded by an adapter.
//!
//! This crate calls no foreign code. An adapter (`sincro-fmu`) is an [`FmuLoader`], which reads an FMU when a scene is
//! loaded and makes instances of it when the scene runs.

use std::fmt;
use std::sync::Arc;

use crate::script::ScriptParser;

/// Loaders of foreign formats that a program gives to [`crate::open::open`]: scripts and FMUs, which this crate cannot
/// read itself. The default has none; scenes that need one are then refused.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loaders {
    /// Parser of the scripting language.
    pub scripts: Option<&'static dyn ScriptParser>,
    /// Loader of FMUs.
    pub fmus: Option<&'static dyn FmuLoader>,
}

/// Loader of FMUs (functional mock-up units) for blocks of diagrams; implemented by an adapter such as `sincro-fmu`.
pub trait FmuLoader: Send + Sync + fmt::Debug {
    /// Reads an FMU from the bytes of its file (a zip archive); none of its code runs yet.
    ///
    /// # Errors
    ///
    /// A message in English: the reason for which the FMU cannot be used.
    fn read(&self, bytes: &[u8]) -> Result<Arc<dyn FmuModel>, String>;
}

/// FMU that was read: its description, from which instances are made.
pub trait FmuModel: Send + Sync + fmt::Debug {
    /// Returns the name of the model.
    fn name(&self) -> &str;

    /// Returns the interfaces that the FMU has and that this program can run.
    fn interfaces(&self) -> &[FmuInterface];

    /// Returns the variables that are numbers or arrays of numbers, and input clocks. Their indices in this list name
    /// them in all other calls.
    fn variables(&self) -> &[FmuVariable];

    /// Returns the variables that give the numbers of continuous states and zero crossings for model exchange.
    fn exchange(&self) -> &FmuExchange;

    /// Returns true if instances of an interface can save their state as bytes.
    fn can_save(&self, interface: FmuInterface) -> bool;

    /// Creates an instance; `parameters` holds pairs of a variable's index in [`FmuModel::variables`] and its values,
    /// in the unit of the variable.
    ///
    /// # Errors
    ///
    /// A message in English: the FMU refuses, or its library cannot be loaded.
    fn instantiate(
        &self,
        interface: FmuInterface,
        parameters: &[(usize, Vec<f64>)],
    ) -> Result<Box<dyn FmuInstance>, String>;
}

/// Interface of an FMU by which it is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FmuInterface {
    /// Co-simulation: the FMU brings its own integrator.
    CoSimulation,
    /// Model exchange: its continuous states are integrated with the run.
    ModelExchange,
    /// Scheduled execution: its model partitions run when their clocks tick.
    ScheduledExecution,
}

/// Variable of an FMU that is a number or an array of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct FmuVariable {
    /// Name in the model description.
    pub name: String,
    /// Causality: `input`, `output`, `parameter`, `structuralParameter`, `local` …
    pub causality: String,
    /// Unit of its values, if one is given.
    pub unit: Option<FmuUnit>,
    /// Dimensions of an array, in row-major order; none for one number.
    pub dimensions: Vec<FmuDimension>,
    /// First start value, if one is given.
    pub start: Option<f64>,
    /// True if it is a real number, of 32 or 64 bits.
    pub is_real: bool,
    /// True if it changes at events only.
    pub is_discrete: bool,
    /// True for an input on which an output may depend at the same instant (direct feedthrough).
    pub feeds_through: bool,
    /// True for an input clock that the importer triggers.
    pub is_clock: bool,
}

/// Dimension of an array of an FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FmuDimension {
    /// Fixed size.
    Fixed(usize),
    /// Value of a structural parameter, by its index among the variables.
    Parameter(usize),
}

/// Unit of a variable of an FMU: its name, and its relation to SI units if the FMU defines it.
#[derive(Clone, Debug, PartialEq)]
pub struct FmuUnit {
    /// Name, such as `rad/s` or `degC`.
    pub name: String,
    /// Relation to the SI units.
    pub base: Option<FmuBaseUnit>,
    /// True for a difference of two values: the offset does not count.
    pub is_relative: bool,
}

/// Relation of a unit to the SI units: `value in SI units = factor·value + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FmuBaseUnit {
    /// Exponents of kilogram, metre, second, ampere, kelvin, radian, mole and candela, in this order.
    pub exponents: [i8; 8],
    /// Size in SI units.
    pub factor: f64,
    /// SI value of its zero.
    pub offset: f64,
}

/// Variables whose sizes give the numbers of states and zero crossings of an FMU for model exchange.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FmuExchange {
    /// Derivatives of continuous states: indices of variables.
    pub states: Vec<usize>,
    /// Event indicators: indices of variables.
    pub crossings: Vec<usize>,
    /// Number of event indicators that are no variables.
    pub n_crossings: usize,
}

/// Events of an FMU that were handled: what followed from them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FmuEvents {
    /// Instant of the next time event `[s]`; infinite if there is none.
    pub next: f64,
    /// True if the FMU asks to end the simulation.
    pub ends: bool,
}

/// Values of variables of an FMU: indices in [`FmuModel::variables`], and one value for each number, those of an array
/// in row-major order, one variable after the other, in the units of the variables.
pub type FmuValues<'a> = (&'a [usize], &'a [f64]);

/// Instance of an FMU with its own state, made by [`FmuModel::instantiate`]: started once, then stepped (co-simulation,
/// scheduled execution) or evaluated (model exchange). All errors are messages in English: the FMU reports a failure,
/// or cannot do what is asked for.
pub trait FmuInstance: Send + fmt::Debug {
    /// Initializes the instance at time `t` `[s]` under `inputs`, and handles the events of the start.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn start(&mut self, t: f64, inputs: FmuValues<'_>) -> Result<FmuEvents, String>;

    /// Sets variables.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn set(&mut self, values: FmuValues<'_>) -> Result<(), String>;

    /// Reads variables: `places` holds their indices in [`FmuModel::variables`]; `values` receives the values, in the
    /// units of the variables.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn get(&mut self, places: &[usize], values: &mut [f64]) -> Result<(), String>;

    /// Makes a communication step from time `t` `[s]` of length `h` `[s]`.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`]; the FMU ended the simulation.
    fn step(&mut self, t: f64, h: f64) -> Result<(), String>;

    /// Returns the state as bytes.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn save(&mut self) -> Result<Vec<u8>, String>;

    /// Takes back the state of [`FmuInstance::save`], of this or another started instance of the same FMU.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn restore(&mut self, state: &[u8]) -> Result<(), String>;

    /// Reads the continuous states and their nominal values, both of the same length, for model exchange.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn continuous_states(&mut self, states: &mut [f64], nominals: &mut [f64]) -> Result<(), String>;

    /// Sets time `[s]` and continuous states, for model exchange.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn set_continuous_states(&mut self, t: f64, states: &[f64]) -> Result<(), String>;

    /// Reads the derivatives of the continuous states.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn derivatives(&mut self, derivatives: &mut [f64]) -> Result<(), String>;

    /// Reads the event indicators: an event happens where one passes from above zero to zero or below, or back.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn event_indicators(&mut self, indicators: &mut [f64]) -> Result<(), String>;

    /// Tells the instance that the step to the present time and states was accepted; returns true if it has an event
    /// then.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`]; the FMU ended the simulation.
    fn complete_step(&mut self) -> Result<bool, String>;

    /// Handles the events of the present time and states, with new values of discrete `inputs`.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn handle_events(&mut self, inputs: FmuValues<'_>) -> Result<FmuEvents, String>;

    /// Computes Jv: the change of outputs (their indices in `unknowns`) and, behind them, of the derivatives of all
    /// states, per change of inputs (their indices in `knowns`) and, behind them, of all states by `seed`. Returns
    /// false if the FMU has no such function.
    ///
    /// # Errors
    ///
    /// See [`FmuInstance`].
    fn directional_derivative(
        &mut self,
        unknowns: &[usize],
        knowns: &[usize],
        seed: &[f64],
        change: &mut [f64],
    ) -> Result<bool, String>;
}
