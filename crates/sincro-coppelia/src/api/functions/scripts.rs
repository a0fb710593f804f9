//! Functions: scripts that are added, changed and taken away. A script is named by the handle that `addScript` gives,
//! or by its object.

use super::{Function, done, one, plain};
use crate::api::{ApiError, Arguments, Handle, SimApi};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "addScript",
        tip: "int scriptHandle=sim.addScript(int scriptType)",
        run: |sim, a| one(sim.add_script(a.int(0)?)?),
    },
    Function {
        name: "createScript",
        tip: "int scriptHandle=sim.createScript(int scriptType,string scriptText,int options=0,string lang='')",
        run: |sim, a| {
            let (script_type, text) = (a.int(0)?, a.text(1)?);
            let is_lua = !a.has(3) || matches!(a.text(3)?, "" | "lua");
            if !is_lua {
                return Err(ApiError(format!("scripts in `{}` are not run: Lua only", a.text(3)?)));
            }
            one(sim.create_script(script_type, text)?)
        },
    },
    Function {
        name: "setScriptText",
        tip: "int result=sim.setScriptText(int scriptHandle,string scriptText)",
        run: |sim, a| {
            sim.set_script_text(a.int(0)?, a.text(1)?)?;
            one(1_i64)
        },
    },
    Function {
        name: "associateScriptWithObject",
        tip: "int result=sim.associateScriptWithObject(int scriptHandle,int associatedObjectHandle)",
        run: |sim, a| {
            let object = object_of(sim, a)?;
            sim.associate_script(a.int(0)?, object)?;
            one(1_i64)
        },
    },
    Function {
        name: "initScript",
        tip: "bool result=sim.initScript(int scriptHandle)",
        run: |sim, a| {
            sim.init_script(a.int(0)?)?;
            one(true)
        },
    },
    Function {
        name: "removeScript",
        tip: "sim.removeScript(int scriptHandle)",
        run: |sim, a| {
            sim.remove_script(a.int(0)?)?;
            done()
        },
    },
];

/// Object of argument 2; none for −1.
pub(super) fn object_of(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Option<Handle>, ApiError> {
    match a.handle(1)? {
        -1 => Ok(None),
        other => plain(sim, other).map(Some),
    }
}
