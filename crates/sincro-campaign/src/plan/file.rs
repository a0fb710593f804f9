//! Plan file as it is written: TOML with the places of its parts.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

/// A plan file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlanFile {
    #[serde(default)]
    pub(super) title: String,
    #[serde(default)]
    pub(super) description: String,
    /// Absent in the `[campaign]` of an experiment, whose scene is its own folder.
    pub(super) scene: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) seed: u64,
    pub(super) runs: Option<Spanned<u64>>,
    pub(super) design: Option<Spanned<String>>,
    pub(super) confidence: Option<Spanned<f64>>,
    #[serde(default)]
    pub(super) random_seeds: bool,
    pub(super) rows_per_part: Option<Spanned<u64>>,
    /// Signals of which the whole series of every run is kept, and every how many recorded rows.
    #[serde(default)]
    pub(super) signals: Vec<Spanned<String>>,
    pub(super) signals_every: Option<Spanned<u64>>,
    #[serde(default)]
    pub(super) variants: Vec<Spanned<String>>,
    pub(super) checks: Option<Spanned<ChecksFile>>,
    #[serde(default)]
    pub(super) set: BTreeMap<Spanned<String>, Spanned<toml::Value>>,
    #[serde(default)]
    pub(super) parameter: Vec<Spanned<ParameterFile>>,
    #[serde(default)]
    pub(super) correlation: Vec<Spanned<CorrelationFile>>,
    #[serde(default)]
    pub(super) measure: Vec<Spanned<MeasureFile>>,
}

/// An experiment file, of which its campaign alone is read here.
#[derive(Debug, Deserialize)]
pub(super) struct ExperimentFile {
    pub(super) campaign: Option<PlanFile>,
}

/// Checks of the scene that are measured: all, none, or some by their names.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum ChecksFile {
    Word(String),
    Names(Vec<String>),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterFile {
    pub(super) name: Option<String>,
    pub(super) path: Spanned<String>,
    #[serde(default)]
    pub(super) also: Vec<Spanned<String>>,
    #[serde(default)]
    pub(super) unit: String,
    #[serde(default)]
    pub(super) integer: bool,
    pub(super) uniform: Option<Bounds>,
    pub(super) log_uniform: Option<Bounds>,
    pub(super) normal: Option<Normal>,
    pub(super) log_normal: Option<LogNormal>,
    pub(super) values: Option<Vec<f64>>,
    pub(super) range: Option<Range>,
    pub(super) table: Option<TableFile>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Bounds {
    pub(super) from: f64,
    pub(super) to: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Normal {
    pub(super) mean: f64,
    pub(super) std: f64,
    pub(super) min: Option<f64>,
    pub(super) max: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LogNormal {
    pub(super) median: f64,
    pub(super) sigma: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Range {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) points: usize,
    #[serde(default)]
    pub(super) log: bool,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TableFile {
    pub(super) file: Spanned<String>,
    pub(super) column: Spanned<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CorrelationFile {
    pub(super) between: [String; 2],
    pub(super) value: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeasureFile {
    pub(super) name: String,
    pub(super) signal: Option<Spanned<String>>,
    pub(super) formula: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) signals: BTreeMap<String, Spanned<String>>,
    pub(super) measure: Option<Spanned<String>>,
    pub(super) at: Option<f64>,
    pub(super) window: Option<[f64; 2]>,
    pub(super) target: Option<f64>,
    pub(super) band: Option<f64>,
    #[serde(default)]
    pub(super) unit: String,
    pub(super) at_most: Option<f64>,
    pub(super) at_least: Option<f64>,
}
