//! Python module `sincro._sincro`: scenes, runs, lock-step, dynamics, tasks. The package `sincro` in `python/` stands
//! on it; users see only that.
//!
//! | file | content |
//! |---|---|
//! | `model` | `Model`: a loaded scene and the run under way that Python steps |
//! | `live` | that run: step, state, signals, snapshot |
//! | `campaign` | a whole run with its error bars, checks and audit: `Run` |
//! | `function` | Python functions as controllers in lock-step |
//! | `dynamics` | mass matrix, inverse and forward dynamics, Jacobians, linearisation, trim |
//! | `environment` | tasks of scenes as many worlds at once, for reinforcement learning |
//! | `numbers` | arguments that Python gives, checked |
//! | `errors` | problems as Python exceptions, with the text of the command line |
//! | `foreground` | long work beside the interpreter: the GIL released, Ctrl-C heard, panics contained |

mod campaign;
mod dynamics;
mod environment;
mod errors;
mod foreground;
mod function;
mod live;
mod model;
mod numbers;

use std::ffi::OsString;
use std::path::PathBuf;

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use sincro_analysis::linear::{self, DMatrix};

/// Runs the command line on its arguments, the first of which is the name of the program; returns its exit status.
#[pyfunction]
fn command_line(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| sincro::command_line::run(arguments))
}

/// Imports a robot file (URDF, SDF, MJCF) as a scene folder; returns the import report as JSON and all warnings.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "the arguments of one function of Python")]
fn import_robot(
    py: Python<'_>,
    robot: PathBuf,
    folder: PathBuf,
    free_base: bool,
    motors: String,
    repairs: Vec<String>,
    package_paths: Vec<String>,
    merge_fixed: bool,
) -> PyResult<(String, Vec<String>)> {
    let request = dynamics::ImportRequest { free_base, motors, repairs, package_paths, merge_fixed };
    let imported = foreground::contained(py, || dynamics::import(&robot, &folder, &request))?;
    imported.map_err(|found| errors::scene(py, &found))
}

/// Gain of the linear-quadratic regulator `u = −K·x` of `ẋ = A·x + B·u`, `m × n`.
#[pyfunction]
fn lqr<'py>(
    py: Python<'py>,
    a: PyReadonlyArray2<'py, f64>,
    b: PyReadonlyArray2<'py, f64>,
    q: PyReadonlyArray2<'py, f64>,
    r: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let of = |m: &PyReadonlyArray2<'_, f64>| {
        let m = m.as_array();
        DMatrix::from_fn(m.nrows(), m.ncols(), |i, k| m[[i, k]])
    };
    let (a, b, q, r) = (of(&a), of(&b), of(&q), of(&r));
    let found = foreground::contained(py, || linear::lqr(&a, &b, &q, &r))?;
    let k = found.map_err(|error| errors::argument(py, &format!("there is no regulator: {error}")))?.k;
    let rows: Vec<f64> = k.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<f64>>()).collect();
    PyArray1::from_vec(py, rows).reshape([k.nrows(), k.ncols()])
}

/// Compiled part of the package `sincro`.
#[pymodule]
fn _sincro(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<model::Model>()?;
    module.add_class::<campaign::Run>()?;
    module.add_class::<live::Snapshot>()?;
    module.add_class::<environment::Worlds>()?;
    module.add_function(wrap_pyfunction!(command_line, module)?)?;
    module.add_function(wrap_pyfunction!(import_robot, module)?)?;
    module.add_function(wrap_pyfunction!(lqr, module)?)?;
    Ok(())
}
