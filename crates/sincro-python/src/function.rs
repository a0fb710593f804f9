//! Python functions as controllers in lock-step, at their own rate.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sincro_scene::diagnostic::{Located, Location, SourceText};
use sincro_scene::record::Recorder;
use sincro_scene::script::ScriptError;
use sincro_sim::controller::{Commands, Controller, Forked, Instant};
use sincro_sim::restructure::Restructured;
use sincro_sim::{ControllerFactory, Loaded};

use crate::numbers;

/// The exception that ended a run, if a function raised one; shared by the controllers of the run.
pub type Raised = Arc<Mutex<Option<PyErr>>>;

/// A function that controls: which signals it reads, which commands it sets, how often.
#[derive(Debug)]
pub struct Function {
    /// Name in messages.
    pub name: String,
    /// `function(t, y)`, which returns the commands, or none to hold them.
    pub function: Py<PyAny>,
    /// Base steps from one call to the next.
    pub every: u64,
    /// Signals that it reads, in the order of `y`.
    pub reads: Vec<String>,
    /// Commands that it sets, by index and name, in the order of what it returns.
    pub writes: Vec<(usize, String)>,
    /// True if it gives the same answers in a second run: it keeps no memory, or has a method `reset`.
    pub is_repeatable: bool,
}

/// Makes the controller of one run.
#[derive(Debug)]
pub struct Factory {
    /// The function.
    pub function: Arc<Function>,
    /// Slot for its exceptions.
    pub raised: Raised,
}

impl ControllerFactory for Factory {
    fn controller(&self, _: &Loaded) -> Box<dyn Controller> {
        Box::new(FunctionController {
            function: self.function.clone(),
            raised: self.raised.clone(),
            recorder: None,
            sensors: Vec::new(),
            held: vec![None; self.function.writes.len()],
        })
    }
}

/// Names as located texts, for readers that report places.
pub fn located<'a>(what: &str, names: impl IntoIterator<Item = &'a String>) -> Vec<Located<String>> {
    let at = |name: &String| {
        let source = Arc::new(SourceText { path: what.into(), text: name.clone() });
        Located { value: name.clone(), at: Location { source, span: 0..name.len() } }
    };
    names.into_iter().map(at).collect()
}

/// A function at work in one run.
struct FunctionController {
    function: Arc<Function>,
    raised: Raised,
    recorder: Option<Recorder>,
    /// Values of all sensors, as they were last sampled.
    sensors: Vec<f64>,
    held: Vec<Option<f64>>,
}

impl fmt::Debug for FunctionController {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FunctionController").field("name", &self.function.name).finish_non_exhaustive()
    }
}

impl FunctionController {
    fn failed(&self, message: String) -> ScriptError {
        ScriptError { object: self.function.name.clone(), at: None, message, help: None }
    }

    /// Keeps an exception for whoever started the run, and says it in words.
    fn raised(&self, py: Python<'_>, error: PyErr) -> ScriptError {
        let words = error.to_string();
        let mut first = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert_with(|| error.clone_ref(py));
        self.failed(words)
    }

    /// Commands from what the function returned.
    fn take(&mut self, py: Python<'_>, answer: &Bound<'_, PyAny>) -> PyResult<()> {
        let function = self.function.clone();
        if answer.is_none() {
            return Ok(());
        }
        if let Ok(table) = answer.cast::<PyDict>() {
            for (key, value) in table {
                let key: String = key.extract()?;
                let is_named = |name: &str| name == key || name.strip_suffix(".command") == Some(key.as_str());
                let place = function.writes.iter().position(|(_, name)| is_named(name));
                let Some(place) = place else {
                    let names: Vec<&str> = function.writes.iter().map(|(_, name)| name.as_str()).collect();
                    let message =
                        format!("`{key}` is none of the commands of `{}`: {}", function.name, names.join(", "));
                    return Err(crate::errors::unknown(py, &message));
                };
                self.held[place] = Some(numbers::vector(py, &key, &value, 1)?[0]);
            }
            return Ok(());
        }
        let values = numbers::vector(py, "the answer", answer, function.writes.len())?;
        self.held.iter_mut().zip(values).for_each(|(held, value)| *held = Some(value));
        Ok(())
    }
}

impl Controller for FunctionController {
    fn name(&self) -> &str {
        &self.function.name
    }

    fn start(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        let model = at.world.model();
        let reads = located("reads", &self.function.reads);
        let recorder = Recorder::new(&reads, model, &[]).map_err(|found| self.failed(found.to_string()))?;
        let n_sensed = model.names().sensors.iter().map(|s| s.values.len()).sum();
        self.sensors = vec![f64::NAN; n_sensed];
        self.recorder = Some(recorder);
        self.held.fill(None);
        Python::attach(|py| {
            let function = self.function.function.bind(py);
            match function.hasattr("reset") {
                Ok(true) => function.call_method0("reset").map(|_| ()).map_err(|error| self.raised(py, error)),
                _ => Ok(()),
            }
        })
    }

    fn measure(&mut self, _: Instant<'_>, sensors: &[f64]) -> Result<(), sincro_sim::controller::NotFinite> {
        self.sensors.copy_from_slice(sensors);
        Ok(())
    }

    fn actuate(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        if !at.tick.is_multiple_of(self.function.every) {
            return Ok(());
        }
        let Some(recorder) = &mut self.recorder else { return Ok(()) };
        let seen = at.world.observe(at.t);
        let row = recorder.row(&seen, &self.sensors, at.t, at.tick == 0)[1..].to_vec();
        Python::attach(|py| {
            let answer = self.function.function.bind(py).call1((at.t, PyArray1::from_vec(py, row)));
            let taken = answer.and_then(|answer| self.take(py, &answer));
            taken.map_err(|error| self.raised(py, error))
        })
    }

    fn latch(&self, commands: &mut Commands<'_>) {
        for ((command, _), held) in self.function.writes.iter().zip(&self.held) {
            if let Some(value) = held {
                commands.set(*command, *value);
            }
        }
    }

    fn restructured(&mut self, _: &Restructured) -> Result<(), String> {
        Err("the structure changes, which a function of Python cannot follow".to_owned())
    }

    fn fork(&self) -> Forked {
        Forked::Nothing
    }
}

/// Commands that Python holds while it steps a run, the strongest source, and changes of the structure that it has
/// made and the run has not adopted.
#[derive(Clone, Debug)]
pub struct Held {
    pub commands: Vec<Option<f64>>,
    pub made: Vec<Restructured>,
}

impl Controller for Held {
    fn name(&self) -> &str {
        "step"
    }

    fn latch(&self, commands: &mut Commands<'_>) {
        for (command, held) in self.commands.iter().enumerate() {
            if let Some(value) = held {
                commands.set(command, *value);
            }
        }
    }

    fn take_restructured(&mut self) -> Vec<Restructured> {
        std::mem::take(&mut self.made)
    }

    fn fork(&self) -> Forked {
        Forked::Whole(Box::new(self.clone()))
    }
}
