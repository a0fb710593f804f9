//! Stiffness estimate: rates of springs and dampers of joints, which an explicit method must resolve.
//!
//! For each degree of freedom with stiffness k, damping c and the inertia D that a torque on it meets with everything
//! beyond left free ([`crate::recursions::aba::joint_inertias`]), the rate is that of the faster root of D s² + c s + k
//! = 0. Coupling between joints is neglected, and D changes with the pose.

use crate::actuation::MotorMode;
use crate::model::Model;
use crate::recursions::aba::joint_inertias;
use crate::state::State;

/// |h·λ| up to which RK4 is stable on the negative real axis. Source: key `hairer1996`, section IV.2.
pub const RK4_LIMIT: f64 = 2.785;

/// The fastest degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// The degree of freedom.
    pub dof: usize,
    /// Magnitude of the fastest root [1/s].
    pub rate: f64,
    /// Stiffness on it [N·m/rad] or [N/m].
    pub stiffness: f64,
    /// Damping on it [N·m·s/rad] or [N·s/m].
    pub damping: f64,
    /// Inertia it acts on [kg·m²] or `[kg]`.
    pub inertia: f64,
}

/// Fastest spring or damper at a state, with its rate `[1/s]`; none if there is none. Joints with ideal velocity motors
/// are left out.
#[must_use]
pub fn stiffest(model: &Model<f64>, state: &State<f64>) -> Option<Stiffness> {
    let inertias = joint_inertias(model, state);
    let held = |dof: usize| model.drives().iter().any(|d| d.dof == dof && model.drive_limit(d).is_none());
    let each = model.dofs().iter().enumerate().filter(|(k, _)| !held(*k)).map(|(k, dof)| {
        let (mut stiffness, mut damping) = (dof.stiffness, dof.damping);
        for motor in model.motors().iter().filter(|m| m.dof == k && m.mode == MotorMode::Spring) {
            stiffness += motor.stiffness;
            damping += motor.damping;
        }
        let inertia = inertias[k];
        Stiffness { dof: k, rate: fastest_root(inertia, damping, stiffness), stiffness, damping, inertia }
    });
    each.filter(|s| s.rate > 0.0).max_by(|a, b| a.rate.total_cmp(&b.rate))
}

/// Magnitude of the larger root of D s² + c s + k.
fn fastest_root(inertia: f64, damping: f64, stiffness: f64) -> f64 {
    let half = 0.5 * damping / inertia;
    let discriminant = half * half - stiffness / inertia;
    if discriminant > 0.0 { half + discriminant.sqrt() } else { (stiffness / inertia).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_an_oscillator_and_of_an_overdamped_one() {
        assert!((fastest_root(2.0, 0.0, 18.0) - 3.0).abs() < 1e-15);
        // s² + 5 s + 4 = (s + 1)(s + 4)
        assert!((fastest_root(1.0, 5.0, 4.0) - 4.0).abs() < 1e-15);
    }
}
