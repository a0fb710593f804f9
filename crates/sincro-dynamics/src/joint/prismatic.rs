//! Prismatic joint along coordinate axis `A` of the link frame: S = (0, e_A).

use sincro_math::Real;

use super::{Placement, Stage};
use crate::model::Link;
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, RigidInertia, Vec3};

/// Translation along coordinate axis `A` (0 x, 1 y, 2 z).
pub struct Prismatic<const A: usize>;

impl<const A: usize> Stage for Prismatic<A> {
    const N_Q: usize = 1;
    const N_V: usize = 1;

    #[inline(always)]
    fn place<R: Real>(link: &Link<R>, q: &[R], at: &mut Placement<R>) {
        at.offset = link.origin + link.base_vector(Vec3::along(A, link.sign * q[0]));
    }

    #[inline(always)]
    fn offset<R: Real>(_: &Link<R>, at: &Placement<R>) -> Vec3<R> {
        at.offset
    }

    #[inline(always)]
    fn turn<R: Real>(_: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        x
    }

    #[inline(always)]
    fn unturn<R: Real>(_: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        x
    }

    #[inline(always)]
    fn turn_articulated<R: Real>(_: &Placement<R>, ia: &ArticulatedInertia<R>) -> ArticulatedInertia<R> {
        *ia
    }

    #[inline(always)]
    fn turn_rigid<R: Real>(_: &Placement<R>, i: &RigidInertia<R>) -> RigidInertia<R> {
        *i
    }

    #[inline(always)]
    fn rotation<R: Real>(_: &Placement<R>) -> Mat3<R> {
        Mat3::identity()
    }

    #[inline(always)]
    fn column<R: Real>(_: &Link<R>, _: usize, rate: R) -> Motion<R> {
        Motion { ang: Vec3::zero(), lin: Vec3::along(A, rate) }
    }

    #[inline(always)]
    fn project<R: Real>(_: &Link<R>, _: usize, f: &Force<R>) -> R {
        f.lin[A]
    }

    #[inline(always)]
    fn inertia_column<R: Real>(_: &Link<R>, _: usize, ia: &ArticulatedInertia<R>) -> Force<R> {
        Force { ang: ia.coupling.col(A), lin: ia.linear.col(A) }
    }
}
