//! A library made by the compiler: the one module that calls what it holds.

// functions of a loaded library are called through pointers
#![allow(unsafe_code)]

use std::path::Path;

use libloading::Library;
use sincro_math::Real;
use sincro_math::elementary::{Binary, Unary};

/// Elementary functions by their number, those of two arguments after the others.
type Call = extern "C" fn(i32, f64, f64) -> f64;

/// Function on rows of inputs, of parameters and of outputs, two arrays of results, and lanes whose first flag does not
/// count: see [`super::text::library`].
type Signature = unsafe extern "C" fn(*const f64, *const f64, *mut f64, *mut f64, *mut f64, u64, Call) -> i64;

extern "C" fn call(f: i32, x: f64, y: f64) -> f64 {
    let f = f as usize;
    match Unary::ALL.get(f) {
        Some(f) => x.unary(*f),
        None => Binary::ALL.get(f - Unary::ALL.len()).map_or(f64::NAN, |f| x.binary(*f, y)),
    }
}

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

    /// Calls a function of this library; the callers have checked the lengths. Returns its flags; negative if it
    /// refuses the inputs.
    #[inline]
    pub fn call(
        &self,
        Function(f): Function,
        inputs: *const f64,
        parameters: &[f64],
        outputs: *mut f64,
        [first, second]: [&mut [f64]; 2],
        uncounted: u64,
    ) -> i64 {
        // SAFETY: the library is open while `self` lives; the function reads and writes within the arrays alone, and
        // reads all of its inputs before it writes
        unsafe {
            let (first, second) = (first.as_mut_ptr(), second.as_mut_ptr());
            f(inputs, parameters.as_ptr(), outputs, first, second, uncounted, call)
        }
    }
}
