//! The diagram file as it is written. Doc comments here become the descriptions in the JSON Schema.

use std::collections::BTreeMap;

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

/// A block diagram: blocks, and wires between their ports. SI units and radians.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(title = "sincro diagram"))]
pub(crate) struct DiagramFile {
    /// Sample time of all blocks that have none of their own; leave it out if there are continuous blocks [s].
    #[allow(dead_code)] // read from the document, with its positions
    pub sample_time: Option<NumberOrFormula>,
    /// Names and numbers for formulas in this file; the experiment's parameters are known too.
    #[serde(default)]
    #[allow(dead_code)] // read from the document, with its positions
    pub parameters: BTreeMap<String, NumberOrFormula>,
    /// Wires such as `"error -> pid -> /motor1"`, `"plant.x[0] -> error.u2"`, `"[a, b] -> norm"`; `/…` are the world's signals.
    #[serde(default)]
    pub wires: Vec<String>,
    /// Blocks.
    #[serde(default)]
    pub block: Vec<BlockFile>,
    /// Diagrams that can be used as blocks, any number of times.
    #[serde(default)]
    pub diagram: Vec<DefinitionFile>,
}

/// A diagram that can be used as a block: its name is the block's type.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct DefinitionFile {
    /// What blocks of this type give as `type`.
    pub name: String,
    /// What it is for.
    #[serde(default)]
    #[allow(dead_code)]
    pub description: String,
    /// Names of the ports through which signals come in.
    #[serde(default)]
    pub inputs: Vec<String>,
    /// Names of the ports through which signals go out.
    #[serde(default)]
    pub outputs: Vec<String>,
    /// Parameters with their defaults; a block of this type gives its own.
    #[serde(default)]
    pub parameters: BTreeMap<String, NumberOrFormula>,
    /// Sample time of all blocks in it that have none of their own [s].
    #[allow(dead_code)] // read from the document, with its positions
    pub sample_time: Option<NumberOrFormula>,
    /// Wires between its blocks and its ports.
    #[serde(default)]
    pub wires: Vec<String>,
    /// Its blocks.
    #[serde(default)]
    pub block: Vec<BlockFile>,
}

/// A block.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
pub(crate) struct BlockFile {
    /// Letters, digits, `_` and `-`.
    pub name: String,
    /// What it is: a block of the library, or a diagram of this file.
    #[serde(rename = "type")]
    pub kind: String,
    /// Time between two samples, a multiple of the experiment's step [s].
    #[allow(dead_code)] // read from the document, with its positions
    pub sample_time: Option<NumberOrFormula>,
    /// Unit of its outputs, such as `N·m`, or a list of one for each component; compared where two units meet.
    pub unit: Option<OneOrMany>,
    /// Its parameters.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, Value>,
}

/// One text, or a list of texts.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub(crate) enum OneOrMany {
    /// One for all.
    One(String),
    /// One for each.
    Many(Vec<String>),
}

impl OneOrMany {
    /// The texts; one alone if it is for all.
    pub fn texts(&self) -> &[String] {
        match self {
            Self::One(text) => std::slice::from_ref(text),
            Self::Many(texts) => texts,
        }
    }
}

/// A number, or a formula of the parameters.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
#[allow(dead_code)] // read from the document, with its positions
pub(crate) enum NumberOrFormula {
    /// A number.
    Number(f64),
    /// A formula of the parameters.
    Formula(String),
}
