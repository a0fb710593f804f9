//! A scene and its diagram, tick by tick: what a run, a server and a test all drive.

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

use sincro_blocks::runner::LoopOpening;
use sincro_dynamics::signal::Signal;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, Observation, Stop, World};

#[cfg(feature = "jit")]
use super::compiled::{Compilation, EquationsBy};
use super::method_choice::{MethodChanges, MethodChoice};
use super::world_with_room;
use crate::controller::{
    Change, Commands, Controller, Forked, Instant, Message, NotFinite, SavedImage, ScriptFailure, Source,
};
use crate::diagram_controller::DiagramController;
use crate::load::Loaded;
use crate::restructure::{Edit, Renamed, Restructured, restructure};
use crate::runtime_object::RuntimeObject;
use crate::sensors::{Sensors, Timing};
use crate::snapshot::Snapshot;
use crate::structure::Structure;
use crate::trace::Trace;
use sincro_scene::record::{Recorder, float_signals};
use sincro_scene::scene::Scene;
use sincro_scene::script::ScriptError;

/// Run of a scene, step by step: its world with the diagram, scripts and attached controllers that control it.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
/// run.start()?;
/// let before = run.world().energy().total();
/// for _ in 0..20 {
///     run.advance()?;
/// }
/// assert_eq!((run.tick(), run.t()), (20, 1.0)); // [s]
/// assert!((run.world().energy().total() - before).abs() < 1e-5); // it swings freely [J]
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct LockStep {
    world: World,
    /// Choice of `auto`; none for a method by name.
    method: Option<MethodChoice>,
    control: Option<DiagramController<f64>>,
    sensors: Sensors,
    /// Signals of the diagram, then recorded float signals, then values of sensors, as they were last observed.
    signals: Vec<f64>,
    /// Names of the float signals of scripts and clients that are recorded.
    floats: Vec<String>,
    commands: Vec<Signal>,
    /// Source of each command, as it was last latched.
    sources: Vec<Source>,
    /// Commands of scene and diagram for the step that begins, and their sources; scratch.
    upcoming: (Vec<f64>, Vec<Source>),
    step: f64,
    tick: u64,
    /// All that act besides the diagram, in their order.
    controllers: Vec<Box<dyn Controller>>,
    is_started: bool,
    /// Scene at the start.
    scene: Arc<Scene>,
    /// Structure now; none if it is that of the start.
    structure: Option<Structure>,
    timing: Timing,
    #[cfg(feature = "jit")]
    compilation: Compilation,
}

/// Copy of a lock-step to look ahead with; result of [`LockStep::fork`].
#[derive(Debug)]
pub struct Fork {
    /// Copy, independent of the original.
    pub lockstep: LockStep,
    /// Names of controllers, or parts of them, that the copy goes on without.
    pub not_copied: Vec<String>,
}

/// Changes of the structure that a recorder has followed, for [`LockStep::bring_up`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Followed {
    /// Hash of the structure; 0 for that of the start.
    hash: u64,
    /// Energy that the changes have added `[J]`.
    pub energy: f64,
}

/// Reason why a [`LockStep`] cannot go on; [`Halt::explain`] makes a status for the user of it.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
/// run.start()?;
/// run.advance()?;
/// run.world().state.v[0] = f64::NAN;
/// let halt = run.advance().unwrap_err();
/// let Halt::World { tick, t, .. } = halt else { panic!("the world stops") };
/// assert_eq!((tick, t), (1, 0.05));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Halt {
    /// The world could not be advanced from this tick.
    World {
        /// Number of base steps done.
        tick: u64,
        /// Time of the last state reached `[s]`.
        t: f64,
        /// Cause in the dynamics.
        cause: Stop,
    },
    /// A block of the diagram gave a number that is not finite.
    Block {
        /// Number of base steps done when it did; between ticks, that of the tick before.
        tick: u64,
        /// Simulated time `[s]`.
        t: f64,
        /// Block with its inputs and outputs.
        culprit: NotFinite,
    },
    /// A controller or script failed.
    Controller {
        /// Number of base steps done.
        tick: u64,
        /// Simulated time `[s]`.
        t: f64,
        /// True if the world had made the step already.
        is_after_step: bool,
        /// Controller or script, line and cause.
        fault: Box<ScriptError>,
    },
}

impl Halt {
    /// Returns true if the world has made the step all the same, so that its state is that of the tick after.
    #[must_use]
    pub fn is_after_step(&self) -> bool {
        match self {
            Self::World { .. } => false,
            Self::Block { .. } => true,
            Self::Controller { is_after_step, .. } => *is_after_step,
        }
    }
}

impl LockStep {
    /// Creates the lock-step of a scene before its first tick, with the integration method `method` (see
    /// [`method_for`](crate::run::method_for)); `refined` runs it at the finer steps of the error bars.
    /// [`LockStep::start`] comes next.
    #[must_use]
    pub fn new(loaded: &Loaded, method: MethodKind, refined: bool) -> Self {
        let Loaded { scene, experiment, controller, .. } = loaded;
        let control = controller.as_ref().map(|c| DiagramController::new(&c.wiring, &scene.model));
        let n_states = control.as_ref().map_or(0, |c| c.wiring().program().n_states);
        let world = world_with_room(scene, experiment, method, refined, n_states);
        let engine = loaded.extensions.scripts.filter(|_| !scene.scripts.is_empty());
        let controllers = engine.map(|engine| engine.controller(loaded)).into_iter().collect();
        let timing = Timing::new(experiment);
        let sensors = Sensors::new(scene, timing);
        let floats: Vec<String> = float_signals(&experiment.record).map(str::to_owned).collect();
        let room = control.as_ref().map_or(0, |c| c.signals().len()) + floats.len() + sensors.values.len();
        let signals = Vec::with_capacity(room);
        let (commands, step) = (scene.commands.clone(), experiment.step);
        let (sources, is_started) = (vec![Source::Scene; world.state.commands.len()], false);
        let mut new = Self {
            world,
            method: MethodChoice::new(loaded, method),
            control,
            sensors,
            signals,
            floats,
            commands,
            upcoming: (Vec::new(), Vec::new()),
            sources,
            step,
            tick: 0,
            controllers,
            is_started,
            scene: Arc::clone(scene),
            structure: None,
            timing,
            #[cfg(feature = "jit")]
            compilation: Compilation::new(refined),
        };
        match new.control.as_mut().and_then(Controller::continuous) {
            Some(part) => new.world.initialize_with(0.0, part),
            None => new.world.initialize(0.0),
        }
        for factory in &loaded.controllers {
            new.attach(factory.controller(loaded));
        }
        new
    }

    /// Attaches a controller: it acts after those that are attached, and its commands win over theirs.
    ///
    /// # Panics
    ///
    /// If the controller has a continuous part: the world has no room for its states.
    ///
    /// ```
    /// use sincro_sim::prelude::*;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
    /// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
    /// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
    /// // PD control holds the elbow straight
    /// run.attach(Box::new(ClosureController::new("pd", |at: Instant<'_>, held: &mut [Option<f64>]| {
    ///     let (q, v) = (at.world.state.q[1], at.world.state.v[1]);
    ///     held[0] = Some(-20.0 * q - 4.0 * v); // [N·m]
    /// })));
    /// run.start()?;
    /// while run.t() < 5.0 {
    ///     run.advance()?;
    ///     assert!(run.state().q[1].abs() < 0.02); // [rad]
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn attach(&mut self, mut controller: Box<dyn Controller>) {
        assert!(controller.continuous().is_none(), "the world is made with room for the diagram's states alone");
        self.controllers.push(controller);
    }

    /// Returns the first attached controller of the type `C`, with the world; `None` if there is none.
    pub fn controller<C: Controller>(&mut self) -> Option<(&mut C, &mut World)> {
        let Self { controllers, world, .. } = self;
        let found = controllers.iter_mut().find_map(|controller| (&mut **controller as &mut dyn Any).downcast_mut());
        found.map(|controller| (controller, world))
    }

    /// Calls `visit` with each object that controllers have made at run time, and the index of its controller, from 0.
    pub fn visit_runtime_objects(&self, visit: &mut dyn FnMut(usize, &RuntimeObject<'_>)) {
        for (k, controller) in self.controllers.iter().enumerate() {
            controller.runtime_objects(&mut |object| visit(k, object));
        }
    }

    /// All controllers besides the diagram.
    pub(super) fn controllers_mut(&mut self) -> &mut [Box<dyn Controller>] {
        &mut self.controllers
    }

    /// Returns a copy to look ahead with, and the names of what could not be copied.
    #[must_use]
    pub fn fork(&self) -> Fork {
        let (mut controllers, mut not_copied) = (Vec::new(), Vec::new());
        for controller in &self.controllers {
            match controller.fork() {
                Forked::Whole(copy) => controllers.push(copy),
                Forked::Part(copy, missing) => {
                    controllers.push(copy);
                    not_copied.push(missing);
                }
                Forked::Nothing => not_copied.push(controller.name().to_owned()),
            }
        }
        let lockstep = Self {
            world: self.world.clone(),
            method: self.method.clone(),
            control: self.control.clone(),
            sensors: self.sensors.clone(),
            signals: self.signals.clone(),
            floats: self.floats.clone(),
            commands: self.commands.clone(),
            sources: self.sources.clone(),
            upcoming: self.upcoming.clone(),
            controllers,
            scene: Arc::clone(&self.scene),
            structure: self.structure.clone(),
            #[cfg(feature = "jit")]
            compilation: self.compilation.clone(),
            ..*self
        };
        Fork { lockstep, not_copied }
    }

    /// Returns the world, to be read or changed between steps; after a change of its state call
    /// [`World::mark_changed`].
    pub fn world(&mut self) -> &mut World {
        &mut self.world
    }

    /// Returns the state of the world: coordinates, velocities, actuators, in SI units.
    #[must_use]
    pub fn state(&self) -> &State<f64> {
        &self.world.state
    }

    /// Sets all velocities of the world to zero; coordinates and the state of the diagram stay.
    pub fn stop(&mut self) {
        self.world.state.v.fill(0.0);
        self.world.mark_changed();
    }

    /// Sets the state of the world, and the continuous states of the diagram to `continuous`, in their order; an empty
    /// slice leaves the latter.
    ///
    /// # Panics
    ///
    /// If `continuous` is not empty and has another length than the diagram has continuous states.
    ///
    /// ```
    /// use sincro_sim::prelude::*;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
    /// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
    /// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
    /// run.start()?;
    /// let mut hanging = run.state().clone();
    /// hanging.q.fill(0.0);
    /// run.set_state(hanging, &[]);
    /// run.advance()?;
    /// assert!(run.state().v.iter().all(|v| v.abs() < 1e-12)); // an equilibrium: it stays
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_state(&mut self, state: State<f64>, continuous: &[f64]) {
        self.world.state = state;
        self.world.mark_changed();
        if let Some(control) = &mut self.control
            && !continuous.is_empty()
        {
            control.runner.state.continuous.copy_from_slice(continuous);
        }
    }

    /// Draws the noise of sensors by another seed than that of the experiment, from the next sample on.
    #[cfg(feature = "tasks")]
    pub(crate) fn reseed_sensors(&mut self, seed: u64) {
        self.timing.seed = seed;
        self.sensors.reseed(seed);
    }

    /// Returns the controller that runs the scene's diagram; `None` if there is no diagram.
    #[must_use]
    pub fn control(&self) -> Option<&DiagramController<f64>> {
        self.control.as_ref()
    }

    /// Opens a loop of the diagram for analysis, at a signal that a block gives at ticks: from its next evaluation on,
    /// all that reads the signal sees the value of `opening` in its place. `None` closes the loop again. Not part of a
    /// snapshot; without effect where there is no diagram.
    pub fn set_opening(&mut self, opening: Option<LoopOpening<f64>>) {
        if let Some(control) = &mut self.control {
            control.runner.opening = opening;
        }
    }

    /// Returns the base step `[s]`.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Returns the number of base steps done.
    #[must_use]
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Returns the simulated time `[s]`: the tick times the base step.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.tick as f64 * self.step
    }

    /// Starts the controllers and evaluates the diagram for the first time; to be called once before
    /// [`LockStep::advance`]. Continuous commands are seen from then on: the speed of a rotor that lags, the torque of
    /// a continuous controller.
    ///
    /// # Errors
    ///
    /// [`Halt::Controller`]: a controller cannot start. [`Halt::Block`]: a block gives a number that is not finite.
    pub fn start(&mut self) -> Result<(), Halt> {
        self.is_started = true;
        self.follow_structure()?;
        self.call(false, |controller, at| controller.start(at))?;
        self.update_proximity_sensors();
        self.measure()?;
        for controller in all(&mut self.control, &mut self.controllers) {
            controller.write_outputs(&mut self.world.state.commands);
        }
        Ok(())
    }

    /// Lets the controllers clean up, if they were started. The lock-step must not be advanced afterwards.
    ///
    /// # Errors
    ///
    /// [`Halt::Controller`]: a controller fails.
    pub fn end(&mut self) -> Result<(), Halt> {
        if self.is_started { self.call(false, |controller, at| controller.finish(at)) } else { Ok(()) }
    }

    /// Takes the pictures that scripts have saved since the start.
    pub(crate) fn take_images(&mut self) -> Vec<SavedImage> {
        self.controllers.iter_mut().flat_map(|controller| controller.take_images()).collect()
    }

    /// Returns the changes of the model by controllers, controller by controller.
    #[must_use]
    pub fn changes(&self) -> Vec<Change> {
        self.controllers.iter().flat_map(|controller| controller.changes()).cloned().collect()
    }

    /// Calls all controllers at the present instant, in their order, up to the first that fails.
    fn call(
        &mut self,
        is_after_step: bool,
        mut act: impl FnMut(&mut dyn Controller, Instant<'_>) -> Result<(), ScriptError>,
    ) -> Result<(), Halt> {
        let (tick, t) = (self.tick, self.t());
        for k in 0..usize::from(self.control.is_some()) + self.controllers.len() {
            let controller = nth(&mut self.control, &mut self.controllers, k);
            let done = act(controller, Instant { world: &mut self.world, tick, t });
            let changes = controller.take_restructured();
            done.map_err(|fault| Halt::Controller { tick, t, is_after_step, fault: Box::new(fault) })?;
            for change in &changes {
                self.adopt_structure(change, Some(k), is_after_step)?;
            }
        }
        Ok(())
    }

    /// Adopts changes of the structure that controllers have made in the world outside of the step, as when a client
    /// calls a function of the API; to be called after such calls. Each step does it, too.
    ///
    /// # Errors
    ///
    /// [`Halt::Controller`]: a controller cannot go on with the structure.
    pub fn follow_structure(&mut self) -> Result<(), Halt> {
        for k in 0..usize::from(self.control.is_some()) + self.controllers.len() {
            for change in nth(&mut self.control, &mut self.controllers, k).take_restructured() {
                self.adopt_structure(&change, Some(k), false)?;
            }
        }
        Ok(())
    }

    /// Scene of the world as it is now: that of the start, unless its structure was changed.
    #[must_use]
    pub fn scene(&self) -> &Arc<Scene> {
        self.structure.as_ref().map_or(&self.scene, |structure| &structure.scene)
    }

    /// Structure now, if it is not that of the start.
    #[must_use]
    pub fn structure(&self) -> Option<&Structure> {
        self.structure.as_ref()
    }

    /// Lets a recorder of the scene at the start go on with the present structure; `known` is what it has followed so
    /// far. To be called before each row. Returns true if the structure has changed since.
    pub fn bring_up(&self, recorder: &mut Recorder, known: &mut Followed) -> bool {
        let (hash, energy) = self.structure.as_ref().map_or((0, 0.0), |s| (s.hash, s.energy_added));
        if hash == known.hash {
            return false;
        }
        let scene = self.scene();
        let renamed = Renamed::new(&self.scene, scene);
        recorder.follow(&scene.model, &|path| renamed.path(path), energy - known.energy);
        *known = Followed { hash, energy };
        true
    }

    /// Takes over a change of the structure of the world; controller `from` has made it.
    fn adopt_structure(&mut self, change: &Restructured, from: Option<usize>, is_after_step: bool) -> Result<(), Halt> {
        let scene = &change.scene;
        let former = std::mem::replace(&mut self.commands, scene.commands.clone());
        let sources = std::mem::replace(&mut self.sources, vec![Source::Scene; scene.commands.len()]);
        for (k, old) in change.transferred.commands.iter().enumerate() {
            if let Some(old) = old {
                self.commands[k] = former[*old].clone();
                self.sources[k] = sources[*old];
            }
        }
        self.sensors = self.sensors.continued(scene, self.timing);
        if let Some(method) = &mut self.method {
            method.restructured(&scene.model);
        }
        self.structure = Some(Structure::after(self.structure.as_ref(), change));
        let (tick, t) = (self.tick, self.t());
        for k in 0..usize::from(self.control.is_some()) + self.controllers.len() {
            if Some(k) == from {
                continue;
            }
            let controller = nth(&mut self.control, &mut self.controllers, k);
            controller.restructured(change).map_err(|message| {
                let object = controller.name().to_owned();
                let fault = Box::new(ScriptError { object, at: None, message, help: None });
                Halt::Controller { tick, t, is_after_step, fault }
            })?;
        }
        Ok(())
    }

    /// Returns the messages of controllers in the order of time, and the number of those that were too many to keep.
    #[must_use]
    pub fn messages(&self) -> (Vec<Message>, usize) {
        let (mut all, mut n_more) = (Vec::new(), 0);
        for controller in &self.controllers {
            let (messages, more) = controller.messages();
            all.extend(messages);
            n_more += more;
        }
        all.sort_by(|a, b| a.t.total_cmp(&b.t));
        (all, n_more)
    }

    /// Returns the scripts of all controllers that have failed in calls after which the run went on.
    #[must_use]
    pub fn script_failures(&self) -> Vec<ScriptFailure> {
        self.controllers.iter().flat_map(|controller| controller.script_failures()).collect()
    }

    /// Returns true if a controller has asked to stop the run since the last call, and forgets the requests.
    pub fn take_stop_request(&mut self) -> bool {
        // of all of them, not up to the first that asks
        let mut must_stop = false;
        for controller in &mut self.controllers {
            must_stop |= controller.take_stop_request();
        }
        must_stop
    }

    /// Advances the run by one base step, from t_k to t_{k+1}.
    ///
    /// ```text
    /// step(k):
    ///   1 actuate   each controller, the diagram first: commands and forces of the step      t_k
    ///               (controllers know what scene and diagram command)
    ///   2 latch     u ← signals of the scene, then each controller; the strongest source wins
    ///   3 remember  each controller: memory for its next tick
    ///   4 advance   the world goes from t_k to t_{k+1} under u, in sub-steps; a continuous diagram with it.
    ///               If a controller holds the motion, only the count of steps goes on
    ///   5 detect    proximity sensors that are due; then those of each controller              t_{k+1}
    ///   6 sense     each controller: measurements of the step, forces of the next one
    ///   7 evaluate  continuous outputs at t_{k+1}
    ///   8 sample    the other sensors that are due
    ///   9 measure   each controller: measurements at t_{k+1}; blocks that are due are evaluated
    /// ```
    ///
    /// Whoever drives the lock-step hashes and records the state after it. If 1 fails, the state is that of t_k; if 4
    /// fails, that of the last instant reached, and the tick is not counted; if 6 or 9 fails, the step has been made
    /// and counted.
    ///
    /// # Errors
    ///
    /// [`Halt::World`]: the world cannot go on. [`Halt::Block`]: a block gives a number that is not finite.
    /// [`Halt::Controller`]: a controller fails.
    pub fn advance(&mut self) -> Result<(), Halt> {
        self.follow_structure()?;
        let (tick, t) = (self.tick, self.t());
        // 1 actuate
        self.preview();
        self.call(false, |controller, at| controller.actuate(at))?;
        // 2 latch
        self.latch();
        // 3 remember
        all(&mut self.control, &mut self.controllers).for_each(|controller| controller.latched(tick, t));
        // 4 advance
        if let Some(method) = &mut self.method {
            method.choose(tick, t, &mut self.world);
        }
        #[cfg(feature = "jit")]
        self.compile_if_it_pays();
        let advanced = if self.controllers.iter().any(|controller| controller.holds_motion()) {
            self.world.state.tick += 1;
            Ok(())
        } else {
            match self.control.as_mut().and_then(Controller::continuous) {
                Some(part) => self.world.advance_with(t, self.step, part),
                None => self.world.advance(t, self.step),
            }
        };
        if let Err((t, cause)) = advanced {
            // between ticks a block shows in the motion first
            let culprit = self.control.as_ref().and_then(DiagramController::not_finite);
            return Err(culprit.map_or(Halt::World { tick, t, cause }, |culprit| Halt::Block { tick, t, culprit }));
        }
        self.tick += 1;
        // 5 detect
        self.update_proximity_sensors();
        // 6 sense
        self.call(true, |controller, at| controller.sense(at))?;
        // 7 evaluate
        let (tick, t) = (self.tick, self.t());
        for controller in all(&mut self.control, &mut self.controllers) {
            controller.evaluate_outputs(Instant { world: &mut self.world, tick, t });
        }
        // 8 sample, 9 measure
        self.measure()
    }

    /// Compiles the equations of the world at the next step, if that can be done, whether it pays or not. A run that
    /// goes on does so by itself after some thousands of steps: its bits are the same.
    ///
    /// ```
    /// use sincro_sim::prelude::*;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
    /// let loaded = load(folder.as_ref(), &[Override::new("integrator", "rk4")], Extensions::default())?;
    /// let runs = [true, false].map(|is_compiled| {
    ///     let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
    ///     if is_compiled {
    ///         run.compile_equations();
    ///     }
    ///     run.start().unwrap();
    ///     (0..20).for_each(|_| run.advance().unwrap());
    ///     run.state().clone()
    /// });
    /// assert_eq!(runs[0], runs[1]);
    /// # Ok(())
    /// # }
    /// ```
    #[cfg(feature = "jit")]
    pub fn compile_equations(&mut self) {
        self.compilation.want();
    }

    /// Returns the evaluation of the equations of the world: by compiled code, or why not.
    #[cfg(feature = "jit")]
    #[must_use]
    pub fn equations_by(&self) -> &EquationsBy {
        self.compilation.equations_by(&self.world)
    }

    /// Time in which the equations that are evaluated now were compiled `[s]`; `None` for the recursions.
    #[must_use]
    pub fn compile_time(&self) -> Option<f64> {
        #[cfg(feature = "jit")]
        if let EquationsBy::Compiled { elapsed } = self.equations_by() {
            return Some(elapsed.as_secs_f64());
        }
        None
    }

    /// Compiles the equations of the world once that pays, and again after parameters have changed.
    #[cfg(feature = "jit")]
    fn compile_if_it_pays(&mut self) {
        if self.compilation.is_due(self.tick, &self.world) {
            let acts = self.control.as_mut().and_then(Controller::continuous).is_some();
            self.compilation.compile(self.tick, self.step, acts, &mut self.world);
        }
    }

    /// Latches the commands of the present tick without advancing, so that the world is under the inputs of its next
    /// step.
    pub fn latch(&mut self) {
        let mut commands = Commands::of_scene(&mut self.world.state.commands, &mut self.sources);
        set_first(&mut commands, self.tick as f64 * self.step, &self.commands, self.control.as_ref());
        for (k, controller) in self.controllers.iter().enumerate() {
            controller.latch(&mut commands.by(Source::Controller(k)));
        }
        if let Some(diagram) = &mut self.control {
            diagram.note_sources(&self.sources);
        }
    }

    /// Tells the controllers what scene and diagram command for the present tick.
    fn preview(&mut self) {
        if self.controllers.is_empty() {
            return;
        }
        let t = self.t();
        let (values, sources) = &mut self.upcoming;
        values.clone_from(&self.world.state.commands);
        sources.clone_from(&self.sources);
        set_first(&mut Commands::of_scene(values, sources), t, &self.commands, self.control.as_ref());
        for controller in &mut self.controllers {
            controller.preview(&self.upcoming.0);
        }
    }

    /// Returns the scene's signals for the commands, the weakest source of each, in the order of the command vector.
    #[must_use]
    pub fn signals_of_scene(&self) -> &[Signal] {
        &self.commands
    }

    /// Sets the command with the index `command` to the constant `value`, in the unit of its actuator, in place of the
    /// scene's signal: it is latched from the next base step on, unless the diagram or a controller sets that command.
    ///
    /// # Panics
    ///
    /// If there is no such command.
    pub fn hold_command(&mut self, command: usize, value: f64) {
        self.commands[command] = Signal::Constant(value);
    }

    /// Returns the source of each command as it was last latched, in the order of the command vector.
    #[must_use]
    pub fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// Proximity sensors look at the present tick, then the controllers.
    fn update_proximity_sensors(&mut self) {
        let (tick, t) = (self.tick, self.t());
        self.sensors.update_proximity_sensors(&mut self.world, tick, t, &mut self.controllers);
        for controller in all(&mut self.control, &mut self.controllers) {
            controller.update_proximity_sensors(Instant { world: &mut self.world, tick, t });
        }
    }

    /// Sensors take the samples that are due, then the controllers measure.
    fn measure(&mut self) -> Result<(), Halt> {
        let (tick, t) = (self.tick, self.t());
        self.sensors.sample(&mut self.world, tick, t);
        for controller in all(&mut self.control, &mut self.controllers) {
            controller
                .measure(Instant { world: &mut self.world, tick, t }, &self.sensors.values)
                .map_err(|culprit| Halt::Block { tick, t, culprit })?;
        }
        Ok(())
    }

    /// Observes everything that can be recorded, at the present time `t` `[s]`: the world, and a list of the diagram's
    /// signals, then the recorded float signals of scripts and clients (NaN if nobody has set one), then the values of
    /// all sensors, each in its unit. For [`Recorder::row`](sincro_scene::record::Recorder::row).
    pub fn observe(&mut self, t: f64) -> (Observation<'_>, &[f64]) {
        let signals = self.control.as_ref().map_or(&[][..], DiagramController::signals);
        if !(self.sensors.values.is_empty() && self.floats.is_empty()) {
            self.signals.clear();
            self.signals.extend_from_slice(signals);
            let set = |name: &String| self.controllers.iter().find_map(|controller| controller.float_signal(name));
            let float = |name: &String| set(name).unwrap_or(f64::NAN);
            self.signals.extend(self.floats.iter().map(float));
            self.signals.extend_from_slice(&self.sensors.values);
            return (self.world.observe(t), &self.signals);
        }
        (self.world.observe(t), signals)
    }

    /// Returns the hash of the present state alone, with which the trace of a run begins.
    #[must_use]
    pub fn trace(&self) -> Trace {
        let mut trace = Trace::start(&self.world.state);
        self.add_beside_state(&mut trace);
        trace
    }

    /// Adds the present state to the hash `trace` of a run.
    pub fn hash_into(&self, trace: &mut Trace) {
        trace.add(&self.world.state);
        self.add_beside_state(trace);
    }

    /// Adds to a trace what is no part of the state of the world.
    fn add_beside_state(&self, trace: &mut Trace) {
        trace.add_continuous(self.continuous());
        if let Some(structure) = &self.structure {
            trace.add_structure(structure.hash);
        }
    }

    /// Returns a snapshot: everything needed to go on from here bit for bit. `trace` is the hash of the run so far.
    #[must_use]
    pub fn snapshot(&self, trace: Trace) -> Snapshot {
        let diagram = self.control.as_ref().and_then(Controller::save);
        Snapshot {
            params: (self.world.model().params() != self.scene().model.params())
                .then(|| Box::new(self.world.model().params().clone())),
            state: self.world.state.clone(),
            trace,
            method: self.world.method(),
            control: self.world.control(),
            sensors: self.sensors.values.clone(),
            diagram,
            structure: self.structure.clone(),
        }
    }

    /// Restores a snapshot of the same scene and diagram, with the structure that it had then.
    ///
    /// # Panics
    ///
    /// If the snapshot has another number of sensor values, as one of another scene may have, or if the diagram
    /// measures an object that it has not.
    ///
    /// ```
    /// use sincro_sim::prelude::*;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
    /// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
    /// let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
    /// run.start()?;
    /// let here = run.snapshot(run.trace());
    /// run.advance()?;
    /// let first = run.state().clone();
    /// run.restore(&here);
    /// run.advance()?;
    /// assert_eq!(*run.state(), first); // the same bits
    /// # Ok(())
    /// # }
    /// ```
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.restore_structure(snapshot.structure.as_ref());
        let scene = self.scene().clone();
        self.world.set_params(snapshot.params.as_deref().unwrap_or(scene.model.params()));
        self.world.state = snapshot.state.clone();
        if let Some(control) = snapshot.control {
            if self.method.is_some() {
                // a run whose method has a name, or a fixed step, keeps it
                self.world.set_method(snapshot.method);
            }
            self.world.set_control(control);
        }
        self.tick = snapshot.state.tick;
        self.sensors.values.copy_from_slice(&snapshot.sensors);
        if let (Some(control), Some(state)) = (&mut self.control, &snapshot.diagram) {
            control.restore(state, &snapshot.state);
        }
    }

    /// Begins with another structure than that of the scene, in its initial state; to be called before
    /// [`LockStep::start`].
    ///
    /// # Panics
    ///
    /// If the diagram measures or commands an object that the structure has not.
    pub fn set_structure(&mut self, structure: &Structure) {
        self.restore_structure(Some(structure));
        self.world.state = State { tick: 0, ..structure.scene.initial.clone() };
        match self.control.as_mut().and_then(Controller::continuous) {
            Some(part) => self.world.initialize_with(0.0, part),
            None => self.world.initialize(0.0),
        }
    }

    /// Replaces the world by one of the structure of a snapshot, if that is another one.
    fn restore_structure(&mut self, structure: Option<&Structure>) {
        if self.structure.as_ref() == structure {
            return;
        }
        let scene = structure.map_or(&self.scene, |structure| &structure.scene).clone();
        let from = self.scene().clone();
        let edit = Edit { from: &from, copies: &BTreeMap::new(), conserves_momentum: false };
        let mut change = restructure(&mut self.world, (*scene).clone(), &edit);
        // loops select their rows in the state after the change: the world is made there again
        self.world = self.world.continued((*scene.model).clone(), scene.initial.clone(), &|_| None);
        change.scene = scene;
        let adopted = self.adopt_structure(&change, None, false);
        adopted.expect("the diagram has run with the structure of the snapshot");
        self.structure = structure.cloned();
    }

    /// Changes of the integration method so far, by `auto`.
    pub(super) fn method_changes(&self) -> MethodChanges {
        self.method.as_ref().map_or(MethodChanges::default(), |method| method.changes)
    }

    /// Returns the notices of the diagram's blocks about the run so far, one sentence each.
    #[must_use]
    pub fn notices(&self) -> Vec<String> {
        let notices = self.control.iter().flat_map(|control| control.runner.notices());
        notices.map(|(path, words)| format!("block `{path}` {words}")).collect()
    }

    /// Continuous states of the diagram: part of what is integrated.
    fn continuous(&self) -> &[f64] {
        self.control.as_ref().map_or(&[], |c| &c.runner.state.continuous)
    }
}

/// Sets the commands of the scene's signals at time `t` `[s]`, then those of the diagram.
fn set_first(commands: &mut Commands<'_>, t: f64, signals: &[Signal], diagram: Option<&DiagramController<f64>>) {
    for (command, signal) in signals.iter().enumerate() {
        commands.set(command, signal.value(t));
    }
    if let Some(diagram) = diagram {
        diagram.latch(&mut commands.by(Source::Diagram));
    }
}

/// The diagram, then the other controllers in their order.
fn all<'a>(
    diagram: &'a mut Option<DiagramController<f64>>,
    others: &'a mut [Box<dyn Controller>],
) -> impl Iterator<Item = &'a mut dyn Controller> {
    let diagram = diagram.iter_mut().map(|diagram| diagram as &mut dyn Controller);
    diagram.chain(others.iter_mut().map(|controller| &mut **controller))
}

/// Controller `k`: the diagram is the first one, if there is one.
fn nth<'a>(
    diagram: &'a mut Option<DiagramController<f64>>,
    others: &'a mut [Box<dyn Controller>],
    k: usize,
) -> &'a mut dyn Controller {
    match diagram {
        Some(diagram) if k == 0 => diagram,
        Some(_) => &mut *others[k - 1],
        None => &mut *others[k],
    }
}
