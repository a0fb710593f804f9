//! Diagnostics of the builder: errors and warnings about the objects of a model.

use core::fmt;
use core::ops::Deref;

use super::NodeId;

/// Severity of a [`Diagnostic`]: whether the model can be built in spite of it.
///
/// ```
/// use sincro_dynamics::model::{ModelBuilder, Severity};
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0; 3]);
/// builder.joint("hinge", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Revolute { axis: [0.0; 3] }));
/// let error = builder.build().unwrap_err();
/// assert!(error.iter().any(|diagnostic| diagnostic.severity == Severity::Error && diagnostic.field == "axis"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The model cannot be built.
    Error,
    /// The model can be built, with numbers that are probably not meant.
    Warning,
}

/// Diagnostic about one object of a model under construction: an error in a [`BuildError`], or a warning returned by
/// [`ModelBuilder::build`](super::ModelBuilder::build).
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// Id of the object in the builder; `None` where the model as a whole is meant.
    pub node: Option<NodeId>,
    /// Name of the field in the builder's specification, such as `mass` or `axis`.
    pub field: &'static str,
    /// Description of the defect, with the name of the object and the value.
    pub message: String,
    /// Suggested correction.
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
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// let base = builder.joint("base", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
/// let mass = MassProperties { mass: -1.0, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 5.0] };
/// let body = builder.body("body", base, Pose::identity(), BodySpec { mass });
/// let error = builder.build().unwrap_err();
/// let of_mass = error.iter().find(|diagnostic| diagnostic.field == "mass").unwrap();
/// assert!(of_mass.node == Some(body) && of_mass.message.contains("-1") && !of_mass.help.is_empty());
/// ```
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
