//! The schema of experiment files.

use std::sync::LazyLock;

use serde_json::Value;

use super::ExperimentFile;
use crate::schema::generate;

/// Returns the JSON Schema of `experiment.toml`, generated from the types that read it; made once.
pub fn experiment_schema() -> &'static Value {
    static SCHEMA: LazyLock<Value> = LazyLock::new(generate::<ExperimentFile>);
    &SCHEMA
}
