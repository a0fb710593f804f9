//! The three kinds of numbers do the same: lanes and dual numbers against `f64`, bit for bit, also where a comparison
//! is between equals.

use sincro_math::lanes::dispatch_lanes;
use sincro_math::{Dual, LaneVisitor, Lanes, Real};

/// Pairs with equals, zeros of both signs, infinities and NaN on either side.
const PAIRS: [(f64, f64); 12] = [
    (1.0, 2.0),
    (2.0, 1.0),
    (1.5, 1.5),
    (-1.5, 1.5),
    (0.0, -0.0),
    (-0.0, 0.0),
    (f64::INFINITY, 3.0),
    (3.0, f64::NEG_INFINITY),
    (f64::INFINITY, f64::INFINITY),
    (f64::NAN, 1.0),
    (1.0, f64::NAN),
    (-4.0, 0.25),
];

/// Every operation of two numbers, assigning ones included.
fn operations<R: Real>(a: R, b: R) -> Vec<R> {
    let (mut sum, mut difference, mut product) = (a, a, a);
    sum += b;
    difference -= b;
    product *= b;
    let (then, otherwise) = (R::splat(10.0), R::splat(-10.0));
    let selected = a.if_less(b, then, otherwise);
    let smooth = a.map(|x| (2.0 * x + 1.0, 2.0));
    let both = a.map2(b, |x, y| (x - 3.0 * y, 1.0, -3.0));
    let (sine, cosine) = a.sin_cos();
    vec![
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        sum,
        difference,
        product,
        selected,
        a.min(b),
        a.max(b),
        a.abs(),
        b.abs(),
        a.clamp_abs(b.abs()),
        a.abs().sqrt(),
        a.sqrt(),
        sine,
        cosine,
        smooth,
        both,
        R::zero(),
        R::one(),
        R::default(),
    ]
}

/// Equal to the bit; every NaN is like another.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// Compares all operations on the pairs, one after the other in the lanes, with the scalar ones.
struct AgainstScalars;

impl LaneVisitor for AgainstScalars {
    type Output = usize;

    #[inline(always)]
    fn visit<R: Real>(self) -> usize {
        for first in 0..PAIRS.len() {
            let pair = |k: usize| PAIRS[(first + k) % PAIRS.len()];
            let (a, b) = (R::from_lanes(|k| pair(k).0), R::from_lanes(|k| pair(k).1));
            let found = operations(a, b);
            for k in 0..R::LANES {
                let expected = operations(pair(k).0, pair(k).1);
                for (n, (found, expected)) in found.iter().zip(&expected).enumerate() {
                    let found = found.lane(k);
                    assert!(same(found, *expected), "operation {n} of {:?} in lane {k}: {found} {expected}", pair(k));
                }
            }
            let is_finite = (0..R::LANES).all(|k| pair(k).0.is_finite());
            assert_eq!(a.is_finite(), is_finite, "{first}");
        }
        R::LANES
    }
}

#[test]
fn lanes_of_this_processor_have_the_bits_of_scalars() {
    assert_eq!(dispatch_lanes(AgainstScalars), sincro_math::lanes::width());
}

#[test]
fn the_instruction_set_is_that_of_the_lanes() {
    let expected = match sincro_math::lanes::width() {
        8 => "AVX-512",
        4 => "AVX2",
        _ => "baseline",
    };
    assert_eq!(sincro_math::lanes::instruction_set(), expected);
}

#[test]
fn portable_lanes_have_the_bits_of_scalars() {
    AgainstScalars.visit::<Lanes<4>>();
    AgainstScalars.visit::<Lanes<1>>();
    AgainstScalars.visit::<f64>();
}

#[test]
fn values_of_dual_numbers_have_the_bits_of_scalars() {
    for (x, y) in PAIRS {
        let duals = operations(Dual::<2>::variable(x, 0), Dual::variable(y, 1));
        for (n, (dual, plain)) in duals.iter().zip(operations(x, y)).enumerate() {
            // of a function of two arguments a negative zero becomes a positive one
            let is_zero = dual.value == 0.0 && plain == 0.0;
            assert!(same(dual.value, plain) || is_zero, "operation {n} of ({x}, {y}): {} {plain}", dual.value);
        }
    }
}

#[test]
fn assigning_operations_carry_the_derivatives_of_the_others() {
    let (x, y) = (Dual::<2>::variable(1.7, 0), Dual::variable(-0.6, 1));
    let (mut sum, mut difference, mut product) = (x, x, x);
    sum += y;
    difference -= y;
    product *= y;
    assert_eq!((sum, difference, product), (x + y, x - y, x * y));
    assert_eq!((sum.partials, difference.partials, product.partials), ([1.0, 1.0], [1.0, -1.0], [-0.6, 1.7]));
}

#[test]
fn between_equals_less_does_not_hold() {
    let (x, bound) = (Dual::<1>::variable(0.5, 0), Dual::splat(0.5));
    assert_eq!(x.if_less(bound, Dual::splat(1.0), Dual::splat(2.0)).value, 2.0);
    // of equals the smaller and the larger are the first, with its derivative
    assert_eq!((x.min(bound), x.max(bound)), (x, x));
    assert_eq!((bound.min(x), bound.max(x)), (bound, bound));
}

#[test]
fn the_derivative_of_the_absolute_value_at_zero_is_that_from_above() {
    let slope = |x: f64| Dual::<1>::variable(x, 0).abs().partials[0];
    assert_eq!([2.0, 0.0, -0.0, -2.0].map(slope), [1.0, 1.0, 1.0, -1.0]);
}

#[test]
fn constants_depend_on_nothing() {
    assert_eq!(Dual::<3>::constant(4.0), Dual { value: 4.0, partials: [0.0; 3] });
    assert_eq!(Dual::<3>::variable(4.0, 2), Dual { value: 4.0, partials: [0.0, 0.0, 1.0] });
    assert_eq!(Dual::<3>::from_lanes(|_| 7.0), Dual::splat(7.0));
}
