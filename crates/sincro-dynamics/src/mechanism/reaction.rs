//! Reaction of joints: wrench between the two sides of a joint, whatever it transmits.
//!
//! Newton's and Euler's equations of everything that hangs on the joint: the wrench of the parent on the child is
//! Σ (I (a − g) + v ×* I v − f) over the links beyond it, with the external wrenches f of elements, contacts and loop
//! joints. Torques of motors, springs, dampers, friction, limits and gears of the joint itself are part of it. Source:
//! key `featherstone2008`, section 5.3.

use sincro_math::Real;

use super::Mechanism;
use crate::model::JointInfo;
use crate::recursions::kinematics::frame_pose;
use crate::scratch::Scratch;
use crate::spatial::{Force, Motion, Vec3};

impl Mechanism<f64> {
    /// Wrench of a joint's parent on its child: torque about the origin of the joint frame of the child [N·m] and force
    /// `[N]`, in axes of the joint frame of the parent; after kinematics with the accelerations last evaluated. Zero
    /// for a joint whose child is the parent.
    pub(crate) fn joint_wrench(&self, joint: &JointInfo) -> Force<f64> {
        let Some(child) = joint.moving.link.filter(|_| joint.n_v > 0) else { return Force::zero() };
        let mut sum = self.net_wrench_beyond(child, &self.scratch);
        sum -= self.constraint_wrench(|link| self.hangs_on(link, child));
        let turn = frame_pose(&self.scratch, &joint.base).rot;
        let origin = frame_pose(&self.scratch, &joint.moving).pos;
        let about_origin = sum.ang - origin.cross(sum.lin);
        Force { ang: turn.tr_mul_vec(about_origin), lin: turn.tr_mul_vec(sum.lin) }
    }

    /// Wrench of contacts and loop joints on the links of a set, about the world's origin, world axes.
    fn constraint_wrench(&self, is_in: impl Fn(usize) -> bool) -> Force<f64> {
        let mut sum = Force::zero();
        let Some(constraints) = self.constraints.as_deref() else { return sum };
        let is_in = |link: u32| link != crate::joint::WORLD && is_in(link as usize);
        for (row, lambda) in constraints.rows[..constraints.n_free].iter().zip(&constraints.lambda) {
            if is_in(row.a) {
                sum += row.wa.scale(*lambda);
            }
            if is_in(row.b) {
                sum -= row.wb.scale(*lambda);
            }
        }
        for contact in constraints.points(&self.model, &self.scratch) {
            let wrench = Force { ang: contact.point.cross(contact.force) + contact.torque, lin: contact.force };
            let [one, two] = contact.surfaces.map(|s| is_in(self.model.constraints().colliders[s].link));
            if one {
                sum += wrench;
            }
            if two {
                sum -= wrench;
            }
        }
        sum
    }
}

impl<R: Real> Mechanism<R> {
    /// Returns true if a link is `root` or hangs on it.
    pub(super) fn hangs_on(&self, link: usize, root: usize) -> bool {
        let mut at = Some(link);
        while let Some(link) = at.filter(|link| *link > root) {
            at = self.model.links[link].parent();
        }
        at == Some(root)
    }

    /// Sum over `root` and the links that hang on it of the inertial wrench less gravity and the wrenches of elements,
    /// about the world's origin, world axes, for motions in `scratch`.
    pub(super) fn net_wrench_beyond(&self, root: usize, scratch: &Scratch<R>) -> Force<R> {
        let links = (root..self.model.links.len()).filter(|i| self.hangs_on(*i, root));
        links.fold(Force::zero(), |mut sum, i| {
            sum += self.net_wrench(i, scratch);
            sum
        })
    }

    /// The same of one link.
    fn net_wrench(&self, i: usize, scratch: &Scratch<R>) -> Force<R> {
        let (inertia, at, pose) = (&self.model.params.inertias[i], &scratch.links[i], &scratch.poses[i]);
        let upward = Motion { ang: Vec3::zero(), lin: -pose.rot.tr_mul_vec(self.model.params.gravity) };
        let mut wrench = inertia.mul(&(at.a + upward)) + at.v.cross_force(&inertia.mul(&at.v));
        if let Some(external) = self.external.get(i).filter(|_| self.has_external()) {
            wrench -= *external;
        }
        let lin = pose.rot.mul_vec(wrench.lin);
        Force { ang: pose.rot.mul_vec(wrench.ang) + pose.pos.cross(lin), lin }
    }
}
