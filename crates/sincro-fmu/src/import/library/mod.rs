//! Functions of a foreign FMU's library.
//!
//! The one module of this crate that calls foreign code.

// foreign functions are called through pointers
#![allow(unsafe_code)]

mod clocks;
mod events;
mod exchange;
mod state;
mod values;

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_void};
use std::path::Path;

use libloading::Library;
use sincro_scene::fmu::FmuInterface;

use crate::description::FmiVersion;
pub(super) use state::SavedState;

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

thread_local! {
    /// Last error that an FMU has logged in this thread.
    static LOGGED: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Longest message of an FMU that is kept `[bytes]`.
const MAX_MESSAGE: usize = 1000;

fn keep(status: Status, message: *const c_char) {
    if status < 2 || message.is_null() {
        return;
    }
    // SAFETY: the standard promises a text that ends with a zero
    let text = unsafe { CStr::from_ptr(message) }.to_string_lossy();
    let text: String = text.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).take(MAX_MESSAGE).collect();
    LOGGED.with(|logged| *logged.borrow_mut() = text);
}

/// Logger of FMI 2.0. The message is a format whose arguments Rust cannot take.
extern "C" fn log2(_: *mut c_void, _: *const c_char, status: Status, _: *const c_char, message: *const c_char) {
    keep(status, message);
}

extern "C" fn log3(_: *mut c_void, status: Status, _: *const c_char, message: *const c_char) {
    keep(status, message);
}

static CALLBACKS: Callbacks = Callbacks {
    logger: log2 as *const c_void,
    allocate: calloc,
    free,
    step_finished: std::ptr::null(),
    environment: std::ptr::null_mut(),
};

/// Callback of scheduled execution that has nothing to do: partitions run one after the other, in one thread.
extern "C" fn nothing() {}
extern "C" fn clock_update(_: *mut c_void) {}

/// The functions of an FMU.
#[derive(Debug)]
pub(super) struct Functions {
    version: FmiVersion,
    library: Library,
}

/// An instance in a library; a pointer of the library's own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Component(Handle);

// SAFETY: the standard allows an instance to be called from any thread, one at a time; its owner gives it to one
unsafe impl Send for Component {}

const REQUIRED: [&str; 6] =
    ["EnterInitializationMode", "ExitInitializationMode", "FreeInstance", "Terminate", "GetVersion", "Reset"];

impl Functions {
    /// Loads a library and looks for its functions.
    pub(super) fn load(path: &Path, version: FmiVersion) -> Result<Self, String> {
        // SAFETY: initializers of the library run; the user named the FMU
        let library = unsafe { Library::new(path) }
            .map_err(|error| format!("the library of the FMU cannot be loaded: {error}"))?;
        let new = Self { version, library };
        let own: &[&str] = match version {
            FmiVersion::V2 => &["Instantiate", "SetupExperiment", "GetReal", "SetReal"],
            FmiVersion::V3 => &["GetFloat64", "SetFloat64"],
        };
        for name in REQUIRED.iter().chain(own) {
            new.find::<unsafe extern "C" fn()>(name)?;
        }
        Ok(new)
    }

    /// Function of the standard by its name without prefix; `T` is its type, a function pointer. It lives as long as
    /// the library.
    fn find<T: Copy>(&self, name: &str) -> Result<T, String> {
        let address = self.address(name)?;
        debug_assert_eq!(size_of::<T>(), size_of::<unsafe extern "C" fn()>(), "a function pointer");
        // SAFETY: the types given by the callers in this module are those of the standard
        Ok(unsafe { std::mem::transmute_copy::<unsafe extern "C" fn(), T>(&address) })
    }

    /// Looks a function up; one instance for all types, of which there are a hundred.
    fn address(&self, name: &str) -> Result<unsafe extern "C" fn(), String> {
        let prefix = if self.version == FmiVersion::V2 { "fmi2" } else { "fmi3" };
        // SAFETY: the function is called with its own type only, see `find`
        let found = unsafe { self.library.get::<unsafe extern "C" fn()>(format!("{prefix}{name}").as_bytes()) };
        found.map(|symbol| *symbol).map_err(|_| format!("the library of the FMU has no function {prefix}{name}"))
    }

    fn check(name: &str, status: Status) -> Result<(), String> {
        let logged = LOGGED.take();
        match status {
            0 | 1 => Ok(()),
            _ if logged.is_empty() => Err(format!("{name} of the FMU failed with status {status}")),
            _ => Err(format!("{name} of the FMU failed with status {status}: {logged}")),
        }
    }

    /// Makes an instance; `has_event_mode` for co-simulation whose clocks the importer activates.
    pub(super) fn instantiate(
        &self,
        (interface, has_event_mode): (FmuInterface, bool),
        (name, token, resources): (&str, &str, &str),
    ) -> Result<Component, String> {
        let of_c = |text: &str| CString::new(text).map_err(|_| "a text of the FMU has a zero in it".to_owned());
        let (name, token, resources) = (of_c(name)?, of_c(token)?, of_c(resources)?);
        let texts = [name.as_ptr(), token.as_ptr(), resources.as_ptr()];
        let handle = match self.version {
            FmiVersion::V2 => self.instantiate2(interface, texts)?,
            FmiVersion::V3 => self.instantiate3(interface, has_event_mode, texts)?,
        };
        let logged = LOGGED.take();
        match handle.is_null() {
            false => Ok(Component(handle)),
            true if logged.is_empty() => Err("the FMU refused to be instantiated".into()),
            true => Err(format!("the FMU refused to be instantiated: {logged}")),
        }
    }

    fn instantiate2(&self, interface: FmuInterface, [n, t, r]: [*const c_char; 3]) -> Result<Handle, String> {
        type Text = *const c_char;
        type Instantiate = unsafe extern "C" fn(Text, i32, Text, Text, *const Callbacks, i32, i32) -> Handle;
        let function = self.find::<Instantiate>("Instantiate")?;
        let kind = i32::from(interface == FmuInterface::CoSimulation);
        // SAFETY: texts and functions outlive the call; the functions outlive the instance
        Ok(unsafe { function(n, kind, t, r, &raw const CALLBACKS, 0, 0) })
    }

    fn instantiate3(
        &self,
        interface: FmuInterface,
        has_event_mode: bool,
        [n, t, r]: [*const c_char; 3],
    ) -> Result<Handle, String> {
        type Text = *const c_char;
        type Log = extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);
        type Nothing = extern "C" fn();
        let (none, no_data): (Handle, *const c_void) = (std::ptr::null_mut(), std::ptr::null());
        // SAFETY, for all three: texts outlive the call, functions the instance
        match interface {
            FmuInterface::CoSimulation => {
                type Instantiate = unsafe extern "C" fn(
                    Text,
                    Text,
                    Text,
                    bool,
                    bool,
                    bool,
                    bool,
                    *const u32,
                    usize,
                    Handle,
                    Log,
                    *const c_void,
                ) -> Handle;
                let function = self.find::<Instantiate>("InstantiateCoSimulation")?;
                let (events, early) = (has_event_mode, has_event_mode);
                Ok(unsafe { function(n, t, r, false, false, events, early, no_data.cast(), 0, none, log3, no_data) })
            }
            FmuInterface::ModelExchange => {
                type Instantiate = unsafe extern "C" fn(Text, Text, Text, bool, bool, Handle, Log) -> Handle;
                let function = self.find::<Instantiate>("InstantiateModelExchange")?;
                Ok(unsafe { function(n, t, r, false, false, none, log3) })
            }
            FmuInterface::ScheduledExecution => {
                type Update = extern "C" fn(*mut c_void);
                type Instantiate =
                    unsafe extern "C" fn(Text, Text, Text, bool, bool, Handle, Log, Update, Nothing, Nothing) -> Handle;
                let function = self.find::<Instantiate>("InstantiateScheduledExecution")?;
                Ok(unsafe { function(n, t, r, false, false, none, log3, clock_update, nothing, nothing) })
            }
        }
    }

    pub(super) fn enter_initialization(&self, c: Component, start: f64) -> Result<(), String> {
        const NAME: &str = "EnterInitializationMode";
        let status = match self.version {
            FmiVersion::V2 => {
                // SAFETY: a live instance
                unsafe { self.find::<unsafe extern "C" fn(Handle) -> Status>(NAME)?(c.0) }
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

    /// Announces the start time `[s]`, which FMI 2.0 wants to know first.
    pub(super) fn set_up(&self, c: Component, start: f64) -> Result<(), String> {
        if self.version == FmiVersion::V3 {
            return Ok(());
        }
        type Setup = unsafe extern "C" fn(Handle, i32, f64, f64, i32, f64) -> Status;
        let setup = self.find::<Setup>("SetupExperiment")?;
        // SAFETY: a live instance
        Self::check("SetupExperiment", unsafe { setup(c.0, 0, 0.0, start, 0, 0.0) })
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

    /// Makes a communication step.
    pub(super) fn step(&self, c: Component, t: f64, h: f64) -> Result<Stepped, String> {
        const NAME: &str = "DoStep";
        match self.version {
            FmiVersion::V2 => {
                type Step = unsafe extern "C" fn(Handle, f64, f64, i32) -> Status;
                // SAFETY: a live instance
                Self::check(NAME, unsafe { self.find::<Step>(NAME)?(c.0, t, h, 0) })?;
                Ok(Stepped { reached: None, has_event: false, ends: false })
            }
            FmiVersion::V3 => {
                type Step =
                    unsafe extern "C" fn(Handle, f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64) -> Status;
                // bytes, because a library could leave something else than a truth value in a `bool`
                let (mut event, mut ends, mut early, mut last) = (0_u8, 0_u8, 0_u8, t + h);
                let step = self.find::<Step>(NAME)?;
                let places = ((&raw mut event).cast(), (&raw mut ends).cast(), (&raw mut early).cast());
                // SAFETY: a live instance, places for the results
                let status = unsafe { step(c.0, t, h, false, places.0, places.1, places.2, &raw mut last) };
                Self::check(NAME, status)?;
                Ok(Stepped { reached: (early != 0).then_some(last), has_event: event != 0, ends: ends != 0 })
            }
        }
    }
}

/// Result of a communication step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stepped {
    /// Time reached `[s]`, if it is before the end of the step.
    pub reached: Option<f64>,
    /// True if an event is to be handled.
    pub has_event: bool,
    /// True if the FMU ended the simulation.
    pub ends: bool,
}
