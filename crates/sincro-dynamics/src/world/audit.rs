//! Residuals of the laws of a mechanism at an observed instant: constraints, drives, contacts, finiteness of the state.
//!
//! | law | residual | scale |
//! |---|---|---|
//! | [`Law::Finiteness`] | numbers of state and accelerations that are not finite | 1 |
//! | [`Law::LoopPosition`] | \|g\| of each row of a loop joint or gear `[m]`, `[rad]` | see below |
//! | [`Law::LoopVelocity`] | \|J q̇\| of each such row [m/s], [rad/s] | max(1, \|q̇\|), for lengths times max(1, \|p\|) |
//! | [`Law::JointLimit`] | distance beyond a joint limit `[m]`, `[rad]` | max(1, \|bound\|) |
//! | [`Law::Penetration`] | depth of a rigid contact `[m]` | max(1, \|p\|) |
//! | [`Law::NormalForce`] | −λₙ of a contact or joint limit, relative to the largest force (dimensionless) | 1 |
//! | [`Law::FrictionCone`] | ‖λ_t‖ − μ λₙ, relative to the largest force (dimensionless) | 1 |
//! | [`Law::DriveVelocity`] | \|v − v*\| of a locked drive [rad/s], [m/s] | max(1, \|q̇\|) |
//! | [`Law::DriveMode`] | speed by which a saturated drive has passed its target velocity [rad/s], [m/s] | max(1, \|q̇\|) |
//! | [`Law::DriveForce`] | \|τ\| − τ_max of a locked drive, relative to τ_max plus the largest reaction | 1 |
//!
//! Loops have the scale max(1, \|p\|) for lengths and 1 for axes, gears max(1, \|q₁\|, \|q₂\|).
//! \|p\| is the largest distance of a link from the world's origin. The scales are those of the local error that error
//! control allows, max(\|y\|, 1), so that a tolerance times a scale is the largest residual that an accuracy allows.
//!
//! Drives are audited at the end of a tick only, under the target velocities and the modes of that tick; their forces,
//! in the modes that these forces were found with, not where an input jumps at that instant, since a drive changes its
//! mode at the start of the next tick.

use super::Observation;
use crate::constraint::{Constraints, pair_of};
use crate::contact::candidate_list::SlotCandidate;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::state::State;

/// Physical law that a simulated mechanism must satisfy; its residual is audited by [`Observation::law_residuals`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Law {
    /// State and accelerations are finite.
    Finiteness,
    /// Loop joints and gears are closed.
    LoopPosition,
    /// Loop joints and gears are closed at velocity level.
    LoopVelocity,
    /// Joint limits are not passed.
    JointLimit,
    /// Rigid surfaces do not penetrate each other.
    Penetration,
    /// Contacts and joint limits push, they do not pull.
    NormalForce,
    /// Friction forces lie within their cones.
    FrictionCone,
    /// A locked drive moves at its target velocity.
    DriveVelocity,
    /// A saturated drive pushes in the direction of its velocity error.
    DriveMode,
    /// A locked drive needs no more than its limit.
    DriveForce,
}

impl Law {
    /// All laws, in the order of their declaration.
    pub const ALL: [Self; 10] = [
        Self::Finiteness,
        Self::LoopPosition,
        Self::LoopVelocity,
        Self::JointLimit,
        Self::Penetration,
        Self::NormalForce,
        Self::FrictionCone,
        Self::DriveVelocity,
        Self::DriveMode,
        Self::DriveForce,
    ];
}

/// Element of the mechanism that a residual belongs to; indices are those of the model's lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawElement {
    /// Loop joint, index in [`ConstraintSet::loop_joints`](crate::model::ConstraintSet).
    LoopJoint(usize),
    /// Gear, index in [`ConstraintSet::gears`](crate::model::ConstraintSet).
    Gear(usize),
    /// Joint limit, index in [`ConstraintSet::limits`](crate::model::ConstraintSet).
    Limit(usize),
    /// Pair of colliders, index in [`ConstraintSet::pairs`](crate::model::ConstraintSet).
    Pair(usize),
    /// Drive of a degree of freedom, index in v: which drives there are changes with the modes of motors.
    Drive(usize),
    /// Degree of freedom, index in v.
    Dof(usize),
    /// Whole mechanism.
    Mechanism,
}

impl LawElement {
    /// Name of the element in `model` as the user gave it, of a limit, drive or degree of freedom that of the joint;
    /// `/` for the whole mechanism. Panics if the model has no such element.
    #[must_use]
    pub fn name(self, model: &Model<f64>) -> String {
        let (set, names) = (model.constraints(), model.names());
        match self {
            Self::LoopJoint(k) => set.loop_joints[k].name.clone(),
            Self::Gear(k) => set.gears[k].name.clone(),
            Self::Limit(k) => names.dof_name(set.limits[k].dof).to_owned(),
            Self::Pair(k) => {
                let pair = &set.pairs[k];
                format!("{} on {}", set.colliders[pair.a].name, set.colliders[pair.b].name)
            }
            Self::Drive(k) | Self::Dof(k) => names.dof_name(k).to_owned(),
            Self::Mechanism => "/".to_owned(),
        }
    }
}

/// Physical quantity of a residual, which gives its unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResidualKind {
    /// Length `[m]`.
    Length,
    /// Angle `[rad]`.
    Angle,
    /// Speed `[m/s]`.
    Speed,
    /// Angular speed `[rad/s]`.
    AngularSpeed,
    /// Ratio to a largest force, or a count.
    Dimensionless,
}

impl ResidualKind {
    /// Symbol of the unit, such as `m/s`; empty for a dimensionless residual.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Angle => "rad",
            Self::Speed => "m/s",
            Self::AngularSpeed => "rad/s",
            Self::Dimensionless => "",
        }
    }
}

/// Worst residual of one law at one instant, with the element it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawResidual {
    /// Residual in the unit of `kind`; zero or less where the law holds exactly.
    pub value: f64,
    /// Scale by which a tolerance is multiplied, in the same unit; at least 1.
    pub scale: f64,
    /// Physical quantity of residual and scale.
    pub kind: ResidualKind,
    /// Element with this residual.
    pub element: LawElement,
}

impl LawResidual {
    /// Residual over scale (dimensionless), to be compared with a tolerance; infinite for a residual that is not a
    /// number.
    #[must_use]
    pub fn relative(&self) -> f64 {
        let share = self.value / self.scale;
        if share.is_nan() { f64::INFINITY } else { share }
    }
}

/// Worst residual of each law at one instant, from [`Observation::law_residuals`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawResiduals {
    worst: [Option<LawResidual>; Law::ALL.len()],
}

impl LawResiduals {
    /// Worst residual of a law; `None` if no element is subject to it.
    #[must_use]
    pub fn get(&self, law: Law) -> Option<&LawResidual> {
        self.worst[law as usize].as_ref()
    }

    /// Laws that an element is subject to, in the order of [`Law::ALL`], with their worst residuals.
    pub fn iter(&self) -> impl Iterator<Item = (Law, &LawResidual)> {
        Law::ALL.into_iter().filter_map(|law| Some((law, self.get(law)?)))
    }

    fn add(&mut self, law: Law, value: f64, scale: f64, kind: ResidualKind, element: LawElement) {
        let new = LawResidual { value, scale, kind, element };
        let worst = &mut self.worst[law as usize];
        if worst.is_none_or(|known| new.relative() > known.relative()) {
            *worst = Some(new);
        }
    }
}

/// Magnitudes of a state, which residuals are compared with.
pub(crate) struct Scales {
    length: f64,
    pub(crate) speed: f64,
    pub(crate) linear_speed: f64,
}

impl Scales {
    pub(crate) fn of(v: &[f64], scratch: &Scratch<f64>) -> Self {
        let length = scratch.poses.iter().map(|pose| pose.pos.norm()).fold(1.0, f64::max);
        let speed = v.iter().fold(1.0_f64, |s, v| s.max(v.abs()));
        Self { length, speed, linear_speed: speed * length }
    }
}

impl Observation<'_> {
    /// Audits all laws in the present state: the worst residual of each, and the element it belongs to. Drives are
    /// audited at the end of a tick only. Nothing is allocated.
    #[must_use]
    pub fn law_residuals(&self) -> LawResiduals {
        let mut found = LawResiduals::default();
        self.add_finiteness(&mut found);
        if !self.is_settled && self.state.tick > 0 {
            return found;
        }
        let scales = Scales::of(&self.state.v, self.scratch());
        if let Some(constraints) = self.mechanism.constraints.as_deref() {
            self.add_loops(constraints, &scales, &mut found);
            self.add_distances(constraints, &scales, &mut found);
            add_forces(self.model(), constraints, &mut found);
        }
        if self.is_settled {
            self.add_drives(&scales, &mut found);
        }
        found
    }

    fn add_finiteness(&self, found: &mut LawResiduals) {
        let State { q, v, totals, rotors, .. } = self.state;
        let of_state = [&**q, v, totals, rotors, self.accelerations];
        let n = of_state.into_iter().flatten().filter(|x| !x.is_finite()).count();
        let is_finite = |k: usize| v[k].is_finite() && self.accelerations[k].is_finite();
        let element = (0..v.len()).find(|k| !is_finite(*k)).map_or(LawElement::Mechanism, LawElement::Dof);
        found.add(Law::Finiteness, n as f64, 1.0, ResidualKind::Dimensionless, element);
    }

    fn add_loops(&self, c: &Constraints<f64>, scales: &Scales, found: &mut LawResiduals) {
        let set = self.model().constraints();
        let mut rows = (0..c.n_free).map(|row| {
            let rate = c.motions.rate(&c.rows[row], &self.state.v);
            (c.residual[row].abs(), rate.abs())
        });
        // rows that depend on others are not there
        let mut is_used = c.is_independent.iter();
        for (k, joint) in set.loop_joints.iter().enumerate() {
            for i in 0..joint.kind.rows() {
                if !is_used.next().unwrap_or(&true) {
                    continue;
                }
                let Some((g, rate)) = rows.next() else { break };
                let element = LawElement::LoopJoint(k);
                if i < joint.kind.n_translations() {
                    found.add(Law::LoopPosition, g, scales.length, ResidualKind::Length, element);
                    found.add(Law::LoopVelocity, rate, scales.linear_speed, ResidualKind::Speed, element);
                } else {
                    found.add(Law::LoopPosition, g, 1.0, ResidualKind::Angle, element);
                    found.add(Law::LoopVelocity, rate, scales.speed, ResidualKind::AngularSpeed, element);
                }
            }
        }
        for ((k, gear), (g, rate)) in set.gears.iter().enumerate().zip(rows) {
            let kinds = if self.model().is_translation(gear.dofs[1]) {
                [ResidualKind::Length, ResidualKind::Speed]
            } else {
                [ResidualKind::Angle, ResidualKind::AngularSpeed]
            };
            let scale = gear.coordinates.iter().fold(1.0_f64, |s, k| s.max(self.state.q[*k].abs()));
            found.add(Law::LoopPosition, g, scale, kinds[0], LawElement::Gear(k));
            found.add(Law::LoopVelocity, rate, scales.speed, kinds[1], LawElement::Gear(k));
        }
    }

    fn add_distances(&self, c: &Constraints<f64>, scales: &Scales, found: &mut LawResiduals) {
        let (model, set) = (self.model(), self.model().constraints());
        for (k, limit) in set.limits.iter().enumerate() {
            let beyond = -limit.sign * (self.state.q[limit.coordinate] - limit.bound);
            let kind = if model.is_translation(limit.dof) { ResidualKind::Length } else { ResidualKind::Angle };
            found.add(Law::JointLimit, beyond.max(0.0), limit.bound.abs().max(1.0), kind, LawElement::Limit(k));
        }
        for SlotCandidate { pair, candidate, .. } in c.candidates.iter() {
            if set.pairs[*pair as usize].material.stiffness.is_finite() {
                continue;
            }
            let depth = -candidate.kinematics(&c.motions.at(self.scratch())).distance;
            let element = LawElement::Pair(*pair as usize);
            found.add(Law::Penetration, depth.max(0.0), scales.length, ResidualKind::Length, element);
        }
    }

    fn add_drives(&self, scales: &Scales, found: &mut LawResiduals) {
        // modes of the step that ends here, and those of the present forces
        let (model, modes, present) = (self.model(), &self.state.drives, &self.mechanism.drives);
        let reaction = |dof: usize| self.mechanism.scratch.reaction[dof];
        let largest = model.params.drives.iter().map(|drive| reaction(drive.dof).abs()).fold(0.0, f64::max);
        for (k, drive) in model.params.drives.iter().enumerate() {
            let element = LawElement::Drive(drive.dof);
            let kind = if model.is_translation(drive.dof) { ResidualKind::Speed } else { ResidualKind::AngularSpeed };
            let missing = self.target_velocities[k] - self.state.v[drive.dof];
            if modes[k] != 0.0 {
                let passed = (-modes[k].signum() * missing).max(0.0);
                found.add(Law::DriveMode, passed, scales.speed, kind, element);
                continue;
            }
            found.add(Law::DriveVelocity, missing.abs(), scales.speed, kind, element);
            if present[k] != 0.0 {
                continue;
            }
            let limits =
                model.params.drives.iter().zip(present).filter(|(d, mode)| d.dof == drive.dof && **mode == 0.0);
            let limit = limits.map(|(d, _)| self.mechanism.limit(d)).try_fold(0.0, |sum, limit| Some(sum + limit?));
            let (Some(limit), true) = (limit, self.inputs_are_continuous) else { continue };
            let excess = (reaction(drive.dof).abs() - limit).max(0.0);
            let excess = if excess > 0.0 { excess / (limit + largest) } else { excess };
            found.add(Law::DriveForce, excess, 1.0, ResidualKind::Dimensionless, element);
        }
    }
}

/// Adds normal forces and friction of the problem last solved.
fn add_forces(model: &Model<f64>, c: &Constraints<f64>, found: &mut LawResiduals) {
    let set = model.constraints();
    let force = c.force_scale();
    for block in c.blocks.iter().filter(|block| !block.is_drive()) {
        let element = match set.limits.get(block.slot) {
            Some(_) => LawElement::Limit(block.slot),
            None => LawElement::Pair(pair_of(set, block.slot - set.limits.len())),
        };
        let normal = c.lambda[block.row];
        found.add(Law::NormalForce, (-normal / force).max(0.0), 1.0, ResidualKind::Dimensionless, element);
        for group in block.groups.iter().flatten() {
            let list = &c.lambda[group.row..group.row + group.dim];
            let size = list.iter().map(|x| x * x).sum::<f64>().sqrt();
            let excess = (size - group.coefficient * normal.max(0.0)) / force;
            found.add(Law::FrictionCone, excess.max(0.0), 1.0, ResidualKind::Dimensionless, element);
        }
    }
}

#[cfg(test)]
mod tests;
