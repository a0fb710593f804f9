//! Viscous joint damper: τ = −c q̇.

use sincro_math::Real;

use crate::joint::Dof;

/// Torque [N·m] or force `[N]` at rate `v`.
#[inline(always)]
pub fn torque<R: Real>(dof: &Dof<R>, v: R) -> R {
    -(dof.damping * v)
}

/// Power taken from the mechanism c q̇² `[W]`, never negative.
#[inline(always)]
pub fn dissipation<R: Real>(dof: &Dof<R>, v: R) -> R {
    dof.damping * v * v
}
