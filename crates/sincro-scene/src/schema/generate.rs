//! The schemas from the types that read files: how `generated/*.json` and `schemas/*.schema.json` are made.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

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
