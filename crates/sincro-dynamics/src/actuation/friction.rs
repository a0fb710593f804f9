//! Friction of a joint: a torque of limited magnitude that keeps the joint at rest if it can, and opposes the motion
//! otherwise; at rest the limit may be higher than in motion (stiction), between the two it follows Stribeck's curve.
//!
//! It is a drive ([`crate::actuation::drive`]) with target velocity zero. The law is not regularised, so a sticking
//! joint does not creep. Its limits: [`crate::joint::Friction`].

use sincro_math::Real;

/// Power taken from the mechanism `[W]` by friction `torque` at rate `v`, never negative.
#[inline(always)]
pub fn dissipation<R: Real>(torque: R, v: R) -> R {
    -(torque * v)
}
