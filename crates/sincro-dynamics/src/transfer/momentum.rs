//! Velocities after bodies were joined or parted, from the momenta of the bodies before.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δv_b, Δω_b | velocity of the centre of mass and angular velocity of body b: before, less that of the candidate v |
//! | J_b | Jacobian of its centre of mass frame in the new model, 6 × n_v |
//! | r | Σ J_bᵀ (I_b Δω_b, m_b Δv_b): momentum that the candidate lacks along each degree of freedom |
//!
//! The candidate is corrected by M⁻¹ r. What force sensors hold does not move: the base of their tree takes it.

use std::collections::BTreeSet;

use super::numbers::Correspondence;
use crate::energy::energy_at;
use crate::kinematics::{self, Attached};
use crate::model::Model;
use crate::recursions::aba::AtRest;
use crate::scratch::Scratch;
use crate::spatial::{Force, Mat3, Motion, Pose, RigidInertia, Sym3, Vec3};
use crate::state::State;

/// Momentum that a candidate lacks, relative to the momenta of the bodies, that is put down to rounding.
const ROUNDING: f64 = 1e-12;

/// A body of both models.
struct Body {
    /// Frame in its centre of mass: before, and in the new model.
    frames: [Attached<f64>; 2],
    /// About the centre of mass, in the axes of the body.
    inertia: RigidInertia<f64>,
}

impl Body {
    /// Momentum about the centre of mass, world axes, of a body whose axes are turned by `rot`.
    fn momentum(&self, rot: &Mat3<f64>, v: &Motion<f64>) -> Force<f64> {
        let own = self.inertia.mul(&Motion { ang: rot.tr_mul_vec(v.ang), lin: rot.tr_mul_vec(v.lin) });
        Force { ang: rot.mul_vec(own.ang), lin: rot.mul_vec(own.lin) }
    }
}

/// Bodies that both models have, each where its mass properties are known.
fn bodies(former: &Model<f64>, model: &Model<f64>, names: &Correspondence) -> Vec<Body> {
    let mut all = Vec::new();
    for (k, (frame, found)) in model.names().frames.iter().zip(&names.frames).enumerate() {
        let (Some((old, true)), Some(mass)) = (*found, model.params.masses[k]) else { continue };
        let other = &former.names().frames[old];
        let center = Pose::translation(Vec3(mass.center_of_mass));
        let at = |link: Option<usize>, pose: &Pose<f64>| Attached { link, pose: pose.compose(&center) };
        let inertia = RigidInertia::from_center_of_mass(mass.mass, Vec3::zero(), &Sym3(mass.inertia));
        all.push(Body { frames: [at(other.link, &other.pose), at(frame.link, &frame.pose)], inertia });
    }
    all
}

/// Velocities of bodies in a state, world axes.
fn twists(model: &Model<f64>, state: &State<f64>, frames: impl Iterator<Item = Attached<f64>>) -> Vec<Motion<f64>> {
    let mut scratch = Scratch::new(model);
    let zero = vec![0.0; model.n_v()];
    kinematics::motions(model, &state.q, &state.v, &zero, &mut scratch);
    frames.map(|frame| kinematics::frame_velocity(&scratch, &frame)).collect()
}

/// Corrects the velocities of `state` so that the momentum of all bodies along every degree of freedom is that of
/// before; returns the kinetic energy that is lost by it `[J]`. Trees in which nothing was joined or parted keep their
/// bits.
pub(super) fn conserve(
    (former, before): (&Model<f64>, &State<f64>),
    (model, state): (&Model<f64>, &mut State<f64>),
    names: &Correspondence,
) -> f64 {
    let n = model.n_v();
    let bodies = bodies(former, model, names);
    let old = twists(former, before, bodies.iter().map(|body| body.frames[0]));
    let new = twists(model, state, bodies.iter().map(|body| body.frames[1]));
    let (mut lacking, mut scale) = (vec![0.0; n], vec![0.0; n]);
    let mut scratch = Scratch::new(model);
    let mut jacobian = vec![0.0; 6 * n];
    for (body, (old, new)) in bodies.iter().zip(old.iter().zip(&new)) {
        if body.frames[1].link.is_none() {
            continue;
        }
        kinematics::jacobian(model, &state.q, &body.frames[1], &mut scratch, &mut jacobian);
        let rot = kinematics::frame_pose(&scratch, &body.frames[1]).rot;
        let short = body.momentum(&rot, &Motion { ang: old.ang - new.ang, lin: old.lin - new.lin });
        let all = body.momentum(&rot, old);
        for k in 0..n {
            let column = |row: usize| jacobian[row * n + k];
            for c in 0..3 {
                lacking[k] += column(c) * short.ang[c] + column(3 + c) * short.lin[c];
                scale[k] += (column(c) * all.ang[c]).abs() + (column(3 + c) * all.lin[c]).abs();
            }
        }
    }
    let (trees, links) = (model.trees(), model.links_of_dofs());
    let tree_of = |k: usize| trees[links[k] as usize];
    let is_changed = |k: &usize| lacking[*k].abs() > ROUNDING * (scale[*k] + f64::MIN_POSITIVE / ROUNDING);
    let changed: BTreeSet<u32> = (0..n).filter(is_changed).map(tree_of).collect();
    if changed.is_empty() {
        return 0.0;
    }
    (0..n).filter(|k| !changed.contains(&tree_of(*k))).for_each(|k| lacking[k] = 0.0);
    let kinetic = |v: &[f64]| energy_at(model, &state.q, v, &mut Scratch::new(model)).kinetic;
    let mut at_rest = AtRest::new(model);
    let step = at_rest.respond(model, &state.q, &lacking, &mut Scratch::new(model));
    let v: Vec<f64> = state.v.iter().zip(step).map(|(v, step)| v + step).collect();
    if !v.iter().all(|x| x.is_finite()) {
        return 0.0;
    }
    // kinetic energy of the same bodies and rotors, moving as before
    let own = |body: &Body, w: &Motion<f64>| {
        0.5 * w.dot(&body.momentum(&kinematics::frame_pose(&scratch, &body.frames[1]).rot, w))
    };
    let moves = |body: &Body| body.frames[1].link.is_some();
    let change: f64 = bodies
        .iter()
        .zip(old.iter().zip(&new))
        .filter(|(b, _)| moves(b))
        .map(|(b, (o, n))| own(b, o) - own(b, n))
        .sum();
    let loss = kinetic(&state.v) + change - kinetic(&v);
    state.v = v;
    loss
}

#[cfg(test)]
mod tests {
    use crate::prelude::*;
    use crate::transfer::{Origin, transfer};

    /// A hand of two bodies with a force sensor between them, and a ball: apart, or the ball on the palm.
    fn hand(holds_ball: bool) -> Model<f64> {
        let mut builder = ModelBuilder::new([0.0; 3]);
        let ball = |mass: f64| BodySpec { mass: Shape::Sphere { radius: 0.1 }.mass_properties(mass / 0.004) };
        let free = JointSpec::new(JointKind::Free);
        let base = builder.joint("base", NodeId::WORLD, Pose::identity(), free.clone());
        let wrist = builder.body("wrist", base, Pose::identity(), ball(2.0));
        let sensor = JointSpec { sensor: true, ..JointSpec::new(JointKind::Fixed) };
        let sensor = builder.joint("sensor", wrist, Pose::translation(Vec3([0.2, 0.1, 0.0])), sensor);
        let palm = builder.body("palm", sensor, Pose::identity(), ball(1.0));
        let held = if holds_ball { palm } else { builder.joint("air", NodeId::WORLD, Pose::identity(), free) };
        builder.body("ball", held, Pose::translation(Vec3([0.3, 0.0, 0.1])), ball(0.5));
        builder.build().unwrap().0
    }

    #[test]
    fn what_is_joined_behind_a_force_sensor_moves_the_base_and_not_the_sensor() {
        let (former, mut joined) = (hand(false), hand(true));
        let mut before = State::new(&former);
        let n = former.n_v();
        before.q[former.n_q() - 7..][..3].copy_from_slice(&[0.2, 0.1, 0.0]);
        before.v[n - 6..].copy_from_slice(&[1.0, -0.5, 0.3, 0.7, 1.1, -0.4]);
        let same = |name: &str| Some(Origin { name: name.to_owned(), is_same: true });
        let initial = State::new(&joined);
        let after = transfer((&former, &before), (&mut joined, initial), &same, true);
        let sensor = joined.names().joint("sensor").unwrap();
        assert!(sensor.n_v > 0, "the sensor has degrees of freedom that are held");
        assert_eq!(after.state.v[sensor.v_idx..][..sensor.n_v], vec![0.0; sensor.n_v]);
        assert!(after.momentum_change.norm() < 1e-12, "{:?}", after.momentum_change);
        assert!(after.angular_momentum_change.norm() < 1e-12, "{:?}", after.angular_momentum_change);
        assert!((after.joining_loss + after.energy_change).abs() < 1e-12 && after.joining_loss > 0.1);
    }
}
