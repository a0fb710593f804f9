//! User interfaces: `simUI`, and windows of V-REP 3 (custom dialogs, `simGetUIHandle`). There are no windows: what is
//! set is kept and told again, and nothing is ever pressed.

use std::collections::{BTreeMap, BTreeSet};

use crate::{ApiError, Arguments, Value};

/// Values that a client or script may keep in interfaces.
const MAX_VALUES: usize = 10_000;
/// Interfaces that may exist at once.
const MAX_INTERFACES: usize = 1_000;
/// Handle of the first window of V-REP 3.
const FIRST: i64 = 500_000;
/// Key of what belongs to an interface as a whole: no widget has that number.
const WHOLE: i64 = -1;

/// Return values of a function.
type Outcome = Result<Vec<Value>, ApiError>;
/// Interface, number of a widget in it, what of it is kept.
type Key = (String, i64, &'static str);

/// Interfaces with the values of their widgets.
#[derive(Clone, Debug, Default)]
pub struct Widgets {
    values: BTreeMap<Key, Value>,
    /// Interfaces that were made and not destroyed.
    interfaces: BTreeSet<String>,
    /// Names of windows of V-REP 3, in the order in which they were asked for.
    windows: Vec<String>,
    /// Number of interfaces that were made.
    n_made: usize,
}

impl Widgets {
    /// Bytes of what is kept.
    #[must_use]
    pub fn size(&self) -> usize {
        self.values.iter().map(|((own, ..), value)| own.len() + value.as_text().map_or(0, str::len)).sum()
    }

    fn get(&self, key: &Key, default: Value) -> Value {
        self.values.get(key).cloned().unwrap_or(default)
    }
}

/// Owner of interfaces, with a limit of what it stores.
pub trait Keeper {
    /// Its interfaces.
    fn widgets(&mut self) -> &mut Widgets;
    /// Checks that bytes can be stored beside what is.
    ///
    /// # Errors
    ///
    /// They would be too many.
    fn check_size(&self, bytes: usize) -> Result<(), ApiError>;
}

/// Value of a widget before the first setting.
#[derive(Clone, Copy)]
enum Blank {
    Text,
    Int(i64),
    Real,
}

/// Functions that set and get one value of a widget, and the value before the first setting.
const VALUES: [(&str, &str, Blank); 10] = [
    ("setEditValue", "getEditValue", Blank::Text),
    ("setLabelText", "getLabelText", Blank::Text),
    ("setButtonText", "getButtonText", Blank::Text),
    ("setText", "getText", Blank::Text),
    ("setSliderValue", "getSliderValue", Blank::Int(0)),
    ("setCheckboxValue", "getCheckboxValue", Blank::Int(0)),
    ("setRadiobuttonValue", "getRadiobuttonValue", Blank::Int(0)),
    ("setComboboxSelectedIndex", "getComboboxSelectedIndex", Blank::Int(-1)),
    ("setSpinboxValue", "getSpinboxValue", Blank::Real),
    ("setProgress", "getProgress", Blank::Int(0)),
];

/// Calls the function of `simUI` of a name without it.
///
/// # Errors
///
/// Its arguments are not those of the function, the interface is not there, or there are too many values.
pub fn call(keeper: &mut impl Keeper, name: &str, a: Arguments<'_>) -> Outcome {
    match name {
        "create" => create(keeper, a),
        "destroy" => {
            let own = a.text(0)?.to_owned();
            keeper.widgets().interfaces.remove(&own);
            keeper.widgets().values.retain(|(interface, _, _), _| *interface != own);
            Ok(Vec::new())
        }
        "isVisible" => Ok(vec![Value::Bool(false)]),
        "getPosition" | "getSize" => Ok(vec![Value::Int(0), Value::Int(0)]),
        "getTitle" => Ok(vec![keeper.widgets().get(&(a.text(0)?.to_owned(), WHOLE, "title"), Value::from(""))]),
        "setTitle" => put(keeper, (a.text(0)?.to_owned(), WHOLE, "title"), a.get(1)),
        _ => value(keeper, name, a),
    }
}

/// Sets or gets a value of a widget; what only shows something does nothing.
fn value(keeper: &mut impl Keeper, name: &str, a: Arguments<'_>) -> Outcome {
    let Some((set, get, blank)) = VALUES.iter().find(|(set, get, _)| [*set, *get].contains(&name)) else {
        return Ok(Vec::new());
    };
    let key = (a.text(0)?.to_owned(), a.int(1)?, *get);
    if name == *set {
        return put(keeper, key, a.get(2));
    }
    let default = match *blank {
        Blank::Text => Value::from(""),
        Blank::Int(n) => Value::Int(n),
        Blank::Real => Value::Real(0.0),
    };
    Ok(vec![keeper.widgets().get(&key, default)])
}

fn create(keeper: &mut impl Keeper, a: Arguments<'_>) -> Outcome {
    a.text(0)?;
    let widgets = keeper.widgets();
    if widgets.interfaces.len() >= MAX_INTERFACES {
        return Err(ApiError(format!("there are {MAX_INTERFACES} interfaces already: destroy some")));
    }
    widgets.n_made += 1;
    let handle = format!("ui{}", widgets.n_made);
    widgets.interfaces.insert(handle.clone());
    Ok(vec![handle.into()])
}

/// Keeps a value of a widget.
fn put(keeper: &mut impl Keeper, key: Key, value: &Value) -> Outcome {
    let widgets = keeper.widgets();
    if !widgets.interfaces.contains(&key.0) {
        return Err(ApiError(format!("there is no interface `{:.30}`: simUI.create gives the handle of one", key.0)));
    }
    if widgets.values.len() >= MAX_VALUES && !widgets.values.contains_key(&key) {
        return Err(ApiError(format!("{MAX_VALUES} values of widgets are kept already: destroy an interface")));
    }
    let size = value.as_text().map_or(0, str::len);
    if size > 10_000 || matches!(value, Value::List(_) | Value::Map(_) | Value::Bytes(_)) {
        return Err(ApiError::new("a widget holds a number or a text of up to 10000 bytes"));
    }
    keeper.check_size(key.0.len() + size)?;
    keeper.widgets().values.insert(key, value.clone());
    Ok(Vec::new())
}

/// Calls the function of `sim` on windows of V-REP 3 of a name without it.
///
/// # Errors
///
/// As [`call`].
pub fn call_window(keeper: &mut impl Keeper, name: &str, a: Arguments<'_>) -> Outcome {
    match name {
        "getUIHandle" | "createUI" => return open(keeper, a.text(0)?),
        _ => {}
    }
    let own = window(keeper, a)?;
    match name {
        "getUIEventButton" => Ok(vec![Value::Int(-1), Value::List(vec![Value::Int(0), Value::Int(0)])]),
        "setUIButtonLabel" => keep(keeper, (own, a.int(1)?, "label"), a.get(2)),
        "getUIButtonLabel" => Ok(vec![keeper.widgets().get(&(own, a.int(1)?, "label"), Value::from(""))]),
        "setUIButtonProperty" => keep(keeper, (own, a.int(1)?, "property"), a.get(2)),
        "getUIButtonProperty" => Ok(vec![keeper.widgets().get(&(own, a.int(1)?, "property"), Value::Int(0))]),
        "setUISlider" => keep(keeper, (own, a.int(1)?, "slider"), a.get(2)),
        "getUISlider" => Ok(vec![keeper.widgets().get(&(own, a.int(1)?, "slider"), Value::Int(0))]),
        "setUIProperty" => keep(keeper, (own, WHOLE, "property"), &Value::Int(a.int(1)?)),
        "getUIProperty" => Ok(vec![keeper.widgets().get(&(own, WHOLE, "property"), Value::Int(0))]),
        "createUIButton" => create_button(keeper, own, a),
        "removeUI" => {
            keeper.widgets().values.retain(|(interface, _, _), _| *interface != own);
            Ok(vec![Value::Int(1)])
        }
        // what changes what a window looks like
        _ => Ok(vec![Value::Int(1)]),
    }
}

/// A window of V-REP 3 by its name; it is there from now on.
fn open(keeper: &mut impl Keeper, name: &str) -> Outcome {
    let widgets = keeper.widgets();
    if let Some(k) = widgets.windows.iter().position(|known| known == name) {
        return Ok(vec![Value::Int(FIRST + k as i64)]);
    }
    if widgets.windows.len() >= MAX_INTERFACES || name.len() > 1_000 {
        return Err(ApiError(format!("a name of 1000 bytes at most, and {MAX_INTERFACES} windows at once")));
    }
    widgets.windows.push(name.to_owned());
    widgets.interfaces.insert(format!("window {name}"));
    Ok(vec![Value::Int(FIRST + widgets.windows.len() as i64 - 1)])
}

/// Key of a window among the interfaces.
fn window(keeper: &mut impl Keeper, a: Arguments<'_>) -> Result<String, ApiError> {
    let number = a.int(0)?;
    let place = number.checked_sub(FIRST).and_then(|k| usize::try_from(k).ok());
    let name = place.and_then(|k| keeper.widgets().windows.get(k));
    name.map(|name| format!("window {name}")).ok_or_else(|| ApiError(format!("there is no window {number}")))
}

fn keep(keeper: &mut impl Keeper, key: Key, value: &Value) -> Outcome {
    put(keeper, key, value)?;
    Ok(vec![Value::Int(1)])
}

/// A button with a number that no other button of the window has.
fn create_button(keeper: &mut impl Keeper, own: String, a: Arguments<'_>) -> Outcome {
    let keys = keeper.widgets().values.keys().filter(|(window, _, _)| *window == own);
    let button = keys.map(|(_, button, _)| *button).max().unwrap_or(WHOLE).max(0) + 1;
    put(keeper, (own, button, "property"), &Value::Int(a.int(3)?))?;
    Ok(vec![Value::Int(button)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Default)]
    struct Room(Widgets);

    impl Keeper for Room {
        fn widgets(&mut self) -> &mut Widgets {
            &mut self.0
        }

        fn check_size(&self, bytes: usize) -> Result<(), ApiError> {
            if self.0.size() + bytes > 100 { Err(ApiError::new("full")) } else { Ok(()) }
        }
    }

    #[test]
    fn what_is_set_is_told_until_the_interface_is_destroyed() {
        let mut room = Room::default();
        let ui = call(&mut room, "create", Arguments(&["<ui/>".into()])).unwrap().remove(0);
        let of = |more: &[Value]| [std::slice::from_ref(&ui), more].concat();
        let get = of(&[1.into()]);
        assert_eq!(call(&mut room, "getSliderValue", Arguments(&get)).unwrap(), [Value::Int(0)]);
        call(&mut room, "setSliderValue", Arguments(&of(&[1.into(), 7.into()]))).unwrap();
        assert_eq!(call(&mut room, "getSliderValue", Arguments(&get)).unwrap(), [Value::Int(7)]);
        assert!(call(&mut room, "setLabelText", Arguments(&of(&[2.into(), "x".repeat(101).into()]))).is_err());
        call(&mut room, "destroy", Arguments(&of(&[]))).unwrap();
        assert_eq!(call(&mut room, "getSliderValue", Arguments(&get)).unwrap(), [Value::Int(0)]);
        assert!(call(&mut room, "setSliderValue", Arguments(&of(&[1.into(), 7.into()]))).is_err());
    }

    #[test]
    fn a_window_keeps_its_name_its_property_and_its_buttons() {
        let mut room = Room::default();
        let [a, again, b] =
            ["a", "a", "b"].map(|name| call_window(&mut room, "getUIHandle", Arguments(&[name.into()])));
        let (a, b) = (a.unwrap().remove(0), b.unwrap().remove(0));
        assert!(again.unwrap()[0] == a && a != b);
        call_window(&mut room, "setUIProperty", Arguments(&[a.clone(), 5.into()])).unwrap();
        assert_eq!(call_window(&mut room, "getUIProperty", Arguments(&[a])).unwrap(), [Value::Int(5)]);
        assert_eq!(call_window(&mut room, "getUIProperty", Arguments(&[b])).unwrap(), [Value::Int(0)]);
        assert!(call_window(&mut room, "getUIProperty", Arguments(&[i64::MIN.into()])).is_err());
    }
}
