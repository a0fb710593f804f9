//! Live session: a loaded scene that clients and scripts start, step, read and change through the API of V-REP and
//! CoppeliaSim.
//!
//! | type | role |
//! |---|---|
//! | [`Session`] | the life of runs: start, step, pause, stop, load; each is recorded, hashed and reported as any run |
//!
//! A step of a session lasts [`ObjectRegistry::sample_time`], a whole number of base steps: commands are latched at its
//! start and held, as those of any controller. Nothing here has a clock, a thread or a socket.

mod files;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sincro_dynamics::state::State;
use sincro_dynamics::world::MethodKind;

pub use files::Files;

use crate::api::{ApiError, Handle, Kind, LegacyPorts, ObjectRegistry, Phase, Request, SimApi, Value, functions};
use crate::api_controller::ApiController;
use crate::host;
use sincro_scene::diagnostic::Diagnostics;
use sincro_scene::overrides::Override;
use sincro_scene::scene::{ObjectKind, Scene};
use sincro_scene::script::Kind as ScriptKind;
use sincro_sim::load::{Extensions, Loaded, load};
use sincro_sim::results::Status;
use sincro_sim::run::{LockStep, Recording, RunError, RunOptions, Simulated, method_for};
use sincro_sim::structure::Structure;
use sincro_sim::trace::Trace;

/// Run of a session that has ended, whether it was completed, stopped by a client or failed; [`Session::take_finished`]
/// gives it.
#[derive(Debug)]
pub struct Finished {
    /// Signals, status, warnings and trace hash of the run.
    pub simulated: Simulated,
    /// Scene and experiment that were run, with changes that clients made before.
    pub loaded: Loaded,
    /// Number of steps of clients that were completed.
    pub steps: u64,
}

/// Loaded scene that clients start, step, read and change through the API of V-REP and CoppeliaSim, with the runs that
/// they make of it.
///
/// ```
/// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
/// use sincro_coppelia::session::Session;
///
/// let mut session = Session::open(&scene, &[], sincro_sim::Extensions::default(), None)?;
/// session.start()?;
/// session.step()?;
/// assert_eq!((session.steps(), session.t()), (1, session.registry().sample_time()));
/// session.stop()?;
/// assert_eq!(session.take_finished().len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Session {
    folder: PathBuf,
    overrides: Vec<Override>,
    loaded: Loaded,
    lockstep: LockStep,
    method: MethodKind,
    warnings: Vec<String>,
    run: Option<Run>,
    finished: Vec<Finished>,
    steps: u64,
    /// Folder that it was opened with: clients may load it, and those beside it.
    served: PathBuf,
    grants: Grants,
    /// Ports of the legacy API; none if clients are not served.
    legacy_ports: Option<LegacyPorts>,
    /// Structure that runs start with, if clients have changed it while stopped.
    structure: Option<Structure>,
    /// True after a customization script has failed while stopped: it is not called there again.
    has_failed: bool,
}

/// Permissions of clients beyond the simulation, given with [`Session::grant`]; none by default.
#[derive(Clone, Debug, Default)]
pub struct Grants {
    /// Folder to which clients may send files and from which they may load scenes; none: they may not.
    pub files: Option<Files>,
    /// True if clients may run texts in the scene's scripts (`sim.executeScriptString`).
    pub evaluation: bool,
}

/// Scenes that the example programs of CoppeliaSim load, and what they are called here.
const EXAMPLES: &[(&str, &str)] = &[
    ("messaging/pControllerViaRemoteApi", "pcontroller"),
    ("messaging/movementViaRemoteApi", "movement"),
    ("messaging/synchronousImageTransmissionViaRemoteApi", "camera-stream"),
];

/// A run under way.
struct Run {
    recording: Recording,
    /// Object registry before the run.
    before: ObjectRegistry,
    /// State at the start.
    start: State<f64>,
}

impl Session {
    /// Opens a scene folder, stopped at time 0. A step of clients lasts `sample_time` `[s]`, or `simulation_step` of
    /// the experiment for none. Scripts of the scene need `extensions` with their language.
    ///
    /// # Errors
    ///
    /// All problems of the scene's files and of the overrides, each with its place in the file; or a sample time that
    /// is no whole multiple of the base step.
    pub fn open(
        folder: &Path,
        overrides: &[Override],
        extensions: Extensions,
        sample_time: Option<f64>,
    ) -> Result<Self, Diagnostics> {
        let loaded = load(folder, overrides, extensions)?;
        Self::new(folder, overrides, loaded, sample_time)
    }

    /// Creates a session of a scene that is loaded already from `folder` with `overrides`; see [`Session::open`] for
    /// `sample_time` `[s]`.
    ///
    /// # Errors
    ///
    /// A sample time that is no whole multiple of the base step.
    pub fn new(
        folder: &Path,
        overrides: &[Override],
        loaded: Loaded,
        sample_time: Option<f64>,
    ) -> Result<Self, Diagnostics> {
        let (method, warnings) = method_for(&loaded);
        let mut registry = ObjectRegistry::new(&loaded, loaded.experiment.simulation_ticks);
        if let Some(dt) = sample_time {
            let refused =
                |ApiError(message)| Diagnostics::from(sincro_scene::diagnostic::Diagnostic::without_location(message));
            registry.set_sample_time(dt).map_err(refused)?;
        }
        let lockstep = fresh(&loaded, None, method, registry);
        Ok(Self {
            folder: folder.to_path_buf(),
            overrides: overrides.to_vec(),
            loaded,
            lockstep,
            method,
            warnings,
            run: None,
            finished: Vec::new(),
            steps: 0,
            served: folder.to_path_buf(),
            grants: Grants::default(),
            legacy_ports: None,
            structure: None,
            has_failed: false,
        })
    }

    /// Scene and experiment of the session, with changes of the model that clients have made while stopped and run
    /// since.
    #[must_use]
    pub fn loaded(&self) -> &Loaded {
        &self.loaded
    }

    /// Path of the scene folder, as it was given to [`Session::open`] or loaded by a client.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Overrides that the scene was loaded with, in their order; none for a scene that a client has loaded.
    #[must_use]
    pub fn overrides(&self) -> &[Override] {
        &self.overrides
    }

    /// Typed functions of the API on the objects and world of the session, at its present time: positions, forces,
    /// sensors, parameters.
    ///
    /// # Panics
    ///
    /// Never: a session's lock-step has a registry.
    pub fn sim(&mut self) -> SimApi<'_> {
        let mut sim = self.sim_as_it_is();
        if let Err(ApiError(message)) = sim.make_bodies() {
            sim.log(200, &format!("shapes that become bodies: {message}"));
        }
        sim
    }

    /// The functions of the API while shapes wait to become bodies.
    fn sim_as_it_is(&mut self) -> SimApi<'_> {
        ApiController::sim(&mut self.lockstep).expect("a session's lock-step has a registry")
    }

    /// Objects of the scene and runtime objects, with all that clients and scripts store: handles, signals, setpoints.
    /// Shapes that wait to become bodies, and bodies that wait to be removed, are as they were; [`Session::sim`] and
    /// the next step make the change.
    pub fn registry(&mut self) -> &mut ObjectRegistry {
        self.sim_as_it_is().registry
    }

    /// State of the simulation: stopped, running or paused.
    pub fn phase(&mut self) -> Phase {
        self.registry().phase
    }

    /// Simulation time `[s]` since the start of the run; 0 while stopped.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.lockstep.t()
    }

    /// Number of steps of clients since the run began; 0 while stopped. A step has [`ObjectRegistry::sample_time`]
    /// seconds.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Hash of all states of the present run so far, the same for the same run on every machine; none while stopped.
    #[must_use]
    pub fn trace(&self) -> Option<Trace> {
        self.run.as_ref().map(|run| run.recording.trace())
    }

    /// Takes the runs that have ended since the last call, the oldest first.
    pub fn take_finished(&mut self) -> Vec<Finished> {
        std::mem::take(&mut self.finished)
    }

    /// Calls a function of the API by name, with or without `sim.` before it, then carries out what it requested
    /// (start, pause, stop, load). Returns its results in the order of its call tip.
    ///
    /// ```
    /// # let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
    /// # use sincro_coppelia::session::Session;
    /// use sincro_coppelia::api::Value;
    ///
    /// let mut session = Session::open(&scene, &[], sincro_sim::Extensions::default(), None)?;
    /// session.call("sim.startSimulation", &[])?;
    /// assert_eq!(session.call("sim.getSimulationTime", &[])?, [Value::Real(0.0)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// No function of that name is offered, it has refused its arguments, or what it requested failed; the message
    /// names the function.
    pub fn call(&mut self, name: &str, arguments: &[Value]) -> Result<Vec<Value>, ApiError> {
        let mut result = functions::call(&mut self.sim_as_it_is(), name, arguments)?;
        let handled = functions::function(name).is_some_and(|f| f.name == "handleVisionSensor");
        let sensor = arguments.first().and_then(Value::as_int).filter(|own| handled && *own > 0);
        if let Some(sensor) = sensor
            && ApiController::filter_picture(&mut self.lockstep, Handle(sensor as i32))?
        {
            result = functions::call(&mut self.sim_as_it_is(), "readVisionSensor", arguments)?;
        }
        self.follow_changes()?;
        self.do_requests()?;
        Ok(result)
    }

    /// Calls a function of the script on an object, of that kind or, for none, of any, then carries out what it
    /// requested (start, stop, load). Returns its results in their order.
    ///
    /// # Errors
    ///
    /// There is no such script or function, the scripts have not been started, the function failed, or what it
    /// requested did.
    pub fn call_script(
        &mut self,
        object: Handle,
        kind: Option<ScriptKind>,
        function: &str,
        arguments: &[Value],
    ) -> Result<Vec<Value>, ApiError> {
        self.open_scripts()?;
        let results = ApiController::call_script(&mut self.lockstep, (object, kind), function, arguments)?;
        self.follow_structure()?;
        self.do_requests()?;
        Ok(results)
    }

    /// Declares that a server serves clients on these TCP ports of the legacy remote API; from the next run on, scripts
    /// may request further ports.
    pub fn set_served(&mut self, ports: LegacyPorts) {
        self.legacy_ports = Some(ports);
    }

    /// Records whether the server could open a TCP port that a script has requested.
    pub fn note_port(&mut self, port: u16, is_open: bool) {
        let note = |ports: &mut LegacyPorts| {
            if is_open {
                // it is there already, or was allowed when the script asked
                let _ = ports.add(port, true);
            } else {
                ports.remove(port);
            }
        };
        self.legacy_ports.iter_mut().for_each(note);
        self.registry().legacy_ports.iter_mut().for_each(note);
    }

    /// Replaces the permissions of clients.
    pub fn grant(&mut self, grants: Grants) {
        self.registry().sent_folder = grants.files.as_ref().map(|files| files.folder().to_path_buf());
        self.registry().takes_script_texts = grants.evaluation;
        self.grants = grants;
    }

    /// Folder for files of clients.
    ///
    /// # Errors
    ///
    /// [`Grants::files`] is none; the message has the option of `sincro serve` that grants it.
    pub fn files(&mut self) -> Result<&mut Files, ApiError> {
        let refused = "clients send and erase no files here: `sincro serve --grant files` lets them";
        self.grants.files.as_mut().ok_or_else(|| ApiError::new(refused))
    }

    /// Runs a text in the script on an object, of that kind or, for none, of any, then carries out what it requested.
    /// Returns what the text returns.
    ///
    /// # Errors
    ///
    /// [`Grants::evaluation`] is false, there is no such script, the scripts have not been started, or the text failed.
    pub fn evaluate(&mut self, object: Handle, kind: Option<ScriptKind>, text: &str) -> Result<Vec<Value>, ApiError> {
        if !self.grants.evaluation {
            let refused = "texts of clients are not run here: `sincro serve --grant scripts` lets them";
            return Err(ApiError::new(refused));
        }
        self.open_scripts()?;
        let results = ApiController::evaluate(&mut self.lockstep, (object, kind), text)?;
        self.follow_structure()?;
        self.do_requests()?;
        Ok(results)
    }

    /// Lets the run go on with the structure that clients have made.
    ///
    /// # Errors
    ///
    /// A controller cannot: the run has then ended.
    fn follow_structure(&mut self) -> Result<(), ApiError> {
        self.sim_as_it_is().make_bodies()?;
        self.follow_changes()
    }

    /// As [`Session::follow_structure`], while shapes wait to become bodies.
    fn follow_changes(&mut self) -> Result<(), ApiError> {
        self.lockstep.follow_structure().map_err(|halt| {
            let status = halt.explain(&mut self.lockstep, &self.loaded.experiment);
            self.fail(status)
        })
    }

    /// Does what clients and scripts have asked for.
    ///
    /// # Errors
    ///
    /// The first of it that was refused; the rest is done.
    pub(crate) fn do_requests(&mut self) -> Result<(), ApiError> {
        let mut first = Ok(());
        for request in self.registry().take_requests() {
            let done = match request {
                Request::Start => self.start(),
                Request::Pause => self.pause(),
                Request::Stop => self.stop(),
                // the new scene of the regular API
                Request::Load(path) if path.is_empty() => self.replace(&path, &self.served.clone(), None),
                Request::Load(path) => self.load(&path),
                Request::Close => self.stop(),
                Request::Save(name, text) => self.save(&name, &text),
                Request::SaveImage(name, bytes) => self.files().and_then(|files| files.put(&name, &bytes)),
            };
            if first.is_ok() {
                first = done;
            }
        }
        first
    }

    /// Starts a run, with the initialization of scripts, or resumes a paused one; nothing if one is running. Time stays
    /// 0 until the first step.
    ///
    /// # Errors
    ///
    /// A recorded signal does not exist, or a script or block of the diagram fails at the start: the run has then
    /// ended.
    pub fn start(&mut self) -> Result<(), ApiError> {
        match self.phase() {
            Phase::Running => return Ok(()),
            Phase::Paused => {
                self.notify_scripts(host::Phase::Resume)?;
                self.registry().phase = Phase::Running;
                return Ok(());
            }
            Phase::Stopped => {}
        }
        self.open_scripts()?;
        self.sim_as_it_is().make_bodies()?;
        if std::mem::take(&mut self.registry().is_model_changed) {
            self.adopt();
        }
        self.registry().legacy_ports = self.legacy_ports.clone();
        let before = self.registry().clone();
        self.registry().begin_run();
        let start = self.lockstep.state().clone();
        self.settle(&start);
        let options = RunOptions { keyframes: true, ..RunOptions::default() };
        let recording = Recording::new(&self.loaded, &mut self.lockstep, options).map_err(told)?;
        self.run = Some(Run { recording, before, start });
        self.registry().phase = Phase::Running;
        self.steps = 0;
        let first = self.lockstep.start();
        if let Some(run) = &mut self.run {
            run.recording.start(&mut self.lockstep).map_err(|e| told(e.into()))?;
        }
        self.registry().has_begun = true;
        if let Err(halt) = first {
            let status = halt.explain(&mut self.lockstep, &self.loaded.experiment);
            return Err(self.fail(status));
        }
        Ok(())
    }

    /// Resolves the actuator modes, if a client has moved joints since the scene was opened.
    fn settle(&mut self, start: &State<f64>) {
        let initial = &self.scene().initial;
        if start.q != initial.q || start.v != initial.v {
            self.lockstep.world().initialize(0.0);
        }
    }

    /// Makes changes of the model that clients made while stopped part of the scene, until it is closed: the next run
    /// is made as if the file said so.
    fn adopt(&mut self) {
        // the diagram is told when the run starts
        let _ = self.lockstep.follow_structure();
        let (q, v) = (self.lockstep.state().q.clone(), self.lockstep.state().v.clone());
        self.structure = self.lockstep.structure().cloned();
        let params = self.lockstep.world().model().params().clone();
        let mut registry =
            ApiController::take_registry(&mut self.lockstep).expect("a session's lock-step has a registry");
        let scene = self.structure.as_mut().map_or(&mut self.loaded.scene, |structure| &mut structure.scene);
        let scene = Arc::make_mut(scene);
        // motors keep the modes of the scene
        let params = params.with_motors_of(scene.model.params());
        Arc::make_mut(&mut scene.model).set_params(&params);
        for object in &mut scene.objects {
            let entry = registry.entry(Handle(object.id as i32 + 1)).ok();
            if let (ObjectKind::Body { mass }, Some(Kind::Body(new))) = (&mut object.kind, entry.map(|e| &e.kind)) {
                *mass = *new;
            }
        }
        if let Some(structure) = &mut self.structure {
            let initial = &mut Arc::make_mut(&mut structure.scene).initial;
            (initial.q, initial.v) = (q.clone(), v.clone());
            registry.set_scene(&structure.scene);
        } else {
            registry.set_scene(&self.loaded.scene);
        }
        (self.method, self.warnings) = self.method();
        let scripts = ApiController::take_open_scripts(&mut self.lockstep);
        self.lockstep = fresh(&self.loaded, self.structure.as_ref(), self.method, *registry);
        ApiController::set_scripts(&mut self.lockstep, scripts);
        let initial = &self.scene().initial;
        if q != initial.q || v != initial.v {
            // nothing of what was settled for other numbers is kept
            let state = State { q, v, ..initial.clone() };
            self.lockstep.set_state(state, &[]);
        }
        self.restore();
    }

    /// Scene that runs start with: that of the file, or what clients have made of it while stopped.
    fn scene(&self) -> &Arc<Scene> {
        self.structure.as_ref().map_or(&self.loaded.scene, |structure| &structure.scene)
    }

    /// Integration method of runs, with warnings about it.
    fn method(&self) -> (MethodKind, Vec<String>) {
        match &self.structure {
            None => method_for(&self.loaded),
            // the diagram is that of the file: it tells nothing about another structure
            Some(structure) => {
                method_for(&Loaded { scene: structure.scene.clone(), controller: None, ..self.loaded.clone() })
            }
        }
    }

    /// Pauses the run; nothing if there is none.
    ///
    /// # Errors
    ///
    /// A script fails in `sysCall_suspend`: the run has then ended.
    pub fn pause(&mut self) -> Result<(), ApiError> {
        if self.phase() == Phase::Running {
            self.notify_scripts(host::Phase::Suspend)?;
            self.registry().phase = Phase::Paused;
        }
        Ok(())
    }

    /// Calls `sysCall_suspended` of the scripts of a run that is paused, or `sysCall_nonSimulation` of customization
    /// scripts while there is no run, and carries out what they request; to be called now and then. Nothing while the
    /// simulation runs.
    ///
    /// # Errors
    ///
    /// A script fails: the run has then ended; one that fails while there is none is not called there again.
    pub fn idle(&mut self) -> Result<(), ApiError> {
        match self.phase() {
            Phase::Running => return Ok(()),
            Phase::Paused => self.notify_scripts(host::Phase::Suspended)?,
            // scripts whose `sysCall_init` failed live when the next run begins
            Phase::Stopped if self.has_failed => return Ok(()),
            Phase::Stopped => {
                self.open_scripts()?;
                if !ApiController::is_open(&mut self.lockstep) {
                    return Ok(());
                }
                self.call_stopped(host::Phase::NonSimulation)?;
                self.follow_structure()?;
            }
        }
        self.do_requests()
    }

    /// Lets the customization scripts live, if there are any and they do not yet: from here through all runs.
    ///
    /// # Errors
    ///
    /// A script fails at its start.
    fn open_scripts(&mut self) -> Result<(), ApiError> {
        let has_some = |scene: &Scene| scene.scripts.iter().any(|script| script.kind == ScriptKind::Customization);
        if self.phase() != Phase::Stopped || ApiController::is_open(&mut self.lockstep) || !has_some(self.scene()) {
            return Ok(());
        }
        self.call_stopped(host::Phase::Open)?;
        self.has_failed = false;
        self.follow_structure()
    }

    /// Calls the customization scripts while there is no run; a failure is logged.
    fn call_stopped(&mut self, phase: host::Phase) -> Result<(), ApiError> {
        ApiController::call_stopped(&mut self.lockstep, phase).map_err(|fault| {
            self.has_failed |= phase == host::Phase::Open;
            let message = fault.to_string();
            self.registry().log(200, message.clone());
            ApiError(message)
        })
    }

    /// Tells the scripts of the run of a pause.
    fn notify_scripts(&mut self, phase: host::Phase) -> Result<(), ApiError> {
        ApiController::notify_scripts(&mut self.lockstep, phase).map_err(|halt| {
            let status = halt.explain(&mut self.lockstep, &self.loaded.experiment);
            self.fail(status)
        })
    }

    /// Ends the run, which [`Session::take_finished`] then gives, and goes back to the state in which it started;
    /// nothing if there is none.
    ///
    /// # Errors
    ///
    /// None at present.
    pub fn stop(&mut self) -> Result<(), ApiError> {
        let (tick, time) = (self.lockstep.tick(), self.lockstep.t());
        let lasted = tick >= self.loaded.experiment.n_steps;
        self.end(if lasted { Status::Completed } else { Status::Interrupted { tick, time } });
        Ok(())
    }

    /// Ends the run as [`Session::stop`] does, then the customization scripts (`sysCall_cleanup`): the scene is let go.
    ///
    /// # Errors
    ///
    /// None at present: a script that fails is logged.
    pub fn close(&mut self) -> Result<(), ApiError> {
        self.stop()?;
        if ApiController::is_open(&mut self.lockstep) {
            let _ = self.call_stopped(host::Phase::Close);
        }
        Ok(())
    }

    /// Makes one step of clients, [`ObjectRegistry::sample_time`] seconds, then carries out what scripts have
    /// requested. Nothing unless a run is on and not paused.
    ///
    /// # Errors
    ///
    /// The world could not advance (a state that is not finite, no convergence), or a script or block failed: the run
    /// has ended, and what was recorded is kept.
    pub fn step(&mut self) -> Result<(), ApiError> {
        let registry = self.registry();
        if registry.phase != Phase::Running {
            return Ok(());
        }
        let n_ticks = registry.sample_ticks();
        self.follow_structure()?;
        for _ in 0..n_ticks {
            let advanced = self.lockstep.advance();
            let Some(run) = &mut self.run else { return Ok(()) };
            if advanced.as_ref().err().is_none_or(sincro_sim::run::Halt::is_after_step) {
                run.recording.tick(&mut self.lockstep, advanced.is_err()).map_err(|e| told(e.into()))?;
            }
            if let Err(halt) = advanced {
                let status = halt.explain(&mut self.lockstep, &self.loaded.experiment);
                return Err(self.fail(status));
            }
        }
        self.steps += 1;
        // scripts may have asked for something
        self.do_requests()
    }

    /// Loads another scene, stopped: a folder, or a file in it, inside the folder that holds the first scene, or a file
    /// that a client has sent. A run that is on is ended.
    ///
    /// # Errors
    ///
    /// The scene lies elsewhere, does not exist or has errors (the message has the first), or a scene sent by a client
    /// asks for files or limits that it may not have. The scene that was loaded stays.
    pub fn load(&mut self, path: &str) -> Result<(), ApiError> {
        let allowed = self.allowed(path);
        let sent = if allowed.is_ok() { None } else { self.sent(path) };
        let folder = sent.clone().map_or(allowed, Ok)?;
        self.replace(path, &folder, sent)
    }

    /// Loads the scene of a folder that a client has named `path`, or of a file that a client has sent.
    fn replace(&mut self, path: &str, folder: &Path, sent: Option<PathBuf>) -> Result<(), ApiError> {
        let mut extensions = self.loaded.extensions;
        if sent.is_some() {
            // before anything of it is opened: what is wrong with a file must not tell what is in it
            self.grants.files.as_ref().map_or(Ok(()), Files::check_references)?;
            if !self.grants.evaluation {
                extensions.scripts = None;
            }
        }
        let loaded = load(folder, &[], extensions).map_err(|problems| {
            let first = problems.0.first().map(|p| p.message.clone()).unwrap_or_default();
            ApiError(format!("the scene `{path}` cannot be loaded: {first}"))
        })?;
        if let Some(place) = sent.as_deref().and_then(Path::parent) {
            let is_inside = |file: &Path| file.canonicalize().is_ok_and(|file| file.starts_with(place));
            if let Some(outside) = loaded.sources.iter().find(|source| !is_inside(&source.path)) {
                let outside = outside.path.display();
                return Err(ApiError(format!("the scene `{path}` takes `{outside}`, which no client has sent")));
            }
            files::check_limits(&loaded.scene.scripts)?;
        }
        self.close()?;
        let mut other =
            Self::new(folder, &[], loaded, None).map_err(|_| ApiError::new("the scene cannot be loaded"))?;
        other.finished = std::mem::take(&mut self.finished);
        other.served.clone_from(&self.served);
        other.grant(self.grants.clone());
        other.loaded.extensions = self.loaded.extensions;
        *self = other;
        Ok(())
    }

    /// Writes a model into the folder for files of clients.
    fn save(&mut self, name: &str, text: &str) -> Result<(), ApiError> {
        let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let name = if last.ends_with(".toml") { last.to_owned() } else { format!("{last}.toml") };
        self.files()?.put(&name, text.as_bytes())
    }

    /// The file that a client has sent and means by a path, if there is one.
    fn sent(&self, path: &str) -> Option<PathBuf> {
        let name = path.rsplit(['/', '\\']).next()?;
        let files = self.grants.files.as_ref()?;
        let place = files.place(name).ok()?;
        (files.has(&place) && place.is_file()).then(|| place.canonicalize().ok())?
    }

    /// The scene folder that a client means, if it may be loaded.
    fn allowed(&self, path: &str) -> Result<PathBuf, ApiError> {
        let refused = |why: &str| ApiError(format!("the scene `{path}` {why}"));
        // V-REP's scenes are files; here the folder of the same name
        let stem = path.strip_suffix(".ttt").or_else(|| path.strip_suffix(".simscene.xml")).unwrap_or(path);
        let stem = EXAMPLES.iter().find(|(known, _)| stem.ends_with(known)).map_or(stem, |(_, here)| here);
        let name = Path::new(stem);
        let above = self.served.parent().filter(|above| !above.as_os_str().is_empty());
        let root = above.unwrap_or(Path::new(".")).canonicalize().map_err(|_| refused("cannot be found"))?;
        let whole = root.join(name).canonicalize();
        let whole = whole.or_else(|_| root.join(name.file_name().unwrap_or_default()).canonicalize());
        let whole = whole.map_err(|_| refused("does not exist"))?;
        if !whole.starts_with(&root) {
            return Err(refused("lies outside the folder of the scene that is served"));
        }
        Ok(whole)
    }

    fn fail(&mut self, status: Status) -> ApiError {
        let message = match &status {
            Status::Stopped { reason, help, .. } => format!("the run stopped: {reason}; {help}"),
            _ => "the run stopped".to_owned(),
        };
        self.registry().log(200, message.clone());
        self.end(status);
        ApiError(message)
    }

    /// Keeps what the run gave and goes back to where it started.
    fn end(&mut self, status: Status) {
        let Some(run) = self.run.take() else { return };
        if let Err(halt) = self.lockstep.end() {
            let experiment = &self.loaded.experiment;
            let words = match halt.explain(&mut self.lockstep, experiment) {
                Status::Stopped { reason, .. } => reason,
                _ => String::new(),
            };
            self.registry().log(200, words);
        }
        let warnings = self.warnings.clone();
        match run.recording.finish(&mut self.lockstep, status, self.method, warnings) {
            Ok(simulated) => {
                let (loaded, steps) = (self.loaded.clone(), self.steps);
                self.finished.push(Finished { simulated, loaded, steps });
            }
            Err(error) => self.registry().log(200, format!("{error}")),
        }
        let mut registry =
            *ApiController::take_registry(&mut self.lockstep).expect("a session's lock-step has a registry");
        registry.end_run(run.before);
        registry.phase = Phase::Stopped;
        let scripts = ApiController::take_open_scripts(&mut self.lockstep);
        self.lockstep = fresh(&self.loaded, self.structure.as_ref(), self.method, registry);
        ApiController::set_scripts(&mut self.lockstep, scripts);
        self.lockstep.set_state(run.start, &[]);
        self.restore();
        self.steps = 0;
    }

    /// Restores changes that a client made before the run.
    fn restore(&mut self) {
        self.restore_motors();
        self.sim().restore_pairs();
    }

    /// Motors that a client changed before the run are so again.
    fn restore_motors(&mut self) {
        let sim = self.sim();
        for joint in sim.registry.joints() {
            if let (Some(index), Some(motor)) = (joint.motor, joint.drive)
                && sim.world.model().motors()[index]
                    != (sincro_dynamics::actuation::Motor { dof: joint.v_idx, ..motor })
            {
                sim.world.set_motor(sincro_dynamics::ids::MotorId::new(index), motor);
            }
        }
    }
}

/// A lock-step that has not started, with a registry.
fn fresh(loaded: &Loaded, structure: Option<&Structure>, method: MethodKind, registry: ObjectRegistry) -> LockStep {
    let mut lockstep = LockStep::new(loaded, method, false);
    if let (None, Some(engine)) = (ApiController::of(&mut lockstep), loaded.extensions.scripts) {
        // models that clients load may have scripts
        lockstep.attach(engine.controller(loaded));
    }
    ApiController::set_registry(&mut lockstep, registry);
    if let Some(structure) = structure {
        lockstep.set_structure(structure);
    }
    lockstep
}

fn told(error: RunError) -> ApiError {
    match error {
        RunError::Diagnostics(problems) => {
            ApiError(problems.0.first().map_or_else(|| "nothing can be recorded".into(), |p| p.message.clone()))
        }
        RunError::File(error) => ApiError(error.to_string()),
    }
}
