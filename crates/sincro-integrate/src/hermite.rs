//! Cubic through values and slopes at both ends of a step: what happens within it.

/// Cubic Hermite polynomial `v₀ + s (a₀ + s (c₂ + s c₃))` on [0, 1].
///
/// ```
/// use sincro_integrate::Hermite;
///
/// // s (1 − s) rises to 1/4
/// let arc = Hermite::new((0.0, 1.0), (0.0, -1.0));
/// assert_eq!(arc.value(arc.extrema()[1]), 0.25);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Hermite {
    v0: f64,
    a0: f64,
    c2: f64,
    c3: f64,
}

impl Hermite {
    /// Creates the polynomial of the given values and slopes at 0 and at 1.
    #[must_use]
    pub fn new((v0, a0): (f64, f64), (v1, a1): (f64, f64)) -> Self {
        Self { v0, a0, c2: 3.0 * (v1 - v0) - 2.0 * a0 - a1, c3: 2.0 * (v0 - v1) + a0 + a1 }
    }

    /// Value at `s`.
    #[must_use]
    pub fn value(&self, s: f64) -> f64 {
        self.v0 + s * (self.a0 + s * (self.c2 + s * self.c3))
    }

    /// Positions of the extrema within (0, 1), roots of `a₀ + 2 c₂ s + 3 c₃ s²` without cancellation; NaN for none.
    #[must_use]
    pub fn extrema(&self) -> [f64; 2] {
        let root = (self.c2 * self.c2 - 3.0 * self.c3 * self.a0).sqrt();
        let q = -(self.c2 + root.copysign(self.c2));
        [q / (3.0 * self.c3), self.a0 / q].map(|s| if s > 0.0 && s < 1.0 { s } else { f64::NAN })
    }

    /// Position of the first extremum whose value is below `bound`; infinite for none.
    #[must_use]
    pub fn first_extremum_below(&self, bound: f64) -> f64 {
        let below = self.extrema().into_iter().filter(|s| self.value(*s) < bound);
        below.fold(f64::INFINITY, f64::min)
    }
}

/// Time of the first extremum, within a step of length `h` `[s]`, at which a quantity that rises at the end is below
/// `bound`, by its value and rate at the start and at the end; infinite for none.
///
/// ```
/// use sincro_integrate::dip;
///
/// // falls from 0.1 m at 1 m/s and is back after 1 s: 0.15 m below zero in between
/// assert_eq!(dip(1.0, 0.0, (0.1, -1.0), (0.1, 1.0)), 0.5);
/// assert_eq!(dip(1.0, -0.2, (0.1, -1.0), (0.1, 1.0)), f64::INFINITY);
/// ```
#[must_use]
pub fn dip(h: f64, bound: f64, (start, rate): (f64, f64), (end, rate_end): (f64, f64)) -> f64 {
    if rate_end <= 0.0 {
        return f64::INFINITY;
    }
    h * Hermite::new((start, h * rate), (end, h * rate_end)).first_extremum_below(bound)
}

/// Time of the instant, within a step of length `h` `[s]`, at which two points are closer than `bound`, by their
/// distance and its rate at the start and at the end; infinite for none. Where they move straight on, the square of
/// their distance is a polynomial.
///
/// ```
/// use sincro_integrate::distance_dip;
///
/// // past each other at 2 m/s, 0.1 m aside
/// let distance = 1.01_f64.sqrt();
/// let (start, end) = ((distance, -2.0 / distance), (distance, 2.0 / distance));
/// assert_eq!(distance_dip(1.0, 0.2, start, end), 0.5);
/// assert_eq!(distance_dip(1.0, 0.09, start, end), f64::INFINITY);
/// ```
#[must_use]
pub fn distance_dip(h: f64, bound: f64, start: (f64, f64), end: (f64, f64)) -> f64 {
    let square = |(distance, rate): (f64, f64)| (distance * distance, 2.0 * distance * h * rate);
    let closest = bound.max(0.0);
    h * Hermite::new(square(start), square(end)).first_extremum_below(closest * closest)
}
