//! Error of parameters that were refused.

use core::fmt;
use core::ops::Deref;

/// Parameters that were refused: all that is wrong with them, one sentence each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidParameters(Vec<String>);

impl InvalidParameters {
    /// Error with its findings, one sentence each.
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
