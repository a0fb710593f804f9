//! Errors and warnings of an import, collected: an import is refused with all of them.

use sincro_scene::diagnostic::{Diagnostic, Diagnostics};

/// Collector of diagnostics.
#[derive(Debug, Default)]
pub(crate) struct Findings(pub Diagnostics);

impl Findings {
    /// Adds an error.
    pub fn error(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Adds a warning.
    pub fn warn(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic.as_warning());
    }

    /// The value of a result; its error is noted.
    pub fn take<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        result.map_err(|diagnostic| self.error(diagnostic)).ok()
    }
}
