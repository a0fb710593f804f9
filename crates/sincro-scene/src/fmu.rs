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

    /// Returns the variables that are numbers: name, causality (`input`, `output`, `parameter` …) and unit as text, if
    /// one is given. Their indices in this list name them in all other calls.
    fn variables(&self) -> Vec<(&str, &str, Option<&str>)>;

    /// Returns true if an output may depend on an input at the same instant (direct feedthrough).
    fn has_feedthrough(&self) -> bool;

    /// Creates an instance that starts at time `t` `[s]`; `parameters` holds pairs of a variable's index in
    /// [`FmuModel::variables`] and its value, in the unit of the variable.
    ///
    /// # Errors
    ///
    /// A message in English: the FMU refuses, or its library cannot be loaded.
    fn instantiate(&self, t: f64, parameters: &[(usize, f64)]) -> Result<Box<dyn FmuInstance>, String>;
}

/// Instance of an FMU in co-simulation, with its own state; made by [`FmuModel::instantiate`].
pub trait FmuInstance: Send + fmt::Debug {
    /// Sets variables: `places` holds their indices in [`FmuModel::variables`], `values` one value for each, in the
    /// units of the variables.
    ///
    /// # Errors
    ///
    /// A message in English if the FMU reports a failure.
    fn set(&mut self, places: &[usize], values: &[f64]) -> Result<(), String>;

    /// Reads variables: `places` holds their indices in [`FmuModel::variables`]; `values`, of the same length, receives
    /// the value of each, in the units of the variables.
    ///
    /// # Errors
    ///
    /// A message in English if the FMU reports a failure.
    fn get(&mut self, places: &[usize], values: &mut [f64]) -> Result<(), String>;

    /// Makes a communication step from time `t` `[s]` of length `h` `[s]`.
    ///
    /// # Errors
    ///
    /// A message in English if the FMU reports a failure or ended the simulation.
    fn step(&mut self, t: f64, h: f64) -> Result<(), String>;
}
