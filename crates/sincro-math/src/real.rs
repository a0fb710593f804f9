//! The one trait that the dynamics is written over.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::functions::{self, Binary, Unary};

/// Real number that the dynamics is written over: `f64`, a bundle of lanes ([`Lanes`](crate::Lanes)), or a dual number
/// ([`Dual`](crate::Dual)).
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

    /// True for numbers of one lane. What differs from lane to lane (constraints, limits) runs for these only; behind
    /// `if R::IS_SCALAR` it is not even compiled for the others.
    const IS_SCALAR: bool = Self::LANES == 1;

    /// Constant `x`, the same in every lane and without derivatives; the unit stays.
    fn splat(x: f64) -> Self;

    /// Number composed lane by lane: `f(k)` gives the value of lane `k`, 0 to `LANES` − 1; without derivatives.
    fn from_lanes(f: impl FnMut(usize) -> f64) -> Self;

    /// Value in lane `k`, 0 to `LANES` − 1, without derivatives; the unit stays. Numbers of one lane ignore `k`;
    /// bundles panic for a `k` beyond the last lane.
    fn lane(self, k: usize) -> f64;

    /// The same number with the value `x` in lane `k`, 0 to `LANES` − 1, without derivatives; bundles may panic for a
    /// `k` beyond the last lane.
    #[inline(always)]
    fn with_lane(self, k: usize, x: f64) -> Self {
        Self::from_lanes(|l| if l == k || Self::IS_SCALAR { x } else { self.lane(l) })
    }

    /// Bundle of the first [`LANES`](Self::LANES) numbers of `row`; panics if there are fewer.
    #[inline(always)]
    fn from_row(row: &[f64]) -> Self {
        Self::from_lanes(|k| row[k])
    }

    /// Writes all lanes to the first numbers of `row`; panics if there are fewer.
    #[inline(always)]
    fn to_row(self, row: &mut [f64]) {
        for (k, x) in row[..Self::LANES].iter_mut().enumerate() {
            *x = self.lane(k);
        }
    }

    /// Square root, in the root of the unit; NaN below zero. On dual numbers the derivative is infinite at zero.
    fn sqrt(self) -> Self;

    /// Sine and cosine (dimensionless, in this order) of an angle `[rad]`; absolute error below 1.8e-16, NaN where the
    /// angle is not finite.
    fn sin_cos(self) -> (Self, Self);

    /// Absolute value, in the same unit; its derivative at zero is that from above.
    fn abs(self) -> Self;

    /// Selection lane by lane: `then` where `self < bound`, else `otherwise`; a NaN compares as not less. The
    /// derivatives are those of the selected number.
    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self;

    /// Value of a differentiable scalar function at this number, lane by lane: `f(x)` returns the value and the
    /// derivative at `x`, as the functions of [`elementary`](crate::elementary) do.
    ///
    /// For functions that are not worth a vector form; lanes call it one after the other.
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self;

    /// Value of a differentiable scalar function of `self` and `other`, lane by lane: `f(x, y)` returns the value and
    /// the derivatives by `x` and by `y`, in this order.
    fn map2(self, other: Self, f: impl Fn(f64, f64) -> (f64, f64, f64)) -> Self;

    /// Value of an elementary function at this number, lane by lane, with its derivative: [`Real::map`] of a function
    /// that a recording knows by name.
    #[inline]
    fn unary(self, f: Unary) -> Self {
        match f {
            Unary::Tan => self.map(functions::tan),
            Unary::Asin => self.map(functions::asin),
            Unary::Acos => self.map(functions::acos),
            Unary::Atan => self.map(functions::atan),
            Unary::Exp => self.map(functions::exp),
            Unary::Ln => self.map(functions::ln),
            Unary::Log10 => self.map(functions::log10),
            Unary::Sinh => self.map(functions::sinh),
            Unary::Cosh => self.map(functions::cosh),
            Unary::Tanh => self.map(functions::tanh),
            Unary::Floor => self.map(functions::floor),
            Unary::Ceil => self.map(functions::ceil),
        }
    }

    /// Value of an elementary function of `self` and `other`, lane by lane, with its derivatives: [`Real::map2`] of a
    /// function that a recording knows by name.
    #[inline]
    fn binary(self, f: Binary, other: Self) -> Self {
        match f {
            Binary::Atan2 => self.map2(other, functions::atan2),
            Binary::Hypot => self.map2(other, functions::hypot),
            Binary::Pow => self.map2(other, functions::pow),
            Binary::Modulo => self.map2(other, functions::modulo),
        }
    }

    /// Runs `task` compiled for the best registers of this processor, and returns its result: lanes with their own
    /// instruction set, scalars with the thirty-two registers of AVX-512 where there are. One compiled copy of a task
    /// exists for each kind of number.
    #[inline(always)]
    fn run_hot<T: Task>(task: T) -> T::Output {
        task.run()
    }

    /// Runs a `task` of lanes as [`Real::run_hot`] does, with their instruction set; other numbers run it inline.
    #[inline(always)]
    fn run_lanes<T: Task>(task: T) -> T::Output {
        if Self::LANES > 1 { Self::run_hot(task) } else { task.run() }
    }

    /// Runs a part of a task, such as one kind of joint in a pass over the links, and returns its result: inlined into
    /// the task, but for numbers whose operations are so many instructions that the task would become one function too
    /// large to be compiled fast.
    #[inline(always)]
    fn run_part<T: Task>(part: T) -> T::Output {
        part.run()
    }

    /// Number 0 in every lane, of any unit, without derivatives.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    /// Number 1 in every lane, dimensionless, without derivatives.
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }

    /// Smaller of two numbers of one unit, lane by lane. A NaN in `self` stays, a NaN in `other` is ignored.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        other.if_less(self, other, self)
    }

    /// Larger of two numbers of one unit, lane by lane. A NaN in `self` stays, a NaN in `other` is ignored.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.if_less(other, other, self)
    }

    /// Number limited to `[-limit, limit]`, lane by lane; `limit >= 0`, in the same unit. A NaN in `self` stays.
    #[inline(always)]
    fn clamp_abs(self, limit: Self) -> Self {
        self.min(limit).max(-limit)
    }

    /// Returns true if the value of every lane is finite; derivatives are not examined.
    #[inline(always)]
    fn is_finite(self) -> bool {
        (0..Self::LANES).all(|k| self.lane(k).is_finite())
    }
}

/// Computation to be run by [`Real::run_hot`], such as a pass over the links of a model, or by [`Real::run_part`]. Its
/// `run` must be `#[inline(always)]`, and so must everything that it calls. What is not inlined has the baseline
/// instruction set, such as a closure of some size: each operation on lanes is a call there.
pub trait Task {
    /// Result of the computation.
    type Output;

    /// Runs the computation and returns its result.
    fn run(self) -> Self::Output;
}

/// Scalar product of two lists, summed in their order; entries of the longer one that have no partner do not count. Its
/// unit is the product of theirs.
///
/// ```
/// assert_eq!(sincro_math::dot(&[1.0, 2.0], &[3.0, 4.0]), 11.0);
/// ```
#[inline(always)]
pub fn dot<R: Real>(a: &[R], b: &[R]) -> R {
    let mut sum = R::zero();
    for (a, b) in a.iter().zip(b) {
        sum += *a * *b;
    }
    sum
}
