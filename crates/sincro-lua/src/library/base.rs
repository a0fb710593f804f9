//! `setmetatable` without finalizers, `collectgarbage` at a price, `coroutine.close` where hooks are on.

use std::sync::Arc;

use mlua::thread::ThreadStatus;
use mlua::{Error, Lua, MultiValue, Table, Value};

use super::{Arguments, Library, Original, closers, put};

/// Instructions that one collection of garbage counts as. A collection takes as long as the script's memory is large,
/// up to some 0.1 s, but what it has to go through is not the same on every machine: so the price is one for all, and
/// the wall clock ends a loop of long ones.
pub(super) const COLLECTION: u64 = 10_000;

pub(super) fn install(lua: &Lua, library: &Arc<Library>) -> mlua::Result<()> {
    let globals = lua.globals();
    let own = Original::of(library, &globals, "setmetatable")?;
    let metatables = closers::install(lua)?;
    put(lua, library, &globals, "setmetatable", move |_, arguments| set_metatable(&own, &metatables, arguments))?;
    let own = Original::of(library, &globals, "collectgarbage")?;
    put(lua, library, &globals, "collectgarbage", move |library, arguments| collect_garbage(library, &own, arguments))?;
    let coroutines: Table = globals.get("coroutine")?;
    let own = Original::of(library, &coroutines, "close")?;
    put(lua, library, &coroutines, "close", move |library, arguments| close(library, &own, arguments))
}

/// As Lua's, but a metatable with `__gc` is refused. Lua looks at the field at this moment only: one that is set later
/// is never called.
fn set_metatable(own: &Original, metatables: &Table, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    if let Some(Value::Table(metatable)) = arguments.get(2) {
        if metatable.raw_get::<Value>("__gc")? != Value::Nil {
            return Err(Error::RuntimeError(
                "a metatable with `__gc` is not allowed: scripts have no finalizers".into(),
            ));
        }
        closers::remember(metatables, metatable)?;
    }
    own.call(arguments.lua, &arguments.values)
}

fn collect_garbage(library: &Library, own: &Original, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    let collects = match arguments.get(1) {
        Some(Value::String(option)) => {
            matches!(&*option.as_bytes(), b"collect" | b"step" | b"generational" | b"incremental")
        }
        _ => true,
    };
    library.guard.charge(arguments.lua, if collects { COLLECTION } else { 1 })?;
    own.call(arguments.lua, &arguments.values)
}

/// As Lua's, but a coroutine that ended by an error is left as it is if a call of this script ever reached a limit: if
/// the limit was reached in the coroutine its hooks are off for good, and nothing would hold the `__close` of its
/// variables.
fn close(library: &Library, own: &Original, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    if let Some(Value::Thread(thread)) = arguments.get(1)
        && thread.status() == ThreadStatus::Error
        && library.guard.was_stopped()
    {
        let message = arguments.lua.create_string("a coroutine that a limit may have ended is not closed")?;
        return Ok(MultiValue::from_iter([Value::Boolean(false), Value::String(message)]));
    }
    own.call(arguments.lua, &arguments.values)
}
