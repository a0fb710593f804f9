//! Integrals of functions of one variable.

/// Largest number of bisections of an interval.
const MAX_BISECTIONS: u32 = 12;

/// Nodes and weights of the Gauss–Legendre rule of seven points on [−1, 1], by symmetry.
const GAUSS: [(f64, f64); 4] = [
    (0.0, 0.417_959_183_673_469_4),
    (0.405_845_151_377_397_2, 0.381_830_050_505_118_9),
    (0.741_531_185_599_394_4, 0.279_705_391_489_276_7),
    (0.949_107_912_342_758_5, 0.129_484_966_168_869_7),
];

/// ∫ f from `a` to `b` by the Gauss–Legendre rule of seven points, and ∫ |f|.
fn gauss(f: &impl Fn(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let (mut sum, mut size) = (0.0, 0.0);
    for (k, (node, weight)) in GAUSS.into_iter().enumerate() {
        for side in [1.0, -1.0].into_iter().take(if k == 0 { 1 } else { 2 }) {
            let y = f(middle + side * half * node);
            sum += weight * y;
            size += weight * y.abs();
        }
    }
    (sum * half, size * half.abs())
}

/// Integral of `f` from `a` to `b`, by the Gauss–Legendre rule of seven points on intervals that are bisected, at most
/// twelve times, where the rule is not exact to rounding. Its unit is that of `f` times that of its argument.
///
/// ```
/// use sincro_integrate::quadrature;
///
/// let area = quadrature(&|x: f64| x.abs(), -1.0, 2.0); // a corner inside the interval
/// assert!((area - 2.5).abs() < 1e-6);
/// ```
#[must_use]
pub fn quadrature(f: &impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (whole, size) = gauss(f, a, b);
    refine(f, (a, b), whole, 1e-14 * size, MAX_BISECTIONS)
}

fn refine(f: &impl Fn(f64) -> f64, (a, b): (f64, f64), whole: f64, tolerance: f64, left: u32) -> f64 {
    let middle = 0.5 * (a + b);
    let (one, two) = (gauss(f, a, middle).0, gauss(f, middle, b).0);
    // not a number: no use in going on
    let error = (one + two - whole).abs();
    if left == 0 || error <= tolerance || error.is_nan() {
        return one + two;
    }
    refine(f, (a, middle), one, tolerance, left - 1) + refine(f, (middle, b), two, tolerance, left - 1)
}
