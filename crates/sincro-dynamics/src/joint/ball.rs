//! Ball joint: S = (1, 0), three degrees of freedom that the recursions eliminate one after the other.

use sincro_math::Real;

use super::{Link, Placement, Stage};
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, Quat, RigidInertia, Vec3};

/// Any rotation about the link's origin.
pub(crate) struct Ball;

impl Stage for Ball {
    const N_Q: usize = 4;
    const N_V: usize = 3;

    #[inline(always)]
    fn place<R: Real>(_: &Link<R>, q: &[R], at: &mut Placement<R>) {
        at.rot = Quat::from_slice(q).matrix();
    }

    #[inline(always)]
    fn offset<R: Real>(link: &Link<R>, _: &Placement<R>) -> Vec3<R> {
        link.origin
    }

    #[inline(always)]
    fn turn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        at.rot.mul_vec(x)
    }

    #[inline(always)]
    fn unturn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        at.rot.tr_mul_vec(x)
    }

    #[inline(always)]
    fn turn_articulated<R: Real>(at: &Placement<R>, ia: &ArticulatedInertia<R>) -> ArticulatedInertia<R> {
        ia.turned(&at.rot)
    }

    #[inline(always)]
    fn turn_rigid<R: Real>(at: &Placement<R>, i: &RigidInertia<R>) -> RigidInertia<R> {
        i.turned(&at.rot)
    }

    #[inline(always)]
    fn rotation<R: Real>(at: &Placement<R>) -> Mat3<R> {
        at.rot
    }

    #[inline(always)]
    fn column<R: Real>(_: &Link<R>, j: usize, rate: R) -> Motion<R> {
        Motion { ang: Vec3::along(j, rate), lin: Vec3::zero() }
    }

    #[inline(always)]
    fn project<R: Real>(_: &Link<R>, j: usize, f: &Force<R>) -> R {
        f.ang[j]
    }

    #[inline(always)]
    fn inertia_column<R: Real>(_: &Link<R>, j: usize, ia: &ArticulatedInertia<R>) -> Force<R> {
        Force { ang: ia.rotational.col(j), lin: ia.coupling.row(j) }
    }
}
