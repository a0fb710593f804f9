//! Poses: position and orientation of one frame in another.

use sincro_math::Real;

use super::{Mat3, Vec3};

/// Pose of a frame B in a frame A, `x_ab`: rotation `r_ab` and position `p_ab` `[m]`. Labels cancel: `x_ab * x_bc =
/// x_ac`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose<R> {
    /// Takes components in B to components in A.
    pub rot: Mat3<R>,
    /// Origin of B in A.
    pub pos: Vec3<R>,
}

impl<R: Real> Pose<R> {
    /// Both frames coincide.
    #[inline(always)]
    pub fn identity() -> Self {
        Self { rot: Mat3::identity(), pos: Vec3::zero() }
    }

    /// Parallel axes, origin at `pos`.
    pub fn translation(pos: Vec3<R>) -> Self {
        Self { rot: Mat3::identity(), pos }
    }

    /// `x_ab * x_bc`.
    #[inline(always)]
    pub fn compose(&self, b: &Self) -> Self {
        Self { rot: self.rot.mul(&b.rot), pos: self.pos + self.rot.mul_vec(b.pos) }
    }

    /// `x_ba` of `x_ab`.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        Self { rot: self.rot.transpose(), pos: -self.rot.tr_mul_vec(self.pos) }
    }

    /// A point given in B, in A.
    #[inline(always)]
    pub fn point(&self, p: Vec3<R>) -> Vec3<R> {
        self.pos + self.rot.mul_vec(p)
    }
}
