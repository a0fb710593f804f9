//! Prismatic joint along any direction n of the link frame: S = (0, n).

use sincro_math::Real;

use super::{Link, Placement, Stage};
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, RigidInertia, Vec3};

/// Translation along the link's `axis`. Nothing turns, so that the axis need not be on a coordinate axis.
pub(crate) struct Prismatic;

impl Stage for Prismatic {
    const N_Q: usize = 1;
    const N_V: usize = 1;

    #[inline(always)]
    fn place<R: Real>(link: &Link<R>, q: &[R], at: &mut Placement<R>) {
        at.offset = link.origin + link.axis.scale(q[0]);
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
    fn column<R: Real>(link: &Link<R>, _: usize, rate: R) -> Motion<R> {
        Motion { ang: Vec3::zero(), lin: link.axis.scale(rate) }
    }

    #[inline(always)]
    fn project<R: Real>(link: &Link<R>, _: usize, f: &Force<R>) -> R {
        link.axis.dot(f.lin)
    }

    #[inline(always)]
    fn inertia_column<R: Real>(link: &Link<R>, _: usize, ia: &ArticulatedInertia<R>) -> Force<R> {
        Force { ang: ia.coupling.mul_vec(link.axis), lin: ia.linear.mul_vec(link.axis) }
    }
}
