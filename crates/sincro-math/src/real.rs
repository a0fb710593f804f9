//! The one trait that the dynamics is written over.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number: `f64`, a bundle of lanes, or a dual number.
///
/// A comparison never yields a `bool`, because lanes can differ: it selects ([`Real::if_less`]). Whoever must branch
/// looks at one lane at a time ([`Real::lane`]).
///
/// ```
/// use sincro_math::{Dual, Real};
///
/// /// Kinetic energy m v²/2 `[J]`, written once for all kinds of numbers.
/// fn kinetic_energy<R: Real>(mass: f64, v: R) -> R {
///     R::splat(0.5 * mass) * v * v
/// }
///
/// assert_eq!(kinetic_energy(2.0, 3.0), 9.0);
/// let v = Dual::<1>::variable(3.0, 0);
/// assert_eq!(kinetic_energy(2.0, v).partials, [2.0 * 3.0]); // by v: the momentum [kg·m/s]
/// ```
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// Number of lanes: 1 for `f64` and dual numbers.
    const LANES: usize;

    /// Constant `x`, in its unit, in every lane and without derivatives.
    fn splat(x: f64) -> Self;

    /// Number made lane by lane (`f` is given the index of the lane), without derivatives; the units are the caller's.
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self;

    /// Value in lane `k < LANES`, in its unit, derivatives dropped.
    fn lane(self, k: usize) -> f64;

    /// Square root; NaN below zero.
    fn sqrt(self) -> Self;

    /// Sine and cosine of an angle `[rad]`, absolute error below 1.8e-16, one polynomial for every kind of number.
    fn sin_cos(self) -> (Self, Self);

    /// Absolute value, in the same unit; its derivative at zero is that from above.
    fn abs(self) -> Self;

    /// `then` where `self < bound`, else `otherwise`, lane by lane. A NaN compares as not less.
    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self;

    /// The lane values mapped through a differentiable scalar function: `f(x)` returns the value and the derivative.
    ///
    /// For the functions that are not worth a vector form; lanes call it one after the other.
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self;

    /// Two numbers mapped through a differentiable scalar function, lane by lane: `f(x, y)` returns the value and the
    /// derivatives by `x` and by `y`.
    fn map2(self, other: Self, f: impl Fn(f64, f64) -> (f64, f64, f64)) -> Self;

    /// Runs a hot computation compiled for the best registers of this processor: lanes for their own instruction set,
    /// scalars for the thirty-two registers of AVX-512. There is one compiled copy of a task for each kind of number,
    /// whoever calls it.
    #[inline(always)]
    fn run_hot<T: Task>(task: T) -> T::Output {
        task.run()
    }

    /// The number 0, of any unit, without derivatives.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    /// The number 1, dimensionless, without derivatives.
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }

    /// The smaller of two. A NaN in `self` stays (a NaN in `other` is passed over): a limit hides no failure.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        other.if_less(self, other, self)
    }

    /// The larger of two. A NaN in `self` stays, as in [`Real::min`].
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.if_less(other, other, self)
    }

    /// `self` limited to `[-limit, limit]`; `limit >= 0`. A NaN in `self` stays.
    #[inline(always)]
    fn clamp_abs(self, limit: Self) -> Self {
        self.min(limit).max(-limit)
    }

    /// Returns true if every lane is finite.
    #[inline(always)]
    fn is_finite(self) -> bool {
        (0..Self::LANES).all(|k| self.lane(k).is_finite())
    }
}

/// A computation handed to [`Real::run_hot`]. `run` must be `#[inline(always)]`, and so must be what it calls.
pub trait Task {
    /// Result type.
    type Output;

    /// Runs the computation.
    fn run(self) -> Self::Output;
}
