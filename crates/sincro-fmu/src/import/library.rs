//! Functions of a foreign FMU's library.
//!
//! The one module of this crate that calls foreign code.

// foreign functions are called through pointers
#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_void};
use std::path::Path;

use libloading::{Library, Symbol};

use super::description::NumberKind;
use crate::description::FmiVersion;

type Handle = *mut c_void;

/// Status of a call: 0 all went well, 1 a warning, else it failed.
type Status = i32;

#[repr(C)]
struct Callbacks {
    logger: *const c_void,
    allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free: unsafe extern "C" fn(*mut c_void),
    step_finished: *const c_void,
    environment: *mut c_void,
}

// SAFETY: immutable pointers to functions
unsafe impl Sync for Callbacks {}

unsafe extern "C" {
    fn calloc(n: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

/// Messages of foreign FMUs are not shown: their texts are formats with arguments that Rust cannot take.
extern "C" fn ignore2(_: *mut c_void, _: *const c_char, _: Status, _: *const c_char, _: *const c_char) {}
extern "C" fn ignore3(_: *mut c_void, _: Status, _: *const c_char, _: *const c_char) {}

static CALLBACKS: Callbacks = Callbacks {
    logger: ignore2 as *const c_void,
    allocate: calloc,
    free,
    step_finished: std::ptr::null(),
    environment: std::ptr::null_mut(),
};

/// The functions for co-simulation.
#[derive(Debug)]
pub(super) struct Functions {
    version: FmiVersion,
    library: Library,
}

/// An instance in a library; a pointer of the library's own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Component(Handle);

// SAFETY: the standard allows an instance to be called from any thread, one at a time; `Slave` gives it to one
unsafe impl Send for Component {}

/// Saved state of an instance.
#[derive(Clone, Copy, Debug)]
pub(super) struct SavedState(Handle);

// SAFETY: as for `Component`
unsafe impl Send for SavedState {}

const REQUIRED: [&str; 8] = [
    "EnterInitializationMode",
    "ExitInitializationMode",
    "FreeInstance",
    "Terminate",
    "DoStep",
    "GetVersion",
    "Reset",
    "SetDebugLogging",
];

impl Functions {
    /// Loads a library and looks for its functions.
    pub(super) fn load(path: &Path, version: FmiVersion) -> Result<Self, String> {
        // SAFETY: initializers of the library run; the user named the FMU
        let library = unsafe { Library::new(path) }
            .map_err(|error| format!("the library of the FMU cannot be loaded: {error}"))?;
        let new = Self { version, library };
        let own: &[&str] = match version {
            FmiVersion::V2 => &["Instantiate", "SetupExperiment", "GetReal", "SetReal"],
            FmiVersion::V3 => &["InstantiateCoSimulation", "GetFloat64", "SetFloat64"],
        };
        for name in REQUIRED.iter().chain(own) {
            new.find::<unsafe extern "C" fn()>(name)?;
        }
        Ok(new)
    }

    fn find<T>(&self, name: &str) -> Result<Symbol<'_, T>, String> {
        let prefix = if self.version == FmiVersion::V2 { "fmi2" } else { "fmi3" };
        // SAFETY: the types given by the callers in this file are those of the standard
        unsafe { self.library.get(format!("{prefix}{name}").as_bytes()) }
            .map_err(|_| format!("the library of the FMU has no function {prefix}{name}"))
    }

    fn check(name: &str, status: Status) -> Result<(), String> {
        if matches!(status, 0 | 1) { Ok(()) } else { Err(format!("{name} of the FMU failed with status {status}")) }
    }

    pub(super) fn instantiate(&self, name: &str, token: &str, resources: &str) -> Result<Component, String> {
        let of_c = |text: &str| CString::new(text).map_err(|_| "a text of the FMU has a zero in it".to_owned());
        let (name, token, resources) = (of_c(name)?, of_c(token)?, of_c(resources)?);
        type V2 = unsafe extern "C" fn(
            *const c_char,
            i32,
            *const c_char,
            *const c_char,
            *const Callbacks,
            i32,
            i32,
        ) -> Handle;
        type V3 = unsafe extern "C" fn(
            *const c_char,
            *const c_char,
            *const c_char,
            bool,
            bool,
            bool,
            bool,
            *const u32,
            usize,
            *mut c_void,
            extern "C" fn(*mut c_void, Status, *const c_char, *const c_char),
            *const c_void,
        ) -> Handle;
        let (n, t, r) = (name.as_ptr(), token.as_ptr(), resources.as_ptr());
        let handle = match self.version {
            FmiVersion::V2 => {
                let function = self.find::<V2>("Instantiate")?;
                // SAFETY: texts and functions outlive the call; the functions outlive the instance
                unsafe { function(n, 1, t, r, &raw const CALLBACKS, 0, 0) }
            }
            FmiVersion::V3 => {
                let function = self.find::<V3>("InstantiateCoSimulation")?;
                let none = std::ptr::null_mut();
                // SAFETY: as above
                unsafe {
                    function(n, t, r, false, false, false, false, std::ptr::null(), 0, none, ignore3, std::ptr::null())
                }
            }
        };
        if handle.is_null() { Err("the FMU refused to be instantiated".into()) } else { Ok(Component(handle)) }
    }

    pub(super) fn enter_initialization(&self, c: Component, start: f64) -> Result<(), String> {
        const NAME: &str = "EnterInitializationMode";
        let status = match self.version {
            FmiVersion::V2 => {
                type Setup = unsafe extern "C" fn(Handle, i32, f64, f64, i32, f64) -> Status;
                let setup = self.find::<Setup>("SetupExperiment")?;
                // SAFETY: a live instance
                Self::check("SetupExperiment", unsafe { setup(c.0, 0, 0.0, start, 0, 0.0) })?;
                let enter = self.find::<unsafe extern "C" fn(Handle) -> Status>(NAME)?;
                // SAFETY: a live instance
                unsafe { enter(c.0) }
            }
            FmiVersion::V3 => {
                type Enter = unsafe extern "C" fn(Handle, bool, f64, f64, bool, f64) -> Status;
                let enter = self.find::<Enter>(NAME)?;
                // SAFETY: a live instance
                unsafe { enter(c.0, false, 0.0, start, false, 0.0) }
            }
        };
        Self::check(NAME, status)
    }

    /// A function without arguments.
    pub(super) fn call(&self, name: &str, c: Component) -> Result<(), String> {
        let function = self.find::<unsafe extern "C" fn(Handle) -> Status>(name)?;
        // SAFETY: a live instance
        Self::check(name, unsafe { function(c.0) })
    }

    pub(super) fn free(&self, c: Component) {
        if let Ok(function) = self.find::<unsafe extern "C" fn(Handle)>("FreeInstance") {
            // SAFETY: a live instance, which its owner gives up
            unsafe { function(c.0) }
        }
    }

    pub(super) fn get(&self, c: Component, references: &[u32], values: &mut [f64]) -> Result<(), String> {
        let n = references.len().min(values.len());
        let (r, v) = (references.as_ptr(), values.as_mut_ptr());
        match self.version {
            FmiVersion::V2 => {
                type Get = unsafe extern "C" fn(Handle, *const u32, usize, *mut f64) -> Status;
                // SAFETY: as many places as references
                Self::check("GetReal", unsafe { self.find::<Get>("GetReal")?(c.0, r, n, v) })
            }
            FmiVersion::V3 => {
                type Get = unsafe extern "C" fn(Handle, *const u32, usize, *mut f64, usize) -> Status;
                // SAFETY: as many places as references
                Self::check("GetFloat64", unsafe { self.find::<Get>("GetFloat64")?(c.0, r, n, v, n) })
            }
        }
    }

    pub(super) fn set(&self, c: Component, references: &[u32], values: &[f64]) -> Result<(), String> {
        let n = references.len().min(values.len());
        let (r, v) = (references.as_ptr(), values.as_ptr());
        match self.version {
            FmiVersion::V2 => {
                type Set = unsafe extern "C" fn(Handle, *const u32, usize, *const f64) -> Status;
                // SAFETY: as many values as references
                Self::check("SetReal", unsafe { self.find::<Set>("SetReal")?(c.0, r, n, v) })
            }
            FmiVersion::V3 => {
                type Set = unsafe extern "C" fn(Handle, *const u32, usize, *const f64, usize) -> Status;
                // SAFETY: as many values as references
                Self::check("SetFloat64", unsafe { self.find::<Set>("SetFloat64")?(c.0, r, n, v, n) })
            }
        }
    }

    /// Value of one number that is not of the type Float64.
    pub(super) fn get_number(&self, c: Component, kind: NumberKind, reference: u32) -> Result<f64, String> {
        let name = self.name_of(kind, "Get");
        macro_rules! get {
            ($($kind:ident: $number:ty),*) => {
                match kind {
                    $(NumberKind::$kind => {
                        let mut value = <$number>::default();
                        let status = match self.version {
                            FmiVersion::V2 => {
                                type Get = unsafe extern "C" fn(Handle, *const u32, usize, *mut $number) -> Status;
                                // SAFETY: one reference, one place
                                unsafe { self.find::<Get>(&name)?(c.0, &raw const reference, 1, &raw mut value) }
                            }
                            FmiVersion::V3 => {
                                type Get = unsafe extern "C" fn(Handle, *const u32, usize, *mut $number, usize) -> Status;
                                // SAFETY: one reference, one place
                                unsafe { self.find::<Get>(&name)?(c.0, &raw const reference, 1, &raw mut value, 1) }
                            }
                        };
                        Self::check(&name, status).map(|()| value as f64)
                    })*
                    NumberKind::Boolean => self.get_truth(c, reference, &name),
                }
            };
        }
        get!(Float64: f64, Float32: f32, Int8: i8, UInt8: u8, Int16: i16, UInt16: u16, Int32: i32, UInt32: u32, Int64: i64, UInt64: u64)
    }

    fn get_truth(&self, c: Component, reference: u32, name: &str) -> Result<f64, String> {
        let (mut wide, mut narrow) = (0_i32, 0_u8);
        let status = match self.version {
            FmiVersion::V2 => {
                type Get = unsafe extern "C" fn(Handle, *const u32, usize, *mut i32) -> Status;
                // SAFETY: one reference, one place
                unsafe { self.find::<Get>(name)?(c.0, &raw const reference, 1, &raw mut wide) }
            }
            FmiVersion::V3 => {
                type Get = unsafe extern "C" fn(Handle, *const u32, usize, *mut u8, usize) -> Status;
                // SAFETY: one reference, one place of the size of a truth value
                unsafe { self.find::<Get>(name)?(c.0, &raw const reference, 1, &raw mut narrow, 1) }
            }
        };
        Self::check(name, status).map(|()| f64::from(u8::from(wide != 0 || narrow != 0)))
    }

    /// Sets one number that is not of the type Float64: rounded, and cut off at the bounds of its type.
    pub(super) fn set_number(&self, c: Component, kind: NumberKind, reference: u32, x: f64) -> Result<(), String> {
        let name = self.name_of(kind, "Set");
        macro_rules! set {
            ($($kind:ident: $number:ty = $value:expr),*) => {
                match kind {
                    $(NumberKind::$kind => {
                        let value: $number = $value;
                        let status = match self.version {
                            FmiVersion::V2 => {
                                type Set = unsafe extern "C" fn(Handle, *const u32, usize, *const $number) -> Status;
                                // SAFETY: one reference, one value
                                unsafe { self.find::<Set>(&name)?(c.0, &raw const reference, 1, &raw const value) }
                            }
                            FmiVersion::V3 => {
                                type Set = unsafe extern "C" fn(Handle, *const u32, usize, *const $number, usize) -> Status;
                                // SAFETY: one reference, one value
                                unsafe { self.find::<Set>(&name)?(c.0, &raw const reference, 1, &raw const value, 1) }
                            }
                        };
                        Self::check(&name, status)
                    })*
                    NumberKind::Boolean => self.set_truth(c, reference, x != 0.0, &name),
                }
            };
        }
        let r = x.round();
        set!(Float64: f64 = x, Float32: f32 = x as f32, Int8: i8 = r as i8, UInt8: u8 = r as u8, Int16: i16 = r as i16,
            UInt16: u16 = r as u16, Int32: i32 = r as i32, UInt32: u32 = r as u32, Int64: i64 = r as i64, UInt64: u64 = r as u64)
    }

    fn set_truth(&self, c: Component, reference: u32, truth: bool, name: &str) -> Result<(), String> {
        let (wide, narrow) = (i32::from(truth), u8::from(truth));
        let status = match self.version {
            FmiVersion::V2 => {
                type Set = unsafe extern "C" fn(Handle, *const u32, usize, *const i32) -> Status;
                // SAFETY: one reference, one value
                unsafe { self.find::<Set>(name)?(c.0, &raw const reference, 1, &raw const wide) }
            }
            FmiVersion::V3 => {
                type Set = unsafe extern "C" fn(Handle, *const u32, usize, *const u8, usize) -> Status;
                // SAFETY: one reference, one value of the size of a truth value
                unsafe { self.find::<Set>(name)?(c.0, &raw const reference, 1, &raw const narrow, 1) }
            }
        };
        Self::check(name, status)
    }

    /// Name of the function for a type, without its prefix.
    fn name_of(&self, kind: NumberKind, verb: &str) -> String {
        match (self.version, kind) {
            (_, NumberKind::Boolean) => format!("{verb}Boolean"),
            (FmiVersion::V2, NumberKind::Float64 | NumberKind::Float32) => format!("{verb}Real"),
            (FmiVersion::V2, _) => format!("{verb}Integer"),
            (FmiVersion::V3, kind) => format!("{verb}{kind:?}"),
        }
    }

    /// Makes a communication step; false if the FMU ended the simulation.
    pub(super) fn step(&self, c: Component, t: f64, h: f64) -> Result<bool, String> {
        const NAME: &str = "DoStep";
        match self.version {
            FmiVersion::V2 => {
                type Step = unsafe extern "C" fn(Handle, f64, f64, i32) -> Status;
                // SAFETY: a live instance
                Self::check(NAME, unsafe { self.find::<Step>(NAME)?(c.0, t, h, 0) }).map(|()| true)
            }
            FmiVersion::V3 => {
                type Step =
                    unsafe extern "C" fn(Handle, f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64) -> Status;
                let (mut event, mut ends, mut early, mut last) = (false, false, false, 0.0);
                let step = self.find::<Step>(NAME)?;
                // SAFETY: a live instance, places for the results
                let status =
                    unsafe { step(c.0, t, h, false, &raw mut event, &raw mut ends, &raw mut early, &raw mut last) };
                Self::check(NAME, status).map(|()| !ends)
            }
        }
    }

    pub(super) fn save(&self, c: Component) -> Result<SavedState, String> {
        let name = if self.version == FmiVersion::V2 { "GetFMUstate" } else { "GetFMUState" };
        let mut state = std::ptr::null_mut();
        let function = self.find::<unsafe extern "C" fn(Handle, *mut Handle) -> Status>(name)?;
        // SAFETY: a live instance, a place for the state
        Self::check(name, unsafe { function(c.0, &raw mut state) }).map(|()| SavedState(state))
    }

    pub(super) fn restore(&self, c: Component, state: SavedState) -> Result<(), String> {
        let name = if self.version == FmiVersion::V2 { "SetFMUstate" } else { "SetFMUState" };
        let function = self.find::<unsafe extern "C" fn(Handle, Handle) -> Status>(name)?;
        // SAFETY: a live instance and a state of it
        Self::check(name, unsafe { function(c.0, state.0) })
    }

    pub(super) fn free_state(&self, c: Component, state: SavedState) {
        let name = if self.version == FmiVersion::V2 { "FreeFMUstate" } else { "FreeFMUState" };
        let mut state = state.0;
        if let Ok(function) = self.find::<unsafe extern "C" fn(Handle, *mut Handle) -> Status>(name) {
            // SAFETY: a live instance and a state of it, which its owner gives up
            unsafe { function(c.0, &raw mut state) };
        }
    }
}
