//! Attributes of scripts of V-REP 3.

use mlua::{Error, Value as LuaValue};

use super::ApiContext;
use super::scripts::{place_of, unknown};

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
            AUTOMATIC_CALLS => Ok(LuaValue::Boolean(shared.cascade(k).is_automatic)),
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
            AUTOMATIC_CALLS => {
                let is_off = matches!(value, LuaValue::Nil | LuaValue::Boolean(false) | LuaValue::Integer(0));
                shared.change_cascade(k, |cascade| cascade.is_automatic = !is_off);
            }
            other => return Err(not_offered("setScriptAttribute", other)),
        }
        Ok(1)
    })
}

fn not_offered(function: &str, attribute: i64) -> Error {
    Error::RuntimeError(format!(
        "there is no attribute {attribute}: scripts have executioncount and automaticcascadingcalls, their order and \
         threads stand in the scene file (in function 'sim.{function}')"
    ))
}
