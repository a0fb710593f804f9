//! Diagnostics of the files of a scene, with their locations: one type for every reader, from TOML syntax to physics.
//!
//! A [`Diagnostic`] points at bytes of a [`SourceText`]; [`Diagnostics`] are all that were found, in the order of the
//! files. The plain rendering is here; the command line draws prettier ones from the same data.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

pub use sincro_dynamics::model::Severity;

/// Text that diagnostics refer to: that of a file, or the argument of `--set`.
#[derive(Debug, PartialEq, Eq)]
pub struct SourceText {
    /// Path of the file as it is shown to the user; `--set` and the like for other texts.
    pub path: PathBuf,
    /// Whole text.
    pub text: String,
}

impl SourceText {
    /// Returns line and column of the byte with index `byte`, both counted from 1, columns in characters. A byte beyond
    /// the end stands for the end.
    #[must_use]
    pub fn line_column(&self, byte: usize) -> (usize, usize) {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        let before = &self.text[..byte];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        (1 + before.matches('\n').count(), 1 + before[line_start..].chars().count())
    }
}

/// Location in a text: a range of its bytes, which a diagnostic points at.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let found = from_text(r#"joint = [{ name = "hinge", kind = "revolut" }]"#).unwrap_err();
/// let of_kind = found.0.iter().find(|diagnostic| diagnostic.message.contains("revolut")).unwrap();
/// let at = Location { source: of_kind.source.clone().unwrap(), span: of_kind.span.clone().unwrap() };
/// assert_eq!((at.line_column(), at.text()), ((1, 35), "\"revolut\""));
/// assert_eq!(at.to_string(), "scene.toml:1:35");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// Text that the range lies in.
    pub source: Arc<SourceText>,
    /// Range of bytes of the text, from 0, the end excluded.
    pub span: Range<usize>,
}

impl Location {
    /// Returns line and column of the first character, both counted from 1.
    #[must_use]
    pub fn line_column(&self) -> (usize, usize) {
        self.source.line_column(self.span.start)
    }

    /// Returns the text that the location covers; empty if the range lies outside of the text.
    #[must_use]
    pub fn text(&self) -> &str {
        self.source.text.get(self.span.clone()).unwrap_or("")
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, column) = self.line_column();
        write!(f, "{}:{line}:{column}", self.source.path.display())
    }
}

/// Value together with the location at which the user wrote it, so that messages can point there.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// Value as it was read.
    pub value: T,
    /// Location of the value in its file.
    pub at: Location,
}

/// Error or warning about the user's files: severity, message, location, and a remedy where one is known. Its text
/// (`Display`) is `path:line:column: error: message` with a line `help:`.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let found = Diagnostic::without_location("there is no folder `pendulum`").with_help("name a folder");
/// assert!(found.is_error() && !found.clone().as_warning().is_error());
/// assert_eq!(found.to_string(), "error: there is no folder `pendulum`\n  help: name a folder");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Severity: error or warning.
    pub severity: Severity,
    /// Text that it is about; `None` where there is no text, as for a folder that does not exist.
    pub source: Option<Arc<SourceText>>,
    /// Range of bytes that it is about; `None` where the whole text is meant.
    pub span: Option<Range<usize>>,
    /// Message: in lower case, names in backticks, with the value as it was found.
    pub message: String,
    /// Remedy in English, if one is known.
    pub help: Option<String>,
}

impl Diagnostic {
    /// Creates an error with the message `message` (lower case, names in backticks) at a location in a file, without a
    /// remedy.
    #[must_use]
    pub fn error(at: &Location, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            source: Some(at.source.clone()),
            span: Some(at.span.clone()),
            message: message.into(),
            help: None,
        }
    }

    /// Creates an error with the message `message` that belongs to no text, such as for a folder that does not exist.
    #[must_use]
    pub fn without_location(message: impl Into<String>) -> Self {
        Self { severity: Severity::Error, source: None, span: None, message: message.into(), help: None }
    }

    /// Returns the same diagnostic as a warning, which does not keep a scene from running.
    #[must_use]
    pub fn as_warning(self) -> Self {
        Self { severity: Severity::Warning, ..self }
    }

    /// Returns the diagnostic with the remedy `help`, in place of an earlier one; it is shown behind `help:`.
    #[must_use]
    pub fn with_help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// Returns line and column of the first character it is about, both counted from 1; `None` if it has no location.
    #[must_use]
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let source = self.source.as_ref()?;
        Some(source.line_column(self.span.as_ref()?.start))
    }

    /// Returns true if the severity is error, false if it is warning.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(source) = &self.source {
            write!(f, "{}:", source.path.display())?;
            if let Some((line, column)) = self.line_column() {
                write!(f, "{line}:{column}:")?;
            }
            f.write_str(" ")?;
        }
        let severity = if self.is_error() { "error" } else { "warning" };
        write!(f, "{severity}: {}", self.message)?;
        match &self.help {
            Some(help) => write!(f, "\n  help: {help}"),
            None => Ok(()),
        }
    }
}

/// List of all errors and warnings about the files of a scene, which a reader returns at once and not one by one.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// // all that is wrong with a scene at once, in the order of the file
/// let found = from_text(r#"body = [{ name = "a", mass = -1.0 }, { name = "b", mas = 1.0 }]"#).unwrap_err();
/// assert!(found.any_error() && found.0.len() >= 2);
/// assert!(found.0.iter().all(|diagnostic: &Diagnostic| diagnostic.line_column().is_some()));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnostics(pub Vec<Diagnostic>);

impl Diagnostics {
    /// Creates an empty list, to which a reader adds what it finds.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends an error or warning at the end of the list.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Appends the diagnostics of `other` that are not in this list yet.
    pub fn merge(&mut self, other: Self) {
        for diagnostic in other.0 {
            if !self.0.contains(&diagnostic) {
                self.0.push(diagnostic);
            }
        }
    }

    /// Returns true if the list contains an error; warnings alone do not count.
    #[must_use]
    pub fn any_error(&self) -> bool {
        self.0.iter().any(Diagnostic::is_error)
    }

    /// Returns the list ordered by location: file by file in the order in which they first occur, in each by position.
    #[must_use]
    pub fn sorted(mut self) -> Self {
        let mut files: Vec<Option<PathBuf>> = Vec::new();
        let rank = |diagnostic: &Diagnostic, files: &mut Vec<Option<PathBuf>>| {
            let path = diagnostic.source.as_ref().map(|s| s.path.clone());
            files.iter().position(|known| *known == path).unwrap_or_else(|| {
                files.push(path);
                files.len() - 1
            })
        };
        let mut keyed: Vec<_> =
            self.0.drain(..).map(|p| (rank(&p, &mut files), p.span.as_ref().map_or(0, |s| s.start), p)).collect();
        keyed.sort_by_key(|(file, byte, _)| (*file, *byte));
        Self(keyed.into_iter().map(|(_, _, p)| p).collect())
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Self {
        Self(vec![diagnostic])
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, diagnostic) in self.0.iter().enumerate() {
            let separator = if k == 0 { "" } else { "\n" };
            write!(f, "{separator}{diagnostic}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, span: Range<usize>) -> Location {
        Location { source: Arc::new(SourceText { path: "a.toml".into(), text: text.into() }), span }
    }

    #[test]
    fn columns_count_characters_and_lines_count_from_one() {
        let place = at("é = 1\nmass° = 2\n", 16..17);
        assert_eq!(place.text(), "2");
        assert_eq!(place.to_string(), "a.toml:2:9");
        assert_eq!(place.source.line_column(usize::MAX), (3, 1));
        assert_eq!(place.source.line_column(1), (1, 1), "inside a character is at it");
    }

    #[test]
    fn problems_read_well_without_colour() {
        let place = at("step = 0\n", 7..8);
        let diagnostic = Diagnostic::error(&place, "`step` is 0").with_help("give a positive number");
        let diagnostics = Diagnostics(vec![diagnostic.clone(), diagnostic.as_warning()]);
        assert_eq!(
            diagnostics.to_string(),
            "a.toml:1:8: error: `step` is 0\n  help: give a positive number\na.toml:1:8: warning: `step` is 0\n  help: \
             give a positive number"
        );
    }

    #[test]
    fn sorting_keeps_files_apart() {
        let (b, a) = (at("123", 2..3), at("123", 0..1));
        let other = Location { source: Arc::new(SourceText { path: "b.toml".into(), text: "x".into() }), span: 0..1 };
        let diagnostics =
            Diagnostics(vec![Diagnostic::error(&b, "1"), Diagnostic::error(&other, "2"), Diagnostic::error(&a, "3")]);
        let order: Vec<String> = diagnostics.sorted().0.into_iter().map(|p| p.message).collect();
        assert_eq!(order, ["3", "1", "2"]);
    }
}
