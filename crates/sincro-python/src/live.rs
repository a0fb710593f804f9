//! The run that Python steps: lock-step, signals of the present instant, snapshots.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use sincro_dynamics::initial::{LimitViolation, limit_violations};
use sincro_dynamics::spatial::Pose;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::draft::SceneDraft;
use sincro_scene::record::Recorder;
use sincro_scene::scene::frame_of;
use sincro_sim::Loaded;
use sincro_sim::restructure::{Edit, restructure};
use sincro_sim::results::Status;
use sincro_sim::run::{Followed, LockStep, method_for};
use sincro_sim::trace::Trace;

use crate::errors;
use crate::function::{Factory, Function, Held, Raised, located};

/// Reason why the run under way cannot be used, as an exception later: no GIL is held where it is found.
#[derive(Debug)]
pub enum LiveError {
    /// The run stopped.
    Stopped(Box<Status>),
    /// A Python function raised an exception.
    Raised(Box<Status>, PyErr),
    /// Problems with names of signals.
    Names(sincro::Diagnostics),
    /// The request cannot be met; the reason in words.
    Argument(String),
    /// The handler of a signal raised an exception: Ctrl-C.
    Signal(PyErr),
}

impl LiveError {
    /// As an exception.
    pub fn into_error(self, py: Python<'_>) -> PyErr {
        match self {
            Self::Stopped(status) => errors::stopped(py, &status),
            Self::Raised(status, cause) => raised(py, &status, cause),
            Self::Names(found) => errors::unknown_names(py, &found),
            Self::Argument(message) => errors::argument(py, &message),
            Self::Signal(error) => error,
        }
    }
}

/// `ControllerError`, caused by the exception that a function raised.
pub fn raised(py: Python<'_>, status: &Status, cause: PyErr) -> PyErr {
    let Status::Stopped { tick, time, reason, .. } = status else { return cause };
    let error = errors::with(errors::new(py, "ControllerError", reason), py, "tick", *tick);
    let error = errors::with(error, py, "time", *time);
    error.set_cause(py, Some(cause));
    error
}

/// A moment of a run, to go back to.
#[pyclass(frozen, module = "sincro")]
#[derive(Debug)]
pub struct Snapshot {
    pub(crate) bytes: Vec<u8>,
    pub(crate) held: Vec<Option<f64>>,
    pub(crate) t: f64,
}

#[pymethods]
impl Snapshot {
    /// Time of the moment [s].
    #[getter]
    fn time(&self) -> f64 {
        self.t
    }

    fn __repr__(&self) -> String {
        format!("<sincro.Snapshot at {} s, {} bytes>", self.t, self.bytes.len())
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<Py<PyAny>> {
        let this = slf.get();
        let class = slf.get_type();
        let held: Vec<f64> = this.held.iter().map(|x| x.unwrap_or(f64::NAN)).collect();
        Ok((class, (&this.bytes[..], held, this.t)).into_pyobject(slf.py())?.into_any().unbind())
    }

    #[new]
    fn new(bytes: Vec<u8>, held: Vec<f64>, t: f64) -> Self {
        Self { bytes, held: held.into_iter().map(|x| (!x.is_nan()).then_some(x)).collect(), t }
    }
}

/// The run under way.
#[derive(Debug)]
pub struct Live {
    loaded: Arc<Loaded>,
    pub(crate) lockstep: LockStep,
    trace: Trace,
    raised: Raised,
    /// Reason of the end, if it is over.
    ended: Option<Box<Status>>,
    recorders: BTreeMap<Vec<String>, (Recorder, Followed)>,
    /// Energy at the start [J], time of the last step's begin [s], impulses of the motors at it [N·m·s].
    memory: Vec<f64>,
    is_scripted: bool,
    has_functions: bool,
}

impl Live {
    /// Begins a run of a scene with Python's functions.
    pub fn begin(loaded: &Arc<Loaded>, functions: &[Arc<Function>]) -> Result<Self, LiveError> {
        let raised = Raised::default();
        let with_functions = with_functions(loaded, functions, &raised);
        let (method, _) = method_for(&with_functions);
        let mut lockstep = LockStep::new(&with_functions, method, false);
        let n_commands = loaded.scene.commands.len();
        lockstep.attach(Box::new(Held { commands: vec![None; n_commands], made: Vec::new() }));
        let trace = lockstep.trace();
        let mut live = Self {
            loaded: loaded.clone(),
            lockstep,
            trace,
            raised,
            ended: None,
            recorders: BTreeMap::new(),
            memory: Vec::new(),
            is_scripted: !loaded.scene.scripts.is_empty(),
            has_functions: !functions.is_empty(),
        };
        if let Err(halt) = live.lockstep.start() {
            return Err(live.end(halt));
        }
        let energy = live.lockstep.world().observe(0.0).energy().total();
        live.memory.push(energy);
        live.remember();
        Ok(live)
    }

    /// Notes the begin of a step: means are taken over the last one.
    fn remember(&mut self) {
        let t = self.lockstep.t();
        self.memory.truncate(1);
        self.memory.push(t);
        self.memory.extend_from_slice(&self.lockstep.state().totals[2..]);
    }

    fn end(&mut self, halt: sincro_sim::run::Halt) -> LiveError {
        let status = Box::new(halt.explain(&mut self.lockstep, &self.loaded.experiment));
        self.ended = Some(status.clone());
        match self.raised.lock().unwrap_or_else(PoisonError::into_inner).take() {
            Some(cause) => LiveError::Raised(status, cause),
            None => LiveError::Stopped(status),
        }
    }

    /// Makes one base step.
    pub fn step(&mut self) -> Result<(), LiveError> {
        if let Some(status) = &self.ended {
            return Err(LiveError::Stopped(status.clone()));
        }
        self.remember();
        match self.lockstep.advance() {
            Ok(()) => self.lockstep.hash_into(&mut self.trace),
            Err(halt) => {
                if halt.is_after_step() {
                    self.lockstep.hash_into(&mut self.trace);
                }
                return Err(self.end(halt));
            }
        }
        if self.is_scripted && self.lockstep.take_stop_request() {
            let (tick, time) = (self.lockstep.tick(), self.lockstep.t());
            let reason = format!("a script stopped the simulation after tick {tick} at t = {time:.6} s");
            let status = Box::new(Status::Stopped { tick, time, reason, help: String::new() });
            self.ended = Some(status.clone());
            return Err(LiveError::Stopped(status));
        }
        Ok(())
    }

    /// Commands that are held from now on.
    pub fn held(&mut self) -> &mut [Option<f64>] {
        let (held, _) = self.lockstep.controller::<Held>().expect("it was attached when the run began");
        &mut held.commands
    }

    /// Hash of all states so far.
    pub fn trace(&self) -> Trace {
        self.trace
    }

    /// Values of signals at the present instant.
    pub fn observe(&mut self, names: &[String], out: &mut Vec<f64>) -> Result<(), LiveError> {
        if !self.recorders.contains_key(names) {
            let entries = self.loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
            let model = &self.loaded.scene.model;
            let recorder = Recorder::new(&located("signal", names), model, &entries).map_err(LiveError::Names)?;
            self.recorders.insert(names.to_vec(), (recorder, Followed::default()));
        }
        let Self { recorders, lockstep, memory, .. } = self;
        let Some((recorder, followed)) = recorders.get_mut(names) else { return Ok(()) };
        lockstep.bring_up(recorder, followed);
        let t = lockstep.t();
        let (seen, signals) = lockstep.observe(t);
        // the memory is that of this model: it has the right length
        let _ = recorder.set_memory(memory);
        out.clear();
        out.extend_from_slice(&recorder.row(&seen, signals, t, false)[1..]);
        Ok(())
    }

    /// Refuses coordinates beyond limits of joints.
    pub fn refuse_beyond_limits(&self, q: Option<&[f64]>) -> Result<(), LiveError> {
        let Some(q) = q else { return Ok(()) };
        let mut state = self.lockstep.state().clone();
        state.q.copy_from_slice(q);
        match limit_violations(&self.lockstep.scene().model, &state).first() {
            Some(LimitViolation { joint, position, limit }) => {
                let words = format!("`{joint}` at {position} is beyond its limit {limit}: no state of the mechanism");
                Err(LiveError::Argument(words))
            }
            None => Ok(()),
        }
    }

    /// Puts the world into another state.
    pub fn place(&mut self, q: Option<Vec<f64>>, v: Option<Vec<f64>>) {
        let mut state = self.lockstep.state().clone();
        state.q = q.unwrap_or(state.q);
        state.v = v.unwrap_or(state.v);
        self.lockstep.set_state(state, &[]);
    }

    /// Puts what is fixed in the world at another place there, `place` taking its present pose `[m]`; all that joins it
    /// goes on from there.
    pub fn move_fixed(&mut self, path: &str, place: impl FnOnce(&Pose<f64>) -> Pose<f64>) -> Result<(), LiveError> {
        if let Some(status) = &self.ended {
            return Err(LiveError::Stopped(status.clone()));
        }
        if self.has_functions {
            let words = "`set_pose` builds the model anew, which Python functions do not follow: this model has such \
                controllers; command it by `step` instead";
            return Err(LiveError::Argument(words.into()));
        }
        let scene = self.lockstep.scene().clone();
        let Some(k) = scene.objects.iter().position(|object| object.path == path) else {
            return Err(LiveError::Argument(format!("there is no object `{path}`")));
        };
        let here = frame_of(&scene, k);
        if here.link.is_some() {
            let words = format!("`{path}` moves with joints: set their coordinates, `set_state`");
            return Err(LiveError::Argument(words));
        }
        let Some(mut draft) = SceneDraft::new(&scene) else {
            return Err(LiveError::Argument("the scene was not read from a file".into()));
        };
        let x_wp = scene.objects[k].parent.map_or_else(Pose::identity, |parent| frame_of(&scene, parent).pose);
        draft.set_pose(path, &x_wp.inverse().compose(&place(&here.pose)));
        let to = draft.compile(scene.objects.len()).map_err(LiveError::Names)?;
        let (held, world) = self.lockstep.controller::<Held>().expect("it was attached when the run began");
        let edit = Edit { from: &scene, copies: &BTreeMap::new(), conserves_momentum: false };
        held.made.push(restructure(world, to, &edit));
        self.lockstep.follow_structure().map_err(|halt| self.end(halt))
    }

    /// The present moment, to go back to.
    pub fn snapshot(&mut self) -> Result<Snapshot, LiveError> {
        if self.is_scripted && self.lockstep.tick() > 0 {
            let words = "scripts keep a memory that a snapshot cannot hold: this scene has scripts";
            return Err(LiveError::Argument(words.into()));
        }
        if self.has_functions && self.lockstep.tick() > 0 {
            let words = "Python functions keep a memory that a snapshot cannot hold: this model has such controllers";
            return Err(LiveError::Argument(words.into()));
        }
        let bytes = self.lockstep.snapshot(self.trace).to_bytes(&self.loaded);
        Ok(Snapshot { bytes, held: self.held().to_vec(), t: self.lockstep.t() })
    }

    /// Goes back, or forward, to a moment.
    pub fn restore(&mut self, to: &Snapshot) -> Result<(), LiveError> {
        let read = sincro_sim::snapshot::Snapshot::from_bytes(&to.bytes, &self.loaded);
        let snapshot = read.map_err(|error| LiveError::Argument(error.to_string()))?;
        let (now, then) = (self.lockstep.state(), &snapshot.state);
        let fits = now.q.len() == then.q.len() && now.v.len() == then.v.len() && now.totals.len() == then.totals.len();
        if !fits || self.held().len() != to.held.len() {
            return Err(LiveError::Argument("the snapshot has another number of states".into()));
        }
        if self.has_functions && (self.lockstep.structure().is_some() || snapshot.structure.is_some()) {
            let words = "a script has changed the structure, which Python functions do not follow: close the model";
            return Err(LiveError::Argument(words.into()));
        }
        self.lockstep.restore(&snapshot);
        self.trace = snapshot.trace;
        self.held().copy_from_slice(&to.held);
        self.ended = None;
        self.remember();
        Ok(())
    }
}

/// The scene with Python's functions attached to each of its runs.
pub fn with_functions(loaded: &Loaded, functions: &[Arc<Function>], raised: &Raised) -> Loaded {
    let mut loaded = loaded.clone();
    for function in functions {
        loaded.controllers.push(Arc::new(Factory { function: function.clone(), raised: raised.clone() }));
    }
    loaded
}

/// The run under way of a model, begun when it is first needed; none once the model is closed.
pub type Slot = Mutex<Option<Live>>;
