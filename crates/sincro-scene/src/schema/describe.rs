//! Words for messages: what a value is, and what the schema wanted.

use serde_json::{Map, Value};

use super::{alternatives, exclusive_keys, property_names};
use crate::document::NonJson;
use crate::suggest::quoted;

/// Longest text of a value that is quoted whole.
const QUOTED: usize = 40;
/// Keys of an expected table that are listed.
const MAX_KEYS: usize = 6;

/// Description of the value found, such as `the string "abc"` or `a list of 3`.
pub(super) fn found(value: &Value, odd: Option<&NonJson>) -> String {
    match value {
        Value::Null => match odd {
            Some(NonJson::Infinite { positive: true }) => "infinite".into(),
            Some(NonJson::Infinite { positive: false }) => "minus infinite".into(),
            Some(NonJson::Date) => "a date".into(),
            Some(NonJson::TooLarge) => "a whole number of more than 64 bits".into(),
            Some(NonJson::NotANumber) | None => "not a number".into(),
        },
        Value::Bool(truth) => truth.to_string(),
        Value::Number(number) => format!("the number {number}"),
        Value::String(text) if text.chars().count() > QUOTED => {
            format!("the string \"{}…\"", text.chars().take(QUOTED).collect::<String>())
        }
        Value::String(text) => format!("the string {text:?}"),
        Value::Array(list) => format!("a list of {}", list.len()),
        Value::Object(_) => "a table".into(),
    }
}

/// Description of the value expected, such as `a number in kg`.
pub(super) fn expected(root: &Value, schema: &Value) -> String {
    let unit = unit(description(root, schema));
    let mut parts: Vec<String> = Vec::new();
    for choice in alternatives(root, schema) {
        let part = one_expected(root, choice, &unit);
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    parts.join(" or ")
}

fn one_expected(root: &Value, choice: &Map<String, Value>, unit: &str) -> String {
    if let Some(words) = words(choice) {
        let words: Vec<String> = words.iter().map(|w| format!("`{w}`")).collect();
        return format!("one of {}", words.join(", "));
    }
    match choice.get("type").and_then(Value::as_str) {
        Some("number") if unit.is_empty() => "a number".into(),
        Some("number") => format!("a number in {unit}"),
        Some("integer") => "a whole number".into(),
        Some("boolean") => "true or false".into(),
        Some("string") => "a string".into(),
        Some("array") => list(root, choice, unit),
        Some("object") => match choice.get("oneOf").and_then(exclusive_keys) {
            Some(keys) => format!("a table with one of {}", quoted(&keys)),
            None => match property_names(choice)[..] {
                [] => "a table".into(),
                ref keys if keys.len() > MAX_KEYS => "a table".into(),
                ref keys => format!("a table of {}", quoted(keys)),
            },
        },
        _ => "something else".into(),
    }
}

fn list(root: &Value, choice: &Map<String, Value>, unit: &str) -> String {
    let items = choice.get("items").map(|items| alternatives(root, items)).unwrap_or_default();
    let noun = match items.first().and_then(|i| i.get("type")).and_then(Value::as_str) {
        Some("number") => "numbers",
        Some("string") => "strings",
        Some("object") => "tables",
        _ => "entries",
    };
    let unit = if noun == "numbers" && !unit.is_empty() { format!(" in {unit}") } else { String::new() };
    match fixed_length(choice) {
        Some(n) => format!("a list of {n} {noun}{unit}"),
        None => format!("a list of {noun}{unit}"),
    }
}

/// Number of entries of a list that always has as many.
pub(super) fn fixed_length(choice: &Map<String, Value>) -> Option<u64> {
    let (min, max) = (choice.get("minItems")?.as_u64()?, choice.get("maxItems")?.as_u64()?);
    (min == max).then_some(min)
}

/// The words that an enumeration knows.
pub(crate) fn words(choice: &Map<String, Value>) -> Option<Vec<&str>> {
    if let Some(Value::Array(words)) = choice.get("enum") {
        return words.iter().map(Value::as_str).collect();
    }
    let words = choice.get("oneOf")?.as_array()?;
    let mut all = Vec::new();
    for word in words {
        match (word.get("const"), word.get("enum")) {
            (Some(word), _) => all.push(word.as_str()?),
            (None, Some(Value::Array(some))) => all.extend(some.iter().filter_map(Value::as_str)),
            _ => return None,
        }
    }
    Some(all)
}

/// Returns the description of the value that `schema` describes: its own, or that of its type; empty if there is none.
/// `root` is the whole schema, in which references are resolved.
pub fn description<'s>(root: &'s Value, schema: &'s Value) -> &'s str {
    let own = schema.get("description").and_then(Value::as_str);
    let of_type = || alternatives(root, schema).first().and_then(|c| c.get("description")).and_then(Value::as_str);
    own.or_else(of_type).unwrap_or("")
}

/// The units in brackets in a description, such as `N·m/rad or N/m`.
fn unit(description: &str) -> String {
    units(description).join(" or ")
}

/// Returns the units in square brackets in a description, such as `N·m/rad` and `N/m`, in their order.
pub fn units(description: &str) -> Vec<&str> {
    let mut units = Vec::new();
    let mut rest = description;
    while let Some((_, after)) = rest.split_once('[') {
        let Some((unit, after)) = after.split_once(']') else { break };
        units.push(unit);
        rest = after;
    }
    units
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::scene_schema;

    #[test]
    fn expectations_carry_their_units() {
        let root = scene_schema();
        let of = |type_name: &str, key: &str| expected(root, &root["$defs"][type_name]["properties"][key]);
        assert_eq!(of("BodyFile", "mass"), "a number in kg");
        assert_eq!(of("JointFile", "axis"), "a list of 3 numbers");
        assert_eq!(of("JointFile", "position"), "a list of 3 numbers in m");
        assert_eq!(
            of("JointFile", "damping"),
            "a number in N·m·s/rad or N·s/m or a list of numbers in N·m·s/rad or N·s/m"
        );
        assert_eq!(of("MotorFile", "mode"), "one of `free`, `torque`, `velocity`, `position`, `spring`, `voltage`");
        assert_eq!(
            of("MotorFile", "command"),
            "a number or a table with one of `constant`, `step`, `ramp`, `sine`, `pulse`, `table`"
        );
    }
}
