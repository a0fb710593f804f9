//! Diagnostics of the builder: errors and warnings about the objects of a model.

use core::fmt;
use core::ops::Deref;

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

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{severity}: {}", self.message)
    }
}

/// Error of [`ModelBuilder::build`](super::ModelBuilder::build): all diagnostics, warnings too, at least one of them an
/// error.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildError(pub(crate) Vec<Diagnostic>);

impl Deref for BuildError {
    type Target = [Diagnostic];

    fn deref(&self) -> &[Diagnostic] {
        &self.0
    }
}

impl From<BuildError> for Vec<Diagnostic> {
    fn from(error: BuildError) -> Self {
        error.0
    }
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: Vec<String> = self.0.iter().map(ToString::to_string).collect();
        f.write_str(&lines.join("\n"))
    }
}

impl std::error::Error for BuildError {}
