//! The table `simOMPL`: path planning, also with a function of the script that says which states are good.

use mlua::{Error, Function, Lua, MultiValue, Table, Value as LuaValue};
use sincro_coppelia::api::paths::{Scene, checks_in, ends, names};
use sincro_coppelia::api::{ApiError, functions};

use super::ApiContext;

/// Instructions that a state counts as, beside those of the function.
const COST: u64 = 20;

/// The module, with its names of V-REP 3 as globals.
pub(super) fn module(context: &ApiContext<'_>) -> mlua::Result<Table> {
    let lua = context.lua;
    let module = lua.create_table()?;
    for function in functions::planning_functions() {
        module.set(function.name, context.of_session("simOMPL", function)?)?;
    }
    for (table, constants) in names::tables() {
        let own = lua.create_table()?;
        for (name, number) in constants {
            own.set(name, number)?;
            lua.globals().set(format!("sim_ompl_{}_{name}", table.to_ascii_lowercase()), number)?;
        }
        module.set(table, own)?;
    }
    let (shared, own, guard) = (context.shared.clone(), context.own, context.guard.clone());
    type Search = (i64, String, f64, Function);
    let search = lua.create_function(move |lua, (handle, step, seconds, check): Search| {
        let refused =
            |ApiError(message): ApiError| Error::RuntimeError(format!("{message} (in function 'simOMPL.{step}')"));
        let is_solve = step == "solve";
        // no Lua runs while the simulation is held: the task is taken out of it for the search
        let taken = shared.with_sim(own, |sim| {
            let start = if is_solve { ends(sim, handle)? } else { Vec::new() };
            Ok((start, sim.tasks().task(handle)?.clone()))
        });
        let (start, mut task) = taken.map_err(refused)?;
        let mut is_good = |state: &[f64]| {
            guard.charge(lua, COST)?;
            let answer: LuaValue = check.call(lua.create_sequence_from(state.iter().copied())?)?;
            Ok::<bool, Error>(!matches!(answer, LuaValue::Nil | LuaValue::Boolean(false) | LuaValue::Integer(0)))
        };
        let found = match is_solve {
            true => task.solve(&start, checks_in(seconds), &mut is_good),
            false => task.simplify(checks_in(seconds), &mut is_good).map(|()| true),
        }?;
        guard.charge(lua, COST * task.take_checks() as u64)?;
        let put_back = |sim: &mut sincro_coppelia::api::SimApi<'_>| {
            *sim.tasks().task(handle)? = task;
            Ok(())
        };
        shared.with_sim(own, put_back).map_err(refused)?;
        Ok(found)
    })?;
    let own_text = lua.load(include_str!("../ompl.lua")).set_name(crate::sandbox::OWN_SOURCE);
    own_text.call::<()>((&module, super::modules::callback(lua)?, search))?;
    // the first is here
    for (name, why) in functions::absent_planning_functions().skip(1) {
        let message = format!("simOMPL.{name} is not offered: {why}");
        let refuse = move |_: &Lua, _: MultiValue| -> mlua::Result<()> { Err(Error::RuntimeError(message.clone())) };
        let refuse = lua.create_function(refuse)?;
        lua.globals().set(format!("simExtOMPL_{name}"), &refuse)?;
        module.set(name, refuse)?;
    }
    lua.globals().set("simOMPL", &module)?;
    Ok(module)
}
