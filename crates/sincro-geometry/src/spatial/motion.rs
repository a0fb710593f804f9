//! Six-vectors: motions (twists, accelerations) and forces (wrenches), angular part first.

use core::ops::{Add, AddAssign, Neg, Sub, SubAssign};

use sincro_math::Real;

use super::Vec3;

/// A twist or spatial acceleration: angular [rad/s], linear velocity of the frame's origin [m/s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<R> {
    /// Angular part.
    pub ang: Vec3<R>,
    /// Linear part, of the point at the frame's origin.
    pub lin: Vec3<R>,
}

/// A wrench or spatial momentum: moment about the frame's origin [N·m], force `[N]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Force<R> {
    /// Moment about the origin.
    pub ang: Vec3<R>,
    /// Force.
    pub lin: Vec3<R>,
}

impl<R: Real> Motion<R> {
    /// No motion.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { ang: Vec3::zero(), lin: Vec3::zero() }
    }

    /// Power of a force along this motion: `self · f` `[W]`.
    #[inline(always)]
    pub fn dot(&self, f: &Force<R>) -> R {
        self.ang.dot(f.ang) + self.lin.dot(f.lin)
    }

    /// Rate `self × m` of a motion `m` (its unit per second) that is fixed in a frame moving with `self` `[rad/s]`,
    /// `[m/s]`.
    #[inline(always)]
    pub fn cross(&self, m: &Self) -> Self {
        Self { ang: self.ang.cross(m.ang), lin: self.ang.cross(m.lin) + self.lin.cross(m.ang) }
    }

    /// Rate `self ×* f` `[N·m/s]`, `[N/s]` of a force `f` that is fixed in a frame moving with `self` `[rad/s]`,
    /// `[m/s]`.
    #[inline(always)]
    pub fn cross_force(&self, f: &Force<R>) -> Force<R> {
        Force { ang: self.ang.cross(f.ang) + self.lin.cross(f.lin), lin: self.ang.cross(f.lin) }
    }
}

impl<R: Real> Force<R> {
    /// No force.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { ang: Vec3::zero(), lin: Vec3::zero() }
    }

    /// Product with a scalar; the units multiply.
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
