//! Constraints of a model as they are declared: loop joints, gears, joint limits, colliders and their pairs.

use sincro_complementarity::SLOT_LEN;
use sincro_math::Real;

use crate::contact::{Collider, Pair};
use crate::spatial::Pose;

/// Frame fixed in a link or the world: one end of a [`LoopJoint`].
#[derive(Clone, Debug, PartialEq)]
pub struct Anchor {
    /// Name of the body or frame.
    pub name: String,
    /// The link, `WORLD` for none.
    pub(crate) link: u32,
    /// Pose in the link, or in the world `[m]`.
    pub pose: Pose<f64>,
}

/// Kind of a loop joint: which origins and axes of the frames at its two ends it keeps together.
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
    /// Number of scalar constraint equations, 1 to 6.
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

/// Loop joint of a model: a constraint between two frames that closes a kinematic loop of the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopJoint {
    /// Name given by the user.
    pub name: String,
    /// Kind.
    pub kind: LoopJointKind,
    /// Frame at the first end.
    pub a: Anchor,
    /// Frame at the second end.
    pub b: Anchor,
}

/// Gear (mimic) constraint of a model between two coordinates, q₂ = offset + ratio·q₁ + Σ cₖ q₁ᵏ, k = 2, 3, 4. Its row
/// is q̇₂ − p'(q₁) q̇₁, with the velocity bias −p''(q₁) q̇₁², p the polynomial.
#[derive(Clone, Debug, PartialEq)]
pub struct GearConstraint {
    /// Name given by the user.
    pub name: String,
    /// Indices in v of degrees of freedom 1 and 2.
    pub dofs: [usize; 2],
    /// Indices in q of their coordinates.
    pub coordinates: [usize; 2],
    /// Ratio of the rates, v₂ over v₁, where q₁ = 0; everywhere without higher powers.
    pub ratio: f64,
    /// Coordinate q₂ where q₁ = 0 `[rad]` or `[m]`.
    pub offset: f64,
    /// Coefficients c₂, c₃, c₄ of q₁², q₁³, q₁⁴; all zero for a linear one.
    pub higher: [f64; 3],
}

impl GearConstraint {
    /// Returns true if q₂ is a polynomial of q₁ of degree two or more.
    #[must_use]
    pub fn is_polynomial(&self) -> bool {
        self.higher != [0.0; 3]
    }

    /// Position residual q₂ − p(q₁) at the coordinates `q` (n_q) of a model, in the unit of q₂.
    #[inline(always)]
    pub fn residual<R: Real>(&self, q: &[R]) -> R {
        let [q1, q2] = self.coordinates.map(|k| q[k]);
        let linear = q2 - R::splat(self.ratio) * q1 - R::splat(self.offset);
        if !self.is_polynomial() {
            return linear;
        }
        let [c2, c3, c4] = self.higher.map(R::splat);
        linear - q1 * q1 * (c2 + q1 * (c3 + q1 * c4))
    }

    /// Slope p'(q₁), the ratio of the rates, v₂ over v₁.
    #[inline(always)]
    pub fn slope<R: Real>(&self, q1: R) -> R {
        if !self.is_polynomial() {
            return R::splat(self.ratio);
        }
        let [c2, c3, c4] = [2.0 * self.higher[0], 3.0 * self.higher[1], 4.0 * self.higher[2]].map(R::splat);
        R::splat(self.ratio) + q1 * (c2 + q1 * (c3 + q1 * c4))
    }

    /// Curvature p''(q₁).
    #[inline(always)]
    pub fn curvature<R: Real>(&self, q1: R) -> R {
        let [c2, c3, c4] = [2.0 * self.higher[0], 6.0 * self.higher[1], 12.0 * self.higher[2]].map(R::splat);
        c2 + q1 * (c3 + q1 * c4)
    }
}

/// Lower or upper limit of the coordinate of a joint; both limits of a joint are two entries.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Index in v of the degree of freedom.
    pub dof: usize,
    /// Index in q of its coordinate.
    pub coordinate: usize,
    /// Direction in which it pushes: +1 for a lower limit, −1 for an upper one.
    pub sign: f64,
    /// Value of the limit `[rad]` or `[m]`.
    pub bound: f64,
    /// Restitution: speed after over speed before the impact, 0 to 1.
    pub restitution: f64,
}

/// Constraints of a model: loop joints, gears, joint limits, and the contacts that are possible. A *slot* is a place
/// for one unilateral constraint: a limit, or one contact point of a pair. Numbers are the same in every lane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConstraintSet {
    /// Loop joints, in the order in which they were added.
    pub loop_joints: Vec<LoopJoint>,
    /// Gear constraints, in the order in which they were added.
    pub gears: Vec<GearConstraint>,
    /// Joint limits; entry k is slot k.
    pub limits: Vec<Limit>,
    /// Colliders, in the order in which they were added.
    pub colliders: Vec<Collider>,
    /// Pairs of colliders that can collide; their slots come after those of the limits.
    pub pairs: Vec<Pair>,
    /// Rest speed `[m/s]`: contacts that approach more slowly have no restitution.
    pub rest_speed: f64,
}

impl ConstraintSet {
    /// Returns true if there are no constraints.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.loop_joints.is_empty() && self.gears.is_empty() && self.limits.is_empty() && self.pairs.is_empty()
    }

    /// Number of slots of contacts: the most contact points at once.
    #[must_use]
    pub fn n_contacts(&self) -> usize {
        self.pairs.last().map_or(0, |p| p.first + p.slots)
    }

    /// Number of slots: those of limits, then those of contacts.
    #[must_use]
    pub fn n_slots(&self) -> usize {
        self.limits.len() + self.n_contacts()
    }

    /// Links of the two surfaces of a pair; `WORLD` for none.
    pub(crate) fn links_of(&self, pair: &Pair) -> [u32; 2] {
        [pair.a, pair.b].map(|k| self.colliders[k].link)
    }

    /// Upper bound of the number of constraint rows, whatever the materials: six a contact point.
    pub(crate) fn max_rows(&self) -> usize {
        self.n_bilateral() + self.limits.len() + 6 * self.n_contacts()
    }

    /// Returns true if a list may be [`crate::state::State::contacts`] of this model: empty, or the fallback and
    /// records of slots in increasing order.
    #[must_use]
    pub(crate) fn accepts(&self, contacts: &[f64]) -> bool {
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
    pub(crate) fn n_bilateral(&self) -> usize {
        self.loop_joints.iter().map(|c| c.kind.rows()).sum::<usize>() + self.gears.len()
    }
}
