//! Screw joint on the z axis of the link frame: S = (e_z, pitch·e_z).

use sincro_math::Real;

use super::{Link, Placement, Revolute, Stage};
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, RigidInertia, Vec3};

/// Rotation about z that advances by the link's pitch [m/rad].
pub(crate) struct Screw;

/// Screws are rare: their link frame is turned so that the axis is z.
const A: usize = 2;

impl Stage for Screw {
    const N_Q: usize = 1;
    const N_V: usize = 1;

    #[inline(always)]
    fn place<R: Real>(link: &Link<R>, q: &[R], at: &mut Placement<R>) {
        Revolute::<A>::place(link, q, at);
        at.offset = link.origin + link.base_vector(Vec3::along(A, link.pitch * q[0]));
    }

    #[inline(always)]
    fn offset<R: Real>(_: &Link<R>, at: &Placement<R>) -> Vec3<R> {
        at.offset
    }

    #[inline(always)]
    fn turn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        Revolute::<A>::turn(at, x)
    }

    #[inline(always)]
    fn unturn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        Revolute::<A>::unturn(at, x)
    }

    #[inline(always)]
    fn turn_articulated<R: Real>(at: &Placement<R>, ia: &ArticulatedInertia<R>) -> ArticulatedInertia<R> {
        Revolute::<A>::turn_articulated(at, ia)
    }

    #[inline(always)]
    fn turn_rigid<R: Real>(at: &Placement<R>, i: &RigidInertia<R>) -> RigidInertia<R> {
        Revolute::<A>::turn_rigid(at, i)
    }

    #[inline(always)]
    fn rotation<R: Real>(at: &Placement<R>) -> Mat3<R> {
        Revolute::<A>::rotation(at)
    }

    #[inline(always)]
    fn column<R: Real>(link: &Link<R>, _: usize, rate: R) -> Motion<R> {
        Motion { ang: Vec3::along(A, rate), lin: Vec3::along(A, link.pitch * rate) }
    }

    #[inline(always)]
    fn project<R: Real>(link: &Link<R>, _: usize, f: &Force<R>) -> R {
        f.ang[A] + link.pitch * f.lin[A]
    }

    #[inline(always)]
    fn inertia_column<R: Real>(link: &Link<R>, _: usize, ia: &ArticulatedInertia<R>) -> Force<R> {
        Force {
            ang: ia.rotational.col(A) + ia.coupling.col(A).scale(link.pitch),
            lin: ia.coupling.row(A) + ia.linear.col(A).scale(link.pitch),
        }
    }
}
