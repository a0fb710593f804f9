//! Schemas as editors use them: the schema of the types, with all that is rewritten before validation.

use serde_json::{Map, Value, json};

use super::describe::units;

/// Version of the file format that this program writes; files of older versions are read, those of newer ones refused.
pub const FORMAT: u64 = 2;

/// Suffixes of a key by its unit, with the words for the unit.
const VARIANTS: [(&str, &str, &str); 3] = [
    ("rad", "_deg", "in degrees [deg]"),
    ("rad/s", "_rpm", "in turns a minute [1/min]"),
    ("rad/s", "_deg_s", "in degrees a second [deg/s]"),
];

/// Returns a schema of a file as editors use it: extended by all that is rewritten before validation, such as formulas
/// in the place of numbers and keys with suffixes (`_deg`, `_rpm`), and with the version of the format.
#[must_use]
pub fn for_editors(schema: &Value) -> Value {
    let mut schema = schema.clone();
    extend(&mut schema);
    if let Some(table) = schema.as_object_mut() {
        table.insert("$comment".into(), json!(format!("sincro, format {FORMAT}")));
        if let Some(format) = table.get_mut("properties").and_then(|p| p.get_mut("format")) {
            format["maximum"] = FORMAT.into();
        }
    }
    schema
}

fn extend(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(extend),
        Value::Object(table) => {
            table.values_mut().for_each(extend);
            add_variants(table);
            if table.get("type").is_some_and(|t| t == "number") {
                // a formula
                table.insert("type".into(), json!(["number", "string"]));
            }
        }
        _ => {}
    }
}

/// Adds the keys with a suffix to a table.
fn add_variants(table: &mut Map<String, Value>) {
    let Some(properties) = table.get_mut("properties").and_then(Value::as_object_mut) else { return };
    let mut added: Vec<(String, String)> = Vec::new();
    for (key, property) in properties.clone() {
        let text = property.get("description").and_then(Value::as_str).unwrap_or("");
        let units = units(text);
        for (unit, suffix, words) in VARIANTS {
            if units.contains(&unit) || (key == "command" && units.is_empty()) {
                let mut variant = property.clone();
                variant["description"] = json!(format!("`{key}`, {words}."));
                if let Some(table) = variant.as_object_mut() {
                    table.remove("default");
                }
                let name = format!("{key}{suffix}");
                properties.insert(name.clone(), variant);
                added.push((key.clone(), name));
            }
        }
    }
    let has_variant = |key: &Value| added.iter().any(|(of, _)| key == of);
    if let Some(required) = table.get_mut("required").and_then(Value::as_array_mut) {
        required.retain(|key| !has_variant(key));
        if required.is_empty() {
            table.remove("required");
        }
    }
    if let Some(choices) = table.get_mut("oneOf").and_then(Value::as_array_mut) {
        let more: Vec<Value> = choices
            .iter()
            .filter_map(|choice| choice.get("required")?.get(0))
            .flat_map(|key| added.iter().filter(move |(of, _)| key == of))
            .map(|(_, name)| json!({"required": [name]}))
            .collect();
        choices.extend(more);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::scene_schema;

    #[test]
    fn editors_know_degrees_and_formulas() {
        let schema = for_editors(scene_schema());
        let initial = &schema["$defs"]["InitialFile"]["properties"];
        assert!(initial.get("position_deg").is_some() && initial.get("velocity_rpm").is_some());
        assert!(initial.get("velocity_deg").is_none());
        assert_eq!(schema["$defs"]["BodyFile"]["properties"]["mass"]["type"], json!(["number", "string"]));
        assert_eq!(schema["$comment"], "sincro, format 2");
    }
}
