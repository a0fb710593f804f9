//! Constraints of a model as they are declared: loop joints, gears, joint limits, colliders and their pairs.

use crate::contact::{Collider, Pair};
use crate::spatial::Pose;

/// Numbers of a slot in [`crate::state::State::contacts`], after its index: six multipliers and the contact mode.
pub const SLOT_LEN: usize = 7;

/// Number of slots for which memory is reserved beforehand.
pub(crate) const RESERVED_SLOTS: usize = 64;

/// A frame fixed in a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Anchor {
    /// Name of the body or frame.
    pub name: String,
    /// The link, `WORLD` for none.
    pub(crate) link: u32,
    /// In the link, or the world.
    pub pose: Pose<f64>,
}

/// Kind of a loop joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoopJointKind {
    /// Coincident origins (a ball joint).
    Point,
    /// Coincident origins and parallel z axes (a revolute joint).
    Hinge,
    /// Coincident frames (a fixed joint).
    Weld,
    /// Common z axis, along which the ends slide without turning against each other (a prismatic joint).
    Slider,
    /// Common z axis, along which the ends slide and about which they turn.
    Cylindrical,
    /// Coincident origins and perpendicular z axes: a cross with one arm along the z axis of each end.
    Universal,
    /// Common plane through both origins, perpendicular to the z axes of both ends.
    Planar,
    /// Constant distance of the origins `[m]`.
    Distance(f64),
}

impl LoopJointKind {
    /// Number of constraint rows.
    #[must_use]
    pub fn rows(self) -> usize {
        match self {
            Self::Point | Self::Planar => 3,
            Self::Cylindrical | Self::Universal => 4,
            Self::Hinge | Self::Slider => 5,
            Self::Weld => 6,
            Self::Distance(_) => 1,
        }
    }
}

/// Loop joint: a constraint that closes a kinematic loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopJoint {
    /// Name given by the user.
    pub name: String,
    /// Kind.
    pub kind: LoopJointKind,
    /// One end.
    pub a: Anchor,
    /// The other end.
    pub b: Anchor,
}

/// Gear (mimic) constraint between two coordinates: q₂ = ratio·q₁ + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct GearConstraint {
    /// Name given by the user.
    pub name: String,
    /// Degrees of freedom 1 and 2.
    pub dofs: [usize; 2],
    /// Coordinates in q of the two.
    pub coordinates: [usize; 2],
    /// Ratio of the rates, v₂ over v₁.
    pub ratio: f64,
    /// `[rad]` or `[m]`.
    pub offset: f64,
}

/// A lower or an upper limit of the coordinate of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Degree of freedom.
    pub dof: usize,
    /// Its coordinate in q.
    pub coordinate: usize,
    /// +1 for a lower, −1 for an upper limit.
    pub sign: f64,
    /// `[rad]` or `[m]`.
    pub bound: f64,
    /// Restitution: speed after over speed before.
    pub restitution: f64,
}

/// All constraints of a model; numbers are the same in every lane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConstraintSet {
    /// Loop joints.
    pub loop_joints: Vec<LoopJoint>,
    /// Gear constraints.
    pub gears: Vec<GearConstraint>,
    /// Joint limits: the first slots.
    pub limits: Vec<Limit>,
    /// Colliders.
    pub colliders: Vec<Collider>,
    /// Pairs of colliders; their slots come after the limits'.
    pub pairs: Vec<Pair>,
    /// Rest speed [m/s]: slower approach has no restitution.
    pub rest_speed: f64,
}

impl ConstraintSet {
    /// Returns true if there are no constraints.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.loop_joints.is_empty() && self.gears.is_empty() && self.limits.is_empty() && self.pairs.is_empty()
    }

    /// Number of slots of contacts.
    #[must_use]
    pub fn n_contacts(&self) -> usize {
        self.pairs.last().map_or(0, |p| p.first + p.slots)
    }

    /// Number of slots: limits, then contacts.
    #[must_use]
    pub fn n_slots(&self) -> usize {
        self.limits.len() + self.n_contacts()
    }

    /// Upper bound of the number of constraint rows, whatever the materials: six a contact point.
    pub(crate) fn max_rows(&self) -> usize {
        self.n_bilateral() + self.limits.len() + 6 * self.n_contacts()
    }

    /// Returns true if a list may be [`crate::state::State::contacts`] of this model: empty, or the fallback and
    /// records of slots in increasing order.
    #[must_use]
    pub fn accepts(&self, contacts: &[f64]) -> bool {
        let Some((fallback, records)) = contacts.split_first() else { return true };
        let slots = records.chunks(1 + SLOT_LEN).map(|record| record[0]);
        let is_slot = |slot: f64| slot >= 0.0 && slot < self.n_slots() as f64 && slot.fract() == 0.0;
        fallback.is_finite()
            && records.len() % (1 + SLOT_LEN) == 0
            && slots.clone().all(is_slot)
            && slots.clone().zip(slots.skip(1)).all(|(one, two)| one < two)
    }

    /// Number of bilateral rows: of loop joints and gears.
    #[must_use]
    pub fn n_bilateral(&self) -> usize {
        self.loop_joints.iter().map(|c| c.kind.rows()).sum::<usize>() + self.gears.len()
    }
}
