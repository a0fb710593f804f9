//! Force elements: what pushes and brakes the bodies, each with its torque, its energy or its power.
//!
//! | element | torque on its joint | stores | takes |
//! |---|---|---|---|
//! | [`spring`] | −k (q − rest) | ½ k (q − rest)² | |
//! | [`damper`] | −c q̇ | | c q̇² |
//! | [`friction`] | ∓ limit, or whatever holds | | limit·|q̇| |
//! | [`motor`] | by mode | | −τ q̇ |
//! | [`applied`] | a signal of time | | −τ q̇ |
//! | [`gravity`] | through the base's acceleration | −m g·c | |

pub mod applied;
pub mod damper;
pub mod friction;
pub mod gravity;
pub mod motor;
pub mod spring;

pub use applied::{AppliedTorque, AppliedWrench};
pub use motor::{Motor, MotorMode};

use sincro_math::Real;

use crate::model::Model;

/// Joint torques of all elements at one instant, and what they add to the mass matrix in a linearly implicit step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant<'a, R> {
    pub t: f64,
    pub q: &'a [R],
    pub v: &'a [R],
    pub commands: &'a [R],
    pub drives: &'a [R],
    /// Step of a linearly implicit method: springs are taken at q + h·v + h·(new − old velocity), dampers at the new velocity.
    pub implicit_step: Option<f64>,
}

/// Sums the torques of all joint elements into `torque` and the diagonal (armature and implicit terms) into `diagonal`.
#[inline(always)]
pub(crate) fn joint_torques<R: Real>(model: &Model<R>, at: &Instant<'_, R>, torque: &mut [R], diagonal: &mut [R]) {
    let h = R::splat(at.implicit_step.unwrap_or(0.0));
    for (k, dof) in model.dofs.iter().enumerate() {
        let v = at.v[k];
        // at h = 0 this is the explicit torque
        let deflection = if model.has_scalar_coordinate(k) { at.q[dof.q_idx as usize] + h * v } else { dof.rest };
        torque[k] = (dof.torque + spring::torque(dof, deflection)) + damper::torque(dof, v);
        diagonal[k] = dof.armature + h * (dof.damping + h * dof.stiffness);
    }
    for applied in &model.applied {
        torque[applied.dof] += applied.torque(at.t);
    }
    for (motor, &command) in model.motors.iter().zip(at.commands) {
        let k = motor.dof;
        let q = at.q[model.dofs[k].q_idx as usize];
        let (tau, implicit) = motor.torque(q, at.v[k], command, h);
        torque[k] += tau;
        diagonal[k] += implicit;
    }
    for (drive, &pull) in model.drives.iter().zip(at.drives) {
        // a holding drive (0) gives what its constraint needs; the others pull at their limit
        if let Some(limit) = drive.limit(model) {
            torque[drive.dof] += pull * limit;
        }
    }
}
