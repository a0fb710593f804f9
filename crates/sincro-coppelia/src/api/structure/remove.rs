//! Removal of objects and models.

use std::collections::{BTreeMap, BTreeSet};

use sincro_scene::draft::SceneDraft;

use super::Rebuild;
use crate::api::registry::Handle;
use crate::api::{ApiError, SimApi};

/// Lists of a scene file whose objects act on what carries them, which has to move.
const ACTING: [&str; 3] = ["force", "rotor", "drag"];

impl SimApi<'_> {
    /// Removes objects, with `whole` each with all below it; else their children pass to what carries them. Joints that
    /// carried only what is removed go, too: those that let it move freely for good, the others until something that
    /// moves is hung on them. Links of dummies end with the dummies and the bodies that they join. Scripts of what is
    /// removed end before the next phase.
    ///
    /// # Errors
    ///
    /// A handle is no object.
    pub fn remove_objects(&mut self, handles: &[Handle], whole: bool) -> Result<(), ApiError> {
        let mut chosen = self.with_trees(handles, whole)?;
        if self.unlink_all(&chosen)? {
            // a body that a link has joined to one of them is not below it any more
            chosen = self.with_trees(handles, whole)?;
        }
        // a frame that was the free joint of a body goes with it
        let carriers: Vec<Handle> = chosen.iter().filter_map(|handle| self.free_carrier(*handle)).collect();
        for carrier in carriers.into_iter().filter(|carrier| self.was_joint(*carrier)) {
            chosen.insert(carrier);
        }
        let (of_model, runtime): (Vec<Handle>, Vec<Handle>) =
            chosen.iter().copied().partition(|handle| self.is_of_model(*handle));
        if of_model.is_empty() {
            return runtime.into_iter().try_for_each(|handle| self.remove(handle));
        }
        let edit = self.draft()?;
        let mut gone: BTreeSet<String> = BTreeSet::new();
        for handle in &of_model {
            gone.insert(self.model_path(*handle)?);
        }
        // joints that let nothing move any more
        let idle = idle_joints(&edit.draft, &gone);
        gone.extend(idle);
        self.remove_and_rebuild(edit, gone, &BTreeMap::new())?;
        runtime.into_iter().try_for_each(|handle| self.remove(handle))
    }

    /// Removes objects with the next change of the structure, all at once, if clients and scripts have made them and
    /// all below them, and there are no scripts on them; else now. Whoever asks about objects before then is to call
    /// [`SimApi::remove_doomed`] first.
    ///
    /// # Errors
    ///
    /// As of [`SimApi::remove_objects`].
    pub(crate) fn remove_later(&mut self, handles: &[Handle], whole: bool) -> Result<(), ApiError> {
        let is_doomed = |sim: &Self, own: &Handle| sim.registry.doomed.iter().any(|(other, _)| other == own);
        if handles.iter().any(|own| is_doomed(self, own)) || self.registry.doomed.iter().any(|(_, whole)| *whole) {
            self.remove_doomed()?;
        }
        let is_made = |sim: &Self, own: &Handle| {
            let has_script = sim.registry.scene().scripts.iter().any(|script| script.object as i32 + 1 == own.0);
            sim.registry.added.contains(own) && !has_script
        };
        let all = self.with_trees(handles, true)?;
        if self.registry.belts.is_empty() && all.iter().all(|own| is_made(self, own)) {
            self.registry.doomed.extend(handles.iter().map(|own| (*own, whole)));
            return Ok(());
        }
        if all.iter().any(|own| self.is_of_model(*own)) {
            self.make_bodies()?;
        }
        self.remove_objects(handles, whole)
    }

    /// Removes what waits for it: one compilation. If the scene cannot be without all, each is removed that can be.
    ///
    /// # Errors
    ///
    /// The first that cannot be removed.
    pub fn remove_doomed(&mut self) -> Result<(), ApiError> {
        let doomed = std::mem::take(&mut self.registry.doomed);
        let Some((_, whole)) = doomed.first().copied() else { return Ok(()) };
        let handles: Vec<Handle> = doomed.iter().map(|(own, _)| *own).collect();
        if doomed.iter().all(|(_, other)| *other == whole) && self.remove_objects(&handles, whole).is_ok() {
            return Ok(());
        }
        let mut done = Ok(());
        for (own, whole) in doomed {
            if self.registry.entry(own).is_ok() {
                done = done.and(self.remove_objects(&[own], whole));
            }
        }
        done
    }

    /// Objects, with `whole` each with all below it.
    fn with_trees(&self, handles: &[Handle], whole: bool) -> Result<BTreeSet<Handle>, ApiError> {
        let mut chosen = BTreeSet::new();
        for handle in handles {
            self.registry.entry(*handle)?;
            chosen.insert(*handle);
            if whole {
                chosen.extend(self.registry.tree(*handle));
                chosen.extend(self.registry.visible_tree(*handle));
            }
        }
        Ok(chosen)
    }

    /// Makes an edit without the objects `gone`. Their children pass to what carries those, where they are, or to the
    /// object that `heirs` has for what is removed. Forces, rotors and drags that nothing that moves would carry go,
    /// too.
    ///
    /// # Errors
    ///
    /// The scene cannot be: nothing has changed then.
    pub(super) fn remove_and_rebuild(
        &mut self,
        mut edit: Rebuild,
        mut gone: BTreeSet<String>,
        heirs: &BTreeMap<Handle, Handle>,
    ) -> Result<(), ApiError> {
        let paths = self.pass_children(&mut edit, &mut gone, heirs)?;
        edit.draft.remove(&paths);
        let mut former = Vec::new();
        let mut done = Ok(());
        for (child, parent) in self.orphans(&gone, heirs)? {
            former.push((child, self.registry.entry(child)?.parent));
            done = done.and_then(|()| self.set_parent(child, parent, true));
        }
        if let Err(refused) = done.and_then(|()| self.rebuild(edit)) {
            // nothing has been removed: what hung on it does so again
            former.into_iter().try_for_each(|(child, parent)| self.set_parent(child, parent, true))?;
            return Err(refused);
        }
        Ok(())
    }

    /// Hangs the children of what is removed on what they pass to, where they are. Returns the paths of what is removed
    /// after that; `gone` has those before it.
    fn pass_children(
        &mut self,
        edit: &mut Rebuild,
        gone: &mut BTreeSet<String>,
        heirs: &BTreeMap<Handle, Handle>,
    ) -> Result<BTreeSet<String>, ApiError> {
        let mut of_gone: Vec<String> = gone.iter().cloned().collect();
        // deeper ones first: their paths are then those of the scene
        of_gone.sort_by_key(|path| std::cmp::Reverse(path.matches('/').count()));
        let mut paths = gone.clone();
        for path in of_gone {
            for child in edit.draft.children(&path) {
                if gone.contains(&child) {
                    continue;
                }
                let handle = self.handle_at(&child)?;
                let above = self.heir(handle, gone, heirs)?;
                let is_carried = above.map_or(Ok(false), |own| self.carries_motion(own))?;
                if !is_carried && edit.draft.table(&child).is_some_and(|(list, _)| ACTING.contains(&list)) {
                    let below = edit.draft.subtree(&child);
                    paths.extend(below.iter().cloned());
                    gone.extend(below);
                    continue;
                }
                let (parent, x_wp) = self.model_parent(above)?;
                let pose = x_wp.inverse().compose(&self.own_pose(handle)?);
                let new = edit.hang(&child, &parent, &pose);
                paths = paths.into_iter().map(|path| moved_path(path, &child, &new)).collect();
            }
        }
        Ok(paths)
    }

    /// Returns true if what hangs on an object is not fixed in the world.
    fn carries_motion(&self, handle: Handle) -> Result<bool, ApiError> {
        Ok(self.registry.entry(handle)?.moving.link.is_some())
    }

    /// Object that carries another one when the objects `gone` are removed; none for the world.
    fn heir(
        &self,
        handle: Handle,
        gone: &BTreeSet<String>,
        heirs: &BTreeMap<Handle, Handle>,
    ) -> Result<Option<Handle>, ApiError> {
        let mut above = self.registry.entry(handle)?.parent;
        while let Some(parent) = above.filter(|parent| self.is_gone(*parent, gone)) {
            above = match heirs.get(&parent) {
                Some(heir) => Some(*heir),
                None => self.registry.entry(parent)?.parent,
            };
        }
        Ok(above)
    }

    fn is_gone(&self, handle: Handle, gone: &BTreeSet<String>) -> bool {
        self.model_path(handle).is_ok_and(|path| gone.contains(&path))
    }

    /// Runtime objects that hang on what is removed, each with what it hangs on then.
    fn orphans(
        &self,
        gone: &BTreeSet<String>,
        heirs: &BTreeMap<Handle, Handle>,
    ) -> Result<Vec<(Handle, Option<Handle>)>, ApiError> {
        let mut found = Vec::new();
        let is_loose = |e: &&crate::api::Entry| e.is_runtime || self.registry.moved_frames.contains(&e.handle);
        let stays = |e: &&crate::api::Entry| !self.is_gone(e.handle, gone);
        for entry in self.registry.entries().filter(is_loose).filter(stays) {
            if entry.parent.is_some_and(|parent| self.is_gone(parent, gone)) {
                found.push((entry.handle, self.heir(entry.handle, gone, heirs)?));
            }
        }
        Ok(found)
    }
}

/// Path of an object after one above it has gone from the path `old` to `new`.
fn moved_path(path: String, old: &str, new: &str) -> String {
    match path.strip_prefix(old) {
        Some(rest) if rest.starts_with('/') => format!("{new}{rest}"),
        _ => path,
    }
}

/// Joints below which no body is left, those above others first.
pub(super) fn idle_joints(draft: &SceneDraft, gone: &BTreeSet<String>) -> Vec<String> {
    let stays = |path: &String| !gone.contains(path);
    let is = |path: &String, list: &str| draft.table(path).is_some_and(|(kind, _)| kind == list);
    // a fixed joint needs nothing to move, unless it measures what it carries
    let is_fixed = |path: &String| {
        let Some((_, keys)) = draft.table(path) else { return false };
        let measures = keys.get("force_sensor").and_then(|value| value.as_bool()) == Some(true);
        keys.get("kind").and_then(|kind| kind.as_str()) == Some("fixed") && !measures
    };
    let can_idle = |path: &String| is(path, "joint") && stays(path) && !is_fixed(path);
    let is_idle = |joint: &String| !draft.subtree(joint).iter().any(|path| is(path, "body") && stays(path));
    draft.subtree("").into_iter().filter(can_idle).filter(is_idle).collect()
}
