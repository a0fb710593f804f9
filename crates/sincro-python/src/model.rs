//! `Model`: a loaded scene, and the run under way that Python steps.

use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sincro::Override;
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_scene::record::{Probe, Recorder, catalogue};
use sincro_sim::Loaded;

use crate::campaign::{self, Parts, Run};
use crate::dynamics::{self, LinearRequest, WantedTrim};
use crate::function::{Function, located};
use crate::live::{Live, LiveError, Slot, Snapshot};
use crate::{errors, foreground, numbers};
use sincro_analysis::dynamics::normalize_quaternions;

/// Steps between two looks at the clock.
const STEPS_PER_LOOK: u64 = 256;
/// Time between two looks at Ctrl-C.
const LOOK_EVERY: Duration = Duration::from_millis(50);

thread_local! {
    /// Models that this thread is stepping: a function that controls one cannot use its run.
    static IN_USE: RefCell<Vec<usize>> = const { RefCell::new(Vec::new()) };
}

/// Entry of [`IN_USE`], as long as it lives.
struct Use(usize);

impl Use {
    fn begin(model: &Model) -> Option<Self> {
        let address = std::ptr::from_ref(model).addr();
        IN_USE.with_borrow_mut(|all| {
            let is_free = !all.contains(&address);
            is_free.then(|| {
                all.push(address);
                Self(address)
            })
        })
    }
}

impl Drop for Use {
    fn drop(&mut self) {
        IN_USE.with_borrow_mut(|all| all.retain(|address| *address != self.0));
    }
}

/// A scene, loaded; see the class of the same name in the package.
#[pyclass(subclass, frozen, module = "sincro._sincro")]
pub struct Model {
    path: PathBuf,
    settings: Vec<(String, String)>,
    overrides: Vec<Override>,
    loaded: Arc<Loaded>,
    /// Name and unit of each command.
    commands: Vec<(String, String)>,
    functions: Mutex<Vec<Arc<Function>>>,
    live: Slot,
    is_closed: AtomicBool,
}

impl Model {
    pub(crate) fn loaded(&self) -> &Arc<Loaded> {
        &self.loaded
    }

    fn functions(&self) -> Vec<Arc<Function>> {
        self.functions.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn refuse_closed(&self, py: Python<'_>) -> PyResult<()> {
        let is_closed = self.is_closed.load(Ordering::Relaxed);
        if is_closed { Err(errors::new(py, "ClosedError", "the model was closed: load it again")) } else { Ok(()) }
    }

    /// Uses the run under way, begun if it is not, with the GIL released.
    fn with_live<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Live) -> Result<T, LiveError> + Send,
    ) -> PyResult<T> {
        self.refuse_closed(py)?;
        let Some(in_use) = Use::begin(self) else {
            let words = "the model is in the middle of a step: a controller gets what it reads as `y`, and cannot use the model";
            return Err(errors::argument(py, words));
        };
        let done = foreground::contained(py, || {
            let mut live = self.live.lock().unwrap_or_else(PoisonError::into_inner);
            if live.is_none() {
                *live = Some(Live::begin(&self.loaded, &self.functions())?);
            }
            live.as_mut().map(act).transpose()
        });
        drop(in_use);
        let done = done?.map_err(|error| error.into_error(py))?;
        done.ok_or_else(|| errors::new(py, "InternalError", "a run that was begun is there"))
    }

    fn command(&self, py: Python<'_>, name: &str) -> PyResult<usize> {
        let is_named =
            |known: &String| known == name || known.strip_suffix(".command").is_some_and(|stem| stem == name);
        self.commands.iter().position(|(known, _)| is_named(known)).ok_or_else(|| {
            let near = sincro_scene::suggest::nearest(name, self.commands.iter().map(|(known, _)| known.as_str()));
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => "`model.inputs` lists the commands".to_owned(),
            };
            errors::unknown(py, &format!("there is no command `{name}`\n  help: {help}"))
        })
    }

    /// Commands that an argument sets: all by a list, some by a dictionary.
    fn inputs_of(&self, py: Python<'_>, u: &Bound<'_, PyAny>) -> PyResult<Vec<(usize, f64)>> {
        let Ok(table) = u.cast::<PyDict>() else {
            let values = numbers::vector(py, "u", u, self.commands.len())?;
            return Ok(values.into_iter().enumerate().collect());
        };
        let mut set = Vec::with_capacity(table.len());
        for (key, value) in table {
            let key: String = key.extract()?;
            set.push((self.command(py, &key)?, numbers::vector(py, &key, &value, 1)?[0]));
        }
        Ok(set)
    }

    /// The state of the run under way.
    fn now(&self, py: Python<'_>) -> PyResult<(Vec<f64>, Vec<f64>)> {
        self.with_live(py, |live| Ok((live.lockstep.state().q.clone(), live.lockstep.state().v.clone())))
    }

    /// Coordinates (n_q,), with quaternions scaled to length 1.
    fn coordinates(&self, py: Python<'_>, given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        let model = &self.loaded.scene.model;
        let mut q = numbers::vector(py, "q", given, model.n_q())?;
        normalize_quaternions(model, &mut q).map_err(|why| errors::argument(py, &why))?;
        Ok(q)
    }

    fn q_or_now(&self, py: Python<'_>, q: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<f64>> {
        self.refuse_closed(py)?;
        match q {
            Some(q) => self.coordinates(py, q),
            None => Ok(self.now(py)?.0),
        }
    }
}

/// First index and the one after the last.
type Range = (usize, usize);

/// Name and unit of each command, as they are recorded.
fn command_names(loaded: &Loaded) -> Vec<(String, String)> {
    let all = catalogue(&loaded.scene.model);
    let name = |k: usize| {
        let entry = all.iter().find(|entry| entry.probe == Probe::Command(k));
        entry.map_or_else(|| (format!("command {k}"), String::new()), |e| (e.name.clone(), e.unit.to_string()))
    };
    (0..loaded.scene.commands.len()).map(name).collect()
}

#[pymethods]
impl Model {
    #[new]
    fn new(py: Python<'_>, path: PathBuf, settings: Vec<(String, String)>) -> PyResult<Self> {
        let overrides: Vec<Override> = settings.iter().map(|(path, value)| Override::new(path, value)).collect();
        let loaded = foreground::contained(py, || sincro::load(&path, &overrides))?;
        let loaded = loaded.map_err(|found| errors::scene(py, &found))?;
        let commands = command_names(&loaded);
        Ok(Self {
            path,
            settings,
            overrides,
            loaded: Arc::new(loaded),
            commands,
            functions: Mutex::default(),
            live: Mutex::default(),
            is_closed: AtomicBool::new(false),
        })
    }

    // ---- the scene

    /// Folder of the scene.
    #[getter]
    fn path(&self) -> PathBuf {
        self.path.clone()
    }

    #[getter]
    fn _settings(&self) -> Vec<(String, String)> {
        self.settings.clone()
    }

    /// Title of the experiment.
    #[getter]
    fn title(&self) -> &str {
        &self.loaded.experiment.title
    }

    /// Warnings about the scene, with their places.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.loaded.warnings.iter().map(ToString::to_string).collect()
    }

    /// Base step [s].
    #[getter]
    fn dt(&self) -> f64 {
        self.loaded.experiment.step
    }

    /// Duration of the experiment [s].
    #[getter]
    fn duration(&self) -> f64 {
        self.loaded.experiment.duration
    }

    /// Number of coordinates.
    #[getter]
    fn n_q(&self) -> usize {
        self.loaded.scene.model.n_q()
    }

    /// Number of velocities: degrees of freedom, closed loops not counted.
    #[getter]
    fn n_v(&self) -> usize {
        self.loaded.scene.model.n_v()
    }

    /// Name and unit of every command, in the order of `step`.
    #[getter]
    fn inputs(&self) -> Vec<(String, String)> {
        self.commands.clone()
    }

    /// Name and unit of every signal that can be read.
    #[getter]
    fn signals(&self) -> Vec<(String, String)> {
        let of_diagram = self.loaded.controller.as_ref().map(|c| c.entries()).unwrap_or_default();
        let all = catalogue(&self.loaded.scene.model).into_iter().chain(of_diagram);
        all.map(|entry| (entry.name, entry.unit.to_string())).collect()
    }

    /// Path, first and last coordinate (exclusive), first and last velocity of every joint.
    #[getter]
    fn joints(&self) -> Vec<(String, Range, Range)> {
        let of = |j: &sincro_dynamics::model::JointInfo| {
            (j.name.clone(), (j.q_idx, j.q_idx + j.n_q), (j.v_idx, j.v_idx + j.n_v))
        };
        self.loaded.scene.model.names().joints.iter().map(of).collect()
    }

    /// Paths of bodies and frames.
    #[getter]
    fn frames(&self) -> Vec<String> {
        self.loaded.scene.model.names().frames.iter().map(|frame| frame.name.clone()).collect()
    }

    /// True if the experiment has a task.
    #[getter]
    fn has_task(&self) -> bool {
        self.loaded.experiment.task.is_some()
    }

    /// Closes the model: what is asked of it later is refused.
    fn close(&self) {
        self.is_closed.store(true, Ordering::Relaxed);
        if let Ok(mut live) = self.live.try_lock() {
            *live = None;
        }
    }

    // ---- whole runs

    #[pyo3(signature = (until, error_bars, variants))]
    fn _run(&self, py: Python<'_>, until: Option<f64>, error_bars: bool, variants: bool) -> PyResult<Run> {
        self.refuse_closed(py)?;
        let parts = Parts { error_bars, variants };
        let functions = self.functions();
        let Some(until) = until else {
            return campaign::run(py, (&self.path, &self.overrides, &self.loaded), &functions, parts);
        };
        let mut overrides = self.overrides.clone();
        overrides.push(Override::new("duration", &format!("{until:?}")));
        let loaded = foreground::contained(py, || self.loaded.with_overrides(&overrides))?;
        let loaded = loaded.map_err(|found| errors::scene(py, &found))?;
        campaign::run(py, (&self.path, &overrides, &loaded), &functions, parts)
    }

    // ---- the run under way

    /// Time of the run under way [s].
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.with_live(py, |live| Ok(live.lockstep.t()))
    }

    /// Base steps of the run under way.
    #[getter]
    fn tick(&self, py: Python<'_>) -> PyResult<u64> {
        self.with_live(py, |live| Ok(live.lockstep.tick()))
    }

    /// Hash of all states of the run under way, as `sincro run` prints it.
    #[getter]
    fn trace_hash(&self, py: Python<'_>) -> PyResult<String> {
        self.with_live(py, |live| Ok(live.trace().to_string()))
    }

    /// Coordinates of the run under way, (n_q,) [rad] or [m].
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.now(py)?.0))
    }

    /// Velocities of the run under way, (n_v,) [rad/s] or [m/s].
    #[getter]
    fn v<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.now(py)?.1))
    }

    /// Puts the run under way into another state: coordinates (n_q,), velocities (n_v,); what is left out stays.
    /// Coordinates beyond rigid limits of joints are refused.
    #[pyo3(signature = (q=None, v=None))]
    fn set_state(&self, py: Python<'_>, q: Option<&Bound<'_, PyAny>>, v: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let q = q.map(|q| self.coordinates(py, q)).transpose()?;
        let v = v.map(|v| numbers::vector(py, "v", v, self.n_v())).transpose()?;
        self.with_live(py, |live| {
            live.refuse_beyond_limits(q.as_deref())?;
            live.place(q, v);
            Ok(())
        })
    }

    /// Puts a body or frame that is fixed in the world at another place there while the run is under way: position
    /// (3,) [m], orientation as a quaternion w, x, y, z (4,); what is left out stays. What a bushing joins to it
    /// follows, as what a weld joins to a mocap body of MuJoCo. Not for a model with Python functions as controllers.
    #[pyo3(signature = (path, position=None, quaternion_wxyz=None))]
    fn set_pose(
        &self,
        py: Python<'_>,
        path: String,
        position: Option<&Bound<'_, PyAny>>,
        quaternion_wxyz: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let position = position.map(|p| numbers::vector(py, "position", p, 3)).transpose()?;
        let wxyz = quaternion_wxyz.map(|q| numbers::vector(py, "quaternion_wxyz", q, 4)).transpose()?;
        if wxyz.as_ref().is_some_and(|q| q.iter().all(|x| *x == 0.0)) {
            return Err(errors::argument(py, "`quaternion_wxyz` is zero, which is no orientation"));
        }
        self.with_live(py, move |live| {
            live.move_fixed(&path, |here| Pose {
                pos: position.map_or(here.pos, |p| Vec3([p[0], p[1], p[2]])),
                rot: wxyz.map_or(here.rot, |q| Quat::from_slice(&q).normalized().matrix()),
            })
        })
    }

    /// Advances the run under way by base steps. `u`: all commands in the order of `inputs` (n_inputs,), or some of
    /// them by name; they win over the scene's signals and the diagram, and are held until they are set again or
    /// released.
    #[pyo3(signature = (u=None, steps=1))]
    fn step(&self, py: Python<'_>, u: Option<&Bound<'_, PyAny>>, steps: i64) -> PyResult<()> {
        if steps < 0 {
            return Err(errors::argument(py, &format!("`steps` is {steps}: worlds do not go back; `restore` does")));
        }
        let set = match u {
            Some(u) => self.inputs_of(py, u)?,
            None => Vec::new(),
        };
        self.with_live(py, move |live| {
            if !set.is_empty() {
                let held = live.held();
                set.into_iter().for_each(|(command, value)| held[command] = Some(value));
            }
            if steps == 1 {
                return live.step();
            }
            let mut looked = Instant::now();
            for k in 0..steps as u64 {
                live.step()?;
                if k % STEPS_PER_LOOK == STEPS_PER_LOOK - 1 && looked.elapsed() > LOOK_EVERY {
                    Python::attach(|py| py.check_signals()).map_err(LiveError::Signal)?;
                    looked = Instant::now();
                }
            }
            Ok(())
        })
    }

    /// Gives commands back to the scene and its diagram.
    fn release(&self, py: Python<'_>) -> PyResult<()> {
        self.with_live(py, |live| {
            live.held().fill(None);
            Ok(())
        })
    }

    /// Begins the run under way anew, commands released.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        self.refuse_closed(py)?;
        let Some(in_use) = Use::begin(self) else {
            return Err(errors::argument(py, "the model is in the middle of a step: a controller cannot reset it"));
        };
        py.detach(|| *self.live.lock().unwrap_or_else(PoisonError::into_inner) = None);
        drop(in_use);
        Ok(())
    }

    /// Values of signals at the present instant, in the order of the names.
    fn observe<'py>(&self, py: Python<'py>, names: Vec<String>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = self.with_live(py, |live| {
            let mut values = Vec::with_capacity(names.len());
            live.observe(&names, &mut values)?;
            Ok(values)
        })?;
        Ok(PyArray1::from_vec(py, values))
    }

    /// The present moment, exact, to go back to.
    fn snapshot(&self, py: Python<'_>) -> PyResult<Snapshot> {
        self.with_live(py, Live::snapshot)
    }

    /// Goes back, or forward, to a moment of this scene with these settings.
    fn restore(&self, py: Python<'_>, to: &Bound<'_, Snapshot>) -> PyResult<()> {
        let to = to.get();
        self.with_live(py, |live| live.restore(to))
    }

    #[pyo3(signature = (named, period, reads, writes, is_repeatable))]
    fn _control(
        &self,
        py: Python<'_>,
        named: (String, Py<PyAny>),
        period: Option<f64>,
        reads: Vec<String>,
        writes: Vec<String>,
        is_repeatable: bool,
    ) -> PyResult<()> {
        self.refuse_closed(py)?;
        let step = self.dt();
        let ticks = (period.unwrap_or(step) / step).round();
        let is_whole = period.is_none_or(|period| (period - ticks * step).abs() <= 1e-9 * period.abs());
        if !(1.0..1e15).contains(&ticks) || !is_whole {
            let period = period.unwrap_or(step);
            let words = format!("a period of {period} s is no whole multiple of the base step of {step} s");
            return Err(errors::argument(py, &words));
        }
        let model = &self.loaded.scene.model;
        Recorder::new(&located("reads", &reads), model, &[]).map_err(|found| {
            let of_diagram = self.loaded.controller.as_ref().map(|c| c.entries()).unwrap_or_default();
            match reads.iter().find(|name| of_diagram.iter().any(|entry| entry.name == **name)) {
                Some(name) => errors::unknown(
                    py,
                    &format!("`{name}` is a signal of the diagram: functions read signals of the world and of sensors"),
                ),
                None => errors::unknown_names(py, &found),
            }
        })?;
        let mut commands = Vec::with_capacity(writes.len());
        for name in writes {
            let command = self.command(py, &name)?;
            commands.push((command, name));
        }
        let (every, (name, function)) = (ticks as u64, named);
        let function = Function { name, function, every, reads, writes: commands, is_repeatable };
        self.functions.lock().unwrap_or_else(PoisonError::into_inner).push(Arc::new(function));
        self.reset(py)
    }

    /// Names of the controllers in Python.
    #[getter]
    fn controllers(&self) -> Vec<String> {
        self.functions().iter().map(|function| function.name.clone()).collect()
    }

    fn _clear_controllers(&self, py: Python<'_>) -> PyResult<()> {
        self.functions.lock().unwrap_or_else(PoisonError::into_inner).clear();
        self.reset(py)
    }

    // ---- equations of motion

    /// Mass matrix M(q) with armature, (n_v, n_v) [kg·m²], [kg·m] or [kg]; `q` (n_q,): now unless given.
    #[pyo3(signature = (q=None))]
    fn mass_matrix<'py>(&self, py: Python<'py>, q: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let q = self.q_or_now(py, q)?;
        let terms = foreground::contained(py, || dynamics::terms(&self.loaded, q, None, None, None))?;
        matrix(py, terms.mass_matrix, self.n_v(), self.n_v())
    }

    /// Torques τ = M(q)·v̇ + h(q, v), springs and dampers left out, (n_v,) [N·m] or [N]; `q`: now, `v`, `v_dot`: zero
    /// unless given.
    #[pyo3(signature = (q=None, v=None, v_dot=None))]
    fn inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: Option<&Bound<'py, PyAny>>,
        v: Option<&Bound<'py, PyAny>>,
        v_dot: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (q, zeros) = (self.q_or_now(py, q)?, vec![0.0; self.n_v()]);
        let v = numbers::vector_or(py, "v", v, &zeros)?;
        let v_dot = numbers::vector_or(py, "v_dot", v_dot, &zeros)?;
        let terms = foreground::contained(py, || dynamics::terms(&self.loaded, q, Some(v), Some(v_dot), None))?;
        Ok(PyArray1::from_vec(py, terms.inverse_dynamics))
    }

    /// Accelerations v̇ under the torques `tau`, springs and dampers left out, (n_v,) [rad/s²] or [m/s²]; `q`: now,
    /// `v`, `tau`: zero unless given.
    #[pyo3(signature = (q=None, v=None, tau=None))]
    fn forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: Option<&Bound<'py, PyAny>>,
        v: Option<&Bound<'py, PyAny>>,
        tau: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (q, zeros) = (self.q_or_now(py, q)?, vec![0.0; self.n_v()]);
        let v = numbers::vector_or(py, "v", v, &zeros)?;
        let tau = numbers::vector_or(py, "tau", tau, &zeros)?;
        let terms = foreground::contained(py, || dynamics::terms(&self.loaded, q, Some(v), None, Some(tau)))?;
        Ok(PyArray1::from_vec(py, terms.forward_dynamics))
    }

    /// Jacobian of a body or frame, (6, n_v): angular velocity [rad/s], then velocity of the origin [m/s], world axes.
    #[pyo3(signature = (frame, q=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        frame: &str,
        q: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let q = self.q_or_now(py, q)?;
        let names = self.frames();
        let Some(index) = names.iter().position(|name| name == frame) else {
            let near = sincro_scene::suggest::nearest(frame, names.iter().map(String::as_str));
            let help = near.map_or_else(|| names.join(", "), |near| format!("did you mean `{near}`?"));
            return Err(errors::unknown(py, &format!("there is no body or frame `{frame}`\n  help: {help}")));
        };
        let rows = foreground::contained(py, || dynamics::jacobian(&self.loaded, &q, index))?;
        matrix(py, rows, 6, self.n_v())
    }

    #[pyo3(signature = (q, v, tau))]
    fn _forward_dynamics_derivatives<'py>(
        &self,
        py: Python<'py>,
        q: Option<&Bound<'py, PyAny>>,
        v: Option<&Bound<'py, PyAny>>,
        tau: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<[Bound<'py, PyArray2<f64>>; 3]> {
        let (q, n, zeros) = (self.q_or_now(py, q)?, self.n_v(), vec![0.0; self.n_v()]);
        let v = numbers::vector_or(py, "v", v, &zeros)?;
        let tau = numbers::vector_or(py, "tau", tau, &zeros)?;
        let [by_q, by_v, by_tau] =
            foreground::contained(py, || dynamics::forward_derivatives(&self.loaded, &q, &v, &tau))?;
        Ok([matrix(py, by_q, n, n)?, matrix(py, by_v, n, n)?, matrix(py, by_tau, n, n)?])
    }

    /// JSON of the linearisation (`sincro linearize --json`), with the operating point.
    #[pyo3(signature = (at, equilibrium, inputs, outputs, closed_loop))]
    fn _linearize(
        &self,
        py: Python<'_>,
        at: Option<f64>,
        equilibrium: bool,
        inputs: Vec<String>,
        outputs: Vec<String>,
        closed_loop: bool,
    ) -> PyResult<(String, [Vec<f64>; 4], Vec<String>)> {
        let request = LinearRequest { inputs, outputs, closed_loop, equilibrium };
        let found = match at {
            Some(t) => {
                self.refuse_closed(py)?;
                foreground::contained(py, || dynamics::linearize_at(&self.loaded, t, &request))?
            }
            None => self.with_live(py, |live| Ok(dynamics::linearize(&self.loaded, &mut live.lockstep, &request)))?,
        };
        found.map_err(|found| errors::scene(py, &found))
    }

    /// JSON of the sampled loop (`sincro linearize --sampled --json`), which is opened at the signals `loops` in turn.
    #[pyo3(signature = (at, equilibrium, loops))]
    fn _linearize_sampled(
        &self,
        py: Python<'_>,
        at: Option<f64>,
        equilibrium: bool,
        loops: Vec<String>,
    ) -> PyResult<String> {
        let found = match at {
            Some(t) => {
                self.refuse_closed(py)?;
                foreground::contained(py, || dynamics::sampled_at(&self.loaded, t, equilibrium, &loops))?
            }
            None => {
                self.with_live(py, |live| Ok(dynamics::sampled(&self.loaded, &live.lockstep, equilibrium, &loops)))?
            }
        };
        found.map_err(|found| errors::scene(py, &found))
    }

    /// JSON of an equilibrium (`sincro trim --json`); its state becomes that of the run under way if `go` is true.
    #[pyo3(signature = (free, want, closed_loop, go))]
    fn _trim(
        &self,
        py: Python<'_>,
        free: Vec<String>,
        want: Vec<(String, f64)>,
        closed_loop: bool,
        go: bool,
    ) -> PyResult<(String, Vec<f64>)> {
        let request = WantedTrim { free, want, closed_loop };
        let found = self.with_live(py, |live| {
            let found = dynamics::trim(&self.loaded, &live.lockstep, &request);
            if let (Ok((_, state)), true) = (&found, go) {
                let zeros = vec![0.0; self.n_v()];
                live.place(Some(state.q.clone()), Some(zeros));
            }
            Ok(found.map(|(text, state)| (text, state.q)))
        })?;
        found.map_err(|found| errors::scene(py, &found))
    }
}

/// Rows of numbers as an array.
fn matrix(py: Python<'_>, numbers: Vec<f64>, rows: usize, columns: usize) -> PyResult<Bound<'_, PyArray2<f64>>> {
    PyArray1::from_vec(py, numbers).reshape([rows, columns])
}
