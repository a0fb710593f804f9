//! Host of the scripts of a run: when they are called, and what they are called with.
//!
//! An adapter (`sincro-lua`) makes a [`Host`] for each run, which is called inside the step ([`Phase`]). Scripts see
//! the world through the object registry of a [`crate::api`]; their commands are latched as those of any
//! controller.

mod calls;

use std::fmt;

pub(crate) use calls::Scripts;
pub use calls::in_order;

use sincro_dynamics::world::World;

use crate::api::{ApiError, Handle, ObjectRegistry, Value};
use sincro_scene::script::{Kind, ScriptError};
use sincro_sim::controller::{Message, ScriptFailure};

/// Phase of a run in which scripts are called, each with the callback of its name (`sysCall_init`, `sysCall_actuation`
/// …).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Once, before the first tick (`sysCall_init`).
    Initialization,
    /// At the start of each step of scripts, before the world advances: commands and forces of the step are given here.
    Actuation,
    /// At the end of each step of scripts, after the world has advanced; the time is that of the start of the step.
    Sensing,
    /// When the run is about to be paused.
    Suspend,
    /// Now and then while it is paused.
    Suspended,
    /// Before it is resumed after a pause.
    Resume,
    /// Once, when the run is over.
    Cleanup,
    /// Once, before the first run of a session (`sysCall_init` of customization scripts alone): they live from here to
    /// [`Phase::Close`], through all runs.
    Open,
    /// Now and then while a session is stopped (`sysCall_nonSimulation` of customization scripts).
    NonSimulation,
    /// Once, when a session lets its scene go (`sysCall_cleanup` of customization scripts).
    Close,
}

/// Context of a call of scripts by the lock-step: world, objects and time, which a [`Host`] hands to the functions of
/// the API.
#[derive(Debug)]
pub struct Call<'a> {
    /// The world, to be left in its place when the call is over.
    pub world: &'a mut World,
    /// Object registry, to be left in its place when the call is over; none if it was taken away.
    pub registry: &'a mut Option<Box<ObjectRegistry>>,
    /// Tick (number of base steps since the start); in sensing that at which the step began.
    pub tick: u64,
    /// Time of the scripts `[s]`: `tick` times the base step.
    pub t: f64,
}

/// Scripts in memory, in the language of an adapter (`sincro-lua`); the lock-step calls them in each [`Phase`]. A host
/// is that of one run, or, after [`Phase::Open`], of all runs of a session, between which customization scripts stay.
pub trait Host: Send + fmt::Debug {
    /// Calls the callback of a phase in all scripts that have it, in their order ([`in_order`]). Scripts that are new
    /// in the registry's scene are started before, those that it has no longer are ended.
    ///
    /// # Errors
    ///
    /// The first script that fails, with its object and line; those after it are not called.
    fn call(&mut self, call: Call<'_>, phase: Phase) -> Result<(), ScriptError>;

    /// Calls a global function of the script on an object, of any kind of script unless one is given; returns its
    /// results in their order.
    ///
    /// # Errors
    ///
    /// There is no such script or no function of that name, or it failed; the message has the script's own.
    fn call_function(
        &mut self,
        call: Call<'_>,
        script: (Handle, Option<Kind>),
        function: &str,
        arguments: &[Value],
    ) -> Result<Vec<Value>, ApiError>;

    /// Lets the script on a vision sensor filter its picture (`sysCall_vision`), as in a step; returns true if there is
    /// one that does.
    ///
    /// # Errors
    ///
    /// The script has failed.
    fn filter_picture(&mut self, call: Call<'_>, sensor: Handle) -> Result<bool, ApiError>;

    /// Runs a text as a chunk of the script on an object, with what that script knows and within its limits; returns
    /// what the chunk returns.
    ///
    /// # Errors
    ///
    /// There is no such script, or the text cannot be parsed or failed.
    fn evaluate(&mut self, call: Call<'_>, script: (Handle, Option<Kind>), text: &str) -> Result<Vec<Value>, ApiError>;

    /// Returns the scripts that have failed since the run began in calls after which it went on.
    fn failures(&self) -> Vec<ScriptFailure>;

    /// Takes the messages that scripts have printed since the last call, in their order.
    fn take_messages(&mut self) -> Vec<Message>;
}

/// Settings that a host starts the scripts of a run with.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Duration of a step of scripts `[s]`: a whole number of base steps.
    pub step: f64,
    /// Seed of the scripts' random numbers, from the experiment.
    pub seed: u64,
}
