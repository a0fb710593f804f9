//! Scripts by their handles: their objects, their parameters.

use std::sync::Arc;

use mlua::{Error, MultiValue, Value as LuaValue};
use sincro_coppelia::api::{ApiError, Handle, check_name};
use sincro_scene::script::Kind;

use super::ApiContext;
use crate::shared::Shared;

/// Handle of the first script: beyond those of objects, below the flags.
pub(super) const FIRST_SCRIPT: i64 = 1_000_000;

/// Parameters of all scripts together.
const MAX_PARAMETERS: usize = 10_000;

const SELF: i64 = -4;
const ALL: i64 = -2;
const TREE: i64 = -6;
const CUSTOMIZATION: i64 = 6;

/// The place of a script, by its own handle, `sim.handle_self`, or its object, which is the script itself in
/// CoppeliaSim 4.7 and later.
pub(super) fn place_of(shared: &Shared, index: usize, handle: i64) -> Option<usize> {
    if handle == SELF {
        return Some(index);
    }
    if (1..FIRST_SCRIPT).contains(&handle) {
        return shared.script_on(Handle(i32::try_from(handle).ok()?), None);
    }
    if let Some((object, kind)) = shared.added_script(handle) {
        return shared.script_on(object, Some(kind));
    }
    let k = usize::try_from(handle.checked_sub(FIRST_SCRIPT)?).ok()?;
    shared.has(k).then_some(k)
}

fn handle_of_place(k: usize) -> i64 {
    FIRST_SCRIPT + k as i64
}

pub(super) fn unknown(handle: i64, function: &str) -> Error {
    Error::RuntimeError(format!("there is no script with the handle {handle} (in function 'sim.{function}')"))
}

fn kind_of(script_type: i64) -> Kind {
    if script_type == CUSTOMIZATION { Kind::Customization } else { Kind::Child }
}

pub(super) fn offer(context: &ApiContext<'_>) -> mlua::Result<()> {
    let (shared, index) = (context.shared.clone(), context.index);
    context.add("getObjectAssociatedWithScript", move |_, script: i64| {
        let k = place_of(&shared, index, script).ok_or_else(|| unknown(script, "getObjectAssociatedWithScript"))?;
        Ok(shared.object(k).0)
    })?;
    for (name, kind) in [
        ("getScriptAssociatedWithObject", Kind::Child),
        ("getCustomizationScriptAssociatedWithObject", Kind::Customization),
    ] {
        let (shared, own) = (context.shared.clone(), context.own);
        context.add(name, move |_, object: i32| {
            let object = if object == -4 { own } else { Handle(object) };
            Ok(shared.script_on(object, Some(kind)).map_or(-1, handle_of_place))
        })?;
    }
    let (shared, own) = (context.shared.clone(), context.own);
    context.add("getScript", move |_, (script_type, object): (i64, Option<LuaValue>)| {
        let object = match object {
            None | Some(LuaValue::Nil) => own,
            Some(LuaValue::String(path)) => {
                let path = path.to_string_lossy();
                let found = shared.with_sim(own, |sim| super::object_of_name(sim, own, &path));
                found.map_err(|error| super::refused("getScript", &error))?
            }
            Some(LuaValue::Integer(SELF)) => own,
            Some(LuaValue::Integer(h)) => Handle(i32::try_from(h).unwrap_or(-1)),
            Some(_) => return Err(Error::RuntimeError("argument 2 is no handle (in function 'sim.getScript')".into())),
        };
        Ok(shared.script_on(object, Some(kind_of(script_type))).map_or(-1, handle_of_place))
    })?;
    let shared = context.shared.clone();
    context.add("getScriptHandle", move |_, name: Option<String>| {
        let found = match name {
            None => Some(index),
            Some(name) => shared.find(|s| s.path.rsplit('/').next() == name.split('#').next()),
        };
        Ok(found.map_or(-1, handle_of_place))
    })?;
    let shared = context.shared.clone();
    context.add("getScriptSimulationParameter", move |lua, (script, name, as_text): (i64, String, Option<bool>)| {
        if matches!(script, TREE | ALL) {
            // those of the scripts that have it, in a list
            let list = lua.create_table()?;
            for object in scripts_below(&shared, index, script == TREE) {
                let key = (object, name.clone());
                let text = shared.with_sim(object, |sim| Ok(sim.registry.script_parameters.get(&key).cloned()));
                if let Some(text) = text.map_err(|error| super::refused("getScriptSimulationParameter", &error))? {
                    list.push(if as_text == Some(true) {
                        LuaValue::String(lua.create_string(text)?)
                    } else {
                        value_of(lua, &text)?
                    })?;
                }
            }
            return Ok(if list.is_empty() { LuaValue::Nil } else { LuaValue::Table(list) });
        }
        let script = object_with(&shared, index, script, "getScriptSimulationParameter")?;
        let found =
            shared.with_sim(script, |sim| Ok(sim.registry.script_parameters.get(&(script, name.clone())).cloned()));
        let text = found.map_err(|error| super::refused("getScriptSimulationParameter", &error))?;
        let Some(text) = text else { return Ok(LuaValue::Nil) };
        if as_text == Some(true) { lua.create_string(text).map(LuaValue::String) } else { value_of(lua, &text) }
    })?;
    let shared = context.shared.clone();
    context.add("setScriptSimulationParameter", move |lua, (script, name, value): (i64, String, LuaValue)| {
        let objects = match script {
            TREE | ALL => scripts_below(&shared, index, script == TREE),
            script => vec![object_with(&shared, index, script, "setScriptSimulationParameter")?],
        };
        let text = match &value {
            LuaValue::Boolean(truth) => truth.to_string(),
            LuaValue::Nil => "nil".to_owned(),
            other => lua.coerce_string(other.clone())?.map(|text| text.to_string_lossy()).ok_or_else(|| {
                let what = other.type_name();
                Error::RuntimeError(format!(
                    "argument 3 is a {what}, expected text (in function 'sim.setScriptSimulationParameter')"
                ))
            })?,
        };
        let own = shared.object(index);
        let done = shared.with_sim(own, |sim| {
            let parameters = &mut sim.registry.script_parameters;
            let mut n_set = 0;
            for object in &objects {
                let key = (*object, name.clone());
                let is_known = parameters.contains_key(&key);
                // of several scripts, those that have it
                if !is_known && matches!(script, TREE | ALL) {
                    continue;
                }
                if parameters.len() >= MAX_PARAMETERS && !is_known {
                    return Err(ApiError(format!("there are {MAX_PARAMETERS} parameters already")));
                }
                check_name("parameter", &name)?;
                parameters.insert(key, text.clone());
                n_set += 1;
            }
            Ok(n_set)
        });
        done.map_err(|error| super::refused("setScriptSimulationParameter", &error))
    })?;
    for name in ["setScriptText", "associateScriptWithObject", "initScript", "removeScript"] {
        // these know scripts that were added, and others by their objects
        let of_session: mlua::Function = context.sim.get(name)?;
        let shared = context.shared.clone();
        context.add(name, move |_, (script, rest): (i64, MultiValue)| {
            let is_own = script == SELF || (script >= FIRST_SCRIPT && shared.added_script(script).is_none());
            let place = if is_own { place_of(&shared, index, script) } else { None };
            let script = place.map_or(script, |place| i64::from(shared.object(place).0));
            of_session.call::<MultiValue>((script, rest))
        })?;
    }
    let shared = context.shared.clone();
    context.add("getScriptName", move |_, script: i64| {
        if let Some(k) = place_of(&shared, index, script) {
            return Ok(shared.script(k).path.rsplit('/').next().unwrap_or_default().to_owned());
        }
        // one that was added and has not begun yet has the name of its object, too
        let (object, _) = shared.added_script(script).ok_or_else(|| unknown(script, "getScriptName"))?;
        let name = shared.with_sim(object, |sim| Ok(sim.registry.entry(object)?.name.clone()));
        name.map_err(|error| super::refused("getScriptName", &error))
    })?;
    let shared = context.shared.clone();
    context.add("isScriptExecutionThreaded", move |_, ()| Ok(i64::from(shared.script(index).is_threaded)))?;
    // a script's suffix is that of its object
    context.add("setNameSuffix", |_, _: LuaValue| Ok(-1))?;
    context.add("getStackTraceback", |lua, _: Option<LuaValue>| {
        let trace: mlua::Function = lua.globals().get::<mlua::Table>("debug")?.get("traceback")?;
        trace.call::<LuaValue>(())
    })?;
    let shared = context.shared.clone();
    context.add("getNameSuffix", move |_, name: Option<String>| {
        let is_own = name.is_none();
        let object = shared.object(index);
        let own = || shared.with_sim(object, |sim| Ok(sim.registry.entry(object)?.name.clone()));
        let name = name.map_or_else(own, Ok).map_err(|error| super::refused("getNameSuffix", &error))?;
        let parts = name.rsplit_once('#').and_then(|(stem, digits)| Some((stem, digits.parse::<i64>().ok()?)));
        Ok(match parts {
            Some((stem, suffix)) => (suffix, (!is_own).then(|| stem.to_owned())),
            None => (-1, (!is_own).then_some(name)),
        })
    })
}

/// Objects of all scripts, or of those on the script's own object and below.
fn scripts_below(shared: &Arc<Shared>, index: usize, in_tree: bool) -> Vec<Handle> {
    let own = shared.object(index);
    let tree = shared.with_sim(own, |sim| Ok(sim.registry.visible_tree(own))).unwrap_or_default();
    let mut all = shared.objects();
    all.retain(|object| !in_tree || tree.contains(object));
    all.sort_unstable();
    all.dedup();
    all
}

/// The object whose parameters are meant: that of a script, by the script's handle or its own.
fn object_with(shared: &Arc<Shared>, index: usize, handle: i64, function: &str) -> mlua::Result<Handle> {
    let of_script = place_of(shared, index, handle).map(|k| shared.object(k));
    let of_object = || i32::try_from(handle).ok().map(Handle).filter(|h| shared.script_on(*h, None).is_some());
    of_script.or_else(of_object).ok_or_else(|| unknown(handle, function))
}

/// Value of a stored text: nil, false, true, a number, else the text.
fn value_of(lua: &mlua::Lua, text: &str) -> mlua::Result<LuaValue> {
    match text {
        "nil" => return Ok(LuaValue::Nil),
        "true" => return Ok(LuaValue::Boolean(true)),
        "false" => return Ok(LuaValue::Boolean(false)),
        _ => {}
    }
    let string = LuaValue::String(lua.create_string(text)?);
    if let Ok(n) = text.parse::<i64>() {
        return Ok(LuaValue::Integer(n));
    }
    Ok(match lua.coerce_number(string.clone())? {
        Some(x) => LuaValue::Number(x),
        None => string,
    })
}
