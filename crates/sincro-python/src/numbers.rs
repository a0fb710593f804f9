//! Arguments that Python gives, checked: lists of numbers of a known length, all finite.

use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors;

/// Numbers of an argument, which may be a NumPy array of any real type, a sequence, or a single number where one is
/// wanted.
///
/// # Errors
///
/// `ArgumentError`: it is none of these, has another length than `n`, or a number is not finite.
pub fn vector(py: Python<'_>, name: &str, given: &Bound<'_, PyAny>, n: usize) -> PyResult<Vec<f64>> {
    let numbers = list(py, name, given)?;
    fits(py, name, &numbers, n)?;
    Ok(numbers)
}

/// As [`vector`], an argument that is left out standing for `otherwise`.
pub fn vector_or(
    py: Python<'_>,
    name: &str,
    given: Option<&Bound<'_, PyAny>>,
    otherwise: &[f64],
) -> PyResult<Vec<f64>> {
    given.map_or_else(|| Ok(otherwise.to_vec()), |given| vector(py, name, given, otherwise.len()))
}

/// Refuses numbers that are not as many as wanted, or not finite.
pub fn fits(py: Python<'_>, name: &str, numbers: &[f64], n: usize) -> PyResult<()> {
    if numbers.len() != n {
        return Err(errors::argument(py, &format!("`{name}` has {} numbers, not {n}", numbers.len())));
    }
    match numbers.iter().position(|x| !x.is_finite()) {
        Some(k) => Err(errors::argument(py, &format!("`{name}[{k}]` is {}, not a finite number", numbers[k]))),
        None => Ok(()),
    }
}

/// Numbers of an argument, of any length.
pub fn list(py: Python<'_>, name: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    if let Ok(array) = given.extract::<PyReadonlyArray1<'_, f64>>() {
        return Ok(array.as_array().to_vec());
    }
    if let Ok(x) = given.extract::<f64>() {
        return Ok(vec![x]);
    }
    let converted = py.import("numpy").and_then(|numpy| numpy.call_method1("asarray", (given,)));
    let array = converted.and_then(real).ok().flatten().and_then(|array| array.cast_into::<PyArray1<f64>>().ok());
    match array {
        Some(array) => Ok(array.readonly().as_array().to_vec()),
        None => {
            let kind = given.get_type().name()?;
            Err(errors::argument(py, &format!("`{name}` is a {kind}, not a one-dimensional array of real numbers")))
        }
    }
}

/// The array as 64-bit floating numbers; none if its numbers are not real: complex, texts, objects.
fn real(array: Bound<'_, PyAny>) -> PyResult<Option<Bound<'_, PyAny>>> {
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    // floating, signed, unsigned, truth
    if "fiub".contains(&kind) { array.call_method1("astype", ("float64",)).map(Some) } else { Ok(None) }
}
