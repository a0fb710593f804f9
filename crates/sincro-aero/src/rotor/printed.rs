//! A published script for the same rotor, with its defects: to compare against, never to fly with.
//!
//! Source: key `morales2019`, section 6.1.2, line by line; NaN where the script gives NaN. What is wrong in it,
//! compared with [`super::Rotor`], whose equations it means to solve by Ferrari's closed form:
//!
//! 1. The thrust axis is the third row of the rotation matrix; it is the third column.
//! 2. The sign of a term of A₃; 3. the resolvent's b₁ and b₂; 4. d₃ lacks A₁. All three are harmless without forward
//!    speed only: there the thrust is right, else it is too small by up to a half, or NaN.
//! 5. The induced torque lacks the factor 2x. 6. The torque has no sense of rotation.
//! 7. At Ω = 0 it divides by zero. 8. At Ω < 0 it takes climb for descent.
//! 9. In fast climb (or for a slow rotor) the root jumps to another branch.
//!
//! Symbols are the script's: x inflow ratio, μ and ν in-plane and axial ratio, all by ΩR.

use core::f64::consts::PI;

use sincro_math::Real;
use sincro_math::elementary::{Binary, asin};

use super::{Load, RotorSpec};
use sincro_geometry::spatial::{Mat3, Vec3};
use sincro_math::error::InvalidParameters;

/// Rotor computed by the published script, defects included; made by [`PrintedScript::new`] from the numbers of a
/// blade-element rotor. For comparison with [`super::Rotor`] only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedScript(RotorSpec);

/// Results of [`evaluate`]: thrust, torque, and the dimensionless ratios that the script computes on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printed<R> {
    /// Thrust along the (mistaken) axis of the script `[N]`.
    pub thrust: R,
    /// Torque, without sense of rotation `[N·m]`.
    pub torque: R,
    /// Inflow ratio x, inflow over tip velocity ΩR (dimensionless).
    pub inflow_ratio: R,
    /// Thrust coefficient c_T = T/(ρ A (ΩR)²) (dimensionless).
    pub thrust_coefficient: R,
    /// Torque coefficient c_Q = Q/(ρ A (ΩR)² R) (dimensionless).
    pub torque_coefficient: R,
}

impl PrintedScript {
    /// Creates the script's rotor with the numbers of `spec`; the script ignores its `spin`.
    ///
    /// # Errors
    ///
    /// [`InvalidParameters`] with one sentence for each number of `spec` that [`super::Rotor::new`] refuses.
    pub fn new(spec: RotorSpec) -> Result<Self, InvalidParameters> {
        super::Rotor::new(spec).map(|rotor| Self(*rotor.spec()))
    }

    /// Load by the script in air of `density` `[kg/m³]`, at `speed` `[rad/s]`, with the hub moving at `velocity`
    /// `[m/s]` relative to the air, in world axes, and the `rotation` from rotor to world axes.
    ///
    /// The torque `[N·m]` acts on the airframe about the thrust axis, positive whatever the spin, as the script has it;
    /// power `[W]` is torque times speed. NaN where the script gives NaN.
    #[inline(always)]
    pub fn load<R: Real>(&self, density: f64, speed: R, velocity: Vec3<R>, rotation: &Mat3<R>) -> Load<R> {
        let out = evaluate(&self.0, density, speed, velocity, rotation);
        let inflow = out.inflow_ratio * speed * R::splat(self.0.radius);
        Load { thrust: out.thrust, torque: out.torque, inflow, power: out.torque * speed, gyroscopic: [R::zero(); 2] }
    }
}

/// Evaluates the script in air of `density` `[kg/m³]` at `speed` `[rad/s]`, for a hub moving at `velocity` `[m/s]`
/// relative to the air, in world axes; `rotation` turns body axes to world axes. NaN where the script divides by zero
/// (Ω = 0) or takes the root of a negative number.
#[must_use]
#[inline(always)]
pub fn evaluate<R: Real>(
    rotor: &RotorSpec,
    density: f64,
    speed: R,
    velocity: Vec3<R>,
    rotation: &Mat3<R>,
) -> Printed<R> {
    let c = R::splat;
    let radius = rotor.radius;
    let sigma = f64::from(rotor.n_blades) * rotor.chord / (PI * radius);
    let k1 = sigma * rotor.lift_slope / 8.0;
    let pitch = rotor.collective_pitch;
    // defect 1: the third row
    let axial = velocity.dot(rotation.row(2));
    let total = velocity.dot(velocity).sqrt();
    let (sin, cos) = (axial / (total + c(1e-6))).map(asin).sin_cos();
    let ratio = total / (speed * c(radius));
    let (mu, nu) = (ratio * cos, ratio * sin);
    let k2 = c(k1 * pitch) * (c(2.0 / 3.0) + mu * mu);
    let x = inflow_ratio(mu, nu, ratio, c(k1), k2);
    let c_t = c(2.0) * (k2 - c(k1) * x);
    // defect 5: the middle term without 2x
    let c_q = c(sigma * (rotor.drag.cd0 + rotor.drag.k_cd * (pitch * pitch))) * (c(1.0) + mu * mu) / c(8.0)
        + c(2.0 * k1) * (c(pitch / 3.0) - x / c(2.0))
        + c(0.25 * sigma * rotor.drag.k_cd) * x * (x - c(4.0 * pitch / 3.0));
    let tip = speed * c(radius);
    let by_coefficient = c(density * (PI * radius * radius)) * (tip * tip);
    Printed {
        thrust: by_coefficient * c_t,
        torque: c_q * by_coefficient * c(radius),
        inflow_ratio: x,
        thrust_coefficient: c_t,
        torque_coefficient: c_q,
    }
}

/// The quartic x⁴ + 2A₁x³ + A₂x² + 2A₃x + A₄ = 0, as the script solves it.
#[inline(always)]
fn inflow_ratio<R: Real>(mu: R, nu: R, ratio: R, k1: R, k2: R) -> R {
    let c = R::splat;
    let (mu2, k2k2) = (mu * mu, k2 * k2);
    let a1 = -nu;
    let a2 = ratio * ratio - k1 * k1;
    let a3 = nu * mu2 + k1 * k2; // defect 2
    let a4 = nu * nu * mu2 - k2k2;
    let b1 = c(0.5) * (a1 * a1 + a2 - c(1.0)); // defect 3
    let b2 = a3 - b1;
    let b3 = c(0.5) * (a2 * a4 - a1 * a1 * a4 - a3 * a3);
    let c1 = b1 * b1 - c(3.0) * b2;
    let c2 = c(2.0) * (b1 * b1 * b1) - c(9.0) * b1 * b2 + c(27.0) * b3;
    // NaN below zero: of the discriminant, and of the power's base
    let base = c(0.5) * (c2 + (c2 * c2 - c(4.0) * (c1 * c1 * c1)).sqrt());
    let c3 = base.binary(Binary::Pow, c(1.0 / 3.0));
    let d1 = -(b1 + c3 + c1 / c3) / c(3.0);
    let d2 = (d1 * d1 - a4).sqrt();
    let d3 = (d1 - a3) / d2; // defect 4
    let aux = a1 * d3 - c(2.0) * d2;
    let sign = aux.if_less(R::zero(), c(-1.0), R::one());
    c(0.5) * (-a1 - d3 * sign + (a1 * a1 + d3 * d3 - c(4.0) * d1 + c(2.0) * aux.abs()).sqrt())
}
