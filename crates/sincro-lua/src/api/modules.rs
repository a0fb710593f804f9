//! Modules beside `sim`: `simIK`, `simOMPL`, `simUI`, `simVision`, `simROS`, `simROS2`, `simB0`, `simRemoteApi`,
//! `messagePack`, `dkjson` and `matrix`, by `require` and, but for `dkjson`, as globals; files of the scene that a
//! script is given, by `require`.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use mlua::chunk::ChunkMode;
use mlua::{Error, Function, MultiValue, Table, Value as LuaValue};
use sincro_coppelia::api::functions;

use super::{ApiContext, planning, ros, vision};
use crate::{older_names, power, sandbox};

/// Libraries of Lua, which are modules, too.
const LIBRARIES: [&str; 9] = ["_G", "coroutine", "debug", "io", "math", "os", "string", "table", "utf8"];

pub(super) fn offer(context: &ApiContext<'_>) -> mlua::Result<()> {
    let lua = context.lua;
    let modules = lua.create_table()?;
    modules.set("sim", &context.sim)?;
    modules.set("simIK", inverse_kinematics(context)?)?;
    modules.set("simOMPL", planning::module(context)?)?;
    modules.set("simUI", interfaces(context)?)?;
    modules.set("simVision", vision::module(context)?)?;
    modules.set("simRemoteApi", remote_api(context)?)?;
    let [ros, ros2, b0] = ros::modules(context)?;
    modules.set("simROS", ros)?;
    modules.set("simROS2", ros2)?;
    modules.set("simB0", b0)?;
    let pack: Table = lua.load(include_str!("../message_pack.lua")).set_name(crate::sandbox::OWN_SOURCE).call(())?;
    modules.set("messagePack", &pack)?;
    modules.set("MessagePack", pack)?;
    let json: Table = lua.load(include_str!("../json.lua")).set_name(crate::sandbox::OWN_SOURCE).call(())?;
    modules.set("dkjson", &json)?;
    modules.set("json", json)?;
    let matrix: Table =
        lua.load(include_str!("../matrix.lua")).set_name(crate::sandbox::OWN_SOURCE).call(&context.sim)?;
    for pair in matrix.pairs::<String, Table>() {
        let (name, class) = pair?;
        lua.globals().set(name, class)?;
    }
    modules.set("matrix", matrix)?;
    let environment: Function =
        lua.load(include_str!("../environment.lua")).set_name(crate::sandbox::OWN_SOURCE).call(())?;
    let (script, guard) = (context.shared.script(context.index), context.guard.clone());
    // files whose text is running: one of them that is asked for again is a loop
    let loading = Mutex::new(BTreeSet::<String>::new());
    let require = lua.create_function(move |lua, name: String| {
        let package: Table = lua.globals().get("package")?;
        let loaded: Table = package.get("loaded")?;
        let known: LuaValue = loaded.get(&*name)?;
        if !known.is_nil() {
            return Ok(known);
        }
        let spellings = [format!("{name}.lua"), format!("{}.lua", name.replace('.', "/")), name.clone()];
        let file = spellings.iter().find_map(|name| script.files.iter().find(|(known, _)| known == name));
        let Some((file, source)) = file else {
            if let Some(given) = package.get::<Table>("preload")?.get::<Option<Function>>(&*name)? {
                let module: LuaValue = given.call(&*name)?;
                loaded.set(&*name, &module)?;
                return Ok(module);
            }
            let (plain, version) = name.split_once('-').unwrap_or((&name, "1"));
            if version.parse::<u32>().is_ok()
                && let Some(module) = modules.get::<Option<Table>>(plain)?
            {
                return Ok(LuaValue::Table(module));
            }
            if LIBRARIES.contains(&&*name) {
                return lua.globals().get(name);
            }
            return Err(Error::RuntimeError(format!(
                "there is no module '{name}': scripts have `sim`, `simIK`, `simOMPL`, `simUI`, `simVision`, `simROS`, `simROS2`, `simB0`, `simRemoteApi`, `messagePack`, `dkjson` and `matrix`; a file of the scene's folder that stands under `files` of the script is one, too: files = [\"{name}.lua\"]"
            )));
        };
        let files = || loading.lock().unwrap_or_else(PoisonError::into_inner);
        if files().contains(file) {
            return Err(Error::RuntimeError(format!(
                "loop of modules: `{file}` is asked for while it is being loaded; call `require` of it within the function that needs it"
            )));
        }
        sandbox::charge_text(lua, &guard, &source.text)?;
        let text = power::with_calls(&older_names::renamed(&source.text));
        let is_old = text.contains("module");
        let chunk = lua.load(text).set_name(format!("={file}")).set_mode(ChunkMode::Text);
        let chunk = if is_old { chunk.set_environment(environment.call::<Table>(())?) } else { chunk };
        files().insert(file.clone());
        let module = chunk.call::<LuaValue>(&*name);
        files().remove(file);
        let module = module?;
        // as in Lua: what a file leaves under its name counts, then what it returns, then true
        let module = if module.is_nil() { loaded.get(&*name)? } else { module };
        let module = if module.is_nil() { LuaValue::Boolean(true) } else { module };
        loaded.set(&*name, &module)?;
        Ok(module)
    })?;
    let package = lua.create_table()?;
    package.set("loaded", lua.create_table()?)?;
    package.set("preload", lua.create_table()?)?;
    // where scripts add folders to: modules are found by their names in the scene alone
    package.set("path", "./?.lua")?;
    package.set("cpath", "")?;
    package.set("seeall", lua.create_function(|_, _: MultiValue| Ok(()))?)?;
    let refused = |_: &mlua::Lua, _: MultiValue| -> mlua::Result<()> {
        Err(Error::RuntimeError("package.loadlib is not allowed: scripts load no programs".into()))
    };
    package.set("loadlib", lua.create_function(refused)?)?;
    lua.globals().set("package", package)?;
    lua.globals().set("require", require)
}

/// The Lua function that finds callbacks by their names.
pub(super) fn callback(lua: &mlua::Lua) -> mlua::Result<Function> {
    lua.load(include_str!("../callback.lua")).set_name(crate::sandbox::OWN_SOURCE).call(())
}

/// The table `simIK`.
fn inverse_kinematics(context: &ApiContext<'_>) -> mlua::Result<Table> {
    let module = context.lua.create_table()?;
    for function in functions::ik_functions() {
        module.set(function.name, context.of_session("simIK", function)?)?;
    }
    for (old, present) in functions::old_ik_names() {
        module.set(old, module.get::<Function>(present)?)?;
    }
    for (name, value) in functions::ik::CONSTANTS {
        module.set(*name, *value)?;
    }
    // validation callbacks cannot leave the script
    context
        .lua
        .load(include_str!("../ik.lua"))
        .set_name(crate::sandbox::OWN_SOURCE)
        .call::<()>((&module, callback(context.lua)?))?;
    context.lua.globals().set("simIK", &module)?;
    Ok(module)
}

/// The table `simUI`.
fn interfaces(context: &ApiContext<'_>) -> mlua::Result<Table> {
    let module = context.lua.create_table()?;
    for function in functions::ui_functions() {
        let called = context.of_session("simUI", function)?;
        // the name of V-REP 3.3 and 3.4
        context.lua.globals().set(format!("simExtCustomUI_{}", function.name), &called)?;
        module.set(function.name, called)?;
    }
    context.lua.globals().set("simUI", &module)?;
    Ok(module)
}

/// A port of the legacy API, as an argument of one of the functions of `simRemoteApi`.
fn port_of(port: i64, function: &str) -> mlua::Result<u16> {
    u16::try_from(port).ok().filter(|port| *port != 0).ok_or_else(|| {
        let message = format!("port {port}: expected 1 to 65535; there is no shared memory");
        Error::RuntimeError(format!("{message} (in function 'simRemoteApi.{function}')"))
    })
}

/// The table `simRemoteApi`: `start(port, maxPacketSize, debug, preEnableTrigger)` has a port of the legacy API opened,
/// where clients are served. A port is closed when the server ends, not before.
fn remote_api(context: &ApiContext<'_>) -> mlua::Result<Table> {
    let (lua, globals) = (context.lua, context.lua.globals());
    let module = lua.create_table()?;
    let (shared, own, index) = (context.shared.clone(), context.own, context.index);
    type Start = (i64, LuaValue, LuaValue, LuaValue);
    let start = lua.create_function(move |_, (port, _, _, trigger): Start| {
        let port = port_of(port, "start")?;
        let has_trigger = !matches!(trigger, LuaValue::Nil | LuaValue::Boolean(false) | LuaValue::Integer(0));
        let asked = shared.with_sim(own, |sim| Ok(sim.registry.ask_port(port, has_trigger)));
        match asked.map_err(|error| super::refused("simRemoteApi.start", &error))? {
            Ok(()) => Ok(1),
            Err(why) => {
                shared.say(index, format!("port {port} is not opened: {why}"));
                Ok(-1)
            }
        }
    })?;
    let left = |name: &'static str| {
        let shared = context.shared.clone();
        lua.create_function(move |_, (port, _): (i64, MultiValue)| {
            let port = port_of(port, name)?;
            let why = "ports stay as they are until the server ends";
            shared.say(index, format!("simRemoteApi.{name} does nothing to port {port}: {why}"));
            Ok(-1)
        })
    };
    let (stop, reset) = (left("stop")?, left("reset")?);
    let shared = context.shared.clone();
    // clients are not told apart by their ports: whether it is open is all that is known
    let status = lua.create_function(move |_, (port, _): (i64, MultiValue)| {
        let port = port_of(port, "status")?;
        let is_open =
            shared.with_sim(own, |sim| Ok(sim.registry.legacy_ports.as_ref().is_some_and(|all| all.contains(port))));
        let is_open = is_open.map_err(|error| super::refused("simRemoteApi.status", &error))?;
        Ok((if is_open { 1 } else { -1 }, LuaValue::Nil, LuaValue::Nil, 11))
    })?;
    for (name, old, function) in [
        ("start", "simExtRemoteApiStart", start),
        ("stop", "simExtRemoteApiStop", stop),
        ("reset", "simExtRemoteApiReset", reset),
        ("status", "simExtRemoteApiStatus", status),
    ] {
        module.set(name, &function)?;
        globals.set(old, function)?;
    }
    globals.set("simRemoteApi", &module)?;
    Ok(module)
}
