//! Values between Lua and the session: lists are tables 1 … n, maps are tables with names, bytes and text are both
//! strings.

use mlua::{Error, Lua, MultiValue, Table, Value as LuaValue};
use sincro_coppelia::api::Value;

/// Tables inside each other beyond which a value is refused: a table may hold itself.
const MAX_DEPTH: usize = 64;

/// Size beyond which values are refused together [bytes]: a table that is in a table many times is that many values
/// here.
const MAX_SIZE: usize = 256 << 20;

/// From Lua; functions and the like have no value elsewhere.
pub(crate) fn from_lua(value: LuaValue) -> mlua::Result<Value> {
    at_depth(value, 0, &mut 0)
}

/// Counts a value; `size` is that of all so far.
fn count(size: &mut usize, more: usize) -> mlua::Result<()> {
    *size += more;
    if *size <= MAX_SIZE {
        return Ok(());
    }
    Err(Error::RuntimeError(format!("values of more than {} MiB cannot be passed on", MAX_SIZE >> 20)))
}

fn at_depth(value: LuaValue, depth: usize, size: &mut usize) -> mlua::Result<Value> {
    count(size, size_of::<Value>())?;
    Ok(match value {
        LuaValue::Nil => Value::Nil,
        LuaValue::Boolean(truth) => Value::Bool(truth),
        LuaValue::Integer(n) => Value::Int(n),
        LuaValue::Number(x) => Value::Real(x),
        LuaValue::String(text) => {
            count(size, text.as_bytes().len())?;
            match text.to_str() {
                Ok(text) => Value::Text(text.to_owned()),
                Err(_) => Value::Bytes(text.as_bytes().to_vec()),
            }
        }
        LuaValue::Table(table) => {
            if depth >= MAX_DEPTH {
                return Err(Error::RuntimeError(
                    "a table holds itself, or tables are too deep inside each other".into(),
                ));
            }
            of_table(&table, depth, size)?
        }
        other => return Err(Error::RuntimeError(format!("a {} cannot be passed on", other.type_name()))),
    })
}

fn of_table(table: &Table, depth: usize, size: &mut usize) -> mlua::Result<Value> {
    let n = table.raw_len();
    if n > 0 {
        let items = (1..=n).map(|k| at_depth(table.raw_get(k)?, depth + 1, size));
        return Ok(Value::List(items.collect::<mlua::Result<_>>()?));
    }
    let mut map = Vec::new();
    for pair in table.pairs::<LuaValue, LuaValue>() {
        let (key, value) = pair?;
        let name = match &key {
            LuaValue::String(name) => name.to_string_lossy(),
            LuaValue::Integer(k) => k.to_string(),
            other => {
                return Err(Error::RuntimeError(format!(
                    "a table with a {} as a key cannot be passed on",
                    other.type_name()
                )));
            }
        };
        count(size, size_of::<String>() + name.len())?;
        map.push((name, at_depth(value, depth + 1, size)?));
    }
    // Lua has no order of keys that is the same in every run
    map.sort_by(|a: &(String, Value), b| a.0.cmp(&b.0));
    Ok(if map.is_empty() { Value::List(Vec::new()) } else { Value::Map(map) })
}

/// To Lua.
pub(crate) fn to_lua(lua: &Lua, value: &Value) -> mlua::Result<LuaValue> {
    Ok(match value {
        Value::Nil => LuaValue::Nil,
        Value::Bool(truth) => LuaValue::Boolean(*truth),
        Value::Int(n) => LuaValue::Integer(*n),
        Value::Real(x) => LuaValue::Number(*x),
        Value::Text(text) => LuaValue::String(lua.create_string(text)?),
        Value::Bytes(bytes) => LuaValue::String(lua.create_string(bytes)?),
        Value::List(list) => {
            let table = lua.create_table_with_capacity(list.len(), 0)?;
            for (k, item) in list.iter().enumerate() {
                table.raw_set(k + 1, to_lua(lua, item)?)?;
            }
            LuaValue::Table(table)
        }
        Value::Numbered(map) => {
            let table = lua.create_table()?;
            for (key, item) in map {
                table.raw_set(*key, to_lua(lua, item)?)?;
            }
            LuaValue::Table(table)
        }
        Value::Map(map) => {
            let table = lua.create_table_with_capacity(0, map.len())?;
            for (name, item) in map {
                table.raw_set(name.as_str(), to_lua(lua, item)?)?;
            }
            LuaValue::Table(table)
        }
    })
}

/// Arguments or results.
pub(crate) fn list_from_lua(values: MultiValue) -> mlua::Result<Vec<Value>> {
    let mut size = 0;
    values.into_iter().map(|value| at_depth(value, 0, &mut size)).collect()
}

/// Results.
pub(crate) fn list_to_lua(lua: &Lua, values: &[Value]) -> mlua::Result<MultiValue> {
    values.iter().map(|value| to_lua(lua, value)).collect()
}
