//! Robot blocks: what the model knows, for use in a controller.
//!
//! `q` are all coordinates of the model and `v` all velocities, in the order of `world.q` and `world.v`. The model is
//! the scene's own, or that of another file or with other numbers (parameters `model` and `set`, see `robot_model.rs`).
//! Springs, dampers and friction are no part of inverse dynamics, gravity torque and mass matrix; the armature of
//! motors is part of the mass matrix.

mod forward_kinematics;
mod gravity_torque;
mod inverse_dynamics;
mod jacobian;
mod mass_matrix;

use std::sync::Arc;

use sincro_blocks::instance::DynBlock;
use sincro_blocks::kind::{Kind, Parameter, ValueKind};
use sincro_blocks::reader::Reader;
use sincro_blocks::unit::Unit;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_math::Real;

use crate::fmu::FmuLoader;
use crate::record::{Probe, catalogue};
use crate::script::ScriptParser;

pub use forward_kinematics::ForwardKinematics;
pub use gravity_torque::GravityTorque;
pub use inverse_dynamics::InverseDynamics;
pub use jacobian::{Jacobian, Rows as JacobianRows};
pub use mass_matrix::MassMatrix;

/// Context from which robot blocks are created: the model, and loaders of what this crate cannot read.
#[derive(Clone, Debug)]
pub struct Context {
    /// Parser of laws written in a scripting language; `None`: the program has none.
    pub parser: Option<&'static dyn ScriptParser>,
    /// Loader of FMUs; `None`: the program has none.
    pub fmus: Option<&'static dyn FmuLoader>,
    /// Model whose kinematics and dynamics the blocks compute.
    pub model: Arc<Model<f64>>,
}

/// Parameter `model` of the blocks that compute with a model.
const MODEL: Parameter =
    Parameter::optional("model", ValueKind::Text, "scene file whose model it computes with", "the experiment's scene");

/// Parameter `set` of the blocks that compute with a model.
const SET: Parameter = Parameter::optional(
    "set",
    ValueKind::Names,
    "numbers that differ in that model, by path: `{ \"/arm/link.mass\" = 0.9 }`",
    "none",
);

/// A kind of block and how one is made from parameters and the model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Item {
    /// Its description.
    pub kind: &'static Kind,
    /// Makes one.
    pub read: fn(&mut Reader<'_>, &Context) -> Box<dyn DynBlock>,
}

/// All blocks that are made here and not in the library.
pub(crate) fn all() -> impl Iterator<Item = &'static Item> {
    const ROBOT_BLOCKS: &[Item] = &[
        forward_kinematics::ITEM,
        jacobian::ITEM,
        inverse_dynamics::ITEM,
        gravity_torque::ITEM,
        mass_matrix::ITEM,
        super::lua::ITEM,
        super::fmu::ITEM,
    ];
    ROBOT_BLOCKS.iter()
}

/// The block of a name.
#[must_use]
pub(crate) fn find(name: &str) -> Option<&'static Item> {
    all().find(|item| item.kind.name == name)
}

/// Working memory of a robot block: its model in the number type of the diagram, with scratch for the algorithms. Made
/// with the block by the framework, not by users.
#[derive(Clone, Debug, Default)]
pub struct Robot<R>(Option<Box<Parts<R>>>);

#[derive(Clone, Debug)]
struct Parts<R> {
    model: Model<R>,
    scratch: Scratch<R>,
    zero: Vec<R>,
}

impl<R: Real> Robot<R> {
    fn new(model: &Model<f64>) -> Self {
        let model = Model::pack(&[model]).expect("one model has one structure");
        let scratch = Scratch::new(&model);
        let zero = vec![R::zero(); model.n_v()];
        Self(Some(Box::new(Parts { model, scratch, zero })))
    }

    /// Model, scratch, and as many zeros as there are velocities.
    fn parts(&mut self) -> (&Model<R>, &mut Scratch<R>, &[R]) {
        let Parts { model, scratch, zero } = &mut **self.0.as_mut().expect("made with the block");
        (model, scratch, zero)
    }
}

/// A frame of the model, named by a parameter.
fn frame(reader: &mut Reader<'_>, context: &Context) -> usize {
    let path = reader.text("frame");
    let frames = &context.model.names().frames;
    match frames.iter().position(|f| f.name == path) {
        Some(k) => k,
        None => {
            let near = crate::suggest::nearest(&path, frames.iter().map(|f| f.name.as_str()));
            let all = frames.iter().map(|f| format!("`{}`", f.name)).collect::<Vec<_>>().join(", ");
            let help =
                near.map_or_else(|| format!("bodies and frames: {all}"), |near| format!("did you mean `{near}`?"));
            reader.fault("frame", format!("there is no body or frame `{path}`"), help);
            0
        }
    }
}

/// Units of generalized forces, in the order of the velocities: `N·m` of a rotation, `N` of a translation.
fn force_units(model: &Model<f64>) -> Vec<Option<Unit>> {
    let mut units = vec![None; model.n_v()];
    for entry in catalogue(model) {
        if let Probe::Rate(k) = entry.probe {
            units[k] = Unit::parse(if entry.unit == "m/s" { "N" } else { "N·m" }).ok();
        }
    }
    units
}

/// Inputs that must be as wide as the model's vectors are.
fn check_widths(inputs: &[Option<usize>], wanted: &[(&str, usize)]) -> Result<(), String> {
    for (given, (name, width)) in inputs.iter().zip(wanted) {
        if let Some(given) = given
            && given != width
        {
            return Err(format!("`{name}` has {given} components, the model has {width}"));
        }
    }
    Ok(())
}
