//! Functions of Lua's libraries whose time the count of instructions does not bound, replaced or charged for before
//! they run.
//!
//! Lua's hook sees instructions of Lua code only: a library function in C runs unseen, however long. Those whose time
//! grows faster than the memory of their arguments are here; what each adds to the count depends on its arguments
//! alone, so it is the same on every machine.
//!
//! | functions | bound |
//! |---|---|
//! | `string.find`, `match`, `gmatch`, `gsub` | own matcher, 8 steps an instruction (`pattern.rs`); plain search linear, 64 bytes an instruction |
//! | `string.rep`, results of `gsub` | 64 bytes an instruction, `max_memory` |
//! | `table.insert`, `remove`, `move`, `concat` | 8 elements an instruction, charged before anything is moved |
//! | `table.sort` | own merge sort, one instruction an element and a comparison |
//! | `collectgarbage` | [`base::COLLECTION`] instructions each |
//! | `setmetatable` | no finalizers: hooks are off in them; `__close` is disabled in stopped calls (`closers.rs`) |
//! | `coroutine.close` | not after a limit was reached in the coroutine: its hooks are off |
//!
//! Functions that are not here take time in proportion to their arguments' or results' size, which `max_memory` bounds.

mod base;
mod closers;
#[cfg(test)]
mod differential;
#[cfg(test)]
mod escapes;
mod pattern;
mod sort;
mod strings;
mod tables;

use std::sync::Arc;

use mlua::{Error, Function, IntoLuaMulti, Lua, LuaString, MultiValue, RegistryKey, Table, Value};

use crate::guard::Guard;
pub(crate) use closers::{disarm, rearm};
pub(crate) use sort::sort_keys;

/// Bytes that are copied or searched for one instruction.
pub(crate) const BYTES_PER_INSTRUCTION: u64 = 64;

/// Elements of a table that are moved for one instruction.
const ELEMENTS_PER_INSTRUCTION: u64 = 8;

/// Resources of the functions here.
#[derive(Debug)]
pub(crate) struct Library {
    guard: Arc<Guard>,
    /// Lua's own `pcall`.
    pcall: Function,
    /// Limit of results that are made outside the script's memory [bytes].
    max_memory: usize,
}

/// Puts the functions in the place of Lua's own.
pub(crate) fn install(lua: &Lua, guard: &Arc<Guard>, max_memory: usize) -> mlua::Result<()> {
    let pcall = lua.globals().get("pcall")?;
    let library = Arc::new(Library { guard: guard.clone(), pcall, max_memory });
    base::install(lua, &library)?;
    strings::install(lua, &library)?;
    tables::install(lua, &library)
}

impl Library {
    /// Calls a function of the script or of Lua. Errors that are no texts are kept: see [`Raised`].
    fn call(&self, lua: &Lua, function: &Function, arguments: impl IntoLuaMulti) -> mlua::Result<MultiValue> {
        let mut passed = arguments.into_lua_multi(lua)?;
        passed.push_front(Value::Function(function.clone()));
        let mut results: MultiValue = self.pcall.call(passed)?;
        if results.pop_front() == Some(Value::Boolean(true)) {
            return Ok(results);
        }
        Err(raised(lua, results.pop_front().unwrap_or(Value::Nil)))
    }

    /// Charges for elements of a table.
    fn charge_elements(&self, lua: &Lua, n: u64) -> mlua::Result<()> {
        self.charge_share(lua, n, ELEMENTS_PER_INSTRUCTION)
    }

    /// Charges for bytes.
    fn charge_bytes(&self, lua: &Lua, n: usize) -> mlua::Result<()> {
        self.charge_share(lua, n as u64, BYTES_PER_INSTRUCTION)
    }

    /// A charge of less than one instruction is none: the instruction that made the call is counted.
    fn charge_share(&self, lua: &Lua, n: u64, share: u64) -> mlua::Result<()> {
        if n < share { Ok(()) } else { self.guard.charge(lua, n / share) }
    }
}

/// Error value of a script on its way through a function here: `pcall` of the sandbox gives it back.
#[derive(Debug)]
pub(crate) struct Raised(RegistryKey);

impl std::fmt::Display for Raised {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("an error that is no text")
    }
}

impl std::error::Error for Raised {}

impl Raised {
    /// The value, if an error is one that went through a function here.
    pub fn value(lua: &Lua, error: &Error) -> Option<Value> {
        let Self(key) = error.downcast_ref()?;
        lua.registry_value(key).ok()
    }
}

/// The error that a value raises.
fn raised(lua: &Lua, value: Value) -> Error {
    match value {
        Value::Error(error) => *error,
        Value::String(text) => Error::RuntimeError(text.to_string_lossy()),
        other => lua.create_registry_value(other).map_or_else(|error| error, |key| Error::external(Raised(key))),
    }
}

/// A function of Lua that is called after its work was charged for.
#[derive(Clone, Debug)]
struct Original {
    name: &'static str,
    function: Function,
    library: Arc<Library>,
}

impl Original {
    fn of(library: &Arc<Library>, table: &Table, name: &'static str) -> mlua::Result<Self> {
        Ok(Self { name, function: table.get(name)?, library: library.clone() })
    }

    fn call(&self, lua: &Lua, arguments: impl IntoLuaMulti) -> mlua::Result<MultiValue> {
        self.library.call(lua, &self.function, arguments).map_err(|error| match error {
            // called from here the function has no name
            Error::RuntimeError(text) => Error::RuntimeError(text.replace("to '?'", &format!("to '{}'", self.name))),
            other => other,
        })
    }
}

/// Arguments of a call.
struct Arguments<'a> {
    lua: &'a Lua,
    name: &'static str,
    values: MultiValue,
}

impl Arguments<'_> {
    fn len(&self) -> usize {
        self.values.len()
    }

    /// Argument `k`, from 1.
    fn get(&self, k: usize) -> Option<&Value> {
        self.values.get(k - 1)
    }

    fn is_absent(&self, k: usize) -> bool {
        matches!(self.get(k), None | Some(Value::Nil))
    }

    fn is_true(&self, k: usize) -> bool {
        !matches!(self.get(k), None | Some(Value::Nil | Value::Boolean(false)))
    }

    /// A string, or a number as its text.
    fn string(&self, k: usize) -> mlua::Result<LuaString> {
        let text = match self.get(k) {
            Some(Value::String(text)) => return Ok(text.clone()),
            Some(number @ (Value::Integer(_) | Value::Number(_))) => self.lua.coerce_string(number.clone())?,
            _ => None,
        };
        text.ok_or_else(|| self.wrong_type(k, "string"))
    }

    /// An integer, or what converts to one.
    fn integer(&self, k: usize) -> mlua::Result<i64> {
        let value = self.get(k).cloned().unwrap_or(Value::Nil);
        if let Some(n) = self.lua.coerce_integer(value.clone())? {
            return Ok(n);
        }
        let is_number = !matches!(value, Value::Nil) && self.lua.coerce_number(value)?.is_some();
        Err(if is_number {
            self.wrong(k, "number has no integer representation")
        } else {
            self.wrong_type(k, "number")
        })
    }

    fn integer_or(&self, k: usize, default: i64) -> mlua::Result<i64> {
        if self.is_absent(k) { Ok(default) } else { self.integer(k) }
    }

    fn wrong_type(&self, k: usize, expected: &str) -> Error {
        let given = self.get(k).map_or("no value", type_name);
        self.wrong(k, &format!("{expected} expected, got {given}"))
    }

    /// Error of argument `k`; the object of a method call is not counted.
    fn wrong(&self, k: usize, why: &str) -> Error {
        let name = self.name;
        let is_method = self.lua.inspect_stack(0, |frame| frame.names().name_what == Some("method")) == Some(true);
        Error::RuntimeError(match k - usize::from(is_method) {
            0 => format!("calling '{name}' on bad self ({why})"),
            k => format!("bad argument #{k} to '{name}' ({why})"),
        })
    }
}

/// Lua's name of a type.
fn type_name(value: &Value) -> &'static str {
    match value {
        Value::Integer(_) | Value::Number(_) => "number",
        Value::Error(_) => "userdata",
        other => other.type_name(),
    }
}

/// Puts a function in the place of Lua's own.
fn put(
    lua: &Lua,
    library: &Arc<Library>,
    table: &Table,
    name: &'static str,
    run: impl Fn(&Library, &Arguments<'_>) -> mlua::Result<MultiValue> + Send + 'static,
) -> mlua::Result<()> {
    let library = library.clone();
    let function =
        lua.create_function(move |lua, values: MultiValue| run(&library, &Arguments { lua, name, values }))?;
    table.set(name, function)
}

/// Result of one value.
fn one(value: Value) -> mlua::Result<MultiValue> {
    Ok(MultiValue::from_iter([value]))
}
