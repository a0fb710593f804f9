//! Three-vectors.

use core::ops::{Add, AddAssign, Index, IndexMut, Neg, Sub, SubAssign};

use sincro_math::Real;

/// Vector of three components (x, y, z) along the axes of some frame, in one unit.
///
/// ```
/// use sincro_geometry::spatial::Vec3;
///
/// let (r, f) = (Vec3([0.0, 0.5, 0.0]), Vec3([0.0, 0.0, 2.0])); // lever arm [m], force [N]
/// let torque = r.cross(f);
/// assert_eq!(torque, Vec3([1.0, 0.0, 0.0])); // [N·m]
/// assert!(torque.dot(r) == 0.0 && torque.dot(f) == 0.0);
/// assert_eq!(torque.norm(), r.norm() * f.norm());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3<R>(pub [R; 3]);

impl<R: Real> Vec3<R> {
    /// Vector (x, y, z), the components in one unit.
    #[inline(always)]
    pub fn new(x: R, y: R, z: R) -> Self {
        Self([x, y, z])
    }

    /// Coefficient c of the third term in the rate of the rotation vector φ (`self`, `[rad]`) of a body with the
    /// angular velocity ω `[rad/s]` in its own axes: φ' = ω + φ×ω/2 + c φ×(φ×ω); also in the gradient of a function of
    /// φ.
    ///
    /// c = (1 − (θ/2) cot(θ/2))/θ² `[1/rad²]`, θ = |φ|. Source: key `iserles2000`, section 2.5.
    #[inline(always)]
    pub fn rotation_rate_coefficient(self) -> R {
        let square = self.dot(self);
        // series below θ = 0.1, where its next term is 1e-16 of the first
        let near = R::splat(1e-2);
        let series = R::splat(1.0 / 12.0)
            + square
                * (R::splat(1.0 / 720.0) + square * (R::splat(1.0 / 30240.0) + square * R::splat(1.0 / 1_209_600.0)));
        let safe = near.if_less(square, square, R::one());
        let half = R::splat(0.5) * safe.sqrt();
        let (sin, cos) = half.sin_cos();
        let closed = (R::one() - half * cos / sin) / safe;
        near.if_less(square, closed, series)
    }

    /// Rate of the rotation vector φ (`self`, `[rad]`) of a body with the angular velocity `omega` `[rad/s]` in its own
    /// axes; see [`Vec3::rotation_rate_coefficient`].
    #[inline(always)]
    pub fn rotation_rate(self, omega: Self) -> Self {
        let once = self.cross(omega);
        let twice = self.cross(once);
        omega + once.scale(R::splat(0.5)) + twice.scale(self.rotation_rate_coefficient())
    }

    /// Vector of zeros, of any unit.
    #[inline(always)]
    pub fn zero() -> Self {
        Self([R::zero(); 3])
    }

    /// Vector of the given `length` (any unit) along coordinate axis `axis` (0, 1 or 2). Panics for other indices.
    #[inline(always)]
    pub fn along(axis: usize, length: R) -> Self {
        let mut v = Self::zero();
        v[axis] = length;
        v
    }

    /// Vector of the constants `v` (x, y, z) in numbers of type `R`; the units stay.
    #[inline(always)]
    pub fn splat(v: [f64; 3]) -> Self {
        let [x, y, z] = v;
        Self([R::splat(x), R::splat(y), R::splat(z)])
    }

    /// Dot product with `b`; the units multiply.
    #[inline(always)]
    pub fn dot(self, b: Self) -> R {
        self[0] * b[0] + self[1] * b[1] + self[2] * b[2]
    }

    /// Cross product `self × b`; the units multiply.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        let a = self;
        Self([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }

    /// Cross product `self × (r e_K)` with a vector of length `r` along coordinate axis `K` (0, 1, 2); the units
    /// multiply.
    #[inline(always)]
    pub fn cross_along<const K: usize>(self, r: R) -> Self {
        let (b, c) = ((K + 1) % 3, (K + 2) % 3);
        let mut out = Self::zero();
        out[b] = self[c] * r;
        out[c] = -(self[b] * r);
        out
    }

    /// Product with the scalar `k`; the units multiply.
    #[inline(always)]
    pub fn scale(self, k: R) -> Self {
        Self([self[0] * k, self[1] * k, self[2] * k])
    }

    /// Euclidean length, in the unit of the components.
    #[inline(always)]
    pub fn norm(self) -> R {
        self.dot(self).sqrt()
    }
}

impl<R> Index<usize> for Vec3<R> {
    type Output = R;
    #[inline(always)]
    fn index(&self, k: usize) -> &R {
        &self.0[k]
    }
}

impl<R> IndexMut<usize> for Vec3<R> {
    #[inline(always)]
    fn index_mut(&mut self, k: usize) -> &mut R {
        &mut self.0[k]
    }
}

impl<R: Real> Add for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self([self[0] + b[0], self[1] + b[1], self[2] + b[2]])
    }
}

impl<R: Real> Sub for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self([self[0] - b[0], self[1] - b[1], self[2] - b[2]])
    }
}

impl<R: Real> Neg for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self([-self[0], -self[1], -self[2]])
    }
}

impl<R: Real> AddAssign for Vec3<R> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<R: Real> SubAssign for Vec3<R> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
