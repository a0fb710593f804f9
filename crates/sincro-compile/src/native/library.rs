//! A library made by the compiler: the one module that calls what it holds.

// functions of a loaded library are called through pointers
#![allow(unsafe_code)]

use std::path::Path;

use libloading::Library;

/// Function on rows of inputs, of parameters, of outputs: see [`super::text::library`].
type Signature = unsafe extern "C" fn(*const f64, *const f64, *mut f64) -> i32;

/// Function of a [`LoadedLibrary`], which must outlive it.
#[derive(Clone, Copy)]
pub(super) struct Function(Signature);

pub(super) struct LoadedLibrary(Library);

impl LoadedLibrary {
    pub fn open(path: &Path) -> Result<Self, String> {
        // SAFETY: a library made from our own text has no initializers
        let library = unsafe { Library::new(path) };
        library.map(Self).map_err(|error| format!("the compiled library cannot be loaded: {error}"))
    }

    pub fn function(&self, name: &str) -> Result<Function, String> {
        // SAFETY: functions of that name are written with this signature
        let found = unsafe { self.0.get::<Signature>(name.as_bytes()) };
        found.map(|symbol| Function(*symbol)).map_err(|_| format!("the compiled library has no function {name}"))
    }

    /// Calls a function of this library; the callers have checked the lengths. False if it refuses the inputs.
    #[inline]
    pub fn call(&self, Function(f): Function, inputs: *const f64, parameters: &[f64], outputs: *mut f64) -> bool {
        // SAFETY: the library is open while `self` lives; the function reads and writes rows within the arrays alone,
        // and reads all of its inputs before it writes
        unsafe { f(inputs, parameters.as_ptr(), outputs) != 0 }
    }
}
