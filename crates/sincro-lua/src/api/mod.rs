//! The functions of `sim`, for one script.
//!
//! What the simulation can be asked is [`sincro_coppelia::api::functions`]: the same for scripts and clients. Here it
//! becomes Lua, as `sim.fooBar` and, as V-REP had it, `simFooBar`; beside it stands what only scripts have: their
//! parameters, each other, threads.

mod attributes;
mod callbacks;
mod cascade;
mod helpers;
mod modules;
mod moves;
mod planning;
mod ros;
mod scripts;
mod threads;
mod vision;

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

pub(crate) use callbacks::{find as function_of, hold_variables, set_held_variables};
pub(crate) use ros::DELIVER;

use mlua::{Error, Function, IntoLuaMulti, Lua, MultiValue, Table, Value as LuaValue};
use sincro_coppelia::api::{ApiError, Arguments, Handle, Search, Value, constants, functions};

use crate::convert;
use crate::guard::Guard;
use crate::machine::{CALL_TYPES, is_of_old_api};
use crate::sandbox::Waits;
use crate::shared::Shared;

/// Context of the registration of `sim`'s functions, under all their names.
pub(crate) struct ApiContext<'a> {
    lua: &'a Lua,
    sim: Table,
    shared: &'a Arc<Shared>,
    /// The script's place among those of the run.
    index: usize,
    /// Its object.
    own: Handle,
    guard: &'a Arc<Guard>,
}

/// Parameters that objects do not have which a script is told of.
const MAX_LACKING_TOLD: usize = 100;
/// `sim.handle_self` as a text.
const SELF: &str = "-4";

/// Fills a Lua state with everything that the script `index` may call.
pub(crate) fn offer(
    lua: &Lua,
    shared: &Arc<Shared>,
    index: usize,
    guard: &Arc<Guard>,
    waits: &Waits,
) -> mlua::Result<()> {
    let own = shared.object(index);
    let context = ApiContext { lua, sim: lua.create_table()?, shared, index, own, guard };
    constants_of(&context)?;
    for function in functions::functions() {
        let called = context.of_session("sim", function)?;
        context.put(function.name, called)?;
    }
    for (old, present) in functions::old_names() {
        if let Some(function) = context.sim.get::<Option<Function>>(present)? {
            context.put(old, function)?;
        }
    }
    context.replace_some()?;
    scripts::offer(&context)?;
    attributes::offer(&context)?;
    cascade::offer(&context)?;
    threads::offer(&context, waits)?;
    moves::offer(&context, waits)?;
    vision::offer(&context)?;
    callbacks::offer(&context)?;
    helpers::offer(&context)?;
    absent(&context)?;
    lua.globals().set("sim", &context.sim)?;
    modules::offer(&context)
}

impl ApiContext<'_> {
    /// Puts a function under its present name, and as V-REP had it.
    fn put(&self, name: &str, function: Function) -> mlua::Result<()> {
        let mut letters = name.chars();
        if let Some(first) = letters.next() {
            let old = format!("sim{}{}", first.to_ascii_uppercase(), letters.as_str());
            self.lua.globals().set(old, &function)?;
        }
        self.sim.set(name, function)
    }

    /// Puts a function that is made here.
    fn add<A, R>(&self, name: &str, f: impl Fn(&Lua, A) -> mlua::Result<R> + Send + 'static) -> mlua::Result<()>
    where
        A: mlua::FromLuaMulti,
        R: IntoLuaMulti,
    {
        self.put(name, self.lua.create_function(f)?)
    }

    /// A function of the session.
    fn of_session(&self, module: &'static str, function: &'static functions::Function) -> mlua::Result<Function> {
        let (shared, own, guard) = (self.shared.clone(), self.own, self.guard.clone());
        let is_setter = function.name.starts_with("set") && !functions::is_display_only(function.name);
        self.lua.create_function(move |lua, arguments: MultiValue| {
            let given = convert::list_from_lua(arguments).map_err(|error| named(function.name, error))?;
            // a client's nil may be a number that is none; a script's is a mistake
            let is_missing = |(k, value): (usize, &Value)| *value == Value::Nil && !function.may_be_nil(k);
            if is_setter && let Some(k) = given.iter().enumerate().position(is_missing) {
                return Err(Error::RuntimeError(format!(
                    "argument {} is nil (in function '{module}.{}')",
                    k + 1,
                    function.name
                )));
            }
            let (mut has_restructured, mut work) = (false, 0);
            let result = shared.with_sim_as_it_is(own, |sim| {
                let before = sim.registry.scene().clone();
                let result = function.call(sim, Arguments(&given));
                has_restructured = !Arc::ptr_eq(&before, sim.registry.scene());
                work = sim.work();
                result
            });
            guard.spend(lua, has_restructured)?;
            if work > 0 {
                guard.charge(lua, work)?;
            }
            let named = |ApiError(message): ApiError| {
                Error::RuntimeError(format!("{message} (in function '{module}.{}')", function.name))
            };
            let values = result.map_err(|error| {
                let error = named(error);
                if given.iter().any(has_not_finite) {
                    guard.note_not_finite(&error);
                }
                error
            })?;
            convert::list_to_lua(lua, &values)
        })
    }

    /// Mode of the errors of the script, parameter 0: a name that is not found is an error (1, as at the start), or −1
    /// is the answer (0).
    fn error_report_mode(&self) -> mlua::Result<Arc<AtomicI64>> {
        let mode = Arc::new(AtomicI64::new(1));
        let (kept, others) = (mode.clone(), self.sim.get::<Function>("setInt32Param")?);
        let set = self.lua.create_function(move |_, arguments: MultiValue| {
            match arguments.get(1).and_then(LuaValue::as_integer).filter(|_| names_errors(&arguments)) {
                Some(value) => kept.store(value, Ordering::Relaxed),
                None => return others.call::<MultiValue>(arguments),
            }
            Ok(MultiValue::from_iter([LuaValue::Integer(1)]))
        })?;
        let (kept, others) = (mode.clone(), self.sim.get::<Function>("getInt32Param")?);
        let get = self.lua.create_function(move |_, arguments: MultiValue| match names_errors(&arguments) {
            true => Ok(MultiValue::from_iter([LuaValue::Integer(kept.load(Ordering::Relaxed))])),
            false => others.call(arguments),
        })?;
        for ending in ["Int32Param", "Int32Parameter", "IntegerParameter"] {
            self.put(&format!("set{ending}"), set.clone())?;
            self.put(&format!("get{ending}"), get.clone())?;
        }
        Ok(mode)
    }

    /// Functions of the session that scripts have in another way.
    fn replace_some(&self) -> mlua::Result<()> {
        let (shared, own, mode) = (self.shared.clone(), self.own, self.error_report_mode()?);
        self.add("getObjectHandle", move |_, name: String| {
            let silent = name.strip_suffix("@silentError").map(str::to_owned);
            let is_silent = silent.is_some() || mode.load(Ordering::Relaxed) == 0;
            let name = silent.unwrap_or(name);
            // a number that scripts of V-REP give in place of a name
            if name == SELF {
                return Ok(own.0);
            }
            let found = shared.with_sim_as_it_is(own, |sim| sim.found_by(&name, |sim| object_of_name(sim, own, &name)));
            match found {
                Err(_) if is_silent => Ok(-1),
                found => found.map(|handle| handle.0).map_err(|error| refused("getObjectHandle", &error)),
            }
        })?;
        let (shared, index) = (self.shared.clone(), self.index);
        self.add("addStatusbarMessage", move |_, text: Option<String>| {
            shared.say(index, text.unwrap_or_default());
            Ok(1)
        })?;
        let shared = self.shared.clone();
        self.add("addLog", move |_, (_, text): (i64, String)| {
            shared.say(index, text);
            Ok(())
        })?;
        // the clock of the wall would make every run another one
        let shared = self.shared.clone();
        self.add("getSystemTime", move |_, ()| Ok(shared.t()))?;
        for name in ["getSystemTimeInMs", "getSystemTimeInMilliseconds"] {
            // since an earlier time, for none (-1) the time itself
            let shared = self.shared.clone();
            self.add(name, move |_, before: Option<i64>| {
                let now = (shared.t() * 1e3).round() as i64;
                Ok(now - before.filter(|before| *before >= 0).unwrap_or(0))
            })?;
        }
        self.object_parameters()?;
        if is_of_old_names(&self.shared.script(self.index).text) {
            for name in
                ["readProximitySensor", "handleProximitySensor", "checkProximitySensor", "checkProximitySensorEx"]
            {
                // before CoppeliaSim 4.3 there was one result alone where nothing is detected
                let of_session: Function = self.sim.get(name)?;
                self.add(name, move |_, arguments: MultiValue| {
                    let mut results: MultiValue = of_session.call(arguments)?;
                    let is_detected = results.front().and_then(LuaValue::as_integer).is_some_and(|result| result > 0);
                    if !is_detected {
                        results.truncate(1);
                    }
                    Ok(results)
                })?;
            }
        }
        if let Some(inverse) = self.sim.get::<Option<Function>>("getMatrixInverse")? {
            self.add("invertMatrix", move |_, matrix: Table| {
                let inverted: Table = inverse.call(&matrix)?;
                for k in 1..=12 {
                    matrix.raw_set(k, inverted.raw_get::<f64>(k)?)?;
                }
                Ok(1)
            })?;
        }
        let math: Table = self.lua.globals().get("math")?;
        let (random, seeded): (Function, Function) = (math.get("random")?, math.get("randomseed")?);
        self.add("getRandom", move |_, seed: Option<i64>| {
            if let Some(seed) = seed {
                seeded.call::<()>(seed)?;
            }
            random.call::<f64>(())
        })
    }
}

impl ApiContext<'_> {
    /// Parameters of objects under their older names: the first result of a getter says that there is a second. To
    /// scripts of V-REP up to 3.4 a parameter that the object does not have is 0 as a first result, and no error; a
    /// message tells once.
    fn object_parameters(&self) -> mlua::Result<()> {
        let is_old = is_of_old_api(&self.shared.script(self.index).text);
        let told = Arc::new(Mutex::new(BTreeSet::new()));
        for (name, is_getter) in ["Int32", "Int", "Float"].iter().flat_map(|name| [(name, true), (name, false)]) {
            let verb = if is_getter { "get" } else { "set" };
            let present = if *name == "Float" { "Float" } else { "Int32" };
            let of_session: Function = self.sim.get(format!("{verb}Object{present}Param"))?;
            let (shared, index, told) = (self.shared.clone(), self.index, told.clone());
            self.add(&format!("{verb}Object{name}Parameter"), move |_, arguments: MultiValue| {
                let mut results = match of_session.call::<MultiValue>(arguments) {
                    Err(error) if is_old && is_of_no_parameter(&error) => {
                        let message = crate::fault::words(&error).0;
                        let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
                        if told.len() < MAX_LACKING_TOLD && told.insert(message.clone()) {
                            shared.say(index, format!("{message}; the result is 0, as in V-REP"));
                        }
                        return Ok(MultiValue::from_iter([LuaValue::Integer(0)]));
                    }
                    results => results?,
                };
                if is_getter {
                    results.push_front(LuaValue::Integer(1));
                }
                Ok(results)
            })?;
        }
        Ok(())
    }
}

/// Returns true if an object is refused a parameter because it has none of that number, or is of another kind.
fn is_of_no_parameter(error: &Error) -> bool {
    let message = crate::fault::words(error).0;
    message.contains(" object parameter ") || message.contains("` is no ")
}

/// Returns true if the first argument is the parameter of the mode of errors (`sim.intparam_error_report_mode`).
fn names_errors(arguments: &MultiValue) -> bool {
    arguments.front().and_then(LuaValue::as_integer) == Some(0)
}

/// Returns true if a value is a number that is not finite, or has one in it.
fn has_not_finite(value: &Value) -> bool {
    match value {
        Value::Real(x) => !x.is_finite(),
        Value::List(list) => list.iter().any(has_not_finite),
        Value::Map(map) => map.iter().any(|(_, value)| has_not_finite(value)),
        _ => false,
    }
}

/// The object of a name, by V-REP's rule for scripts: a name without `#` means the one that has the suffix of the
/// script's own object, if there is one.
fn object_of_name(sim: &mut sincro_coppelia::api::SimApi<'_>, own: Handle, name: &str) -> Result<Handle, ApiError> {
    let search = Search { from: Some(own), ..Search::default() };
    let is_plain = !name.contains('#') && !name.starts_with(['/', '.', ':']);
    let registry = &sim.registry;
    if is_plain && let Ok(entry) = registry.entry(own) {
        let place = || registry.entries().filter(|e| e.name == entry.name).position(|e| e.handle == own);
        let number = entry.name.rsplit_once('#').and_then(|(_, digits)| digits.parse::<usize>().ok());
        if let Some(k) = number.or_else(|| place()?.checked_sub(1))
            && let Ok(found) = registry.find(&format!("{name}#{k}"), search)
        {
            return Ok(found);
        }
    }
    registry.find(name, search)
}

/// Returns true if a script finds objects as those before CoppeliaSim 4.3 did, and not as later ones do.
fn is_of_old_names(text: &str) -> bool {
    text.contains("etObjectHandle(") && !text.contains("sim.getObject(")
}

/// A refusal as an error of Lua.
fn refused(name: &str, ApiError(message): &ApiError) -> Error {
    Error::RuntimeError(format!("{message} (in function 'sim.{name}')"))
}

fn named(name: &str, error: Error) -> Error {
    Error::RuntimeError(format!("{} (in function 'sim.{name}')", crate::fault::words(&error).0))
}

/// Functions that are not here, as such that say why.
fn absent(context: &ApiContext<'_>) -> mlua::Result<()> {
    for name in functions::absent() {
        if context.sim.get::<Option<Function>>(name)?.is_none() {
            let why = functions::why_absent(name).unwrap_or_default();
            let message = format!("sim.{name} is not offered: {why}");
            context
                .add(name, move |_, _: MultiValue| -> mlua::Result<()> { Err(Error::RuntimeError(message.clone())) })?;
        }
    }
    Ok(())
}

/// Numbers by name: `sim.x` and `sim_x`.
fn constants_of(context: &ApiContext<'_>) -> mlua::Result<()> {
    let globals = context.lua.globals();
    for (name, value) in constants::constants() {
        context.sim.set(name, value)?;
        globals.set(format!("sim_{name}"), value)?;
    }
    for (name, number) in CALL_TYPES {
        let old = if name == "init" { "initialization" } else { name };
        context.sim.set(format!("syscb_{name}"), number)?;
        globals.set(format!("sim_syscb_{name}"), number)?;
        for kind in ["child", "main", "customization"] {
            context.sim.set(format!("{kind}scriptcall_{old}"), number)?;
            globals.set(format!("sim_{kind}scriptcall_{old}"), number)?;
        }
        // V-REP had these names for customization scripts
        if matches!(name, "actuation" | "sensing") {
            context.sim.set(format!("customizationscriptcall_simulation{name}"), number)?;
            globals.set(format!("sim_customizationscriptcall_simulation{name}"), number)?;
        }
    }
    Ok(())
}

/// The value of a signal of any kind, for those who wait for it.
pub(crate) fn signal(lua: &Lua, shared: &Shared, own: Handle, name: &str) -> mlua::Result<LuaValue> {
    let found = shared.with_sim(own, |sim| {
        let registry = &sim.registry;
        let integer = registry.integers.get(name).map(|x| Value::Int(*x));
        let float = || registry.floats.get(name).map(|x| Value::Real(*x));
        let text = || registry.strings.get(name).map(|x| Value::Bytes(x.clone()));
        Ok(integer.or_else(float).or_else(text))
    });
    match found.map_err(|error| refused("waitForSignal", &error))? {
        Some(value) => convert::to_lua(lua, &value),
        None => Ok(LuaValue::Nil),
    }
}
