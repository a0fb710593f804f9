//! Joints and moving bodies that are made at run time.

use serde_json::Value;
use sincro_dynamics::contact::Surface;
use sincro_dynamics::geometry::polyhedron::{convex_hull, mass_properties};
use sincro_dynamics::model::MassProperties;
use sincro_dynamics::spatial::{Pose, Vec3};

use super::{Rebuild, free_joint, table};
use crate::api::registry::{Handle, Kind, WORLD};
use crate::api::runtime_objects::MAX_CREATED;
use crate::api::tree::is_force_sensor;
use crate::api::{ApiError, Reference, SimApi};
use sincro_scene::draft::pose_keys;
use sincro_scene::keys::{mass_keys, shape_keys};
use sincro_scene::scenery::Piece;

/// Density of what is made without a mass, as in V-REP [kg/m³].
const DENSITY: f64 = 1000.0;
/// Coefficient of friction of what is made, that of V-REP's default material.
pub(super) const FRICTION: f64 = 0.71;

/// Role of a shape in the dynamics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Role {
    /// True if it is fixed in the world.
    pub is_static: bool,
    /// True if it touches others.
    pub is_respondable: bool,
    /// Mass `[kg]`; none: that of water.
    pub mass: Option<f64>,
}

impl SimApi<'_> {
    /// Checks that so many further objects may be made.
    pub(super) fn check_room(&self, n: usize) -> Result<(), ApiError> {
        if self.registry.n_created + self.registry.added.len() + n <= MAX_CREATED {
            return Ok(());
        }
        Err(ApiError(format!("{MAX_CREATED} objects were made already: remove some")))
    }

    /// Makes a joint in the world's origin that turns about (revolute, 10) or slides along (prismatic, 11) its z axis,
    /// or turns in any way (spherical, 12). It is part of the model as soon as a body that moves is hung on it; until
    /// then it can be put and hung anywhere. A joint in kinematic mode holds its position, one in dynamic mode is free
    /// until its motor is given a mode.
    ///
    /// # Errors
    ///
    /// There is no joint of that type, or there are too many objects.
    pub(crate) fn create_joint(&mut self, kind: i64, is_kinematic: bool) -> Result<Handle, ApiError> {
        let word = match kind {
            10 => "revolute",
            11 => "prismatic",
            12 => "ball",
            _ => return Err(ApiError(format!("{kind} is no type of joint: revolute 10, prismatic 11, spherical 12"))),
        };
        self.check_room(1)?;
        let name = self.fresh_name("Joint");
        let handle = self.registry.create(&name, Kind::Joint(None), WORLD)?;
        let mut keys = table([("kind", word.into())]);
        if word != "ball" {
            keys.insert("axis".into(), Value::from(vec![0.0, 0.0, 1.0]));
            let mode = if is_kinematic { "velocity" } else { "free" };
            keys.insert("motor".into(), Value::Object(table([("mode", mode.into())])));
        }
        self.registry.parked.insert(handle, keys);
        Ok(handle)
    }

    /// Makes a force sensor in the world's origin: a fixed joint that is part of the model as soon as a body is hung on
    /// it, and measures what it carries from then on.
    ///
    /// # Errors
    ///
    /// There are too many objects.
    pub(crate) fn create_force_sensor(&mut self) -> Result<Handle, ApiError> {
        self.check_room(1)?;
        let name = self.fresh_name("ForceSensor");
        let handle = self.registry.create(&name, Kind::ForceSensor(None), WORLD)?;
        self.registry.parked.insert(handle, table([("kind", "fixed".into()), ("force_sensor", true.into())]));
        Ok(handle)
    }

    /// A dummy that was made becomes a frame of the model by an edit, with those above it, so that what is hung on it
    /// goes with it.
    pub(super) fn join_dummies(&mut self, parent: Option<Handle>, edit: &mut Rebuild) -> Result<(), ApiError> {
        let Some(handle) = parent else { return Ok(()) };
        let entry = self.registry.entry(handle)?.clone();
        if self.is_of_model(handle) || edit.joined.values().any(|known| *known == handle) {
            return Ok(());
        }
        self.join_dummies(entry.parent, edit)?;
        if entry.kind != Kind::Dummy {
            return Ok(());
        }
        let (parent, x_wp) = self.parent_in_edit(entry.parent, edit)?;
        let pose = x_wp.inverse().compose(&self.pose(handle, Reference::World)?);
        let name = self.model_name(handle)?;
        let mut keys = table([("name", name.into()), ("parent", parent.into())]);
        keys.extend(pose_keys(&pose));
        let path = edit.draft.add("frame", keys);
        edit.joined.insert(path, handle);
        Ok(())
    }

    /// A joint that was made and moves nothing yet becomes part of the model by an edit, with those above it.
    pub(super) fn join_parked(&mut self, joint: Option<Handle>, edit: &mut Rebuild) -> Result<(), ApiError> {
        let Some(handle) = joint else { return Ok(()) };
        if self.is_of_model(handle) {
            return self.restore_sensors(handle, edit);
        }
        if edit.joined.values().any(|known| *known == handle) {
            return Ok(());
        }
        let entry = self.registry.entry(handle)?.clone();
        let Some(keys) = self.registry.parked.get(&handle).cloned() else {
            // a dummy or shape: what carries it may be such a joint
            return self.join_parked(entry.parent, edit);
        };
        self.join_parked(entry.parent, edit)?;
        let (parent, x_wp) = self.parent_in_edit(entry.parent, edit)?;
        let pose = x_wp.inverse().compose(&self.pose(handle, Reference::World)?);
        let name = self.model_name(handle)?;
        let mut all = table([("name", name.into()), ("parent", parent.into())]);
        all.extend(keys);
        all.extend(pose_keys(&pose));
        let path = edit.draft.add("joint", all);
        edit.joined.insert(path, handle);
        Ok(())
    }

    /// Force sensors that carried nothing are joints again by an edit that hangs something on an object.
    fn restore_sensors(&self, handle: Handle, edit: &mut Rebuild) -> Result<(), ApiError> {
        let mut at = Some(handle);
        while let Some(own) = at {
            let path = self.model_path(own)?;
            if self.parked_keys(own).is_some_and(is_force_sensor)
                && let Some(("frame", place)) = edit.draft.table(&path)
            {
                let place = place.clone();
                edit.draft.unpark(&path, place);
            }
            at = self.registry.entry(own)?.parent.filter(|parent| self.is_of_model(*parent));
        }
        Ok(())
    }

    /// Nearest object above that is part of the model after an edit, with the pose of its frame in the world.
    pub(super) fn parent_in_edit(
        &mut self,
        parent: Option<Handle>,
        edit: &Rebuild,
    ) -> Result<(String, Pose<f64>), ApiError> {
        let mut at = parent;
        while let Some(handle) = at {
            if let Some((path, _)) = edit.joined.iter().find(|(_, joined)| **joined == handle) {
                let frame = self.registry.entry(handle)?.moving;
                return Ok((path.clone(), self.place(&frame)));
            }
            if self.is_of_model(handle) {
                return self.model_parent(Some(handle));
            }
            at = self.registry.entry(handle)?.parent;
        }
        Ok(("/".to_owned(), Pose::identity()))
    }

    /// Name of an object as the scene takes it: names of runtime objects may have other letters.
    fn model_name(&mut self, handle: Handle) -> Result<String, ApiError> {
        let name = self.registry.entry(handle)?.name.clone();
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        let is_number = |digits: &str| !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit());
        let stem = name.rsplit_once('#').filter(|(_, digits)| is_number(digits)).map_or(&*name, |(stem, _)| stem);
        if !stem.is_empty() && stem.chars().all(is_plain) {
            return Ok(name);
        }
        Ok(self.fresh_name(&name))
    }

    /// Gives a shape that was made a role in the dynamics: it becomes a body of the model at the next compilation, with
    /// all others that wait for it ([`SimApi::make_bodies`]). One that moves is free, unless it hangs on a joint or on
    /// something that moves.
    ///
    /// # Errors
    ///
    /// The shape encloses no volume, or there are too many objects.
    pub(crate) fn give_role(&mut self, shape: Handle, role: Role) -> Result<(), ApiError> {
        let entry = self.registry.entry(shape)?;
        if entry.kind != Kind::Shape {
            return Err(ApiError(format!("`{}` is no shape that was made at run time", entry.path)));
        }
        if self.registry.octrees.contains_key(&shape) || self.registry.clouds.contains_key(&shape) {
            return Err(ApiError(format!("`{}` is no shape: octrees and point clouds move nothing", entry.path)));
        }
        self.check_room(2 * (self.registry.roles.len() + 1))?;
        // refused now, not when it is compiled
        self.shapes_of_body(shape)?;
        self.registry.roles.retain(|(other, _)| *other != shape);
        self.registry.roles.push((shape, role));
        Ok(())
    }

    /// Role that a shape has from the next compilation on; none if it has none or is a body already.
    pub(crate) fn role(&mut self, shape: Handle) -> Option<&mut Role> {
        self.registry.roles.iter_mut().find(|(other, _)| *other == shape).map(|(_, role)| role)
    }

    /// Gives a shape that is no body, or is one from the next compilation on, a mass `[kg]` for the time when it is
    /// one.
    ///
    /// # Errors
    ///
    /// The mass is not positive.
    pub(crate) fn set_shape_mass(&mut self, shape: Handle, mass: f64) -> Result<(), ApiError> {
        if !(mass.is_finite() && mass > 0.0) {
            let path = &self.registry.entry(shape)?.path;
            return Err(ApiError(format!("mass {mass} kg of `{path}` is not positive")));
        }
        self.registry.masses.insert(shape, mass);
        Ok(())
    }

    /// Mass of a shape that is no body `[kg]`: the one that it was given, else that of water.
    ///
    /// # Errors
    ///
    /// It has none of its own and encloses no volume.
    pub(crate) fn shape_mass(&mut self, shape: Handle) -> Result<f64, ApiError> {
        if let Some(mass) = self.registry.masses.get(&shape) {
            return Ok(*mass);
        }
        Ok(self.mass_of_water(shape)?.mass)
    }

    /// Mass `[kg]`, centre of mass `[m]` and inertia about it `[kg·m²]` of a shape that is no body, in its frame: those
    /// of an even density.
    ///
    /// # Errors
    ///
    /// As of [`SimApi::shape_mass`].
    pub(crate) fn shape_mass_properties(&mut self, shape: Handle) -> Result<MassProperties, ApiError> {
        let (mass, of_water) = (self.shape_mass(shape)?, self.mass_of_water(shape)?);
        let scale = mass / of_water.mass;
        Ok(MassProperties { mass, inertia: of_water.inertia.map(|x| x * scale), ..of_water })
    }

    /// Gives a shape that is no body the mass that it has at a density `[kg/m³]`.
    ///
    /// # Errors
    ///
    /// The density is not positive, or it encloses no volume.
    pub(crate) fn set_shape_density(&mut self, shape: Handle, density: f64) -> Result<(), ApiError> {
        if !(density.is_finite() && density > 0.0) {
            return Err(ApiError(format!("density {density} kg/m³ is not positive")));
        }
        let mass = self.mass_of_water(shape)?.mass * (density / DENSITY);
        self.set_shape_mass(shape, mass)
    }

    /// Mass properties of a shape that is no body, in its frame, at the density of water.
    fn mass_of_water(&mut self, shape: Handle) -> Result<MassProperties, ApiError> {
        self.shapes_of_body(shape)?;
        let parts = self.registry.senses.parts_of(shape);
        if let Some(hull) = hull_mass(&parts, None) {
            return Ok(hull);
        }
        let mut solids = Vec::with_capacity(parts.len());
        for (piece, place) in parts {
            let Surface::Solid(solid) = piece.geometry.surface() else {
                let path = &self.registry.entry(shape)?.path;
                return Err(ApiError(format!("`{path}` has several meshes: give it a mass with sim.setShapeMass")));
            };
            solids.push(solid.mass_properties(DENSITY).placed(&place.rot, place.pos));
        }
        Ok(MassProperties::sum(&solids))
    }

    /// Removes what waits for it, and makes bodies of the model of all shapes that wait for it: one compilation. Shapes
    /// that a scene cannot have do not keep the others from it.
    ///
    /// # Errors
    ///
    /// The model cannot be so, for the first of them.
    pub(crate) fn make_bodies(&mut self) -> Result<(), ApiError> {
        self.remove_doomed()?;
        let roles = std::mem::take(&mut self.registry.roles);
        self.make_bodies_in_halves(&roles)
    }

    /// One shape that a scene cannot have costs a number of compilations that grows with the logarithm of the others.
    fn make_bodies_in_halves(&mut self, roles: &[(Handle, Role)]) -> Result<(), ApiError> {
        match roles {
            [] => Ok(()),
            [(shape, _)] => {
                let path = self.registry.entry(*shape)?.path.clone();
                let of_shape = |ApiError(message)| match message.contains(&path) {
                    true => ApiError(message),
                    false => ApiError(format!("`{path}` becomes no body: {message}")),
                };
                self.make_bodies_of(roles).map_err(of_shape)
            }
            all if self.make_bodies_of(all).is_ok() => Ok(()),
            all => {
                let (first, second) = all.split_at(all.len() / 2);
                let made = self.make_bodies_in_halves(first);
                made.and(self.make_bodies_in_halves(second))
            }
        }
    }

    fn make_bodies_of(&mut self, roles: &[(Handle, Role)]) -> Result<(), ApiError> {
        let mut edit = self.draft()?;
        for (shape, role) in roles {
            self.add_body(*shape, *role, &mut edit)?;
        }
        self.rebuild(edit)
    }

    /// Adds the body that a shape becomes to an edit.
    fn add_body(&mut self, shape: Handle, role: Role, edit: &mut Rebuild) -> Result<(), ApiError> {
        let entry = self.registry.entry(shape)?.clone();
        let parts = self.registry.senses.parts_of(shape);
        let own_mass = self.registry.masses.get(&shape).copied().or(role.mass);
        let hull = hull_mass(&parts, own_mass);
        let shapes = self.shapes_of_body(shape)?;
        self.join_parked(entry.parent, edit)?;
        let (parent, x_wp) = self.parent_in_edit(entry.parent, edit)?;
        let place = self.pose(shape, Reference::World)?;
        let mut name = self.model_name(shape)?;
        let is_taken = |name: &str| edit.draft.table(&format!("{}/{name}", parent.trim_end_matches('/'))).is_some();
        if is_taken(&name) {
            name = self.unused_name(&name, is_taken);
        }
        let mut keys = table([("name", name.clone().into()), ("shape", Value::Array(shapes))]);
        match (hull, own_mass) {
            (Some(hull), _) => keys.extend(mass_keys(&hull)),
            (None, Some(mass)) => drop(keys.insert("mass".into(), mass.into())),
            (None, None) => drop(keys.insert("density".into(), DENSITY.into())),
        }
        if role.is_respondable {
            keys.insert("contact".into(), self.contact_keys(shape));
        }
        let is_carried = !edit.fixed.contains(&parent) && (edit.joined.contains_key(&parent) || self.moves(&parent));
        let (parent, pose) = if role.is_static || is_carried {
            (parent, x_wp.inverse().compose(&place))
        } else {
            let joint = self.fresh_name_in(&format!("{name}_free"), &edit.draft);
            (edit.draft.add("joint", free_joint(&joint, "/", &place)), Pose::identity())
        };
        keys.insert("parent".into(), parent.into());
        keys.extend(pose_keys(&pose));
        let path = edit.draft.add("body", keys);
        if role.is_static && !is_carried {
            edit.fixed.insert(path.clone());
        }
        edit.joined.insert(path, shape);
        Ok(())
    }

    /// Parts of a shape as the scene file has them, in its frame.
    fn shapes_of_body(&mut self, shape: Handle) -> Result<Vec<Value>, ApiError> {
        let path = self.registry.entry(shape)?.path.clone();
        let parts = self.registry.senses.parts_of(shape);
        let flat =
            || ApiError(format!("`{path}` is flat: a body that moves or touches needs a volume, such as a cuboid"));
        let keys = parts.into_iter().map(|(piece, place)| {
            let mut keys = shape_keys(piece.geometry.surface()).ok_or_else(flat)?;
            keys.extend(pose_keys(&place));
            let [r, g, b] = piece.color;
            keys.insert("color".into(), format!("#{r:02x}{g:02x}{b:02x}").into());
            Ok(Value::Object(keys))
        });
        keys.collect()
    }

    /// Returns true if an object of the model moves.
    fn moves(&self, path: &str) -> bool {
        let handle = self.handle_at(path);
        handle.and_then(|handle| self.carrier_frame(handle)).is_ok_and(|frame| frame.link.is_some())
    }

    /// Returns true if a body of the model has a contact in the scene.
    pub(crate) fn has_contact(&self, body: Handle) -> bool {
        let object = self.model_path(body).ok().and_then(|path| self.registry.scene().object(&path).cloned());
        object.is_some_and(|object| object.contact.is_some())
    }

    /// Lets a body of the model touch others that touch.
    ///
    /// # Errors
    ///
    /// It has no shapes.
    pub(crate) fn add_contact(&mut self, body: Handle) -> Result<(), ApiError> {
        let path = self.model_path(body)?;
        let mut edit = self.draft()?;
        let Some(("body", keys)) = edit.draft.table(&path) else {
            return Err(ApiError(format!("`{path}` is no body")));
        };
        let mut keys = keys.clone();
        if keys.get("shape").and_then(Value::as_array).is_none_or(Vec::is_empty) {
            return Err(ApiError(format!("`{path}` has no shape to touch others with")));
        }
        keys.insert("contact".into(), self.contact_keys(body));
        edit.draft.replace(&path, "body", keys);
        self.rebuild(edit)
    }
}

/// Mass properties of a body of one mesh or hull, in its frame: those of its convex hull, of the mass that is given or
/// of water. None for solids, whose mass the model computes itself.
fn hull_mass(parts: &[(Piece, Pose<f64>)], mass: Option<f64>) -> Option<MassProperties> {
    let [(piece, place)] = parts else { return None };
    let (Surface::Hull(points) | Surface::Mesh(points, _)) = piece.geometry.surface() else { return None };
    let placed: Vec<[f64; 3]> = points.iter().map(|point| place.point(Vec3(*point)).0).collect();
    let (corners, triangles) = convex_hull(&placed)?;
    let of_water = mass_properties(&corners, &triangles, DENSITY);
    let scale = mass.map_or(1.0, |mass| mass / of_water.mass);
    let inertia = of_water.inertia.map(|x| x * scale);
    Some(MassProperties { mass: of_water.mass * scale, inertia, ..of_water })
}
