//! Whether a state can be a start: loops that are open, joints beyond their stops, bodies that overlap; and how redundant the closures are.

use crate::integrate::System;
use crate::mechanism::Mechanism;
use crate::mechanism::constraints::ActivationRule;
use crate::model::Model;
use crate::state::State;

/// How far a closure is open.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintResidual {
    /// Its name.
    pub name: String,
    /// Between the ends, or from the distance wanted `[m]`; of a coupling, in the units of its second joint.
    pub distance: f64,
    /// Between axes that should agree `[rad]`.
    pub angle: f64,
}

/// Two surfaces that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Penetration {
    /// One body.
    pub a: String,
    /// The other.
    pub b: String,
    /// How deep `[m]`.
    pub depth: f64,
}

/// A joint beyond a stop.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitViolation {
    /// Name of the joint.
    pub joint: String,
    /// Where it is `[rad]` or `[m]`.
    pub position: f64,
    /// The limit `[rad]` or `[m]`.
    pub limit: f64,
}

/// Degrees of freedom and what takes them away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mobility {
    /// Of the tree.
    pub tree_dofs: usize,
    /// Closed loops: closures and couplings.
    pub loops: usize,
    /// Equations of those.
    pub equations: usize,
    /// Equations that follow from others here.
    pub redundant: usize,
}

impl Mobility {
    /// What is left.
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

/// How far every closure and coupling is open in a state.
#[must_use]
pub fn constraint_residuals(model: &Model<f64>, x: &State<f64>) -> Vec<ConstraintResidual> {
    let set = model.constraints();
    let mut scratch = crate::scratch::Scratch::new(model);
    crate::recursions::kinematics::poses(model, &x.q, &mut scratch);
    let loop_joints = set.loop_joints.iter().map(|c| {
        let (distance, angle) = c.residual(&scratch);
        ConstraintResidual { name: c.name.clone(), distance, angle }
    });
    let gears = set.gears.iter().map(|c| {
        let [q1, q2] = c.coordinates.map(|k| x.q[k]);
        ConstraintResidual { name: c.name.clone(), distance: (q2 - c.ratio * q1 - c.offset).abs(), angle: 0.0 }
    });
    loop_joints.chain(gears).collect()
}

/// Coordinates near those of a state that close all loops; none if there are none near.
#[must_use]
pub fn assemble(model: &Model<f64>, x: &State<f64>) -> Option<Vec<f64>> {
    let (mut mechanism, mut y) = placed(model, x);
    mechanism.drives.fill(1.0);
    mechanism.mark_locked();
    for _ in 0..20 {
        mechanism.project(&mut y, false);
    }
    let mut closed = x.clone();
    closed.q.copy_from_slice(mechanism.base());
    let all = constraint_residuals(model, &closed).iter().all(|o| o.distance < 1e-9 && o.angle < 1e-9);
    (all && closed.q.iter().all(|q| q.is_finite())).then_some(closed.q)
}

/// Pairs of bodies that overlap, each with its greatest depth; compliant ones left out.
#[must_use]
pub fn penetrations(model: &Model<f64>, x: &State<f64>) -> Vec<Penetration> {
    let set = model.constraints();
    let (mut mechanism, y) = placed(model, x);
    mechanism.detect_contacts(&y[model.n_v()..], ActivationRule::All);
    let Some(c) = mechanism.constraints.as_deref() else { return Vec::new() };
    let mut found: Vec<Penetration> = Vec::new();
    for pair in set.pairs.iter().filter(|p| p.material.stiffness.is_infinite()) {
        let gaps = c.candidates[pair.first..pair.first + pair.slots].iter().flatten();
        let depth =
            gaps.map(|s| -s.kinematics(&c.motions.at(&mechanism.scratch)).distance).fold(f64::NEG_INFINITY, f64::max);
        if depth > 0.0 {
            let name = |k: usize| set.colliders[k].name.clone();
            found.push(Penetration { a: name(pair.a), b: name(pair.b), depth });
        }
    }
    found
}

/// Joints beyond their stops, by more than rounding.
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

/// Degrees of freedom in a state, closures counted.
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
        let (mut mechanism, y) = placed(model, x);
        mechanism.drives.fill(1.0);
        mechanism.mark_locked();
        found.redundant = mechanism.redundant(&y);
    }
    found
}
