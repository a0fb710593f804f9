//! Drives: set-valued joint torques, that is velocity motors and Coulomb friction.
//!
//! A drive wants a velocity w (friction: zero) and has a limit. Either it *holds* its joint at w with whatever torque that takes,
//! up to the limit, or it *pulls* with its limit towards w. The state of a drive is −1, 0 (holding) or +1.
//! A held degree of freedom is exact in the recursions ([`crate::recursions::aba::Held`]): no gain, no drift, no creep.

use sincro_math::Real;

use crate::model::Model;

/// What a drive is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveKind {
    /// Coulomb friction of the joint.
    Friction,
    /// Velocity or position motor of this index.
    Motor(usize),
    /// Nothing moves: a degree of freedom of a force sensor.
    Lock,
}

/// One drive of a model; several may act on one degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drive {
    /// The degree of freedom.
    pub dof: usize,
    /// Friction or a motor.
    pub kind: DriveKind,
}

impl Drive {
    /// Largest torque [N·m], none if there is no limit in any lane.
    #[inline(always)]
    pub(crate) fn limit<R: Real>(&self, model: &Model<R>) -> Option<R> {
        let limit = match self.kind {
            DriveKind::Lock => return None,
            DriveKind::Friction => model.dofs[self.dof].friction,
            DriveKind::Motor(i) => model.motors[i].max_torque,
        };
        limit.is_finite().then_some(limit)
    }

    /// The velocity it wants, for latched commands and coordinates at the tick.
    #[inline(always)]
    pub(crate) fn wanted<R: Real>(&self, model: &Model<R>, q: &[R], commands: &[R]) -> R {
        match self.kind {
            DriveKind::Friction | DriveKind::Lock => R::zero(),
            DriveKind::Motor(i) => model.motors[i].wanted_velocity(q[model.dofs[self.dof].q_idx as usize], commands[i]),
        }
    }
}

/// The drives that a model has: friction first, then motors, then what is locked.
pub(crate) fn drives_of<R: Real>(model: &Model<R>) -> Vec<Drive> {
    let zero = R::zero();
    let friction = model.dofs.iter().enumerate().filter(|(_, d)| d.friction != zero);
    let friction = friction.map(|(dof, _)| Drive { dof, kind: DriveKind::Friction });
    let motors = model.motors.iter().enumerate().filter(|(_, m)| m.is_drive());
    let motors = motors.map(|(i, m)| Drive { dof: m.dof, kind: DriveKind::Motor(i) });
    let sensors = model.names.joints.iter().filter(|j| j.kind == crate::joint::JointKind::Fixed);
    let locked = sensors.flat_map(|j| (j.v_idx..j.v_idx + j.n_v).map(|dof| Drive { dof, kind: DriveKind::Lock }));
    friction.chain(motors).chain(locked).collect()
}
