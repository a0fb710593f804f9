//! Static bodies (parameter 3003 of shapes): they stay where they are against what they hang on.
//!
//! | the body hangs on | static it is |
//! |---|---|
//! | a free joint of its own | fixed in the world, the joint a frame until the body moves again |
//! | a body or force sensor | joined to it, as before; fixed in the world when it is hung on that |
//! | a joint of one coordinate | held by the joint, which the dynamics do not move; `sim.setJointPosition` does |
//!
//! In V-REP such a body has no inertia for what carries it. Here it has, unless it is fixed in the world.

use sincro_dynamics::spatial::Pose;

use super::{Belt, free_joint};
use crate::api::registry::{Handle, Kind};
use crate::api::{ApiError, Reference, SimApi};

impl SimApi<'_> {
    /// Makes a body static, or lets the dynamics move it.
    ///
    /// # Errors
    ///
    /// The body is carried by a joint of several coordinates, or would move and has no mass.
    pub(crate) fn set_static(&mut self, handle: Handle, is_static: bool) -> Result<(), ApiError> {
        let entry = self.registry.entry(handle)?.clone();
        let Kind::Body(mass) = entry.kind else {
            return Err(ApiError(format!("`{}` is no body", entry.path)));
        };
        if is_static {
            self.registry.statics.insert(handle);
            return self.hold_static(handle).inspect_err(|_| {
                self.registry.statics.remove(&handle);
            });
        }
        if !self.is_static(handle)? {
            return Ok(());
        }
        if self.is_fixed(handle)? {
            let was_massless = self.registry.belts.get(&handle).is_some_and(Belt::was_massless);
            if mass.mass <= 0.0 || was_massless {
                return Err(ApiError(format!("`{}` has no mass: give it one in the scene", entry.path)));
            }
        }
        self.registry.statics.remove(&handle);
        let is_own = |joint: &Handle| self.is_free_joint(*joint) || self.belt_joint(handle) == Some(*joint);
        if let Some(joint) = self.nearest_joint(handle).filter(|joint| !is_own(joint)) {
            let (mode, _) = self.kinematic_mode(joint)?;
            return self.set_kinematic_mode(joint, mode, self.is_hybrid(joint));
        }
        if self.is_fixed(handle)? { self.let_move(handle) } else { Ok(()) }
    }

    /// Returns true if a body is fixed in the world, or was made static.
    pub(crate) fn is_static(&self, handle: Handle) -> Result<bool, ApiError> {
        Ok(self.registry.statics.contains(&handle) || self.is_fixed(handle)?)
    }

    /// Returns true if a body that was made static hangs on a joint, with no other joint between them.
    pub(in crate::api) fn carries_static(&self, joint: Handle) -> bool {
        self.registry.statics.iter().any(|body| self.nearest_joint(*body) == Some(joint))
    }

    /// Holds a body that was made static: by the world or by its joint.
    ///
    /// # Errors
    ///
    /// A joint of several coordinates carries it.
    pub(super) fn hold_static(&mut self, handle: Handle) -> Result<(), ApiError> {
        if self.is_fixed(handle)? {
            return Ok(());
        }
        if let Some(joint) = self.free_carrier(handle).filter(|joint| self.is_free_joint(*joint)) {
            self.take_off_belt(handle)?;
            let place = self.pose(handle, Reference::World)?;
            let mut edit = self.draft()?;
            self.park(joint, handle, (None, &place), &mut edit)?;
            return self.rebuild(edit);
        }
        if self.is_joined(handle) {
            return Ok(());
        }
        let Some(joint) = self.nearest_joint(handle) else { return Ok(()) };
        if self.registry.joint(joint).is_err() {
            let (body, joint) = (&self.registry.entry(handle)?.path, &self.registry.entry(joint)?.path);
            let help = "make the body on it static that has the joint for itself, or hang this one on the world first";
            return Err(ApiError(format!("`{body}` hangs on `{joint}`, which no motor can hold: {help}")));
        }
        let (mode, _) = self.kinematic_mode(joint)?;
        self.set_kinematic_mode(joint, mode, self.is_hybrid(joint))
    }

    /// Nearest joint above a body, above frames and bodies that it is joined to.
    fn nearest_joint(&self, body: Handle) -> Option<Handle> {
        let parent = |handle: &Handle| self.registry.entry(*handle).ok()?.parent;
        let is_joint =
            |handle: &Handle| self.registry.entry(*handle).is_ok_and(|entry| matches!(entry.kind, Kind::Joint(_)));
        std::iter::successors(parent(&body), parent).find(is_joint)
    }

    /// Puts a body that is fixed in the world on a free joint.
    fn let_move(&mut self, handle: Handle) -> Result<(), ApiError> {
        self.take_off_belt(handle)?;
        let place = self.pose(handle, Reference::World)?;
        let mut edit = self.draft()?;
        if let Some(joint) = self.free_carrier(handle).filter(|joint| self.was_joint(*joint)) {
            self.free(joint, handle, &place, &mut edit)?;
            return self.rebuild(edit);
        }
        let name = self.fresh_name(&format!("{}_free", self.registry.entry(handle)?.name));
        let joint = edit.draft.add("joint", free_joint(&name, "/", &place));
        let path = self.model_path(handle)?;
        edit.draft.hang(&path, &joint, &Pose::identity());
        self.rebuild(edit)
    }
}
