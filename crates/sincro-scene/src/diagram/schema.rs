//! The schema of diagram files: that of the structure from its types, that of every block's parameters from the
//! library.

use std::sync::LazyLock;

use serde_json::{Map, Value, json};
use sincro_blocks::kind::{Kind, Parameter, ValueKind};
use sincro_blocks::library;

use super::robot;
use crate::schema::parse;

/// Returns the JSON Schema of `diagram.toml`, generated from the blocks; made once.
pub fn diagram_schema() -> &'static Value {
    static SCHEMA: LazyLock<Value> =
        LazyLock::new(|| with_blocks(parse(include_str!("../schema/generated/diagram.json"))));
    &SCHEMA
}

/// Adds to the schema of the structure, for each type of block, the parameters that it takes.
pub(crate) fn with_blocks(mut schema: Value) -> Value {
    let kinds = library::all().map(|item| item.kind).chain(robot::all().map(|item| item.kind));
    let rules: Vec<Value> = kinds.map(rule).collect();
    if let Some(block) = schema.pointer_mut("/$defs/BlockFile").and_then(Value::as_object_mut) {
        block.insert("allOf".into(), Value::Array(rules));
    }
    schema
}

/// If the block is of this kind, then it takes these parameters.
fn rule(kind: &Kind) -> Value {
    let mut properties = Map::new();
    for parameter in kind.parameters {
        properties.insert(parameter.name.into(), schema_of(parameter));
    }
    let required: Vec<&str> = kind.parameters.iter().filter(|p| p.default.is_none()).map(|p| p.name).collect();
    let description = format!("{} {}", kind.summary, kind.equation);
    json!({
        "if": {"properties": {"type": {"const": kind.name}}},
        "then": {"description": description, "properties": properties, "required": required}
    })
}

fn schema_of(parameter: &Parameter) -> Value {
    let number = json!(["number", "string"]);
    let mut schema = match parameter.takes {
        ValueKind::Number | ValueKind::Positive | ValueKind::Count => json!({"type": number}),
        ValueKind::Numbers => json!({"type": ["number", "string", "array"], "items": {"type": number}}),
        ValueKind::Matrix => json!({"type": ["number", "string", "array"]}),
        ValueKind::Flag => json!({"type": "boolean"}),
        ValueKind::Text | ValueKind::File => json!({"type": "string"}),
        ValueKind::Texts => json!({"type": ["string", "array"], "items": {"type": ["string", "number", "array"]}}),
        ValueKind::Names | ValueKind::NumberLists => json!({"type": "object"}),
        ValueKind::Choice(words) => json!({"enum": words}),
    };
    let description = match parameter.default {
        Some(default) => format!("{} (default {default})", parameter.meaning()),
        None => parameter.meaning().to_owned(),
    };
    schema["description"] = description.into();
    schema
}
