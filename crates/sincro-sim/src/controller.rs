//! Controllers in lock-step: everything that acts on the world at its own sample time, while the world waits for it.
//!
//! [`crate::run::LockStep::advance`] calls them in the order in which they were attached. A controller writes its own commands, through
//! [`Controller::latch`], and the world that it is handed; of two that give the same command, the later one wins.

use std::any::Any;
use std::fmt;

use sincro_dynamics::world::World;

use crate::proximity::Detection;
use sincro_scene::scenery::Piece;
use sincro_scene::script::Fault;

/// Instant of a step, with the world at that instant.
#[derive(Debug)]
pub struct Instant<'a> {
    /// The world.
    pub world: &'a mut World,
    /// Base steps done.
    pub tick: u64,
    /// Time `[s]`.
    pub t: f64,
}

/// A message of a controller, kept with the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Time of the message `[s]`.
    pub t: f64,
    /// Path of the object that speaks, or the name of the controller.
    pub object: String,
    /// Text of the message.
    pub text: String,
}

/// A number of the model that a controller has changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// From when on `[s]`; 0 also for what was changed before the run.
    pub t: f64,
    /// Path of the object; `/` for the world.
    pub object: String,
    /// Which number: `mass`, `center_of_mass`, `inertia` (xx, xy, xz, yy, yz, zz), `limits` (lower, upper), `coupling` (ratio, offset), `respondable`, `gravity`.
    pub quantity: &'static str,
    /// The new numbers, in the units of the scene file.
    pub value: Vec<f64>,
}

/// A controller in lock-step.
///
/// | call | instant | may write | if it fails |
/// |---|---|---|---|
/// | [`start`](Controller::start) | once, before the first tick | the world | the run stops at tick 0, nothing is advanced |
/// | [`actuate`](Controller::actuate) | t_k, before the world advances | the world, its own commands | the run stops at t_k: the state is that of t_k |
/// | [`latch`](Controller::latch) | t_k, after all have acted | the commands that it determines | cannot fail |
/// | [`look`](Controller::look) | t_{k+1}, once the scene's proximity sensors have looked | itself | cannot fail |
/// | [`sense`](Controller::sense) | t_{k+1} | the world, for the next step | the run stops at t_{k+1}: the step has been made and is recorded |
/// | [`finish`](Controller::finish) | once, after the last tick | itself | the end of the run is reported as a stop |
///
/// It decides by the tick at which it is called whether a step of its own begins. All methods but [`Controller::name`] do nothing unless
/// they are implemented. Nothing in it may depend on a clock or on the order of threads: the same calls give the same bits.
pub trait Controller: Any + Send + fmt::Debug {
    /// Name in messages.
    fn name(&self) -> &str;

    /// Before the first tick.
    ///
    /// # Errors
    ///
    /// It cannot control this run.
    fn start(&mut self, _: Instant<'_>) -> Result<(), Fault> {
        Ok(())
    }

    /// Commands and forces of the base step that begins.
    ///
    /// # Errors
    ///
    /// It cannot go on.
    fn actuate(&mut self, _: Instant<'_>) -> Result<(), Fault> {
        Ok(())
    }

    /// Writes the commands that it determines over those of the scene and of the controllers before it.
    fn latch(&self, _commands: &mut [f64]) {}

    /// The step has been made and the scene's proximity sensors have looked; at the start, too.
    fn look(&mut self, _: Instant<'_>) {}

    /// Measurements of the step that ends.
    ///
    /// # Errors
    ///
    /// It cannot go on.
    fn sense(&mut self, _: Instant<'_>) -> Result<(), Fault> {
        Ok(())
    }

    /// After the last tick, if it was started.
    ///
    /// # Errors
    ///
    /// It could not clean up.
    fn finish(&mut self, _: Instant<'_>) -> Result<(), Fault> {
        Ok(())
    }

    /// A copy to look ahead with. None: what it remembers cannot be copied, and a forked run goes on without it.
    fn fork(&self) -> Option<Box<dyn Controller>> {
        None
    }

    /// Surfaces that it has added to the scene, for sensors to see.
    fn pieces(&self) -> &[Piece] {
        &[]
    }

    /// The proximity sensor that is object `sensor` of the scene has looked.
    fn detected(&mut self, _sensor: usize, _found: Option<Detection>) {}

    /// Value of a float signal that it has set, to be recorded.
    fn float_signal(&self, _name: &str) -> Option<f64> {
        None
    }

    /// Calls `visit` with name, unit and present value of each stream that it records, always in the same order; new ones come last.
    fn streams(&self, _visit: &mut dyn FnMut(&str, &str, f64)) {}

    /// Takes the places of streams whose past is to be forgotten.
    fn take_cleared_streams(&mut self) -> Vec<usize> {
        Vec::new()
    }

    /// Messages in the order of time, and the number of those that were too many to keep.
    fn messages(&self) -> (Vec<Message>, usize) {
        (Vec::new(), 0)
    }

    /// Changes of the model.
    fn changes(&self) -> &[Change] {
        &[]
    }

    /// Takes requests about the run as a whole; true if one of them is to stop it.
    fn take_stop_request(&mut self) -> bool {
        false
    }
}
