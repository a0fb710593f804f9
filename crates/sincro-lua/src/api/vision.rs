//! `sim.handleVisionSensor` of one sensor: its script filters the picture at once.

use std::sync::atomic::Ordering;

use mlua::{Error, Function, Lua, MultiValue};
use sincro_coppelia::api::{Handle, functions};

use super::ApiContext;
use super::callbacks::find;
use crate::guard::Guard;
use crate::shared::Shared;
use crate::vision;

/// Scripts that may be handling sensors at once: one may handle that of another.
const MAX_DEPTH: usize = 8;

// `sim.handle_all`, `sim.handle_all_except_explicit`, `sim.handle_self`
const ALL: i64 = -2;
const ALL_EXCEPT_EXPLICIT: i64 = -3;
const SELF: i64 = -4;

/// A whole number, whether Lua has it as one or as a float.
fn whole(value: &mlua::Value) -> Option<i64> {
    value.as_integer().or_else(|| value.as_number().filter(|x| x.fract() == 0.0).map(|x| x as i64))
}

pub(super) fn offer(context: &ApiContext<'_>) -> mlua::Result<()> {
    let handle: Function = context.sim.get("handleVisionSensor")?;
    let read: Function = context.sim.get("readVisionSensor")?;
    let (shared, own) = (context.shared.clone(), context.own);
    context.add("handleVisionSensor", move |lua, arguments: MultiValue| {
        let results: MultiValue = handle.call(arguments.clone())?;
        match arguments.front().and_then(whole).unwrap_or_default() {
            which @ (ALL | ALL_EXCEPT_EXPLICIT) => {
                for sensor in shared.objects().into_iter().filter(|object| vision::is_sensor(&shared, *object)) {
                    if which == ALL || vision::is_handled_by_step(&shared, sensor) {
                        filter(lua, &shared, sensor)?;
                    }
                }
            }
            given => {
                let which = if given == SELF { own } else { Handle(i32::try_from(given).unwrap_or_default()) };
                if which.0 > 0 && filter(lua, &shared, which)? {
                    return read.call(which.0);
                }
            }
        }
        Ok(results)
    })
}

/// Calls `sysCall_vision` of the script on a sensor; whether there is one.
fn filter(lua: &Lua, shared: &Shared, sensor: Handle) -> mlua::Result<bool> {
    let place = shared.script_on(sensor, None);
    let Some(other) = place.and_then(|place| shared.state(place)) else { return Ok(false) };
    let Some(function) = find(&other, "sysCall_vision") else { return Ok(false) };
    if shared.depth.fetch_add(1, Ordering::Relaxed) >= MAX_DEPTH {
        shared.depth.fetch_sub(1, Ordering::Relaxed);
        return Err(Error::RuntimeError(format!(
            "more than {MAX_DEPTH} sensors are handled within each other: sysCall_vision must not handle its own sensor"
        )));
    }
    let run = || vision::filter(&other, shared, sensor, &function);
    let done = match (Guard::of(lua), Guard::of(&other)) {
        (Some(own), Some(others)) if !std::sync::Arc::ptr_eq(&own, &others) => {
            own.charge(lua, 1).and_then(|()| own.lend_time(&others, run))
        }
        _ => run(),
    };
    shared.depth.fetch_sub(1, Ordering::Relaxed);
    done.map(|()| true)
}

/// The table `simVision`.
pub(super) fn module(context: &ApiContext<'_>) -> mlua::Result<mlua::Table> {
    let module = context.lua.create_table()?;
    for function in functions::vision_functions() {
        module.set(function.name, context.of_session("simVision", function)?)?;
    }
    for (name, why) in functions::absent_vision_functions() {
        let message = format!("simVision.{name} is not offered: {why}");
        let refuse = move |_: &Lua, _: MultiValue| -> mlua::Result<()> { Err(Error::RuntimeError(message.clone())) };
        module.set(name, context.lua.create_function(refuse)?)?;
    }
    context.lua.globals().set("simVision", &module)?;
    Ok(module)
}
