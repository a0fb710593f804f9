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

/// Origin of a [`Drive`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveKind {
    /// Coulomb friction of the joint.
    Friction,
    /// Motor in velocity or position mode, with this id.
    Motor(MotorId),
    /// Lock without a limit: a degree of freedom of a force sensor.
    Lock,
}

/// Set-valued torque on a degree of freedom: velocity motor or Coulomb friction. A model lists them
/// ([`Model::drives`](crate::model::Model::drives)); several may act on one degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drive {
    /// Index of the degree of freedom, 0 to n_v − 1.
    pub dof: usize,
    /// Friction, motor or lock.
    pub kind: DriveKind,
}
