//! Bodies that were made at run time and are grouped: one body with the shapes and the mass of all.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value};
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::Pose;

use super::Rebuild;
use super::remove::idle_joints;
use crate::api::registry::{Handle, Kind};
use crate::api::{ApiError, Reference, SimApi};
use sincro_scene::draft::pose_keys;
use sincro_scene::keys::{mass_keys, pose_of};

/// Difference of velocities that is put down to rounding, relative to `1 + |v|`.
const SAME: f64 = 1e-9;

impl SimApi<'_> {
    /// One body of several that stand still against each other: the first one keeps its handle, frame, name, contact
    /// and velocity, and gets the shapes and mass of the others, which are removed; what hangs on them hangs on it.
    ///
    /// # Errors
    ///
    /// A body belongs to the scene, some are fixed in the world and others not, or they move against each other.
    pub(in crate::api) fn group_bodies(&mut self, first: Handle, others: &[Handle]) -> Result<Handle, ApiError> {
        let x_wf = self.pose(first, Reference::World)?;
        let mut edit = self.draft()?;
        edit.conserves_momentum = false;
        let (first_path, mut keys, own) = self.groupable(first, &edit)?;
        let mut shapes = shapes_of(&keys, &first_path, &Pose::identity())?;
        let (mut masses, mut gone, mut heirs) = (vec![own], BTreeSet::new(), BTreeMap::new());
        for other in others {
            let (path, keys, mass) = self.groupable(*other, &edit)?;
            self.check_at_rest(first, *other)?;
            let x_fo = x_wf.inverse().compose(&self.pose(*other, Reference::World)?);
            shapes.extend(shapes_of(&keys, &path, &x_fo)?);
            masses.push(mass.placed(&x_fo.rot, x_fo.pos));
            gone.insert(path);
            heirs.insert(*other, first);
            // with its free joint or the frame that was one: what is beside it there hangs on the first one, too
            if let Some(carrier) = self.registry.joint_below(*other) {
                gone.insert(self.model_path(carrier)?);
                heirs.insert(carrier, first);
            }
        }
        let mass = MassProperties::sum(&masses);
        keys.remove("density");
        keys.insert("shape".into(), Value::Array(shapes));
        keys.extend(mass_keys(&mass));
        edit.draft.replace(&first_path, "body", keys);
        let idle = idle_joints(&edit.draft, &gone);
        gone.extend(idle);
        self.remove_and_rebuild(edit, gone, &heirs)?;
        if !self.is_fixed(first)? {
            self.set_mass(first, mass)?;
        }
        Ok(first)
    }

    /// Path, keys and mass properties of a body that was made at run time.
    fn groupable(
        &self,
        body: Handle,
        edit: &Rebuild,
    ) -> Result<(String, Map<String, Value>, MassProperties), ApiError> {
        let entry = self.registry.entry(body)?;
        let path = &entry.path;
        let Kind::Body(mass) = entry.kind else {
            let help = "make all that are grouped dynamic or respondable, or none";
            return Err(ApiError(format!("`{path}` is no body, and others are: {help}")));
        };
        if !self.registry.added.contains(&body) {
            let help = "its shapes are changed there; bodies are joined with sim.setObjectParent";
            return Err(ApiError(format!("`{path}` is a body of the scene: {help}")));
        }
        let path = self.model_path(body)?;
        match edit.draft.table(&path) {
            Some(("body", keys)) => Ok((path.clone(), keys.clone(), mass)),
            _ => Err(ApiError(format!("`{path}` is no body"))),
        }
    }

    /// Refuses bodies that do not stand still against each other.
    fn check_at_rest(&mut self, first: Handle, other: Handle) -> Result<(), ApiError> {
        let [one, two] = [self.registry.entry(first)?.clone(), self.registry.entry(other)?.clone()];
        let refused = |what: &str| ApiError(format!("`{}` and `{}` {what}", one.path, two.path));
        let are_fixed = [self.is_fixed(first)?, self.is_fixed(other)?];
        if are_fixed[0] != are_fixed[1] {
            return Err(refused("cannot be one body: one of them is fixed in the world (parameter 3003)"));
        }
        if self.registry.visible_tree(other).contains(&first) {
            return Err(refused("cannot be one body: the first hangs on the other, give them in the other order"));
        }
        if are_fixed == [true; 2] {
            return Ok(());
        }
        let (a, b) = (self.twist(&one.frame), self.twist(&two.frame));
        let apart = self.place(&two.frame).pos - self.place(&one.frame).pos;
        let expected = a.lin + a.ang.cross(apart);
        let slack = SAME * (1.0 + a.lin.norm() + a.ang.norm());
        if (b.lin - expected).norm() > slack || (b.ang - a.ang).norm() > slack {
            return Err(refused("move against each other: join them with sim.setObjectParent before they are grouped"));
        }
        Ok(())
    }
}

/// Shapes of a body as another body has them, in whose frame it stands at `x_fo`.
fn shapes_of(keys: &Map<String, Value>, path: &str, x_fo: &Pose<f64>) -> Result<Vec<Value>, ApiError> {
    let none = Vec::new();
    let shapes = keys.get("shape").and_then(Value::as_array).unwrap_or(&none);
    let placed = shapes.iter().map(|shape| {
        let turned = || ApiError(format!("`{path}` has shapes with `rotation_deg`: write `quaternion_wxyz`"));
        let mut shape =
            shape.as_object().filter(|shape| !shape.contains_key("rotation_deg")).ok_or_else(turned)?.clone();
        let pose = x_fo.compose(&pose_of(&shape));
        shape.remove("density");
        if let (None, Some(color)) = (shape.get("color"), keys.get("color")) {
            shape.insert("color".into(), color.clone());
        }
        shape.extend(pose_keys(&pose));
        Ok(Value::Object(shape))
    });
    placed.collect()
}
