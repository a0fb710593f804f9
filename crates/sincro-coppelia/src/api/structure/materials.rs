//! Friction and restitution that clients and scripts give to shapes by the parameters of V-REP's physics engines.

use serde_json::{Map, Value};

use super::make::FRICTION;
use super::table;
use crate::api::registry::{Handle, Kind};
use crate::api::{ApiError, SimApi};

/// Quantity of a surface that a parameter of an engine stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    /// Coefficient of friction (dimensionless).
    Friction,
    /// Newton's coefficient of restitution (dimensionless).
    Restitution,
}

impl Quantity {
    /// Key of `contact` in the scene file.
    fn key(self) -> &'static str {
        match self {
            Self::Friction => "friction",
            Self::Restitution => "restitution",
        }
    }

    /// That of a parameter: Bullet's old and new friction, ODE's, Vortex's along both axes, Newton's static and kinetic
    /// one, MuJoCo's; restitution of Bullet, Vortex and Newton.
    fn of(parameter: i64) -> Option<Self> {
        match parameter {
            6002 | 6003 | 15_001 | 24_001 | 24_002 | 33_001 | 33_002 | 43_001 => Some(Self::Friction),
            6001 | 24_013 | 33_003 => Some(Self::Restitution),
            _ => None,
        }
    }
}

/// Friction and restitution that an object was given before it touched others; none: not given.
pub(crate) type Material = Map<String, Value>;

impl SimApi<'_> {
    /// Sets the friction or restitution of a shape or body, which it has as soon as it touches others, by the number of
    /// an engine's parameter: there is one way to compute the world, which takes those of every engine.
    ///
    /// # Errors
    ///
    /// The parameter is another one, the object is no shape, or the value is out of range.
    pub(crate) fn set_engine_float(&mut self, parameter: i64, object: Handle, value: f64) -> Result<(), ApiError> {
        let quantity = self.quantity(parameter, object)?;
        let (most, range) = match quantity {
            Quantity::Friction => (f64::MAX, "0 or more"),
            Quantity::Restitution => (1.0, "0 to 1"),
        };
        if !(0.0..=most).contains(&value) {
            return Err(ApiError(format!("a {} of {value}, expected {range}", quantity.key())));
        }
        if !self.has_contact(object) {
            let material = self.registry.materials.entry(object).or_default();
            material.insert(quantity.key().into(), value.into());
            return Ok(());
        }
        let path = self.model_path(object)?;
        let mut edit = self.draft()?;
        let Some(("body", keys)) = edit.draft.table(&path) else {
            return Err(ApiError(format!("`{path}` is no body")));
        };
        let mut keys = keys.clone();
        let Some(contact) = keys.get_mut("contact").and_then(Value::as_object_mut) else {
            return Err(ApiError(format!("`{path}` has a contact that is no table: its material is the scene's")));
        };
        if contact.get(quantity.key()).and_then(Value::as_f64) == Some(value) {
            return Ok(());
        }
        contact.insert(quantity.key().into(), value.into());
        self.check_change(object, quantity.key())?;
        edit.draft.replace(&path, "body", keys);
        self.rebuild(edit)?;
        self.change(object, quantity.key(), vec![value])
    }

    /// Friction or restitution of a shape or body, by the number of an engine's parameter.
    ///
    /// # Errors
    ///
    /// As [`SimApi::set_engine_float`].
    pub(crate) fn engine_float(&mut self, parameter: i64, object: Handle) -> Result<f64, ApiError> {
        let quantity = self.quantity(parameter, object)?;
        let none = match quantity {
            Quantity::Friction => FRICTION,
            Quantity::Restitution => 0.0,
        };
        if !self.has_contact(object) {
            return Ok(self.material(object).get(quantity.key()).and_then(Value::as_f64).unwrap_or(none));
        }
        let path = self.model_path(object)?;
        let edit = self.draft()?;
        let contact = edit.draft.table(&path).and_then(|(_, keys)| keys.get("contact")?.get(quantity.key())?.as_f64());
        Ok(contact.unwrap_or(0.0))
    }

    fn quantity(&self, parameter: i64, object: Handle) -> Result<Quantity, ApiError> {
        let entry = self.registry.entry(object)?;
        if !matches!(entry.kind, Kind::Body(_) | Kind::Shape) {
            return Err(ApiError(format!("`{}` is no shape", entry.path)));
        }
        Quantity::of(parameter).ok_or_else(|| {
            let offered = "friction and restitution of shapes are offered; what else the engines have is not that of this program";
            ApiError(format!("engine parameter {parameter}: {offered}"))
        })
    }

    /// Friction and restitution that an object was given before it touched others.
    fn material(&self, object: Handle) -> Material {
        self.registry.materials.get(&object).cloned().unwrap_or_default()
    }

    /// Contact of a body as the scene file has it: friction of V-REP's default material, unless the object was given
    /// another one.
    pub(super) fn contact_keys(&self, object: Handle) -> Value {
        let mut keys = table([("friction", FRICTION.into())]);
        keys.extend(self.material(object));
        Value::Object(keys)
    }
}
