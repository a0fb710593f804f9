//! Six-vectors: motions (twists, accelerations) and forces (wrenches), angular part first.

use core::ops::{Add, AddAssign, Neg, Sub, SubAssign};

use sincro_math::Real;

use super::Vec3;

/// Spatial motion vector (twist or spatial acceleration) in the axes and about the origin of some frame, angular part
/// first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<R> {
    /// Angular velocity `[rad/s]`, or angular acceleration `[rad/s²]`.
    pub ang: Vec3<R>,
    /// Linear velocity of the body's point at the frame's origin `[m/s]`, or the linear part of the spatial
    /// acceleration `[m/s²]`.
    pub lin: Vec3<R>,
}

/// Spatial force vector (wrench or momentum) in the axes and about the origin of some frame, angular part first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Force<R> {
    /// Moment about the frame's origin `[N·m]`, or angular momentum `[kg·m²/s]`.
    pub ang: Vec3<R>,
    /// Force `[N]`, or linear momentum `[kg·m/s]`.
    pub lin: Vec3<R>,
}

impl<R: Real> Motion<R> {
    /// Motion vector with both parts zero, such as the twist of a body at rest.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { ang: Vec3::zero(), lin: Vec3::zero() }
    }

    /// Scalar product with a force in the same frame: of a twist and a wrench the power `[W]`, of a twist and its
    /// momentum twice the kinetic energy `[J]`.
    #[inline(always)]
    pub fn dot(&self, f: &Force<R>) -> R {
        self.ang.dot(f.ang) + self.lin.dot(f.lin)
    }

    /// Spatial cross product `self × m`: rate of change (unit of `m` per second) of a motion vector `m` that is fixed
    /// in a body moving with the twist `self`, all in one frame.
    #[inline(always)]
    pub fn cross(&self, m: &Self) -> Self {
        Self { ang: self.ang.cross(m.ang), lin: self.ang.cross(m.lin) + self.lin.cross(m.ang) }
    }

    /// Spatial cross product `self ×* f`: rate of change (unit of `f` per second) of a force vector `f` that is fixed
    /// in a body moving with the twist `self`, all in one frame.
    #[inline(always)]
    pub fn cross_force(&self, f: &Force<R>) -> Force<R> {
        Force { ang: self.ang.cross(f.ang) + self.lin.cross(f.lin), lin: self.ang.cross(f.lin) }
    }
}

impl<R: Real> Force<R> {
    /// Force vector with both parts zero.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { ang: Vec3::zero(), lin: Vec3::zero() }
    }

    /// Product of both parts with the scalar `k`; the units multiply.
    #[inline(always)]
    pub fn scale(&self, k: R) -> Self {
        Self { ang: self.ang.scale(k), lin: self.lin.scale(k) }
    }
}

impl<R: Real> Add for Motion<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { ang: self.ang + b.ang, lin: self.lin + b.lin }
    }
}

impl<R: Real> AddAssign for Motion<R> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<R: Real> Add for Force<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { ang: self.ang + b.ang, lin: self.lin + b.lin }
    }
}

impl<R: Real> Sub for Force<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { ang: self.ang - b.ang, lin: self.lin - b.lin }
    }
}

impl<R: Real> Neg for Force<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { ang: -self.ang, lin: -self.lin }
    }
}

impl<R: Real> AddAssign for Force<R> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<R: Real> SubAssign for Force<R> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
