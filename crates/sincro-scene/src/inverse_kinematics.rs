//! Inverse kinematics by damped least squares: steps of joints that bring end effectors to their targets.
//!
//! Δq = Jᵀ (J Jᵀ + λ² 1)⁻¹ e with the errors e of position `[m]` and orientation `[rad]`, each joint at most 0.2 rad or
//! 0.1 m an iteration. Source: key `wampler1986`. [`damped_step`] is the step that `simIK` takes; [`pose_coordinates`]
//! iterates it for poses of frames, with λ² falling with the square of the error: quadratic near the target, without
//! jumps near singular positions.

use sincro_dynamics::initial::limit_violations;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics::{Attached, frame_pose, jacobian, poses};
use sincro_dynamics::model::Model;
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Mat3, Vec3, rotation_between};
use sincro_dynamics::state::State;
use sincro_math::least_squares::damped_step;

/// Largest rotation of a joint in one iteration `[rad]`.
pub const MAX_ROTATION_STEP: f64 = 0.2;
/// The same of a sliding joint `[m]`.
pub const MAX_TRANSLATION_STEP: f64 = 0.1;
/// λ² of steps without damping: only what is singular is touched.
pub const LEAST_DAMPING: f64 = 1e-12;

/// λ² of [`pose_coordinates`] over the square of the error.
const DAMPING_SHARE: f64 = 1e-2;
/// Iteration limit of [`pose_coordinates`].
const MAX_ITERATIONS: usize = 500;
/// Error at which it ends `[m]`, `[rad]`.
const CONVERGED: f64 = 1e-13;

/// Target of a frame, for [`pose_coordinates`].
#[derive(Clone, Copy, Debug)]
pub struct PoseTarget {
    /// Frame, by the link that carries it.
    pub frame: Attached<f64>,
    /// Position of its origin in the world `[m]`; `None` for any.
    pub position: Option<Vec3<f64>>,
    /// Rotation from its axes to those of the world; `None` for any.
    pub rotation: Option<Mat3<f64>>,
}

/// Result of [`pose_coordinates`].
#[derive(Clone, Debug, PartialEq)]
pub struct PoseSolution {
    /// Coordinates of the best iterate (n_q).
    pub q: Vec<f64>,
    /// Largest errors left: of positions `[m]`, of orientations `[rad]`.
    pub errors: [f64; 2],
    /// Names of the joints that ended beyond a limit: none are held there.
    pub beyond_limits: Vec<String>,
}

/// Coordinates near those of `x` at which all `targets` are met: joints with scalar coordinates that carry their frames
/// are moved, those of ball and free joints stay. The best iterate, with its errors, if they cannot be met.
#[must_use]
pub fn pose_coordinates(model: &Model<f64>, x: &State<f64>, targets: &[PoseTarget]) -> PoseSolution {
    let mut scratch = Scratch::new(model);
    let mut q = x.q.clone();
    let mut best = (f64::INFINITY, q.clone(), [f64::INFINITY; 2]);
    for _ in 0..MAX_ITERATIONS {
        let (rows, e, errors) = equations(model, &q, targets, &mut scratch);
        let worst = errors[0].max(errors[1]);
        if worst < best.0 {
            best = (worst, q.clone(), errors);
        }
        let square: f64 = e.iter().map(|e| e * e).sum();
        let step = damped_step(&rows, &e, (DAMPING_SHARE * square).max(LEAST_DAMPING));
        let Some(step) = step.filter(|_| worst > CONVERGED) else { break };
        for (k, change) in step.into_iter().enumerate().filter(|(k, _)| model.has_scalar_coordinate(*k)) {
            let joint = model.names().joint_of(k);
            let slides = match joint.kind {
                JointKind::Prismatic { .. } => true,
                JointKind::Planar => k - joint.v_idx < 2,
                _ => false,
            };
            let most = if slides { MAX_TRANSLATION_STEP } else { MAX_ROTATION_STEP };
            q[joint.q_idx + k - joint.v_idx] += change.clamp(-most, most);
        }
    }
    let (_, q, errors) = best;
    let there = State { q: q.clone(), ..x.clone() };
    let beyond_limits = limit_violations(model, &there).into_iter().map(|beyond| beyond.joint).collect();
    PoseSolution { q, errors, beyond_limits }
}

/// Rows of the Jacobian, a column for each degree of freedom, errors, and the largest of positions and orientations.
fn equations(
    model: &Model<f64>,
    q: &[f64],
    targets: &[PoseTarget],
    scratch: &mut Scratch<f64>,
) -> (Vec<Vec<f64>>, Vec<f64>, [f64; 2]) {
    let n = model.n_v();
    let (mut rows, mut e, mut errors) = (Vec::new(), Vec::new(), [0.0_f64; 2]);
    let mut all = vec![0.0; 6 * n];
    for target in targets {
        poses(model, q, scratch);
        let pose = frame_pose(scratch, &target.frame);
        jacobian(model, q, &target.frame, scratch, &mut all);
        // the coordinates of ball and free joints stay
        (0..6 * n).filter(|i| !model.has_scalar_coordinate(i % n)).for_each(|i| all[i] = 0.0);
        let miss = [
            target.rotation.map(|rotation| rotation_between(&pose.rot, &rotation)),
            target.position.map(|position| position - pose.pos),
        ];
        for (part, miss) in miss.into_iter().enumerate() {
            let Some(miss) = miss else { continue };
            errors[1 - part] = errors[1 - part].max(miss.norm());
            for k in 0..3 {
                rows.push(all[(3 * part + k) * n..(3 * part + k + 1) * n].to_vec());
                e.push(miss[k]);
            }
        }
    }
    (rows, e, errors)
}
