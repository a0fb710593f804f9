//! Inverse kinematics without moving anything: Jacobian, manipulability, configurations that reach a target, and paths.

use sincro_dynamics::spatial::{Pose, Quat};
use sincro_math::least_squares::cholesky;
use sincro_math::random::SplitMix64;

use super::ik::{Group, IkJoint};
use super::registry::Handle;
use super::{ApiError, SimApi};

/// Iterations of one attempt at least.
const MIN_ITERATIONS: usize = 50;
/// Attempts for a second of the time limit of a client: a clock would make every run another one.
const ATTEMPTS_PER_SECOND: f64 = 200.0;
/// Attempts of one call at most.
const MAX_ATTEMPTS: f64 = 2_000.0;
/// Configurations that differ less in every joint are one `[rad]` or `[m]`.
const SAME: f64 = 1e-2;
/// Half-range in which a joint without stops is sampled: `[rad]` of a revolute joint, `[m]` of a prismatic one.
const FREE_RANGE: [f64; 2] = [std::f64::consts::PI, 1.0];
/// Seed of the starting configurations.
const SEED: u64 = 0x9e37_79b9_7f4a_7c15;
/// Points of one path.
const MAX_POINTS: usize = 10_000;

impl SimApi<'_> {
    /// Jacobian of a group in rows, weighted, a column for each joint from the base to the tip, and the weighted errors
    /// `[m]`, `[rad]`.
    ///
    /// # Errors
    ///
    /// There is no such group, or it has no elements.
    pub(crate) fn group_jacobian(
        &mut self,
        environment: i64,
        group: i64,
    ) -> Result<(Vec<Vec<f64>>, Vec<f64>), ApiError> {
        let group = self.enabled(environment, group)?;
        self.inside(environment, &group, |sim, joints| sim.rows(&group.elements, &in_order(joints)))
    }

    /// Joints that a group moves, in the order of the columns of its Jacobian: from the base to the tip.
    ///
    /// # Errors
    ///
    /// As [`SimApi::group_jacobian`].
    pub(crate) fn group_joints(&mut self, environment: i64, group: i64) -> Result<Vec<Handle>, ApiError> {
        let group = self.enabled(environment, group)?;
        self.inside(environment, &group, |_, joints| Ok(in_order(joints).iter().map(|joint| joint.handle).collect()))
    }

    /// Manipulability `√det(J·Jᵀ)` of a group (Yoshikawa); 0 where it is singular.
    ///
    /// # Errors
    ///
    /// As [`SimApi::group_jacobian`].
    pub(crate) fn manipulability(&mut self, environment: i64, group: i64) -> Result<f64, ApiError> {
        let (rows, _) = self.group_jacobian(environment, group)?;
        let largest = rows.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        let l = cholesky(&rows, 0.0);
        let pivots = l.iter().enumerate().map(|(k, row)| row[k]);
        // rounding leaves pivots of this size where the rows depend on each other
        let is_singular = pivots.clone().any(|pivot| pivot.is_nan() || pivot <= 1e-8 * largest);
        Ok(if is_singular { 0.0 } else { pivots.product() })
    }

    /// Configurations of some joints in which a group reaches its targets, each within the limits of the joints: from
    /// the present one, then from others at random (the same in every run, others for another `salt`); at most `n`, as
    /// many attempts as `seconds` stand for. The nearest to the present one comes first.
    ///
    /// # Errors
    ///
    /// There is no such group, it has no elements, or it does not move one of the joints.
    pub(crate) fn find_configurations(
        &mut self,
        (environment, group): (i64, i64),
        joints: &[Handle],
        n: usize,
        (seconds, salt): (f64, u64),
    ) -> Result<Vec<Vec<f64>>, ApiError> {
        let mut group = self.enabled(environment, group)?;
        group.iterations = group.iterations.max(MIN_ITERATIONS);
        let attempts = (seconds.max(0.0) * ATTEMPTS_PER_SECOND).clamp(1.0, MAX_ATTEMPTS) as usize;
        self.inside(environment, &group, |sim, moved| {
            let places = places(joints, moved)?;
            let start: Vec<f64> = moved.iter().map(|m| sim.position_of(m)).collect();
            let (mut found, mut random) = (Vec::<Vec<f64>>::new(), SplitMix64::new(SEED.wrapping_add(salt)));
            for attempt in 0..attempts {
                let from: Vec<f64> = match attempt {
                    0 => start.clone(),
                    _ => moved.iter().map(|m| random_position(&mut random, m)).collect(),
                };
                sim.put(moved, &from);
                if !sim.solve(&group, moved)?.is_reached {
                    continue;
                }
                let q: Vec<f64> = moved.iter().map(|m| sim.position_of(m)).collect();
                let is_same = |other: &Vec<f64>| other.iter().zip(&q).all(|(a, b)| (a - b).abs() < SAME);
                if !found.iter().any(is_same) {
                    found.push(q);
                }
                if found.len() >= n {
                    break;
                }
            }
            let distance = |q: &Vec<f64>| q.iter().zip(&start).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            found.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
            Ok(found.into_iter().map(|q| places.iter().map(|k| q[*k]).collect()).collect())
        })
    }

    /// Configurations of some joints along the straight path of a tip to its target, `n` of them, the present one
    /// first; none if a point is not reached.
    ///
    /// # Errors
    ///
    /// There is no such group, no element of it has the tip, or it does not move one of the joints.
    pub(crate) fn generate_path(
        &mut self,
        (environment, group): (i64, i64),
        joints: &[Handle],
        tip: Handle,
        n: usize,
    ) -> Result<Option<Vec<f64>>, ApiError> {
        if !(2..=MAX_POINTS).contains(&n) {
            return Err(ApiError(format!("a path of {n} points, expected 2 to {MAX_POINTS}")));
        }
        let mut group: Group = self.enabled(environment, group)?;
        group.iterations = group.iterations.max(MIN_ITERATIONS);
        let k = group.elements.iter().position(|element| element.tip == tip);
        let k = k.ok_or_else(|| ApiError::new("no element of the group has that tip"))?;
        let all = group.clone();
        self.inside(environment, &all, |sim, moved| {
            let places = places(joints, moved)?;
            let [start, goal] = sim.ends(&group.elements[k])?;
            let q_start = Quat::from_matrix(&start.rot);
            let turn = shortest(&q_start.conjugate().mul(&Quat::from_matrix(&goal.rot))).log();
            let mut path = Vec::with_capacity(n * joints.len());
            for point in 0..n {
                let s = point as f64 / (n - 1) as f64;
                let pos = start.pos + (goal.pos - start.pos).scale(s);
                group.elements[k].goal = Some(Pose { rot: q_start.mul(&Quat::exp(turn.scale(s))).matrix(), pos });
                if point > 0 && !sim.solve(&group, moved)?.is_reached {
                    return Ok(None);
                }
                path.extend(places.iter().map(|place| sim.position_of(&moved[*place])));
            }
            Ok(Some(path))
        })
    }
}

/// The one of the two quaternions of a rotation that turns by half a turn at most.
fn shortest(q: &Quat<f64>) -> Quat<f64> {
    if q.w < 0.0 { Quat { w: -q.w, xyz: q.xyz.scale(-1.0) } } else { *q }
}

/// Joints from the base to the tip: parents have smaller handles than their children.
fn in_order(joints: &[IkJoint]) -> Vec<IkJoint> {
    let mut sorted = joints.to_vec();
    sorted.sort_by_key(|joint| joint.handle);
    sorted
}

/// Places of joints among those that a group moves.
fn places(joints: &[Handle], moved: &[IkJoint]) -> Result<Vec<usize>, ApiError> {
    let place = |joint: &Handle| {
        let found = moved.iter().position(|m| m.handle == *joint);
        found.ok_or_else(|| ApiError(format!("the group does not move the joint {}", joint.0)))
    };
    joints.iter().map(place).collect()
}

/// Random position within the limits of a joint.
fn random_position(random: &mut SplitMix64, joint: &IkJoint) -> f64 {
    let range = FREE_RANGE[usize::from(joint.is_sliding)];
    let [low, high] = joint.bounds;
    let [low, high] = if low.is_finite() && high.is_finite() { [low, high] } else { [-range, range] };
    low + (high - low) * random.unit()
}
