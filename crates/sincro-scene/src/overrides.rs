//! Settings from outside the files: `--set PATH=VALUE`, and the `set` table of a variant.
//!
//! | path | reaches |
//! |---|---|
//! | `/arm/link.inertia.xx` | a key of the scene's object of that path |
//! | `/arm.parameters.m` | a parameter of the file of the instance of that path, or of that form: `/ball*.parameters.r` |
//! | `gravity.2` | a key of the scene file |
//! | `step`, `parameters.m`, `sweep.range.to` | a key of the experiment file; parameters of included files are its own |
//! | `pid.kp`, `diagram.step.to` | a parameter of the diagram's block of that name (`diagram.` where the name is also a key above) |
//!
//! List entries are counted from 0: `axis.2` or `axis[2]`. A path must be known to the schema; what the file leaves out
//! is filled in.

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Located, Location, SourceText};

/// Setting `PATH=VALUE` that changes a value of the scene's files before they are read, as `--set` takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    /// Path of the value, such as `/arm.mass` (scene), `duration` (experiment) or `controller.gain` (diagram).
    pub path: Located<String>,
    /// New value as text: TOML, or a bare word that stands for a string; numbers in the unit of the key.
    pub value: Located<String>,
}

impl Override {
    /// Creates the setting of `value` (TOML, or a bare word as a string) at `path`; neither is checked before it is
    /// applied.
    #[must_use]
    pub fn new(path: &str, value: &str) -> Self {
        let text = format!("{path}={value}");
        let source = Arc::new(SourceText { path: "--set".into(), text });
        let part = |from: usize, part: &str| {
            let at = Location { source: source.clone(), span: from..from + part.len() };
            Located { value: part.to_owned(), at }
        };
        Self { path: part(0, path), value: part(path.len() + 1, value) }
    }

    /// Parses an argument of `--set`, `PATH=VALUE`.
    ///
    /// # Errors
    ///
    /// A diagnostic if there is no `=`, or nothing before or after it.
    ///
    /// ```
    /// use sincro_scene::overrides::Override;
    ///
    /// assert_eq!(Override::parse("/arm.spring.stiffness=30").unwrap().value.value, "30");
    /// assert!(Override::parse("/arm.spring.stiffness").is_err());
    /// ```
    pub fn parse(text: &str) -> Result<Self, Diagnostic> {
        let source = Arc::new(SourceText { path: "--set".into(), text: text.to_owned() });
        let whole = Location { source, span: 0..text.len() };
        let help = "write PATH=VALUE, such as /shoulder.spring.stiffness=30 or step=0.001";
        let Some((path, value)) = text.split_once('=') else {
            return Err(Diagnostic::error(&whole, format!("`{text}` has no `=`")).with_help(help));
        };
        let (path, value) = (path.trim(), value.trim());
        if path.is_empty() || value.is_empty() {
            let lacking = if path.is_empty() { "path before" } else { "value after" };
            return Err(Diagnostic::error(&whole, format!("`{text}` has no {lacking} the `=`")).with_help(help));
        }
        Ok(Self::new(path, value))
    }
}
