//! Velocities after bodies were joined or parted, from the momenta of the bodies before.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δv_b, Δω_b | velocity of the centre of mass and angular velocity of body b: before, less that of the candidate v |
//! | J_b | Jacobian of its centre of mass frame in the new model, 6 × n_v |
//! | r | Σ J_bᵀ (I_b Δω_b, m_b Δv_b): momentum that the candidate lacks along each degree of freedom |

use super::numbers::Correspondence;
use crate::energy::energy_at;
use crate::kinematics::{self, Attached};
use crate::model::{MassProperties, Model};
use crate::recursions::crba::mass_matrix;
use crate::scratch::Scratch;
use crate::spatial::{Motion, Pose, Sym3, Vec3};
use crate::state::State;

/// Momentum that a candidate lacks, relative to the momenta of the bodies, that is put down to rounding.
const ROUNDING: f64 = 1e-12;

/// A body of both models.
struct Body {
    /// Frame in its centre of mass: before, and in the new model.
    frames: [Attached<f64>; 2],
    mass: MassProperties,
}

/// Bodies that both models have, each where its mass properties are known.
fn bodies(former: &Model<f64>, model: &Model<f64>, names: &Correspondence) -> Vec<Body> {
    let mut all = Vec::new();
    for (k, (frame, found)) in model.names().frames.iter().zip(&names.frames).enumerate() {
        let (Some((old, true)), Some(mass)) = (*found, model.params.masses[k]) else { continue };
        let other = &former.names().frames[old];
        let center = Pose::translation(Vec3(mass.center_of_mass));
        let at = |link: Option<usize>, pose: &Pose<f64>| Attached { link, pose: pose.compose(&center) };
        all.push(Body { frames: [at(other.link, &other.pose), at(frame.link, &frame.pose)], mass });
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
        let turned = |w: Vec3<f64>| rot.mul_vec(inertia_times(&body.mass, rot.tr_mul_vec(w)));
        let momentum = |v: &Motion<f64>| (turned(v.ang), v.lin.scale(body.mass.mass));
        let ((ang, lin), (ang_old, lin_old)) =
            (momentum(&Motion { ang: old.ang - new.ang, lin: old.lin - new.lin }), momentum(old));
        for k in 0..n {
            let column = |row: usize| jacobian[row * n + k];
            for c in 0..3 {
                lacking[k] += column(c) * ang[c] + column(3 + c) * lin[c];
                scale[k] += (column(c) * ang_old[c]).abs() + (column(3 + c) * lin_old[c]).abs();
            }
        }
    }
    let roots = roots(model);
    let is_changed = |k: &usize| lacking[*k].abs() > ROUNDING * (scale[*k] + f64::MIN_POSITIVE / ROUNDING);
    let changed: Vec<usize> = (0..n).filter(is_changed).map(|k| roots[k]).collect();
    let dofs: Vec<usize> = (0..n).filter(|k| changed.contains(&roots[*k])).collect();
    if dofs.is_empty() {
        return 0.0;
    }
    let kinetic = |v: &[f64]| energy_at(model, &state.q, v, &mut Scratch::new(model)).kinetic;
    let mut mass = vec![0.0; n * n];
    mass_matrix(model, &state.q, &mut scratch, &mut mass);
    let rows: Vec<Vec<f64>> = dofs.iter().map(|i| dofs.iter().map(|j| mass[i * n + j]).collect()).collect();
    let step = solve(&rows, &dofs.iter().map(|k| lacking[*k]).collect::<Vec<_>>());
    let mut v = state.v.clone();
    for (k, step) in dofs.iter().zip(&step) {
        v[*k] += step;
    }
    if !v.iter().all(|x| x.is_finite()) {
        return 0.0;
    }
    // kinetic energy of the same bodies and rotors, moving as before
    let own = |body: &Body, w: &Motion<f64>| {
        let rot = kinematics::frame_pose(&scratch, &body.frames[1]).rot;
        let local = rot.tr_mul_vec(w.ang);
        0.5 * (body.mass.mass * w.lin.dot(w.lin) + local.dot(inertia_times(&body.mass, local)))
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

/// Inertia about the centre of mass, in the axes of the body, times a vector.
fn inertia_times(mass: &MassProperties, w: Vec3<f64>) -> Vec3<f64> {
    let inertia = Sym3(mass.inertia);
    Vec3(std::array::from_fn(|i| (0..3).map(|j| inertia.at(i, j) * w[j]).sum()))
}

/// Root link of the tree of each degree of freedom.
fn roots(model: &Model<f64>) -> Vec<usize> {
    let mut of_link = Vec::with_capacity(model.links().len());
    let mut roots = vec![0; model.n_v()];
    for (k, link) in model.links().iter().enumerate() {
        let root = link.parent().map_or(k, |parent| of_link[parent]);
        of_link.push(root);
        let first = link.first_dof();
        roots[first..first + link.kind.n_v()].fill(root);
    }
    roots
}

/// Solution of a positive definite system by its Cholesky factor L: L Lᵀ x = b. Rows and columns are those of a matrix
/// of masses, whose pivots are positive.
fn solve(rows: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let n = b.len();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum = (0..j).fold(rows[i][j], |sum, k| sum - l[i][k] * l[j][k]);
            l[i][j] = if i == j { sum.sqrt() } else { sum / l[j][j] };
        }
    }
    let mut x = b.to_vec();
    for i in 0..n {
        let sum = (0..i).fold(x[i], |sum, k| sum - l[i][k] * x[k]);
        x[i] = sum / l[i][i];
    }
    for i in (0..n).rev() {
        let sum = (i + 1..n).fold(x[i], |sum, k| sum - l[k][i] * x[k]);
        x[i] = sum / l[i][i];
    }
    x
}
