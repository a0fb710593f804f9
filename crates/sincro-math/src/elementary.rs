//! Elementary functions with the same bits for scalars and lanes, on every platform.
//!
//! Sine and cosine are the hot ones: one branch-free polynomial, written once for scalars and lanes. The rest comes
//! from the pure-Rust `libm` crate.
//!
//! Method of [`sin_cos`]: Cody–Waite reduction by π/2 in three parts, then the minimax polynomials of degree 13 (sine)
//! and 14 (cosine) on [−π/4, π/4]. Source of the coefficients: key `ng-fdlibm`. Beyond [`REDUCTION_LIMIT`] the
//! reduction would lose digits, and the lanes concerned go to `libm`.
//!
//! Absolute error of [`sin_cos`], measured against thirty digits (`tests/sin_cos_accuracy.rs`): 8.4e-17 for |x| ≤ π/4,
//! 1.2e-16 up to 100 rad, 1.3e-16 up to 10⁴ rad, 1.57e-16 up to the limit. The roundings of the method add up to less
//! than 0.8 units in the last place of 1, 1.78e-16: two in the reduction, one in the sum, the rest small. Near their
//! zeros both keep a relative error of 2.4e-16.
//!
//! The functions of one or two arguments below return the value and the derivatives there, as [`Real::map`] and
//! [`Real::map2`] take them:
//!
//! ```
//! use sincro_math::{Dual, Real, elementary};
//!
//! let x = Dual::<1>::variable(0.5, 0);
//! let y = x.map(elementary::exp);
//! assert_eq!(y.partials[0], y.value);
//! ```
//!
//! [`Real::map`]: crate::Real::map
//! [`Real::map2`]: crate::Real::map2

pub use crate::functions::*;

use crate::Real;

/// Limit on |angle| `[rad]` of the fast path of [`sin_cos`]; larger angles take a slower one. Below it the quotient by
/// π/2 has at most 20 bits, so that its product with each 33-bit part of π/2 is exact.
pub const REDUCTION_LIMIT: f64 = 1.0e6;

// π/2 = PIO2_1 + PIO2_2 + PIO2_3: the first two have 33 significant bits.
const PIO2_1: f64 = 1.570_796_326_734_125_6;
const PIO2_2: f64 = 6.077_100_506_303_966e-11;
const PIO2_3: f64 = 2.022_266_248_795_950_6e-21;
const TWO_OVER_PI: f64 = core::f64::consts::FRAC_2_PI;

/// Adding and subtracting 1.5·2⁵² rounds to the nearest integer, which stands in the low bits in between.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Access to the bits of a number, lane by lane: what the branch-free sine needs beside arithmetic.
pub(crate) trait Bits: Real {
    /// Magnitude of `self`, sign of `sign`.
    fn copysign(self, sign: Self) -> Self;

    /// `odd` where the lowest bit of `n` is set, else `even`.
    fn if_odd(n: Self, odd: Self, even: Self) -> Self;

    /// `self` with the sign flipped where bit `BIT` of `n` is set.
    fn flip_by<const BIT: u32>(self, n: Self) -> Self;

    /// Returns true if |self| is below `limit` in every lane (a NaN is not).
    fn all_below(self, limit: f64) -> bool;
}

impl Bits for f64 {
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.copysign(sign)
    }

    #[inline(always)]
    fn if_odd(n: Self, odd: Self, even: Self) -> Self {
        let mask = 0u64.wrapping_sub(n.to_bits() & 1);
        f64::from_bits((even.to_bits() & !mask) | (odd.to_bits() & mask))
    }

    #[inline(always)]
    fn flip_by<const BIT: u32>(self, n: Self) -> Self {
        f64::from_bits(self.to_bits() ^ ((n.to_bits() << (63 - BIT)) & (1 << 63)))
    }

    #[inline(always)]
    fn all_below(self, limit: f64) -> bool {
        self.abs() < limit
    }
}

/// Sine and cosine of the angle `x` `[rad]`, in this order, each dimensionless; NaN where `x` is not finite. Faster
/// than the standard library's and the same bits on every platform and in every lane.
#[inline(always)]
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    sin_cos_lanes(x)
}

/// Sine and cosine of each lane of `x` `[rad]`.
#[inline(always)]
pub(crate) fn sin_cos_lanes<R: Bits>(x: R) -> (R, R) {
    let near = sin_cos_reduced(x);
    if x.all_below(REDUCTION_LIMIT) { near } else { sin_cos_far(x, near) }
}

/// The branch-free path; right for |x| < [`REDUCTION_LIMIT`].
#[inline(always)]
fn sin_cos_reduced<R: Bits>(x: R) -> (R, R) {
    // the quadrant stands in the low bits of `shifted`
    let shifted = x * R::splat(TWO_OVER_PI) + R::splat(ROUNDER);
    let n = shifted - R::splat(ROUNDER);
    let r = ((x - n * R::splat(PIO2_1)) - n * R::splat(PIO2_2)) - n * R::splat(PIO2_3);

    let z = r * r;
    let s = (r + r * z * polynomial(&SIN, z)).copysign(r); // −0 stays −0
    // 1 − z/2 is rounded; what the rounding lost is added back with the small terms
    let half = R::splat(0.5) * z;
    let w = R::one() - half;
    let c = w + (((R::one() - w) - half) + z * z * polynomial(&COS, z));

    // odd quadrants swap sine and cosine; the sine is negative in quadrants 2 and 3, the cosine in 1 and 2
    let sin = R::if_odd(shifted, c, s).flip_by::<1>(shifted);
    let cos = R::if_odd(shifted, s, c).flip_by::<1>(shifted).flip_by::<0>(shifted);
    (sin, cos)
}

/// Horner's scheme in `z`.
#[inline(always)]
fn polynomial<R: Real>(c: &[f64; 6], z: R) -> R {
    let mut sum = R::splat(c[5]);
    for k in (0..5).rev() {
        sum = R::splat(c[k]) + z * sum;
    }
    sum
}

#[cold]
#[inline(never)]
fn sin_cos_far<R: Bits>(x: R, near: (R, R)) -> (R, R) {
    let far = |k: usize| x.lane(k).is_nan() || x.lane(k).abs() >= REDUCTION_LIMIT;
    let sin = R::from_lanes(|k| if far(k) { libm::sincos(x.lane(k)).0 } else { near.0.lane(k) });
    let cos = R::from_lanes(|k| if far(k) { libm::sincos(x.lane(k)).1 } else { near.1.lane(k) });
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_stand_in_the_order_of_their_enumeration() {
        assert!(Unary::ALL.iter().enumerate().all(|(k, f)| *f as usize == k));
        assert!(Binary::ALL.iter().enumerate().all(|(k, f)| *f as usize == k));
    }

    #[test]
    fn exact_where_the_value_is_exact() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(sin_cos(-0.0).0.to_bits(), (-0.0f64).to_bits());
    }

    #[test]
    fn zero_to_the_zero_falls_with_the_exponent_without_bound() {
        assert_eq!(pow(0.0, 0.0), (1.0, 0.0, f64::NEG_INFINITY));
        assert_eq!(pow(0.0, 2.0), (0.0, 0.0, 0.0));
    }

    #[test]
    fn sine_is_odd_and_cosine_is_even_to_the_bit() {
        for k in 0..10_000 {
            let x = f64::from(k) * 0.013_7;
            let ((s, c), (s_minus, c_minus)) = (sin_cos(x), sin_cos(-x));
            assert_eq!((s.to_bits(), c.to_bits()), ((-s_minus).to_bits(), c_minus.to_bits()), "{x}");
        }
    }

    #[test]
    fn far_angles_keep_their_accuracy() {
        for x in [1.0e6, -3.3e9, 1.0e22, 999_999.999] {
            let (s, c) = sin_cos(x);
            let (sl, cl) = libm::sincos(x);
            assert!((s - sl).abs() < 2.5e-16 && (c - cl).abs() < 2.5e-16, "{x}");
        }
    }

    #[test]
    fn a_far_lane_leaves_its_neighbours_alone() {
        let (sin, cos) = sin_cos_lanes(crate::Lanes([0.3, 1.0e9, f64::NAN, -2.0]));
        let (sin, cos) = (sin.0, cos.0);
        assert_eq!(((sin[0], cos[0]), (sin[3], cos[3])), (sin_cos(0.3), sin_cos(-2.0)));
        assert_eq!((sin[1], cos[1]), libm::sincos(1.0e9));
        assert!(sin[2].is_nan() && cos[2].is_nan());
    }

    #[test]
    fn not_finite_in_not_a_number_out() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (s, c) = sin_cos(x);
            assert!(s.is_nan() && c.is_nan());
        }
    }

    /// The central difference with h = 1e-5 is off by some h² f‴/6 (f‴ up to 70 here) and 1e-16 f/h: 1e-9 leaves room
    /// for both.
    fn close(derivative: f64, difference: f64) -> bool {
        (derivative - difference).abs() <= 1e-9 * (1.0 + derivative.abs())
    }

    #[test]
    fn derivatives_of_one_argument_are_the_slopes() {
        type Pair = fn(f64) -> (f64, f64);
        const H: f64 = 1e-5;
        let functions: [Pair; 10] = [tan, asin, acos, atan, exp, ln, log10, sinh, cosh, tanh];
        for (number, f) in functions.iter().enumerate() {
            for x in [0.3, 0.45, 0.6, 0.8] {
                let difference = (f(x + H).0 - f(x - H).0) / (2.0 * H);
                assert!(close(f(x).1, difference), "function {number} at {x}: {} {difference}", f(x).1);
            }
        }
    }

    #[test]
    fn derivatives_of_two_arguments_are_the_slopes() {
        type Triple = fn(f64, f64) -> (f64, f64, f64);
        const H: f64 = 1e-5;
        let functions: [Triple; 4] = [atan2, hypot, pow, modulo];
        for (number, f) in functions.iter().enumerate() {
            for (a, b) in [(0.4, 1.3), (2.5, 0.7), (1.9, 3.1)] {
                let by_a = (f(a + H, b).0 - f(a - H, b).0) / (2.0 * H);
                let by_b = (f(a, b + H).0 - f(a, b - H).0) / (2.0 * H);
                let (_, da, db) = f(a, b);
                assert!(close(da, by_a) && close(db, by_b), "function {number} at {a}, {b}");
            }
        }
    }

    #[test]
    fn modulo_takes_the_sign_of_the_modulus() {
        assert_eq!(modulo(-1.0, 3.0).0, 2.0);
        assert_eq!(modulo(1.0, -3.0).0, -2.0);
        assert_eq!(modulo(7.5, 2.0).0, 1.5);
        assert!(modulo(1.0, 0.0).0.is_nan());
    }

    #[test]
    fn powers_have_finite_slopes_where_they_are_smooth() {
        assert_eq!(pow(0.0, 2.0), (0.0, 0.0, 0.0));
        assert_eq!(pow(-2.0, 3.0).1, 12.0);
        assert_eq!(pow(-2.0, 0.0).1, 0.0);
        assert!(pow(-2.0, 0.5).0.is_nan());
    }
}
