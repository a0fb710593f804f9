//! Rotors: what a turning propeller does to the hub that carries it.
//!
//! | rotor | thrust | for |
//! |---|---|---|
//! | [`Rotor`] | blade elements in the flow that momentum theory gives | flight: climb, descent, forward speed |
//! | [`ConstantCoefficients`] | b Ω·abs(Ω) | control design near hover |
//! | [`CoefficientTable`] | measured coefficients over advance ratio | propellers from a data sheet |
//! | [`StockPropeller`] | particles a second × their momentum | V-REP's propeller, as it was |
//! | [`printed`] | a published script with its defects | comparison only |
//!
//! Axes of a rotor: z along the thrust axis, x and y in the disc. The velocity that a rotor takes is that of its hub
//! relative to the air, so climb is positive and wind is subtracted beforehand; the turning of the body about its own
//! centre (ω × r) is part of it. Loads are functions of one instant: nothing is stored, all power comes from the shaft.

mod blade;
mod coefficients;
mod momentum;
mod mounted;
pub mod printed;
mod stock;

pub use blade::{Drag, Rotor, RotorSpec, Validity};
pub use coefficients::{CoefficientTable, ConstantCoefficients, TableRow};
pub use mounted::{Hub, MountedRotor, RotorLaw, SpeedSource};
pub use printed::PrintedScript;
pub use stock::StockPropeller;

use sincro_math::Real;

/// Sense of rotation of a rotor at positive speed, seen from above (against the thrust axis, which is z of the rotor).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Spin {
    /// Counter-clockwise: the angular velocity is along +z, the reaction along −z.
    CounterClockwise,
    /// Clockwise: the angular velocity is along −z, the reaction along +z.
    Clockwise,
}

impl Spin {
    /// Sign of the sense of rotation (dimensionless): +1 counter-clockwise, −1 clockwise.
    #[inline(always)]
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::CounterClockwise => 1.0,
            Self::Clockwise => -1.0,
        }
    }
}

/// Load of a rotor at one instant: what it exerts on the airframe, in rotor axes (z along the thrust, x and y in the
/// disc), and the power of its shaft. [`MountedRotor::wrench`] turns it into a wrench on the link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load<R> {
    /// Force on the hub along +z `[N]`.
    pub thrust: R,
    /// Reaction torque on the airframe about +z `[N·m]`; against the sense of rotation while the shaft drives the
    /// rotor.
    pub torque: R,
    /// Inflow: velocity of the air through the disc relative to the hub, positive along −z `[m/s]`, climb and induced
    /// velocity together; 0 where the law has none.
    pub inflow: R,
    /// Gyroscopic moment on the airframe about the rotor's x and y axes, in this order `[N·m]`; 0 where the rotor has
    /// no inertia.
    pub gyroscopic: [R; 2],
    /// Power that the shaft delivers to the air `[W]`; negative in a windmill. 0 of [`StockPropeller`].
    pub power: R,
}

/// Limit of hub velocities `[m/s]` and rotor speeds `[rad/s]` in [`Rotor::evaluate`]: larger ones count as this one,
/// because their squares and cubes would overflow. No physics reaches it; it only keeps loads finite.
pub const MAX_VELOCITY: f64 = 1e60;

/// `x` limited to ±[`MAX_VELOCITY`]; what is not finite becomes NaN, because a limit hides no failure.
#[inline(always)]
fn limited<R: Real>(x: R) -> R {
    // 0·x is 0 for a finite number and NaN for all others
    x.clamp_abs(R::splat(MAX_VELOCITY)) + R::zero() * x
}

/// Describes a number outside of [least, most]; none if it is within. `unit` may be empty.
fn outside(name: &str, x: f64, (least, most): (f64, f64), unit: &str) -> Option<String> {
    let within = x >= least && x <= most;
    let gap = if unit.is_empty() { "" } else { " " };
    (!within).then(|| format!("`{name}` is {x}{gap}{unit}: expected a number from {least} to {most}{gap}{unit}"))
}
