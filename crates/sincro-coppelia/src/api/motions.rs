//! Motions of the targets of motors (`sim.setJointTargetPosition` with limits). They are part of the registry, as those
//! of numbers are ([`sincro_planning::Motions`]): snapshots hold them, and they end with the run.

use sincro_dynamics::actuation::MotorMode;

use super::registry::{Handle, ObjectRegistry};
use super::{ApiError, SimApi};
use sincro_motion::{Axis, Goal, Limits, PlanError, Point, Profile, Synchronization, plan};

/// The motion of the target of a motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct JointMotion {
    profile: Profile,
    elapsed: f64,
    is_velocity: bool,
}

impl SimApi<'_> {
    /// Tells a joint its position and lets the target of its motor, in position or spring mode, go there within limits
    /// of velocity, acceleration and jerk: from where the joint is, or from where the target is if it is on its way. In
    /// any other mode the position is kept for later.
    ///
    /// # Errors
    ///
    /// There is no such joint, it has no motor, or a number makes no sense.
    pub(crate) fn go_to_position(
        &mut self,
        handle: Handle,
        position: f64,
        [v, a, j]: [f64; 3],
    ) -> Result<(), ApiError> {
        let joint = self.registry.joint(handle)?;
        let (q_idx, v_idx, motor) = (joint.q_idx, joint.v_idx, joint.motor);
        let here = Point { p: self.world.state.q[q_idx], v: self.world.state.v[v_idx], a: 0.0 };
        let start = self.registry.joint_motions.get(&handle).filter(|c| !c.is_velocity).map_or(here, JointMotion::now);
        let axis = Axis { start, limits: Limits::symmetric(v, a, j), goal: Goal::Position(position, 0.0) };
        let profile = planned(axis)?;
        // forgets where the target was on its way to
        self.set_target_position(handle, position)?;
        let is_followed = matches!(self.driving_mode(handle)?, MotorMode::Position | MotorMode::Spring);
        self.start_joint_motion(
            handle,
            motor.filter(|_| is_followed),
            JointMotion { profile, elapsed: 0.0, is_velocity: false },
        );
        Ok(())
    }

    /// Tells a joint its velocity and lets the target of its motor, in velocity mode, go there within limits of
    /// acceleration and jerk: from the velocity that the joint has, or from that of the target if it is on its way.
    ///
    /// # Errors
    ///
    /// As of [`SimApi::go_to_position`].
    pub(crate) fn go_to_velocity(&mut self, handle: Handle, velocity: f64, [a, j]: [f64; 2]) -> Result<(), ApiError> {
        let joint = self.registry.joint(handle)?;
        let (v_idx, motor) = (joint.v_idx, joint.motor);
        let here = Point { p: 0.0, v: self.world.state.v[v_idx], a: 0.0 };
        let start = self.registry.joint_motions.get(&handle).filter(|c| c.is_velocity).map_or(here, JointMotion::now);
        let profile = planned(Axis { start, limits: Limits::symmetric(1.0, a, j), goal: Goal::Velocity(velocity) })?;
        self.set_target_velocity(handle, velocity)?;
        // a joint that is held has a motor at rest
        let is_followed = self.driving_mode(handle)? == MotorMode::Velocity && !self.is_held(handle);
        self.start_joint_motion(
            handle,
            motor.filter(|_| is_followed),
            JointMotion { profile, elapsed: 0.0, is_velocity: true },
        );
        Ok(())
    }

    fn start_joint_motion(&mut self, handle: Handle, motor: Option<usize>, joint_motion: JointMotion) {
        let Some(motor) = motor else { return };
        self.registry.hold(motor, Some(joint_motion.value()));
        self.registry.joint_motions.insert(handle, joint_motion);
    }
}

fn planned(axis: Axis) -> Result<Profile, ApiError> {
    let profiles = plan(&[axis], Synchronization::None);
    Ok(profiles.map_err(|PlanError { why, .. }| ApiError(format!("the joint cannot go there: {why}")))?[0])
}

impl JointMotion {
    fn now(&self) -> Point {
        self.profile.at(self.elapsed)
    }

    /// Target of the motor.
    fn value(&self) -> f64 {
        if self.is_velocity { self.now().v } else { self.now().p }
    }
}

impl ObjectRegistry {
    /// Advances the moving targets of motors by a base step: a motor is given where its target is to be
    /// at the end of it.
    pub(crate) fn move_targets(&mut self) {
        if self.joint_motions.is_empty() {
            return;
        }
        let step = self.base_step();
        let mut joint_motions = std::mem::take(&mut self.joint_motions);
        joint_motions.retain(|handle, joint_motion| {
            joint_motion.elapsed += step;
            if let Ok(Some(motor)) = self.joint(*handle).map(|joint| joint.motor) {
                self.hold(motor, Some(joint_motion.value()));
            }
            joint_motion.elapsed < joint_motion.profile.duration()
        });
        self.joint_motions = joint_motions;
    }
}
