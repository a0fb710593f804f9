//! Functions and variables of other scripts.

use mlua::{Error, Function, Lua, MultiValue, Table, Value as LuaValue};

use super::{ApiContext, scripts};
use crate::convert;
use crate::guard::Guard;
use crate::older_names;

/// Scripts that may be calling each other at once.
const MAX_DEPTH: usize = 16;
/// Registry key of the variables that wait for the text of a thread.
const GIVEN: &str = "sincro.given";

pub(super) fn offer(context: &ApiContext<'_>) -> mlua::Result<()> {
    let (shared, index, own) = (context.shared.clone(), context.index, context.own);
    let depth = std::sync::Arc::new(std::sync::atomic::AtomicUsize::new(0));
    context.add("callScriptFunction", move |lua, (first, second, arguments): (LuaValue, LuaValue, MultiValue)| {
        let fail = |message: String| Error::RuntimeError(format!("{message} (in function 'sim.callScriptFunction')"));
        // both orders are about: (handle, name) and (name, handle), where an old name is `function@object`
        let (name, handle) = match (&first, &second) {
            (LuaValue::String(name), LuaValue::Integer(handle))
            | (LuaValue::Integer(handle), LuaValue::String(name)) => (name.to_string_lossy(), *handle),
            _ => return Err(fail("expected the name of a function and the handle of a script".into())),
        };
        let (name, place) = match name.split_once('@') {
            None => (name.clone(), scripts::place_of(&shared, index, handle)),
            Some((name, object)) => {
                let object = shared.with_sim(own, |sim| super::object_of_name(sim, own, object));
                let object = object.map_err(|error| super::refused("callScriptFunction", &error))?;
                (name.to_owned(), shared.script_on(object, None))
            }
        };
        let place = place.ok_or_else(|| fail(format!("there is no script {handle}")))?;
        let Some(other) = shared.state(place) else {
            return Err(fail("scripts can call each other once all of them are there, not while they are read".into()));
        };
        let path = &shared.script(place).path;
        let function =
            find(&other, &name).ok_or_else(|| fail(format!("the script of `{path}` has no function `{name}`")))?;
        if depth.fetch_add(1, std::sync::atomic::Ordering::Relaxed) >= MAX_DEPTH {
            depth.fetch_sub(1, std::sync::atomic::Ordering::Relaxed);
            return Err(fail(format!("more than {MAX_DEPTH} scripts call each other")));
        }
        let result = pass(lua, &other, &function, arguments);
        depth.fetch_sub(1, std::sync::atomic::Ordering::Relaxed);
        result.map_err(|error| fail(format!("`{name}` of the script of `{path}`: {}", crate::fault::words(&error).0)))
    })?;
    let (shared, index, own) = (context.shared.clone(), context.index, context.own);
    context.add("setScriptVariable", move |_, (name, handle, value): (String, i64, LuaValue)| {
        let fail = |message: String| Error::RuntimeError(format!("{message} (in function 'sim.setScriptVariable')"));
        // an old name is `variable@object`
        let (name, place) = match name.split_once('@') {
            None => (&*name, scripts::place_of(&shared, index, handle)),
            Some((name, object)) => {
                let object = shared.with_sim(own, |sim| super::object_of_name(sim, own, object));
                let object = object.map_err(|error| super::refused("setScriptVariable", &error))?;
                (name, shared.script_on(object, None))
            }
        };
        let place = place.ok_or_else(|| fail(format!("there is no script {handle}")))?;
        let Some(other) = shared.state(place) else {
            return Err(fail("scripts have variables once all of them are there, not while they are read".into()));
        };
        let value = convert::list_from_lua(MultiValue::from_iter([value]))?;
        let value = convert::list_to_lua(&other, &value)?.pop_front().unwrap_or(LuaValue::Nil);
        let waiting: Option<Table> = other.named_registry_value(GIVEN)?;
        match waiting {
            Some(waiting) => {
                waiting.raw_push(other.create_sequence_from([LuaValue::String(other.create_string(name)?), value])?)?
            }
            None => set_variable(&other, name, value)?,
        }
        Ok(0)
    })?;
    let guard = context.guard.clone();
    context.add("testCB", move |lua, (a, callback, b, n): (LuaValue, Function, LuaValue, Option<usize>)| {
        let mut result = MultiValue::new();
        for _ in 0..=n.unwrap_or(99) {
            // a function in C has no instructions that are counted
            guard.charge(lua, 1)?;
            result = callback.call((a.clone(), b.clone()))?;
        }
        Ok(result)
    })
}

/// Has variables that others set from now on wait until the text of a thread has ended, which may set them, too.
pub(crate) fn hold_variables(lua: &Lua) -> mlua::Result<()> {
    lua.set_named_registry_value(GIVEN, lua.create_table()?)
}

/// Sets the variables that have waited, in their order.
pub(crate) fn set_held_variables(lua: &Lua) -> mlua::Result<()> {
    let Some(held) = lua.named_registry_value::<Option<Table>>(GIVEN)? else { return Ok(()) };
    lua.unset_named_registry_value(GIVEN)?;
    for pair in held.sequence_values::<Table>() {
        let pair = pair?;
        set_variable(lua, &pair.raw_get::<String>(1)?, pair.raw_get(2)?)?;
    }
    Ok(())
}

/// Sets a variable by its name, as `x` or `table.x`.
fn set_variable(lua: &Lua, name: &str, value: LuaValue) -> mlua::Result<()> {
    let (tables, last) = name.rsplit_once('.').map_or((None, name), |(tables, last)| (Some(tables), last));
    let mut at = lua.globals();
    for part in tables.into_iter().flat_map(|tables| tables.split('.')) {
        at = at.get(part).map_err(|_| {
            Error::RuntimeError(format!("the script has no table `{part}` (in function 'sim.setScriptVariable')"))
        })?;
    }
    at.raw_set(last, value)
}

/// A function by its name, as `f` or `table.f`.
pub(crate) fn find(lua: &Lua, name: &str) -> Option<Function> {
    let mut at = LuaValue::Table(lua.globals());
    for part in name.split('.') {
        let LuaValue::Table(table) = at else { return None };
        at = table.get(older_names::inside(part)).ok()?;
    }
    match at {
        LuaValue::Function(function) => Some(function),
        _ => None,
    }
}

/// Calls a function of another Lua state, within the time of the present call.
pub(super) fn pass(lua: &Lua, other: &Lua, function: &Function, arguments: MultiValue) -> mlua::Result<MultiValue> {
    let given = convert::list_from_lua(arguments)?;
    let given = convert::list_to_lua(other, &given)?;
    let result: MultiValue = match (Guard::of(lua), Guard::of(other)) {
        (Some(own), Some(others)) => {
            own.charge(lua, 1)?;
            own.lend_time(&others, || function.call(given))?
        }
        _ => function.call(given)?,
    };
    let values = convert::list_from_lua(result)?;
    convert::list_to_lua(lua, &values)
}
