//! Scripts of a scene: which object each belongs to, its text, its limits; and the parser of their language.
//!
//! This crate knows no language. An adapter (`sincro-lua`) is a [`ScriptParser`], which looks texts over when a scene
//! is loaded.

use std::fmt;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Location, SourceText};

/// A script as a scene has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// Index among the scene's objects.
    pub object: usize,
    /// Path of that object.
    pub path: String,
    /// The text that positions refer to: the script's own file, or the scene file that it stands in.
    pub source: Arc<SourceText>,
    /// The script's text: all of the source, or the text of its key.
    pub text: String,
    /// Lines of the source before the text.
    pub lines_before: usize,
    /// Numbers and texts that are stored with it.
    pub parameters: Vec<(String, Parameter)>,
    /// Files that it may read, by their names in the scene; their texts as they were when it was loaded.
    pub files: Vec<(String, Arc<SourceText>)>,
    /// Calling convention.
    pub style: Style,
    /// Order among the scripts of one object.
    pub kind: Kind,
    /// True if an old script is a thread of its own.
    pub is_threaded: bool,
    /// Memory that it may take `[bytes]`.
    pub max_memory: usize,
    /// Instructions that one call may take.
    pub max_instructions: u64,
    /// Its entry in the scene file.
    pub at: Location,
}

/// Parameter stored with a script.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameter {
    /// A number.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// A text.
    Text(String),
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(x) if x.fract() == 0.0 && x.abs() < 1e15 => write!(f, "{x:.0}"),
            Self::Number(x) => write!(f, "{x:?}"),
            Self::Flag(truth) => write!(f, "{truth}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// Calling convention of a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// As its text tells: `New` if it has a function `sysCall_…` after its first run, else `Old`.
    Detect,
    /// The whole text is run again for every call, with `sim_call_type` set.
    Old,
    /// Functions `sysCall_init`, `sysCall_actuation` …
    New,
}

/// Kinds of scripts, in the order in which those of one place are called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Belongs to the simulation.
    Child,
    /// Belongs to the model.
    Customization,
}

/// Error of a script: it cannot go on.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptError {
    /// Path of its object.
    pub object: String,
    /// The line of its text.
    pub at: Option<Location>,
    /// Message.
    pub message: String,
    /// Advice on a correction, if there is any.
    pub help: Option<String>,
}

impl ScriptError {
    /// The error as a finding in the script's text.
    #[must_use]
    pub fn diagnostic(&self) -> Diagnostic {
        let message = format!("script of `{}`: {}", self.object, self.message);
        let diagnostic = match &self.at {
            Some(at) => Diagnostic::error(at, message),
            None => Diagnostic::without_location(message),
        };
        match &self.help {
            Some(help) => diagnostic.with_help(help.clone()),
            None => diagnostic,
        }
    }
}

impl fmt::Display for ScriptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the script of `{}` failed", self.object)?;
        if let Some(at) = &self.at {
            let line = at.line_column().0;
            write!(f, " at {}:{line}, `{}`", at.source.path.display(), at.text().trim())?;
        }
        write!(f, ": {}", self.message)
    }
}

/// A law in a script's language, for a block of a diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptedLawSpec {
    /// Its text.
    pub code: String,
    /// Names of its inputs.
    pub inputs: Vec<String>,
    /// Names and widths of its outputs.
    pub outputs: Vec<(String, usize)>,
    /// Names of the numbers that it keeps.
    pub memory: Vec<String>,
    /// Numbers that it knows by name.
    pub parameters: Vec<(String, f64)>,
}

/// A law in memory. It keeps nothing between calls but what it is given.
pub trait ScriptedLaw: Send + Sync + fmt::Debug {
    /// Outputs, one after the other, at time `t` `[s]`.
    ///
    /// # Errors
    ///
    /// The law failed: where and why.
    fn output(&mut self, t: f64, inputs: &[Vec<f64>], memory: &[f64], y: &mut [f64]) -> Result<(), String>;

    /// Computes the memory for the next tick at time `t` `[s]`; `inputs` holds the components of each input.
    ///
    /// # Errors
    ///
    /// The law failed: where and why.
    fn update(&mut self, t: f64, inputs: &[Vec<f64>], memory: &mut [f64]) -> Result<(), String>;

    /// Another one of the same.
    fn boxed_clone(&self) -> Box<dyn ScriptedLaw>;
}

impl Clone for Box<dyn ScriptedLaw> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}

/// Parser of the language of scripts: looks texts over when a scene is loaded.
///
/// ```
/// use sincro_scene::fmu::Loaders;
/// use sincro_scene::open::open;
/// use sincro_scene::script::{Script, ScriptError, ScriptParser, ScriptedLaw, ScriptedLawSpec};
///
/// /// Refuses all scripts: for a program without a language of scripts.
/// #[derive(Debug)]
/// struct NoScripts;
///
/// impl ScriptParser for NoScripts {
///     fn check(&self, script: &Script) -> Result<(), ScriptError> {
///         let (object, message) = (script.path.clone(), "scripts are switched off".into());
///         Err(ScriptError { object, at: Some(script.at.clone()), message, help: None })
///     }
///     fn law(&self, spec: &ScriptedLawSpec) -> Result<Box<dyn ScriptedLaw>, String> {
///         Err(format!("a law of {} inputs in a script: scripts are switched off", spec.inputs.len()))
///     }
/// }
///
/// # fn main() -> Result<(), sincro_scene::diagnostic::Diagnostics> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/propeller-lua");
/// let loaders = Loaders { scripts: Some(&NoScripts), ..Loaders::default() };
/// let found = open(folder.as_ref(), &[], loaders, true).unwrap_err();
/// assert!(found.to_string().contains("scripts are switched off"), "{found}");
/// # Ok(())
/// # }
/// ```
pub trait ScriptParser: Send + Sync + fmt::Debug {
    /// Checks the syntax of a script before anything runs.
    ///
    /// # Errors
    ///
    /// The first fault of the text.
    fn check(&self, script: &Script) -> Result<(), ScriptError>;

    /// Compiles the text of a law for a block of a diagram.
    ///
    /// # Errors
    ///
    /// The first fault of the text, in words.
    fn law(&self, spec: &ScriptedLawSpec) -> Result<Box<dyn ScriptedLaw>, String>;
}
