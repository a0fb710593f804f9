//! Revolute joint about coordinate axis `A` of the link frame: S = (e_A, 0).

use sincro_math::Real;

use super::{Link, Placement, Stage, turn_about, turn_rigid_about};
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, RigidInertia, Vec3};

/// Rotation about coordinate axis `A` (0 x, 1 y, 2 z).
pub(crate) struct Revolute<const A: usize>;

impl<const A: usize> Stage for Revolute<A> {
    const N_Q: usize = 1;
    const N_V: usize = 1;

    #[inline(always)]
    fn place<R: Real>(link: &Link<R>, q: &[R], at: &mut Placement<R>) {
        (at.sin, at.cos) = (link.sign * q[0]).sin_cos();
    }

    #[inline(always)]
    fn offset<R: Real>(link: &Link<R>, _: &Placement<R>) -> Vec3<R> {
        link.origin
    }

    #[inline(always)]
    fn turn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        turn_about::<A, R>(at.sin, at.cos, x)
    }

    #[inline(always)]
    fn unturn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R> {
        turn_about::<A, R>(-at.sin, at.cos, x)
    }

    #[inline(always)]
    fn turn_articulated<R: Real>(at: &Placement<R>, ia: &ArticulatedInertia<R>) -> ArticulatedInertia<R> {
        ia.rotated::<A>(at.sin, at.cos)
    }

    #[inline(always)]
    fn turn_rigid<R: Real>(at: &Placement<R>, i: &RigidInertia<R>) -> RigidInertia<R> {
        turn_rigid_about::<A, R>(at.sin, at.cos, i)
    }

    #[inline(always)]
    fn rotation<R: Real>(at: &Placement<R>) -> Mat3<R> {
        Mat3::rotation::<A>(at.sin, at.cos)
    }

    #[inline(always)]
    fn column<R: Real>(_: &Link<R>, _: usize, rate: R) -> Motion<R> {
        Motion { ang: Vec3::along(A, rate), lin: Vec3::zero() }
    }

    #[inline(always)]
    fn project<R: Real>(_: &Link<R>, _: usize, f: &Force<R>) -> R {
        f.ang[A]
    }

    #[inline(always)]
    fn inertia_column<R: Real>(_: &Link<R>, _: usize, ia: &ArticulatedInertia<R>) -> Force<R> {
        Force { ang: ia.rotational.col(A), lin: ia.coupling.row(A) }
    }

    #[inline(always)]
    fn velocity_product<R: Real>(v: &Motion<R>, v_joint: &Motion<R>) -> Motion<R> {
        let rate = v_joint.ang[A];
        Motion { ang: v.ang.cross_along::<A>(rate), lin: v.lin.cross_along::<A>(rate) }
    }

    #[inline(always)]
    fn inertia_times_bias<R: Real>(ia: &ArticulatedInertia<R>, c: &Motion<R>) -> Force<R> {
        // c = (ω × e_A q̇, v × e_A q̇) has no component along A
        let (b, d) = ((A + 1) % 3, (A + 2) % 3);
        let (i, h, m) = (&ia.rotational, &ia.coupling.0, &ia.linear);
        let mut f = Force::zero();
        for k in 0..3 {
            f.ang[k] = (i.at(k, b) * c.ang[b] + i.at(k, d) * c.ang[d]) + (h[k][b] * c.lin[b] + h[k][d] * c.lin[d]);
            f.lin[k] = (h[b][k] * c.ang[b] + h[d][k] * c.ang[d]) + (m.at(k, b) * c.lin[b] + m.at(k, d) * c.lin[d]);
        }
        f
    }
}
