//! A value and its exact partial derivatives, carried through every operation: forward-mode differentiation.
//!
//! Used to linearise: a computation written over [`Real`] and run on `Dual<N>` returns, beside its value, the
//! derivatives by `N` chosen inputs, to rounding. The value has the bits of the same computation on `f64`.
//!
//! Notation: `x = value + Σ partials[i]·εᵢ` with `εᵢ εⱼ = 0`, so `f(x) = f(value) + f′(value) Σ partials[i]·εᵢ`.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::real::Task;
use crate::{Real, elementary};

/// Dual number: a value and its `N` partial derivatives, carried through every operation (forward-mode
/// differentiation).
///
/// Where a function has a kink (`abs`, `min`, a comparison), the derivative is that of the side the value is on, as
/// the comparison decides it.
///
/// ```
/// use sincro_math::{Dual, Real};
///
/// let (x, y) = (Dual::<2>::variable(3.0, 0), Dual::<2>::variable(4.0, 1));
/// let area = x * x * y;
/// assert_eq!(area.value, 36.0);
/// assert_eq!(area.partials, [24.0, 9.0]); // 2xy, x²
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// Value, in any unit.
    pub value: f64,
    /// Partial derivatives by the `N` chosen inputs, in their order; the unit of the value over that of the input.
    pub partials: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// Number of the given value, in any unit, that depends on none of the inputs: all partial derivatives are zero.
    #[inline(always)]
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self { value, partials: [0.0; N] }
    }

    /// Input `index` itself (0 to N − 1), at `value` in its unit: its own partial derivative is 1, the others are 0.
    ///
    /// # Panics
    ///
    /// If `index >= N`.
    #[inline(always)]
    #[must_use]
    pub fn variable(value: f64, index: usize) -> Self {
        let mut out = Self::constant(value);
        out.partials[index] = 1.0;
        out
    }

    /// `f(self)`, given its value and its derivative there.
    #[inline(always)]
    fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, partials: self.partials.map(|p| scaled(p, derivative)) }
    }
}

/// `p·d`, where a partial of zero stays zero though the derivative be infinite: a constant under a root at zero does
/// not spoil the derivatives with respect to the inputs it does not depend on.
#[inline(always)]
fn scaled(p: f64, d: f64) -> f64 {
    if p == 0.0 { 0.0 } else { p * d }
}

impl<const N: usize> Default for Dual<N> {
    #[inline(always)]
    fn default() -> Self {
        Self::constant(0.0)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let partials = core::array::from_fn(|i| self.partials[i] + other.partials[i]);
        Self { value: self.value + other.value, partials }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let partials = core::array::from_fn(|i| self.partials[i] - other.partials[i]);
        Self { value: self.value - other.value, partials }
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl)] // the product rule is a sum
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let partials = core::array::from_fn(|i| self.partials[i] * other.value + self.value * other.partials[i]);
        Self { value: self.value * other.value, partials }
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl)] // the quotient rule subtracts a product
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // (a/b)′ = (a′ − (a/b) b′) / b
        let value = self.value / other.value;
        let partials = core::array::from_fn(|i| (self.partials[i] - value * other.partials[i]) / other.value);
        Self { value, partials }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, partials: self.partials.map(|p| -p) }
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> MulAssign for Dual<N> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const N: usize> Real for Dual<N> {
    const LANES: usize = 1;

    // one compiled copy of a task for all its callers: no step takes derivatives, and code for them is large
    #[inline(never)]
    fn run_hot<T: Task>(task: T) -> T::Output {
        task.run()
    }

    #[inline(never)]
    fn run_part<T: Task>(part: T) -> T::Output {
        part.run()
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self::constant(x)
    }

    #[inline(always)]
    fn from_lanes(mut f: impl FnMut(usize) -> f64) -> Self {
        Self::constant(f(0))
    }

    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self.value
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = elementary::sin_cos(self.value);
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let slope = if self.value < 0.0 { -1.0 } else { 1.0 };
        self.chain(self.value.abs(), slope)
    }

    #[inline(always)]
    fn if_less(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self.value < bound.value { then } else { otherwise }
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> (f64, f64)) -> Self {
        let (value, derivative) = f(self.value);
        self.chain(value, derivative)
    }

    #[inline(always)]
    fn map2(self, other: Self, f: impl Fn(f64, f64) -> (f64, f64, f64)) -> Self {
        let (value, by_self, by_other) = f(self.value, other.value);
        self.chain(value, by_self) + other.chain(0.0, by_other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few roundings: closed form and chain rule round differently.
    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 4.0 * f64::EPSILON * (1.0 + b.abs())
    }

    fn x_and_y() -> (Dual<2>, Dual<2>) {
        (Dual::variable(1.7, 0), Dual::variable(-0.6, 1))
    }

    #[test]
    fn sum_and_difference() {
        let (x, y) = x_and_y();
        assert_eq!((x + x - y).partials, [2.0, -1.0]);
        assert_eq!((-x).partials, [-1.0, 0.0]);
    }

    #[test]
    fn product_rule() {
        let (x, y) = x_and_y();
        let p = x * x * y; // 2xy, x²
        assert!(close(p.partials[0], 2.0 * 1.7 * -0.6) && close(p.partials[1], 1.7 * 1.7));
    }

    #[test]
    fn quotient_rule() {
        let (x, y) = x_and_y();
        let q = x / y; // 1/y, −x/y²
        assert!(close(q.partials[0], -1.0 / 0.6) && close(q.partials[1], -1.7 / 0.36));
    }

    #[test]
    fn chain_rule() {
        let (x, y) = x_and_y();
        let (s, c) = (x * y).sin_cos(); // y cos xy, x cos xy; −y sin xy, −x sin xy
        assert!(close(s.partials[0], -0.6 * c.value) && close(s.partials[1], 1.7 * c.value));
        assert!(close(c.partials[0], 0.6 * s.value) && close(c.partials[1], -1.7 * s.value));
        let r = (x * x + y * y).sqrt(); // x/r, y/r
        assert!(close(r.partials[0], 1.7 / r.value) && close(r.partials[1], -0.6 / r.value));
        let e = (x * x).map(elementary::exp); // 2x exp x²
        assert!(close(e.partials[0], 3.4 * e.value));
    }

    #[test]
    fn chain_rule_in_two_arguments() {
        let (x, y) = x_and_y();
        let a = (x * y).map2(x, elementary::atan2); // of xy/x = y
        assert!(close(a.partials[0], 0.0) && close(a.partials[1], 1.0 / 1.36));
        let p = x.map2(x, elementary::pow); // x^x (1 + ln x)
        assert!(close(p.partials[0], p.value * (1.0 + libm::log(1.7))));
    }

    #[test]
    fn squares_of_sine_and_cosine_sum_to_a_constant() {
        let (s, c) = x_and_y().0.sin_cos();
        let one = s * s + c * c;
        assert!(close(one.value, 1.0) && close(one.partials[0], 0.0));
    }

    #[test]
    fn selection_takes_the_derivatives_of_the_side_it_takes() {
        let (x, y) = x_and_y();
        assert_eq!((x.min(y), x.max(y)), (y, x));
        assert_eq!(y.abs(), -y);
        assert_eq!(x.clamp_abs(Dual::splat(0.5)), Dual::constant(0.5));
    }

    #[test]
    fn an_infinite_slope_spoils_only_what_depends_on_it() {
        let zero = Dual::<2>::variable(0.0, 0);
        assert_eq!(zero.sqrt().partials, [f64::INFINITY, 0.0]);
        let cube = Dual::<2>::variable(-2.0, 0).map2(Dual::constant(3.0), elementary::pow);
        assert_eq!((cube.value, cube.partials), (-8.0, [12.0, 0.0]));
    }

    #[test]
    fn the_value_has_the_bits_of_the_plain_computation() {
        fn f<R: Real>(x: R, y: R) -> R {
            let (s, c) = (x / y).sin_cos();
            (s * x - c).abs().sqrt() / y
        }
        let (x, y) = x_and_y();
        assert_eq!(f(x, y).value.to_bits(), f(x.value, y.value).to_bits());
    }
}
