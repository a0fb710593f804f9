//! Diagnostics of the builder: errors and warnings about the objects of a model.

use super::NodeId;

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The model cannot be built.
    Error,
    /// The model can be built, with numbers that are probably not meant.
    Warning,
}

/// Diagnostic about one object.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// The object, none where the model as a whole is meant.
    pub node: Option<NodeId>,
    /// Name of the property, as the builder's fields are called (`mass`, `axis`, …).
    pub field: &'static str,
    /// Defect, with the value.
    pub message: String,
    /// Correction that would help.
    pub help: String,
}
