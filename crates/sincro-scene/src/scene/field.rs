//! Gravity and density of the air over the position: formulas, and that they fit where the bodies start.

#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sincro_dynamics::actuation::GravityField;
use sincro_dynamics::kinematics;
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::Vec3;
use sincro_dynamics::state::State;
use sincro_math::expression::Expression;
use sincro_math::scalar_field::{POSITION_NAMES, ScalarField};

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;

/// Gravitational acceleration: the same everywhere, or over the position.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub(crate) enum GravityFile {
    /// The same everywhere, world axes [m/s²].
    Uniform([f64; 3]),
    /// Over the position.
    Field(GravityFieldFile),
}

/// Gravitational acceleration as formulas of the position in the world, at the centre of mass of each body.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct GravityFieldFile {
    /// Formulas of x, y, z [m], in quotes: the acceleration along the axes of the world [m/s²].
    pub acceleration: [String; 3],
    /// Formula of x, y, z: potential, minus whose gradient it is; without it gravity does work [m²/s²].
    pub potential: Option<String>,
}

/// Density of the air: a number, or a formula of the position.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(untagged)]
pub(crate) enum AirDensityFile {
    /// The same everywhere [kg/m³].
    Uniform(#[cfg_attr(test, schemars(range(min = 0.0)))] f64),
    /// Over the position.
    Formula(AirDensityFormulaFile),
}

/// Density of the air as a formula of the position in the world.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct AirDensityFormulaFile {
    /// Formula of x, y, z [m], in quotes, such as "1.225*exp(-z/8500)" [kg/m³].
    pub formula: String,
}

impl GravityFile {
    /// Uniform acceleration, zero of a field `[m/s²]`.
    pub fn uniform(&self) -> [f64; 3] {
        match self {
            Self::Uniform(gravity) => *gravity,
            Self::Field(_) => [0.0; 3],
        }
    }

    /// The field, if it is one; none, with the reasons noted, if a formula cannot be.
    pub fn field(&self, document: &Document, diagnostics: &mut Diagnostics) -> Option<GravityField> {
        let Self::Field(file) = self else { return None };
        let mut read = |text: &str, key: &str| formula(text, &format!("/gravity/{key}"), document, diagnostics);
        let along: Vec<Option<ScalarField>> =
            file.acceleration.iter().enumerate().map(|(k, text)| read(text, &format!("acceleration/{k}"))).collect();
        let potential = match &file.potential {
            None => None,
            Some(text) => Some(read(text, "potential")?),
        };
        let acceleration = along.into_iter().collect::<Option<Vec<_>>>()?.try_into().ok()?;
        Some(GravityField { acceleration, potential })
    }
}

impl AirDensityFile {
    /// Uniform density `[kg/m³]`; any number where a formula takes its place.
    pub fn uniform(&self) -> f64 {
        match self {
            Self::Uniform(density) => *density,
            Self::Formula(_) => 0.0,
        }
    }

    /// The formula, if it is one; none, with the reasons noted, if it cannot be.
    pub fn field(&self, document: &Document, diagnostics: &mut Diagnostics) -> Option<ScalarField> {
        let Self::Formula(file) = self else { return None };
        formula(&file.formula, "/air_density/formula", document, diagnostics)
    }
}

fn formula(text: &str, pointer: &str, document: &Document, diagnostics: &mut Diagnostics) -> Option<ScalarField> {
    let parsed = Expression::parse(text, &POSITION_NAMES).map_err(|e| {
        let help = e.help.unwrap_or_else(|| "it is a formula of the position x, y, z in the world".into());
        (vec![e.message], help)
    });
    let made = parsed.and_then(|formula| {
        ScalarField::new(formula).map_err(|e| (e.into_iter().collect(), "write it with fewer nested brackets".into()))
    });
    match made {
        Ok(field) => Some(field),
        Err((reasons, help)) => {
            for reason in reasons {
                let diagnostic = Diagnostic::error(&document.at(pointer), format!("formula `{text}`: {reason}"));
                diagnostics.push(diagnostic.with_help(help.clone()));
            }
            None
        }
    }
}

/// Notes formulas that have no value where bodies and elements start, and a potential that is not that of the
/// acceleration there.
pub(super) fn check(model: &Model<f64>, initial: &State<f64>, document: &Document, diagnostics: &mut Diagnostics) {
    let mut scratch = Scratch::new(model);
    kinematics::poses(model, &initial.q, &mut scratch);
    let poses = scratch.link_poses();
    let mut note = |pointer: &str, message: String, help: &str| {
        diagnostics.push(Diagnostic::error(&document.at(pointer), message).with_help(help));
    };
    let names = model.names();
    for (k, frame) in names.frames.iter().enumerate() {
        let (Some(link), Some(field)) = (frame.link, model.gravity_field()) else { continue };
        let Some(mass) = model.mass_properties(sincro_dynamics::ids::BodyId::new(k)) else { continue };
        let p = poses[link].compose(&frame.pose).point(Vec3(mass.center_of_mass));
        let (name, g) = (&frame.name, field.acceleration(p));
        if let Some(axis) = (0..3).find(|&axis| !g[axis].is_finite()) {
            let message = format!("gravity at `{name}`, which starts at {:?}, is {}", p.0, g[axis]);
            note(&format!("/gravity/acceleration/{axis}"), message, "give formulas that are finite where bodies are");
        } else if let Some(down) = field.inconsistency(p) {
            let message = format!(
                "the potential does not fit the acceleration: at `{name}` its negative gradient is {:?}, the acceleration {:?}",
                down.0, g.0
            );
            note(
                "/gravity/potential",
                message,
                "acceleration = −(∂U/∂x, ∂U/∂y, ∂U/∂z); leave `potential` out if there is none",
            );
        }
    }
    let rotors = model.rotors().iter().zip(&names.rotors).map(|(r, name)| (&r.atmosphere, r.link, r.pose.pos, name));
    let drags = model.drags().iter().zip(&names.drags).map(|(d, name)| (&d.atmosphere, d.link, d.pose.pos, name));
    for (atmosphere, link, at, name) in rotors.chain(drags) {
        let Some(density) = atmosphere.as_ref().map(|field| field.at(poses[link].point(at).0)) else { continue };
        if !(density.is_finite() && density >= 0.0) {
            let message = format!("the density of the air at the start of `{name}` is {density} kg/m³");
            note(
                "/air_density/formula",
                message,
                "give a formula that is zero or more where rotors and drag elements are",
            );
        }
    }
}
