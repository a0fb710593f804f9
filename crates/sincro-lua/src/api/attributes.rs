//! Attributes of scripts of V-REP 3.

use mlua::{Error, Value as LuaValue};
use sincro_scene::script::Kind;

use super::ApiContext;
use super::scripts::{place_of, unknown};

/// `sim.customizationscriptattribute_activeduringsimulation`.
const ACTIVE_IN_RUNS: i64 = 0;
/// `sim.scriptattribute_executioncount`.
const EXECUTION_COUNT: i64 = 2;
/// `sim.childscriptattribute_automaticcascadingcalls`.
const AUTOMATIC_CALLS: i64 = 3;
/// `sim.scriptattribute_enabled`.
const ENABLED: i64 = 4;
/// `sim.customizationscriptattribute_cleanupbeforesave` and `sim.scriptattribute_debuglevel`: nothing is saved with the
/// state of a script, and nothing is traced.
const WITHOUT_EFFECT: [i64; 2] = [5, 6];
/// `sim.scriptattribute_scripttype`.
const SCRIPT_TYPE: i64 = 7;

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
            ACTIVE_IN_RUNS => Ok(LuaValue::Boolean(shared.activity(k).is_in_runs)),
            ENABLED => Ok(LuaValue::Boolean(shared.activity(k).is_enabled)),
            SCRIPT_TYPE => Ok(LuaValue::Integer(match shared.script(k).kind {
                Kind::Customization => 6,
                Kind::Child => 1,
            })),
            other if WITHOUT_EFFECT.contains(&other) => Ok(LuaValue::Integer(0)),
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
            AUTOMATIC_CALLS => shared.change_cascade(k, |cascade| cascade.is_automatic = is_on(&value)),
            ACTIVE_IN_RUNS => shared.change_activity(k, |activity| activity.is_in_runs = is_on(&value)),
            ENABLED => shared.change_activity(k, |activity| activity.is_enabled = is_on(&value)),
            other if WITHOUT_EFFECT.contains(&other) => {}
            other => return Err(not_offered("setScriptAttribute", other)),
        }
        Ok(1)
    })
}

fn is_on(value: &LuaValue) -> bool {
    !matches!(value, LuaValue::Nil | LuaValue::Boolean(false) | LuaValue::Integer(0))
}

fn not_offered(function: &str, attribute: i64) -> Error {
    Error::RuntimeError(format!(
        "there is no attribute {attribute}: scripts have activeduringsimulation, executioncount, automaticcascadingcalls, \
         enabled and scripttype; their order and threads stand in the scene file (in function 'sim.{function}')"
    ))
}
