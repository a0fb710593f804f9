//! Scripts that call those below them, as in V-REP 3.
//!
//! | | V-REP up to 3.1.2 | from 3.1.3 on |
//! |---|---|---|
//! | called by | `simHandleChildScript(sim_handle_all, …)` of the script above | the step, or `simHandleChildScripts(type, …)` of the script above if that has switched off `automaticcascadingcalls` |
//! | one script | `simHandleChildScript(handle, …)`, with its results; nil for a thread, which the step resumes | – |
//! | result for several | their number | their number |
//!
//! The scripts that are met first on the ways down are called, with the arguments (`...` of an old script, arguments of
//! `sysCall_actuation` and `sysCall_sensing`); then, with the same arguments, those below each of them, unless it calls
//! these itself. Threads are left out: the step resumes them.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use mlua::{Error, Function, Lua, MultiValue, Value as LuaValue};
use sincro_scene::script::Style;

use super::callbacks::pass;
use super::scripts::{place_of, unknown};
use super::{ApiContext, object_of_name, refused};
use crate::machine::{CALL_TYPES, TEXT};
use crate::shared::Shared;

/// Scripts that may be calling each other down the tree at once.
const MAX_DEPTH: usize = 16;

/// `sim.handle_all`.
const ALL: i64 = -2;
/// `sim.handle_all_except_explicit`.
const ALL_EXCEPT_EXPLICIT: i64 = -3;

pub(super) fn offer(context: &ApiContext<'_>) -> mlua::Result<()> {
    let (shared, index) = (context.shared.clone(), context.index);
    context.add("handleChildScripts", move |lua, (call_type, arguments): (i64, MultiValue)| {
        let fail = |message: &str| Error::RuntimeError(format!("{message} (in function 'sim.handleChildScripts')"));
        let cascade = shared.cascade(index);
        if cascade.is_thread {
            return Err(fail("a thread calls no scripts: the step calls those below it"));
        }
        if cascade.is_automatic {
            shared.say(
                index,
                "sim.handleChildScripts calls nothing: the step calls the scripts below, as long as \
                 sim.childscriptattribute_automaticcascadingcalls is set"
                    .to_owned(),
            );
            return Ok(-1);
        }
        if !is_call_type(call_type, "actuation") && !is_call_type(call_type, "sensing") {
            return Err(fail("scripts are called for actuation and sensing: the others are called by the simulation"));
        }
        call_below(lua, &shared, index, (call_type, false), &arguments).map(|n| n as i64)
    })?;
    let (shared, index, own) = (context.shared.clone(), context.index, context.own);
    context.add("handleChildScript", move |lua, (which, arguments): (LuaValue, MultiValue)| {
        let handle = match &which {
            LuaValue::String(name) => {
                let object = shared.with_sim(own, |sim| object_of_name(sim, own, &name.to_string_lossy()));
                i64::from(object.map_err(|error| refused("handleChildScript", &error))?.0)
            }
            other => other.as_integer().ok_or_else(|| {
                let what = other.type_name();
                Error::RuntimeError(format!(
                    "argument 1 is a {what}, expected a handle (in function 'sim.handleChildScript')"
                ))
            })?,
        };
        let call_type = present_call_type(lua)?;
        if handle == ALL || handle == ALL_EXCEPT_EXPLICIT {
            let n = call_below(lua, &shared, index, (call_type, handle == ALL_EXCEPT_EXPLICIT), &arguments)?;
            return Ok(MultiValue::from_iter([LuaValue::Integer(n as i64)]));
        }
        let place = place_of(&shared, index, handle).ok_or_else(|| unknown(handle, "handleChildScript"))?;
        shared.change_cascade(place, |cascade| cascade.is_explicit = true);
        if shared.cascade(place).is_thread {
            return Ok(MultiValue::from_iter([LuaValue::Nil]));
        }
        let results = call(lua, &shared, place, call_type, &arguments)?;
        if shared.cascade(place).is_automatic {
            call_below(lua, &shared, place, (call_type, true), &arguments)?;
        }
        // nothing returned is nil
        Ok(if results.is_empty() { MultiValue::from_iter([LuaValue::Nil]) } else { results })
    })
}

fn is_call_type(number: i64, name: &str) -> bool {
    CALL_TYPES.contains(&(name, number))
}

/// Call type of the phase that an old script is called in.
fn present_call_type(lua: &Lua) -> mlua::Result<i64> {
    let actuation = CALL_TYPES.iter().find(|(name, _)| *name == "actuation").map_or(0, |(_, number)| *number);
    Ok(lua.globals().get::<Option<i64>>("sim_call_type")?.unwrap_or(actuation))
}

/// Calls the scripts below one, and those below them; returns the number of the first ones. If `skips_explicit`, those
/// that are called by their handles are left out, with all below them.
fn call_below(
    lua: &Lua,
    shared: &Arc<Shared>,
    place: usize,
    (call_type, skips_explicit): (i64, bool),
    arguments: &MultiValue,
) -> mlua::Result<usize> {
    let mut below = shared.first_below(shared.script(place).object);
    below.retain(|place| !(skips_explicit && shared.cascade(*place).is_explicit));
    for place in &below {
        call(lua, shared, *place, call_type, arguments)?;
        if shared.cascade(*place).is_automatic {
            call_below(lua, shared, *place, (call_type, skips_explicit), arguments)?;
        }
    }
    Ok(below.len())
}

/// Calls one script for a phase; returns its results.
fn call(
    lua: &Lua,
    shared: &Arc<Shared>,
    place: usize,
    call_type: i64,
    arguments: &MultiValue,
) -> mlua::Result<MultiValue> {
    let path = &shared.script(place).path;
    let fail = |message: String| Error::RuntimeError(format!("script of `{path}`: {message}"));
    let Some(other) = shared.state(place) else { return Ok(MultiValue::new()) };
    let function = if shared.cascade(place).style == Style::Old {
        other.globals().set("sim_call_type", call_type)?;
        Some(other.named_registry_value::<Function>(TEXT)?)
    } else {
        let name = if is_call_type(call_type, "sensing") { "sysCall_sensing" } else { "sysCall_actuation" };
        super::callbacks::find(&other, name)
    };
    let Some(function) = function else { return Ok(MultiValue::new()) };
    if shared.depth.fetch_add(1, Ordering::Relaxed) >= MAX_DEPTH {
        shared.depth.fetch_sub(1, Ordering::Relaxed);
        return Err(fail(format!("more than {MAX_DEPTH} scripts call each other")));
    }
    let result = pass(lua, &other, &function, arguments.clone());
    shared.depth.fetch_sub(1, Ordering::Relaxed);
    shared.set_execution_count(place, shared.execution_count(place).saturating_add(1));
    result.map_err(|error| fail(crate::fault::words(&error).0))
}
