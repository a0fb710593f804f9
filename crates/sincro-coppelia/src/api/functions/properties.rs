//! Functions: properties of CoppeliaSim 4.7 and later, by name and kind.
//!
//! A property of an object is one of the functions under another name ([`PROPERTIES`]). `customData.…`, of any object,
//! the scene and the application, are data that clients and scripts store; `signal.…` are signals.

use sincro_conventions::properties::{FLAGS, KEPT_FLAGS, OF_SCENE, PROPERTIES, Property, VISIBLE};

use super::objects::owner;
use super::{Function, Outcome, done, function, one};
use crate::api::stored::{Stored, check_tag};
use crate::api::{ApiError, Arguments, Handle, SimApi, Value};

/// Kind of a property, as the functions name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Type {
    Bool,
    Int,
    Float,
    Text,
    Bytes,
    Table,
    /// A list of that many numbers; 0 for any.
    Reals(usize),
    /// Whole numbers.
    Ints,
}

/// Handles of the scene and the application.
const SCENE: Handle = Handle(-12);
const APPLICATION: Handle = Handle(-13);

/// A getter and a setter of a kind.
macro_rules! pair {
    ($get:literal, $set:literal, $type:literal, $kind:expr) => {
        [
            Function {
                name: $get,
                tip: concat!($type, " value=sim.", $get, "(int target,string propertyName,map options={})"),
                run: |d, a| get(d, a, Some($kind)),
            },
            Function {
                name: $set,
                tip: concat!("sim.", $set, "(int target,string propertyName,", $type, " value,map options={})"),
                run: |d, a| set(d, a, Some($kind)),
            },
        ]
    };
}

const PAIRS: [[Function; 2]; 14] = [
    pair!("getBoolProperty", "setBoolProperty", "bool", Type::Bool),
    pair!("getIntProperty", "setIntProperty", "int", Type::Int),
    pair!("getLongProperty", "setLongProperty", "int", Type::Int),
    pair!("getHandleProperty", "setHandleProperty", "int", Type::Int),
    pair!("getFloatProperty", "setFloatProperty", "float", Type::Float),
    pair!("getStringProperty", "setStringProperty", "string", Type::Text),
    pair!("getBufferProperty", "setBufferProperty", "buffer", Type::Bytes),
    pair!("getTableProperty", "setTableProperty", "map", Type::Table),
    pair!("getVector2Property", "setVector2Property", "float[2]", Type::Reals(2)),
    pair!("getVector3Property", "setVector3Property", "float[3]", Type::Reals(3)),
    pair!("getQuaternionProperty", "setQuaternionProperty", "float[4]", Type::Reals(4)),
    pair!("getPoseProperty", "setPoseProperty", "float[7]", Type::Reals(7)),
    pair!("getFloatArrayProperty", "setFloatArrayProperty", "float[]", Type::Reals(0)),
    pair!("getIntArrayProperty", "setIntArrayProperty", "int[]", Type::Ints),
];

/// The functions of [`PAIRS`], one after the other.
pub(super) const TYPED: &[Function] = PAIRS.as_flattened();

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "getColorProperty",
        tip: "float[3] value=sim.getColorProperty(int target,string propertyName,map options={})",
        run: |d, a| get(d, a, Some(Type::Reals(3))),
    },
    Function {
        name: "getProperty",
        tip: "any value=sim.getProperty(int target,string propertyName,map options={})",
        run: |d, a| get(d, a, None),
    },
    Function {
        name: "setProperty",
        tip: "sim.setProperty(int target,string propertyName,any value,map options={})",
        run: |d, a| set(d, a, None),
    },
    Function {
        name: "removeProperty",
        tip: "sim.removeProperty(int target,string propertyName,map options={})",
        run: remove,
    },
    Function {
        name: "getPropertyName",
        tip: "string propertyName=sim.getPropertyName(int target,int index,map options={})",
        run: name_at,
    },
];

impl Type {
    /// The kind of a value that was given without one.
    fn of(value: &Value) -> Result<Self, ApiError> {
        Ok(match value {
            Value::Bool(_) => Self::Bool,
            Value::Int(_) => Self::Int,
            Value::Real(_) => Self::Float,
            Value::Text(_) => Self::Text,
            Value::Bytes(_) => Self::Bytes,
            Value::List(_) if value.as_reals().is_some() => Self::Reals(0),
            Value::List(_) | Value::Map(_) | Value::Numbered(_) => Self::Table,
            Value::Nil => return Err(ApiError::new("a property has no value nil: use sim.removeProperty")),
        })
    }

    /// A value as one of this kind.
    fn read(self, value: &Value) -> Option<Value> {
        Some(match self {
            Self::Bool => Value::Bool(value.as_bool().filter(|_| *value != Value::Nil)?),
            Self::Int => Value::Int(value.as_int()?),
            Self::Float => Value::Real(value.as_real().filter(|_| *value != Value::Nil)?),
            Self::Text => Value::Text(value.as_text()?.to_owned()),
            Self::Bytes => Value::Bytes(value.as_bytes()?.to_vec()),
            Self::Table => match value {
                Value::List(_) | Value::Map(_) | Value::Numbered(_) => value.clone(),
                _ => return None,
            },
            Self::Reals(n) => Value::reals(value.as_reals().filter(|list| n == 0 || list.len() == n)?),
            Self::Ints => {
                let Value::List(list) = value else { return None };
                Value::List(list.iter().map(|x| x.as_int().map(Value::Int)).collect::<Option<_>>()?)
            }
        })
    }

    fn word(self) -> String {
        match self {
            Self::Bool => "a truth value".into(),
            Self::Int => "a whole number".into(),
            Self::Float => "a number".into(),
            Self::Text => "text".into(),
            Self::Bytes => "bytes".into(),
            Self::Table => "a table".into(),
            Self::Reals(0) => "a list of numbers".into(),
            Self::Reals(n) => format!("a list of {n} numbers"),
            Self::Ints => "a list of whole numbers".into(),
        }
    }
}

/// The property of a name, of an object or the scene.
fn known(target: Handle, name: &str) -> Result<&'static Property, ApiError> {
    let list = if target == SCENE { OF_SCENE } else { PROPERTIES };
    list.iter().find(|p| p.name == name && target != APPLICATION).ok_or_else(|| {
        let names: Vec<&str> = match target {
            APPLICATION => Vec::new(),
            SCENE => list.iter().map(|p| p.name).collect(),
            _ => {
                let flags = FLAGS.iter().chain(&KEPT_FLAGS).map(|(flag, _)| *flag);
                list.iter().map(|p| p.name).chain(flags).chain([VISIBLE]).collect()
            }
        };
        let short: String = name.chars().take(60).collect();
        ApiError(format!("there is no property `{short}` here: {}, customData.…, signal.…", names.join(", ")))
    })
}

/// Bits of a flag of an object by the name of its property.
fn flags_of(target: Handle, name: &str) -> Option<i64> {
    let is_object = ![SCENE, APPLICATION].contains(&target);
    FLAGS.iter().find(|(known, _)| is_object && *known == name).map(|(_, flags)| *flags)
}

/// Value of a property that is a flag of an object, or its visibility; none if it is neither.
fn flag(sim: &SimApi<'_>, target: Handle, name: &str) -> Option<bool> {
    if let Some(flags) = flags_of(target, name) {
        return Some(sim.registry.special_property(target) & flags != 0);
    }
    let is_object = ![SCENE, APPLICATION].contains(&target);
    if is_object && name == VISIBLE {
        return Some(sim.registry.is_seen(target));
    }
    let (_, bit) = KEPT_FLAGS.iter().find(|(known, _)| is_object && *known == name)?;
    Some(sim.registry.common_property(target) & bit != 0)
}

/// Sets a flag of an object, or its visibility.
fn set_flag(sim: &mut SimApi<'_>, target: Handle, name: &str, is_set: bool) -> Outcome {
    if let Some(flags) = flags_of(target, name) {
        return sim.set_special_flags(target, flags, is_set).and_then(|()| done());
    }
    if name == VISIBLE {
        let layers = i64::from(is_set);
        return call(sim, "setObjectInt32Param", &[target.into(), Value::Int(10), Value::Int(layers)])
            .and_then(|_| done());
    }
    if let Some((_, bit)) = KEPT_FLAGS.iter().find(|(known, _)| *known == name) {
        let now = sim.registry.common_property(target);
        sim.registry.set_common_property(target, if is_set { now | bit } else { now & !bit });
    }
    done()
}

fn call(sim: &mut SimApi<'_>, name: &str, arguments: &[Value]) -> Outcome {
    (function(name).expect("properties are functions").run)(sim, Arguments(arguments))
}

/// The value of a property as it is; none if nothing was stored under that name.
fn value(sim: &mut SimApi<'_>, target: Handle, name: &str) -> Result<Option<Value>, ApiError> {
    if let Some(signal) = name.strip_prefix("signal.") {
        let registry = &sim.registry;
        let integer = registry.integers.get(signal).map(|x| Value::Int(*x));
        let float = || registry.floats.get(signal).map(|x| Value::Real(*x));
        let text = || registry.strings.value(signal);
        return Ok(integer.or_else(float).or_else(text));
    }
    if let Some(tag) = name.strip_prefix("customData.") {
        check_tag(tag)?;
        return sim.registry.data.get(&(target, tag.to_owned())).map(Stored::value).transpose();
    }
    if let Some(is_set) = flag(sim, target, name) {
        return Ok(Some(Value::Bool(is_set)));
    }
    let property = known(target, name)?;
    let own = (target != SCENE).then(|| Value::from(target));
    let arguments: Vec<Value> = own.into_iter().chain(property.get.1.iter().map(|x| Value::Int(*x))).collect();
    let mut results = call(sim, property.get.0, &arguments)?;
    Ok((!results.is_empty()).then(|| results.swap_remove(0)).filter(|value| *value != Value::Nil))
}

/// Options: `noError`.
fn is_tolerant(a: Arguments<'_>, k: usize) -> bool {
    let Value::Map(options) = a.get(k) else { return false };
    options.iter().any(|(key, value)| key == "noError" && value.as_bool() == Some(true))
}

fn get(sim: &mut SimApi<'_>, a: Arguments<'_>, kind: Option<Type>) -> Outcome {
    let (target, name) = (owner(sim, a, 0)?, a.text(1)?);
    let found = match value(sim, target, name) {
        Err(_) if is_tolerant(a, 2) => None,
        other => other?,
    };
    let Some(found) = found else {
        let missing = ApiError(format!("property `{name:.60}` has no value"));
        return if is_tolerant(a, 2) { Ok(vec![Value::Nil]) } else { Err(missing) };
    };
    let Some(kind) = kind else { return one(found) };
    let wrong = || ApiError(format!("property `{name:.60}` is {}, not {}", found.word(), kind.word()));
    one(kind.read(&found).ok_or_else(wrong)?)
}

fn set(sim: &mut SimApi<'_>, a: Arguments<'_>, kind: Option<Type>) -> Outcome {
    let (target, name) = (owner(sim, a, 0)?, a.text(1)?);
    let kind = kind.map_or_else(|| Type::of(a.get(2)), Ok)?;
    let wrong = || ApiError(format!("argument 3 is {}, expected {}", a.get(2).word(), kind.word()));
    let value = kind.read(a.get(2)).ok_or_else(wrong)?;
    if let Some(signal) = name.strip_prefix("signal.") {
        return set_signal(sim, signal, value);
    }
    if let Some(tag) = name.strip_prefix("customData.") {
        return super::objects::store(sim, (target, tag), Stored::from_value(&value));
    }
    if flag(sim, target, name).is_some() {
        let is_set = value.as_bool().ok_or_else(|| ApiError(format!("property `{name}` is a truth value")))?;
        return set_flag(sim, target, name, is_set);
    }
    let property = known(target, name)?;
    let Some((setter, before, behind)) = property.set else {
        return Err(ApiError(format!("property `{name}` is read only here")));
    };
    let value = if let Value::Bool(x) = value { Value::Int(x.into()) } else { value };
    let own = (target != SCENE).then(|| Value::from(target));
    let ints = |list: &'static [i64]| list.iter().map(|x| Value::Int(*x));
    let arguments: Vec<Value> = own.into_iter().chain(ints(before)).chain([value]).chain(ints(behind)).collect();
    call(sim, setter, &arguments)?;
    done()
}

fn set_signal(sim: &mut SimApi<'_>, signal: &str, value: Value) -> Outcome {
    if signal.is_empty() {
        return Err(ApiError::new("a signal has no name: write signal.NAME"));
    }
    let registry = &mut *sim.registry;
    let of_run = registry.phase.is_on();
    // set first: an error leaves what another kind of signal has under this name
    let set = match value {
        Value::Int(x) => {
            registry.integers.set(signal, x, of_run)?;
            0
        }
        Value::Bool(x) => {
            registry.integers.set(signal, x.into(), of_run)?;
            0
        }
        Value::Real(x) => {
            registry.floats.set(signal, x, of_run)?;
            1
        }
        other => {
            let bytes = other.as_bytes().ok_or_else(|| {
                ApiError::new("signals are numbers, texts and bytes here: pack tables with sim.packTable")
            })?;
            registry.check_stored_size(signal.len() + bytes.len())?;
            match other {
                Value::Bytes(_) => registry.strings.set_buffer(signal, bytes.to_vec(), of_run)?,
                _ => registry.strings.set(signal, bytes.to_vec(), of_run)?,
            }
            2
        }
    };
    if set != 0 {
        registry.integers.clear(signal);
    }
    if set != 1 {
        registry.floats.clear(signal);
    }
    if set != 2 {
        registry.strings.clear(signal);
    }
    done()
}

fn remove_signal(sim: &mut SimApi<'_>, signal: &str) {
    if !signal.is_empty() {
        sim.registry.integers.clear(signal);
        sim.registry.floats.clear(signal);
        sim.registry.strings.clear(signal);
    }
}

fn remove(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (target, name) = (owner(sim, a, 0)?, a.text(1)?);
    if let Some(signal) = name.strip_prefix("signal.") {
        remove_signal(sim, signal);
        return done();
    }
    let tag = name.strip_prefix("customData.");
    let tag = tag.ok_or_else(|| ApiError(format!("property `{name:.60}` is no stored data: it stays")))?;
    check_tag(tag)?;
    sim.registry.data.remove(&(target, tag.to_owned()));
    done()
}

/// Names of the properties that are stored with a target, by number; nil behind the last.
fn name_at(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (target, index) = (owner(sim, a, 0)?, a.int(1)?);
    let (list, flags) = match target {
        SCENE => (OF_SCENE, &[][..]),
        APPLICATION => (&[][..], &[][..]),
        _ => (PROPERTIES, &FLAGS[..]),
    };
    let stored = sim.registry.data.keys().filter(|(h, _)| *h == target);
    let stored: Vec<String> = stored.map(|(_, tag)| format!("customData.{tag}")).collect();
    let flags = flags.iter().map(|(flag, _)| *flag);
    let mut names: Vec<String> = list.iter().map(|p| p.name).chain(flags).map(str::to_owned).collect();
    names.retain(|name| value(&mut *sim, target, name).is_ok_and(|value| value.is_some()));
    names.extend(stored);
    let name = usize::try_from(index).ok().and_then(|k| names.into_iter().nth(k));
    Ok(vec![name.map_or(Value::Nil, Value::Text)])
}
