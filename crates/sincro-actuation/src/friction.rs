//! Friction of one degree of freedom: limits of its torque at rest and in motion.
//!
//! | | |
//! |---|---|
//! | at rest | \|τ\| ≤ F_s |
//! | in motion | τ = −sign(q̇) (F_c + (F_s − F_c) exp(−(q̇/v_s)²)) |
//!
//! Both limits grow by c N with the force N that the bearing transmits, for a load coefficient c.
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
    /// Load coefficient c, friction over the force that the bearing transmits: of a hinge the friction coefficient
    /// times the radius of its pin `[m]`, of a slider the friction coefficient (dimensionless). Revolute and
    /// prismatic joints.
    pub load_coefficient: R,
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
        Self { sliding: limit, at_rest: limit, stribeck_velocity: R::one(), load_coefficient: R::zero() }
    }

    /// Returns true if there is no friction in any lane, under any load.
    #[must_use]
    pub fn is_none(&self) -> bool {
        (0..R::LANES).all(|k| self.at_rest.lane(k) == 0.0 && self.load_coefficient.lane(k) == 0.0)
    }

    /// Friction with the limits that it has while its bearing transmits the force `load` `[N]`.
    #[inline(always)]
    #[must_use]
    pub fn under(&self, load: R) -> Self {
        let more = self.load_coefficient * load;
        Self { sliding: self.sliding + more, at_rest: self.at_rest + more, ..*self }
    }

    /// Magnitude of the friction `[N·m]` or `[N]` in motion at the rate `v` `[rad/s]` or `[m/s]`.
    #[inline(always)]
    pub fn limit_at(&self, v: R) -> R {
        let excess = self.at_rest - self.sliding;
        if (0..R::LANES).all(|k| excess.lane(k) == 0.0) {
            return self.sliding;
        }
        let ratio = v / self.stribeck_velocity;
        self.sliding + excess * (-(ratio * ratio)).unary(elementary::Unary::Exp)
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
        let friction = Friction { sliding: 2.0, at_rest: 3.0, stribeck_velocity: 0.1, load_coefficient: 0.5 };
        assert_eq!(friction.limit_at(0.0), 3.0);
        assert!((friction.limit_at(-0.1) - (2.0 + elementary::exp(-1.0).0)).abs() < 1e-15);
        assert_eq!((friction.under(4.0).limit_at(0.0), friction.under(4.0).limit_at(10.0)), (5.0, 4.0));
        assert_eq!((friction.limit_at(10.0), Friction::coulomb(2.0).limit_at(1e-9)), (2.0, 2.0));
    }
}
