//! A scene and its diagram, tick by tick: what a run, a server and a test all drive.

use sincro_dynamics::signal::Signal;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, Observation, Stop, World};

use super::trace::Trace;
use super::world_with_room;
use crate::diagram::{Control, NotFinite};
use crate::load::Loaded;
use crate::record::float_signals;
use crate::script::{self, Fault, Message, Phase, Scripts, Setting};
use crate::sensor::Sensors;
use crate::session::{self, Desk, Handle, Refusal, Table, Value};
use crate::snapshot::Snapshot;

/// A world with its controller.
#[derive(Clone, Debug)]
pub struct LockStep {
    world: World,
    control: Option<Control<f64>>,
    sensors: Sensors,
    /// Signals of the diagram, then recorded float signals, then values of sensors, as they were last observed.
    signals: Vec<f64>,
    /// Names of the float signals of scripts and clients that are recorded.
    floats: Vec<String>,
    commands: Vec<Signal>,
    step: f64,
    tick: u64,
    /// What clients and scripts see of the scene and hold in it, if there are any.
    table: Option<Box<Table>>,
    scripts: OwnScripts,
}

/// Scripts of a lock-step. A copy has none: what they remember is theirs alone; copies are for looking at where the original is.
#[derive(Debug, Default)]
struct OwnScripts(Option<Scripts>);

impl Clone for OwnScripts {
    fn clone(&self) -> Self {
        Self(None)
    }
}

/// Why it could not go on.
#[derive(Clone, Debug, PartialEq)]
pub enum Halt {
    /// The world could not be advanced from this tick.
    World {
        /// The tick.
        tick: u64,
        /// Where `[s]`.
        t: f64,
        /// Why.
        cause: Stop,
    },
    /// A block gave what is not a finite number.
    Block {
        /// The tick at which it did, or after which, if it did between ticks.
        tick: u64,
        /// Where `[s]`.
        t: f64,
        /// The block.
        culprit: NotFinite,
    },
    /// A script failed.
    Script {
        /// The tick.
        tick: u64,
        /// Where `[s]`.
        t: f64,
        /// Whether the world has made the step.
        is_after_step: bool,
        /// Which, where and why.
        fault: Fault,
    },
}

impl Halt {
    /// Whether the world has made the step all the same, so that the state is that of another tick.
    #[must_use]
    pub fn is_after_step(&self) -> bool {
        match self {
            Self::World { .. } => false,
            Self::Block { .. } => true,
            Self::Script { is_after_step, .. } => *is_after_step,
        }
    }
}

impl LockStep {
    /// Before the first tick.
    #[must_use]
    pub fn new(loaded: &Loaded, method: MethodKind, refined: bool) -> Self {
        let Loaded { scene, experiment, controller, .. } = loaded;
        let control = controller.as_ref().map(|c| Control::new(&c.wiring, &scene.model));
        let n_states = control.as_ref().map_or(0, |c| c.wiring().program().n_states);
        let world = world_with_room(scene, experiment, method, refined, n_states);
        let ticks = experiment.simulation_ticks;
        let setting = Setting { step: experiment.step * ticks as f64, seed: experiment.seed };
        let scripts = Scripts::of(scene, setting);
        let table = scripts.is_some().then(|| {
            let mut table = Table::new(loaded, ticks);
            table.phase = session::Phase::Running;
            Box::new(table)
        });
        let sensors = Sensors::new(scene, experiment);
        let floats: Vec<String> = float_signals(&experiment.record).map(str::to_owned).collect();
        let room = control.as_ref().map_or(0, |c| c.signals().len()) + floats.len() + sensors.values.len();
        let signals = Vec::with_capacity(room);
        let (commands, scripts) = (scene.commands.clone(), OwnScripts(scripts));
        let step = experiment.step;
        let mut new = Self { world, control, sensors, signals, floats, commands, step, tick: 0, table, scripts };
        match &mut new.control {
            Some(control) if control.is_continuous() => new.world.initialize_with(0.0, control),
            _ => new.world.initialize(0.0),
        }
        new
    }

    /// Gives clients and scripts their table of objects: what they hold there is latched from the next tick on.
    pub fn set_table(&mut self, table: Box<Table>) {
        self.table = Some(table);
    }

    /// Takes the table of objects away again.
    pub fn take_table(&mut self) -> Option<Box<Table>> {
        self.table.take()
    }

    /// The table of objects with the world that it is about; none if nobody asked for one.
    pub fn desk(&mut self) -> Option<Desk<'_>> {
        let t = self.t();
        self.table.as_mut().map(|table| Desk::new(table, &mut self.world, t))
    }

    /// The world.
    pub fn world(&mut self) -> &mut World {
        &mut self.world
    }

    /// State of the world.
    #[must_use]
    pub fn state(&self) -> &State<f64> {
        &self.world.state
    }

    /// Brings everything to rest where it is.
    pub fn stop(&mut self) {
        self.world.state.v.fill(0.0);
    }

    /// Puts the world into another state, and the diagram's continuous states with it (none to leave them).
    pub fn place(&mut self, state: State<f64>, continuous: &[f64]) {
        self.world.state = state;
        if let Some(control) = &mut self.control
            && !continuous.is_empty()
        {
            control.runner.state.continuous.copy_from_slice(continuous);
        }
    }

    /// The diagram, if there is one.
    #[must_use]
    pub fn control(&self) -> Option<&Control<f64>> {
        self.control.as_ref()
    }

    /// Base step `[s]`.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Base steps done.
    #[must_use]
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Time `[s]`.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.tick as f64 * self.step
    }

    /// Evaluates the diagram for the first time. Its continuous commands are seen from then on: the speed of a rotor that lags, the
    /// torque of a continuous controller.
    ///
    /// # Errors
    ///
    /// If a block gives what is not a finite number.
    pub fn start(&mut self) -> Result<(), Halt> {
        self.call_scripts(Phase::Initialization, 0)?;
        self.look_around();
        self.look()?;
        if let Some(control) = self.control.as_ref().filter(|c| c.is_continuous()) {
            control.show(&mut self.world.state.commands);
        }
        Ok(())
    }

    /// Lets the scripts clean up, if they were started. Nothing may be done after it.
    ///
    /// # Errors
    ///
    /// If a script fails.
    pub fn end(&mut self) -> Result<(), Halt> {
        let is_started = self.scripts.0.as_ref().is_some_and(Scripts::is_started);
        if is_started { self.call_scripts(Phase::Cleanup, self.tick) } else { Ok(()) }
    }

    /// Tells the scripts, if they were started, of a pause: that it begins, lasts or ends.
    ///
    /// # Errors
    ///
    /// If a script fails.
    pub fn tell_scripts(&mut self, phase: Phase) -> Result<(), Halt> {
        let is_started = self.scripts.0.as_ref().is_some_and(Scripts::is_started);
        if is_started { self.call_scripts(phase, self.tick) } else { Ok(()) }
    }

    /// What clients and scripts have changed of the model.
    #[must_use]
    pub fn changes(&self) -> &[session::Change] {
        self.table.as_ref().map_or(&[], |table| table.changes())
    }

    /// The streams of graphs, if there can be any.
    pub(crate) fn graphs(&mut self) -> Option<&mut session::Graphs> {
        self.table.as_mut().map(|table| &mut table.graphs)
    }

    /// Calls the scripts; they are told the time of `tick`.
    fn call_scripts(&mut self, phase: Phase, tick: u64) -> Result<(), Halt> {
        let Some(scripts) = &mut self.scripts.0 else { return Ok(()) };
        let t = tick as f64 * self.step;
        let done = scripts.call(phase, &mut self.world, &mut self.table, (tick, t));
        let is_after_step = phase == Phase::Sensing;
        done.map_err(|fault| Halt::Script { tick: self.tick, t: self.tick as f64 * self.step, is_after_step, fault })
    }

    /// Calls a function of the script on an object, as another script or a client asks for it.
    ///
    /// # Errors
    ///
    /// There is no script or no such function, or it failed.
    pub fn call_script(
        &mut self,
        object: Handle,
        kind: Option<script::Kind>,
        function: &str,
        arguments: &[Value],
    ) -> Result<Vec<Value>, Refusal> {
        let (tick, t) = (self.tick, self.t());
        let Some(scripts) = &mut self.scripts.0 else { return Err(Refusal::new("the scene has no scripts")) };
        scripts.call_function((object, kind), (function, arguments), &mut self.world, &mut self.table, (tick, t))
    }

    /// Runs a text of the script's language in the script on an object.
    ///
    /// # Errors
    ///
    /// There is no script, or the text failed.
    pub fn evaluate(&mut self, object: Handle, kind: Option<script::Kind>, text: &str) -> Result<Vec<Value>, Refusal> {
        let (tick, t) = (self.tick, self.t());
        let Some(scripts) = &mut self.scripts.0 else { return Err(Refusal::new("the scene has no scripts")) };
        scripts.evaluate((object, kind), text, &mut self.world, &mut self.table, (tick, t))
    }

    /// What scripts and clients have said, in the order of time, and how many messages were too many to keep.
    #[must_use]
    pub fn messages(&self) -> (Vec<Message>, usize) {
        let (printed, more_prints) = self.scripts.0.as_ref().map_or((&[][..], 0), Scripts::messages);
        let (logged, more_logs) = self.table.as_ref().map_or((&[][..], 0), |table| table.notes().all());
        let mut all = [printed, logged].concat();
        all.sort_by(|a, b| a.t.total_cmp(&b.t));
        (all, more_prints + more_logs)
    }

    /// Takes what scripts have asked for of the run as a whole.
    pub fn take_requests(&mut self) -> Vec<session::Request> {
        self.table.as_mut().map_or_else(Vec::new, |table| table.take_requests())
    }

    /// One base step: scripts act, hold, advance, scripts sense, measure, ask.
    ///
    /// # Errors
    ///
    /// If the world cannot go on (the state is then that of the last instant reached), if a block gives what is not a finite
    /// number (the world has then made the step), or if a script fails.
    pub fn advance(&mut self) -> Result<(), Halt> {
        let (tick, t) = (self.tick, self.t());
        if let Some(table) = &mut self.table {
            table.begin_tick(tick, &self.world.state.totals);
        }
        if self.is_due() {
            self.call_scripts(Phase::Actuation, tick)?;
        }
        if let Some(table) = &mut self.table {
            table.move_targets();
        }
        self.latch();
        let advanced = match &mut self.control {
            None => self.world.advance(t, self.step),
            Some(control) => {
                control.update(tick, t);
                if control.is_continuous() {
                    self.world.advance_with(t, self.step, control)
                } else {
                    self.world.advance(t, self.step)
                }
            }
        };
        if let Err((t, cause)) = advanced {
            // between ticks a block shows in the motion first
            let culprit = self.control.as_ref().and_then(Control::not_finite);
            return Err(culprit.map_or(Halt::World { tick, t, cause }, |culprit| Halt::Block { tick, t, culprit }));
        }
        self.tick += 1;
        self.look_around();
        if self.is_due() {
            self.world.release();
            if let Some(table) = &mut self.table {
                table.sense(&self.world.state.q);
            }
            let ticks = self.table.as_ref().map_or(1, |table| table.sample_ticks());
            self.call_scripts(Phase::Sensing, self.tick - ticks.min(self.tick))?;
        }
        let arrived = self.t();
        if let Some(control) = self.control.as_mut().filter(|c| c.is_continuous()) {
            control.arrive(&mut self.world, arrived);
        }
        self.look()
    }

    /// Latches the commands of the present tick without advancing: the world under the inputs that it will have next.
    pub fn latch(&mut self) {
        let t = self.t();
        for (command, signal) in self.world.state.commands.iter_mut().zip(&self.commands) {
            *command = signal.value(t);
        }
        if let Some(control) = &self.control {
            control.latch(&mut self.world.state.commands);
        }
        if let Some(table) = &self.table {
            table.latch(&mut self.world.state.commands);
        }
    }

    /// Whether a step of clients and scripts begins at the present tick.
    fn is_due(&self) -> bool {
        self.table.as_ref().is_some_and(|table| table.is_due(self.tick))
    }

    /// Proximity sensors see what is there at the present tick; those that clients and scripts have made, where a step of theirs begins.
    fn look_around(&mut self) {
        let (tick, t) = (self.tick, self.t());
        self.sensors.look_around(&mut self.world, tick, t, self.table.as_deref_mut());
        if self.is_due()
            && let Some(mut desk) = self.desk()
        {
            desk.handle_made_sensors();
        }
    }

    fn look(&mut self) -> Result<(), Halt> {
        let (tick, t) = (self.tick, self.t());
        self.sensors.sample(&mut self.world, tick, t);
        let Some(control) = &mut self.control else { return Ok(()) };
        control.sense(&self.sensors.values);
        control.look(&mut self.world, tick, t).map_err(|culprit| Halt::Block { tick, t, culprit })
    }

    /// Everything that can be looked at: the world, and the diagram's signals with the recorded float signals of scripts and clients and the values of
    /// all sensors after them. A float signal that nobody has set is not a number.
    pub fn observe(&mut self, t: f64) -> (Observation<'_>, &[f64]) {
        let signals = self.control.as_ref().map_or(&[][..], Control::signals);
        if !(self.sensors.values.is_empty() && self.floats.is_empty()) {
            self.signals.clear();
            self.signals.extend_from_slice(signals);
            let table = self.table.as_deref();
            let float = |name: &String| table.and_then(|table| table.floats.get(name)).copied().unwrap_or(f64::NAN);
            self.signals.extend(self.floats.iter().map(float));
            self.signals.extend_from_slice(&self.sensors.values);
            return (self.world.observe(t), &self.signals);
        }
        (self.world.observe(t), signals)
    }

    /// Hash of the present state.
    #[must_use]
    pub fn trace(&self) -> Trace {
        let mut trace = Trace::start(&self.world.state);
        trace.add_continuous(self.continuous());
        trace
    }

    /// Adds the present state to a hash.
    pub fn add_to(&self, trace: &mut Trace) {
        trace.add(&self.world.state);
        trace.add_continuous(self.continuous());
    }

    /// Everything needed to go on from here bit for bit, with the hash of the run so far.
    #[must_use]
    pub fn snapshot(&self, trace: Trace) -> Snapshot {
        let diagram = self.control.as_ref().map(|c| c.runner.state.clone());
        Snapshot {
            state: self.world.state.clone(),
            trace,
            control: self.world.control(),
            sensors: self.sensors.values.clone(),
            diagram,
        }
    }

    /// Goes back to a snapshot of the same scene and diagram.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.world.state = snapshot.state.clone();
        if let Some(control) = snapshot.control {
            self.world.set_control(control);
        }
        self.tick = snapshot.state.tick;
        self.sensors.values.copy_from_slice(&snapshot.sensors);
        if let (Some(control), Some(state)) = (&mut self.control, &snapshot.diagram) {
            control.resume(state.clone(), &snapshot.state);
        }
    }

    /// What blocks of the diagram have to say of the run so far.
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
