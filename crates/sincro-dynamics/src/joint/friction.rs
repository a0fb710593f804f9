//! Friction of one degree of freedom: limits of its torque at rest and in motion.
//!
//! | | |
//! |---|---|
//! | at rest | \|τ\| ≤ F_s |
//! | in motion | τ = −sign(q̇) (F_c + (F_s − F_c) exp(−(q̇/v_s)²)) |
//!
//! Source: key `armstrong1994`, section 3 (Stribeck's curve with an exponent of 2).

use sincro_math::{Real, elementary};

/// Dry friction of one degree of freedom: Coulomb friction, stiction and Stribeck curve. Viscous friction is a damper
/// of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction<R> {
    /// Coulomb friction F_c, the limit in fast motion [N·m] or `[N]`.
    pub sliding: R,
    /// Stiction F_s, the limit at rest [N·m] or `[N]`; at least F_c.
    pub at_rest: R,
    /// Stribeck velocity v_s [rad/s] or [m/s], positive.
    pub stribeck_velocity: R,
}

impl<R: Real> Friction<R> {
    /// Friction with both limits zero.
    #[must_use]
    pub fn none() -> Self {
        Self::coulomb(R::zero())
    }

    /// Coulomb friction with the same `limit` at rest and in motion `[N·m]` or `[N]`.
    #[must_use]
    pub fn coulomb(limit: R) -> Self {
        Self { sliding: limit, at_rest: limit, stribeck_velocity: R::one() }
    }

    /// Magnitude of the friction `[N·m]` or `[N]` in motion at the rate `v` `[rad/s]` or `[m/s]`.
    #[inline(always)]
    pub fn limit_at(&self, v: R) -> R {
        let excess = self.at_rest - self.sliding;
        if (0..R::LANES).all(|k| excess.lane(k) == 0.0) {
            return self.sliding;
        }
        let ratio = v / self.stribeck_velocity;
        self.sliding + excess * (-(ratio * ratio)).map(elementary::exp)
    }
}

impl From<f64> for Friction<f64> {
    fn from(limit: f64) -> Self {
        Self::coulomb(limit)
    }
}

#[cfg(test)]
mod tests {
    use super::{Friction, elementary};

    #[test]
    fn the_limit_falls_from_stiction_to_coulomb_friction() {
        let friction = Friction { sliding: 2.0, at_rest: 3.0, stribeck_velocity: 0.1 };
        assert_eq!(friction.limit_at(0.0), 3.0);
        assert!((friction.limit_at(-0.1) - (2.0 + elementary::exp(-1.0).0)).abs() < 1e-15);
        assert_eq!((friction.limit_at(10.0), Friction::coulomb(2.0).limit_at(1e-9)), (2.0, 2.0));
    }
}
