//! The error of [`sin_cos`] against a reference of some thirty digits.

use sincro_math::elementary::{REDUCTION_LIMIT, sin_cos};

/// The unevaluated sum `hi + lo`, some 106 bits.
#[derive(Clone, Copy)]
struct Wide {
    hi: f64,
    lo: f64,
}

/// π/2 as a sum of three numbers.
const PARTS: [f64; 3] = [core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];

fn wide_sum(a: f64, b: f64) -> Wide {
    let hi = a + b;
    let b_part = hi - a;
    Wide { hi, lo: (a - (hi - b_part)) + (b - b_part) }
}

fn wide_product(a: f64, b: f64) -> Wide {
    let hi = a * b;
    Wide { hi, lo: libm::fma(a, b, -hi) }
}

impl Wide {
    fn plus(self, other: Self) -> Self {
        let sum = wide_sum(self.hi, other.hi);
        let rest = wide_sum(self.lo, other.lo);
        let first = wide_sum(sum.hi, sum.lo + rest.hi);
        wide_sum(first.hi, first.lo + rest.lo)
    }

    fn times(self, other: Self) -> Self {
        let product = wide_product(self.hi, other.hi);
        wide_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }

    fn over(self, divisor: f64) -> Self {
        let quotient = self.hi / divisor;
        let rest = wide_product(-quotient, divisor).plus(self);
        wide_sum(quotient, (rest.hi + rest.lo) / divisor)
    }

    fn negated(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }

    /// Distance of `x` from this number.
    fn distance(self, x: f64) -> f64 {
        let rest = self.plus(Self { hi: -x, lo: 0.0 });
        (rest.hi + rest.lo).abs()
    }
}

/// Sine and cosine by the Taylor series of the angle reduced to [−π/4, π/4].
fn reference(x: f64) -> (Wide, Wide) {
    let n = libm::rint(x / PARTS[0]);
    // the large parts cancel without rounding before the small ones are taken away
    let [large, small, least] = PARTS.map(|part| wide_product(n, part).negated());
    let r = Wide { hi: x, lo: 0.0 }.plus(large).plus(small).plus(least);
    let mut terms = [Wide { hi: 1.0, lo: 0.0 }, r];
    let [mut cos, mut sin] = terms;
    let minus_square = r.times(r).negated();
    for k in 1..14 {
        let k = f64::from(k);
        terms[0] = terms[0].times(minus_square).over((2.0 * k - 1.0) * 2.0 * k);
        terms[1] = terms[1].times(minus_square).over(2.0 * k * (2.0 * k + 1.0));
        cos = cos.plus(terms[0]);
        sin = sin.plus(terms[1]);
    }
    match n.rem_euclid(4.0) {
        0.0 => (sin, cos),
        1.0 => (cos, sin.negated()),
        2.0 => (sin.negated(), cos.negated()),
        _ => (cos.negated(), sin),
    }
}

/// The largest absolute error of sine or cosine at 200 000 points spread over ±`reach` by the golden ratio.
fn worst_error(reach: f64) -> f64 {
    let mut worst: f64 = 0.0;
    for k in 0..200_000 {
        let fraction = (f64::from(k) * 0.618_033_988_749_894_9).fract();
        let x = reach * (2.0 * fraction - 1.0);
        let ((sin, cos), (sin_exact, cos_exact)) = (sin_cos(x), reference(x));
        worst = worst.max(sin_exact.distance(sin)).max(cos_exact.distance(cos));
    }
    worst
}

/// Twenty to sixty million points showed at most 8.38e-17, 1.20e-16 and 1.563e-16; the bounds leave a few per cent.
/// Half a unit in the last place below 1, 5.6e-17, is what rounding alone costs.
#[test]
fn error_stays_within_the_stated_bounds() {
    for (reach, bound) in [(core::f64::consts::FRAC_PI_4, 8.5e-17), (100.0, 1.25e-16), (REDUCTION_LIMIT, 1.65e-16)] {
        let worst = worst_error(reach);
        assert!(worst <= bound, "{worst:e} within ±{reach}");
    }
}

/// The doubles nearest to multiples of π/2, where sine or cosine is all that the reduction leaves over.
#[test]
fn zeros_are_accurate_to_their_own_last_place() {
    for n in 1..600_000 {
        let x = f64::from(n) * PARTS[0];
        let ((sin, cos), (sin_exact, cos_exact)) = (sin_cos(x), reference(x));
        let (small, exact) = if n % 2 == 0 { (sin, sin_exact) } else { (cos, cos_exact) };
        // measured: 2.31e-16
        assert!(exact.distance(small) <= 2.4e-16 * small.abs(), "{n}");
    }
}
