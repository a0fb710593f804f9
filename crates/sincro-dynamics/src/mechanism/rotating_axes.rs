//! Steps of semi-implicit Euler in axes that rotate with their body.
//!
//! Velocities of free joints have child axes, so that their rates contain −ω×v, and rotations of a body the gyroscopic
//! torque −ω×L. Taken at the old state, as the method takes all forces, each lets the quantity that it only turns grow
//! by a share (h|ω|)²/2 in every step: a body that spins gets faster without end. So the step is made in the axes at
//! its start, and what was found there is turned into those at its end, as far as the step turns the body.
//!
//! v_c⁺ = exp(−hω⁺)(v_c + h v̇ₛ) with v_c the velocity of the centre of mass and v̇ₛ = v̇_c + ω×v_c its acceleration in
//! the axes at the start, so that a step does not depend on where the origin of a body is; where a loop joint holds the
//! body, v_c is the velocity of the joint's point instead, which else would leave it;
//! L⁺ = cay(−h ω_m) L + h τ with cay the Cayley transform, a rotation, and ω_m the angular velocity in the middle of
//! the step without forces: |L| stays to rounding, the kinetic energy to third order. Source: key `hairer2006`,
//! section VII.5 (free rigid body).

use sincro_math::Real;

use crate::joint::{Link, StageKind, WORLD};
use crate::model::{LoopJointKind, Model};
use crate::spatial::{Quat, RigidInertia, Sym3, Vec3};

/// Mask of a rate `k`: 1 where no drive prescribes it (1 in `locked`) and its joint has no inertia of its own, else 0.
#[inline(always)]
fn is_alone<R: Real>(model: &Model<R>, locked: &[R], k: usize) -> R {
    R::zero().if_less(model.dofs[k].armature, R::zero(), R::one() - locked[k])
}

/// Link whose axes rotate with a free or ball joint on the world.
#[derive(Clone, Copy, Debug)]
struct RotatingLink {
    link: usize,
    /// Point of the link whose velocity keeps its direction over a step `[m]`, link axes: that of the loop joint that
    /// ties its tree to the world or another tree, which else would be left; `None` for the centre of mass.
    pivot: Option<Vec3<f64>>,
    /// True if it turns about that point as a rigid body alone.
    is_alone: bool,
}

impl RotatingLink {
    /// Point whose velocity keeps its direction `[m]`, link axes.
    #[inline(always)]
    fn point<R: Real>(&self, inertia: &RigidInertia<R>) -> Vec3<R> {
        // no closures: they would not be compiled for lanes
        match self.pivot {
            None => inertia.center_of_mass(),
            Some(Vec3([x, y, z])) => Vec3([R::splat(x), R::splat(y), R::splat(z)]),
        }
    }

    /// Rotational inertia about that point.
    #[inline(always)]
    fn inertia<R: Real>(&self, inertia: &RigidInertia<R>) -> Sym3<R> {
        inertia.shifted(-self.point(inertia)).rotational
    }
}

/// Links whose axes rotate with a free or ball joint on the world; not those that loop joints hold by other links of
/// their tree: what has a velocity there turns with them.
#[derive(Clone, Debug)]
pub(super) struct RotatingLinks(Vec<RotatingLink>);

impl RotatingLinks {
    /// Finds those of a model.
    pub fn new<R: Real>(model: &Model<R>) -> Self {
        let trees = model.trees();
        let tree = |link: u32| trees.get(link as usize).copied().unwrap_or(WORLD);
        let joints = model.params.constraints.loop_joints.iter();
        let ties: Vec<_> = joints.filter(|joint| tree(joint.a.link) != tree(joint.b.link)).collect();
        let found = model.links().iter().enumerate().filter_map(|(k, link)| {
            if link.parent != WORLD || !matches!(link.kind, StageKind::Free | StageKind::Ball) {
                return None;
            }
            let ends = ties.iter().flat_map(|joint| [(&joint.a, joint.kind), (&joint.b, joint.kind)]);
            let mut held = ends.filter(|(end, _)| tree(end.link) == k as u32);
            let Some((end, kind)) = held.next() else {
                return Some(RotatingLink { link: k, pivot: None, is_alone: !link.has_children });
            };
            let is_alone = !link.has_children
                && matches!(kind, LoopJointKind::Point | LoopJointKind::Weld)
                && held.next().is_none();
            (end.link == k as u32).then_some(RotatingLink { link: k, pivot: Some(end.pose.pos), is_alone })
        });
        Self(found.collect())
    }

    /// Returns true if there are none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// First degree of freedom, link, inertia about its origin, and how it turns, of each.
    #[inline(always)]
    fn of<'a, R: Real>(
        &'a self,
        model: &'a Model<R>,
    ) -> impl Iterator<Item = (usize, &'a Link<R>, &'a RigidInertia<R>, &'a RotatingLink)> {
        let of = |r: &'a RotatingLink| {
            let link = &model.links[r.link];
            (link.first_dof(), link, &model.params.inertias[r.link], r)
        };
        self.0.iter().map(of)
    }

    /// Adds to the rates of free joints `v_dot`, in axes that rotate, what makes them rates in the axes at the start of
    /// the step, of the point of the link whose velocity keeps its direction. Rates that a drive prescribes (1 in
    /// `locked`) stay.
    #[inline(always)]
    pub fn fix_axes<R: Real>(&self, model: &Model<R>, v: &[R], locked: &[R], v_dot: &mut [R]) {
        for (k, _, inertia, rotating) in self.of(model).filter(|(_, link, ..)| link.is_free()) {
            let (omega, linear) = (vector(v, k), vector(v, k + 3));
            let turning = omega.cross(linear + omega.cross(rotating.point(inertia)));
            for c in 0..3 {
                v_dot[k + 3 + c] += (R::one() - locked[k + 3 + c]) * turning[c];
            }
        }
    }

    /// Adds to the joint torques of single bodies what makes their gyroscopic torque at the start of a step of length
    /// `h` `[s]` that of a rotation of their angular momentum over the step. None where a drive prescribes a rate of
    /// rotation (1 in `locked`), and where a joint has inertia of its own: it is not the body alone that turns.
    #[inline(always)]
    pub fn correct_torques<R: Real>(&self, model: &Model<R>, h: f64, v: &[R], locked: &[R], torque: &mut [R]) {
        for (k, link, inertia, rotating) in self.of(model).filter(|(.., rotating)| rotating.is_alone) {
            let omega = vector(v, k);
            let inertia = if link.is_free() { rotating.inertia(inertia) } else { inertia.rotational };
            let correction = omega.cross(inertia.mul_vec(omega)) - inertia.mean_gyroscopic_torque(omega, h);
            let [x, y, z] = [k, k + 1, k + 2];
            let turns_freely = is_alone(model, locked, x) * is_alone(model, locked, y) * is_alone(model, locked, z);
            for c in 0..3 {
                torque[k + c] += turns_freely * correction[c];
            }
        }
    }

    /// Turns the velocities of those points on free joints in `v` from the axes at the start of a step, at the
    /// coordinates `start`, into those at its end, at the coordinates `end`.
    #[inline(always)]
    pub fn turn_velocities<R: Real>(&self, model: &Model<R>, (start, end): (&[R], &[R]), v: &mut [R]) {
        for (k, link, inertia, rotating) in self.of(model).filter(|(_, link, ..)| link.is_free()) {
            let i = link.q_idx as usize + 3;
            let turn = Quat::from_slice(&end[i..]).conjugate().mul(&Quat::from_slice(&start[i..])).matrix();
            let of_rotation = vector(v, k).cross(rotating.point(inertia));
            let turned = turn.mul_vec(vector(v, k + 3) + of_rotation) - of_rotation;
            v[k + 3..k + 6].copy_from_slice(&turned.0);
        }
    }
}

#[inline(always)]
fn vector<R: Real>(v: &[R], k: usize) -> Vec3<R> {
    Vec3([v[k], v[k + 1], v[k + 2]])
}
