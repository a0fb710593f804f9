//! Free joint: S = 1, six degrees of freedom; rates are the link's twist against its parent in link axes, angular
//! first.

use sincro_math::Real;

use super::{Ball, Link, Placement, Stage};
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, Quat, RigidInertia, Vec3};

/// Unconstrained motion.
pub(crate) struct Free;

impl Stage for Free {
    const N_Q: usize = 7;
    const N_V: usize = 6;

    #[inline(always)]
    fn place<R: Real>(link: &Link<R>, q: &[R], at: &mut Placement<R>) {
        at.rot = Quat::from_slice(&q[3..7]).matrix();
        at.offset = link.origin + link.base_vector(Vec3([q[0], q[1], q[2]]));
    }

    #[inline(always)]
    fn offset<R: Real>(_: &Link<R>, at: &Placement<R>) -> Vec3<R> {
        at.offset
    }

    #[inline(always)]
    fn turn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        Ball::turn(at, x)
    }

    #[inline(always)]
    fn unturn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        Ball::unturn(at, x)
    }

    #[inline(always)]
    fn turn_articulated<R: Real>(at: &Placement<R>, ia: &ArticulatedInertia<R>) -> ArticulatedInertia<R> {
        Ball::turn_articulated(at, ia)
    }

    #[inline(always)]
    fn turn_rigid<R: Real>(at: &Placement<R>, i: &RigidInertia<R>) -> RigidInertia<R> {
        Ball::turn_rigid(at, i)
    }

    #[inline(always)]
    fn rotation<R: Real>(at: &Placement<R>) -> Mat3<R> {
        Ball::rotation(at)
    }

    #[inline(always)]
    fn column<R: Real>(_: &Link<R>, j: usize, rate: R) -> Motion<R> {
        if j < 3 {
            Motion { ang: Vec3::along(j, rate), lin: Vec3::zero() }
        } else {
            Motion { ang: Vec3::zero(), lin: Vec3::along(j - 3, rate) }
        }
    }

    #[inline(always)]
    fn project<R: Real>(_: &Link<R>, j: usize, f: &Force<R>) -> R {
        if j < 3 { f.ang[j] } else { f.lin[j - 3] }
    }

    #[inline(always)]
    fn inertia_column<R: Real>(_: &Link<R>, j: usize, ia: &ArticulatedInertia<R>) -> Force<R> {
        if j < 3 {
            Force { ang: ia.rotational.col(j), lin: ia.coupling.row(j) }
        } else {
            Force { ang: ia.coupling.col(j - 3), lin: ia.linear.col(j - 3) }
        }
    }

    #[inline(always)]
    fn minus_outer_before<R: Real>(
        ia: &ArticulatedInertia<R>,
        u: &Force<R>,
        ku: &Force<R>,
        j: usize,
    ) -> ArticulatedInertia<R> {
        let mut out = *ia;
        // whole columns before j: rotations first, then translations
        let (rotations, translations) = if j < 3 { (j, 0) } else { (3, j - 3) };
        for a in 0..3 {
            for b in 0..3 {
                if a <= b && a < rotations {
                    out.rotational.set(a, b, ia.rotational.at(a, b) - u.ang[a] * ku.ang[b]);
                }
                if a < rotations {
                    out.coupling.0[a][b] -= u.ang[a] * ku.lin[b];
                }
                if a <= b && a < translations {
                    out.linear.set(a, b, ia.linear.at(a, b) - u.lin[a] * ku.lin[b]);
                }
            }
        }
        out
    }
}
