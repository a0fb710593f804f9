//! Poses, velocities, accelerations and Jacobians of links and of frames fixed in them.

use sincro_math::elementary::{Binary, Unary};
use sincro_math::{Real, Task};

use crate::joint::{Link, Stage, StageVisitor, WORLD};
pub use crate::model::Attached;
use crate::model::Model;
use crate::recursions::aba::joint_motion;
use crate::scratch::{LinkScratch, Scratch};
use crate::spatial::{Mat3, Motion, Pose, Vec3};

/// Configures every joint at `q`.
#[inline(always)]
pub(crate) fn place<R: Real>(model: &Model<R>, q: &[R], scratch: &mut Scratch<R>) {
    for (link, out) in model.links.iter().zip(&mut scratch.links) {
        link.kind.dispatch(Place { link, q: &q[link.q_idx as usize..], at: &mut out.at });
    }
}

struct Place<'a, R> {
    link: &'a Link<R>,
    q: &'a [R],
    at: &'a mut crate::joint::Placement<R>,
}

impl<R: Real> StageVisitor for Place<'_, R> {
    type Number = R;
    type Output = ();
    #[inline(always)]
    fn visit<S: Stage>(self) {
        S::place(self.link, self.q, self.at);
    }
}

/// Poses of all link frames in the world into [`Scratch::link_poses`], joints taken as last configured by any
/// recursion.
#[inline(always)]
pub(crate) fn chain_poses<R: Real>(model: &Model<R>, scratch: &mut Scratch<R>) {
    for i in 0..model.links.len() {
        let link = &model.links[i];
        let x_pl = link.kind.dispatch(PoseInParent { link, this: &scratch.links[i] });
        scratch.poses[i] = match link.parent() {
            Some(parent) => scratch.poses[parent].compose(&x_pl),
            None => x_pl,
        };
    }
}

struct PoseInParent<'a, R> {
    link: &'a Link<R>,
    this: &'a LinkScratch<R>,
}

impl<R: Real> StageVisitor for PoseInParent<'_, R> {
    type Number = R;
    type Output = Pose<R>;
    #[inline(always)]
    fn visit<S: Stage>(self) -> Pose<R> {
        let rot = S::rotation(&self.this.at);
        let rot = if self.link.turned { self.link.base_rotation.mul(&rot) } else { rot };
        Pose { rot, pos: S::offset(self.link, &self.this.at) }
    }
}

/// Computes the poses of all link frames in the world `[m]` at coordinates `q` (n_q), into [`Scratch::link_poses`]; for
/// [`frame_pose`] without velocities.
#[inline(never)]
pub fn poses<R: Real>(model: &Model<R>, q: &[R], scratch: &mut Scratch<R>) {
    let pass = Poses { model, q, scratch };
    if R::IS_SCALAR { pass.run() } else { R::run_hot(pass) }
}

struct Poses<'a, R> {
    model: &'a Model<R>,
    q: &'a [R],
    scratch: &'a mut Scratch<R>,
}

impl<R: Real> Task for Poses<'_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        place(self.model, self.q, self.scratch);
        chain_poses(self.model, self.scratch);
    }
}

/// Computes poses, twists and accelerations of all links at coordinates `q` (n_q), velocities `v` and accelerations
/// `v_dot` (n_v), into `scratch`; gravity is not part of the accelerations.
#[inline(never)]
pub fn motions<R: Real>(model: &Model<R>, q: &[R], v: &[R], v_dot: &[R], scratch: &mut Scratch<R>) {
    let pass = Motions { model, q, v, v_dot, scratch };
    if R::IS_SCALAR { pass.run() } else { R::run_hot(pass) }
}

struct Motions<'a, R> {
    model: &'a Model<R>,
    q: &'a [R],
    v: &'a [R],
    v_dot: &'a [R],
    scratch: &'a mut Scratch<R>,
}

impl<R: Real> Task for Motions<'_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Self { model, q, v, v_dot, scratch } = self;
        for i in 0..model.links.len() {
            let link = &model.links[i];
            let (done, rest) = scratch.links.split_at_mut(i);
            let parent = (link.parent != WORLD).then(|| (done[link.parent as usize].v, done[link.parent as usize].a));
            let parent = parent.unwrap_or((Motion::zero(), Motion::zero()));
            link.kind.dispatch(Outward { link, q, v, v_dot, parent, out: &mut rest[0] });
        }
        chain_poses(model, scratch);
    }
}

struct Outward<'a, R> {
    link: &'a Link<R>,
    q: &'a [R],
    v: &'a [R],
    v_dot: &'a [R],
    parent: (Motion<R>, Motion<R>),
    out: &'a mut LinkScratch<R>,
}

impl<R: Real> StageVisitor for Outward<'_, R> {
    type Number = R;
    type Output = ();
    #[inline(always)]
    fn visit<S: Stage>(self) {
        let Self { link, q, v, v_dot, parent, out } = self;
        let v_idx = link.v_idx as usize;
        S::place(link, &q[link.q_idx as usize..], &mut out.at);
        let v_joint = joint_motion::<S, R>(link, &v[v_idx..]);
        let a_joint = joint_motion::<S, R>(link, &v_dot[v_idx..]);
        out.v = link.motion_in_link::<S>(&out.at, &parent.0) + v_joint;
        out.a = link.motion_in_link::<S>(&out.at, &parent.1) + a_joint + S::velocity_product(&out.v, &v_joint);
    }
}

/// Pose of a frame in the world `[m]`; `scratch` must hold [`poses`] or [`motions`].
#[inline(always)]
pub fn frame_pose<R: Real>(scratch: &Scratch<R>, frame: &Attached<R>) -> Pose<R> {
    match frame.link {
        Some(link) => scratch.poses[link].compose(&frame.pose),
        None => frame.pose,
    }
}

/// Velocity of a frame: angular `[rad/s]` and that of its origin `[m/s]`, in world axes; zero in the world. `scratch`
/// must hold [`motions`].
#[inline(always)]
pub fn frame_velocity<R: Real>(scratch: &Scratch<R>, frame: &Attached<R>) -> Motion<R> {
    let Some(link) = frame.link else { return Motion::zero() };
    let (v, rot) = (scratch.links[link].v, &scratch.poses[link].rot);
    Motion { ang: rot.mul_vec(v.ang), lin: rot.mul_vec(v.lin + v.ang.cross(frame.pose.pos)) }
}

/// Acceleration of a frame: angular `[rad/s²]` and that of its origin `[m/s²]` (the second derivative of the position),
/// in world axes, gravity not included: zero at rest. `scratch` must hold [`motions`].
#[inline(always)]
pub fn frame_acceleration<R: Real>(scratch: &Scratch<R>, frame: &Attached<R>) -> Motion<R> {
    let Some(link) = frame.link else { return Motion::zero() };
    let (v, a, rot) = (scratch.links[link].v, scratch.links[link].a, &scratch.poses[link].rot);
    let r = frame.pose.pos;
    // the point's acceleration is the spatial one plus ω × (velocity of the point)
    let lin = a.lin + a.ang.cross(r) + v.ang.cross(v.lin + v.ang.cross(r));
    Motion { ang: rot.mul_vec(a.ang), lin: rot.mul_vec(lin) }
}

/// Jacobian of a frame at coordinates `q` (n_q), so that `J·v` is [`frame_velocity`]: `out` (6 × `n_v`) is written row
/// by row, three rows of angular velocity, then three of the velocity of the frame's origin, in world axes.
///
/// ```
/// use sincro_dynamics::kinematics::jacobian;
/// use sincro_dynamics::model::Attached;
/// use sincro_dynamics::prelude::*;
/// use sincro_dynamics::scratch::Scratch;
///
/// # let mut builder = ModelBuilder::new([0.0; 3]);
/// # let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
/// # let hinge = builder.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
/// # let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// # let arm = builder.body("arm", hinge, Pose::identity(), BodySpec { mass });
/// // a tool at 0.5 m from a hinge about z
/// builder.frame("tool", arm, Pose::translation(Vec3([0.5, 0.0, 0.0])));
/// let (model, _warnings) = builder.build()?;
/// let mut rows = vec![0.0; 6 * model.n_v()];
/// let tool = model.names().frame("tool").unwrap();
/// let tool = Attached { link: tool.link, pose: tool.pose };
/// jacobian(&model, &[0.0], &tool, &mut Scratch::new(&model), &mut rows);
/// assert_eq!(rows, [0.0, 0.0, 1.0, 0.0, 0.5, 0.0]); // turns about z, moves along y
/// # Ok::<(), BuildError>(())
/// ```
pub fn jacobian<R: Real>(model: &Model<R>, q: &[R], frame: &Attached<R>, scratch: &mut Scratch<R>, out: &mut [R]) {
    poses(model, q, scratch);
    let columns = Columns { model, frame, scratch, out };
    if R::IS_SCALAR { columns.run() } else { R::run_hot(columns) }
}

/// Columns of a Jacobian, of the joints that carry the frame.
struct Columns<'a, R> {
    model: &'a Model<R>,
    frame: &'a Attached<R>,
    scratch: &'a Scratch<R>,
    out: &'a mut [R],
}

impl<R: Real> Task for Columns<'_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Self { model, frame, scratch, out } = self;
        jacobian_columns(model, frame, scratch, out);
    }
}

#[inline(always)]
fn jacobian_columns<R: Real>(model: &Model<R>, frame: &Attached<R>, scratch: &Scratch<R>, out: &mut [R]) {
    let n = model.n_v();
    out.fill(R::zero());
    let tip = frame_pose(scratch, frame).pos;
    let mut at = frame.link;
    while let Some(i) = at {
        let link = &model.links[i];
        let pose = &scratch.poses[i];
        for j in 0..link.kind.n_v() {
            let s = link.kind.dispatch(UnitColumn { link, j });
            let ang = pose.rot.mul_vec(s.ang);
            let lin = pose.rot.mul_vec(s.lin) + ang.cross(tip - pose.pos);
            for k in 0..3 {
                out[k * n + link.v_idx as usize + j] = ang[k];
                out[(3 + k) * n + link.v_idx as usize + j] = lin[k];
            }
        }
        at = link.parent();
    }
}

/// Motion of a link relative to its parent per unit of its velocity `j`, in link axes.
pub(crate) struct UnitColumn<'a, R> {
    pub link: &'a Link<R>,
    pub j: usize,
}

impl<R: Real> StageVisitor for UnitColumn<'_, R> {
    type Number = R;
    type Output = Motion<R>;
    #[inline(always)]
    fn visit<S: Stage>(self) -> Motion<R> {
        S::column(self.link, self.j, self.link.signed::<S>(R::one()))
    }
}

/// Roll, pitch and yaw, in this order `[rad]`, of the rotation `rot` = Rz(yaw)·Ry(pitch)·Rx(roll); pitch in [−π/2,
/// π/2]. At ±π/2 roll and yaw are not unique.
#[must_use]
#[inline(always)]
pub fn roll_pitch_yaw<R: Real>(rot: &Mat3<R>) -> Vec3<R> {
    let m = &rot.0;
    let pitch = (-m[2][0]).clamp_abs(R::one()).unary(Unary::Asin);
    let (roll, yaw) = (m[2][1].binary(Binary::Atan2, m[2][2]), m[1][0].binary(Binary::Atan2, m[0][0]));
    Vec3([roll, pitch, yaw])
}
