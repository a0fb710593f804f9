//! Functions: `simUI`, user interfaces. There are no windows: what is set is kept and told again, and nothing is ever
//! pressed.

use super::{Function, Outcome, done, one};
use crate::api::{ApiError, Arguments, SimApi, Value};

/// Values that a client or script may keep in interfaces.
const MAX_VALUES: usize = 10_000;
/// Interfaces that may exist at once.
const MAX_INTERFACES: usize = 1_000;

/// A function that shows something.
const fn shown(name: &'static str, tip: &'static str) -> Function {
    Function { name, tip, run: |_, _| done() }
}

/// Functions that set and get one value of a widget: names, tips, value before the first setting.
macro_rules! value {
    ($set:literal, $get:literal, $type:literal, $default:expr) => {
        [
            Function {
                name: $set,
                tip: concat!("simUI.", $set, "(string handle,int id,", $type, " value)"),
                run: |d, a| keep(d, a, $get),
            },
            Function {
                name: $get,
                tip: concat!($type, " value=simUI.", $get, "(string handle,int id)"),
                run: |d, a| kept(d, a, $get, $default),
            },
        ]
    };
}

const VALUES: [[Function; 2]; 10] = [
    value!("setEditValue", "getEditValue", "string", Value::Text(String::new())),
    value!("setLabelText", "getLabelText", "string", Value::Text(String::new())),
    value!("setButtonText", "getButtonText", "string", Value::Text(String::new())),
    value!("setText", "getText", "string", Value::Text(String::new())),
    value!("setSliderValue", "getSliderValue", "int", Value::Int(0)),
    value!("setCheckboxValue", "getCheckboxValue", "int", Value::Int(0)),
    value!("setRadiobuttonValue", "getRadiobuttonValue", "int", Value::Int(0)),
    value!("setComboboxSelectedIndex", "getComboboxSelectedIndex", "int", Value::Int(-1)),
    value!("setSpinboxValue", "getSpinboxValue", "float", Value::Real(0.0)),
    value!("setProgress", "getProgress", "int", Value::Int(0)),
];

/// The functions of [`VALUES`], one after the other.
pub(super) const KEPT: &[Function] = VALUES.as_flattened();

/// Functions of `simUI`, named without it.
pub(super) const FUNCTIONS: &[Function] = &[
    Function { name: "create", tip: "string handle=simUI.create(string xml)", run: create },
    Function { name: "destroy", tip: "simUI.destroy(string handle)", run: destroy },
    Function { name: "isVisible", tip: "bool visible=simUI.isVisible(string handle)", run: |_, _| one(false) },
    Function { name: "getTitle", tip: "string title=simUI.getTitle(string handle)", run: title },
    Function { name: "setTitle", tip: "simUI.setTitle(string handle,string title)", run: set_title },
    Function {
        name: "getPosition",
        tip: "int x,int y=simUI.getPosition(string handle)",
        run: |_, _| Ok(vec![Value::Int(0), Value::Int(0)]),
    },
    Function {
        name: "getSize",
        tip: "int width,int height=simUI.getSize(string handle)",
        run: |_, _| Ok(vec![Value::Int(0), Value::Int(0)]),
    },
];

/// Functions of `simUI` that only show something, named without it.
pub(super) const SHOWN: &[Function] = &[
    shown("show", "simUI.show(string handle)"),
    shown("hide", "simUI.hide(string handle)"),
    shown("setPosition", "simUI.setPosition(string handle,int x,int y)"),
    shown("setSize", "simUI.setSize(string handle,int width,int height)"),
    shown("setEnabled", "simUI.setEnabled(string handle,int id,bool enabled)"),
    shown("setWidgetVisibility", "simUI.setWidgetVisibility(string handle,int id,bool visible)"),
    shown("setStyleSheet", "simUI.setStyleSheet(string handle,int id,string css)"),
    shown("setCurrentTab", "simUI.setCurrentTab(string handle,int id,int index)"),
    shown("setImageData", "simUI.setImageData(string handle,int id,buffer data,int width,int height)"),
    shown("setComboboxItems", "simUI.setComboboxItems(string handle,int id,string[] items,int index)"),
    shown("insertComboboxItem", "simUI.insertComboboxItem(string handle,int id,int index,string text)"),
    shown("appendText", "simUI.appendText(string handle,int id,string text)"),
    shown("addCurve", "simUI.addCurve(string handle,int id,int type,string name,int[] color,int style,map options)"),
    shown("addCurveTimePoints", "simUI.addCurveTimePoints(string handle,int id,string name,float[] x,float[] y)"),
    shown(
        "addCurveXYPoints",
        "simUI.addCurveXYPoints(string handle,int id,string name,float[] sequence,float[] x,float[] y)",
    ),
    shown("clearCurve", "simUI.clearCurve(string handle,int id,string name)"),
    shown("removeCurve", "simUI.removeCurve(string handle,int id,string name)"),
    shown("rescaleAxes", "simUI.rescaleAxes(string handle,int id,string name)"),
    shown("rescaleAxesAll", "simUI.rescaleAxesAll(string handle,int id)"),
    shown("replot", "simUI.replot(string handle,int id)"),
    shown("setMouseOptions", "simUI.setMouseOptions(string handle,int id,bool panX,bool panY,bool zoomX,bool zoomY)"),
    shown("setLegendVisibility", "simUI.setLegendVisibility(string handle,int id,bool visible)"),
    shown("setRowCount", "simUI.setRowCount(string handle,int id,int count)"),
    shown("setColumnCount", "simUI.setColumnCount(string handle,int id,int count)"),
    shown("setItem", "simUI.setItem(string handle,int id,int row,int column,string text)"),
];

fn create(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    a.text(0)?;
    let registry = &mut *sim.registry;
    if registry.interfaces.len() >= MAX_INTERFACES {
        return Err(ApiError(format!("there are {MAX_INTERFACES} interfaces already: destroy some")));
    }
    registry.n_interfaces += 1;
    let handle = format!("ui{}", registry.n_interfaces);
    registry.interfaces.insert(handle.clone());
    one(handle)
}

/// Place of a window of V-REP 3 by its name; it is there from now on.
pub(super) fn open_window(sim: &mut SimApi<'_>, name: &str) -> Result<i64, ApiError> {
    let registry = &mut *sim.registry;
    if let Some(k) = registry.windows.iter().position(|known| known == name) {
        return Ok(k as i64);
    }
    if registry.windows.len() >= MAX_INTERFACES || name.len() > 1_000 {
        return Err(ApiError(format!("a name of 1000 bytes at most, and {MAX_INTERFACES} windows at once")));
    }
    registry.windows.push(name.to_owned());
    registry.interfaces.insert(format!("window {name}"));
    Ok(registry.windows.len() as i64 - 1)
}

/// Keeps a value of a widget.
pub(super) fn keep_value(
    sim: &mut SimApi<'_>,
    key: (String, i64, &'static str),
    value: &Value,
) -> Result<(), ApiError> {
    put(sim, key, value).map(drop)
}

/// Key of a value of a widget.
fn key(a: Arguments<'_>, of: &'static str) -> Result<(String, i64, &'static str), ApiError> {
    Ok((a.text(0)?.to_owned(), a.int(1)?, of))
}

fn put(sim: &mut SimApi<'_>, key: (String, i64, &'static str), value: &Value) -> Outcome {
    if !sim.registry.interfaces.contains(&key.0) {
        return Err(ApiError(format!("there is no interface `{:.30}`: simUI.create gives the handle of one", key.0)));
    }
    let values = &sim.registry.widgets;
    if values.len() >= MAX_VALUES && !values.contains_key(&key) {
        return Err(ApiError(format!("{MAX_VALUES} values of widgets are kept already: destroy an interface")));
    }
    let size = value.as_text().map_or(0, str::len);
    if size > 10_000 || matches!(value, Value::List(_) | Value::Map(_) | Value::Bytes(_)) {
        return Err(ApiError::new("a widget holds a number or a text of up to 10000 bytes"));
    }
    sim.registry.check_stored_size(key.0.len() + size)?;
    sim.registry.widgets.insert(key, value.clone());
    done()
}

fn keep(sim: &mut SimApi<'_>, a: Arguments<'_>, of: &'static str) -> Outcome {
    put(sim, key(a, of)?, a.get(2))
}

fn kept(sim: &mut SimApi<'_>, a: Arguments<'_>, of: &'static str, default: Value) -> Outcome {
    one(sim.registry.widgets.get(&key(a, of)?).cloned().unwrap_or(default))
}

fn title(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let key = (a.text(0)?.to_owned(), -1, "title");
    one(sim.registry.widgets.get(&key).cloned().unwrap_or_else(|| Value::from("")))
}

fn set_title(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let key = (a.text(0)?.to_owned(), -1, "title");
    put(sim, key, a.get(1))
}

fn destroy(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let handle = a.text(0)?.to_owned();
    sim.registry.interfaces.remove(&handle);
    sim.registry.widgets.retain(|(own, _, _), _| *own != handle);
    done()
}
