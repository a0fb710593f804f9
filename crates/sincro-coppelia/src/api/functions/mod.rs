//! The functions of the regular API by name: `sim.getJointPosition` for every adapter.
//!
//! Each file holds a category of functions; [`call`] finds them by their present names, the names of V-REP
//! (`simGetJointPosition`) and those in between. Units and conventions are the API's own: SI, radians, quaternions x y
//! z w. The functions of an adapter itself (stepping, waiting, scripts) are not here.

mod bits;
mod bodies;
mod buffers;
mod clouds;
mod collections;
mod control;
mod deferred;
mod distances;
mod drawings;
mod filters;
mod graphs;
pub mod ik;
mod ik_groups;
mod images;
mod joints;
mod motions;
mod moves;
mod objects;
mod partly;
mod path_objects;
mod paths;
mod planning;
mod poses;
mod properties;
mod radio;
mod rotations;
mod scripts;
mod selection;
mod sensing;
mod shapes;
mod signals;
mod textures;
mod touching;
mod transforms;
mod tubes;
mod ui;
mod vision;
mod waiting;
mod windows;

use std::collections::BTreeMap;
use std::sync::OnceLock;

use super::constants::{HANDLE_FLAGS, HANDLE_JOINT_BASE};
use super::{ApiError, Arguments, Handle, Reference, SimApi, Value};

pub(crate) use images::check_file_name;
pub use partly::{missing_in_scripts, missing_part, partly_in_scripts};
pub use sincro_conventions::absent::{absent, why_absent};
pub use sincro_conventions::names::{old_names, present_name};
use sincro_values::coercion::{coerced, parameters};
pub use waiting::{MOVES, Move};
pub use windows::is_display_only;

/// Result of a function of the API: its return values in the order of its call tip ([`Function::tip`]), or the error
/// that the caller is given.
pub type Outcome = Result<Vec<Value>, ApiError>;

/// Function of the API that is called by name, as scripts and remote clients do; adapters list them with [`functions`].
pub struct Function {
    /// Present name, without its module `sim.`, `simIK.`, `simOMPL.`, `simUI.` or `simVision.`.
    pub name: &'static str,
    /// Signature, as call tips show it: `float position=sim.getJointPosition(int jointHandle)`.
    pub tip: &'static str,
    /// Implementation, called with the positional arguments that were given.
    pub run: fn(&mut SimApi<'_>, Arguments<'_>) -> Outcome,
}

impl Function {
    /// Calls the function. Before, shapes that a client or script has told to be bodies are made bodies of the model,
    /// and objects that it has removed are removed, at once, unless the function sees no difference. Numbers are taken
    /// as text where the call tip says text, and texts that are numbers as numbers.
    ///
    /// # Errors
    ///
    /// The function has refused its arguments, or the model cannot have the bodies.
    pub fn call(&self, sim: &mut SimApi<'_>, arguments: Arguments<'_>) -> Outcome {
        if !sim.registry.doomed.is_empty() && !deferred::removal_may_wait(sim, self, arguments) {
            sim.remove_doomed()?;
        }
        if !sim.registry.roles.is_empty() && !deferred::bodies_may_wait(self) {
            sim.make_bodies()?;
        }
        match coerced(self.tip, arguments.0) {
            Some(changed) => (self.run)(sim, Arguments(&changed)),
            None => (self.run)(sim, arguments),
        }
    }

    /// Returns true if argument `k`, counted from 0, may be nil by the call tip: `string colorName=nil`.
    ///
    /// ```
    /// let paint = sincro_coppelia::api::functions::function("setShapeColor").unwrap();
    /// assert_eq!([0, 1, 2, 3].map(|k| paint.may_be_nil(k)), [false, true, false, false]);
    /// ```
    #[must_use]
    pub fn may_be_nil(&self, k: usize) -> bool {
        parameters(self.tip).nth(k).is_some_and(|argument| argument.ends_with("=nil"))
    }
}

/// Functions of the module `sim`, by category (objects, poses, joints, signals …), each once; adapters offer all of
/// them.
pub fn functions() -> impl Iterator<Item = &'static Function> {
    let categories = [
        control::FUNCTIONS,
        objects::FUNCTIONS,
        poses::FUNCTIONS,
        transforms::FUNCTIONS,
        rotations::FUNCTIONS,
        joints::FUNCTIONS,
        bodies::FUNCTIONS,
        signals::FUNCTIONS,
        touching::FUNCTIONS,
        paths::FUNCTIONS,
        path_objects::FUNCTIONS,
        graphs::FUNCTIONS,
        ik_groups::FUNCTIONS,
        buffers::FUNCTIONS,
        windows::FUNCTIONS,
        drawings::FUNCTIONS,
        motions::FUNCTIONS,
        moves::FUNCTIONS,
        vision::FUNCTIONS,
        images::FUNCTIONS,
        textures::FUNCTIONS,
        sensing::FUNCTIONS,
        distances::FUNCTIONS,
        planning::CALCULATIONS,
        collections::FUNCTIONS,
        shapes::FUNCTIONS,
        clouds::FUNCTIONS,
        bits::FUNCTIONS,
        tubes::FUNCTIONS,
        radio::FUNCTIONS,
        selection::FUNCTIONS,
        scripts::FUNCTIONS,
        ui::WINDOWS,
        properties::TYPED,
        properties::FUNCTIONS,
    ];
    categories.into_iter().flatten()
}

/// Functions of the module `simIK` (inverse kinematics), each once; their names are without `simIK.`.
pub fn ik_functions() -> impl Iterator<Item = &'static Function> {
    ik::FUNCTIONS.iter()
}

/// Functions of the module `simUI` (widgets), each once; their names are without `simUI.`. Nothing is shown: values of
/// widgets are kept.
pub fn ui_functions() -> impl Iterator<Item = &'static Function> {
    ui::FUNCTIONS.iter().chain(ui::SHOWN).chain(ui::KEPT)
}

/// Functions of the module `simVision` (filters on the pictures of vision sensors), each once; their names are without
/// `simVision.`.
pub fn vision_functions() -> impl Iterator<Item = &'static Function> {
    filters::FUNCTIONS.iter()
}

/// Functions of the module `simOMPL` (path planning), each once; their names are without `simOMPL.`.
pub fn planning_functions() -> impl Iterator<Item = &'static Function> {
    planning::FUNCTIONS.iter()
}

/// Functions of `simVision` that are not offered, without `simVision.`, each with the reason.
pub fn absent_vision_functions() -> impl Iterator<Item = (&'static str, &'static str)> {
    filters::ABSENT.iter().copied()
}

/// Functions of `simOMPL` that clients are not offered, without `simOMPL.`, each with the reason; scripts have the
/// first.
pub fn absent_planning_functions() -> impl Iterator<Item = (&'static str, &'static str)> {
    sincro_planning::names::ABSENT.into_iter()
}

/// Older names of functions of `simIK`, each with its present name, both without `simIK.`.
pub fn old_ik_names() -> impl Iterator<Item = (&'static str, &'static str)> {
    ik::OLD.iter().copied()
}

/// The function of `simIK` of a name without it, present or older.
fn ik_function(name: &str) -> Option<&'static Function> {
    let present = ik::OLD.iter().find(|(old, _)| *old == name).map_or(name, |(_, present)| present);
    ik::FUNCTIONS.iter().find(|f| f.name == present)
}

/// Finds a function by its present or an older name, with or without `sim.`; those of `simIK`, `simOMPL`, `simUI` and
/// `simVision` only with their module. None if it is not offered.
#[must_use]
pub fn function(name: &str) -> Option<&'static Function> {
    static BY_NAME: OnceLock<BTreeMap<&'static str, &'static Function>> = OnceLock::new();
    let by_name = BY_NAME.get_or_init(|| functions().map(|f| (f.name, f)).collect());
    if let Some(name) = name.strip_prefix("simIK.") {
        return ik_function(name);
    }
    if let Some(name) = name.strip_prefix("simUI.") {
        return ui_functions().find(|f| f.name == name);
    }
    if let Some(name) = name.strip_prefix("simOMPL.") {
        return planning_functions().find(|f| f.name == name);
    }
    if let Some(name) = name.strip_prefix("simVision.") {
        return vision_functions().find(|f| f.name == name);
    }
    let bare = name.strip_prefix("sim.").unwrap_or(name);
    by_name.get(bare).or_else(|| by_name.get(&*present_name(name))).copied()
}

/// Calls a function by its present or an older name, with or without `sim.` (`sim.getJointPosition`,
/// `simGetJointPosition`). [`Session::call`](crate::session::Session::call) does the same and then carries out requests
/// such as starting a run.
///
/// # Errors
///
/// No function of that name is offered (with the reason if V-REP or CoppeliaSim has it), or it has refused its
/// arguments; the message names the function.
pub fn call(sim: &mut SimApi<'_>, name: &str, arguments: &[Value]) -> Outcome {
    let function = function(name).ok_or_else(|| {
        let present = present_name(name);
        let of_vision = name.strip_prefix("simVision.").and_then(|name| filters::ABSENT.iter().find(|f| f.0 == name));
        let of_planning = || absent_planning_functions().find(|f| name.strip_prefix("simOMPL.") == Some(f.0));
        if let Some((_, why)) = of_vision.copied().or_else(of_planning) {
            return ApiError(format!("{name} is not offered: {why}"));
        }
        if let Some(why) = why_absent(&present) {
            return ApiError(format!("sim.{present} is not offered: {why}"));
        }
        let short: String = name.chars().take(100).collect();
        ApiError(format!("No such function: {short}"))
    })?;
    function.call(sim, Arguments(arguments)).map_err(|ApiError(message)| {
        ApiError(format!("{message} (in function '{}.{}')", module_of(name), function.name))
    })
}

/// The module that a name belongs to.
fn module_of(name: &str) -> &'static str {
    ["simIK", "simOMPL", "simUI", "simVision"]
        .into_iter()
        .find(|module| name.strip_prefix(module).is_some_and(|rest| rest.starts_with('.')))
        .unwrap_or("sim")
}

/// Nothing to give.
fn done() -> Outcome {
    Ok(Vec::new())
}

fn one(value: impl Into<Value>) -> Outcome {
    Ok(vec![value.into()])
}

fn list(numbers: impl IntoIterator<Item = f64>) -> Outcome {
    Ok(vec![Value::reals(numbers)])
}

/// The handle of an object, flags taken off; `sim.handle_self` is the object of the script that calls.
fn handle(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Handle, ApiError> {
    plain(sim, a.handle(k)?)
}

pub(super) fn plain(sim: &SimApi<'_>, raw: i32) -> Result<Handle, ApiError> {
    let bare = if raw >= HANDLE_FLAGS { raw & (HANDLE_FLAGS - 1) } else { raw };
    if bare == -4 {
        return sim.own.ok_or_else(|| ApiError::new("sim.handle_self means the object of a script, and none calls"));
    }
    Ok(sim.registry.entry(Handle(bare))?.handle)
}

/// Reference frame of a pose: argument `k`, the world if it is not given. Flags are those of the first handle.
fn reference(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Reference, ApiError> {
    if !a.has(k) {
        return Ok(Reference::World);
    }
    let first = a.handle(0)?;
    let base = first > 0 && first & HANDLE_JOINT_BASE != 0;
    Ok(match a.handle(k)? {
        -1 => Reference::World,
        -11 => Reference::Parent,
        other if base => Reference::JointBase(plain(sim, other)?),
        other => Reference::Object(plain(sim, other)?),
    })
}

/// Places of the value and of what it is given against in the arguments of a setter: (handle, value, against) since
/// 4.6, (handle, against, value) before.
fn setter(a: Arguments<'_>) -> (usize, usize) {
    if matches!(a.get(1), Value::List(_)) { (1, 2) } else { (2, 1) }
}
