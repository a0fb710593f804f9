//! Environment of a script in its Lua state: the language, mathematics with the same bits everywhere, and nothing that
//! reaches outside.
//!
//! Left out are files, processes, packages, bytecode and the debugger but its traceback. `os` has clocks of the
//! simulation only. `math` is of [`sincro_math::elementary`], not of the platform; `math.random` is Lua's own generator
//! (xoshiro256**) seeded by the run and the script's object.

use std::sync::Arc;

use mlua::chunk::ChunkMode;
use mlua::{Error, Function, Lua, LuaOptions, MultiValue, StdLib, Table, Value, Variadic};
use sincro_math::elementary;

use crate::guard::Guard;
use crate::library::{self, Raised};
use crate::power;

/// The chunk name of a script: positions read `script:12:`.
pub(crate) const CHUNK: &str = "script";

/// Source of the functions in Lua that are not the script's own.
pub(crate) const OWN_SOURCE: &str = "=sincro";

/// Longest text that is compiled in a run [bytes].
const MAX_TEXT: usize = 1 << 20;

/// Length of a printed line beyond which nothing is added [bytes]; messages are cut at 10 000.
const MAX_LINE: usize = 10_000;

/// Finds the value of a signal.
type Signal = dyn Fn(&Lua, &str) -> mlua::Result<Value> + Send;

/// A function of `math` with its name.
type Named = (&'static str, fn(f64) -> f64);

/// Services that the prelude needs.
pub(crate) struct Services {
    /// Time `[s]` of the scripts.
    pub time: Box<dyn Fn() -> f64 + Send>,
    /// The value of a signal of any kind.
    pub signal: Box<Signal>,
    /// Takes what is printed.
    pub print: Box<dyn Fn(String) + Send>,
}

/// Functions of the prelude that wait.
pub(crate) struct Waits {
    /// Until the next step.
    pub switch: Function,
    /// For a time.
    pub wait: Function,
    /// For a signal.
    pub wait_for_signal: Function,
}

/// A Lua state that is shut off, with its limits.
pub(crate) fn new(guard: &Arc<Guard>, max_memory: usize) -> mlua::Result<Lua> {
    let libraries = StdLib::COROUTINE | StdLib::TABLE | StdLib::STRING | StdLib::UTF8 | StdLib::MATH;
    // so `pcall` and `xpcall` stay Lua's own, through which threads can wait
    let lua = Lua::new_with(libraries, LuaOptions::new().catch_rust_panics(true))?;
    lua.set_memory_limit(max_memory)?;
    guard.install(&lua)?;
    library::install(&lua, guard, max_memory)?;
    Ok(lua)
}

/// Fills the globals.
pub(crate) fn furnish(lua: &Lua, guard: &Arc<Guard>, seed: u64, services: Services) -> mlua::Result<Waits> {
    let globals = lua.globals();
    mathematics(lua, seed)?;
    forbid(lua)?;
    let loading = guard.clone();
    globals.set("load", lua.create_function(move |lua, arguments| load(lua, &loading, arguments))?)?;
    globals.set(power::POWER, lua.create_function(power_of)?)?;
    let Services { time, signal, print } = services;
    globals.set("print", printing(lua, print)?)?;
    let time = Arc::new(std::sync::Mutex::new(time));
    clocks(lua, &time)?;

    let host = lua.create_table()?;
    let checked = guard.clone();
    host.set("check", lua.create_function(move |_, ()| checked.check())?)?;
    let stopped = guard.clone();
    host.set("is_stopped", lua.create_function(move |_, ()| Ok(stopped.is_stopped()))?)?;
    let entering = guard.clone();
    host.set("enter", lua.create_function(move |_, ()| Ok(entering.enter_coroutine()))?)?;
    let leaving = guard.clone();
    host.set(
        "leave",
        lua.create_function(move |_, outer: u64| {
            leaving.leave_coroutine(outer);
            Ok(())
        })?,
    )?;
    let sorting = guard.clone();
    host.set("sort_keys", lua.create_function(move |lua, keys: Table| library::sort_keys(lua, &sorting, &keys))?)?;
    host.set("text", lua.create_function(|lua, error: Value| text_of(lua, error))?)?;
    host.set("time", clock(lua, &time)?)?;
    host.set("signal", lua.create_function(move |lua, name: String| signal(lua, &name))?)?;
    let waits: Table = lua.load(include_str!("prelude.lua")).set_name(OWN_SOURCE).call(host)?;
    Ok(Waits { switch: waits.get("switch")?, wait: waits.get("wait")?, wait_for_signal: waits.get("wait_for_signal")? })
}

type Clock = Arc<std::sync::Mutex<Box<dyn Fn() -> f64 + Send>>>;

fn clock(lua: &Lua, time: &Clock) -> mlua::Result<Function> {
    let time = time.clone();
    lua.create_function(move |_, ()| Ok(time.lock().map_or(0.0, |time| time())))
}

/// `os` with the simulation's time: what a script measures is the same in every run.
fn clocks(lua: &Lua, time: &Clock) -> mlua::Result<()> {
    let os = lua.create_table()?;
    os.set("clock", clock(lua, time)?)?;
    let whole = time.clone();
    os.set(
        "time",
        lua.create_function(move |_, _: MultiValue| Ok(whole.lock().map_or(0.0, |time| time()).floor() as i64))?,
    )?;
    os.set("difftime", lua.create_function(|_, (a, b): (f64, Option<f64>)| Ok(a - b.unwrap_or(0.0)))?)?;
    for name in ["execute", "exit", "getenv", "remove", "rename", "tmpname", "setlocale", "date"] {
        os.set(name, refused(lua, &format!("os.{name}"))?)?;
    }
    lua.globals().set("os", os)
}

/// A function that fails, saying what it is.
pub(crate) fn refused(lua: &Lua, name: &str) -> mlua::Result<Function> {
    let message = format!("{name} is not allowed: scripts reach no files, programs or network");
    lua.create_function(move |_, _: MultiValue| -> mlua::Result<()> { Err(Error::RuntimeError(message.clone())) })
}

fn forbid(lua: &Lua) -> mlua::Result<()> {
    let globals = lua.globals();
    for name in ["dofile", "loadfile"] {
        globals.set(name, refused(lua, name)?)?;
    }
    let io = lua.create_table()?;
    for name in ["open", "popen", "lines", "read", "write", "input", "output", "tmpfile", "close", "type"] {
        io.set(name, refused(lua, &format!("io.{name}"))?)?;
    }
    globals.set("io", io)?;
    globals.get::<Table>("string")?.set("dump", refused(lua, "string.dump")?)?;
    let debug = lua.create_table()?;
    debug.set("traceback", lua.create_function(traceback)?)?;
    globals.set("debug", debug)
}

/// `debug.traceback(message, level)` or `(thread, message, level)`; of another thread the stack is not told.
fn traceback(lua: &Lua, mut arguments: MultiValue) -> mlua::Result<Value> {
    let of_thread = matches!(arguments.front(), Some(Value::Thread(_)));
    if of_thread {
        arguments.pop_front();
    }
    let (message, level) = (arguments.pop_front().unwrap_or(Value::Nil), arguments.pop_front());
    let text = match message {
        Value::Nil => None,
        Value::String(text) => Some(text.to_string_lossy()),
        Value::Integer(_) | Value::Number(_) => lua.coerce_string(message)?.map(|text| text.to_string_lossy()),
        other => return Ok(other),
    };
    if of_thread {
        let text = text.map(|text| text + "\n").unwrap_or_default() + "stack traceback:\n\t(another thread)";
        return lua.create_string(text).map(Value::String);
    }
    let level = level.and_then(|level| level.as_usize()).unwrap_or(1);
    lua.traceback(text.as_deref(), level).map(Value::String)
}

/// As Lua's `load`, for texts only; powers are made calls in them too.
fn load(
    lua: &Lua,
    guard: &Arc<Guard>,
    (chunk, name, mode, env): (Value, Option<String>, Option<String>, Option<Table>),
) -> mlua::Result<MultiValue> {
    let text = match chunk {
        Value::String(text) => text.to_string_lossy(),
        Value::Function(pieces) => {
            let mut text = String::new();
            loop {
                let piece: Option<mlua::LuaString> = pieces.call(())?;
                match piece.filter(|piece| !piece.as_bytes().is_empty()) {
                    Some(piece) => {
                        text.push_str(&piece.to_string_lossy());
                        guard.charge(lua, 1)?;
                        if text.len() > MAX_TEXT {
                            break text;
                        }
                    }
                    None => break text,
                }
            }
        }
        other => {
            let message = format!("bad argument #1 to 'load' (text expected, got {})", other.type_name());
            return Err(Error::RuntimeError(message));
        }
    };
    charge_text(lua, guard, &text)?;
    if mode.is_some_and(|mode| !mode.contains('t')) {
        return Err(Error::RuntimeError("bytecode is not allowed: load takes text".into()));
    }
    let mut chunk =
        lua.load(power::with_calls(&text)).set_mode(ChunkMode::Text).set_name(name.unwrap_or_else(|| "=load".into()));
    if let Some(env) = env {
        chunk = chunk.set_environment(env);
    }
    Ok(match chunk.into_function() {
        Ok(function) => MultiValue::from_iter([Value::Function(function)]),
        Err(error) => {
            let message = lua.create_string(syntax_message(&error))?;
            MultiValue::from_iter([Value::Nil, Value::String(message)])
        }
    })
}

/// Charges for the compilation of a text from within a run; Lua's compiler goes through the open jumps and labels of a
/// function again at each one.
pub(crate) fn charge_text(lua: &Lua, guard: &Arc<Guard>, text: &str) -> mlua::Result<()> {
    if text.len() > MAX_TEXT {
        return Err(Error::RuntimeError(format!(
            "a text of more than {} KiB is not compiled in a run",
            MAX_TEXT >> 10
        )));
    }
    let jumps = ["elseif", "goto", "::", "break", "and", "or"]
        .map(|word| memchr::memmem::find_iter(text.as_bytes(), word).count() as u64);
    let jumps: u64 = jumps.iter().sum();
    guard.charge(lua, (text.len() as u64 + jumps * jumps) / 16)
}

/// Message of the compiler, without mlua's prefix.
fn syntax_message(error: &Error) -> String {
    match error {
        Error::SyntaxError { message, .. } => message.clone(),
        other => other.to_string(),
    }
}

/// `a ^ b`: numbers and texts that read as numbers, else the metamethod.
fn power_of(lua: &Lua, (a, b): (Value, Value)) -> mlua::Result<Value> {
    if let (Some(x), Some(y)) = (number(lua, &a)?, number(lua, &b)?) {
        return Ok(Value::Number(power(x, y)));
    }
    for operand in [&a, &b] {
        let meta = match operand {
            Value::Table(table) => table.metatable(),
            _ => None,
        };
        if let Some(own) = meta.and_then(|meta| meta.get::<Option<Function>>("__pow").ok().flatten()) {
            return own.call((&a, &b));
        }
    }
    let wrong = if number(lua, &a)?.is_some() { &b } else { &a };
    Err(Error::RuntimeError(format!("attempt to perform arithmetic on a {} value", wrong.type_name())))
}

fn number(lua: &Lua, value: &Value) -> mlua::Result<Option<f64>> {
    match value {
        Value::Number(x) => Ok(Some(*x)),
        Value::Integer(x) => Ok(Some(*x as f64)),
        Value::String(_) => lua.coerce_number(value.clone()),
        _ => Ok(None),
    }
}

/// x to the power y; for y = 2 as Lua has it.
fn power(x: f64, y: f64) -> f64 {
    if y == 2.0 { x * x } else { elementary::pow(x, y).0 }
}

/// The functions of `math` that a platform's library would compute, and those of older Lua.
fn mathematics(lua: &Lua, seed: u64) -> mlua::Result<()> {
    let math: Table = lua.globals().get("math")?;
    let unary: [Named; 10] = [
        ("sin", |x| elementary::sin_cos(x).0),
        ("cos", |x| elementary::sin_cos(x).1),
        ("tan", |x| elementary::tan(x).0),
        ("asin", |x| elementary::asin(x).0),
        ("acos", |x| elementary::acos(x).0),
        ("exp", |x| elementary::exp(x).0),
        ("log10", |x| elementary::log10(x).0),
        ("sinh", |x| elementary::sinh(x).0),
        ("cosh", |x| elementary::cosh(x).0),
        ("tanh", |x| elementary::tanh(x).0),
    ];
    for (name, f) in unary {
        math.set(name, lua.create_function(move |_, x: f64| Ok(f(x)))?)?;
    }
    let atan = |_: &Lua, (y, x): (f64, Option<f64>)| {
        Ok(match x {
            Some(x) => elementary::atan2(y, x).0,
            None => elementary::atan(y).0,
        })
    };
    math.set("atan", lua.create_function(atan)?)?;
    math.set("atan2", lua.create_function(|_, (y, x): (f64, f64)| Ok(elementary::atan2(y, x).0))?)?;
    math.set("pow", lua.create_function(|_, (x, y): (f64, f64)| Ok(power(x, y)))?)?;
    math.set("log", lua.create_function(|_, (x, base): (f64, Option<f64>)| Ok(logarithm(x, base)))?)?;
    math.set("mod", math.get::<Value>("fmod")?)?;
    math.set("ldexp", lua.create_function(|_, (x, e): (f64, i32)| Ok(x * elementary::pow(2.0, f64::from(e)).0))?)?;
    seeded(lua, &math, seed)
}

/// As Lua has it: base 2 and 10 by themselves, others by division.
fn logarithm(x: f64, base: Option<f64>) -> f64 {
    match base {
        None => elementary::ln(x).0,
        Some(10.0) => elementary::log10(x).0,
        Some(base) => elementary::ln(x).0 / elementary::ln(base).0,
    }
}

/// Seeds the generator; `math.randomseed` without a number seeds it so again. A number with a fraction, as older Lua
/// takes it, counts as the whole number below.
fn seeded(lua: &Lua, math: &Table, seed: u64) -> mlua::Result<()> {
    let own: Function = math.get("randomseed")?;
    let seed = i64::from_ne_bytes(seed.to_ne_bytes());
    own.call::<()>((seed, 0))?;
    let again = move |_: &Lua, given: Variadic<Value>| {
        let whole = |value: Value| match value {
            Value::Number(x) if x.is_finite() => Value::Integer(x.floor() as i64),
            other => other,
        };
        if given.is_empty() {
            return own.call::<()>((seed, 0));
        }
        own.call::<()>(given.into_iter().map(whole).collect::<MultiValue>())
    };
    let again = lua.create_function(again)?;
    math.set("randomseed2", again.clone())?;
    math.set("randomseed", again)?;
    let random: Function = math.get("random")?;
    let from_range = move |_: &Lua, (lower, upper): (Option<Value>, Option<Value>)| in_range(&random, lower, upper);
    math.set("random2", lua.create_function(from_range)?)
}

/// `math.random2` of the simulator: a number from 0 to 1, a whole number from 1 to the first, or from the first to the
/// second, which need not be whole themselves.
fn in_range(random: &Function, lower: Option<Value>, upper: Option<Value>) -> mlua::Result<Value> {
    let r: f64 = random.call(())?;
    let Some(first) = lower else { return Ok(Value::Number(r)) };
    let number = |value: &Value| match value {
        Value::Integer(n) => Ok(*n as f64),
        Value::Number(x) => Ok(*x),
        other => Err(mlua::Error::runtime(format!("number expected, got {}", other.type_name()))),
    };
    let (start, end) = match &upper {
        Some(end) => (number(&first)?, number(end)?),
        None => (1.0, number(&first)?),
    };
    let sum = start + (r * (end - start + 1.0)).floor();
    let is_whole = upper.is_none() || first.is_integer();
    Ok(if is_whole && sum.abs() < 2.0_f64.powi(53) { Value::Integer(sum as i64) } else { Value::Number(sum) })
}

fn printing(lua: &Lua, print: Box<dyn Fn(String) + Send>) -> mlua::Result<Function> {
    let tostring: Function = lua.globals().get("tostring")?;
    lua.create_function(move |_, values: Variadic<Value>| {
        let mut line = String::new();
        for (k, value) in values.into_iter().enumerate() {
            let text: mlua::LuaString = tostring.call(value)?;
            if line.len() > MAX_LINE {
                continue;
            }
            if k > 0 {
                line.push('\t');
            }
            line.push_str(&text.to_string_lossy());
        }
        print(line);
        Ok(())
    })
}

/// An error as scripts know it: a text with its position; other values stay.
fn text_of(lua: &Lua, error: Value) -> mlua::Result<Value> {
    let Value::Error(error) = error else { return Ok(error) };
    if let Some(value) = Raised::value(lua, &error) {
        return Ok(value);
    }
    let (message, line) = crate::fault::words(&error);
    let text = match line {
        Some(line) => format!("{CHUNK}:{line}: {message}"),
        None => message,
    };
    Ok(Value::String(lua.create_string(text)?))
}
