//! V-REP's stock propeller: a jet of imaginary particles.
//!
//! Each step it throws n whole particles of mass m = ρ π d³/6 downwards with velocity u; the force over a step of length
//! Δt is n m u/Δt, the torque −0.002 u. The particles are N a second, and what is left of one is carried to the next
//! step, so n flutters by one from step to step; the mean force is N m u.
//!
//! Source: key `morales2019`, section 6.1.1, and the child script of V-REP's model of a propeller.
//!
//! Ours deviates in the carry: with times in whole nanoseconds, n = ⌊N t₂⌋ − ⌊N t₁⌋ in integers, so that the particles up to
//! t are ⌊N t⌋ exactly, after a year as after a second, and there is no carry to store.

use core::f64::consts::PI;

use super::outside;

/// Nanoseconds in a second.
const SECOND: u128 = 1_000_000_000;

/// The propeller; [`StockPropeller::default`] has V-REP's numbers.
///
/// ```
/// use sincro_dynamics::force::rotor::StockPropeller;
///
/// let propeller = StockPropeller::default();
/// let step = 50_000_000; // 50 ms
/// let counts: Vec<u64> = (0..4).map(|k| propeller.count(k * step, (k + 1) * step)).collect();
/// assert_eq!(counts, [21, 22, 21, 22]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StockPropeller {
    /// Particles a second, N.
    pub particles_per_second: u32,
    /// Diameter of a particle d `[m]`.
    pub diameter: f64,
    /// Density of a particle ρ [kg/m³].
    pub density: f64,
    /// Torque about the axis by velocity of the particles, as a magnitude [N·s].
    pub torque_by_velocity: f64,
}

impl Default for StockPropeller {
    fn default() -> Self {
        Self { particles_per_second: 430, diameter: 0.005, density: 8500.0, torque_by_velocity: 0.002 }
    }
}

impl StockPropeller {
    /// What is wrong with the numbers, one sentence each; empty if nothing is.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let mut out = Vec::new();
        out.extend(outside("diameter", self.diameter, (0.0, 1e6), "m"));
        out.extend(outside("density", self.density, (0.0, 1e9), "kg/m³"));
        out.extend(outside("torque_by_velocity", self.torque_by_velocity, (-1e9, 1e9), "N·s"));
        out
    }

    /// Mass of a particle ρ π d³/6 `[kg]`.
    #[must_use]
    pub fn particle_mass(&self) -> f64 {
        let d = self.diameter;
        self.density * PI * (d * d * d) / 6.0
    }

    /// Particles thrown from `from` to `to`, times since the start in nanoseconds; none if time does not advance.
    #[must_use]
    pub fn count(&self, from: u64, to: u64) -> u64 {
        // at most 2³² · 2⁶⁴ / 10⁹ < 2⁶⁷ would not fit; a propeller that long at work has lost count
        let until = |t: u64| u128::from(self.particles_per_second) * u128::from(t) / SECOND;
        u64::try_from(until(to).saturating_sub(until(from))).unwrap_or(u64::MAX)
    }

    /// Force along the axis `[N]` over a step of `step` nanoseconds in which `count` particles are thrown at `velocity`
    /// [m/s]; zero for a step of no length.
    #[must_use]
    pub fn force(&self, count: u64, step: u64, velocity: f64) -> f64 {
        if step == 0 {
            return 0.0;
        }
        (count as f64) * self.particle_mass() * velocity / (step as f64 * 1e-9)
    }

    /// Mean force along the axis `[N]` at `velocity` [m/s].
    #[must_use]
    pub fn mean_force(&self, velocity: f64) -> f64 {
        f64::from(self.particles_per_second) * self.particle_mass() * velocity
    }

    /// Torque about the axis [N·m] at `velocity` [m/s].
    #[must_use]
    pub fn torque(&self, velocity: f64) -> f64 {
        -self.torque_by_velocity * velocity
    }
}
