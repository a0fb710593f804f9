//! Modules beside `sim`: `simIK`, `simUI`, `simRemoteApi` and `messagePack`, by `require` and as globals.

use mlua::{Error, Function, MultiValue, Table, Value as LuaValue};
use sincro_coppelia::api::functions;

use super::ApiContext;

/// Ports of the legacy API; V-REP takes negative numbers for shared memory.
const PORTS: std::ops::RangeInclusive<i64> = 1..=65_535;

pub(super) fn offer(context: &ApiContext<'_>) -> mlua::Result<()> {
    let lua = context.lua;
    let modules = lua.create_table()?;
    modules.set("sim", &context.sim)?;
    modules.set("simIK", inverse_kinematics(context)?)?;
    modules.set("simUI", interfaces(context)?)?;
    modules.set("simRemoteApi", remote_api(context)?)?;
    let pack: Table = lua.load(include_str!("../message_pack.lua")).set_name("=sincro").call(())?;
    modules.set("messagePack", &pack)?;
    modules.set("MessagePack", pack)?;
    let require = lua.create_function(move |_, name: String| {
        let (plain, version) = name.split_once('-').unwrap_or((&name, "1"));
        if version.parse::<u32>().is_ok()
            && let Some(module) = modules.get::<Option<Table>>(plain)?
        {
            return Ok(module);
        }
        Err(Error::RuntimeError(format!(
            "there is no module '{name}': scripts have `sim`, `simIK`, `simUI`, `simRemoteApi` and `messagePack`, and load no files"
        )))
    })?;
    lua.globals().set("require", require)
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
    context.lua.load(include_str!("../ik.lua")).set_name("=sincro").call::<()>(&module)?;
    context.lua.globals().set("simIK", &module)?;
    Ok(module)
}

/// The table `simUI`.
fn interfaces(context: &ApiContext<'_>) -> mlua::Result<Table> {
    let module = context.lua.create_table()?;
    for function in functions::ui_functions() {
        module.set(function.name, context.of_session("simUI", function)?)?;
    }
    context.lua.globals().set("simUI", &module)?;
    Ok(module)
}

/// The table `simRemoteApi`: `start(port)` has a port of the legacy API opened, where clients are served.
fn remote_api(context: &ApiContext<'_>) -> mlua::Result<Table> {
    let (lua, globals) = (context.lua, context.lua.globals());
    let module = lua.create_table()?;
    let (shared, own, index) = (context.shared.clone(), context.own, context.index);
    let start = lua.create_function(move |_, (port, _): (i64, MultiValue)| {
        let Some(port) = Some(port).filter(|port| PORTS.contains(port)).and_then(|port| u16::try_from(port).ok())
        else {
            let message = format!("port {port}: expected 1 to 65535; there is no shared memory");
            return Err(Error::RuntimeError(format!("{message} (in function 'simRemoteApi.start')")));
        };
        let asked = shared.with_sim(own, |sim| Ok(sim.registry.ask_port(port)));
        if asked.map_err(|error| super::refused("simRemoteApi.start", &error))? {
            return Ok(1);
        }
        shared
            .say(index, format!("port {port} is not opened: nothing is served in this run (`sincro serve` opens it)"));
        Ok(-1)
    })?;
    let known = lua.create_function(|_, _: MultiValue| Ok(1))?;
    // no client is known here: nothing is told but that the service is there
    let status = lua.create_function(|_, _: LuaValue| Ok((1, LuaValue::Nil, LuaValue::Nil, 11)))?;
    for (name, old, function) in [
        ("start", "simExtRemoteApiStart", start),
        ("stop", "simExtRemoteApiStop", known.clone()),
        ("reset", "simExtRemoteApiReset", known),
        ("status", "simExtRemoteApiStatus", status),
    ] {
        module.set(name, &function)?;
        globals.set(old, function)?;
    }
    globals.set("simRemoteApi", &module)?;
    Ok(module)
}
