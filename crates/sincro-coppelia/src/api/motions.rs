//! Motions under way that clients and scripts have asked for: of numbers (`sim.ruckigPos`), and of the targets of
//! motors (`sim.setJointTargetPosition` with limits). They are part of the registry: snapshots hold them, and they end
//! with the run.

use std::collections::BTreeMap;

use sincro_dynamics::actuation::MotorMode;

use super::registry::{Handle, ObjectRegistry};
use super::{ApiError, SimApi};
use sincro_motion::{Axis, Goal, Limits, PlanError, Point, Profile, Synchronization, plan};

/// Motions of numbers that may be under way at once.
const MAX_MOTIONS: usize = 1_000;
/// Axes of one of them.
const MAX_AXES: usize = 100;
/// A motion that lacks less than this has ended `[s]`: sums of steps are no multiples of them.
const DONE: f64 = 1e-9;

/// Several axes, and the time since they began.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Motion {
    profiles: Vec<Profile>,
    duration: f64,
    elapsed: f64,
}

/// Result of one step of a motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MotionStep {
    /// True if all axes have arrived.
    pub is_done: bool,
    /// States of the axes.
    pub points: Vec<Point>,
    /// Time that is left `[s]`; negative if the last step was longer than what was left.
    pub left: f64,
}

/// Motions of numbers by their handles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Motions {
    list: BTreeMap<i64, Motion>,
    next: i64,
}

/// The motion of the target of a motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct JointMotion {
    profile: Profile,
    elapsed: f64,
    is_velocity: bool,
}

impl Motion {
    /// Plans a motion of axes.
    ///
    /// # Errors
    ///
    /// There are none or too many, or a number makes no sense.
    pub(crate) fn new(axes: &[Axis], synchronization: Synchronization) -> Result<Self, ApiError> {
        if axes.is_empty() || axes.len() > MAX_AXES {
            return Err(ApiError(format!("{} degrees of freedom, expected 1 to {MAX_AXES}", axes.len())));
        }
        let profiles = plan(axes, synchronization)
            .map_err(|PlanError { axis, why }| ApiError(format!("degree of freedom {}: {why}", axis + 1)))?;
        let duration = profiles.iter().map(Profile::duration).fold(0.0, f64::max);
        Ok(Self { profiles, duration, elapsed: 0.0 })
    }

    fn step(&mut self, dt: f64) -> MotionStep {
        self.elapsed += dt;
        let is_done = self.elapsed >= self.duration - DONE;
        let t = if is_done { self.elapsed.max(self.duration) } else { self.elapsed };
        MotionStep {
            is_done,
            points: self.profiles.iter().map(|profile| profile.at(t)).collect(),
            left: self.duration - self.elapsed,
        }
    }
}

impl Motions {
    fn get(&mut self, handle: i64) -> Result<&mut Motion, ApiError> {
        self.list.get_mut(&handle).ok_or_else(|| ApiError(format!("there is no motion with the handle {handle}")))
    }
}

impl SimApi<'_> {
    /// Adds a motion and returns its handle.
    ///
    /// # Errors
    ///
    /// There are too many.
    pub(crate) fn add_motion(&mut self, motion: Motion) -> Result<i64, ApiError> {
        let motions = &mut self.registry.motions;
        if motions.list.len() >= MAX_MOTIONS {
            return Err(ApiError(format!("there are {MAX_MOTIONS} motions already: remove some (sim.ruckigRemove)")));
        }
        let handle = motions.next;
        motions.next += 1;
        motions.list.insert(handle, motion);
        Ok(handle)
    }

    /// Advances a motion by a time `[s]`.
    ///
    /// # Errors
    ///
    /// There is none, or the time is none.
    pub(crate) fn step_motion(&mut self, handle: i64, dt: f64) -> Result<MotionStep, ApiError> {
        let motion = self.registry.motions.get(handle)?;
        if !(dt.is_finite() && dt > 0.0) {
            return Err(ApiError(format!("the cycle time is {dt} s, expected a finite time above 0")));
        }
        Ok(motion.step(dt))
    }

    /// Forgets a motion.
    ///
    /// # Errors
    ///
    /// There is none.
    pub(crate) fn remove_motion(&mut self, handle: i64) -> Result<(), ApiError> {
        self.registry.motions.get(handle)?;
        self.registry.motions.list.remove(&handle);
        Ok(())
    }

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
