//! Functions: windows of V-REP 3 (custom dialogs, `simGetUIHandle`). There are no windows: each name is that of one,
//! what is set is kept and told again, and nothing is ever pressed.

use super::ui::{keep_value, open_window};
use super::{Function, Outcome, one};
use crate::api::{ApiError, Arguments, SimApi, Value};

/// Handle of the first window.
const FIRST: i64 = 500_000;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "getUIHandle",
        tip: "int uiHandle=sim.getUIHandle(string uiName)",
        run: |sim, a| one(FIRST + open_window(sim, a.text(0)?)?),
    },
    Function {
        name: "getUIEventButton",
        tip: "int buttonHandle,int[2] auxiliaryValues=sim.getUIEventButton(int uiHandle)",
        run: |sim, a| {
            window(sim, a)?;
            Ok(vec![Value::Int(-1), Value::List(vec![Value::Int(0), Value::Int(0)])])
        },
    },
    Function {
        name: "setUIButtonLabel",
        tip: "int result=sim.setUIButtonLabel(int uiHandle,int buttonHandle,string upStateLabel,string downStateLabel=nil)",
        run: |sim, a| keep(sim, a, "label"),
    },
    Function {
        name: "getUIButtonLabel",
        tip: "string label=sim.getUIButtonLabel(int uiHandle,int buttonHandle)",
        run: |sim, a| kept(sim, a, "label", Value::from("")),
    },
    Function {
        name: "setUIButtonProperty",
        tip: "int result=sim.setUIButtonProperty(int uiHandle,int buttonHandle,int buttonProperty)",
        run: |sim, a| keep(sim, a, "property"),
    },
    Function {
        name: "getUIButtonProperty",
        tip: "int buttonProperty=sim.getUIButtonProperty(int uiHandle,int buttonHandle)",
        run: |sim, a| kept(sim, a, "property", Value::Int(0)),
    },
    Function {
        name: "setUISlider",
        tip: "int result=sim.setUISlider(int uiHandle,int buttonHandle,int position)",
        run: |sim, a| keep(sim, a, "slider"),
    },
    Function {
        name: "getUISlider",
        tip: "int position=sim.getUISlider(int uiHandle,int buttonHandle)",
        run: |sim, a| kept(sim, a, "slider", Value::Int(0)),
    },
    shown(
        "setUIButtonColor",
        "int result=sim.setUIButtonColor(int uiHandle,int buttonHandle,float[3] upStateColor,float[3] downStateColor=nil,float[3] labelColor=nil)",
    ),
    shown("setUIProperty", "int result=sim.setUIProperty(int uiHandle,int elementProperty)"),
    shown("setUIPosition", "int result=sim.setUIPosition(int uiHandle,int[2] position)"),
];

/// A function that changes what a window looks like.
const fn shown(name: &'static str, tip: &'static str) -> Function {
    Function {
        name,
        tip,
        run: |sim, a| {
            window(sim, a)?;
            one(1_i64)
        },
    }
}

/// Key of a window among the interfaces.
fn window(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<String, ApiError> {
    let number = a.int(0)?;
    let name = usize::try_from(number - FIRST).ok().and_then(|k| sim.registry.windows.get(k));
    name.map(|name| format!("window {name}")).ok_or_else(|| ApiError(format!("there is no window {number}")))
}

/// Keeps the third argument of a call as a value of a button.
fn keep(sim: &mut SimApi<'_>, a: Arguments<'_>, of: &'static str) -> Outcome {
    let key = (window(sim, a)?, a.int(1)?, of);
    keep_value(sim, key, a.get(2))?;
    one(1_i64)
}

/// Returns a value of a button as it was set, else the default.
fn kept(sim: &mut SimApi<'_>, a: Arguments<'_>, of: &'static str, default: Value) -> Outcome {
    let key = (window(sim, a)?, a.int(1)?, of);
    one(sim.registry.widgets.get(&key).cloned().unwrap_or(default))
}
