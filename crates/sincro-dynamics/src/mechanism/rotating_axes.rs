//! Steps of semi-implicit Euler in axes that rotate with their body.
//!
//! Velocities of free joints have child axes, so that their rates contain −ω×v, and rotations of a body the gyroscopic
//! torque −ω×L. Taken at the old state, as the method takes all forces, each lets the quantity that it only turns grow
//! by a share (h|ω|)²/2 in every step: a body that spins gets faster without end. So the step is made in the axes at
//! its start, and what was found there is turned into those at its end, as far as the step turns the body.
//!
//! v_c⁺ = exp(−hω⁺)(v_c + h v̇ₛ) with v_c the velocity of the centre of mass and v̇ₛ = v̇_c + ω×v_c its acceleration in
//! the axes at the start, so that a step does not depend on where the origin of a body is;
//! L⁺ = cay(−h ω_m) L + h τ with cay the Cayley transform, a rotation, and ω_m the angular velocity in the middle of
//! the step without forces: |L| stays to rounding, the kinetic energy to third order. Source: key `hairer2006`,
//! section VII.5 (free rigid body).

use sincro_math::Real;

use super::Mechanism;
use crate::joint::{Link, StageKind, WORLD};
use crate::model::Model;
use crate::spatial::{Quat, RigidInertia, Sym3, Vec3};

/// First degrees of freedom and inertias of the links that `holds` holds for.
#[inline(always)]
fn links<R: Real>(
    model: &Model<R>,
    holds: impl Fn(&Link<R>) -> bool,
) -> impl Iterator<Item = (usize, &Link<R>, &RigidInertia<R>)> {
    let all = model.links().iter().zip(&model.params.inertias);
    all.filter(move |(link, _)| holds(link)).map(|(link, inertia)| (link.first_dof(), link, inertia))
}

/// Centre of mass of a link `[m]`, link axes; the origin of a link without mass.
#[inline(always)]
fn center_of_mass<R: Real>(inertia: &RigidInertia<R>) -> Vec3<R> {
    inertia.moment.scale(R::zero().if_less(inertia.mass, R::one() / inertia.mass, R::zero()))
}

#[inline(always)]
fn vector<R: Real>(v: &[R], k: usize) -> Vec3<R> {
    Vec3([v[k], v[k + 1], v[k + 2]])
}

/// Adds to the rates of free joints `v_dot`, in axes that rotate, what makes them rates in the axes at the start of the
/// step, of the point that the centre of mass then is at. Rates that a drive prescribes (1 in `locked`) stay.
#[inline(always)]
pub(super) fn accelerations_in_fixed_axes<R: Real>(model: &Model<R>, v: &[R], locked: &[R], v_dot: &mut [R]) {
    for (k, _, inertia) in links(model, Link::is_free) {
        let (omega, linear) = (vector(v, k), vector(v, k + 3));
        let turning = omega.cross(linear + omega.cross(center_of_mass(inertia)));
        for c in 0..3 {
            v_dot[k + 3 + c] += (R::one() - locked[k + 3 + c]) * turning[c];
        }
    }
}

/// Adds to the joint torques of single bodies on the world, with free or ball joints, what makes their gyroscopic
/// torque at the start of a step of length `h` `[s]` that of a rotation of their angular momentum over the step. Where
/// a drive prescribes a rate of rotation (1 in `locked`), it is not the body that decides how it turns: no correction.
#[inline(always)]
pub(super) fn add_gyroscopic_corrections<R: Real>(model: &Model<R>, h: f64, v: &[R], locked: &[R], torque: &mut [R]) {
    let turns = |link: &Link<R>| matches!(link.kind, StageKind::Free | StageKind::Ball);
    for (k, link, inertia) in links(model, |link| turns(link) && link.parent == WORLD && !link.has_children) {
        let correction = gyroscopic_correction(inertia, link.is_free(), R::splat(h), vector(v, k));
        let turns_freely = (R::one() - locked[k]) * (R::one() - locked[k + 1]) * (R::one() - locked[k + 2]);
        for c in 0..3 {
            torque[k + c] += turns_freely * correction[c];
        }
    }
}

/// Torque ω×L + (cay(−h ω_m) L − L)/h: the difference between the gyroscopic torque of a step and that at its start.
/// The angular momentum is about the centre of mass of bodies that are free (`is_free`), else about the origin.
#[inline(always)]
fn gyroscopic_correction<R: Real>(inertia: &RigidInertia<R>, is_free: bool, h: R, omega: Vec3<R>) -> Vec3<R> {
    let mut about = inertia.rotational;
    if is_free {
        // I − m (c·c 1 − c cᵀ)
        let to_center = center_of_mass(inertia);
        let square = inertia.moment.dot(to_center);
        about = about.plus(&Sym3::scalar(-square)).minus_outer(-inertia.moment, to_center);
    }
    let half = R::splat(0.5) * h;
    let momentum = about.mul_vec(omega);
    let torque = omega.cross(momentum);
    let middle = omega - about.solve(torque).scale(half);
    let turn = middle.scale(half);
    let once = middle.cross(momentum);
    torque - (once - turn.cross(once)).scale(R::one() / (R::one() + turn.dot(turn)))
}

impl<R: Real> Mechanism<R> {
    /// Turns the velocities of the centres of mass on free joints in y from the axes at the start of the step, at the
    /// coordinates `self.q`, into those at its end, the chart's origin.
    #[inline(always)]
    pub(super) fn turn_velocities(&self, y: &mut [R]) {
        let v = &mut y[self.layout.velocities()];
        for (k, link, inertia) in links(&self.model, Link::is_free) {
            let i = link.q_idx as usize + 3;
            let turn = Quat::from_slice(&self.base[i..]).conjugate().mul(&Quat::from_slice(&self.q[i..])).matrix();
            let of_rotation = vector(v, k).cross(center_of_mass(inertia));
            let turned = turn.mul_vec(vector(v, k + 3) + of_rotation) - of_rotation;
            v[k + 3..k + 6].copy_from_slice(&turned.0);
        }
    }
}
