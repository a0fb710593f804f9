//! Functions of CoppeliaSim's own Lua library and of V-REP 3 that are made of others: `helpers.lua`.

use mlua::{Function, Table};

use super::ApiContext;

pub(super) fn offer(context: &ApiContext<'_>) -> mlua::Result<()> {
    let text = include_str!("../helpers.lua");
    let functions: Table = context.lua.load(text).set_name(crate::sandbox::OWN_SOURCE).call(&context.sim)?;
    for pair in functions.pairs::<String, Function>() {
        let (name, function) = pair?;
        context.put(&name, function)?;
    }
    Ok(())
}
