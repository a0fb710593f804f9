//! The flow through a rotor's disc, from momentum: the root of one equation, found on scalars and then polished once in
//! the caller's own arithmetic.
//!
//! Blade elements give the thrust T = 2ρA (S − a w), momentum theory gives T = 2ρA (w − v)√(w² + h²). Their difference,
//!
//! f(w) = (w − v)√(w² + h²) + a w − S,
//!
//! is zero at the inflow w; of several roots the largest counts, the one that is continuous with climb.
//! Source: key `glauert1926` (momentum in forward flight), key `leishman2006` (the combination).
//!
//! | symbol | meaning | unit | usual symbol |
//! |---|---|---|---|
//! | w | inflow: climb plus induced velocity | m/s | λ ΩR |
//! | v | climb velocity of the hub | m/s | λc ΩR |
//! | h | velocity of the hub in the plane of the disc | m/s | μ ΩR |
//! | a | thrust that a unit of inflow costs, k₁ΩR | m/s | σ Clα/8 ΩR |
//! | S | thrust without inflow | m²/s² | |
//!
//! The squared equation is a quartic with a closed form, but that loses its root in forward flight (a resolvent with
//! three real roots), so the root is bracketed instead. How many roots: f′√(w² + h²) = g(w) = 2w² − v w + h² + a√(w² +
//! h²) is convex, so f rises, falls at most once in between, and rises again. For w ≥ max(v, 0) it rises.
//!
//! The polishing step w ← w − f(w)/f′(w), with the root as a constant, gives a dual number dw = −(∂f/∂p dp)/f′: the
//! derivative by the implicit function theorem, exact.

use sincro_math::Real;

/// The coefficients of f; symbols as above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Balance<R> {
    /// v
    pub climb: R,
    /// h²
    pub in_plane_squared: R,
    /// a, not negative
    pub relief: R,
    /// S
    pub supply: R,
}

/// Most evaluations of f in one search: a Newton step that does not halve the one before last is replaced by a halving
/// of the bracket. Usual are five; the limit is there for what is not a number and for roots of 1e-30 of the bracket.
const MAX_ITERATIONS: usize = 128;

/// Step of Newton's method, as a part of w, that leaves its square: then the polishing step gives value and derivatives
/// to rounding.
const LAST_STEP: f64 = 1e-8;

/// f′ below this part of the velocities in it counts as zero: at a double root rounding leaves √ε = 1.5e-8 of it.
const FLAT: f64 = 1e-8;

/// Smallest number above zero.
const SMALLEST: f64 = f64::from_bits(1);

impl<R: Real> Balance<R> {
    /// The inflow w `[m/s]`.
    #[inline(always)]
    pub fn inflow(&self) -> R {
        let w = if R::IS_SCALAR { R::from_lanes(|k| self.lane(k).largest_root()) } else { self.largest_roots() };
        let (f, slope) = self.residual(w);
        // the slope without derivatives: they would only multiply what is left of f
        let slope = R::from_lanes(|k| slope.lane(k));
        let speeds = w.abs() + self.climb.abs() + self.relief;
        let floor = R::from_lanes(|k| FLAT * speeds.lane(k) + f64::MIN_POSITIVE);
        w - f / slope.max(floor)
    }

    /// f and f′ at w.
    #[inline(always)]
    fn residual(&self, w: R) -> (R, R) {
        let through_disc = (w * w + self.in_plane_squared).sqrt();
        let induced = w - self.climb;
        let f = induced * through_disc + (self.relief * w - self.supply);
        // at w = h = 0 the quotient is taken as 0
        let slope = through_disc + induced * (w / through_disc.max(R::splat(f64::MIN_POSITIVE))) + self.relief;
        (f, slope)
    }

    /// The largest root of f in each lane: lanes whose root is above max(v, 0), as in flight, are searched together,
    /// others one by one.
    #[inline(always)]
    fn largest_roots(&self) -> R {
        let zero = R::zero();
        let above = self.climb.max(zero);
        let is_above = self.residual(above).0.if_less(zero, R::one(), zero);
        let upper = self.axial_root().max(above);
        let together = self.rising_root(above, upper, is_above);
        if (0..R::LANES).all(|k| is_above.lane(k) > 0.0) {
            return together;
        }
        R::from_lanes(|k| if is_above.lane(k) > 0.0 { together.lane(k) } else { self.lane(k).largest_root() })
    }

    /// The root for h = 0 with the same S, of w² − (v − a)w − S: an upper bound of the root for h > 0 where that is
    /// above max(v, 0), because √(w² + h²) ≥ w there; exact in axial flight.
    #[inline(always)]
    fn axial_root(&self) -> R {
        let b = self.climb - self.relief;
        let root = (b * b + R::splat(4.0) * self.supply).max(R::zero()).sqrt();
        // the form without cancellation
        b.if_less(R::zero(), R::splat(2.0) * self.supply / (root - b), R::splat(0.5) * (b + root))
    }

    /// The root of f between `low` and `high`, where f rises, by Newton's method from `high`, kept inside the bracket,
    /// in the lanes where `is_wanted` is 1. A lane whose search has ended stays as it is.
    #[inline(always)]
    fn rising_root(&self, mut low: R, mut high: R, is_wanted: R) -> R {
        let (zero, one) = (R::zero(), R::one());
        let mut w = high;
        let (mut last, mut before_last) = (high - low, high - low);
        let mut is_pending = is_wanted;
        for _ in 0..MAX_ITERATIONS {
            if (0..R::LANES).all(|k| is_pending.lane(k) == 0.0) {
                break;
            }
            let (f, slope) = self.residual(w);
            high = zero.if_less(f, w, high);
            low = zero.if_less(f, low, w);
            let newton = w - f / slope;
            let newton_step = (newton - w).abs();
            let is_short = newton_step.if_less(R::splat(0.5) * before_last, one, zero);
            let is_good = low.if_less(newton, newton.if_less(high, is_short, zero), zero);
            let next = zero.if_less(is_good, newton, low + R::splat(0.5) * (high - low));
            let last_step = zero.if_less(is_good, R::splat(LAST_STEP), R::splat(f64::EPSILON));
            let step = (next - w).abs();
            // it stays at a root to rounding, and at an end of the bracket
            let moves = low.if_less(next, next.if_less(high, is_pending, zero), zero);
            let moves = f.abs().if_less(R::splat(SMALLEST), zero, moves);
            let moves = newton_step.if_less(R::splat(SMALLEST), zero, moves);
            is_pending = (last_step * w.abs()).if_less(step, moves, zero);
            w = zero.if_less(moves, next, w);
            (before_last, last) = (last, step);
        }
        w
    }

    #[inline(always)]
    fn lane(&self, k: usize) -> Balance<f64> {
        Balance {
            climb: self.climb.lane(k),
            in_plane_squared: self.in_plane_squared.lane(k),
            relief: self.relief.lane(k),
            supply: self.supply.lane(k),
        }
    }
}

impl Balance<f64> {
    /// The largest root of f.
    fn largest_root(&self) -> f64 {
        let above = self.climb.max(0.0);
        let at_above = self.residual(above).0;
        if at_above == 0.0 {
            return above;
        }
        if at_above < 0.0 {
            return self.rising_root(above, self.axial_root().max(above), 1.0);
        }
        let (least, most) = self.bracket_below(above);
        self.rising_root(least, most, 1.0)
    }

    /// An interval on which f rises through its largest root, given f(above) > 0 at `above` = max(v, 0).
    fn bracket_below(&self, above: f64) -> (f64, f64) {
        // here (w − v)√(w² + h²) ≤ −|S| and a w ≤ 0
        let bottom = -(self.climb.abs() + self.supply.abs().sqrt());
        // 2w² − v w + h² has no zero: f rises everywhere
        if self.climb * self.climb <= 8.0 * self.in_plane_squared {
            return (bottom, above);
        }
        // g is least at `turn`; where it is negative, f falls
        let turn = bisect(self.climb.min(0.0), above, |w| self.bend(w).1 < 0.0);
        if self.bend(turn).0 >= 0.0 {
            return (bottom, above);
        }
        let valley = bisect(turn, above, |w| self.bend(w).0 < 0.0);
        if self.residual(valley).0 <= 0.0 {
            return (valley, above);
        }
        let hill = bisect(self.climb.min(0.0), turn, |w| self.bend(w).0 > 0.0);
        (bottom, hill)
    }

    /// g and g′ at w.
    fn bend(&self, w: f64) -> (f64, f64) {
        let through_disc = (w * w + self.in_plane_squared).sqrt();
        let g = 2.0 * w * w - self.climb * w + self.in_plane_squared + self.relief * through_disc;
        (g, 4.0 * w - self.climb + self.relief * (w / through_disc.max(f64::MIN_POSITIVE)))
    }
}

/// The point in [low, high] where `is_before` turns from true to false.
fn bisect(mut low: f64, mut high: f64, is_before: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..MAX_ITERATIONS {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if is_before(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low + 0.5 * (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Signs of f on a fine grid, from the top downwards: where the largest root is, to the grid's width.
    fn scanned(b: &Balance<f64>, top: f64, bottom: f64, n: u32) -> (f64, f64) {
        let at = |k: u32| top + (bottom - top) * (f64::from(k) / f64::from(n));
        let k = (0..=n).find(|k| b.residual(at(*k)).0 <= 0.0).expect("f is negative at the bottom");
        (at(k), if k == 0 { top } else { at(k - 1) })
    }

    #[test]
    fn the_largest_root_is_found_where_there_are_three() {
        // negative pitch, climb: f rises, falls and rises again between 0 and v
        for supply in [-0.5, -1.0, -2.0, -3.0, -3.9, -4.5, -6.0, 1.0] {
            for in_plane in [0.0, 0.1, 0.5, 1.0, 1.5, 3.0] {
                for relief in [0.0, 0.2, 1.0, 3.0] {
                    for climb in [-4.0, -1.0, 1.0, 4.0] {
                        let b = Balance { climb, in_plane_squared: in_plane * in_plane, relief, supply };
                        let (below, above) = scanned(&b, 10.0, -10.0, 20_000);
                        let w = b.inflow();
                        assert!(w >= below - 1e-7 && w <= above + 1e-7, "{b:?}: {w} not in [{below}, {above}]");
                    }
                }
            }
        }
    }

    #[test]
    fn lanes_find_the_bits_of_the_search_alone() {
        use sincro_math::Lanes;
        use sincro_math::random::splitmix64;
        let mut drawn = 0;
        let mut draw = |low: f64, high: f64| {
            drawn += 1;
            low + (high - low) * (splitmix64(7, drawn) >> 11) as f64 / (1_u64 << 53) as f64
        };
        // flight, hover at rest, windmill states, and lanes of all of them
        for round in 0..4000 {
            let mut one = || match (round % 4, draw(0.0, 1.0)) {
                (0, _) => [draw(-2.0, 2.0), draw(0.0, 9.0), draw(0.1, 3.0), draw(1.0, 60.0)],
                (1, _) => [0.0, 0.0, draw(0.0, 3.0), draw(0.0, 60.0)],
                (_, x) if x < 0.1 => [draw(-9.0, 9.0), 0.0, 0.0, draw(-9.0, 9.0)],
                (_, x) if x < 0.15 => [f64::NAN, 1.0, 1.0, 1.0],
                (_, x) if x < 0.2 => [1e200, 1e300, 1.0, 1e300],
                _ => [draw(-20.0, 20.0), draw(0.0, 30.0), draw(0.0, 9.0), draw(-60.0, 60.0)],
            };
            let all: [[f64; 4]; 8] = core::array::from_fn(|_| one());
            let of = |i: usize| Lanes::<8>::from_lanes(|k| all[k][i]);
            let balance = Balance { climb: of(0), in_plane_squared: of(1), relief: of(2), supply: of(3) };
            let together = balance.inflow();
            for (k, [climb, in_plane_squared, relief, supply]) in all.into_iter().enumerate() {
                let alone = Balance { climb, in_plane_squared, relief, supply }.inflow();
                let found = together.lane(k);
                assert!(found.to_bits() == alone.to_bits() || found.is_nan() && alone.is_nan(), "{:?}", all[k]);
            }
        }
    }

    #[test]
    fn a_double_root_leaves_the_polishing_step_harmless() {
        // h = 0, a = 0: f = w² − v w − S for w > 0 touches zero at v/2 where S = −v²/4
        let b = Balance { climb: 4.0, in_plane_squared: 0.0, relief: 0.0, supply: -4.0 };
        assert!((b.inflow() - 2.0).abs() < 1e-7, "{}", b.inflow());
        let still = Balance { climb: 0.0, in_plane_squared: 0.0, relief: 0.0, supply: 0.0 };
        assert_eq!(still.inflow(), 0.0);
    }

    #[test]
    fn what_is_not_a_number_ends_as_such() {
        let b = Balance { climb: f64::NAN, in_plane_squared: 0.0, relief: 1.0, supply: 1.0 };
        assert!(b.inflow().is_nan());
    }
}
