//! Objects of the model that are hung elsewhere or put elsewhere: grippers, bases.

use sincro_dynamics::spatial::Pose;

use super::remove::idle_joints;
use super::{Rebuild, free_joint, table};
use crate::api::registry::{Handle, Kind};
use crate::api::tree::is_force_sensor;
use crate::api::{ApiError, Reference, SimApi};
use sincro_scene::draft::{SceneDraft, pose_keys};

/// Keys of an object that say where it is.
const PLACE: [&str; 5] = ["name", "parent", "position", "rotation_deg", "quaternion_wxyz"];

impl SimApi<'_> {
    /// Hangs an object of the model on another object, or on the world for none. Hung on something else than the world
    /// a free body is joined to it: momentum is conserved, kinetic energy of the relative motion is lost. Hung on the
    /// world a body that moves is free, with the velocity that it has.
    ///
    /// # Errors
    ///
    /// The object would hang on itself, or the model cannot be so.
    pub(crate) fn hang(&mut self, handle: Handle, parent: Option<Handle>, keeps_place: bool) -> Result<(), ApiError> {
        if let Some(parent) = parent
            && self.registry.tree(handle).contains(&parent)
        {
            return Err(ApiError::new("an object cannot hang on itself"));
        }
        let mut edit = self.draft()?;
        self.join_parked(parent, &mut edit)?;
        self.join_dummies(parent, &mut edit)?;
        let is_body = matches!(self.registry.entry(handle)?.kind, Kind::Body(_));
        // belts and what hangs on them are placed where the belts are put back to
        [Some(handle), parent].into_iter().flatten().try_for_each(|body| self.put_belt_back(body))?;
        let belt = self.belt_joint(handle);
        let carrier = if is_body { self.free_carrier(handle) } else { None };
        let unit = belt.or(carrier).unwrap_or(handle);
        let place = self.hung_place(handle, parent, keeps_place)?;
        let is_free = self.is_free_joint(unit);
        let is_parked = self.was_joint(unit);
        let moves = !self.is_fixed(handle)?;
        match parent {
            None if is_free || is_parked => {
                self.free(unit, handle, &place, &mut edit)?;
            }
            None if is_body && moves => {
                let name = self.fresh_name(&format!("{}_free", self.registry.entry(handle)?.name));
                let joint = edit.draft.add("joint", free_joint(&name, "/", &place));
                let path = self.model_path(handle)?;
                edit.draft.hang(&path, &joint, &Pose::identity());
            }
            _ if is_free => {
                self.park(unit, handle, (parent, &place), &mut edit)?;
            }
            _ => {
                // a body that is joined goes with the frame that lets it be parted, a belt with its joint
                let moved = if is_parked || belt.is_some() { unit } else { handle };
                let own = self.own_pose(moved)?;
                let shown = self.pose(handle, Reference::World)?;
                // of a joint the model's axes are others than those that the API shows
                let place = place.compose(&shown.inverse().compose(&own));
                let (parent, x_wp) = self.parent_in_edit(parent, &edit)?;
                let path = self.model_path(moved)?;
                edit.hang(&path, &parent, &x_wp.inverse().compose(&place));
            }
        }
        self.part_idle(&mut edit)?;
        self.rebuild(edit)?;
        // whoever hangs a body elsewhere takes it off the one that a link has joined it to
        self.registry.dummy_links.retain(|_, link| !link.has_joined(handle));
        if self.registry.statics.contains(&handle) { self.hold_static(handle) } else { Ok(()) }
    }

    /// Place in the world of an object that is hung elsewhere.
    fn hung_place(&mut self, handle: Handle, parent: Option<Handle>, keeps_place: bool) -> Result<Pose<f64>, ApiError> {
        if keeps_place {
            return self.pose(handle, Reference::World);
        }
        let in_parent = self.pose(handle, Reference::Parent)?;
        let x_wp = match parent {
            None => Pose::identity(),
            Some(parent) => {
                let frame = self.registry.entry(parent)?.moving;
                self.place(&frame)
            }
        };
        Ok(x_wp.compose(&in_parent))
    }

    /// The free joint of a body is on the world, the body at a place in the world.
    pub(super) fn free(
        &mut self,
        joint: Handle,
        body: Handle,
        place: &Pose<f64>,
        edit: &mut Rebuild,
    ) -> Result<(), ApiError> {
        let path = self.model_path(joint)?;
        let name = self.registry.entry(joint)?.name.clone();
        if self.is_free_joint(joint) {
            // its coordinates stay: the joint's own frame goes to where the body then is at the place
            let (own, shown) = (self.own_pose(joint)?, self.pose(body, Reference::World)?);
            let base = place.compose(&shown.inverse()).compose(&own);
            edit.draft.hang(&path, "/", &base);
            return Ok(());
        }
        let (at, shown) = (self.own_pose(joint)?, self.pose(body, Reference::World)?);
        let base = place.compose(&shown.inverse()).compose(&at);
        let path = edit.draft.hang(&path, "/", &base);
        edit.draft.unpark(&path, free_joint(&name, "/", &base));
        Ok(())
    }

    /// The free joint of a body becomes a frame on what the body is joined to.
    pub(super) fn park(
        &mut self,
        joint: Handle,
        body: Handle,
        (parent, place): (Option<Handle>, &Pose<f64>),
        edit: &mut Rebuild,
    ) -> Result<(), ApiError> {
        let path = self.model_path(joint)?;
        let frame = self.carrier_frame(joint)?;
        let (moving, shown) = (self.place(&frame), self.pose(body, Reference::World)?);
        let now = place.compose(&shown.inverse()).compose(&moving);
        let (parent, x_wp) = self.parent_in_edit(parent, edit)?;
        let pose = x_wp.inverse().compose(&now);
        let name = self.registry.entry(joint)?.name.clone();
        let path = edit.draft.hang(&path, &parent, &pose);
        let mut frame = table([("name", name.into()), ("parent", parent.into())]);
        frame.extend(pose_keys(&pose));
        edit.draft.park(&path, frame);
        Ok(())
    }

    /// Joints have to carry something; force sensors that carry nothing become frames until something is hung on them.
    fn part_idle(&mut self, edit: &mut Rebuild) -> Result<(), ApiError> {
        let mut idle = idle_joints(&edit.draft, &std::collections::BTreeSet::new());
        for path in &idle {
            park_sensor(&mut edit.draft, path);
        }
        if !idle.is_empty() {
            idle = idle_joints(&edit.draft, &std::collections::BTreeSet::new());
        }
        let Some(first) = idle.first() else { return Ok(()) };
        Err(ApiError(format!("the joint `{first}` would carry nothing: remove it, or hang something else on it first")))
    }

    /// Gives an object that clients or scripts have made another name: of one that is part of the model letters,
    /// digits,
    /// `_` and `-`.
    ///
    /// # Errors
    ///
    /// `handle` is no object or belongs to the scene, or the name is none, or a sibling has it.
    pub fn rename(&mut self, handle: Handle, name: &str) -> Result<(), ApiError> {
        if !self.registry.added.contains(&handle) {
            return self.registry.rename(handle, name);
        }
        let mut edit = self.draft()?;
        edit.conserves_momentum = false;
        let path = self.model_path(handle)?;
        if self.registry.entry(handle)?.name != name {
            edit.draft.set_name(&path, name);
            self.rebuild(edit)?;
        }
        Ok(())
    }

    /// Parts what a force sensor carries from it: bodies are free, with the velocities that they have.
    ///
    /// # Errors
    ///
    /// The object is no force sensor, or a joint or frame that carries bodies hangs on it.
    pub(crate) fn break_force_sensor(&mut self, sensor: Handle) -> Result<(), ApiError> {
        let entry = self.registry.entry(sensor)?;
        if !matches!(entry.kind, Kind::ForceSensor(_)) {
            return Err(ApiError(format!("`{}` is no force sensor", entry.path)));
        }
        let is_body = |handle: &Handle| matches!(self.registry.entry(*handle).map(|e| &e.kind), Ok(Kind::Body(_)));
        let carried: Vec<Handle> = self.registry.visible_children(Some(sensor)).map(|entry| entry.handle).collect();
        let (bodies, others): (Vec<_>, Vec<_>) = carried.into_iter().partition(is_body);
        // what would be fixed in the air; frames and dummies that carry nothing stay where they are
        if let Some(other) = others.into_iter().find(|other| self.registry.tree(*other).iter().any(is_body)) {
            let (sensor, other) = (&entry.path, &self.registry.entry(other)?.path);
            return Err(ApiError(format!(
                "`{other}` carries bodies on `{sensor}`: put a body between to break it there"
            )));
        }
        bodies.into_iter().try_for_each(|body| self.set_parent(body, None, true))?;
        self.registry.broken.insert(sensor);
        Ok(())
    }

    /// State of a force sensor as clients read it: bit 0, it has values; bit 1, it is broken and carries nothing.
    #[must_use]
    pub fn force_sensor_state(&self, sensor: Handle) -> i64 {
        let is_body = |entry: &super::super::registry::Entry| matches!(entry.kind, Kind::Body(_));
        let is_broken =
            self.registry.broken.contains(&sensor) && !self.registry.visible_children(Some(sensor)).any(is_body);
        1 + 2 * i64::from(is_broken)
    }

    /// Returns true if a body of the model is joined to another one, or to a force sensor, without a joint that moves
    /// in between.
    pub(crate) fn is_joined(&self, body: Handle) -> bool {
        if self.free_carrier(body).is_some_and(|carrier| self.was_joint(carrier)) {
            return true;
        }
        let parent = |handle: Handle| self.registry.entry(handle).ok()?.parent;
        let mut at = parent(body);
        while let Some(entry) = at.and_then(|parent| self.registry.entry(parent).ok()) {
            match entry.kind {
                Kind::Body(_) | Kind::ForceSensor(_) => return self.is_of_model(body),
                Kind::Frame => at = parent(entry.handle),
                // beside the body that takes the joint's place
                _ if self.is_free_joint(entry.handle) => {
                    return self.registry.body_on(entry.handle).is_some_and(|first| first != body);
                }
                _ => return false,
            }
        }
        false
    }

    /// Puts a body that is joined to another one at a place in the world, with the frame that lets it be parted.
    ///
    /// # Errors
    ///
    /// The model cannot be so.
    pub(crate) fn place_joined(&mut self, body: Handle, x_wb: &Pose<f64>) -> Result<(), ApiError> {
        let Some(carrier) = self.free_carrier(body).filter(|carrier| self.was_joint(*carrier)) else {
            return self.place_in_model(body, x_wb);
        };
        let (shown, frame) = (self.pose(body, Reference::World)?, self.pose(carrier, Reference::World)?);
        self.place_in_model(carrier, &x_wb.compose(&shown.inverse()).compose(&frame))
    }

    /// Puts an object of the model that is fixed in the world or joined to a body, or a frame or joint with all that it
    /// carries, at a place in the world. All joints keep their coordinates and velocities.
    ///
    /// # Errors
    ///
    /// The object is a body that joints carry.
    pub(crate) fn place_in_model(&mut self, handle: Handle, x_wo: &Pose<f64>) -> Result<(), ApiError> {
        let (own, shown) = (self.own_pose(handle)?, self.pose(handle, Reference::World)?);
        let parent = self.registry.entry(handle)?.parent;
        let (_, x_wp) = self.model_parent(parent)?;
        let place = x_wo.compose(&shown.inverse()).compose(&own);
        let mut edit = self.draft()?;
        (edit.conserves_momentum, edit.is_placement) = (false, true);
        let path = self.model_path(handle)?;
        edit.draft.set_pose(&path, &x_wp.inverse().compose(&place));
        self.rebuild(edit)
    }
}

/// A force sensor becomes a frame with the same place, which remembers it.
fn park_sensor(draft: &mut SceneDraft, path: &str) {
    let Some(("joint", keys)) = draft.table(path) else { return };
    if !is_force_sensor(keys) {
        return;
    }
    let mut frame = keys.clone();
    frame.retain(|key, _| PLACE.contains(&key.as_str()));
    draft.park(path, frame);
}
