//! Coulomb friction in a joint: a torque of at most `limit` that holds the joint still if it can, and else opposes the motion.
//!
//! As a drive ([`crate::actuation::drive`]) it is a velocity motor that wants zero velocity and is limited in torque; there is no
//! smoothing, so that sticking does not creep.

use sincro_math::Real;

/// Power taken from the mechanism `[W]` by friction `torque` at rate `v`, never negative.
#[inline(always)]
pub fn dissipation<R: Real>(torque: R, v: R) -> R {
    -(torque * v)
}
