//! Inverse dynamics: the joint torques that given accelerations take.
//!
//! Recursive Newton–Euler algorithm. Source: key `featherstone2008`, section 5.3, table 5.1. Gravity enters as an
//! upward acceleration of the base. Cost: linear in the number of links.

use sincro_math::{Real, Task};

use crate::joint::{Link, Stage, StageVisitor, WORLD};
use crate::model::Model;
use crate::recursions::aba::joint_motion;
use crate::scratch::{LinkScratch, Scratch};
use crate::spatial::{Force, Motion, RigidInertia, Vec3};

/// Inverse dynamics (recursive Newton–Euler algorithm): writes the joint torques `torque` (n_v) `[N·m]` or forces `[N]`
/// that give the accelerations `v_dot` (n_v) at `q` (n_q) and `v` (n_v): `M·v̇ + bias − gravity − external`.
///
/// Springs, dampers and armature are not part of it. `external`: wrench on each link, link axes, about the link's
/// origin.
///
/// ```
/// use sincro_dynamics::prelude::*;
/// use sincro_dynamics::rnea::inverse_dynamics;
/// use sincro_dynamics::scratch::Scratch;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
/// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// # let mass = MassProperties { mass: 2.0, center_of_mass: [0.0, 0.0, -0.5], inertia: [0.0; 6] };
/// # builder.body("bob", hinge, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// // torque that accelerates a pendulum (2 kg at 0.5 m) by 3 rad/s² at 0.3 rad: m l² q'' + m g l sin q
/// let mut torque = [0.0];
/// inverse_dynamics(&model, &[0.3], &[0.0], &[3.0], None, &mut Scratch::new(&model), &mut torque);
/// assert!((torque[0] - (2.0 * 0.25 * 3.0 + 2.0 * 9.81 * 0.5 * f64::sin(0.3))).abs() < 1e-12); // [N·m]
/// # Ok::<(), BuildError>(())
/// ```
#[inline(always)]
pub fn inverse_dynamics<R: Real>(
    model: &Model<R>,
    q: &[R],
    v: &[R],
    v_dot: &[R],
    external: Option<&[Force<R>]>,
    scratch: &mut Scratch<R>,
    torque: &mut [R],
) {
    R::run_hot(InverseDynamics { model, q, v, v_dot, external, scratch, torque });
}

impl Model<f64> {
    /// Computes joint torques of plain numbers, as [`inverse_dynamics`] does, which every crate compiles again.
    ///
    /// # Panics
    ///
    /// As [`inverse_dynamics`].
    pub fn inverse_dynamics(
        &self,
        q: &[f64],
        v: &[f64],
        v_dot: &[f64],
        external: Option<&[Force<f64>]>,
        scratch: &mut Scratch<f64>,
        torque: &mut [f64],
    ) {
        inverse_dynamics(self, q, v, v_dot, external, scratch, torque);
    }
}

struct InverseDynamics<'a, R> {
    model: &'a Model<R>,
    q: &'a [R],
    v: &'a [R],
    v_dot: &'a [R],
    external: Option<&'a [Force<R>]>,
    scratch: &'a mut Scratch<R>,
    torque: &'a mut [R],
}

impl<R: Real> Task for InverseDynamics<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { model, q, v, v_dot, external, scratch, torque } = self;
        let base = (Motion::zero(), Motion { ang: Vec3::zero(), lin: -model.params.gravity });
        for i in 0..model.links.len() {
            let link = &model.links[i];
            let (done, rest) = scratch.links.split_at_mut(i);
            let parent = (link.parent != WORLD).then(|| &done[link.parent as usize]);
            let parent = parent.map_or((&base.0, &base.1), |p| (&p.v, &p.a));
            let inertia = &model.params.inertias[i];
            link.kind.dispatch(Outward { link, inertia, q, v, v_dot, parent, out: &mut rest[0] });
            if let Some(external) = external {
                rest[0].pa -= external[i];
            }
        }
        for i in (0..model.links.len()).rev() {
            let link = &model.links[i];
            let (done, rest) = scratch.links.split_at_mut(i);
            let parent = (link.parent != WORLD).then(|| &mut done[link.parent as usize].pa);
            link.kind.dispatch(Inward { link, this: &rest[0], parent, torque: &mut torque[link.v_idx as usize..] });
        }
    }
}

/// Base to tip: twist, acceleration and the wrench they take.
struct Outward<'a, R> {
    link: &'a Link<R>,
    inertia: &'a RigidInertia<R>,
    q: &'a [R],
    v: &'a [R],
    v_dot: &'a [R],
    parent: (&'a Motion<R>, &'a Motion<R>),
    out: &'a mut LinkScratch<R>,
}

impl<R: Real> StageVisitor for Outward<'_, R> {
    type Number = R;
    type Output = ();

    #[inline(always)]
    fn visit<S: Stage>(self) {
        let Self { link, inertia, q, v, v_dot, parent, out } = self;
        let v_idx = link.v_idx as usize;
        S::place(link, &q[link.q_idx as usize..], &mut out.at);
        // v = X v_parent + S q̇,  a = X a_parent + S q̈ + v × S q̇
        let v_joint = joint_motion::<S, R>(link, &v[v_idx..]);
        let a_joint = joint_motion::<S, R>(link, &v_dot[v_idx..]);
        out.v = link.motion_in_link::<S>(&out.at, parent.0) + v_joint;
        out.a = link.motion_in_link::<S>(&out.at, parent.1) + a_joint + S::velocity_product(&out.v, &v_joint);
        // f = I a + v ×* I v
        out.pa = inertia.mul(&out.a) + out.v.cross_force(&inertia.mul(&out.v));
    }
}

/// Tip to base: the wrench through the joint, its share along the axis, the rest handed on.
struct Inward<'a, R> {
    link: &'a Link<R>,
    this: &'a LinkScratch<R>,
    parent: Option<&'a mut Force<R>>,
    torque: &'a mut [R],
}

impl<R: Real> StageVisitor for Inward<'_, R> {
    type Number = R;
    type Output = ();

    #[inline(always)]
    fn visit<S: Stage>(self) {
        let Self { link, this, parent, torque } = self;
        for (j, tau) in torque.iter_mut().enumerate().take(S::N_V) {
            *tau = link.signed::<S>(S::project(link, j, &this.pa));
        }
        if let Some(parent) = parent {
            *parent += link.force_to_parent::<S>(&this.at, &this.pa);
        }
    }
}
