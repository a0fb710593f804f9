//! Scripts of a scene: which object each belongs to, its text, its limits; and the parser of their language.
//!
//! This crate knows no language. An adapter (`sincro-lua`) is a [`ScriptParser`], which looks texts over when a scene
//! is loaded.

use std::fmt;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Location, SourceText};

/// Script of a scene: its text, its settings and the object that it belongs to; run by a script engine such as
/// `sincro-lua`.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// Number of the object that it belongs to ([`Object::id`](crate::scene::Object)).
    pub object: usize,
    /// Path of that object.
    pub path: String,
    /// Text that locations refer to: the script's own file, or the scene file that contains it.
    pub source: Arc<SourceText>,
    /// Text of the script: the whole source, or the text of its key in the scene file.
    pub text: String,
    /// Number of lines of the source before the script's text.
    pub lines_before: usize,
    /// Parameters stored with it: name and value.
    pub parameters: Vec<(String, Parameter)>,
    /// Files that it may read: name in the scene, and text as it was when the scene was loaded.
    pub files: Vec<(String, Arc<SourceText>)>,
    /// Calling convention of its text.
    pub style: Style,
    /// Kind, which gives the order among the scripts of one object.
    pub kind: Kind,
    /// True if a script of the old style runs as a thread of its own.
    pub is_threaded: bool,
    /// Effect of an error in a call on the run.
    pub on_error: OnError,
    /// Upper limit of its memory, in bytes.
    pub max_memory: usize,
    /// Upper limit of the instructions of one call.
    pub max_instructions: u64,
    /// Location of its entry in the scene file.
    pub at: Location,
}

/// Value of a parameter that is stored with a script.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameter {
    /// Number, without a unit of its own.
    Number(f64),
    /// Truth value.
    Flag(bool),
    /// String.
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

/// Calling convention of a script, of two generations of CoppeliaSim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Detected by its text: `New` if it has a function `sysCall_…` after its first run, else `Old`.
    Detect,
    /// The whole text runs again for every call, with `sim_call_type` set.
    Old,
    /// Callback functions `sysCall_init`, `sysCall_actuation` and so on.
    New,
}

/// Effect of an error in a call of a script. A limit that is reached, and a number that is not finite, always stop the
/// run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnError {
    /// By its text: `Continue` if it is written for V-REP up to 3.4 (names such as `simGetObjectHandle` only), else
    /// `Stop`.
    Detect,
    /// The run stops.
    Stop,
    /// The run goes on, and its audit has a finding. A script for V-REP up to 3.4 is called again in the next step,
    /// as there; one for later versions is not called any more in the run.
    Continue,
}

/// Kind of a script; scripts of one object are called in the order of the variants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Child script, part of the simulation: it runs while a simulation runs.
    Child,
    /// Customization script, part of the model: it also runs outside of simulations.
    Customization,
}

/// Error of a script or controller that ends its run: where and why. Its text (`Display`) is a message for the user.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptError {
    /// Path of the object that the script belongs to, or name of the controller.
    pub object: String,
    /// Location of the line in the script's text, if it is known.
    pub at: Option<Location>,
    /// Message in English.
    pub message: String,
    /// Remedy in English, if one is known.
    pub help: Option<String>,
}

impl ScriptError {
    /// Returns the error as a diagnostic: at its line if that is known, with the path of the object in the message.
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

/// Specification of a control law written in a scripting language, for a block of a diagram; [`ScriptParser::law`]
/// compiles it.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptedLawSpec {
    /// Text with the function `output` and, with memory, `update`.
    pub code: String,
    /// Names of the inputs, in the order of the block's ports.
    pub inputs: Vec<String>,
    /// Names and widths (numbers of components) of the outputs, in the order of the block's ports.
    pub outputs: Vec<(String, usize)>,
    /// Names of the memory's numbers, in their order.
    pub memory: Vec<String>,
    /// Constants: name and value.
    pub parameters: Vec<(String, f64)>,
}

/// Compiled control law in a scripting language. It is a function of time, inputs and memory, and keeps nothing between
/// calls; the diagram keeps the memory.
pub trait ScriptedLaw: Send + Sync + fmt::Debug {
    /// Computes the outputs at time `t` `[s]`: `inputs` holds the components of each input, `memory` one number per
    /// name, `y` receives the components of all outputs one after the other, all in the order of the
    /// [`ScriptedLawSpec`].
    ///
    /// # Errors
    ///
    /// A message in English with line and cause, if the law fails or a result has another width.
    fn output(&mut self, t: f64, inputs: &[Vec<f64>], memory: &[f64], y: &mut [f64]) -> Result<(), String>;

    /// Replaces `memory` by that of the next tick, at time `t` `[s]`; arguments as in [`ScriptedLaw::output`].
    ///
    /// # Errors
    ///
    /// A message in English with line and cause, if the law fails.
    fn update(&mut self, t: f64, inputs: &[Vec<f64>], memory: &mut [f64]) -> Result<(), String>;

    /// Returns an independent copy of the law, for another run.
    fn boxed_clone(&self) -> Box<dyn ScriptedLaw>;
}

impl Clone for Box<dyn ScriptedLaw> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}

/// Parser of the scripting language, which checks scripts and compiles laws when a scene is loaded; given to it as
/// [`Loaders::scripts`](crate::fmu::Loaders::scripts).
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
    /// Checks the syntax of a script; nothing runs.
    ///
    /// # Errors
    ///
    /// The first syntax error with its location.
    fn check(&self, script: &Script) -> Result<(), ScriptError>;

    /// Compiles a control law for a block of a diagram.
    ///
    /// # Errors
    ///
    /// A message in English with the first error of the text.
    fn law(&self, spec: &ScriptedLawSpec) -> Result<Box<dyn ScriptedLaw>, String>;
}
