//! The schema of experiment files.

use std::sync::LazyLock;

use serde_json::Value;

use crate::schema::parse;

/// Returns the JSON Schema of `experiment.toml`, generated from the types that read it; made once.
pub fn experiment_schema() -> &'static Value {
    static SCHEMA: LazyLock<Value> = LazyLock::new(|| parse(include_str!("../schema/generated/experiment.json")));
    &SCHEMA
}
