//! `__close` of scripts, disabled while a call is stopped.
//!
//! An error that the hook raises unwinds the function that was running before the hook has returned: the `__close` of
//! its variables would run with hooks off, for ever if it likes. So each metatable is remembered when it is set, and
//! before the hook raises an error `__close` of all of them becomes a function that does nothing. Nothing is lost: a
//! call that has reached its limit runs no more code.

use mlua::{Function, Lua, MultiValue, Table, Value};

/// Names in the registry: all metatables (weak), the `__close` of those that lost it, the function in its place.
const METATABLES: &str = "metatables";
const CLOSERS: &str = "closers";
const NO_PIECE: &str = "closes nothing";

/// Begins to remember metatables; returns the table that they are remembered in.
pub(super) fn install(lua: &Lua) -> mlua::Result<Table> {
    let (metatables, mode) = (lua.create_table()?, lua.create_table()?);
    mode.raw_set("__mode", "k")?;
    metatables.set_metatable(Some(mode))?;
    lua.set_named_registry_value(METATABLES, &metatables)?;
    lua.set_named_registry_value(NO_PIECE, lua.create_function(|_, _: MultiValue| Ok(()))?)?;
    // of strings: the only values with a metatable that `setmetatable` did not give them
    let of_strings: Value = lua.load("return getmetatable('')").set_name(crate::sandbox::OWN_SOURCE).eval()?;
    if let Value::Table(of_strings) = of_strings {
        remember(&metatables, &of_strings)?;
    }
    Ok(metatables)
}

/// Remembers a metatable.
pub(super) fn remember(metatables: &Table, metatable: &Table) -> mlua::Result<()> {
    metatables.raw_set(metatable, true)
}

/// Takes `__close` away from all metatables.
pub(crate) fn disarm(lua: &Lua) -> mlua::Result<()> {
    // must not fail for want of memory
    let limit = lua.set_memory_limit(0)?;
    let done = take_all(lua);
    lua.set_memory_limit(limit)?;
    done
}

fn take_all(lua: &Lua) -> mlua::Result<()> {
    let Some(metatables) = lua.named_registry_value::<Option<Table>>(METATABLES)? else { return Ok(()) };
    let nothing: Function = lua.named_registry_value(NO_PIECE)?;
    let closers = match lua.named_registry_value::<Option<Table>>(CLOSERS)? {
        Some(closers) => closers,
        None => lua.create_table()?,
    };
    metatables.for_each(|metatable: Table, _: bool| {
        let closer: Value = metatable.raw_get("__close")?;
        if closer == Value::Nil || closer == Value::Function(nothing.clone()) {
            return Ok(());
        }
        closers.raw_set(&metatable, closer)?;
        metatable.raw_set("__close", &nothing)
    })?;
    lua.set_named_registry_value(CLOSERS, closers)
}

/// Gives back what [`disarm`] took.
pub(crate) fn rearm(lua: &Lua) -> mlua::Result<()> {
    let closers: Option<Table> = lua.named_registry_value(CLOSERS)?;
    lua.unset_named_registry_value(CLOSERS)?;
    closers.map_or(Ok(()), |closers| {
        closers.for_each(|metatable: Table, closer: Value| metatable.raw_set("__close", closer))
    })
}
