//! Drives: set-valued joint torques of velocity motors and Coulomb friction.
//!
//! A drive has a target velocity (zero for friction) and a torque limit. Its state is *locked* (0): the joint moves
//! exactly at the target velocity, with any torque within the limit; or *saturated* (+1 or −1): the drive applies its
//! limit towards the target velocity. The transition between the two is an event that the world locates
//! ([`crate::world`]). A locked degree of freedom has a prescribed acceleration in the recursions
//! ([`crate::recursions::aba::Prescribed`]): no gain, no drift, no creep.
//!
//! Law: |τ| ≤ τ_max, and τ = τ_max sign(v* − v) where v ≠ v*. Source: key `acary2008`, chapter 3 (friction as a
//! set-valued law).

use crate::ids::MotorId;

/// Source of a set-valued joint torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveKind {
    /// Coulomb friction of the joint.
    Friction,
    /// Velocity or position motor of this index.
    Motor(MotorId),
    /// Lock without a limit: a degree of freedom of a force sensor.
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
