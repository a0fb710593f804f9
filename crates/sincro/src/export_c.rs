//! Exporting a scene as C99: the plant, its controller, and a self-test against the run.

use sincro_compile::scene::{ReferenceTick, Request, export};
use sincro_sim::prelude::*;

pub use sincro_compile::Obstacle;
pub use sincro_compile::scene::Exported;

/// Most steps of the reference run that the self-test makes again.
const MAX_STEPS: u64 = 20_000;

/// Exports a loaded scene as C in memory ([`Exported::files`]). `name` starts the names of files and functions: letters
/// and digits are kept, all else becomes `_`. What cannot be compiled is left out, and the result says why.
///
/// # Errors
///
/// [`Obstacle`] if nothing of the scene can be compiled.
///
/// ```
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/double-pendulum");
/// let loaded = sincro::load(folder.as_ref(), &[]).unwrap();
/// let exported = sincro::export_c::export_c(&loaded, "double-pendulum").unwrap();
/// assert!(exported.files.iter().any(|(name, _)| name == "double_pendulum.c"));
/// ```
pub fn export_c(loaded: &Loaded, name: &str) -> Result<Exported, Obstacle> {
    let name = identifier(name);
    let (method, _) = method_for(loaded);
    let scene = &loaded.scene;
    let other = match () {
        () if !scene.scripts.is_empty() => Some("a script of the scene acts on it"),
        () if !loaded.controllers.is_empty() => Some("a controller of the program acts on it"),
        () => None,
    };
    let reference = if other.is_none() { reference(loaded) } else { Vec::new() };
    export(&Request {
        name: &name,
        title: &loaded.experiment.title,
        model: &scene.model,
        initial: &scene.initial,
        commands: &scene.commands,
        diagram: loaded.controller.as_ref(),
        method,
        h: loaded.experiment.step,
        reference: &reference,
        not_closed: other,
    })
}

/// Parts of a loaded scene that can be compiled into straight-line programs, as batches run them; each with the reason
/// why not. [`export_c`] leaves out programs that call functions other than sines and square roots.
#[derive(Clone, Debug)]
pub struct Compilable {
    /// Whole step of the run's method.
    pub step: Result<(), Obstacle>,
    /// Accelerations and other rates of the mechanism, which methods with error control evaluate.
    pub rates: Result<(), Obstacle>,
    /// Block diagram; `None` without one.
    pub diagram: Option<Result<(), Obstacle>>,
}

/// Finds out what of a scene can be compiled.
///
/// ```
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/box-push");
/// let loaded = sincro::load(folder.as_ref(), &[]).unwrap();
/// let obstacle = sincro::export_c::compilable(&loaded).step.unwrap_err();
/// assert!(obstacle.to_string().starts_with("the model has contacts"));
/// ```
#[must_use]
pub fn compilable(loaded: &Loaded) -> Compilable {
    let (method, _) = method_for(loaded);
    let (model, wiring) = (&loaded.scene.model, loaded.controller.as_ref().map(|controller| &controller.wiring));
    let diagram = wiring.map(|wiring| {
        sincro_compile::diagram::compile(wiring.program())?;
        sincro_compile::diagram::measurements(wiring).map(|_| ())
    });
    let step = sincro_compile::plant::step(&[model], method, loaded.experiment.step).map(|_| ());
    Compilable { step, rates: sincro_compile::plant::rates(model).map(|_| ()), diagram }
}

/// States of the run, up to where it halts.
fn reference(loaded: &Loaded) -> Vec<ReferenceTick> {
    let (method, _) = method_for(loaded);
    if sincro_compile::plant::check(&loaded.scene.model, method).is_err() {
        return Vec::new();
    }
    let mut run = LockStep::new(loaded, method, false);
    let mut ticks = Vec::new();
    if run.start().is_err() {
        return ticks;
    }
    for k in 0..=loaded.experiment.n_steps.min(MAX_STEPS) {
        if k > 0 && run.advance().is_err() {
            break;
        }
        let state = run.state();
        ticks.push(ReferenceTick {
            q: state.q.clone(),
            v: state.v.clone(),
            rotors: state.rotors.clone(),
            signals: run.control().map_or_else(Vec::new, |control| control.signals().to_vec()),
        });
    }
    ticks
}

/// Identifier of C for a name.
fn identifier(name: &str) -> String {
    let text: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if text.starts_with(|c: char| c.is_ascii_digit()) || text.is_empty() { format!("scene_{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::compilable;

    #[test]
    fn what_can_be_compiled_is_told_with_the_reason_why_not() {
        let (control, contacts, branch) =
            ("differ in length", "the model has contacts", "it branches on a computed number");
        for (scene, set, step, rates) in [
            ("double-pendulum", "rk4", None, None),
            ("double-pendulum", "dormand-prince", Some(control), None),
            ("two-dof-position", "implicit", None, None),
            ("box-push", "implicit", Some(contacts), Some(contacts)),
            ("quadrotor-hover", "rk4", Some(branch), Some(branch)),
        ] {
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(scene);
            let set = sincro_scene::overrides::Override::new("integrator", &format!("\"{set}\""));
            let said = compilable(&crate::load(&folder, &[set]).unwrap());
            for (found, expected) in [(&said.step, step), (&said.rates, rates)] {
                let why = found.as_ref().err().map(ToString::to_string);
                let is_told = match expected {
                    Some(words) => why.as_ref().is_some_and(|why| why.contains(words)),
                    None => why.is_none(),
                };
                assert!(is_told, "{scene}: {said:?}");
            }
            assert_eq!(said.diagram.is_some(), scene == "two-dof-position");
        }
    }
}
