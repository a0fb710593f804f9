//! Host of the scripts of a run: when they are called, and what they are called with.
//!
//! An adapter (`sincro-lua`) makes a [`Host`] for each run, which is called inside the step ([`Phase`]). Scripts see
//! the world through the object registry of a [`crate::api`]; their commands are latched as those of any
//! controller.

mod calls;

use std::fmt;

pub use calls::Scripts;

use sincro_dynamics::world::World;

use crate::api::{ApiError, Handle, ObjectRegistry, Value};
use sincro_scene::script::{Kind, ScriptError};
use sincro_sim::controller::Message;

/// When a script is called within a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Once, before the first tick.
    Initialization,
    /// At each tick, before the world advances: commands and forces of the step are given here.
    Actuation,
    /// At each tick, after the world has advanced; the time is still that of the start of the step.
    Sensing,
    /// When the run is about to be paused.
    Suspend,
    /// Now and then while it is paused.
    Suspended,
    /// Before it is resumed after a pause.
    Resume,
    /// Once, when the run is over.
    Cleanup,
}

/// Context of a call of the scripts.
#[derive(Debug)]
pub struct Call<'a> {
    /// The world, to be left in its place when the call is over.
    pub world: &'a mut World,
    /// The objects as scripts know them.
    pub registry: &'a mut Option<Box<ObjectRegistry>>,
    /// The tick, in sensing that at which the step began.
    pub tick: u64,
    /// Time `[s]` of the scripts: `tick · step`.
    pub t: f64,
}

/// The scripts of one run, in memory.
pub trait Host: Send + fmt::Debug {
    /// Calls all scripts for a phase, in their order.
    ///
    /// # Errors
    ///
    /// The first script that fails; those after it are not called.
    fn call(&mut self, call: Call<'_>, phase: Phase) -> Result<(), ScriptError>;

    /// Calls a function of the script on an object, of any kind unless one is given.
    ///
    /// # Errors
    ///
    /// There is no script or no such function, or it failed.
    fn call_function(
        &mut self,
        call: Call<'_>,
        script: (Handle, Option<Kind>),
        function: &str,
        arguments: &[Value],
    ) -> Result<Vec<Value>, ApiError>;

    /// Runs a text in the script on an object, with what that script knows and within its limits; gives what the text
    /// returns.
    ///
    /// # Errors
    ///
    /// There is no such script, or the text failed.
    fn evaluate(&mut self, call: Call<'_>, script: (Handle, Option<Kind>), text: &str) -> Result<Vec<Value>, ApiError>;

    /// Takes the messages of scripts since the last call.
    fn take_messages(&mut self) -> Vec<Message>;
}

/// Settings of the scripts of a run.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Base step `[s]`.
    pub step: f64,
    /// Seed of everything random.
    pub seed: u64,
}
