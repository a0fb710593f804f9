//! Error of parameters that were refused.

use core::fmt;
use core::ops::Deref;

/// Error of parameters that were refused: all that is wrong with them, one sentence each, with the name of the
/// parameter, its value and what was expected. Dereferences to the list of sentences; displays them separated by
/// semicolons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidParameters(Vec<String>);

impl InvalidParameters {
    /// Creates the error of the given findings, one sentence each, lower case, without a full stop.
    #[must_use]
    pub fn new(findings: Vec<String>) -> Self {
        Self(findings)
    }
}

impl Deref for InvalidParameters {
    type Target = [String];

    fn deref(&self) -> &[String] {
        &self.0
    }
}

impl IntoIterator for InvalidParameters {
    type Item = String;
    type IntoIter = std::vec::IntoIter<String>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl fmt::Display for InvalidParameters {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("; "))
    }
}

impl std::error::Error for InvalidParameters {}
