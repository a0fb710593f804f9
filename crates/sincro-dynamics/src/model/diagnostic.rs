//! What can be wrong with a model.

use super::NodeId;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The model cannot be built.
    Error,
    /// It can, but the user should know.
    Warning,
}

/// One finding about one object.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// The object, none where the model as a whole is meant.
    pub node: Option<NodeId>,
    /// Name of the property, as the builder's fields are called (`mass`, `axis`, …).
    pub field: &'static str,
    /// What is wrong, with the value.
    pub message: String,
    /// How to mend it.
    pub help: String,
}
