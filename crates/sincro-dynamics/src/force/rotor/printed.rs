//! A published script for the same rotor, with its defects: to compare against, never to fly with.
//!
//! Source: key `morales2019`, section 6.1.2, line by line; NaN where the script gives NaN. What is wrong in it, compared with
//! [`super::Rotor`], whose equations it means to solve by Ferrari's closed form:
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

use sincro_math::elementary::{asin, pow, sin_cos};

use super::RotorSpec;

/// What the script returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printed {
    /// `[N]`
    pub thrust: f64,
    /// [N·m], always positive
    pub torque: f64,
    /// Inflow ratio x.
    pub inflow_ratio: f64,
    /// C_T
    pub thrust_coefficient: f64,
    /// C_Q
    pub torque_coefficient: f64,
}

/// The script at `speed` [rad/s] for a hub moving at `velocity` [m/s] in the world, with `rotation` (rows) from body to world.
#[must_use]
pub fn evaluate(rotor: &RotorSpec, density: f64, speed: f64, velocity: [f64; 3], rotation: [[f64; 3]; 3]) -> Printed {
    let radius = rotor.radius;
    let sigma = f64::from(rotor.n_blades) * rotor.chord / (PI * radius);
    let k1 = sigma * rotor.lift_slope / 8.0;
    let pitch = rotor.collective_pitch;
    // defect 1: the third row
    let [vx, vy, vz] = velocity;
    let [rx, ry, rz] = rotation[2];
    let axial = vx * rx + vy * ry + vz * rz;
    let total = (vx * vx + vy * vy + vz * vz).sqrt();
    let (sin, cos) = sin_cos(asin(axial / (total + 1e-6)).0);
    let ratio = total / (speed * radius);
    let (mu, nu) = (ratio * cos, ratio * sin);
    let k2 = k1 * pitch * (2.0 / 3.0 + mu * mu);
    let x = inflow_ratio(mu, nu, ratio, k1, k2);
    let c_t = 2.0 * (k2 - k1 * x);
    // defect 5: the middle term without 2x
    let c_q = sigma * (rotor.drag.cd0 + rotor.drag.k_cd * (pitch * pitch)) * (1.0 + mu * mu) / 8.0
        + 2.0 * k1 * (pitch / 3.0 - x / 2.0)
        + 0.25 * sigma * rotor.drag.k_cd * x * (x - 4.0 * pitch / 3.0);
    let tip = speed * radius;
    let by_coefficient = density * (PI * radius * radius) * (tip * tip);
    Printed {
        thrust: by_coefficient * c_t,
        torque: c_q * by_coefficient * radius,
        inflow_ratio: x,
        thrust_coefficient: c_t,
        torque_coefficient: c_q,
    }
}

/// The quartic x⁴ + 2A₁x³ + A₂x² + 2A₃x + A₄ = 0, as the script solves it.
fn inflow_ratio(mu: f64, nu: f64, ratio: f64, k1: f64, k2: f64) -> f64 {
    let (mu2, k2k2) = (mu * mu, k2 * k2);
    let a1 = -nu;
    let a2 = ratio * ratio - k1 * k1;
    let a3 = nu * mu2 + k1 * k2; // defect 2
    let a4 = nu * nu * mu2 - k2k2;
    let b1 = 0.5 * (a1 * a1 + a2 - 1.0); // defect 3
    let b2 = a3 - b1;
    let b3 = 0.5 * (a2 * a4 - a1 * a1 * a4 - a3 * a3);
    let c1 = b1 * b1 - 3.0 * b2;
    let c2 = 2.0 * (b1 * b1 * b1) - 9.0 * b1 * b2 + 27.0 * b3;
    // NaN below zero: of the discriminant, and of the power's base
    let c3 = pow(0.5 * (c2 + (c2 * c2 - 4.0 * (c1 * c1 * c1)).sqrt()), 1.0 / 3.0).0;
    let d1 = -(b1 + c3 + c1 / c3) / 3.0;
    let d2 = (d1 * d1 - a4).sqrt();
    let d3 = (d1 - a3) / d2; // defect 4
    let aux = a1 * d3 - 2.0 * d2;
    let sign = if aux < 0.0 { -1.0 } else { 1.0 };
    0.5 * (-a1 - d3 * sign + (a1 * a1 + d3 * d3 - 4.0 * d1 + 2.0 * aux.abs()).sqrt())
}
