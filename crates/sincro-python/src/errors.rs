//! Problems as Python exceptions. The classes are written in Python (`sincro/_errors.py`); texts are those of the
//! command line: place, message, help.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sincro::Diagnostics;
use sincro_sim::results::Status;

/// An exception of a class of `sincro._errors`.
pub fn new(py: Python<'_>, class: &str, message: &str) -> PyErr {
    let made = py.import("sincro._errors").and_then(|m| m.getattr(class)).and_then(|class| class.call1((message,)));
    match made {
        Ok(value) => PyErr::from_value(value),
        Err(_) => PyRuntimeError::new_err(message.to_owned()),
    }
}

/// Sets an attribute of an exception.
pub fn with<'py>(error: PyErr, py: Python<'py>, name: &str, value: impl IntoPyObject<'py>) -> PyErr {
    // an exception of ours has a dictionary
    let _ = error.value(py).setattr(name, value);
    error
}

/// `SceneError` with all problems of a scene; `diagnostics` has each as a dictionary.
pub fn scene(py: Python<'_>, found: &Diagnostics) -> PyErr {
    let list = PyList::empty(py);
    for diagnostic in &found.0 {
        let entry = PyDict::new(py);
        let place = diagnostic.line_column();
        let file = diagnostic.source.as_ref().map(|source| source.path.display().to_string());
        let filled = entry
            .set_item("severity", if diagnostic.is_error() { "error" } else { "warning" })
            .and_then(|()| entry.set_item("file", file))
            .and_then(|()| entry.set_item("line", place.map(|p| p.0)))
            .and_then(|()| entry.set_item("column", place.map(|p| p.1)))
            .and_then(|()| entry.set_item("message", &diagnostic.message))
            .and_then(|()| entry.set_item("help", diagnostic.help.as_deref()))
            .and_then(|()| list.append(entry));
        if let Err(error) = filled {
            return error;
        }
    }
    with(new(py, "SceneError", &found.to_string()), py, "diagnostics", list)
}

/// `StoppedError`: a run that could not go on.
pub fn stopped(py: Python<'_>, status: &Status) -> PyErr {
    let Status::Stopped { tick, time, reason, help } = status else {
        return new(py, "StoppedError", &format!("the run is over: {status:?}"));
    };
    let text = if help.is_empty() { reason.clone() } else { format!("{reason}\n  help: {help}") };
    let error = with(new(py, "StoppedError", &text), py, "tick", *tick);
    with(with(error, py, "time", *time), py, "help", help.as_str())
}

/// `ArgumentError`: an argument that does not fit.
pub fn argument(py: Python<'_>, message: &str) -> PyErr {
    new(py, "ArgumentError", message)
}

/// `UnknownNameError` with messages and helps of names that Python gave: they have no place in a file.
pub fn unknown_names(py: Python<'_>, found: &Diagnostics) -> PyErr {
    let text = |d: &sincro_scene::diagnostic::Diagnostic| match &d.help {
        Some(help) => format!("{}\n  help: {help}", d.message),
        None => d.message.clone(),
    };
    unknown(py, &found.0.iter().map(text).collect::<Vec<_>>().join("\n"))
}

/// `UnknownNameError`.
pub fn unknown(py: Python<'_>, message: &str) -> PyErr {
    new(py, "UnknownNameError", message)
}
