//! Object tree as clients and scripts see it: free joints are left out.
//!
//! V-REP has no free joints: a loose shape hangs on the world. Here the first body on a free joint takes the joint's
//! place, and what else is on the joint hangs on that body, with which it moves. Joints that are left out are found by
//! their own names and paths, and stand in no other list. A frame that was a free joint, of a body that was joined to
//! another one, is left out as well, and so is the joint that carries a conveyor belt.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value};
use sincro_dynamics::joint::JointKind;

use super::ApiError;
use super::registry::{Entry, Handle, Kind, ObjectRegistry};
use super::scene_objects::{handle_of_id, handle_of_object};
use super::structure::Belt;
use sincro_scene::scene::{ObjectKind, Scene};

/// Handles of the objects of a scene that clients do not see as parents: free joints, and frames that were free joints.
pub(super) fn left_out(scene: &Scene) -> BTreeSet<Handle> {
    let is_free = |kind: &ObjectKind| matches!(kind, ObjectKind::Joint { kind: JointKind::Free, .. });
    let free = scene.objects.iter().filter(|object| is_free(&object.kind)).map(handle_of_object);
    let parked = scene.source.iter().flat_map(|source| &source.parked);
    let parked = parked.filter(|(_, keys)| !is_force_sensor(keys)).map(|(id, _)| handle_of_id(*id));
    free.chain(parked).collect()
}

/// Returns true if the keys of a joint in a scene file are those of a force sensor.
pub(super) fn is_force_sensor(keys: &Map<String, Value>) -> bool {
    keys.get("kind").and_then(Value::as_str) == Some("fixed")
}

impl ObjectRegistry {
    /// Returns true if clients do not see an object as a parent: a free joint, or a frame that was one.
    #[must_use]
    pub fn is_left_out(&self, handle: Handle) -> bool {
        self.left_out.contains(&handle)
    }

    /// Leaves the joints of conveyor belts out of the tree: their bodies take their places.
    pub(super) fn leave_out_belts(&mut self) {
        self.left_out.extend(self.belts.values().filter_map(Belt::joint));
        self.body_on = self.bodies_on_joints();
    }

    /// First body on a free joint, which takes the joint's place in the tree.
    pub(super) fn body_on(&self, joint: Handle) -> Option<Handle> {
        self.body_on.get(&joint).copied()
    }

    /// First body on each joint that clients do not see, by the joint; bodies change their parents with the structure
    /// only.
    pub(super) fn bodies_on_joints(&self) -> BTreeMap<Handle, Handle> {
        let mut found = BTreeMap::new();
        for entry in self.entries().filter(|entry| matches!(entry.kind, Kind::Body(_))) {
            if let Some(joint) = entry.parent.filter(|parent| self.is_left_out(*parent)) {
                found.entry(joint).or_insert(entry.handle);
            }
        }
        found
    }

    /// Joint, or frame that was one, whose place a body takes in the tree; none for other objects.
    pub(super) fn joint_below(&self, body: Handle) -> Option<Handle> {
        let joint = self.entry(body).ok()?.parent?;
        (self.is_left_out(joint) && self.body_on(joint) == Some(body)).then_some(joint)
    }

    /// Handle of the parent of an object as clients see it, above free joints; none for the world, and for what is no
    /// object.
    #[must_use]
    pub fn visible_parent(&self, handle: Handle) -> Option<Handle> {
        let mut at = handle;
        loop {
            let parent = self.entry(at).ok()?.parent?;
            if !self.is_left_out(parent) {
                return Some(parent);
            }
            match self.body_on(parent) {
                Some(body) if body != at => return Some(body),
                _ => at = parent,
            }
        }
    }

    /// Parent of an object in a chain down from `base`, which may be a free joint; else the one that clients see.
    ///
    /// # Errors
    ///
    /// There is no such object.
    pub(super) fn parent_below(&self, handle: Handle, base: Option<Handle>) -> Result<Option<Handle>, ApiError> {
        let parent = self.entry(handle)?.parent;
        Ok(if parent == base { parent } else { self.visible_parent(handle) })
    }

    /// Children of an object, or of the world for none, as clients see them, in the order of
    /// [`ObjectRegistry::entries`]; free joints are not among them.
    pub fn visible_children(&self, parent: Option<Handle>) -> impl Iterator<Item = &Entry> {
        self.level(parent).into_iter().filter(|entry| !self.is_left_out(entry.handle))
    }

    /// Objects among which a level of a path is looked for: the visible children of an object, and before each the free
    /// joint that carries it.
    pub(super) fn level(&self, parent: Option<Handle>) -> Vec<&Entry> {
        let mut found = Vec::new();
        match parent {
            Some(joint) if self.is_left_out(joint) => self.add_carried(joint, &mut found),
            _ => self.children(parent).chain(self.beside(parent)).for_each(|entry| self.add(entry, &mut found)),
        }
        found
    }

    fn add<'a>(&'a self, entry: &'a Entry, found: &mut Vec<&'a Entry>) {
        found.push(entry);
        if self.is_left_out(entry.handle) {
            self.add_carried(entry.handle, found);
        }
    }

    /// Adds the body that takes the place of a free joint, or all that is on a joint without body.
    fn add_carried<'a>(&'a self, joint: Handle, found: &mut Vec<&'a Entry>) {
        let body = self.body_on(joint);
        let carried = self.children(Some(joint)).filter(|entry| body.is_none_or(|body| body == entry.handle));
        carried.for_each(|entry| self.add(entry, found));
    }

    /// Objects on the free joint of a body besides it.
    fn beside(&self, body: Option<Handle>) -> impl Iterator<Item = &Entry> {
        let joint = body.and_then(|body| self.joint_below(body));
        let on_joint = joint.into_iter().flat_map(|joint| self.children(Some(joint)));
        on_joint.filter(move |entry| Some(entry.handle) != body)
    }

    /// Handles of an object and of all below it as clients see them, the object first.
    #[must_use]
    pub fn visible_tree(&self, base: Handle) -> Vec<Handle> {
        let mut found = vec![base];
        let mut next = 0;
        while let Some(at) = found.get(next).copied() {
            next += 1;
            found.extend(self.visible_children(Some(at)).map(|entry| entry.handle));
        }
        found
    }

    /// Path of an object in the tree as clients see it: free joints are left out, and of several siblings of one name
    /// each has its number, `/cube[1]`.
    #[must_use]
    pub fn visible_path(&self, handle: Handle) -> String {
        let Ok(entry) = self.entry(handle) else { return String::new() };
        let parent = self.visible_parent(handle);
        let above = parent.map_or_else(String::new, |parent| self.visible_path(parent));
        let siblings = self.level(parent);
        let same: Vec<Handle> = siblings.iter().filter(|e| e.name == entry.name).map(|e| e.handle).collect();
        match same.iter().position(|sibling| *sibling == handle) {
            Some(k) if same.len() > 1 && !self.is_left_out(handle) => format!("{above}/{}[{k}]", entry.name),
            _ => format!("{above}/{}", entry.name),
        }
    }
}
