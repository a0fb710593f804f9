//! The JSON Schemas of the files, generated from the types that read them, and the checker that walks a file against
//! them.
//!
//! Code that generates them takes as long to compile as all else that reads files, so a test does it, and what it gives
//! is committed: `generated/*.json`, which the program reads, and `schemas/*.schema.json`, which editors check with, so
//! that what an editor underlines and what `sincro check` says is one thing. The test keeps them equal to the types.

pub(crate) mod describe;
mod editors;
#[cfg(test)]
mod generate;
mod validate;

use serde_json::{Map, Value};

pub use describe::{description, units};
pub use editors::{FORMAT, for_editors};
pub use validate::validate;

/// JSON Schema from its committed text.
pub(crate) fn parse(text: &str) -> Value {
    serde_json::from_str(text).expect("a committed schema is JSON")
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
    use crate::diagram::{DiagramFile, with_blocks};
    use crate::experiment::ExperimentFile;
    use crate::experiment::experiment_schema;
    use crate::scene::SceneFile;
    use crate::scene::scene_schema;
    use std::path::Path;

    /// The committed file must be what the types give; `SINCRO_BLESS=1` rewrites it.
    fn assert_committed(path: &str, schema: &Value) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let text = format!("{schema:#}\n");
        if std::env::var_os("SINCRO_BLESS").is_some() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &text).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == text, "{} is out of date: run the tests with SINCRO_BLESS=1", path.display());
    }

    #[test]
    fn committed_schemas_are_those_of_the_types() {
        let own = [
            ("scene", generate::generate::<SceneFile>()),
            ("experiment", generate::generate::<ExperimentFile>()),
            ("diagram", generate::generate::<DiagramFile>()),
        ];
        for (name, schema) in own {
            assert_committed(&format!("src/schema/generated/{name}.json"), &schema);
            let whole = if name == "diagram" { with_blocks(schema) } else { schema };
            assert_committed(&format!("../../schemas/{name}.schema.json"), &for_editors(&whole));
        }
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
