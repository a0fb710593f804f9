//! Linear joint springs: τ = −k (q − rest), and springs of ball and free joints.
//!
//! The deflection of a ball joint is the rotation vector φ of its child frame from the rest orientation, |φ| ≤ π; its
//! potential energy is ½ Σ kᵢ φᵢ² and its torque the negative gradient, −Jᵀ K φ in child axes with φ̇ = J ω (source:
//! key `iserles2000`, section 2.5). At |φ| = π the rotation vector, and with it the torque, changes sign. A free joint
//! has such a spring, and one along each axis of its joint frame, −kᵢ (rᵢ − restᵢ), where r is the position of its
//! child frame.

use std::sync::Arc;

use sincro_math::Real;

use super::force_law::NonlinearLaw;
use crate::joint::{Dof, Link, StageKind};
use crate::spatial::{Quat, Vec3};

/// Nonlinear spring and damper of a degree of freedom with a coordinate of its own, beside its linear ones; its
/// deflection is that of the linear spring, from the same rest position. From `JointSpec::spring_law`.
#[derive(Clone, Debug, PartialEq)]
pub struct NonlinearSpring {
    /// Index of the degree of freedom, 0 to n_v − 1.
    pub dof: usize,
    /// Torque `[N·m]` over deflection `[rad]` and rate `[rad/s]`, or force `[N]` over `[m]` and `[m/s]`.
    pub law: Arc<NonlinearLaw>,
}

impl NonlinearSpring {
    /// Elastic and dissipating torque [N·m] or force `[N]` at the coordinate `q` and rate `v`.
    #[inline(always)]
    pub(crate) fn torques<R: Real>(&self, dof: &Dof<R>, q: R, v: R) -> (R, R) {
        let x = q - dof.rest;
        let elastic = self.law.force(x, R::zero());
        (elastic, self.law.force(x, v) - elastic)
    }

    /// Torque known before a linearly implicit step over `steps` of dampers and springs `[s]`, and its term in the
    /// diagonal; at no step the torque now.
    #[inline(always)]
    pub(crate) fn implicit_torque<R: Real>(&self, dof: &Dof<R>, q: R, v: R, steps: (R, R)) -> (R, R) {
        let x = q - dof.rest;
        let (k, c) = self.law.negated_partials(x, v);
        let (k, c) = (k.max(R::zero()), c.max(R::zero()));
        (self.law.force(x, v) - steps.1 * k * v, steps.0 * (c + steps.1 * k))
    }
}

/// Torque [N·m] or force `[N]` at coordinate `q`.
#[inline(always)]
pub(crate) fn torque<R: Real>(dof: &Dof<R>, q: R) -> R {
    dof.stiffness * (dof.rest - q)
}

/// Stored energy ½ k (q − rest)² `[J]`.
#[inline(always)]
pub(crate) fn energy<R: Real>(dof: &Dof<R>, q: R) -> R {
    let deflection = q - dof.rest;
    R::splat(0.5) * dof.stiffness * deflection * deflection
}

/// Deflection of the springs of a ball or free joint: rotation vector `[rad]` from the rest orientation, child axes;
/// of a free joint also the displacement `[m]` along the axes of the joint frame, and the orientation.
struct Deflection<R> {
    rotation: Vec3<R>,
    translation: Option<(Vec3<R>, Quat<R>)>,
}

impl<R: Real> Deflection<R> {
    #[inline(always)]
    fn new(link: &Link<R>, dofs: &[Dof<R>], q: &[R]) -> Self {
        let k = link.q_idx as usize;
        let rest = Quat::exp(Vec3([dofs[0].rest, dofs[1].rest, dofs[2].rest]));
        let is_free = link.kind == StageKind::Free;
        let orientation = Quat::from_slice(if is_free { &q[k + 3..] } else { &q[k..] });
        let rotation = rest.conjugate().mul(&orientation).log();
        // no closure on lanes: it would be compiled for the baseline instruction set
        let mut translation = None;
        if is_free {
            let from_rest = Vec3([q[k] - dofs[3].rest, q[k + 1] - dofs[4].rest, q[k + 2] - dofs[5].rest]);
            translation = Some((from_rest, orientation));
        }
        Self { rotation, translation }
    }
}

#[inline(always)]
fn stiffness<R: Real>(dofs: &[Dof<R>], first: usize, x: Vec3<R>) -> Vec3<R> {
    Vec3([dofs[first].stiffness * x[0], dofs[first + 1].stiffness * x[1], dofs[first + 2].stiffness * x[2]])
}

/// Adds the torques [N·m] and forces `[N]` of the springs of a ball or free joint, child axes; `dofs`, `v` and `torque`
/// begin with its first degree of freedom. The deflections are those after `step` `[s]` at velocity `v`, to first
/// order.
#[inline(always)]
pub(crate) fn add_torques<R: Real>(link: &Link<R>, dofs: &[Dof<R>], (q, v): (&[R], &[R]), step: R, torque: &mut [R]) {
    let Deflection { rotation: phi, translation } = Deflection::new(link, dofs, q);
    let gradient = stiffness(dofs, 0, phi + Vec3([v[0], v[1], v[2]]).scale(step));
    let once = phi.cross(gradient);
    let twice = phi.cross(once);
    let along = gradient - once.scale(R::splat(0.5)) + twice.scale(phi.rotation_rate_coefficient());
    for k in 0..3 {
        torque[k] -= along[k];
    }
    if let Some((displacement, orientation)) = translation {
        let turn = orientation.matrix();
        let ahead = displacement + turn.mul_vec(Vec3([v[3], v[4], v[5]])).scale(step);
        let force = turn.tr_mul_vec(stiffness(dofs, 3, ahead));
        for k in 0..3 {
            torque[3 + k] -= force[k];
        }
    }
}

/// Energy stored in the springs of a ball or free joint `[J]`; `dofs` begins with its first degree of freedom.
#[inline(always)]
pub(crate) fn stored_energy<R: Real>(link: &Link<R>, dofs: &[Dof<R>], q: &[R]) -> R {
    let Deflection { rotation, translation } = Deflection::new(link, dofs, q);
    let of_rotation = rotation.dot(stiffness(dofs, 0, rotation));
    let mut of_translation = R::zero();
    if let Some((x, _)) = translation {
        of_translation = x.dot(stiffness(dofs, 3, x));
    }
    R::splat(0.5) * (of_rotation + of_translation)
}
