//! Drives: set-valued joint torques, that is velocity motors and Coulomb friction.
//!
//! A drive wants a velocity w (friction: zero) and has a limit. Either it *holds* its joint at w with whatever torque that takes,
//! up to the limit, or it *pulls* with its limit towards w. The state of a drive is −1, 0 (holding) or +1.
//! A held degree of freedom is exact in the recursions ([`crate::recursions::aba::Held`]): no gain, no drift, no creep.

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
