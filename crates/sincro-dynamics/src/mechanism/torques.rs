//! Sum of the joint torques of all elements at one instant, and their terms in the diagonal of a linearly implicit
//! step.

use sincro_math::Real;

use crate::actuation::spring_damper::PathLength;
use crate::actuation::{damper, spring};
use crate::integrate::Implicit;
use crate::joint::WORLD;
use crate::model::Model;

/// State at which joint torques are evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TorqueInput<'a, R> {
    pub t: f64,
    pub q: &'a [R],
    pub v: &'a [R],
    pub commands: &'a [R],
    pub drives: &'a [R],
    /// States of elements, of which those of windings are currents `[A]`.
    pub elements: &'a [R],
    /// Forces that the bearings of joints transmit, where friction grows with them `[N]`.
    pub loads: &'a [R],
    /// Step of a linearly implicit method, and which terms it takes at the new state; none: all at this one.
    pub implicit: Option<(f64, Implicit)>,
    /// False if the joints have linear springs, dampers, functions of time, motors and drives alone: the lists of all
    /// other elements are empty and need not be looked at.
    pub has_special: bool,
}

/// Sums the torques of all joint elements into `torque` and the diagonal (armature and implicit terms) into `diagonal`.
#[inline(always)]
pub(crate) fn joint_torques<R: Real>(model: &Model<R>, at: &TorqueInput<'_, R>, torque: &mut [R], diagonal: &mut [R]) {
    // at h = 0 these are the explicit torques
    let (of_dampers, of_springs) = at.implicit.map_or((0.0, 0.0), |(h, implicit)| implicit.steps(h));
    let steps = (R::splat(of_dampers), R::splat(of_springs));
    let n = model.dofs.len();
    let (v, torque, diagonal) = (&at.v[..n], &mut torque[..n], &mut diagonal[..n]);
    for (k, dof) in model.dofs.iter().enumerate() {
        let v = v[k];
        // spring at q + h v⁺, damper at v⁺: what is known now to the right-hand side, the rest to the diagonal
        let spring_at = if dof.q_idx == WORLD { dof.rest } else { at.q[dof.q_idx as usize] + steps.1 * v };
        torque[k] = (dof.torque + spring::torque(dof, spring_at)) + damper::torque(dof, v);
        diagonal[k] = dof.armature + steps.0 * (dof.damping + steps.1 * dof.stiffness);
    }
    for &link in &model.sprung {
        let k = model.links[link].v_idx as usize;
        spring::add_torques(&model.links[link], &model.dofs[k..], (at.q, &at.v[k..]), steps.1, &mut torque[k..]);
    }
    if at.has_special {
        special_torques(model, at, steps, torque, diagonal);
    }
    for applied in &model.applied {
        torque[applied.dof] += applied.torque(at.t);
    }
    for (motor, &command) in model.params.motors.iter().zip(at.commands) {
        let k = motor.dof;
        let q = model.dofs[k].coordinate_in(at.q);
        let (tau, implicit) = motor.torque(q, at.v[k], command, steps);
        torque[k] += tau;
        diagonal[k] += implicit;
    }
    if at.has_special {
        winding_torques(model, at, steps, torque, diagonal);
    }
    for (drive, &saturation) in model.params.drives.iter().zip(at.drives) {
        // a locked drive (0) gives the reaction of its constraint; a saturated one its limit
        if let Some(limit) = model.saturated_torque(drive, at.v[drive.dof], at.loads[drive.dof]) {
            torque[drive.dof] += saturation * limit;
        }
    }
}

/// Adds the torques of nonlinear springs, elastic gears and fixed tendons.
#[inline(always)]
fn special_torques<R: Real>(
    model: &Model<R>,
    at: &TorqueInput<'_, R>,
    steps: (R, R),
    torque: &mut [R],
    diagonal: &mut [R],
) {
    for spring in &model.nonlinear_springs {
        let (k, dof) = (spring.dof, &model.dofs[spring.dof]);
        let (tau, implicit) = spring.implicit_torque(dof, at.q[dof.q_idx as usize], at.v[k], steps);
        torque[k] += tau;
        diagonal[k] += implicit;
    }
    for gear in &model.elastic_gears {
        let (x, rate) = gear.error(at.q, at.v);
        let (k, _) = gear.implicit_terms(x, rate);
        // spring at x + h ẋ: what is known now; the rest couples two degrees of freedom
        let tau = gear.torque(x, rate) - steps.1 * k * rate;
        torque[gear.dofs[1]] += tau;
        torque[gear.dofs[0]] -= gear.ratio * tau;
    }
    for element in &model.spring_dampers {
        let shares = element.shares();
        if shares.is_empty() {
            continue;
        }
        let PathLength { length, rate } = PathLength::of_joints(shares, at.q, at.v);
        let (k, _) = element.implicit_terms(length, rate);
        let force = element.forces(length, rate, at.commands).total() - steps.1 * k * rate;
        for share in shares {
            torque[share.dof] += share.coefficient * force;
        }
    }
}

/// Adds the torques of windings whose motors take a voltage.
#[inline(always)]
fn winding_torques<R: Real>(
    model: &Model<R>,
    at: &TorqueInput<'_, R>,
    steps: (R, R),
    torque: &mut [R],
    diagonal: &mut [R],
) {
    for winding in model.active_windings() {
        let (k, state, command) = (winding.dof, winding.state_in(at.elements), at.commands[winding.motor]);
        let (tau, implicit) = winding.torque(state, at.v[k], command, steps.0);
        torque[k] += tau;
        diagonal[k] += implicit;
    }
}
