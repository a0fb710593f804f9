//! Stiffness estimate: rates of springs and dampers, of joints and between points, which an explicit method must
//! resolve.
//!
//! For each degree of freedom with stiffness k, damping c and the inertia D that a torque on it meets with everything
//! beyond left free (`joint_inertias` in `recursions/aba.rs`), the rate is that of the faster root of D s² + c s + k
//! = 0. Coupling between joints is neglected, and D changes with the pose.

use crate::actuation::{MotorMode, SpringDamper};
use crate::constraint::implicit_forces::ImplicitForces;
use crate::model::Model;
use crate::recursions::aba::{factor_at_rest, joint_inertias};
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::state::State;

/// Stability limit of RK4 on the negative real axis: largest |h·λ| (dimensionless), for step h and root λ. Source: key
/// `hairer1996`, section IV.2.
pub const RK4_LIMIT: f64 = 2.785;

/// Element of a [`Stiffness`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StiffElement {
    /// Spring and damper of the degree of freedom of this index in v.
    Dof(usize),
    /// Spring and damper between two points, by its index in [`Model::spring_dampers`].
    SpringDamper(usize),
}

/// Element with the fastest dynamics, from [`stiffest`]: the one that limits the step of explicit methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Element that it is.
    pub element: StiffElement,
    /// Magnitude of the fastest root of its mass–spring–damper equation `[1/s]`.
    pub rate: f64,
    /// Stiffness `[N·m/rad]` or `[N/m]`.
    pub stiffness: f64,
    /// Damping `[N·m·s/rad]` or `[N·s/m]`.
    pub damping: f64,
    /// Inertia on which it acts, with all else free `[kg·m²]` or `[kg]`.
    pub inertia: f64,
}

impl Stiffness {
    fn new(element: StiffElement, stiffness: f64, damping: f64, inertia: f64) -> Self {
        Self { element, rate: fastest_root(inertia, damping, stiffness), stiffness, damping, inertia }
    }

    /// Description of the element for messages, with the name that the user gave it. `model` must be that of
    /// [`stiffest`].
    #[must_use]
    pub fn element_name(&self, model: &Model<f64>) -> String {
        match self.element {
            StiffElement::Dof(dof) => format!("joint `{}`", model.names().dof_name(dof)),
            StiffElement::SpringDamper(k) => format!("spring_damper `{}`", model.names().spring_dampers[k]),
        }
    }
}

/// Fastest spring or damper of `model` at a state, those of spring motors included; `None` if there is none. Joints
/// held by ideal velocity motors are left out.
#[must_use]
pub fn stiffest(model: &Model<f64>, state: &State<f64>) -> Option<Stiffness> {
    let inertias = joint_inertias(model, state);
    let held = |dof: usize| model.drives().iter().any(|d| d.dof == dof && model.drive_limit(d).is_none());
    let of_joints = model.dofs().iter().enumerate().filter(|(k, _)| !held(*k)).map(|(k, dof)| {
        let (mut stiffness, mut damping) = (dof.stiffness, dof.damping);
        for spring in model.nonlinear_springs.iter().filter(|spring| spring.dof == k) {
            let x = state.q[dof.q_idx as usize] - dof.rest;
            let (of_x, of_v) = spring.law.negated_partials(x, state.v[k]);
            stiffness += of_x.max(0.0);
            damping += of_v.max(0.0);
        }
        for motor in model.motors().iter().filter(|m| m.dof == k && m.mode == MotorMode::Spring) {
            stiffness += motor.stiffness;
            damping += motor.damping;
        }
        Stiffness::new(StiffElement::Dof(k), stiffness, damping, inertias[k])
    });
    let each = of_joints.chain(of_lines(model, state));
    each.filter(|s| s.rate > 0.0).max_by(|a, b| a.rate.total_cmp(&b.rate))
}

/// Springs and dampers between two points, with everything between them left free.
fn of_lines(model: &Model<f64>, state: &State<f64>) -> Vec<Stiffness> {
    let Some(mut forces) = ImplicitForces::new(model) else { return Vec::new() };
    let (mut scratch, rest) = (Scratch::new(model), vec![0.0; model.n_v()]);
    kinematics::motions(model, &state.q, &state.v, &rest, &mut scratch);
    let of_element = |element: &SpringDamper<f64>| element.line(|link| (scratch.links[link].v, scratch.poses[link]));
    let lines: Vec<_> = model.spring_dampers.iter().map(of_element).collect();
    factor_at_rest(model, state, &mut scratch);
    forces.place(model, &lines, &scratch, &rest);
    forces.factor(model, &scratch, lines.iter().map(|_| 1.0), &rest);
    let each = model.spring_dampers.iter().zip(&lines).zip(forces.inverse_inertias()).enumerate();
    each.filter(|(_, (_, inverse))| *inverse > 0.0)
        .map(|(k, ((element, line), inverse))| {
            let (stiffness, damping) = element.implicit_terms(line.length, line.rate);
            Stiffness::new(StiffElement::SpringDamper(k), stiffness, damping, 1.0 / inverse)
        })
        .collect()
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
