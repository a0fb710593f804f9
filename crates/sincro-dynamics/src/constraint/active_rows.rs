//! Active constraints of the last evaluation, for analysis: what holds as an equation there, with its residual and its
//! rate on the numbers of the mechanism, so that dual numbers give its derivatives.
//!
//! Loop joints, gears, pressing limits and closed rigid contacts are holonomic: residual and rate are zero. A sticking
//! friction group has a rate only; it is nonholonomic (rolling without slipping).

use sincro_complementarity::ContactMode;
use sincro_math::Real;

use super::Constraints;
use crate::model::Model;

/// Origin of an [`ActiveRow`]; indices are those of the lists in [`ConstraintSet`](crate::model::ConstraintSet).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActiveSource {
    /// Loop joint, index in `loop_joints`.
    LoopJoint(usize),
    /// Gear, index in `gears`.
    Gear(usize),
    /// Joint limit that is reached, index in `limits`.
    Limit(usize),
    /// Normal direction of a contact point, index of its pair in `pairs`.
    Contact(usize),
    /// Direction of sticking friction at a contact point, index of its pair in `pairs`.
    StickingFriction(usize),
}

/// Constraint equation that holds at the state last evaluated, for linearisation; from
/// [`Mechanism::active_constraints`](crate::mechanism::Mechanism::active_constraints).
#[derive(Clone, Copy, Debug)]
pub struct ActiveRow<R> {
    /// Constraint that it comes from.
    pub source: ActiveSource,
    /// Position residual of a holonomic constraint `[m]` or `[rad]`; `None` for a nonholonomic one (sticking friction).
    pub residual: Option<R>,
    /// Velocity residual J v `[m/s]` or `[rad/s]`.
    pub rate: R,
}

impl<R: Real> Constraints<R> {
    /// Takes over from constraints on plain numbers which rows are used, which contacts are closed and which slide.
    pub fn take_modes(&mut self, other: &Constraints<f64>) {
        self.memory.take_modes(&other.memory);
        self.candidates.clone_from(&other.candidates);
        self.kinematics.clear();
        self.is_independent.clone_from(&other.is_independent);
        self.row_sizes.clone_from(&other.row_sizes);
        self.row_squares.clone_from(&other.row_squares);
    }

    /// Rows that hold as equations in the last evaluation, for the joint rates `v` that it was made with.
    pub fn active_rows(&self, model: &Model<R>, v: &[R]) -> Vec<ActiveRow<R>> {
        let set = &*model.params.constraints;
        let of_loops = set.loop_joints.iter().enumerate();
        let sources = of_loops.flat_map(|(k, joint)| (0..joint.kind.rows()).map(move |_| ActiveSource::LoopJoint(k)));
        let sources = sources.chain((0..set.gears.len()).map(ActiveSource::Gear));
        let used = sources.zip(&self.is_independent).filter(|(_, used)| **used).map(|(source, _)| source);
        let rate = |row: usize| self.motions.rate(&self.rows[row], v);
        let bilateral = used.zip(0..self.n_free).map(|(source, row)| ActiveRow {
            source,
            residual: Some(self.residual[row]),
            rate: rate(row),
        });
        let mut active: Vec<ActiveRow<R>> = bilateral.collect();
        for block in self.blocks.iter().filter(|block| !block.open && !block.is_drive()) {
            let (normal, friction) = match block.slot.checked_sub(set.limits.len()) {
                None => (ActiveSource::Limit(block.slot), ActiveSource::Limit(block.slot)),
                Some(contact) => {
                    let pair = super::pair_of(set, contact);
                    (ActiveSource::Contact(pair), ActiveSource::StickingFriction(pair))
                }
            };
            if !block.is_compliant {
                active.push(ActiveRow {
                    source: normal,
                    residual: Some(self.residual[block.row]),
                    rate: rate(block.row),
                });
            }
            for group in block.groups.iter().flatten().filter(|group| group.mode == ContactMode::Stick) {
                let rows = group.row..group.row + group.dim;
                active.extend(rows.map(|row| ActiveRow { source: friction, residual: None, rate: rate(row) }));
            }
        }
        active
    }
}
