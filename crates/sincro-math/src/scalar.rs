//! `f64` as a [`Real`]: one world.

use crate::elementary;
use crate::real::{Real, Task};

impl Real for f64 {
    const LANES: usize = 1;

    #[inline(always)]
    fn run_hot<T: Task>(task: T) -> T::Output {
        crate::lanes::run_scalar(task)
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        f(0)
    }

    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self < bound { then } else { otherwise }
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        f(self).0
    }

    #[inline(always)]
    fn map2(self, other: Self, f: impl Fn(f64, f64) -> (f64, f64, f64)) -> Self {
        f(self, other).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_does_not_hide_that_a_number_is_not_one() {
        assert!(Real::min(f64::NAN, 1.0).is_nan());
        assert!(Real::max(f64::NAN, 1.0).is_nan());
        assert!(f64::NAN.clamp_abs(1.0).is_nan());
    }

    #[test]
    fn smaller_and_larger() {
        assert_eq!((Real::min(1.0, 2.0), Real::min(2.0, 1.0)), (1.0, 1.0));
        assert_eq!((Real::max(1.0, 2.0), Real::max(2.0, 1.0)), (2.0, 2.0));
        assert_eq!((3.0.clamp_abs(2.0), (-3.0).clamp_abs(2.0)), (2.0, -2.0));
    }
}
