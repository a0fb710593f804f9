//! True and false as numbers: 1 and 0; any number but zero is true. A NaN is neither, and whatever depends on it is
//! NaN.

use sincro_math::Real;

/// 1 where `holds`, else 0, lane by lane; NaN where `a` or `b` is. No derivatives.
#[inline(always)]
pub(crate) fn test<R: Real>(a: R, b: R, holds: impl Fn(f64, f64) -> bool) -> R {
    R::from_lanes(|k| {
        let (a, b) = (a.lane(k), b.lane(k));
        if a.is_nan() || b.is_nan() { f64::NAN } else { number(holds(a, b)) }
    })
}

/// `then` where the condition is true, else `otherwise`, with its derivatives; NaN where the condition is.
#[inline(always)]
pub(crate) fn choose<R: Real>(condition: R, then: R, otherwise: R) -> R {
    let is_false = test(condition, R::zero(), |x, _| x == 0.0);
    // taking away 0 changes no bit; taking away NaN leaves NaN
    is_false.if_less(R::splat(0.5), then, otherwise) - is_false * R::zero()
}

/// 1 or 0.
#[inline(always)]
pub(crate) fn number(is_true: bool) -> f64 {
    if is_true { 1.0 } else { 0.0 }
}

/// Returns true for any number but zero.
#[inline(always)]
pub(crate) fn is_true<R: Real>(x: R) -> bool {
    x.lane(0) != 0.0
}
