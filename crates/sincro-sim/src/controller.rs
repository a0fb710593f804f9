//! Controllers in lock-step: everything that acts on the world at its own sample time, while the world waits for it.
//!
//! [`crate::run::LockStep::advance`] calls them, the diagram first, then those that were attached, in their order.
//! Which of them gives a command is decided in [`Commands::set`]. A Rust closure is one by [`ClosureController`].

use std::any::Any;
use std::fmt;

use sincro_blocks::runner::State;
use sincro_dynamics::coupled::CoupledSystem;
use sincro_dynamics::state::State as WorldState;
use sincro_dynamics::world::World;

use crate::proximity::Detection;
use crate::restructure::Restructured;
use crate::runtime_object::RuntimeObject;
use sincro_scene::scenery::Piece;
use sincro_scene::script::ScriptError;

/// Instant of a step at which a controller is called, with the world at that instant.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
/// // a torque of 1 N·m at the elbow for the first 0.5 s
/// run.attach(Box::new(ClosureController::new("pulse", |at: Instant<'_>, held: &mut [Option<f64>]| {
///     assert_eq!(at.t, at.tick as f64 * 0.05);
///     held[0] = Some(if at.t < 0.5 { 1.0 } else { 0.0 });
/// })));
/// run.start()?;
/// run.advance()?;
/// assert_eq!(run.state().commands, [1.0]);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Instant<'a> {
    /// World that is controlled; its state is that of time `t`.
    pub world: &'a mut World,
    /// Number of base steps done since the start.
    pub tick: u64,
    /// Simulated time `[s]`, `tick` times the base step.
    pub t: f64,
}

/// Message of a controller or script to the user, kept with the results of the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Simulated time of the message `[s]`.
    pub t: f64,
    /// Path of the object whose script speaks, or name of the controller.
    pub object: String,
    /// Text of the message.
    pub text: String,
}

/// Errors of a script in a run that went on: scripts of V-REP are called again after an error.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptFailure {
    /// Path of the object that the script belongs to.
    pub object: String,
    /// Number of calls that failed.
    pub count: u64,
    /// Simulated time of the first one `[s]`.
    pub first: f64,
    /// Error of the first one, with its line.
    pub message: String,
}

/// Picture that a script has saved, or text that it has written, kept with the results of the run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedImage {
    /// Name of the file: letters, digits, `.`, `_`, `-` and spaces.
    pub name: String,
    /// Content of the file, in the format that the end of the name says.
    pub bytes: Vec<u8>,
}

/// Change of a number of the model by a controller or client during a run, recorded with the results so that they can
/// be interpreted.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Simulated time from which the change holds `[s]`; 0 also for changes before the run.
    pub t: f64,
    /// Path of the object; `/` for the world.
    pub object: String,
    /// Name of the quantity, as in the scene file: `mass`, `center_of_mass`, `inertia` (xx, xy, xz, yy, yz, zz),
    /// `limits` (lower, upper), `coupling` (ratio, offset), `respondable`, `gravity`; `detectable`; of a proximity
    /// sensor `detects`, the handle of an object or collection, −1 for all.
    pub quantity: &'static str,
    /// New numbers, as many as the quantity has, in the units of the scene file. Of the structure: `added`, `removed`
    /// and
    /// `hung` have none; `momentum` has the jump of the linear `[kg·m/s]` and angular `[kg·m²/s]` momentum of all
    /// bodies,
    /// `energy` that of the energy and the energy lost by joining `[J]`.
    pub value: Vec<f64>,
}

/// Source of a command. Of several that set the same command the strongest wins: signals of the scene are the weakest,
/// then the diagram, then controllers in the order in which they were attached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Signal of the scene file.
    Scene,
    /// Block diagram of the scene.
    Diagram,
    /// Controller, by its index among those attached, from 0.
    Controller(usize),
}

/// Commands of all actuators at one instant, each with its source, which a controller sets in [`Controller::latch`].
///
/// ```
/// use sincro_sim::controller::Source;
/// use sincro_sim::prelude::*;
///
/// let (mut values, mut sources) = ([0.0; 2], [Source::Scene; 2]);
/// let mut commands = Commands::of_scene(&mut values, &mut sources);
/// commands.by(Source::Controller(0)).set(0, 5.0);
/// commands.by(Source::Diagram).set(0, 1.0); // weaker: a controller has set it
/// commands.by(Source::Diagram).set(1, 2.0);
/// assert_eq!(values, [5.0, 2.0]);
/// ```
#[derive(Debug)]
pub struct Commands<'a> {
    values: &'a mut [f64],
    sources: &'a mut [Source],
    source: Source,
}

impl<'a> Commands<'a> {
    /// Creates the commands of one instant: `values` holds the value of each command in the unit of its actuator,
    /// `sources`, of the same length, receives the source of each, at first [`Source::Scene`].
    pub fn of_scene(values: &'a mut [f64], sources: &'a mut [Source]) -> Self {
        sources.fill(Source::Scene);
        Self { values, sources, source: Source::Scene }
    }

    /// Returns the same commands, to be set by `source` from now on; [`Commands::set`] compares its strength.
    pub fn by(&mut self, source: Source) -> Commands<'_> {
        Commands { values: self.values, sources: self.sources, source }
    }

    /// Sets the command with the index `command` in the model's command vector to `value`, in the unit of its actuator,
    /// unless a stronger source has set it at this instant.
    ///
    /// # Panics
    ///
    /// If there is no such command.
    pub fn set(&mut self, command: usize, value: f64) {
        let wins = match (self.sources[command], self.source) {
            (Source::Scene, _) => true,
            (Source::Diagram, new) => new != Source::Scene,
            (Source::Controller(set), Source::Controller(new)) => new >= set,
            (Source::Controller(_), Source::Scene | Source::Diagram) => false,
        };
        if wins {
            (self.values[command], self.sources[command]) = (value, self.source);
        }
    }
}

/// Block of a diagram whose output is not a finite number: the error that ends a run there.
#[derive(Clone, Debug, PartialEq)]
pub struct NotFinite {
    /// Path of the block in the diagram.
    pub block: String,
    /// Name of its kind, such as `gain`.
    pub kind: &'static str,
    /// Values of its outputs, one after the other, in the order of its ports.
    pub outputs: Vec<f64>,
    /// Values of its inputs, one after the other, in the order of its ports.
    pub inputs: Vec<f64>,
    /// Error message of the block itself, such as of a script in it, if there is one.
    pub fault: Option<Box<str>>,
}

/// Copy of a controller for a look ahead, as far as it can be copied; result of [`Controller::fork`].
#[derive(Debug)]
pub enum Forked {
    /// Complete copy.
    Whole(Box<dyn Controller>),
    /// Incomplete copy, and the name of the part that is missing.
    Part(Box<dyn Controller>, String),
    /// The controller cannot be copied.
    Nothing,
}

/// Controller in lock-step with the world: it is called at fixed instants of each base step, reads the state and gives
/// commands. [`LockStep::attach`](crate::run::LockStep::attach) adds one to a run.
///
/// | call | instant | may write | if it fails |
/// |---|---|---|---|
/// | [`start`](Controller::start) | once, before the first tick | the world | the run stops at tick 0, nothing is
/// advanced |
/// | [`preview`](Controller::preview) | t_k, before all act | its own memory | cannot fail |
/// | [`actuate`](Controller::actuate) | t_k, before the world advances | the world, its own memory | the run stops at
/// t_k: the state is that of t_k |
/// | [`latch`](Controller::latch) | t_k, after all have acted | commands, through [`Commands::set`] | cannot fail |
/// | [`latched`](Controller::latched) | t_k, under the commands of the step | its own memory | cannot fail |
/// | [`continuous`](Controller::continuous) | between t_k and t_{k+1} | its own states and commands | shows in the
/// motion: the run stops there |
/// | [`update_proximity_sensors`](Controller::update_proximity_sensors) | t_{k+1}, once the scene's proximity sensors
/// are up to date | its own memory | cannot fail |
/// | [`sense`](Controller::sense) | t_{k+1} | the world, for the next step | the run stops at t_{k+1}: the step has
/// been made and is recorded |
/// | [`evaluate_outputs`](Controller::evaluate_outputs) | t_{k+1} | its continuous commands | cannot fail |
/// | [`measure`](Controller::measure) | t_{k+1}, once all sensors have their samples | its own memory | as `sense` |
/// | [`write_outputs`](Controller::write_outputs) | once, after the first `measure` | its continuous commands | cannot
/// fail |
/// | [`finish`](Controller::finish) | once, after the last tick | its own memory | the end of the run is reported as a
/// stop |
///
/// A controller decides by the tick at which it is called whether a step of its own begins. All methods but
/// [`Controller::name`] do nothing unless they are implemented. Nothing in it may depend on a clock or on the order of
/// threads: the same calls give the same bits.
///
/// ```
/// use sincro_scene::script::ScriptError;
/// use sincro_sim::prelude::*;
///
/// /// A torque against the velocity of the elbow.
/// #[derive(Debug)]
/// struct Brake {
///     torque: f64,
/// }
///
/// impl Controller for Brake {
///     fn name(&self) -> &str {
///         "brake"
///     }
///     fn actuate(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
///         self.torque = -2.0 * at.world.state.v[1]; // 2 N·m·s/rad
///         Ok(())
///     }
///     fn latch(&self, commands: &mut Commands<'_>) {
///         commands.set(0, self.torque);
///     }
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
/// run.attach(Box::new(Brake { torque: 0.0 }));
/// run.start()?;
/// let before = run.world().energy().total();
/// while run.t() < 2.0 {
///     run.advance()?;
/// }
/// assert!(run.world().energy().total() < before); // it takes energy out
/// # Ok(())
/// # }
/// ```
pub trait Controller: Any + Send + fmt::Debug {
    /// Returns the name of the controller, by which messages and reports call it.
    fn name(&self) -> &str;

    /// Prepares the controller for a run: called before the first tick, and again where a snapshot was restored.
    ///
    /// # Errors
    ///
    /// A [`ScriptError`] if it cannot control this run; the run stops before anything is advanced.
    fn start(&mut self, _: Instant<'_>) -> Result<(), ScriptError> {
        Ok(())
    }

    /// Takes note of the commands of scene and diagram for the base step that begins, each in the unit of its actuator:
    /// they are latched after [`Controller::actuate`], unless a controller sets another.
    fn preview(&mut self, _commands: &[f64]) {}

    /// Computes commands and forces of the base step that begins; the commands are passed on in [`Controller::latch`],
    /// forces are applied to the world directly.
    ///
    /// # Errors
    ///
    /// A [`ScriptError`] if it cannot go on; the run stops at this instant.
    fn actuate(&mut self, _: Instant<'_>) -> Result<(), ScriptError> {
        Ok(())
    }

    /// Sets the commands that the controller determines, through [`Commands::set`].
    fn latch(&self, _: &mut Commands<'_>) {}

    /// Called at tick `_tick` and time `_t` `[s]` when the commands of the step are latched: the controller's memory
    /// becomes that of the next tick.
    fn latched(&mut self, _tick: u64, _t: f64) {}

    /// Returns the continuous part of the controller, which is integrated with the world; `None` if nothing happens
    /// between ticks. Only the diagram has one: the world is created with room for its states, and a controller that is
    /// attached later must return `None`.
    fn continuous(&mut self) -> Option<&mut dyn CoupledSystem<f64>> {
        None
    }

    /// Returns true if the motion holds in the step that begins: time goes on, and everything else stays where it is.
    fn holds_motion(&self) -> bool {
        false
    }

    /// Updates the controller's own proximity sensors after the step and at the start, once those of the scene are up
    /// to date.
    fn update_proximity_sensors(&mut self, _: Instant<'_>) {}

    /// Takes measurements at the end of the step and applies forces for the next one.
    ///
    /// # Errors
    ///
    /// A [`ScriptError`] if it cannot go on; the step has been made and is recorded, and the run stops.
    fn sense(&mut self, _: Instant<'_>) -> Result<(), ScriptError> {
        Ok(())
    }

    /// Evaluates the continuous outputs at the end of the step, before any measurement.
    fn evaluate_outputs(&mut self, _: Instant<'_>) {}

    /// Takes measurements at a tick and at the start, from which the next commands follow. `_sensors` holds the last
    /// values of all sensors, in the order of the scene's sensors and of
    /// [`SensorKind::values`](sincro_scene::sensor::SensorKind::values), in their units.
    ///
    /// # Errors
    ///
    /// [`NotFinite`] with the block whose output is not a finite number; the run stops.
    fn measure(&mut self, _: Instant<'_>, _sensors: &[f64]) -> Result<(), NotFinite> {
        Ok(())
    }

    /// Writes the continuous outputs as they were last evaluated into `_commands`, the command vector in the units of
    /// the actuators, so that they are observed at the start, before they act. Sampled outputs are not written.
    fn write_outputs(&self, _commands: &mut [f64]) {}

    /// Cleans up after the last tick, if the controller was started.
    ///
    /// # Errors
    ///
    /// A [`ScriptError`] if that fails; the end of the run is then reported as a stop.
    fn finish(&mut self, _: Instant<'_>) -> Result<(), ScriptError> {
        Ok(())
    }

    /// Returns the controller's state for a snapshot; `None`: snapshots do not contain its memory.
    fn save(&self) -> Option<State<f64>> {
        None
    }

    /// Restores the state `_saved` that [`Controller::save`] returned, in a world that has gone back to the state
    /// `_world`.
    fn restore(&mut self, _saved: &State<f64>, _world: &WorldState<f64>) {}

    /// Returns a copy of the controller to look ahead with; by default it cannot be copied.
    fn fork(&self) -> Forked {
        Forked::Nothing
    }

    /// Returns the surfaces that the controller has added to the scene, for sensors to see; empty by default.
    fn pieces(&self) -> &[Piece] {
        &[]
    }

    /// Returns the numbers of the objects, in ascending order, that the proximity sensor that is object `_sensor` of
    /// the scene may detect; `None`, the default, if the scene decides.
    fn detected_objects(&self, _sensor: usize) -> Option<Vec<usize>> {
        None
    }

    /// Returns true if no proximity sensor detects object `_object`, of the scene or of [`Controller::pieces`]; false
    /// by default.
    fn is_undetectable(&self, _object: usize) -> bool {
        false
    }

    /// Calls `_visit` with each object that the controller has made or moved at run time, for pictures: shapes,
    /// sensors, dummies, drawings; none by default.
    fn runtime_objects(&self, _visit: &mut dyn FnMut(&RuntimeObject<'_>)) {}

    /// Receives the result of the proximity sensor that is object `_sensor` of the scene: the detection, `None` if
    /// nothing is in its volume.
    fn detected(&mut self, _sensor: usize, _found: Option<Detection>) {}

    /// Returns the value of the float signal `_name` that the controller has set, without a unit, to be recorded;
    /// `None` if it has not set it.
    fn float_signal(&self, _name: &str) -> Option<f64> {
        None
    }

    /// Calls `_visit` with name, unit and present value of each data stream that the controller records, always in the
    /// same order; new ones come last.
    fn streams(&self, _visit: &mut dyn FnMut(&str, &str, f64)) {}

    /// Returns the indices (in the order of [`Controller::streams`]) of the streams whose recorded past is to be
    /// deleted, and forgets the request.
    fn take_cleared_streams(&mut self) -> Vec<usize> {
        Vec::new()
    }

    /// Returns the messages so far in the order of time, and the number of those that were too many to keep.
    fn messages(&self) -> (Vec<Message>, usize) {
        (Vec::new(), 0)
    }

    /// Returns the scripts that have failed since the start in calls after which the run went on, each once; none by
    /// default.
    fn script_failures(&self) -> Vec<ScriptFailure> {
        Vec::new()
    }

    /// Takes the pictures that scripts have saved since the start, each name once; none by default.
    fn take_images(&mut self) -> Vec<SavedImage> {
        Vec::new()
    }

    /// Returns the changes of the model that the controller has made, in the order of time, for the results.
    fn changes(&self) -> &[Change] {
        &[]
    }

    /// Takes the changes of the structure that the controller has made in the world since the last call, in their
    /// order.
    fn take_restructured(&mut self) -> Vec<Restructured> {
        Vec::new()
    }

    /// Receives a change of the structure that another controller has made in the world, or that comes with a snapshot.
    ///
    /// # Errors
    ///
    /// A sentence, if the controller cannot go on; the run stops.
    fn restructured(&mut self, _change: &Restructured) -> Result<(), String> {
        Ok(())
    }

    /// Returns true if the controller has asked to stop the run since the last call, and forgets the request.
    fn take_stop_request(&mut self) -> bool {
        false
    }
}

/// Controller made of a closure, which sees the world at each base step and holds commands; the simplest way to write a
/// control law in Rust.
pub struct ClosureController<F> {
    name: String,
    law: F,
    held: Vec<Option<f64>>,
}

impl<F: FnMut(Instant<'_>, &mut [Option<f64>]) + Send + 'static> ClosureController<F> {
    /// Creates a controller named `name` whose closure `law` is called at every base step with the instant and with the
    /// commands that it holds: one entry for each command of the model, in the unit of its actuator, `None` where the
    /// controller sets none.
    ///
    /// ```
    /// use sincro_sim::controller::{Instant, ClosureController};
    ///
    /// let pd = ClosureController::new("pd", |at: Instant<'_>, held: &mut [Option<f64>]| {
    ///     let (q, v) = (at.world.state.q[0], at.world.state.v[0]);
    ///     held[0] = Some(-20.0 * q - 4.0 * v);
    /// });
    /// ```
    pub fn new(name: &str, law: F) -> Self {
        Self { name: name.to_owned(), law, held: Vec::new() }
    }
}

impl<F> fmt::Debug for ClosureController<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ClosureController").field("name", &self.name).field("held", &self.held).finish_non_exhaustive()
    }
}

impl<F: FnMut(Instant<'_>, &mut [Option<f64>]) + Send + 'static> Controller for ClosureController<F> {
    fn name(&self) -> &str {
        &self.name
    }

    fn actuate(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        self.held.resize(at.world.state.commands.len(), None);
        (self.law)(at, &mut self.held);
        Ok(())
    }

    fn latch(&self, commands: &mut Commands<'_>) {
        for (command, held) in self.held.iter().enumerate() {
            if let Some(value) = held {
                commands.set(command, *value);
            }
        }
    }
}
