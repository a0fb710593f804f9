//! FMUs of a scene: functional mock-up units as blocks of its diagram, loaded by an adapter.
//!
//! This crate calls no foreign code. An adapter (`sincro-fmu`) is an [`FmuLoader`], which reads an FMU when a scene is
//! loaded and makes instances of it when the scene runs.

use std::fmt;
use std::sync::Arc;

use crate::script::ScriptParser;

/// Parts of the program that know what this crate does not: the language of scripts, FMUs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loaders {
    /// Parser of the language of scripts.
    pub scripts: Option<&'static dyn ScriptParser>,
    /// Loader of FMUs.
    pub fmus: Option<&'static dyn FmuLoader>,
}

/// Loader of FMUs for blocks of diagrams, given to the scene from above.
pub trait FmuLoader: Send + Sync + fmt::Debug {
    /// Reads an FMU; none of its code runs yet.
    ///
    /// # Errors
    ///
    /// The reason for which it cannot be used, in words.
    fn read(&self, bytes: &[u8]) -> Result<Arc<dyn FmuModel>, String>;
}

/// An FMU that was read.
pub trait FmuModel: Send + Sync + fmt::Debug {
    /// Name of the model.
    fn name(&self) -> &str;

    /// Variables that are numbers: name, causality (`input`, `output`, `parameter` …) and unit, if one is given.
    fn variables(&self) -> Vec<(&str, &str, Option<&str>)>;

    /// True if an output may depend on an input at the same instant.
    fn has_feedthrough(&self) -> bool;

    /// Makes an instance at time `t` `[s]` with values of parameters; variables go by their places among
    /// [`FmuModel::variables`].
    ///
    /// # Errors
    ///
    /// The FMU refuses, or its library cannot be loaded.
    fn instantiate(&self, t: f64, parameters: &[(usize, f64)]) -> Result<Box<dyn FmuInstance>, String>;
}

/// An instance of an FMU.
pub trait FmuInstance: Send + fmt::Debug {
    /// Sets variables by their places in [`FmuModel::variables`], one value for each, in the units of the description.
    ///
    /// # Errors
    ///
    /// The call fails.
    fn set(&mut self, places: &[usize], values: &[f64]) -> Result<(), String>;

    /// Reads variables by their places in [`FmuModel::variables`] into `values`, one for each, in the units of the
    /// description.
    ///
    /// # Errors
    ///
    /// The call fails.
    fn get(&mut self, places: &[usize], values: &mut [f64]) -> Result<(), String>;

    /// Makes a communication step from `t` by `h` `[s]`.
    ///
    /// # Errors
    ///
    /// The call fails, or the FMU ended the simulation.
    fn step(&mut self, t: f64, h: f64) -> Result<(), String>;
}
