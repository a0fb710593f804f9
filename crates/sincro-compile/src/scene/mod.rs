//! A scene exported as C99: plant, controller, and both in lock-step, with a self-test.
//!
//! | file | content |
//! |---|---|
//! | `NAME.h` | sizes, indices with names and units, structures, functions |
//! | `NAME.c` | the functions: no library, no allocation, no state of their own |
//! | `NAME_test.c` | self-test: runs the experiment and compares every bit of every state by a hash |
//! | `README.md` | what is in it, what is not and why, how to compile and call it |
//!
//! Before anything is written, each program is evaluated beside the algorithm that it was recorded from, the closed
//! loop over the whole reference run; one different bit leaves the part out.

mod names;
mod parts;
mod test_program;
mod text;

use sincro_dynamics::ids::BodyId;
use sincro_dynamics::model::Model;
use sincro_dynamics::state::State;
use sincro_dynamics::world::MethodKind;
use sincro_math::signal::Signal;
use sincro_scene::diagram::ControlDiagram;

use crate::Obstacle;
use parts::Parts;

/// Scene to be exported: argument of [`export`].
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Name of the files and first part of the names of functions: a C identifier.
    pub name: &'a str,
    /// Title of the experiment.
    pub title: &'a str,
    /// Model of the plant.
    pub model: &'a Model<f64>,
    /// Initial state.
    pub initial: &'a State<f64>,
    /// The scene's signals for the commands, in the order of the command vector.
    pub commands: &'a [Signal],
    /// Diagram that controls the plant.
    pub diagram: Option<&'a ControlDiagram>,
    /// Integration method.
    pub method: MethodKind,
    /// Base step `[s]`.
    pub h: f64,
    /// Reference run, from its start on.
    pub reference: &'a [ReferenceTick],
    /// Reason for which plant and diagram alone are not the experiment, if there is one.
    pub not_closed: Option<&'a str>,
}

/// State of the reference run at a tick, after the diagram was evaluated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferenceTick {
    /// Coordinates (n_q).
    pub q: Vec<f64>,
    /// Velocities (n_v).
    pub v: Vec<f64>,
    /// Rotor states.
    pub rotors: Vec<f64>,
    /// Signals of the diagram; empty without one.
    pub signals: Vec<f64>,
}

/// Exported scene: result of [`export`].
#[derive(Clone, Debug)]
pub struct Exported {
    /// Names and contents of the files.
    pub files: Vec<(String, String)>,
    /// Parts that are exported: name and number of operations.
    pub parts: Vec<(&'static str, usize)>,
    /// Parts that are not, each with the reason.
    pub missing: Vec<(&'static str, Obstacle)>,
    /// Steps that the self-test makes; 0 if the closed loop is missing.
    pub n_test_steps: usize,
    /// Hash that the self-test expects.
    pub hash: u64,
}

/// Exports a scene as C. What cannot be compiled is left out, and the result says why.
///
/// # Errors
///
/// [`Obstacle`] if nothing can be compiled.
pub fn export(request: &Request<'_>) -> Result<Exported, Obstacle> {
    let parts = Parts::compile(request);
    if parts.functions.is_empty() && parts.controller.is_none() {
        let reason = parts.missing.first().map_or("it is empty".to_owned(), |(part, why)| format!("{part}: {why}"));
        return Err(Obstacle::new(reason));
    }
    let test = test_program::TestProgram::new(request, &parts);
    let name = request.name;
    let files = vec![
        (format!("{name}.h"), text::header(request, &parts)),
        (format!("{name}.c"), text::source(request, &parts)),
        (format!("{name}_test.c"), test.text),
        ("README.md".to_owned(), text::readme(request, &parts, test.n_steps, test.hash)),
    ];
    Ok(Exported { files, parts: parts.sizes(), missing: parts.missing, n_test_steps: test.n_steps, hash: test.hash })
}

/// Bodies and frames of a model, by id.
fn frames(model: &Model<f64>) -> impl Iterator<Item = BodyId> {
    (0..model.names().frames.len()).map(BodyId::new)
}
