//! Functions that move something and wait until it is there, and their single steps with functions to call back:
//! `moves.lua`, over the session's own.

use mlua::{Error, Function, MultiValue, Table};
use sincro_coppelia::api::{ApiError, functions};

use super::ApiContext;
use crate::convert;
use crate::sandbox::Waits;

pub(super) fn offer(context: &ApiContext<'_>, waits: &Waits) -> mlua::Result<()> {
    let lua = context.lua;
    let host = lua.create_table()?;
    let names = lua.create_table()?;
    for (name, _, this) in functions::MOVES {
        names.set(*name, this.stem())?;
        if !host.contains_key(this.stem())? {
            let steps = lua.create_table()?;
            for step in ["init", "step", "cleanup"] {
                let own: Function = context.sim.get(format!("{}_{step}", this.stem()))?;
                steps.set(step, own)?;
            }
            host.set(this.stem(), steps)?;
        }
    }
    host.set("names", names)?;
    host.set("switch", &waits.switch)?;
    let stepping: Function = context.sim.get("setStepping")?;
    host.set("stepping", stepping)?;
    host.set("sim", &context.sim)?;
    let along = lua.create_table()?;
    for (name, function) in
        [("length", "getPathLength"), ("position", "getPositionOnPath"), ("orientation", "getOrientationOnPath")]
    {
        along.set(name, context.sim.get::<Function>(function)?)?;
    }
    host.set("path", along)?;
    let coroutine: Table = lua.globals().get("coroutine")?;
    let yieldable: Function = coroutine.get("isyieldable")?;
    host.set("yieldable", yieldable)?;
    let (shared, own) = (context.shared.clone(), context.own);
    let parameters = lua.create_function(move |lua, (name, given): (String, MultiValue)| {
        let this = known(&name)?;
        let given = convert::list_from_lua(given).map_err(|error| super::named(&name, error))?;
        let map = shared.with_sim(own, |sim| this.parameters(sim, &given));
        convert::to_lua(lua, &map.map_err(|error: ApiError| super::refused(&name, &error))?)
    })?;
    host.set("parameters", parameters)?;
    let results = lua.create_function(move |lua, (name, data): (String, mlua::Value)| {
        let values = known(&name)?.results(&convert::from_lua(data)?);
        convert::list_to_lua(lua, &values)
    })?;
    host.set("results", results)?;
    let functions: Table = lua.load(include_str!("../moves.lua")).set_name(crate::sandbox::OWN_SOURCE).call(host)?;
    for pair in functions.pairs::<String, Function>() {
        let (name, function) = pair?;
        context.put(&name, function.clone())?;
        // as V-REP wrote them
        if let Some(rest) = name.strip_prefix("rml") {
            lua.globals().set(format!("simRML{rest}"), function)?;
        }
    }
    Ok(())
}

fn known(name: &str) -> mlua::Result<functions::Move> {
    functions::Move::of(name).ok_or_else(|| Error::RuntimeError(format!("there is no motion sim.{name}")))
}
