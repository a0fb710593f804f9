//! Attributes of scripts of V-REP 3, and the calls of the scripts below one.
//!
//! V-REP 3.1.3 wrote lines around each older script that switch off the calls of the scripts below it, make them by
//! `simHandleChildScripts`, and count the calls of the script itself. Here each step calls every script once in a
//! phase, whoever asks for that.

use mlua::{Error, MultiValue, Value as LuaValue};

use super::ApiContext;
use super::scripts::{place_of, scripts_below, unknown};

/// `sim.scriptattribute_executioncount`.
const EXECUTION_COUNT: i64 = 2;
/// `sim.childscriptattribute_automaticcascadingcalls`.
const AUTOMATIC_CALLS: i64 = 3;

const SELF: i64 = -4;

pub(super) fn offer(context: &ApiContext<'_>) -> mlua::Result<()> {
    let (shared, index) = (context.shared.clone(), context.index);
    context.add("getScriptExecutionCount", move |_, script: Option<i64>| {
        let script = script.unwrap_or(SELF);
        let k = place_of(&shared, index, script).ok_or_else(|| unknown(script, "getScriptExecutionCount"))?;
        Ok(shared.execution_count(k))
    })?;
    let shared = context.shared.clone();
    context.add("getScriptAttribute", move |_, (script, attribute): (i64, i64)| {
        let k = place_of(&shared, index, script).ok_or_else(|| unknown(script, "getScriptAttribute"))?;
        match attribute {
            EXECUTION_COUNT => Ok(LuaValue::Integer(shared.execution_count(k))),
            AUTOMATIC_CALLS => Ok(LuaValue::Boolean(true)),
            other => Err(not_offered("getScriptAttribute", other)),
        }
    })?;
    let shared = context.shared.clone();
    context.add("setScriptAttribute", move |_, (script, attribute, value): (i64, i64, LuaValue)| {
        let k = place_of(&shared, index, script).ok_or_else(|| unknown(script, "setScriptAttribute"))?;
        match attribute {
            EXECUTION_COUNT => {
                let count = value.as_integer().ok_or_else(|| {
                    let what = value.type_name();
                    Error::RuntimeError(format!(
                        "argument 3 is a {what}, expected a whole number (in function 'sim.setScriptAttribute')"
                    ))
                })?;
                shared.set_execution_count(k, count);
            }
            AUTOMATIC_CALLS => {}
            other => return Err(not_offered("setScriptAttribute", other)),
        }
        Ok(1)
    })?;
    let (shared, own) = (context.shared.clone(), context.own);
    context.add("handleChildScripts", move |_, arguments: MultiValue| {
        if arguments.len() > 1 {
            return Err(Error::RuntimeError(
                "the scripts below are called by the step itself, without arguments: set signals for them \
                 (in function 'sim.handleChildScripts')"
                    .to_owned(),
            ));
        }
        Ok(scripts_below(&shared, index, true).iter().filter(|object| **object != own).count())
    })
}

fn not_offered(function: &str, attribute: i64) -> Error {
    Error::RuntimeError(format!(
        "there is no attribute {attribute}: scripts have executioncount and automaticcascadingcalls, their order and \
         threads stand in the scene file (in function 'sim.{function}')"
    ))
}
