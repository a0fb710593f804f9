//! The schema of experiment files.

use std::sync::LazyLock;

use serde_json::Value;

use super::ExperimentFile;
use crate::schema::generate;

/// JSON Schema of `experiment.toml`.
pub fn experiment_schema() -> &'static Value {
    static SCHEMA: LazyLock<Value> = LazyLock::new(generate::<ExperimentFile>);
    &SCHEMA
}
