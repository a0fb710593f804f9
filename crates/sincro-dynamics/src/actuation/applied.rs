//! Torques and wrenches that are given functions of time, evaluated inside the step.

use sincro_math::Real;

use crate::signal::Signal;
use crate::spatial::{Force, Pose, Vec3};

/// A torque [N·m] or force `[N]` on one degree of freedom.
#[derive(Clone, Debug)]
pub struct AppliedTorque {
    /// Degree of freedom.
    pub dof: usize,
    /// One signal a lane.
    pub signal: Vec<Signal>,
}

impl AppliedTorque {
    /// Value at time `t` `[s]`.
    #[inline(always)]
    pub fn torque<R: Real>(&self, t: f64) -> R {
        value(&self.signal, t)
    }
}

/// A force and a torque at a point of a link.
#[derive(Clone, Debug)]
pub struct AppliedWrench<R> {
    /// The link.
    pub link: usize,
    /// Frame of application in the link.
    pub pose: Pose<R>,
    /// True if components are along the frame's axes; else along the world's.
    pub in_body: bool,
    /// Force components `[N]`, one signal a lane each.
    pub force: [Vec<Signal>; 3],
    /// Torque components [N·m], one signal a lane each.
    pub torque: [Vec<Signal>; 3],
    /// Index of the first of its six commands (force `[N]`, then torque [N·m]); none if it takes no commands.
    pub input: Option<usize>,
}

impl<R: Real> AppliedWrench<R> {
    /// The wrench at time `t` `[s]` about the link's origin, link axes; `r_wl` takes link to world axes.
    #[inline(always)]
    pub fn wrench(&self, t: f64, r_wl: &crate::spatial::Mat3<R>, commands: &[R]) -> Force<R> {
        let mut lin = Vec3([value(&self.force[0], t), value(&self.force[1], t), value(&self.force[2], t)]);
        let mut ang = Vec3([value(&self.torque[0], t), value(&self.torque[1], t), value(&self.torque[2], t)]);
        if let Some(i) = self.input {
            lin += Vec3([commands[i], commands[i + 1], commands[i + 2]]);
            ang += Vec3([commands[i + 3], commands[i + 4], commands[i + 5]]);
        }
        if self.in_body {
            lin = self.pose.rot.mul_vec(lin);
            ang = self.pose.rot.mul_vec(ang);
        } else {
            lin = r_wl.tr_mul_vec(lin);
            ang = r_wl.tr_mul_vec(ang);
        }
        Force { ang: ang + self.pose.pos.cross(lin), lin }
    }
}

/// External force and torque in world axes at a point of a link, constant until it is removed: applied by scripts and
/// clients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExternalForce<R> {
    /// The link.
    pub link: usize,
    /// Point of application, link frame `[m]`.
    pub point: Vec3<R>,
    /// World axes `[N]`.
    pub force: Vec3<R>,
    /// World axes [N·m].
    pub torque: Vec3<R>,
}

impl<R: Real> ExternalForce<R> {
    /// Wrench about the link's origin `[N·m]`, `[N]`, in link axes; `r_wl` takes link to world axes.
    #[inline(always)]
    pub fn wrench(&self, r_wl: &crate::spatial::Mat3<R>) -> Force<R> {
        let lin = r_wl.tr_mul_vec(self.force);
        Force { ang: r_wl.tr_mul_vec(self.torque) + self.point.cross(lin), lin }
    }
}

#[inline(always)]
fn value<R: Real>(signals: &[Signal], t: f64) -> R {
    R::from_lanes(|k| signals[k].value(t))
}
