//! Consistency of an initial state: residuals of loop joints and gears, joint limits, penetrations, velocities that
//! open loops, and the mobility of the mechanism.

mod velocities;

use crate::contact::candidate_list::SlotCandidate;
use crate::integrate::System;
use crate::mechanism::Mechanism;
use crate::mechanism::constraints::ActivationRule;
use crate::mechanism::constraints::ProjectedRows;
use crate::model::Model;
use crate::state::State;

pub use velocities::{ConstraintRate, MotorConflict, consistent_velocities, constraint_rates, motor_conflict};

/// Position residual of a loop joint or gear, from [`constraint_residuals`]: how far it is from being closed.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintResidual {
    /// Name of the loop joint or gear.
    pub name: String,
    /// Distance between the ends, or deviation from the prescribed distance `[m]`; of a gear |q₂ − p(q₁)|
    /// in the unit of its second joint. Not negative.
    pub distance: f64,
    /// Angle between axes that should agree `[rad]`; 0 if there are none.
    pub angle: f64,
}

/// Penetration of two rigid surfaces, from [`penetrations`].
#[derive(Clone, Debug, PartialEq)]
pub struct Penetration {
    /// Name of one body.
    pub a: String,
    /// Name of the other body.
    pub b: String,
    /// Penetration depth `[m]`, positive.
    pub depth: f64,
}

/// Joint position outside of a joint limit, from [`limit_violations`].
#[derive(Clone, Debug, PartialEq)]
pub struct LimitViolation {
    /// Name of the joint.
    pub joint: String,
    /// Position `[rad]` or `[m]`.
    pub position: f64,
    /// Limit that is exceeded `[rad]` or `[m]`.
    pub limit: f64,
}

/// Mobility of a mechanism at a state, from [`mobility`]: degrees of freedom of the tree and constraint equations on
/// them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mobility {
    /// Number of degrees of freedom of the tree, those of force sensors left out.
    pub tree_dofs: usize,
    /// Number of loop joints and gears.
    pub loops: usize,
    /// Number of their scalar equations.
    pub equations: usize,
    /// Number of those equations that depend on the others.
    pub redundant: usize,
}

impl Mobility {
    /// Number of remaining degrees of freedom: those of the tree less the independent equations.
    #[must_use]
    pub fn dofs(&self) -> usize {
        (self.tree_dofs + self.redundant).saturating_sub(self.equations)
    }
}

fn placed(model: &Model<f64>, x: &State<f64>) -> (Mechanism<f64>, Vec<f64>) {
    let mut mechanism = Mechanism::new(model.clone(), false);
    let mut y = vec![0.0; mechanism.dim()];
    mechanism.load(x, &mut y);
    (mechanism, y)
}

/// Position residuals in the state `x`: one for each loop joint, in the order of the model, then one for each gear.
#[must_use]
pub fn constraint_residuals(model: &Model<f64>, x: &State<f64>) -> Vec<ConstraintResidual> {
    let set = model.constraints();
    let mut scratch = crate::scratch::Scratch::new(model);
    crate::recursions::kinematics::poses(model, &x.q, &mut scratch);
    let loop_joints = set.loop_joints.iter().map(|c| {
        let (distance, angle) = c.residual(&scratch);
        ConstraintResidual { name: c.name.clone(), distance, angle }
    });
    let gears = set.gears.iter().map(|c| ConstraintResidual {
        name: c.name.clone(),
        distance: c.residual(&x.q).abs(),
        angle: 0.0,
    });
    loop_joints.chain(gears).collect()
}

/// Assembles a mechanism with loops: coordinates (n_q) near those of `x` that satisfy all loop joints and gears to
/// 1e-9. `None` if the iteration finds none.
#[must_use]
pub fn assemble(model: &Model<f64>, x: &State<f64>) -> Option<Vec<f64>> {
    let (mut mechanism, mut y) = placed(model, x);
    mechanism.unlock_joints();
    for _ in 0..20 {
        mechanism.project(&mut y, ProjectedRows::Penetrating);
    }
    let mut closed = x.clone();
    closed.q.copy_from_slice(mechanism.base());
    let all = constraint_residuals(model, &closed).iter().all(|o| o.distance < 1e-9 && o.angle < 1e-9);
    (all && closed.q.iter().all(|q| q.is_finite())).then_some(closed.q)
}

/// Pairs of rigid surfaces that penetrate in the state `x`, each with its greatest depth; compliant pairs are left out.
#[must_use]
pub fn penetrations(model: &Model<f64>, x: &State<f64>) -> Vec<Penetration> {
    let set = model.constraints();
    let (mut mechanism, y) = placed(model, x);
    mechanism.detect_contacts(&y[mechanism.layout().velocities()], ActivationRule::All);
    let Some(c) = mechanism.constraints.as_deref() else { return Vec::new() };
    let mut found: Vec<Penetration> = Vec::new();
    for candidates in c.candidates.by_pair() {
        let pair = &set.pairs[candidates[0].pair as usize];
        let distance = |s: &SlotCandidate| s.candidate.kinematics(&c.motions.at(&mechanism.scratch)).distance;
        let depth = candidates.iter().map(|s| -distance(s)).fold(f64::NEG_INFINITY, f64::max);
        if pair.material.stiffness.is_infinite() && depth > 0.0 {
            let name = |k: usize| set.colliders[k].name.clone();
            found.push(Penetration { a: name(pair.a), b: name(pair.b), depth });
        }
    }
    found
}

/// Joint limits that the state `x` exceeds by more than 1e-9, in the order of the model's limits.
#[must_use]
pub fn limit_violations(model: &Model<f64>, x: &State<f64>) -> Vec<LimitViolation> {
    let beyond = model.constraints().limits.iter().filter_map(|limit| {
        let position = x.q[limit.coordinate];
        (limit.sign * (position - limit.bound) < -1e-9).then(|| LimitViolation {
            joint: model.names().dof_name(limit.dof).to_owned(),
            position,
            limit: limit.bound,
        })
    });
    beyond.collect()
}

/// Mobility at the state `x`, under loop joints and gears; contacts and limits are not counted.
#[must_use]
pub fn mobility(model: &Model<f64>, x: &State<f64>) -> Mobility {
    let set = model.constraints();
    let mut found = Mobility {
        tree_dofs: model.n_v() - model.drives().iter().filter(|d| d.kind == crate::actuation::DriveKind::Lock).count(),
        loops: set.loop_joints.len() + set.gears.len(),
        equations: set.n_bilateral(),
        redundant: 0,
    };
    if found.equations > 0 {
        found.redundant = found.equations - placed(model, x).0.select_loop_rows(&x.q);
    }
    found
}
