//! V-REP's stock propeller: a jet of imaginary particles.
//!
//! Each step it throws n whole particles of mass m = ρ π d³/6 downwards with velocity u; the force over a step of
//! length Δt is n m u/Δt, the torque −0.002 u. The particles are N a second, and what is left of one is carried to the
//! next step, so n flutters by one from step to step; the mean force is N m u.
//!
//! Source: key `morales2019`, section 6.1.1, and the child script of V-REP's model of a propeller.
//!
//! Ours deviates in the carry: with the step as the decimal fraction that was typed, n = ⌊N (k+1)Δt⌋ − ⌊N kΔt⌋ in
//! integers, so that the particles up to t are ⌊N t⌋ exactly, after a year as after a second, and there is no carry to
//! store.

use core::f64::consts::PI;

use sincro_math::Real;

use super::outside;

/// A length of time as a fraction of whole numbers, exactly what was typed: 0.005 is 5/1000, whatever its bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExactStep {
    numerator: u64,
    denominator: u128,
}

/// Integers up to here are exact in double precision, and so is any quotient's rounding.
const EXACT: f64 = 9_007_199_254_740_992.0;

impl ExactStep {
    /// The shortest decimal fraction that has the bits of `seconds`, or those bits themselves if it has none of sixteen
    /// digits; zero for what is not positive and finite, and for less than 1e-22 s.
    #[must_use]
    pub fn new(seconds: f64) -> Self {
        if !(seconds > 0.0 && seconds < 1e9) {
            return Self { numerator: 0, denominator: 1 };
        }
        let (mut power, mut denominator) = (1.0, 1_u128);
        // powers of ten up to 10²² are exact
        for _ in 0..=22 {
            let digits = (seconds * power).round();
            if digits < EXACT && digits / power == seconds {
                return Self { numerator: digits as u64, denominator };
            }
            (power, denominator) = (power * 10.0, denominator * 10);
        }
        // the bits themselves, from 2⁻⁶⁰ on
        let denominator = 1_u128 << 60;
        Self { numerator: (seconds * (1_u64 << 60) as f64).min(1e18) as u64, denominator }
    }

    /// ⌊`rate` · `n` steps⌋ for a rate [1/s]; as much as fits, if it does not.
    fn whole(self, rate: u32, n: u64) -> u128 {
        // 2³² · 2⁵³ fits in 128 bits with 2⁴³ steps to spare
        let product =
            u128::from(rate).checked_mul(u128::from(self.numerator)).and_then(|x| x.checked_mul(u128::from(n)));
        product.unwrap_or(u128::MAX) / self.denominator
    }
}

/// V-REP's stock propeller, a jet of imaginary particles; [`StockPropeller::default`] has V-REP's numbers. For scenes
/// that must behave as they do there; its particle count varies by one from step to step.
///
/// ```
/// use sincro_aero::rotor::StockPropeller;
///
/// let propeller = StockPropeller::default();
/// let counts: Vec<u64> = (0..4).map(|tick| propeller.count(tick, 0.05)).collect();
/// assert_eq!(counts, [21, 22, 21, 22]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StockPropeller {
    /// Particles thrown per second, N `[1/s]`.
    pub particles_per_second: u32,
    /// Diameter of a particle, d `[m]`, 0 to 1e6.
    pub diameter: f64,
    /// Density of a particle, ρ `[kg/m³]`, 0 to 1e9.
    pub density: f64,
    /// Torque about the axis over the velocity of the particles `[N·s]`, −1e9 to 1e9; the torque acts along −z for
    /// positive ones.
    pub torque_by_velocity: f64,
}

impl Default for StockPropeller {
    fn default() -> Self {
        Self { particles_per_second: 430, diameter: 0.005, density: 8500.0, torque_by_velocity: 0.002 }
    }
}

impl StockPropeller {
    /// Checks the fields against their ranges: one sentence for each that is out of range or not a number; empty if
    /// none is.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let mut out = Vec::new();
        out.extend(outside("diameter", self.diameter, (0.0, 1e6), "m"));
        out.extend(outside("density", self.density, (0.0, 1e9), "kg/m³"));
        out.extend(outside("torque_by_velocity", self.torque_by_velocity, (-1e9, 1e9), "N·s"));
        out
    }

    /// Mass of a particle, ρ π d³/6 `[kg]`.
    #[must_use]
    pub fn particle_mass(&self) -> f64 {
        let d = self.diameter;
        self.density * PI * (d * d * d) / 6.0
    }

    /// Number of whole particles thrown during base step `tick` (counted from 0) of length `step` `[s]`: ⌊N (tick + 1)
    /// step⌋ − ⌊N tick·step⌋, computed in integers. Zero for a `step` that is not positive and finite.
    #[must_use]
    pub fn count(&self, tick: u64, step: f64) -> u64 {
        let exact = ExactStep::new(step);
        let until = |n: u64| exact.whole(self.particles_per_second, n);
        u64::try_from(until(tick.saturating_add(1)).saturating_sub(until(tick))).unwrap_or(u64::MAX)
    }

    /// Mass flow during base step `tick` (counted from 0) of length `step` `[s]`: mass of its particles over `step`
    /// `[kg/s]`. Times the velocity of the particles it is the thrust of that step; zero for a step that is not
    /// positive.
    #[must_use]
    pub fn flow(&self, tick: u64, step: f64) -> f64 {
        if step > 0.0 { self.count(tick, step) as f64 * self.particle_mass() / step } else { 0.0 }
    }

    /// Thrust averaged over many steps, N m u `[N]`, at the `velocity` u of the particles `[m/s]`.
    #[must_use]
    pub fn mean_force(&self, velocity: f64) -> f64 {
        f64::from(self.particles_per_second) * self.particle_mass() * velocity
    }

    /// Torque on the airframe about the thrust axis (+z) `[N·m]` at the `velocity` of the particles `[m/s]`.
    #[must_use]
    pub fn torque<R: Real>(&self, velocity: R) -> R {
        R::splat(-self.torque_by_velocity) * velocity
    }
}
