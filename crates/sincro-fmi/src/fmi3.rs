//! The functions of FMI 3.0 (key `fmi-3`), in the order of its header.
//!
//! # Safety
//!
//! The importer gives pointers as the standard says: null, or to what the function names. Null is an error of the call.

#![allow(clippy::missing_safety_doc, missing_docs)]

use std::ffi::{CString, c_char, c_void};
use std::path::Path;

use crate::component::{Component, Kind, Mode};
use crate::fmi2::{deserialize, serialize, vectors};
use crate::log::{Function, Logger, Logger3, Message, Status};
use crate::pointers::{slice, slice_mut, text, write};
use crate::registry::{add, guarded, remove, with};

type Handle = *mut c_void;
type State = *mut c_void;

/// Function that the importer wants to have called between the base steps of a communication step.
type IntermediateUpdate = unsafe extern "C" fn(*mut c_void, f64, bool, bool, bool, bool, *mut bool, *mut f64);

fn status(result: Result<(), Status>) -> Status {
    result.err().unwrap_or(Status::Ok)
}

const NULL: &str = "a pointer is null or not aligned";

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    c: Handle,
    is_on: bool,
    n: usize,
    categories: *const *const c_char,
) -> Status {
    with(c, |component| {
        // SAFETY: the importer's promise
        let names = unsafe { slice(categories, n) };
        let Some(names) = names else { return component.refuse(format!("fmi3SetDebugLogging: {NULL}")) };
        // SAFETY: the importer's promise
        let names = names.iter().filter_map(|name| unsafe { text(*name) }).map(|name| name.into_owned()).collect();
        component.set_debug_logging(is_on, names)
    })
}

unsafe fn instantiate(
    kind: Kind,
    (name, token, resources): (*const c_char, *const c_char, *const c_char),
    is_logging: bool,
    (environment, logger): (*mut c_void, Option<Logger3>),
    finish: impl FnOnce(&mut Component),
) -> Handle {
    let made = guarded(|| {
        // SAFETY: the importer's promise
        let (name, token, resources) = unsafe { (text(name), text(token), text(resources)) };
        let logger = Logger {
            function: logger.map_or(Function::None, Function::V3),
            environment,
            instance: CString::new(name.as_deref().unwrap_or("").replace('\0', " ")).unwrap_or_default(),
            is_on: is_logging,
            categories: Vec::new(),
        };
        let made = match (name, token, resources) {
            (Some(_), Some(token), Some(resources)) => {
                Component::new(kind, &token, Path::new(&*resources), logger.clone())
            }
            _ => Err("the name, the token or the path of the resources is missing".to_owned()),
        };
        let mut component = made.map_err(|why| logger.send(&Message::error(format!("instantiation: {why}")))).ok()?;
        finish(&mut component);
        Some(component)
    });
    made.map_or(std::ptr::null_mut(), add)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    is_logging: bool,
    environment: *mut c_void,
    logger: Option<Logger3>,
) -> Handle {
    let texts = (name, token, resources);
    // SAFETY: the importer's promise
    unsafe { instantiate(Kind::ModelExchange, texts, is_logging, (environment, logger), |_| {}) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    is_logging: bool,
    is_event_mode_used: bool,
    is_early_return_allowed: bool,
    _required: *const u32,
    _n_required: usize,
    environment: *mut c_void,
    logger: Option<Logger3>,
    intermediate_update: Option<IntermediateUpdate>,
) -> Handle {
    let texts = (name, token, resources);
    let finish = |component: &mut Component| {
        component.is_event_mode_used = is_event_mode_used;
        component.is_early_return_allowed = is_early_return_allowed;
        component.intermediate_update = intermediate_update.map(|function| function as usize);
    };
    // SAFETY: the importer's promise
    unsafe { instantiate(Kind::CoSimulation, texts, is_logging, (environment, logger), finish) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _is_logging: bool,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> Handle {
    if let Some(function) = logger {
        let logger = Logger {
            function: Function::V3(function),
            environment,
            instance: CString::default(),
            is_on: false,
            categories: Vec::new(),
        };
        logger.send(&Message::error("this FMU has no scheduled execution"));
    }
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(c: Handle) {
    remove(c);
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    c: Handle,
    _tolerance_defined: bool,
    _tolerance: f64,
    start: f64,
    _stop_defined: bool,
    _stop: f64,
) -> Status {
    const NAME: &str = "fmi3EnterInitializationMode";
    with(c, |component| status(component.set_start(start, NAME).and_then(|()| component.enter_initialization(NAME))))
}

/// Functions without arguments that change the mode.
macro_rules! modes {
    ($($name:ident => $method:ident),* $(,)?) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: Handle) -> Status {
            with(c, |component| status(component.$method(stringify!($name))))
        }
    )*};
}

modes! {
    fmi3ExitInitializationMode => exit_initialization,
    fmi3EnterEventMode => enter_event_mode,
    fmi3Terminate => terminate,
    fmi3Reset => reset,
    fmi3EnterContinuousTimeMode => enter_continuous_time_mode,
    fmi3EnterStepMode => enter_step_mode,
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    c: Handle,
    references: *const u32,
    n: usize,
    values: *mut f64,
    n_values: usize,
) -> Status {
    const NAME: &str = "fmi3GetFloat64";
    with(c, |component| {
        if n != n_values {
            return component.refuse(format!("{NAME}: {n} variables without dimensions have not {n_values} values"));
        }
        // SAFETY: the importer's promise
        match unsafe { (slice(references, n), slice_mut(values, n)) } {
            (Some(references), Some(values)) => component.get(references, values, NAME),
            _ => component.refuse(format!("{NAME}: {NULL}")),
        }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    c: Handle,
    references: *const u32,
    n: usize,
    values: *const f64,
    n_values: usize,
) -> Status {
    const NAME: &str = "fmi3SetFloat64";
    with(c, |component| {
        if n != n_values {
            return component.refuse(format!("{NAME}: {n} variables without dimensions have not {n_values} values"));
        }
        // SAFETY: the importer's promise
        match unsafe { (slice(references, n), slice(values, n)) } {
            (Some(references), Some(values)) => component.set(references, values, NAME),
            _ => component.refuse(format!("{NAME}: {NULL}")),
        }
    })
}

/// Functions for types that no variable has: they succeed for no variables.
macro_rules! without_variables {
    ($($name:ident($($argument:ty),*)),* $(,)?) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: Handle, _: *const u32, n: usize, $(_: $argument),*) -> Status {
            with(c, |component| {
                if n == 0 { return Status::Ok }
                component.refuse(concat!(stringify!($name), ": all variables are of the type Float64"))
            })
        }
    )*};
}

without_variables! {
    fmi3GetFloat32(*mut f32, usize),
    fmi3GetInt8(*mut i8, usize),
    fmi3GetUInt8(*mut u8, usize),
    fmi3GetInt16(*mut i16, usize),
    fmi3GetUInt16(*mut u16, usize),
    fmi3GetInt32(*mut i32, usize),
    fmi3GetUInt32(*mut u32, usize),
    fmi3GetInt64(*mut i64, usize),
    fmi3GetUInt64(*mut u64, usize),
    fmi3GetBoolean(*mut bool, usize),
    fmi3GetString(*mut *const c_char, usize),
    fmi3GetBinary(*mut usize, *mut *const u8, usize),
    fmi3GetClock(*mut bool),
    fmi3SetFloat32(*const f32, usize),
    fmi3SetInt8(*const i8, usize),
    fmi3SetUInt8(*const u8, usize),
    fmi3SetInt16(*const i16, usize),
    fmi3SetUInt16(*const u16, usize),
    fmi3SetInt32(*const i32, usize),
    fmi3SetUInt32(*const u32, usize),
    fmi3SetInt64(*const i64, usize),
    fmi3SetUInt64(*const u64, usize),
    fmi3SetBoolean(*const bool, usize),
    fmi3SetString(*const *const c_char, usize),
    fmi3SetBinary(*const usize, *const *const u8, usize),
    fmi3SetClock(*const bool),
    fmi3GetIntervalDecimal(*mut f64, *mut i32),
    fmi3GetIntervalFraction(*mut u64, *mut u64, *mut i32),
    fmi3GetShiftDecimal(*mut f64),
    fmi3GetShiftFraction(*mut u64, *mut u64),
    fmi3SetIntervalDecimal(*const f64),
    fmi3SetIntervalFraction(*const u64, *const u64),
    fmi3SetShiftDecimal(*const f64),
    fmi3SetShiftFraction(*const u64, *const u64),
    fmi3GetOutputDerivatives(*const i32, *mut f64, usize),
}

/// Functions that this FMU does not have.
macro_rules! absent {
    ($($name:ident($($argument:ty),*)),* $(,)?) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: Handle, $(_: $argument),*) -> Status {
            with(c, |component| component.refuse(concat!(stringify!($name), ": this FMU does not have it")))
        }
    )*};
}

absent! {
    fmi3GetNumberOfVariableDependencies(u32, *mut usize),
    fmi3GetVariableDependencies(u32, *mut usize, *mut u32, *mut usize, *mut i32, usize),
    fmi3EnterConfigurationMode(),
    fmi3ExitConfigurationMode(),
    fmi3EvaluateDiscreteStates(),
    fmi3ActivateModelPartition(u32, f64),
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(c: Handle, state: *mut State) -> Status {
    // SAFETY: the importer's promise
    unsafe { crate::fmi2::fmi2GetFMUstate(c, state) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(c: Handle, state: State) -> Status {
    with(c, |component| component.restore(state as usize, "fmi3SetFMUState"))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(c: Handle, state: *mut State) -> Status {
    // SAFETY: the importer's promise
    unsafe { crate::fmi2::fmi2FreeFMUstate(c, state) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(c: Handle, state: State, size: *mut usize) -> Status {
    // SAFETY: the importer's promise
    unsafe { crate::fmi2::fmi2SerializedFMUstateSize(c, state, size) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(c: Handle, state: State, bytes: *mut u8, size: usize) -> Status {
    with(c, |component| unsafe { serialize(component, state, bytes, size, "fmi3SerializeFMUState") })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    c: Handle,
    bytes: *const u8,
    size: usize,
    state: *mut State,
) -> Status {
    with(c, |component| unsafe { deserialize(component, bytes, size, state, "fmi3DeserializeFMUState") })
}

/// Functions that give partial derivatives; `is_adjoint`: the seed is one of the unknowns.
macro_rules! derivatives {
    ($($name:ident => $method:ident, $is_adjoint:literal);* $(;)?) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(
            c: Handle,
            unknowns: *const u32,
            n_unknowns: usize,
            knowns: *const u32,
            n_knowns: usize,
            seed: *const f64,
            n_seed: usize,
            sensitivity: *mut f64,
            n_sensitivity: usize,
        ) -> Status {
            with(c, |component| {
                let lengths = if $is_adjoint { (n_unknowns, n_knowns) } else { (n_knowns, n_unknowns) };
                if (n_seed, n_sensitivity) != lengths {
                    return component.refuse(concat!(stringify!($name), ": the lengths do not fit"));
                }
                // SAFETY: the importer's promise
                let all = unsafe {
                    (
                        slice(unknowns, n_unknowns),
                        slice(knowns, n_knowns),
                        slice(seed, n_seed),
                        slice_mut(sensitivity, n_sensitivity),
                    )
                };
                match all {
                    (Some(unknowns), Some(knowns), Some(seed), Some(sensitivity)) => {
                        component.$method(unknowns, knowns, seed, sensitivity, stringify!($name))
                    }
                    _ => component.refuse(concat!(stringify!($name), ": a pointer is null or not aligned")),
                }
            })
        }
    )*};
}

derivatives! {
    fmi3GetDirectionalDerivative => directional_derivative, false;
    fmi3GetAdjointDerivative => adjoint_derivative, true;
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    c: Handle,
    needs_update: *mut bool,
    terminate: *mut bool,
    nominals_changed: *mut bool,
    values_changed: *mut bool,
    next_defined: *mut bool,
    next: *mut f64,
) -> Status {
    const NAME: &str = "fmi3UpdateDiscreteStates";
    with(c, |component| {
        let event = match component.update_discrete_states(NAME) {
            Ok(event) => event,
            Err(status) => return status,
        };
        let terminates = component.ended.is_some();
        // SAFETY: the importer's promise
        let written = unsafe {
            write(needs_update, false)
                && write(terminate, terminates)
                && write(nominals_changed, false)
                && write(values_changed, false)
                && write(next_defined, event.is_some())
                && write(next, event.unwrap_or(0.0))
        };
        if written { Status::Ok } else { component.refuse(format!("{NAME}: {NULL}")) }
    })
}

// ---- model exchange

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3CompletedIntegratorStep(
    c: Handle,
    _no_set_state: bool,
    enter_event_mode: *mut bool,
    terminate: *mut bool,
) -> Status {
    const NAME: &str = "fmi3CompletedIntegratorStep";
    with(c, |component| {
        if let Err(status) = component.require(NAME, &[Mode::ContinuousTime]) {
            return status;
        }
        // SAFETY: the importer's promise
        let written = unsafe { write(enter_event_mode, false) && write(terminate, false) };
        if written { Status::Ok } else { component.refuse(format!("{NAME}: {NULL}")) }
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetTime(c: Handle, time: f64) -> Status {
    with(c, |component| status(component.set_time(time, "fmi3SetTime")))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetContinuousStates(c: Handle, x: *const f64, n: usize) -> Status {
    const NAME: &str = "fmi3SetContinuousStates";
    // SAFETY: the importer's promise
    with(c, |component| match unsafe { slice(x, n) } {
        Some(x) => status(component.set_continuous_states(x, NAME)),
        None => component.refuse(format!("{NAME}: {NULL}")),
    })
}

vectors! {
    fmi3GetContinuousStateDerivatives => derivatives,
    fmi3GetEventIndicators => event_indicators,
    fmi3GetContinuousStates => continuous_states,
    fmi3GetNominalsOfContinuousStates => nominals,
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfEventIndicators(c: Handle, n: *mut usize) -> Status {
    with(c, |component| {
        // SAFETY: the importer's promise
        if unsafe { write(n, 0) } { Status::Ok } else { component.refuse(NULL) }
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfContinuousStates(c: Handle, n: *mut usize) -> Status {
    with(c, |component| {
        let n_states = component.instance.catalogue().n_states;
        // SAFETY: the importer's promise
        if unsafe { write(n, n_states) } { Status::Ok } else { component.refuse(NULL) }
    })
}

// ---- co-simulation

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    c: Handle,
    time: f64,
    span: f64,
    _no_set_state: bool,
    event_handling_needed: *mut bool,
    terminate: *mut bool,
    early_return: *mut bool,
    last_successful_time: *mut f64,
) -> Status {
    const NAME: &str = "fmi3DoStep";
    let (mut n, mut update) = (0, None);
    let begun = with(c, |component| {
        // SAFETY: the importer's promise
        let written = unsafe {
            write(event_handling_needed, false)
                && write(terminate, false)
                && write(early_return, false)
                && write(last_successful_time, component.instance.time())
        };
        if !written {
            return component.refuse(format!("{NAME}: {NULL}"));
        }
        update =
            component.intermediate_update.map(|f| (f, component.logger.environment, component.is_early_return_allowed));
        match component.begin_step(time, span, NAME) {
            Ok(steps) => {
                n = steps;
                Status::Ok
            }
            Err(status) => status,
        }
    });
    if begun != Status::Ok {
        return begun;
    }
    let (mut is_whole, mut is_early) = (true, false);
    // without a function to call in between, all base steps are made at once
    let (rounds, at_once) = if update.is_some() { (n, 1) } else { (1, n) };
    for round in 0..rounds {
        let mut now = 0.0;
        let advanced = with(c, |component| match component.advance(at_once) {
            Ok(whole) => {
                (is_whole, now) = (whole, component.instance.time());
                Status::Ok
            }
            Err(status) => status,
        });
        if advanced != Status::Ok {
            return advanced;
        }
        if !is_whole {
            break;
        }
        if let Some((function, environment, is_allowed)) = update
            && round + 1 < rounds
        {
            // SAFETY: the number is that of the function which the importer gave
            let function: IntermediateUpdate = unsafe { std::mem::transmute::<usize, IntermediateUpdate>(function) };
            let (mut is_requested, mut until) = (false, 0.0);
            // SAFETY: the instance is not locked: the importer may get variables
            unsafe { function(environment, now, false, true, true, is_allowed, &raw mut is_requested, &raw mut until) };
            if is_allowed && is_requested && now >= until {
                is_early = true;
                break;
            }
        }
    }
    with(c, |component| {
        let is_allowed = component.is_early_return_allowed;
        let now = component.instance.time();
        // SAFETY: the importer's promise, as above
        unsafe {
            write(terminate, !is_whole);
            write(early_return, is_early || (!is_whole && is_allowed));
            write(last_successful_time, now);
        }
        if is_whole || is_allowed { Status::Ok } else { Status::Discard }
    })
}
