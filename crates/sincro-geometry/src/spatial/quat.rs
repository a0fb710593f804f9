//! Unit quaternions, scalar first (w, x, y, z); `q` and `−q` are the same rotation.

use sincro_math::{Real, elementary};

use super::{Mat3, Vec3};

/// Unit quaternion of the rotation of a frame B in a frame A: takes components in B to components in A. As four numbers
/// in the order w, x, y, z.
///
/// ```
/// use sincro_geometry::spatial::{Quat, Vec3};
/// use std::f64::consts::FRAC_PI_2;
///
/// // two quarters of a turn about z make a half turn
/// let quarter = Quat::exp(Vec3([0.0, 0.0, FRAC_PI_2]));
/// let half = quarter.mul(&quarter);
/// assert!((half.log()[2].abs() - 2.0 * FRAC_PI_2).abs() < 1e-15);
/// let turned = half.matrix().mul_vec(Vec3([1.0, 0.0, 0.0]));
/// assert!((turned - Vec3([-1.0, 0.0, 0.0])).norm() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quat<R> {
    /// Scalar part: cosine of half the angle (dimensionless).
    pub w: R,
    /// Vector part: axis times sine of half the angle (dimensionless).
    pub xyz: Vec3<R>,
}

impl<R: Real> Quat<R> {
    /// Quaternion of no rotation (dimensionless): w = 1.
    pub fn identity() -> Self {
        Self { w: R::one(), xyz: Vec3::zero() }
    }

    /// Reads a quaternion from the first four numbers of `q`, in the order w, x, y, z (dimensionless).
    ///
    /// # Panics
    ///
    /// If `q` has fewer than four numbers.
    #[inline(always)]
    pub fn from_slice(q: &[R]) -> Self {
        Self { w: q[0], xyz: Vec3([q[1], q[2], q[3]]) }
    }

    /// Writes w, x, y, z (dimensionless) to the first four places of `q`.
    ///
    /// # Panics
    ///
    /// If `q` has fewer than four places.
    #[inline(always)]
    pub fn write(&self, q: &mut [R]) {
        q[0] = self.w;
        q[1..4].copy_from_slice(&self.xyz.0);
    }

    /// Rotation by the rotation vector `phi` `[rad]`: about its direction by its length (exponential map).
    #[inline(always)]
    pub fn exp(phi: Vec3<R>) -> Self {
        let half = phi.scale(R::splat(0.5));
        let square = half.dot(half);
        // sin(a)/a and cos(a) of a = |phi|/2: series below 1e-2, where neither loses a digit
        let small = R::splat(1e-4);
        let a = small.if_less(square, square, R::one()).sqrt();
        let (sin, cos) = a.sin_cos();
        let sinc_series = R::one()
            - square
                * R::splat(1.0 / 6.0)
                * (R::one() - square * R::splat(0.05) * (R::one() - square * R::splat(1.0 / 42.0)));
        let cos_series = R::one()
            - square
                * R::splat(0.5)
                * (R::one() - square * R::splat(1.0 / 12.0) * (R::one() - square * R::splat(1.0 / 30.0)));
        let sinc = small.if_less(square, sin / a, sinc_series);
        let w = small.if_less(square, cos, cos_series);
        Self { w, xyz: half.scale(sinc) }
    }

    /// Rotation vector `[rad]` of a unit quaternion, axis times angle, the angle at most π: the inverse of
    /// [`Quat::exp`].
    #[inline(always)]
    pub fn log(&self) -> Vec3<R> {
        let zero = R::zero();
        let sign = self.w.if_less(zero, -R::one(), R::one());
        let (w, square) = (self.w * sign, self.xyz.dot(self.xyz));
        // angle/sin(angle/2): series of the arcsine below sin² = 1e-3, where its next term is 2e-17
        let small = R::splat(1e-3);
        let series = R::splat(2.0)
            + square
                * (R::splat(1.0 / 3.0)
                    + square
                        * (R::splat(3.0 / 20.0) + square * (R::splat(5.0 / 56.0) + square * R::splat(35.0 / 576.0))));
        let sin = small.if_less(square, square, R::one()).sqrt();
        let closed = R::splat(2.0) * sin.binary(elementary::Binary::Atan2, w) / sin;
        self.xyz.scale(sign * small.if_less(square, closed, series))
    }

    /// Hamilton product: `q_ab.mul(&q_bc)` is `q_ac`, the rotation `b` followed by `self` (about fixed axes).
    #[inline(always)]
    pub fn mul(&self, b: &Self) -> Self {
        Self {
            w: self.w * b.w - self.xyz.dot(b.xyz),
            xyz: b.xyz.scale(self.w) + self.xyz.scale(b.w) + self.xyz.cross(b.xyz),
        }
    }

    /// Inverse of a unit quaternion: `q_ba` of `q_ab`.
    #[inline(always)]
    pub fn conjugate(&self) -> Self {
        Self { w: self.w, xyz: -self.xyz }
    }

    /// Quaternion scaled to unit length; NaN of zero.
    #[inline(always)]
    pub fn normalized(&self) -> Self {
        let k = R::one() / (self.w * self.w + self.xyz.dot(self.xyz)).sqrt();
        Self { w: self.w * k, xyz: self.xyz.scale(k) }
    }

    /// Rotation matrix `r_ab` of a unit quaternion `q_ab` (dimensionless).
    #[inline(always)]
    pub fn matrix(&self) -> Mat3<R> {
        let (w, [x, y, z]) = (self.w, self.xyz.0);
        let two = R::splat(2.0);
        let (x2, y2, z2) = (x * two, y * two, z * two);
        let one = R::one();
        Mat3([
            [one - (y * y2 + z * z2), x * y2 - w * z2, x * z2 + w * y2],
            [x * y2 + w * z2, one - (x * x2 + z * z2), y * z2 - w * x2],
            [x * z2 - w * y2, y * z2 + w * x2, one - (x * x2 + y * y2)],
        ])
    }
}

impl<R: Real> Quat<R> {
    /// Unit quaternion of the rotation matrix `m` (dimensionless), with w ≥ 0; exact to rounding for any rotation
    /// (Shepperd's choice of pivot, by selection, so that lanes can differ in theirs).
    #[inline(always)]
    pub fn from_matrix(m: &Mat3<R>) -> Self {
        let m = &m.0;
        let trace = m[0][0] + m[1][1] + m[2][2];
        let mut q = [R::one() + trace, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
        let mut pivot = trace;
        for k in 1..4 {
            let (i, j, l) = (k - 1, k % 3, (k + 1) % 3);
            let mut other = [m[l][j] - m[j][l]; 4];
            other[1 + i] = R::one() + m[i][i] - m[j][j] - m[l][l];
            other[1 + j] = m[i][j] + m[j][i];
            other[1 + l] = m[i][l] + m[l][i];
            for (q, other) in q.iter_mut().zip(other) {
                *q = pivot.if_less(m[i][i], other, *q);
            }
            pivot = pivot.if_less(m[i][i], m[i][i], pivot);
        }
        let q = Self::from_slice(&q).normalized();
        let of_sign = |x: R| q.w.if_less(R::zero(), -x, x);
        let [x, y, z] = q.xyz.0;
        Self { w: of_sign(q.w), xyz: Vec3([of_sign(x), of_sign(y), of_sign(z)]) }
    }
}

/// Rotation vector `[rad]` that turns `from` into `to`, both rotations from one frame, of at most half a turn.
#[must_use]
pub fn rotation_between(from: &Mat3<f64>, to: &Mat3<f64>) -> Vec3<f64> {
    let q = Quat::from_matrix(&to.mul(&from.transpose()));
    let (norm, sign) = (q.xyz.norm(), if q.w < 0.0 { -1.0 } else { 1.0 });
    let angle = sign * 2.0 * elementary::atan2(norm, q.w.abs()).0;
    if norm == 0.0 { Vec3::zero() } else { q.xyz.scale(angle / norm) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_is_the_axis_angle_rotation() {
        for angle in [0.0, 1e-9, 1e-3, 0.019, 0.021, 1.0, 3.0] {
            let m = Quat::exp(Vec3([0.0, angle, 0.0])).matrix();
            let (s, c) = Real::sin_cos(angle);
            let expected = Mat3::rotation::<1>(s, c);
            for i in 0..3 {
                for j in 0..3 {
                    assert!((m.0[i][j] - expected.0[i][j]).abs() < 1e-15, "{angle}");
                }
            }
        }
    }

    #[test]
    fn matrix_and_back_is_the_same_rotation() {
        for k in 0..200 {
            let t = f64::from(k);
            let q = Quat::exp(Vec3([3.0 * libm::sin(t * 0.7), 2.0 * libm::cos(t * 1.3), libm::sin(t * 2.1)]));
            let back = Quat::from_matrix(&q.matrix());
            let dot = q.w * back.w + q.xyz.dot(back.xyz);
            assert!((dot.abs() - 1.0).abs() < 1e-14, "{k}");
        }
    }
}
