//! Objects of environments of inverse kinematics: those of the scene, and dummies and joints of their own.

use sincro_conventions::ik_objects::{FIRST, IN_ONE, OwnObject};
use sincro_dynamics::spatial::Pose;

use super::ik::IkJoint;
use super::registry::{Handle, Kind};
use super::{ApiError, Reference, SimApi};

impl SimApi<'_> {
    /// Object of an environment's own.
    pub(super) fn own_object(&self, handle: Handle) -> Option<&OwnObject> {
        let environment = usize::try_from(handle.0.checked_sub(FIRST)?).ok()? / IN_ONE;
        self.registry.environments.get(environment)?.as_ref()?.own.get(handle.0)
    }

    /// Object of an environment's own, to be changed.
    pub(super) fn own_object_mut(&mut self, handle: Handle) -> Option<&mut OwnObject> {
        let environment = usize::try_from(handle.0.checked_sub(FIRST)?).ok()? / IN_ONE;
        self.registry.environments.get_mut(environment)?.as_mut()?.own.get_mut(handle.0)
    }

    /// Pose of an object of the scene or of an environment in the world `[m]`; that of a joint before it moves.
    ///
    /// # Errors
    ///
    /// There is no such object.
    pub(super) fn ik_pose(&mut self, handle: Handle) -> Result<Pose<f64>, ApiError> {
        let Some(own) = self.own_object(handle) else { return self.pose(handle, Reference::World) };
        let (parent, pose) = (own.parent, own.pose);
        Ok(self.carried_frame(parent)?.compose(&pose))
    }

    /// Frame in the world in which the children of an object have their poses.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is a joint of the scene.
    fn carried_frame(&mut self, parent: Option<i32>) -> Result<Pose<f64>, ApiError> {
        let mut frame = Pose::identity();
        let mut at = parent.map(Handle);
        while let Some(handle) = at {
            let Some(own) = self.own_object(handle) else {
                let entry = self.registry.entry(handle)?;
                if matches!(entry.kind, Kind::Joint(_)) {
                    let help = "hang it on what the joint carries";
                    return Err(ApiError(format!("`{}` is a joint of the scene: {help}", entry.path)));
                }
                return Ok(self.pose(handle, Reference::World)?.compose(&frame));
            };
            frame = own.carried().compose(&frame);
            at = own.parent.map(Handle);
        }
        Ok(frame)
    }

    /// Parent of an object, as [`super::ObjectRegistry::parent_below`] has it.
    ///
    /// # Errors
    ///
    /// There is no such object.
    pub(super) fn ik_parent(&self, handle: Handle, base: Option<Handle>) -> Result<Option<Handle>, ApiError> {
        match self.own_object(handle) {
            Some(own) => Ok(own.parent.map(Handle)),
            None => self.registry.parent_below(handle, base),
        }
    }

    /// Puts an object of an environment's own somewhere in the world.
    ///
    /// # Errors
    ///
    /// There is no such object.
    pub(super) fn place_own(&mut self, handle: Handle, x_wo: &Pose<f64>) -> Result<(), ApiError> {
        let parent = self.own_object(handle).and_then(|own| own.parent);
        let x_pw = self.carried_frame(parent)?.inverse();
        let own = self.own_object_mut(handle).ok_or_else(|| ApiError(format!("there is no object {}", handle.0)))?;
        own.pose = x_pw.compose(x_wo);
        Ok(())
    }

    /// Hangs an object of an environment's own on another, or in the world; it stays where it is, or keeps its pose in
    /// the parent's frame.
    ///
    /// # Errors
    ///
    /// There is no such object, it would hang below itself, or the parent is a joint of the scene.
    pub(super) fn hang_own(
        &mut self,
        handle: Handle,
        parent: Option<Handle>,
        stays_in_place: bool,
    ) -> Result<(), ApiError> {
        let mut at = parent;
        while let Some(above) = at {
            if above == handle {
                return Err(ApiError::new("an object cannot hang below itself"));
            }
            at = self.own_object(above).and_then(|own| own.parent.map(Handle));
        }
        self.carried_frame(parent.map(|parent| parent.0))?;
        let x_wo = self.ik_pose(handle)?;
        let own = self.own_object_mut(handle).ok_or_else(|| ApiError(format!("there is no object {}", handle.0)))?;
        own.parent = parent.map(|parent| parent.0);
        if stays_in_place { self.place_own(handle, &x_wo) } else { Ok(()) }
    }

    /// Position of a joint that a group moves `[rad]` or `[m]`.
    pub(super) fn position_of(&self, joint: &IkJoint) -> f64 {
        match joint.q_idx {
            Some(k) => self.world.state.q[k],
            None => self.own_object(joint.handle).and_then(|own| own.joint).map_or(0.0, |joint| joint.position),
        }
    }

    /// Puts a joint that a group moves at a position `[rad]` or `[m]`.
    pub(super) fn set_position_of(&mut self, joint: &IkJoint, q: f64) {
        match joint.q_idx {
            Some(k) => self.world.state.q[k] = q,
            None => {
                if let Some(own) = self.own_object_mut(joint.handle).and_then(|own| own.joint.as_mut()) {
                    own.position = q;
                }
            }
        }
    }

    /// Keeps the position of a joint in an environment, not in the scene.
    ///
    /// # Errors
    ///
    /// There is no such environment.
    pub(super) fn keep_position(&mut self, environment: i64, joint: Handle, q: f64) -> Result<(), ApiError> {
        match self.own_object_mut(joint).and_then(|own| own.joint.as_mut()) {
            Some(own) => own.position = q,
            None => drop(self.environment(environment)?.positions.insert(joint, q)),
        }
        Ok(())
    }
}
