//! `table.insert`, `remove`, `move` and `concat`: what they move is charged for before it is moved. `table.unpack` and
//! `pack` are Lua's own: the stack, a million values, bounds them.
//!
//! Source: Lua 5.4 reference manual, §6.6.

use std::sync::Arc;

use mlua::{Error, Lua, MultiValue, Table, Value};

use super::{Arguments, Library, Original, one, put, sort};

pub(super) fn install(lua: &Lua, library: &Arc<Library>) -> mlua::Result<()> {
    let tables: Table = lua.globals().get("table")?;
    let shift = Original::of(library, &tables, "move")?;
    let (own, moved) = (Original::of(library, &tables, "insert")?, shift.clone());
    put(lua, library, &tables, "insert", move |library, arguments| insert(library, &own, &moved, arguments))?;
    let (own, moved) = (Original::of(library, &tables, "remove")?, shift.clone());
    put(lua, library, &tables, "remove", move |library, arguments| remove(library, &own, &moved, arguments))?;
    put(lua, library, &tables, "move", move |library, arguments| move_elements(library, &shift, arguments))?;
    let own = Original::of(library, &tables, "concat")?;
    put(lua, library, &tables, "concat", move |library, arguments| concatenate(library, &own, arguments))?;
    sort::install(lua, library, &tables)
}

/// Returns true if the length of a table is what its `__len` says: anything, and another number each time it is asked.
fn has_own_length(table: &Table) -> mlua::Result<bool> {
    Ok(match table.metatable() {
        Some(metatable) => metatable.raw_get::<Value>("__len")? != Value::Nil,
        None => false,
    })
}

/// Number of elements from `first` to `last`.
fn distance(first: i64, last: i64) -> u64 {
    u64::try_from(i128::from(last) - i128::from(first) + 1).unwrap_or(0)
}

/// `table.insert`.
fn insert(library: &Library, own: &Original, shift: &Original, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    let lua = arguments.lua;
    let Some(Value::Table(table)) = arguments.get(1) else { return own.call(lua, &arguments.values) };
    if !has_own_length(table)? {
        if arguments.len() == 3 {
            let behind = table.raw_len() as i64;
            let position = arguments.integer(2)?;
            library.charge_elements(lua, distance(position.clamp(1, behind + 1), behind))?;
        }
        return own.call(lua, &arguments.values);
    }
    let end = table.len()?.wrapping_add(1);
    let (position, value) = match arguments.len() {
        2 => (end, arguments.get(2)),
        3 => (arguments.integer(2)?, arguments.get(3)),
        _ => return Err(Error::RuntimeError("wrong number of arguments to 'insert'".into())),
    };
    if position < 1 || position > end {
        return Err(arguments.wrong(2, "position out of bounds"));
    }
    library.charge_elements(lua, distance(position, end - 1))?;
    shift.call(lua, (table, position, end - 1, position + 1))?;
    table.set(position, value)?;
    Ok(MultiValue::new())
}

/// `table.remove`.
fn remove(library: &Library, own: &Original, shift: &Original, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    let lua = arguments.lua;
    let Some(Value::Table(table)) = arguments.get(1) else { return own.call(lua, &arguments.values) };
    if !has_own_length(table)? {
        if arguments.len() > 1 {
            let last = table.raw_len() as i64;
            library.charge_elements(lua, distance(arguments.integer(2)?.clamp(1, last + 1), last))?;
        }
        return own.call(lua, &arguments.values);
    }
    let len = table.len()?;
    let position = if arguments.len() == 1 { len } else { arguments.integer(2)? };
    if position != len && (position < 1 || position > len.saturating_add(1)) {
        return Err(arguments.wrong(2, "position out of bounds"));
    }
    library.charge_elements(lua, distance(position, len))?;
    let removed: Value = table.get(position)?;
    if position < len {
        shift.call(lua, (table, position + 1, len, position))?;
    }
    table.set(position.max(len), Value::Nil)?;
    one(removed)
}

/// `table.move`.
fn move_elements(library: &Library, own: &Original, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    let lua = arguments.lua;
    if let (Ok(first), Ok(last)) = (arguments.integer(2), arguments.integer(3)) {
        library.charge_elements(lua, distance(first, last))?;
    }
    own.call(lua, &arguments.values)
}

/// `table.concat`. Lua's own ends at the first element that is nil; a metatable may have elements everywhere.
fn concatenate(library: &Library, own: &Original, arguments: &Arguments<'_>) -> mlua::Result<MultiValue> {
    let lua = arguments.lua;
    let Some(Value::Table(table)) = arguments.get(1) else { return own.call(lua, &arguments.values) };
    let first = arguments.integer_or(3, 1)?;
    let last = if arguments.is_absent(4) { table.len()? } else { arguments.integer(4)? };
    let n = distance(first, last);
    let n = if table.metatable().is_none() { n.min(table.raw_len() as u64) } else { n };
    library.charge_elements(lua, n)?;
    let separator = arguments.get(2).cloned().unwrap_or(Value::Nil);
    own.call(lua, (table, separator, first, last))
}
