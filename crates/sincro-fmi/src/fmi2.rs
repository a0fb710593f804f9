//! The functions of FMI 2.0 (key `fmi-2`), in the order of its header.
//!
//! # Safety
//!
//! The importer gives pointers as the standard says: null, or to what the function names. Null is an error of the call.

#![allow(clippy::missing_safety_doc, missing_docs)]

use std::ffi::{CString, c_char, c_void};

use crate::component::{Component, Kind, Mode};
use crate::log::{Function, Logger, Logger2, Message, Status};
use crate::pointers::{path_of_uri, slice, slice_mut, text, write};
use crate::registry::{add, guarded, remove, with};

type Handle = *mut c_void;
type State = *mut c_void;

/// Functions of the importer. Memory is not allocated through it.
#[repr(C)]
pub struct Callbacks {
    logger: Option<Logger2>,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// Result of an iteration of events.
#[repr(C)]
pub struct EventInfo {
    new_discrete_states_needed: i32,
    terminate_simulation: i32,
    nominals_changed: i32,
    values_changed: i32,
    next_event_time_defined: i32,
    next_event_time: f64,
}

fn status(result: Result<(), Status>) -> Status {
    result.err().unwrap_or(Status::Ok)
}

const NULL: &str = "a pointer is null or not aligned";

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: Handle,
    is_on: i32,
    n: usize,
    categories: *const *const c_char,
) -> Status {
    with(c, |component| {
        // SAFETY: the importer's promise
        let names = unsafe { slice(categories, n) };
        let Some(names) = names else { return component.refuse(format!("fmi2SetDebugLogging: {NULL}")) };
        // SAFETY: the importer's promise
        let names = names.iter().filter_map(|name| unsafe { text(*name) }).map(|name| name.into_owned()).collect();
        component.set_debug_logging(is_on != 0, names)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: i32,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: i32,
    is_logging: i32,
) -> Handle {
    let made = guarded(|| {
        // SAFETY: the importer's promise
        let callbacks = unsafe { slice(callbacks, 1) }.map(|all| &all[0]);
        // SAFETY: the importer's promise
        let (name, guid, resources) = unsafe { (text(name), text(guid), text(resources)) };
        let logger = Logger {
            function: callbacks.and_then(|c| c.logger).map_or(Function::None, Function::V2),
            environment: callbacks.map_or(std::ptr::null_mut(), |c| c.environment),
            instance: CString::new(name.as_deref().unwrap_or("").replace('\0', " ")).unwrap_or_default(),
            is_on: is_logging != 0,
            categories: Vec::new(),
        };
        let made = match (kind, guid, resources) {
            (0 | 1, Some(guid), Some(resources)) if name.is_some() && callbacks.is_some() => {
                let kind = if kind == 1 { Kind::CoSimulation } else { Kind::ModelExchange };
                path_of_uri(&resources).and_then(|path| Component::new(kind, &guid, &path, logger.clone()))
            }
            _ => Err("the name, the GUID, the resources or the functions of the importer are missing".to_owned()),
        };
        made.map_err(|why| logger.send(&Message::error(format!("fmi2Instantiate: {why}")))).ok()
    });
    made.map_or(std::ptr::null_mut(), add)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(c: Handle) {
    remove(c);
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    c: Handle,
    _tolerance_defined: i32,
    _tolerance: f64,
    start: f64,
    _stop_defined: i32,
    _stop: f64,
) -> Status {
    with(c, |component| status(component.set_start(start, "fmi2SetupExperiment")))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(c: Handle) -> Status {
    with(c, |component| status(component.enter_initialization("fmi2EnterInitializationMode")))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(c: Handle) -> Status {
    with(c, |component| status(component.exit_initialization("fmi2ExitInitializationMode")))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(c: Handle) -> Status {
    with(c, |component| status(component.terminate("fmi2Terminate")))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(c: Handle) -> Status {
    with(c, |component| status(component.reset("fmi2Reset")))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(c: Handle, references: *const u32, n: usize, values: *mut f64) -> Status {
    with(c, |component| {
        // SAFETY: the importer's promise
        match unsafe { (slice(references, n), slice_mut(values, n)) } {
            (Some(references), Some(values)) => component.get(references, values, "fmi2GetReal"),
            _ => component.refuse(format!("fmi2GetReal: {NULL}")),
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(c: Handle, references: *const u32, n: usize, values: *const f64) -> Status {
    with(c, |component| {
        // SAFETY: the importer's promise
        match unsafe { (slice(references, n), slice(values, n)) } {
            (Some(references), Some(values)) => component.set(references, values, "fmi2SetReal"),
            _ => component.refuse(format!("fmi2SetReal: {NULL}")),
        }
    })
}

/// Functions for types that no variable has: they succeed for no variables.
macro_rules! without_variables {
    ($($name:ident: $value:ty),* $(,)?) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: Handle, _: *const u32, n: usize, _: $value) -> Status {
            with(c, |component| {
                if n == 0 { return Status::Ok }
                component.refuse(concat!(stringify!($name), ": all variables are real numbers"))
            })
        }
    )*};
}

without_variables! {
    fmi2GetInteger: *mut i32,
    fmi2GetBoolean: *mut i32,
    fmi2GetString: *mut *const c_char,
    fmi2SetInteger: *const i32,
    fmi2SetBoolean: *const i32,
    fmi2SetString: *const *const c_char,
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: Handle, state: *mut State) -> Status {
    const NAME: &str = "fmi2GetFMUstate";
    with(c, |component| {
        // SAFETY: the importer's promise
        let Some([place]) = (unsafe { slice_mut(state, 1) }) else {
            return component.refuse(format!("{NAME}: {NULL}"));
        };
        status(component.save(*place as usize, NAME).map(|number| *place = number as State))
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(c: Handle, state: State) -> Status {
    with(c, |component| component.restore(state as usize, "fmi2SetFMUstate"))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: Handle, state: *mut State) -> Status {
    const NAME: &str = "fmi2FreeFMUstate";
    with(c, |component| {
        // SAFETY: the importer's promise
        let Some([place]) = (unsafe { slice_mut(state, 1) }) else {
            return component.refuse(format!("{NAME}: {NULL}"));
        };
        if place.is_null() {
            return Status::Ok;
        }
        let freed = component.free_state(*place as usize, NAME);
        *place = std::ptr::null_mut();
        freed
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(c: Handle, state: State, size: *mut usize) -> Status {
    const NAME: &str = "fmi2SerializedFMUstateSize";
    with(c, |component| {
        let n = match component.bytes(state as usize, NAME) {
            Ok(bytes) => bytes.len(),
            Err(status) => return status,
        };
        // SAFETY: the importer's promise
        if unsafe { write(size, n) } { Status::Ok } else { component.refuse(format!("{NAME}: {NULL}")) }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(c: Handle, state: State, bytes: *mut u8, size: usize) -> Status {
    with(c, |component| unsafe { serialize(component, state, bytes, size, "fmi2SerializeFMUstate") })
}

/// Copies a saved state to the importer's memory.
pub(crate) unsafe fn serialize(
    component: &mut Component,
    state: State,
    bytes: *mut u8,
    size: usize,
    name: &str,
) -> Status {
    let own = match component.bytes(state as usize, name) {
        Ok(own) => own,
        Err(status) => return status,
    };
    // SAFETY: the importer's promise
    match unsafe { slice_mut(bytes, size) } {
        Some(place) if place.len() >= own.len() => {
            place[..own.len()].copy_from_slice(own);
            Status::Ok
        }
        _ => component.refuse(format!("{name}: there is no room for the state")),
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: Handle,
    bytes: *const u8,
    size: usize,
    state: *mut State,
) -> Status {
    with(c, |component| unsafe { deserialize(component, bytes, size, state, "fmi2DeSerializeFMUstate") })
}

/// Reads a saved state from the importer's memory.
pub(crate) unsafe fn deserialize(
    component: &mut Component,
    bytes: *const u8,
    size: usize,
    state: *mut State,
    name: &str,
) -> Status {
    // SAFETY: the importer's promise
    let (bytes, place) = unsafe { (slice(bytes, size), slice_mut(state, 1)) };
    let (Some(bytes), Some([place])) = (bytes, place) else { return component.refuse(format!("{name}: {NULL}")) };
    status(component.state_of_bytes(bytes, name).map(|number| *place = number as State))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: Handle,
    unknowns: *const u32,
    n_unknowns: usize,
    knowns: *const u32,
    n_knowns: usize,
    seed: *const f64,
    sensitivity: *mut f64,
) -> Status {
    const NAME: &str = "fmi2GetDirectionalDerivative";
    with(c, |component| {
        // SAFETY: the importer's promise
        let all = unsafe {
            (
                slice(unknowns, n_unknowns),
                slice(knowns, n_knowns),
                slice(seed, n_knowns),
                slice_mut(sensitivity, n_unknowns),
            )
        };
        match all {
            (Some(unknowns), Some(knowns), Some(seed), Some(sensitivity)) => {
                component.directional_derivative(unknowns, knowns, seed, sensitivity, NAME)
            }
            _ => component.refuse(format!("{NAME}: {NULL}")),
        }
    })
}

// ---- model exchange

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterEventMode(c: Handle) -> Status {
    with(c, |component| status(component.enter_event_mode("fmi2EnterEventMode")))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2NewDiscreteStates(c: Handle, info: *mut EventInfo) -> Status {
    const NAME: &str = "fmi2NewDiscreteStates";
    with(c, |component| {
        let next = match component.update_discrete_states(NAME) {
            Ok(next) => next,
            Err(status) => return status,
        };
        let event = EventInfo {
            new_discrete_states_needed: 0,
            terminate_simulation: 0,
            nominals_changed: 0,
            values_changed: 0,
            next_event_time_defined: i32::from(next.is_some()),
            next_event_time: next.unwrap_or(0.0),
        };
        // SAFETY: the importer's promise
        if unsafe { write(info, event) } { Status::Ok } else { component.refuse(format!("{NAME}: {NULL}")) }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterContinuousTimeMode(c: Handle) -> Status {
    with(c, |component| status(component.enter_continuous_time_mode("fmi2EnterContinuousTimeMode")))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
    c: Handle,
    _no_set_state: i32,
    enter_event_mode: *mut i32,
    terminate: *mut i32,
) -> Status {
    const NAME: &str = "fmi2CompletedIntegratorStep";
    with(c, |component| {
        if let Err(status) = component.require(NAME, &[Mode::ContinuousTime]) {
            return status;
        }
        // SAFETY: the importer's promise
        let written = unsafe { write(enter_event_mode, 0) && write(terminate, 0) };
        if written { Status::Ok } else { component.refuse(format!("{NAME}: {NULL}")) }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetTime(c: Handle, time: f64) -> Status {
    with(c, |component| status(component.set_time(time, "fmi2SetTime")))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetContinuousStates(c: Handle, x: *const f64, n: usize) -> Status {
    const NAME: &str = "fmi2SetContinuousStates";
    // SAFETY: the importer's promise
    with(c, |component| match unsafe { slice(x, n) } {
        Some(x) => status(component.set_continuous_states(x, NAME)),
        None => component.refuse(format!("{NAME}: {NULL}")),
    })
}

/// Functions that write a vector of continuous states.
macro_rules! vectors {
    ($($name:ident => $method:ident),* $(,)?) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(c: Handle, out: *mut f64, n: usize) -> Status {
            // SAFETY: the importer's promise
            with(c, |component| match unsafe { slice_mut(out, n) } {
                Some(out) => status(component.$method(out, stringify!($name))),
                None => component.refuse(concat!(stringify!($name), ": a pointer is null or not aligned")),
            })
        }
    )*};
}
pub(crate) use vectors;

vectors! {
    fmi2GetDerivatives => derivatives,
    fmi2GetEventIndicators => event_indicators,
    fmi2GetContinuousStates => continuous_states,
    fmi2GetNominalsOfContinuousStates => nominals,
}

// ---- co-simulation

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetRealInputDerivatives(
    c: Handle,
    _: *const u32,
    n: usize,
    _: *const i32,
    _: *const f64,
) -> Status {
    with(c, |component| {
        if n == 0 { Status::Ok } else { component.refuse("fmi2SetRealInputDerivatives: inputs are held over a step") }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetRealOutputDerivatives(
    c: Handle,
    _: *const u32,
    n: usize,
    _: *const i32,
    _: *mut f64,
) -> Status {
    with(c, |component| {
        if n == 0 { Status::Ok } else { component.refuse("fmi2GetRealOutputDerivatives: outputs have no derivatives") }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(c: Handle, time: f64, span: f64, _no_set_state: i32) -> Status {
    with(c, |component| match component.begin_step(time, span, "fmi2DoStep").and_then(|n| component.advance(n)) {
        Ok(true) => Status::Ok,
        Ok(false) => Status::Discard,
        Err(status) => status,
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(c: Handle) -> Status {
    with(c, |component| component.refuse("fmi2CancelStep: steps are not asynchronous"))
}

/// Kind of status: the time of the last good instant, and the end of the simulation.
const LAST_SUCCESSFUL_TIME: i32 = 2;
const TERMINATED: i32 = 3;

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(c: Handle, _: i32, _: *mut Status) -> Status {
    with(c, |component| component.refuse("fmi2GetStatus: steps are not asynchronous"))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: Handle, kind: i32, value: *mut f64) -> Status {
    with(c, |component| {
        if kind != LAST_SUCCESSFUL_TIME {
            return component.refuse(format!("fmi2GetRealStatus: there is no status {kind}"));
        }
        let time = component.instance.time();
        // SAFETY: the importer's promise
        if unsafe { write(value, time) } { Status::Ok } else { component.refuse(format!("fmi2GetRealStatus: {NULL}")) }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(c: Handle, _: i32, _: *mut i32) -> Status {
    with(c, |component| component.refuse("fmi2GetIntegerStatus: there is no such status"))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(c: Handle, kind: i32, value: *mut i32) -> Status {
    with(c, |component| {
        if kind != TERMINATED {
            return component.refuse(format!("fmi2GetBooleanStatus: there is no status {kind}"));
        }
        let has_ended = i32::from(component.ended.is_some());
        // SAFETY: the importer's promise
        let written = unsafe { write(value, has_ended) };
        if written { Status::Ok } else { component.refuse(format!("fmi2GetBooleanStatus: {NULL}")) }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(c: Handle, _: i32, _: *mut *const c_char) -> Status {
    with(c, |component| component.refuse("fmi2GetStringStatus: there is no such status"))
}
