//! A law in Lua, for a block of a diagram: `output(t, u, memory)` and `update(t, u, memory)`.
//!
//! What the text sets while it is read stays; after that no global can be made, so that a law keeps what it remembers
//! in `memory`, where snapshots find it. Each instance has a Lua state of its own.

use std::fmt;
use std::sync::Arc;

use mlua::chunk::ChunkMode;
use mlua::{Error, Function, Lua, MultiValue, Table, Value};
use sincro_scene::script::{ScriptedLaw, ScriptedLawSpec};

use crate::guard::Guard;
use crate::sandbox::{self, CHUNK, Services};
use crate::{fault, power};

/// Memory of one law [bytes].
const MAX_MEMORY: usize = 64 << 20;
/// Instructions of one call.
const MAX_INSTRUCTIONS: u64 = 20_000_000;

/// Law of a diagram block written in Lua.
pub(crate) struct LuaLaw {
    spec: ScriptedLawSpec,
    guard: Arc<Guard>,
    output: Function,
    update: Option<Function>,
    /// Lists of vector inputs, refilled at every call.
    lists: Vec<Option<Table>>,
    u: Table,
    memory: Table,
    lua: Lua,
}

impl fmt::Debug for LuaLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LuaLaw").field("spec", &self.spec).finish_non_exhaustive()
    }
}

impl LuaLaw {
    /// Reads the text.
    pub fn new(spec: &ScriptedLawSpec) -> Result<Self, String> {
        let guard = Guard::new(MAX_INSTRUCTIONS);
        guard.begin();
        Self::read(spec, guard).map_err(|error| told(&spec.code, &error))
    }

    fn read(spec: &ScriptedLawSpec, guard: Arc<Guard>) -> mlua::Result<Self> {
        let lua = sandbox::new(&guard, MAX_MEMORY)?;
        let services =
            Services { time: Box::new(|| 0.0), signal: Box::new(|_, _| Ok(Value::Nil)), print: Box::new(drop) };
        sandbox::furnish(&lua, &guard, 0, services)?;
        for (name, x) in &spec.parameters {
            lua.globals().set(name.as_str(), *x)?;
        }
        let text = power::with_calls(&spec.code);
        let chunk = lua.load(text).set_name(format!("={CHUNK}")).set_mode(ChunkMode::Text);
        let environment = environment(&lua)?;
        chunk.set_environment(environment.clone()).exec()?;
        let output: Option<Function> = environment.get("output")?;
        let update: Option<Function> = environment.get("update")?;
        lua.load(LOCK).set_name(crate::sandbox::OWN_SOURCE).call::<()>(&environment)?;
        let missing = |name: &str| Error::RuntimeError(format!("the text has no function `{name}`"));
        if update.is_none() && !spec.memory.is_empty() {
            return Err(missing("update"));
        }
        let (u, memory) = (lua.create_table()?, lua.create_table()?);
        let lists = vec![None; spec.inputs.len()];
        let output = output.ok_or_else(|| missing("output"))?;
        Ok(Self { spec: spec.clone(), guard, output, update, lists, u, memory, lua })
    }

    fn fill(&mut self, inputs: &[Vec<f64>], memory: &[f64]) -> mlua::Result<()> {
        for ((name, input), list) in self.spec.inputs.iter().zip(inputs).zip(&mut self.lists) {
            if let [x] = input[..] {
                self.u.raw_set(name.as_str(), x)?;
                continue;
            }
            let list = match list {
                Some(list) => list,
                None => list.insert(self.lua.create_table_with_capacity(input.len(), 0)?),
            };
            for (k, x) in input.iter().enumerate() {
                list.raw_set(k + 1, *x)?;
            }
            self.u.raw_set(name.as_str(), &*list)?;
        }
        for (name, x) in self.spec.memory.iter().zip(memory) {
            self.memory.raw_set(name.as_str(), *x)?;
        }
        Ok(())
    }

    fn evaluate(&mut self, t: f64, inputs: &[Vec<f64>], memory: &[f64], y: &mut [f64]) -> mlua::Result<()> {
        self.guard.begin();
        self.fill(inputs, memory)?;
        let values: MultiValue = self.output.call((t, &self.u, &self.memory))?;
        self.guard.check()?;
        let wrong = |message: String| Error::RuntimeError(format!("output: {message}"));
        if values.len() != self.spec.outputs.len() {
            let (given, wanted) = (values.len(), self.spec.outputs.len());
            return Err(wrong(format!("{given} values are returned, the block has {wanted} outputs")));
        }
        let mut at = 0;
        for ((name, width), value) in self.spec.outputs.iter().zip(values) {
            match value {
                Value::Table(list) if list.raw_len() == *width => {
                    for k in 0..*width {
                        y[at + k] =
                            list.raw_get(k + 1).map_err(|_| wrong(format!("`{name}`[{}] is no number", k + 1)))?;
                    }
                }
                Value::Number(x) if *width == 1 => y[at] = x,
                Value::Integer(x) if *width == 1 => y[at] = x as f64,
                Value::Table(list) => {
                    return Err(wrong(format!("`{name}` has {} numbers, expected {width}", list.raw_len())));
                }
                other => return Err(wrong(format!("`{name}` is a {}, expected {}", other.type_name(), words(*width)))),
            }
            at += width;
        }
        Ok(())
    }

    fn advance(&mut self, t: f64, inputs: &[Vec<f64>], memory: &mut [f64]) -> mlua::Result<()> {
        let Some(update) = self.update.clone() else { return Ok(()) };
        self.guard.begin();
        self.fill(inputs, memory)?;
        update.call::<()>((t, &self.u, &self.memory))?;
        self.guard.check()?;
        for (name, x) in self.spec.memory.iter().zip(memory) {
            let value: Value = self.memory.raw_get(name.as_str())?;
            *x = match value {
                Value::Number(x) => x,
                Value::Integer(n) => n as f64,
                other => {
                    let message = format!("update: `memory.{name}` is a {}, expected a number", other.type_name());
                    return Err(Error::RuntimeError(message));
                }
            };
        }
        Ok(())
    }
}

fn words(width: usize) -> String {
    if width == 1 { "a number".into() } else { format!("a list of {width} numbers") }
}

/// After this no global can be set.
const LOCK: &str = "local env = ...
getmetatable(env).__newindex = function(_, name)
  error('`' .. tostring(name) .. '` cannot be set: a block keeps what it remembers in `memory`', 2)
end";

/// Globals of a law: an empty table in front of what it set and of the sandbox's, so that every assignment can be seen.
fn environment(lua: &Lua) -> mlua::Result<Table> {
    let text = "local own = setmetatable({}, { __index = ... })
    return setmetatable({}, { __index = own, __newindex = own })";
    lua.load(text).set_name(crate::sandbox::OWN_SOURCE).call(lua.globals())
}

/// An error with its line.
fn told(code: &str, error: &Error) -> String {
    let (message, line) = fault::words(error);
    match line.and_then(|line| Some((line, code.lines().nth(line.checked_sub(1)?)?.trim()))) {
        Some((line, text)) => format!("line {line}, `{text}`: {message}"),
        None => message,
    }
}

impl ScriptedLaw for LuaLaw {
    fn output(&mut self, t: f64, inputs: &[Vec<f64>], memory: &[f64], y: &mut [f64]) -> Result<(), String> {
        self.evaluate(t, inputs, memory, y).map_err(|error| told(&self.spec.code, &error))
    }

    fn update(&mut self, t: f64, inputs: &[Vec<f64>], memory: &mut [f64]) -> Result<(), String> {
        self.advance(t, inputs, memory).map_err(|error| told(&self.spec.code, &error))
    }

    fn boxed_clone(&self) -> Box<dyn ScriptedLaw> {
        Box::new(Self::new(&self.spec).expect("the text was read before"))
    }
}
