//! The JSON Schemas of the files, generated from the types that read them, and the checker that walks a file against
//! them.
//!
//! Editors check with the same schemas (`schemas/*.schema.json`), so that what an editor underlines and what
//! `sincro check` says is one thing. A test keeps the files equal to the types.

pub(crate) mod describe;
mod editors;
mod validate;

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

pub use describe::{description, units};
pub use editors::{FORMAT, for_editors};
pub use validate::validate;

/// JSON Schema of a type that reads a file, in the form that the files are checked with.
pub(crate) fn generate<T: JsonSchema>() -> Value {
    let generator = SchemaSettings::draft2020_12().into_generator();
    let mut schema = generator.into_root_schema_for::<T>().to_value();
    simplify(&mut schema);
    schema
}

/// TOML has no null: an optional key is one that may be left out. Formats such as `double` say nothing more.
fn simplify(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(simplify),
        Value::Object(table) => {
            table.values_mut().for_each(simplify);
            simplify_table(table);
        }
        _ => {}
    }
}

fn simplify_table(table: &mut Map<String, Value>) {
    if table.get("format").is_some_and(Value::is_string) {
        table.remove("format");
    }
    if table.get("default").is_some_and(Value::is_null) {
        table.remove("default");
    }
    // an array of a fixed number of components that may be signals has no default worth showing
    if let Some(Value::Array(types)) = table.get_mut("type") {
        types.retain(|t| t != "null");
        if let [only] = &types[..] {
            let only = only.clone();
            table.insert("type".into(), only);
        }
    }
    let Some(Value::Array(choices)) = table.get_mut("anyOf") else { return };
    choices.retain(|c| c.get("type") != Some(&Value::from("null")));
    if let [Value::Object(only)] = &choices[..] {
        let only = only.clone();
        table.remove("anyOf");
        for (key, value) in only {
            table.entry(key).or_insert(value);
        }
    }
}

/// Returns the alternative forms of the value that `schema` describes, as plain schemas: references are resolved in
/// `root`, the whole schema, and `anyOf` is taken apart.
///
/// # Panics
///
/// If a reference does not resolve; those of generated schemas do.
pub fn alternatives<'s>(root: &'s Value, schema: &'s Value) -> Vec<&'s Map<String, Value>> {
    let mut found = Vec::new();
    collect(root, schema, &mut found);
    found
}

fn collect<'s>(root: &'s Value, schema: &'s Value, found: &mut Vec<&'s Map<String, Value>>) {
    let Some(table) = schema.as_object() else { return };
    if let Some(reference) = table.get("$ref").and_then(Value::as_str) {
        let target = root.pointer(reference.trim_start_matches('#'));
        return collect(root, target.expect("references of a generated schema resolve"), found);
    }
    match table.get("anyOf").and_then(Value::as_array) {
        Some(choices) => choices.iter().for_each(|choice| collect(root, choice, found)),
        None => found.push(table),
    }
}

/// Returns the schema of the key `key` of a table: that of the property of this name, or of any key if the table is
/// open. `None` if the table does not know the key.
pub fn property<'s>(table: &'s Map<String, Value>, key: &str) -> Option<&'s Value> {
    let named = table.get("properties").and_then(|p| p.get(key));
    named.or_else(|| table.get("additionalProperties").filter(|rest| **rest != Value::Bool(false)))
}

/// Names of the keys that a table knows.
pub(crate) fn property_names(table: &Map<String, Value>) -> Vec<&str> {
    let named = table.get("properties").and_then(Value::as_object);
    named.map(|p| p.keys().map(String::as_str).collect()).unwrap_or_default()
}

/// Keys of which exactly one must be given, from a `oneOf` of `required` alone.
pub(crate) fn exclusive_keys(one_of: &Value) -> Option<Vec<&str>> {
    let choices = one_of.as_array()?;
    choices.iter().map(|choice| choice.get("required")?.get(0)?.as_str()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagram::diagram_schema;
    use crate::experiment::experiment_schema;
    use crate::scene::scene_schema;
    use std::path::Path;

    /// The committed schema must be the one the types give; `SINCRO_BLESS=1` rewrites it.
    fn assert_committed(name: &str, schema: &Value) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schemas").join(name);
        let text = format!("{:#}\n", for_editors(schema));
        if std::env::var_os("SINCRO_BLESS").is_some() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &text).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == text, "{} is out of date: run the tests with SINCRO_BLESS=1", path.display());
    }

    #[test]
    fn committed_schemas_are_those_of_the_types() {
        assert_committed("scene.schema.json", scene_schema());
        assert_committed("experiment.schema.json", experiment_schema());
        assert_committed("diagram.schema.json", diagram_schema());
    }

    #[test]
    fn nothing_in_a_schema_is_null() {
        fn no_null(value: &Value) -> bool {
            match value {
                Value::Null => false,
                Value::String(text) => text != "null",
                Value::Array(list) => list.iter().all(no_null),
                Value::Object(table) => table.values().all(no_null),
                _ => true,
            }
        }
        assert!(no_null(scene_schema()) && no_null(experiment_schema()) && no_null(diagram_schema()));
    }

    /// The schema states the unit of every number, or that it has none by its description alone.
    #[test]
    fn every_property_is_described() {
        fn visit(value: &Value, path: &str) {
            if let Some(properties) = value.get("properties").and_then(Value::as_object) {
                for (key, property) in properties {
                    assert!(property.get("description").is_some(), "{path}/{key} has no description");
                }
            }
            if let Some(table) = value.as_object() {
                table.iter().for_each(|(key, inner)| visit(inner, &format!("{path}/{key}")));
            }
        }
        visit(scene_schema(), "scene");
        visit(experiment_schema(), "experiment");
        visit(diagram_schema(), "diagram");
    }
}
