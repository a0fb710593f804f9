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
use sincro_scene::scenery::Piece;
use sincro_scene::script::ScriptError;

/// Instant of a step, with the world at that instant.
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
    /// Which number: `mass`, `center_of_mass`, `inertia` (xx, xy, xz, yy, yz, zz), `limits` (lower, upper), `coupling`
    /// (ratio, offset), `respondable`, `gravity`.
    pub quantity: &'static str,
    /// The new numbers, in the units of the scene file.
    pub value: Vec<f64>,
}

/// Source of a command. A stronger one wins: the scene's signals are the weakest, then the diagram, then controllers in
/// the order in which they were attached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A signal of the scene file.
    Scene,
    /// The block diagram.
    Diagram,
    /// A controller, by its place among those that were attached.
    Controller(usize),
}

/// The commands of one instant, each with its source.
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
    /// Commands of a world in the units of their actuators, as the scene's signals give them at an instant; `sources`
    /// has one place for each.
    pub fn of_scene(values: &'a mut [f64], sources: &'a mut [Source]) -> Self {
        sources.fill(Source::Scene);
        Self { values, sources, source: Source::Scene }
    }

    /// The same commands, to be set by another source.
    pub fn by(&mut self, source: Source) -> Commands<'_> {
        Commands { values: self.values, sources: self.sources, source }
    }

    /// Sets the command of that index, in the unit of its actuator, unless a stronger source has set it at this
    /// instant.
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

/// A block whose output is not a finite number.
#[derive(Clone, Debug, PartialEq)]
pub struct NotFinite {
    /// Its path.
    pub block: String,
    /// Its kind.
    pub kind: &'static str,
    /// Its outputs.
    pub outputs: Vec<f64>,
    /// Its inputs.
    pub inputs: Vec<f64>,
    /// Diagnostic of the block itself.
    pub fault: Option<Box<str>>,
}

/// A copy of a controller, as far as it can be copied.
#[derive(Debug)]
pub enum Forked {
    /// All of it.
    Whole(Box<dyn Controller>),
    /// The copy, and the name of what it goes on without.
    Part(Box<dyn Controller>, String),
    /// Nothing can be copied.
    Nothing,
}

/// A controller in lock-step.
///
/// | call | instant | may write | if it fails |
/// |---|---|---|---|
/// | [`start`](Controller::start) | once, before the first tick | the world | the run stops at tick 0, nothing is advanced |
/// | [`actuate`](Controller::actuate) | t_k, before the world advances | the world, its own memory | the run stops at t_k: the state is that of t_k |
/// | [`latch`](Controller::latch) | t_k, after all have acted | commands, through [`Commands::set`] | cannot fail |
/// | [`latched`](Controller::latched) | t_k, under the commands of the step | its own memory | cannot fail |
/// | [`continuous`](Controller::continuous) | between t_k and t_{k+1} | its own states and commands | shows in the motion: the run stops there |
/// | [`update_proximity_sensors`](Controller::update_proximity_sensors) | t_{k+1}, once the scene's proximity sensors are up to date | its own memory | cannot fail |
/// | [`sense`](Controller::sense) | t_{k+1} | the world, for the next step | the run stops at t_{k+1}: the step has been made and is recorded |
/// | [`evaluate_outputs`](Controller::evaluate_outputs) | t_{k+1} | its continuous commands | cannot fail |
/// | [`measure`](Controller::measure) | t_{k+1}, once all sensors have their samples | its own memory | as `sense` |
/// | [`write_outputs`](Controller::write_outputs) | once, after the first `measure` | its continuous commands | cannot fail |
/// | [`finish`](Controller::finish) | once, after the last tick | its own memory | the end of the run is reported as a stop |
///
/// It decides by the tick at which it is called whether a step of its own begins. All methods but [`Controller::name`]
/// do nothing unless they are implemented. Nothing in it may depend on a clock or on the order of threads: the same
/// calls give the same bits.
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
    /// Name of the controller in messages.
    fn name(&self) -> &str;

    /// Prepares the controller for a run: called before the first tick, and again where a snapshot was restored.
    ///
    /// # Errors
    ///
    /// It cannot control this run.
    fn start(&mut self, _: Instant<'_>) -> Result<(), ScriptError> {
        Ok(())
    }

    /// Gives the commands and forces of the base step that begins.
    ///
    /// # Errors
    ///
    /// It cannot go on.
    fn actuate(&mut self, _: Instant<'_>) -> Result<(), ScriptError> {
        Ok(())
    }

    /// Sets the commands that it determines.
    fn latch(&self, _: &mut Commands<'_>) {}

    /// Called when the commands of the step at tick `tick`, time `t` `[s]`, are latched: its memory becomes that of the
    /// next tick.
    fn latched(&mut self, _tick: u64, _t: f64) {}

    /// Its continuous part, integrated with the world; none if nothing happens between ticks. The world must have been
    /// made with room for its states, as it is for the diagram: a controller that is attached later has none.
    fn continuous(&mut self) -> Option<&mut dyn CoupledSystem<f64>> {
        None
    }

    /// Updates its own proximity sensors after the step, once those of the scene are up to date; at the start, too.
    fn update_proximity_sensors(&mut self, _: Instant<'_>) {}

    /// Measurements of the step that ends, and forces of the next one.
    ///
    /// # Errors
    ///
    /// It cannot go on.
    fn sense(&mut self, _: Instant<'_>) -> Result<(), ScriptError> {
        Ok(())
    }

    /// Evaluates its continuous outputs at the end of the step, before any measurement.
    fn evaluate_outputs(&mut self, _: Instant<'_>) {}

    /// Measurements at a tick, with the values that all sensors gave last; at the start, too. The next commands follow
    /// from them.
    ///
    /// # Errors
    ///
    /// An output is not a finite number.
    fn measure(&mut self, _: Instant<'_>, _sensors: &[f64]) -> Result<(), NotFinite> {
        Ok(())
    }

    /// Writes its continuous outputs, in the units of the commands, as they were last evaluated, so that they are
    /// observed at the start, before they act; sampled ones are not written.
    fn write_outputs(&self, _commands: &mut [f64]) {}

    /// After the last tick, if it was started.
    ///
    /// # Errors
    ///
    /// It could not clean up.
    fn finish(&mut self, _: Instant<'_>) -> Result<(), ScriptError> {
        Ok(())
    }

    /// Its state, as a snapshot holds it. None: a snapshot goes on without its memory.
    fn save(&self) -> Option<State<f64>> {
        None
    }

    /// Goes back to a state that it has saved, in a world that has gone back to `world`.
    fn restore(&mut self, _saved: &State<f64>, _world: &WorldState<f64>) {}

    /// A copy to look ahead with.
    fn fork(&self) -> Forked {
        Forked::Nothing
    }

    /// Surfaces that it has added to the scene, for sensors to see.
    fn pieces(&self) -> &[Piece] {
        &[]
    }

    /// Result of the proximity sensor that is object `sensor` of the scene.
    fn detected(&mut self, _sensor: usize, _found: Option<Detection>) {}

    /// Value of a float signal that it has set, to be recorded; it carries no unit.
    fn float_signal(&self, _name: &str) -> Option<f64> {
        None
    }

    /// Calls `visit` with name, unit and present value of each stream that it records, always in the same order; new
    /// ones come last.
    fn streams(&self, _visit: &mut dyn FnMut(&str, &str, f64)) {}

    /// Takes the places of streams whose past is to be forgotten.
    fn take_cleared_streams(&mut self) -> Vec<usize> {
        Vec::new()
    }

    /// Messages in the order of time, and the number of those that were too many to keep.
    fn messages(&self) -> (Vec<Message>, usize) {
        (Vec::new(), 0)
    }

    /// Changes of the model that the controller has made, for the results.
    fn changes(&self) -> &[Change] {
        &[]
    }

    /// Takes requests about the run as a whole; true if one of them is to stop it.
    fn take_stop_request(&mut self) -> bool {
        false
    }
}

/// A control law as a closure: it sees the world at each tick and holds commands.
pub struct ClosureController<F> {
    name: String,
    law: F,
    held: Vec<Option<f64>>,
}

impl<F: FnMut(Instant<'_>, &mut [Option<f64>]) + Send + 'static> ClosureController<F> {
    /// A law that is called at every base step with the commands that it holds; none gives a command back.
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
