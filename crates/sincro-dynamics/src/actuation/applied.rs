//! Torques and wrenches that are given functions of time, evaluated inside the step.

use sincro_math::Real;

use crate::signal::Signal;
use crate::spatial::{Force, Pose, Vec3};

/// Torque `[N·m]` or force `[N]` on one degree of freedom as a function of time; from `JointSpec::torque`.
#[derive(Clone, Debug)]
pub struct AppliedTorque {
    /// Index of the degree of freedom, 0 to n_v − 1.
    pub dof: usize,
    /// Torque `[N·m]` or force `[N]` over time, one signal for each lane.
    pub signal: Vec<Signal>,
}

impl AppliedTorque {
    /// Torque `[N·m]` or force `[N]` at time `t` `[s]`.
    #[inline(always)]
    pub fn torque<R: Real>(&self, t: f64) -> R {
        value(&self.signal, t)
    }
}

/// External force and torque at a point of a link, over time and by command; from
/// [`ForceSpec`](crate::model::ForceSpec).
#[derive(Clone, Debug)]
pub struct AppliedWrench<R> {
    /// Index of the link in [`Model::links`](crate::model::Model::links).
    pub link: usize,
    /// Pose of the frame of application in the link `[m]`; the force acts at its origin.
    pub pose: Pose<R>,
    /// True if components are along the axes of that frame, false if along those of the world.
    pub in_body: bool,
    /// Force components x, y, z `[N]` over time, one signal for each lane.
    pub force: [Vec<Signal>; 3],
    /// Torque components x, y, z `[N·m]` over time, one signal for each lane.
    pub torque: [Vec<Signal>; 3],
    /// Index in the model's commands of the first of its six (force x, y, z `[N]`, torque x, y, z `[N·m]`), added to
    /// the signals; `None` if it takes no commands.
    pub input: Option<usize>,
}

impl<R: Real> AppliedWrench<R> {
    /// Wrench at time `t` `[s]`: moment about the link's origin `[N·m]` and force `[N]`, in link axes. `r_wl` takes
    /// link to world axes; `commands` are all commands of the model (n_commands).
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

/// External force and torque at a point of a link, constant until they are removed: applied by scripts and clients
/// through [`World::apply_external_force`](crate::world::World::apply_external_force).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExternalForce<R> {
    /// Index of the link in [`Model::links`](crate::model::Model::links).
    pub link: usize,
    /// Point of application in the link's frame `[m]`.
    pub point: Vec3<R>,
    /// Force in world axes `[N]`.
    pub force: Vec3<R>,
    /// Torque in world axes `[N·m]`.
    pub torque: Vec3<R>,
}

impl<R: Real> ExternalForce<R> {
    /// Wrench on the link: moment about its origin `[N·m]` and force `[N]`, in link axes; `r_wl` takes link to world
    /// axes.
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
