//! Uniform gravity. Its force enters the recursions as an acceleration of the base; its energy is here.

use sincro_math::Real;

use crate::spatial::{Pose, RigidInertia, Vec3};

/// Potential energy −m g·c `[J]` of a link whose frame stands at `pose` in the world; zero at the world's origin.
#[inline(always)]
pub fn energy<R: Real>(gravity: Vec3<R>, inertia: &RigidInertia<R>, pose: &Pose<R>) -> R {
    let first_moment = pose.rot.mul_vec(inertia.moment) + pose.pos.scale(inertia.mass);
    -gravity.dot(first_moment)
}
