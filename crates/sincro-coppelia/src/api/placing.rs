//! Bodies that joints carry, put where their joints can bring them.
//!
//! Scripts of V-REP restore a robot by giving every object below its base the pose that it began with. A body that a
//! revolute or prismatic joint carries goes there by its joint; where that cannot bring it, it is refused.

use std::f64::consts::TAU;

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::JointInfo;
use sincro_dynamics::spatial::{Pose, Vec3, rotation_between};
use sincro_math::elementary::atan2;

use super::registry::{Entry, Handle};
use super::{ApiError, Reference, SimApi};

/// Distance `[m]` and angle `[rad]` from the pose that a joint can bring a body to.
const TOLERANCE: f64 = 1e-6;
/// Distance `[m]` and angle `[rad]` between poses that are taken for the same: rounding of a way through other
/// parametrizations.
const SAME: f64 = 1e-9;
/// Excess over a limit `[rad]` or `[m]` that is put down to the drift of its constraint.
const LIMIT_SLACK: f64 = 1e-4;

impl SimApi<'_> {
    /// Returns true if an object stands at a pose in the world already, but for rounding.
    pub(super) fn stands_at(&mut self, handle: Handle, x_wo: &Pose<f64>) -> Result<bool, ApiError> {
        let here = self.pose(handle, Reference::World)?;
        let is_there = (x_wo.pos - here.pos).norm() <= SAME * (1.0 + here.pos.norm());
        Ok(is_there && rotation_between(&here.rot, &x_wo.rot).norm() <= SAME)
    }

    /// Brings a body to a pose in the world by the revolute or prismatic joint that carries it; the joint is at rest
    /// then. A pose whose position or orientation is the present one asks for the other alone. Of the angles of a
    /// revolute joint that differ by full turns it takes the one within its limits that is nearest to the initial angle
    /// of the scene. Returns false if no such joint carries the body.
    ///
    /// # Errors
    ///
    /// The joint cannot bring it there, or not within its limits.
    pub(super) fn bring_by_joint(&mut self, entry: &Entry, x_wo: &Pose<f64>) -> Result<bool, ApiError> {
        let one_axis = |kind: &JointKind| matches!(kind, JointKind::Revolute { .. } | JointKind::Prismatic { .. });
        let joints = &self.world.model().names().joints;
        let carrier = joints.iter().find(|j| entry.frame.link.is_some() && j.moving.link == entry.frame.link);
        let Some(carrier) = carrier.filter(|joint| one_axis(&joint.kind)).cloned() else { return Ok(false) };
        let (JointKind::Revolute { axis } | JointKind::Prismatic { axis }) = carrier.kind else { return Ok(false) };
        let (x_wb, x_wj) = (self.pose(entry.handle, Reference::World)?, self.place(&carrier.moving));
        let axis = x_wj.rot.mul_vec(Vec3(axis));
        let axis = axis.scale(1.0 / axis.norm());
        let change = if matches!(carrier.kind, JointKind::Revolute { .. }) {
            turn_to(&axis, x_wj.pos, &x_wb, x_wo)
        } else {
            slide_to(&axis, &x_wb, x_wo)
        };
        let change = change.ok_or_else(|| {
            let help = "the joint that carries it cannot bring it there: set the positions of the joints";
            ApiError(format!("`{}` cannot be put anywhere: {help}", entry.path))
        })?;
        let position = self.position_after(&carrier, change).ok_or_else(|| {
            let beyond = self.world.state.q[carrier.q_idx] + change;
            ApiError(format!("`{}` cannot be put there: its joint would be at {beyond}, beyond its limits", entry.path))
        })?;
        self.count_as_work(|sim| {
            sim.world.state.q[carrier.q_idx] = position;
            sim.world.state.v[carrier.v_idx] = 0.0;
        });
        Ok(true)
    }

    /// Position of a revolute or prismatic joint after a change: within its limits and, of a revolute one, nearest to
    /// the initial one of the scene. None if it would be beyond its limits.
    fn position_after(&self, joint: &JointInfo, change: f64) -> Option<f64> {
        let q = self.world.state.q[joint.q_idx];
        if change.abs() <= SAME {
            // it stays, however many turns it has made
            return Some(q);
        }
        let limits = &self.world.model().constraints().limits;
        let bound = |sign: f64| limits.iter().find(|l| l.dof == joint.v_idx && l.sign == sign).map(|l| l.bound);
        let range = [bound(1.0).unwrap_or(f64::NEG_INFINITY), bound(-1.0).unwrap_or(f64::INFINITY)];
        let period = if matches!(joint.kind, JointKind::Revolute { .. }) { TAU } else { 0.0 };
        nearest_within(q + change, period, self.registry.scene().initial.q[joint.q_idx], range)
    }
}

/// Value `position + k · period` within a range that is nearest to `start`; none if no such value is within it. A
/// period of 0 leaves `position` alone.
fn nearest_within(position: f64, period: f64, start: f64, [lower, upper]: [f64; 2]) -> Option<f64> {
    let is_within = |x: &f64| *x >= lower - LIMIT_SLACK && *x <= upper + LIMIT_SLACK;
    let n_periods = if period > 0.0 { ((start - position) / period).round() } else { 0.0 };
    let candidates = [0.0, -1.0, 1.0].map(|k| position + (n_periods + k) * period);
    candidates.into_iter().filter(is_within).min_by(|a, b| (a - start).abs().total_cmp(&(b - start).abs()))
}

/// Angle `[rad]` about an axis through a point that turns one pose into the other; none if no angle does.
fn turn_to(axis: &Vec3<f64>, through: Vec3<f64>, from: &Pose<f64>, to: &Pose<f64>) -> Option<f64> {
    let across = |p: Vec3<f64>| p - axis.scale(axis.dot(p));
    let (u, w) = (across(from.pos - through), across(to.pos - through));
    let turn = rotation_between(&from.rot, &to.rot);
    let is_turned = turn.norm() > SAME;
    let is_moved = (to.pos - from.pos).norm() > SAME;
    let angle = if is_turned { axis.dot(turn) } else { atan2(axis.dot(u.cross(w)), u.dot(w)).0 };
    let (sin, cos) = sincro_math::elementary::sin_cos(angle);
    let reached = u.scale(cos) + axis.cross(u).scale(sin);
    let is_along = axis.dot(to.pos - from.pos).abs() <= TOLERANCE;
    let is_position_met = !is_moved || is_along && (reached - w).norm() <= TOLERANCE;
    let is_orientation_met = !is_turned || (turn - axis.scale(angle)).norm() <= TOLERANCE;
    (is_position_met && is_orientation_met).then_some(angle)
}

/// Displacement `[m]` along an axis that brings one pose to the other; none if no displacement does.
fn slide_to(axis: &Vec3<f64>, from: &Pose<f64>, to: &Pose<f64>) -> Option<f64> {
    let way = to.pos - from.pos;
    let along = axis.dot(way);
    let is_met =
        (way - axis.scale(along)).norm() <= TOLERANCE && rotation_between(&from.rot, &to.rot).norm() <= TOLERANCE;
    is_met.then_some(along)
}
