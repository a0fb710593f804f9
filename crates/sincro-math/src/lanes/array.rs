//! `N` worlds side by side in a plain array: lanes for processors without a vector type of ours.
//!
//! Every operation is the scalar one, lane by lane, and Rust never contracts `a*b + c`: lane `k` has the bits of the
//! same computation on `f64`.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::Real;
use crate::elementary::{self, Bits};

/// Bundle of `N` numbers, one per simulated world, with arithmetic lane by lane: the portable [`Real`] for a batch.
/// Each lane has the bits of the same computation on `f64`.
///
/// ```
/// use sincro_math::{Lanes, Real};
///
/// let speed = Lanes([1.0, 2.0, 3.0, 4.0]); // four worlds [m/s]
/// assert_eq!((speed * speed * Lanes::splat(0.5)).lane(3), 8.0); // kinetic energy of 1 kg [J]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Default for Lanes<N> {
    #[inline(always)]
    fn default() -> Self {
        Self([0.0; N])
    }
}

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = [0.0; N];
        for k in 0..N {
            out[k] = f(self.0[k], other.0[k]);
        }
        Self(out)
    }
}

impl<const N: usize> Add for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<const N: usize> Mul for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl<const N: usize> Div for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|a| -a))
    }
}

impl<const N: usize> AddAssign for Lanes<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Lanes<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> MulAssign for Lanes<N> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const N: usize> Real for Lanes<N> {
    const LANES: usize = N;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; N])
    }

    #[inline(always)]
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self {
        Self(core::array::from_fn(f))
    }

    #[inline(always)]
    fn lane(self, k: usize) -> f64 {
        self.0[k]
    }

    #[inline(always)]
    fn with_lane(mut self, k: usize, x: f64) -> Self {
        self.0[k] = x;
        self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos_lanes(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }

    #[inline(always)]
    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let mut out = [0.0; N];
        for k in 0..N {
            out[k] = if self.0[k] < bound.0[k] { then.0[k] } else { otherwise.0[k] };
        }
        Self(out)
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        Self(self.0.map(|x| f(x).0))
    }

    #[inline(always)]
    fn map2(self, other: Self, f: impl Fn(f64, f64) -> (f64, f64, f64)) -> Self {
        self.zip(other, |x, y| f(x, y).0)
    }
}

impl<const N: usize> Bits for Lanes<N> {
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.zip(sign, f64::copysign)
    }

    #[inline(always)]
    fn if_odd(n: Self, odd: Self, even: Self) -> Self {
        Self(core::array::from_fn(|k| f64::if_odd(n.0[k], odd.0[k], even.0[k])))
    }

    #[inline(always)]
    fn flip_by<const BIT: u32>(self, n: Self) -> Self {
        self.zip(n, |x, n| x.flip_by::<BIT>(n))
    }

    #[inline(always)]
    fn all_below(self, limit: f64) -> bool {
        self.0.iter().all(|x| x.all_below(limit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lane_has_the_bits_of_the_scalar_computation() {
        let x: [f64; 8] = core::array::from_fn(|k| 1.7 * k as f64 - 5.3);
        let lanes = Lanes(x);
        let (s, c) = (lanes * lanes / Lanes::splat(3.0)).sin_cos();
        let out = (s - c).abs().sqrt();
        for k in 0..8 {
            let (s, c) = Real::sin_cos(x[k] * x[k] / 3.0);
            assert_eq!(out.0[k].to_bits(), (s - c).abs().sqrt().to_bits());
        }
    }

    #[test]
    fn comparisons_select_lane_by_lane() {
        let x = Lanes([-1.0, 2.0]);
        assert_eq!(x.max(Lanes::zero()), Lanes([0.0, 2.0]));
        assert_eq!(x.clamp_abs(Lanes::splat(0.5)), Lanes([-0.5, 0.5]));
    }
}
