//! Linear joint spring: τ = −k (q − rest).

use sincro_math::Real;

use crate::joint::Dof;

/// Torque [N·m] or force `[N]` at coordinate `q`.
#[inline(always)]
pub fn torque<R: Real>(dof: &Dof<R>, q: R) -> R {
    dof.stiffness * (dof.rest - q)
}

/// Stored energy ½ k (q − rest)² `[J]`.
#[inline(always)]
pub fn energy<R: Real>(dof: &Dof<R>, q: R) -> R {
    let deflection = q - dof.rest;
    R::splat(0.5) * dof.stiffness * deflection * deflection
}
