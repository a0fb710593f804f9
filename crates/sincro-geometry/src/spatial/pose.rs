//! Poses: position and orientation of one frame in another.

use sincro_math::Real;

use super::{Mat3, Vec3};

/// Pose of a frame B in a frame A, `x_ab`: rotation `r_ab` and position `p_ab` `[m]`. Labels cancel: `x_ab * x_bc =
/// x_ac`.
///
/// ```
/// use sincro_geometry::spatial::{Mat3, Pose, Vec3};
///
/// // a camera 1 m above the table, turned by a half turn about x: it looks down
/// let x_tc = Pose { rot: Mat3::rotation::<0>(0.0, -1.0), pos: Vec3([0.0, 0.0, 1.0]) };
/// let seen = Vec3([0.2, 0.1, 0.6]); // [m], in the camera's frame
/// let on_table = x_tc.point(seen);
/// assert_eq!(on_table, Vec3([0.2, -0.1, 0.4])); // [m], in the table's frame
/// let x_ct = x_tc.inverse();
/// assert_eq!(x_ct.compose(&x_tc), Pose::identity());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose<R> {
    /// Rotation `r_ab`: takes components in B to components in A (dimensionless).
    pub rot: Mat3<R>,
    /// Position `p_ab` of the origin of B, in the axes of A `[m]`.
    pub pos: Vec3<R>,
}

impl<R: Real> Pose<R> {
    /// Pose of a frame that coincides with its reference.
    #[inline(always)]
    pub fn identity() -> Self {
        Self { rot: Mat3::identity(), pos: Vec3::zero() }
    }

    /// Pose of a frame with parallel axes and its origin at `pos` `[m]`.
    pub fn translation(pos: Vec3<R>) -> Self {
        Self { rot: Mat3::identity(), pos }
    }

    /// Product `x_ac = x_ab * x_bc` of two poses, `self` being `x_ab`, lengths in `[m]`.
    #[inline(always)]
    pub fn compose(&self, b: &Self) -> Self {
        Self { rot: self.rot.mul(&b.rot), pos: self.pos + self.rot.mul_vec(b.pos) }
    }

    /// Inverse pose: `x_ba` of `x_ab`, lengths in `[m]`.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        Self { rot: self.rot.transpose(), pos: -self.rot.tr_mul_vec(self.pos) }
    }

    /// Coordinates in A of a point `p` that is given in B, both `[m]`.
    #[inline(always)]
    pub fn point(&self, p: Vec3<R>) -> Vec3<R> {
        self.pos + self.rot.mul_vec(p)
    }
}
