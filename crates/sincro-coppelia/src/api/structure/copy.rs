//! Copies of objects and models.

use std::collections::{BTreeMap, BTreeSet};

use sincro_dynamics::spatial::Pose;

use super::{Rebuild, free_joint};
use crate::api::registry::{Handle, Kind};
use crate::api::{ApiError, SimApi};

impl SimApi<'_> {
    /// Copies objects to the same places, those whose parents are not copied on the world; with `whole`, and if it is
    /// the base of a model, each with all below it. A copy of a body that moves is free. Copies have the coordinates of
    /// their originals, are at rest, run scripts of their own, and their names have a number appended. Returns the
    /// handles of the copies, in the order of `handles`.
    ///
    /// # Errors
    ///
    /// A handle is no object, an object cannot stand alone (a force, a rotor), or there would be too many.
    pub fn copy_objects(&mut self, handles: &[Handle], whole: bool) -> Result<Vec<Handle>, ApiError> {
        let (mut chosen, mut left_out): (BTreeSet<Handle>, BTreeSet<Handle>) = Default::default();
        for handle in handles {
            self.registry.entry(*handle)?;
            chosen.insert(*handle);
            if whole || self.is_model_base(*handle) {
                chosen.extend(self.registry.tree(*handle));
                // with what is beside it on its free joint, which goes with all of that
                let joint = self.registry.joint_below(*handle).filter(|joint| self.is_free_joint(*joint));
                if let Some(joint) = joint.filter(|joint| self.free_carrier(*handle) != Some(*joint)) {
                    chosen.extend(self.registry.tree(joint));
                    left_out.insert(joint);
                }
            }
        }
        left_out.retain(|joint| !handles.contains(joint));
        if !chosen.iter().any(|handle| self.is_of_model(*handle)) {
            return handles.iter().map(|handle| self.copy(*handle)).collect();
        }
        self.check_room(chosen.len())?;
        let mut edit = self.draft()?;
        let mut copied: BTreeMap<Handle, String> = BTreeMap::new();
        let mut named = BTreeSet::new();
        for root in self.roots(&chosen) {
            if self.is_of_model(root) {
                self.copy_root(root, &chosen, (&mut edit, &mut named), &mut copied)?;
            }
        }
        for joint in left_out.iter().filter_map(|joint| copied.get(joint)) {
            // in V-REP there is no such joint: its script is not that of the body
            edit.draft.remove_scripts(joint);
        }
        self.rebuild(edit)?;
        let mut copies: BTreeMap<Handle, Handle> = BTreeMap::new();
        for (original, path) in &copied {
            copies.insert(*original, self.handle_at(path)?);
        }
        self.copy_joint_modes(&copies)?;
        self.copy_belts(&copies)?;
        // runtime objects go with what they hang on
        let mut runtime: Vec<Handle> = chosen.iter().copied().filter(|h| !copies.contains_key(h)).collect();
        runtime.retain(|h| self.registry.entry(*h).is_ok_and(|entry| entry.is_runtime));
        for original in runtime {
            let parent = self.registry.entry(original)?.parent;
            let pose = self.pose(original, crate::api::Reference::Parent)?;
            let copy = self.copy(original)?;
            if let Some(new) = parent.and_then(|parent| copies.get(&parent)) {
                self.set_parent(copy, Some(*new), false)?;
                self.set_pose(copy, &pose, crate::api::Reference::Parent)?;
            }
            copies.insert(original, copy);
        }
        handles
            .iter()
            .map(|handle| copies.get(handle).copied().ok_or_else(|| ApiError::new("an object was not copied")))
            .collect()
    }

    /// Returns true if an object is the base of a model: a frame of the world with bodies below it.
    fn is_model_base(&self, handle: Handle) -> bool {
        let is_body = |h: &Handle| self.registry.entry(*h).is_ok_and(|entry| matches!(entry.kind, Kind::Body(_)));
        let is_base = |entry: &crate::api::Entry| entry.kind == Kind::Frame && entry.parent.is_none();
        self.registry.entry(handle).is_ok_and(is_base) && self.registry.tree(handle).iter().any(is_body)
    }

    /// Chosen objects whose parents are not chosen.
    fn roots(&self, chosen: &BTreeSet<Handle>) -> Vec<Handle> {
        let parent = |handle: &Handle| self.registry.entry(*handle).ok().and_then(|entry| entry.parent);
        chosen.iter().copied().filter(|handle| parent(handle).is_none_or(|p| !chosen.contains(&p))).collect()
    }

    /// Copies one object with the chosen ones below it.
    fn copy_root(
        &mut self,
        root: Handle,
        chosen: &BTreeSet<Handle>,
        (edit, named): (&mut Rebuild, &mut BTreeSet<String>),
        copied: &mut BTreeMap<Handle, String>,
    ) -> Result<(), ApiError> {
        let entry = self.registry.entry(root)?.clone();
        if matches!(entry.kind, Kind::Force | Kind::Rotor(_)) {
            return Err(ApiError(format!("`{}` acts on what carries it: copy that with it", entry.path)));
        }
        let mut name = self.fresh_name(&entry.name);
        while named.contains(&name) {
            name = next_name(&name);
        }
        named.insert(name.clone());
        // those that hang on the root by chosen ones alone: a deeper one is a root of its own
        let parent = |handle: &Handle| self.registry.entry(*handle).ok().and_then(|entry| entry.parent);
        let is_joined = |handle: &Handle| {
            let mut way = std::iter::successors(Some(*handle), parent).take_while(|above| *above != root);
            way.all(|above| chosen.contains(&above))
        };
        let below: BTreeSet<Handle> = self.registry.tree(root).into_iter().filter(is_joined).collect();
        let mut paths = vec![self.model_path(root)?];
        for handle in below.iter().filter(|h| **h != root && self.is_of_model(**h)) {
            paths.push(self.model_path(*handle)?);
        }
        let moves = matches!(entry.kind, Kind::Body(_)) && !self.is_fixed(root)?;
        let carrier = self.free_carrier(root).filter(|joint| moves && self.is_free_joint(*joint));
        let own_path = paths[0].clone();
        let pairs = if let Some(joint) = carrier {
            // with the joint that lets it move
            let joint_path = self.model_path(joint)?;
            let pose = self.own_pose(joint)?;
            let mut all = vec![joint_path.clone()];
            all.append(&mut paths);
            let carrier_name = format!("{name}_free");
            let mut pairs = edit.draft.copy_some(&all, &joint_path, &carrier_name, "/", &pose);
            if !chosen.contains(&joint) {
                // in V-REP there is no such joint: its script is not that of the body
                edit.draft.remove_scripts(&pairs[0].1);
            }
            let body = pairs.iter().find(|(old, _)| *old == own_path).map(|(_, new)| new.clone()).unwrap_or_default();
            let renamed = edit.draft.set_name(&body, &name);
            for (_, new) in &mut pairs {
                if let Some(rest) = new.strip_prefix(&body) {
                    *new = format!("{renamed}{rest}");
                }
            }
            pairs
        } else if moves {
            let pose = self.own_pose(root)?;
            let joint = edit.draft.add("joint", free_joint(&format!("{name}_free"), "/", &pose));
            edit.draft.copy_some(&paths, &own_path, &name, &joint, &Pose::identity())
        } else {
            // of a belt where it is put back to
            let pose = self.own_pose(self.belt_joint(root).unwrap_or(root))?;
            edit.draft.copy_some(&paths, &own_path, &name, "/", &pose)
        };
        for (old, new) in pairs {
            let original = self.handle_at(&old)?;
            edit.copies.insert(new.clone(), original);
            copied.insert(original, new);
        }
        Ok(())
    }
}

/// The name with the next number.
fn next_name(name: &str) -> String {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let number: u64 = name[stem.len()..].parse().unwrap_or(0);
    format!("{stem}{}", number + 1)
}
