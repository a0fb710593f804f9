//! Coulomb friction of a joint: a torque of magnitude at most `limit` that keeps the joint at rest if it can, and
//! opposes the motion otherwise.
//!
//! It is a drive ([`crate::actuation::drive`]) with target velocity zero. The law is not regularised, so a sticking
//! joint does not creep.

use sincro_math::Real;

/// Power taken from the mechanism `[W]` by friction `torque` at rate `v`, never negative.
#[inline(always)]
pub fn dissipation<R: Real>(torque: R, v: R) -> R {
    -(torque * v)
}
