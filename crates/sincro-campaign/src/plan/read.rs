//! Reading of a plan file: every problem in it at once, each at its place.

use std::path::Path;
use std::sync::Arc;

use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Location, SourceText};
use toml::Spanned;

use super::Plan;
use super::file::PlanFile;
use super::resolve::resolve;

/// Places in a plan file.
pub(super) struct Places {
    pub(super) source: Arc<SourceText>,
}

impl Places {
    pub(super) fn of<T>(&self, value: &Spanned<T>) -> Location {
        Location { source: self.source.clone(), span: value.span() }
    }

    pub(super) fn start(&self) -> Location {
        Location { source: self.source.clone(), span: 0..0 }
    }

    pub(super) fn error<T>(&self, value: &Spanned<T>, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(&self.of(value), message)
    }
}

/// Reads the text of a plan file.
pub(super) fn plan(path: &Path, text: String) -> Result<Plan, Diagnostics> {
    let source = Arc::new(SourceText { path: path.to_path_buf(), text });
    let file: PlanFile = toml::from_str(&source.text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        let at = Location { source: source.clone(), span };
        Diagnostic::error(&at, error.message().trim().to_owned())
    })?;
    resolve(file, &Places { source })
}
