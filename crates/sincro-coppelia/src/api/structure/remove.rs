//! Removal of objects and models.

use std::collections::BTreeSet;

use sincro_scene::draft::SceneDraft;

use super::Rebuild;
use crate::api::registry::Handle;
use crate::api::{ApiError, SimApi};

impl SimApi<'_> {
    /// Removes objects, with `whole` each with all below it; else their children pass to what carries them. Joints that
    /// carried only what is removed go, too: those that let it move freely for good, the others until something that
    /// moves is hung on them. Scripts of what is removed end before the next phase.
    ///
    /// # Errors
    ///
    /// A handle is no object.
    pub fn remove_objects(&mut self, handles: &[Handle], whole: bool) -> Result<(), ApiError> {
        let mut chosen: BTreeSet<Handle> = BTreeSet::new();
        for handle in handles {
            self.registry.entry(*handle)?;
            chosen.insert(*handle);
            if whole {
                chosen.extend(self.registry.tree(*handle));
                chosen.extend(self.registry.visible_tree(*handle));
            }
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
        let mut edit = self.draft()?;
        let mut gone: BTreeSet<String> = BTreeSet::new();
        for handle in &of_model {
            gone.insert(self.model_path(*handle)?);
        }
        self.pass_children(&mut edit, &mut gone)?;
        // joints that let nothing move any more
        let idle = idle_joints(&edit.draft, &gone);
        gone.extend(idle);
        let stays: Vec<(Handle, Option<Handle>)> = self.orphans(&gone, &chosen)?;
        edit.draft.remove(&gone);
        let mut former = Vec::new();
        for (child, parent) in stays {
            former.push((child, self.registry.entry(child)?.parent));
            self.set_parent(child, parent, true)?;
        }
        if let Err(refused) = self.rebuild(edit) {
            // nothing has been removed: what hung on it does so again
            former.into_iter().try_for_each(|(child, parent)| self.set_parent(child, parent, true))?;
            return Err(refused);
        }
        runtime.into_iter().try_for_each(|handle| self.remove(handle))
    }

    /// Hangs the children of what is removed on what carries that, where they are.
    fn pass_children(&mut self, edit: &mut Rebuild, gone: &mut BTreeSet<String>) -> Result<(), ApiError> {
        let of_gone: Vec<String> = gone.iter().cloned().collect();
        for path in of_gone {
            for child in edit.draft.children(&path) {
                if gone.contains(&child) {
                    continue;
                }
                let handle = self.handle_at(&child)?;
                let mut above = self.registry.entry(handle)?.parent;
                while let Some(parent) = above {
                    let is_gone = self.is_of_model(parent) && gone.contains(&self.model_path(parent)?);
                    if !is_gone {
                        break;
                    }
                    above = self.registry.entry(parent)?.parent;
                }
                let (parent, x_wp) = self.model_parent(above)?;
                let pose = x_wp.inverse().compose(&self.own_pose(handle)?);
                edit.draft.hang(&child, &parent, &pose);
            }
        }
        Ok(())
    }

    /// Runtime objects that hang on what is removed, each with what it hangs on then.
    fn orphans(
        &self,
        gone: &BTreeSet<String>,
        chosen: &BTreeSet<Handle>,
    ) -> Result<Vec<(Handle, Option<Handle>)>, ApiError> {
        let is_gone = |handle: Handle| self.model_path(handle).is_ok_and(|path| gone.contains(&path));
        let mut found = Vec::new();
        let is_loose = |e: &&crate::api::Entry| e.is_runtime || self.registry.moved_frames.contains(&e.handle);
        for entry in self.registry.entries().filter(is_loose).filter(|e| !chosen.contains(&e.handle)) {
            let Some(parent) = entry.parent.filter(|p| is_gone(*p)) else { continue };
            let mut above = self.registry.entry(parent)?.parent;
            while let Some(next) = above.filter(|p| is_gone(*p)) {
                above = self.registry.entry(next)?.parent;
            }
            found.push((entry.handle, above));
        }
        Ok(found)
    }
}

/// Joints below which no body is left, with all below them.
pub(super) fn idle_joints(draft: &SceneDraft, gone: &BTreeSet<String>) -> Vec<String> {
    let mut idle = Vec::new();
    let stays = |path: &String| !gone.contains(path);
    let is = |path: &String, list: &str| draft.table(path).is_some_and(|(kind, _)| kind == list);
    // a fixed joint needs nothing to move, unless it measures what it carries
    let is_fixed = |path: &String| {
        let Some((_, keys)) = draft.table(path) else { return false };
        let measures = keys.get("force_sensor").and_then(|value| value.as_bool()) == Some(true);
        keys.get("kind").and_then(|kind| kind.as_str()) == Some("fixed") && !measures
    };
    let can_idle = |path: &String| is(path, "joint") && stays(path) && !is_fixed(path);
    for joint in draft.subtree("").into_iter().filter(can_idle) {
        let below = draft.subtree(&joint);
        if !below.iter().any(|path| is(path, "body") && stays(path)) {
            idle.extend(below);
        }
    }
    idle
}
