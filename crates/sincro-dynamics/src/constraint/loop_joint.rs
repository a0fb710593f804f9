//! Rows and residuals of loop joints (loop-closure constraints).
//!
//! | kind | residual, with the axes x, y, z of each end | rows |
//! |---|---|---|
//! | point | xₐ·(pₐ − p_b), yₐ·(pₐ − p_b), zₐ·(pₐ − p_b) | 3 |
//! | hinge | the point's, and xₐ·z_b, yₐ·z_b | 5 |
//! | weld | the point's, and xₐ·y_b, yₐ·z_b, zₐ·x_b | 6 |
//! | slider | xₐ·(pₐ − p_b), yₐ·(pₐ − p_b), and the weld's last three | 5 |
//! | cylindrical | xₐ·(pₐ − p_b), yₐ·(pₐ − p_b), and xₐ·z_b, yₐ·z_b | 4 |
//! | universal | the point's, and zₐ·z_b | 4 |
//! | planar | zₐ·(pₐ − p_b), and xₐ·z_b, yₐ·z_b | 3 |
//! | distance | \|pₐ − p_b\| − length | 1 |
//! | gear ([`GearConstraint`](crate::model::GearConstraint)) | q₂ − p(q₁) | 1 |
//!
//! Axes of an end instead of the world's: rows that a planar loop cannot move along stay idle whatever it stands on.
//! The rows are exact derivatives of the residuals, where the loop is open too.
//!
//! Source: key `featherstone2008`, chapter 8.

use sincro_math::Real;

use super::row::{Motions, Row, force_at, force_rate};
use crate::joint::WORLD;
use crate::model::{Anchor, LoopJoint, LoopJointKind};
use crate::scratch::Scratch;
use crate::spatial::{Force, Pose, Vec3};

/// Anchor at one instant, world axes.
struct End<R> {
    link: u32,
    pose: Pose<R>,
    w: Vec3<R>,
    p_dot: Vec3<R>,
}

fn end<R: Real>(anchor: &Anchor, scratch: &Scratch<R>, motions: &Motions<R>) -> End<R> {
    let pose = Pose { rot: crate::spatial::Mat3::splat(anchor.pose.rot.0), pos: Vec3::splat(anchor.pose.pos.0) };
    let pose = if anchor.link == WORLD { pose } else { scratch.poses[anchor.link as usize].compose(&pose) };
    let w = motions.twist_of(anchor.link).ang;
    End { link: anchor.link, p_dot: motions.velocity_of(anchor.link, pose.pos), pose, w }
}

impl LoopJointKind {
    /// Axes of the first end along which the origins coincide.
    fn closed_axes(self) -> core::ops::Range<usize> {
        match self {
            Self::Point | Self::Hinge | Self::Weld | Self::Universal => 0..3,
            Self::Slider | Self::Cylindrical => 0..2,
            Self::Planar => 2..3,
            Self::Distance(_) => 0..0,
        }
    }

    /// Number of rows of translations, which come first.
    pub(crate) fn n_translations(self) -> usize {
        if matches!(self, Self::Distance(_)) { 1 } else { self.closed_axes().len() }
    }

    /// Pairs of axes, of the first and of the second end, that are kept perpendicular.
    fn perpendicular_axes(self) -> &'static [(usize, usize)] {
        match self {
            Self::Hinge | Self::Cylindrical | Self::Planar => &[(0, 2), (1, 2)],
            Self::Weld | Self::Slider => &[(0, 1), (1, 2), (2, 0)],
            Self::Universal => &[(2, 2)],
            Self::Point | Self::Distance(_) => &[],
        }
    }
}

impl LoopJoint {
    /// Appends rows and residuals at the poses of `scratch` and the twists of `motions`.
    pub(crate) fn rows<R: Real>(
        &self,
        scratch: &Scratch<R>,
        motions: &Motions<R>,
        rows: &mut Vec<Row<R>>,
        residual: &mut Vec<R>,
    ) {
        let (a, b) = (end(&self.a, scratch, motions), end(&self.b, scratch, motions));
        if let LoopJointKind::Distance(length) = self.kind {
            let d = a.pose.pos - b.pose.pos;
            let size = d.norm();
            let n = d.scale(R::one() / size);
            let d_dot = a.p_dot - b.p_dot;
            let n_dot = (d_dot - n.scale(n.dot(d_dot))).scale(R::one() / size);
            rows.push(along(&a, &b, n, n_dot));
            residual.push(size - R::splat(length));
            return;
        }
        for k in self.kind.closed_axes() {
            // e fixed in a: d/dt e·(p_a − p_b) is the velocity of p_b, as a point of a, against that of b
            let e = a.pose.rot.col(k);
            let w = force_rate(b.pose.pos, e, b.p_dot, a.w.cross(e));
            rows.push(Row::between(a.link, b.link, force_at(b.pose.pos, e), w));
            residual.push(e.dot(a.pose.pos - b.pose.pos));
        }
        for &(i, j) in self.kind.perpendicular_axes() {
            // d/dt (u_a·w_b) = (ω_a − ω_b)·(u × w)
            let (u, w) = (a.pose.rot.col(i), b.pose.rot.col(j));
            let (u_dot, w_dot) = (a.w.cross(u), b.w.cross(w));
            let m = Force { ang: u.cross(w), lin: Vec3::zero() };
            let m_dot = Force { ang: u_dot.cross(w) + u.cross(w_dot), lin: Vec3::zero() };
            rows.push(Row::between(a.link, b.link, m, m_dot));
            residual.push(u.dot(w));
        }
    }

    /// Appends the velocities of both ends apart, before any projection: of the point of each end where the other is,
    /// along three axes (rows 0 to 5), and of the rotation of each about three axes (rows 6 to 11).
    pub(crate) fn end_rows<R: Real>(&self, scratch: &Scratch<R>, rows: &mut Vec<Row<R>>) {
        let place = |anchor: &Anchor| {
            let pos = Vec3::splat(anchor.pose.pos.0);
            if anchor.link == WORLD { pos } else { scratch.poses[anchor.link as usize].point(pos) }
        };
        let ends = [&self.a, &self.b];
        for (end, other) in [(ends[0], ends[1]), (ends[1], ends[0])] {
            let p = place(other);
            let zero = Force::zero();
            rows.extend((0..3).map(|k| Row::between(end.link, WORLD, force_at(p, Vec3::along(k, R::one())), zero)));
        }
        for end in ends {
            let moment = |k: usize| Force { ang: Vec3::along(k, R::one()), lin: Vec3::zero() };
            rows.extend((0..3).map(|k| Row::between(end.link, WORLD, moment(k), Force::zero())));
        }
    }

    /// Constraint residual: distance `[m]`, and angle between the axes that should agree `[rad]`.
    pub(crate) fn residual(&self, scratch: &Scratch<f64>) -> (f64, f64) {
        let pose = |x: &Anchor| {
            if x.link == WORLD { x.pose } else { scratch.poses[x.link as usize].compose(&x.pose) }
        };
        let (a, b) = (pose(&self.a), pose(&self.b));
        let apart = a.rot.tr_mul_vec(a.pos - b.pos);
        let closed = self.kind.closed_axes();
        let distance = Vec3(core::array::from_fn(|k| if closed.contains(&k) { apart[k] } else { 0.0 })).norm();
        let angle = |k: usize| {
            let (u, w) = (a.rot.col(k), b.rot.col(k));
            sincro_math::elementary::atan2(u.cross(w).norm(), u.dot(w)).0
        };
        match self.kind {
            LoopJointKind::Distance(length) => (((a.pos - b.pos).norm() - length).abs(), 0.0),
            LoopJointKind::Point => (distance, 0.0),
            LoopJointKind::Universal => (distance, (angle(2) - core::f64::consts::FRAC_PI_2).abs()),
            LoopJointKind::Hinge | LoopJointKind::Cylindrical | LoopJointKind::Planar => (distance, angle(2)),
            LoopJointKind::Weld | LoopJointKind::Slider => (distance, angle(0).max(angle(1)).max(angle(2))),
        }
    }
}

/// Row along `n` between two points that may lie apart.
fn along<R: Real>(a: &End<R>, b: &End<R>, n: Vec3<R>, n_dot: Vec3<R>) -> Row<R> {
    let mut row = Row::between(a.link, b.link, force_at(a.pose.pos, n), force_rate(a.pose.pos, n, a.p_dot, n_dot));
    row.wb = force_at(b.pose.pos, n);
    row.wb_dot = force_rate(b.pose.pos, n, b.p_dot, n_dot);
    row
}
