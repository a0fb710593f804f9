//! Links as the recursions see them: a rigid body, the stage that joins it to its parent, and the transforms across
//! that joint.

use sincro_math::Real;

use super::{Placement, Stage, StageKind, WORLD};
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, RigidInertia, Vec3};

/// Direction of the offset between a link's origin and its parent's; products by zero are not computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shift {
    /// No offset.
    None,
    /// Along the parent's x axis.
    X,
    /// Along the parent's y axis.
    Y,
    /// Along the parent's z axis.
    Z,
    /// Any direction.
    Any,
}

/// Moving link of the kinematic tree with the joint stage that connects it to its parent; listed in
/// [`Model::links`](crate::model::Model::links). Bodies without a joint between them are one link.
#[derive(Clone, Copy, Debug)]
pub struct Link<R> {
    pub(crate) parent: u32,
    pub(crate) kind: StageKind,
    /// True if `base_rotation` is not the identity.
    pub(crate) turned: bool,
    /// Direction of the offset of the link's origin from its parent's.
    pub(crate) shift: Shift,
    /// True if it has child links.
    pub(crate) has_children: bool,
    /// True if it is the first of its siblings that a tip-to-base pass meets.
    pub(crate) is_last_child: bool,
    /// First coordinate in q.
    pub(crate) q_idx: u32,
    /// First degree of freedom in v.
    pub(crate) v_idx: u32,
    /// Origin of the base frame in the parent link `[m]`.
    pub(crate) origin: Vec3<R>,
    /// Base to parent axes, if `turned`.
    pub(crate) base_rotation: Mat3<R>,
    /// +1, or −1 where the user's axis points against the coordinate axis: q_stage = sign·q.
    pub(crate) sign: R,
    /// Direction of a prismatic joint, parent axes.
    pub(crate) axis: Vec3<R>,
    /// Advance of a screw [m/rad].
    pub(crate) pitch: R,
}

impl<R: Real> Link<R> {
    /// Components from base to parent axes.
    #[inline(always)]
    pub(crate) fn base_vector(&self, x: Vec3<R>) -> Vec3<R> {
        if self.turned { self.base_rotation.mul_vec(x) } else { x }
    }

    /// Index of the parent in [`Model::links`](crate::model::Model::links); `None` for the world.
    #[inline(always)]
    pub fn parent(&self) -> Option<usize> {
        (self.parent != WORLD).then_some(self.parent as usize)
    }

    /// Index in v of the first degree of freedom of the stage that connects it to its parent.
    #[must_use]
    pub fn first_dof(&self) -> usize {
        self.v_idx as usize
    }

    /// Returns true if the stage that connects it to its parent has six degrees of freedom.
    pub fn is_free(&self) -> bool {
        self.kind == StageKind::Free
    }
}

/// Motions, forces and inertias carried across the joint.
impl<R: Real> Link<R> {
    /// A rate, acceleration or torque from the user's coordinate to the stage's, or back.
    #[inline(always)]
    pub(crate) fn signed<S: Stage>(&self, x: R) -> R {
        if S::N_V == 1 { self.sign * x } else { x }
    }

    /// A motion of the parent link as the motion of this link's origin, in link axes.
    #[inline(always)]
    pub(crate) fn motion_in_link<S: Stage>(&self, at: &Placement<R>, m: &Motion<R>) -> Motion<R> {
        let (mut ang, mut lin) = (m.ang, m.lin);
        let r = S::offset(self, at);
        match self.shift {
            Shift::None => {}
            Shift::X => lin += ang.cross_along::<0>(r[0]),
            Shift::Y => lin += ang.cross_along::<1>(r[1]),
            Shift::Z => lin += ang.cross_along::<2>(r[2]),
            Shift::Any => lin += ang.cross(r),
        }
        if self.turned {
            ang = self.base_rotation.tr_mul_vec(ang);
            lin = self.base_rotation.tr_mul_vec(lin);
        }
        Motion { ang: S::unturn(at, ang), lin: S::unturn(at, lin) }
    }

    /// A force on this link as the same force about the parent's origin, in parent axes.
    #[inline(always)]
    pub(crate) fn force_to_parent<S: Stage>(&self, at: &Placement<R>, f: &Force<R>) -> Force<R> {
        let mut ang = self.base_vector(S::turn(at, f.ang));
        let lin = self.base_vector(S::turn(at, f.lin));
        let r = S::offset(self, at);
        match self.shift {
            Shift::None => {}
            Shift::X => ang -= lin.cross_along::<0>(r[0]),
            Shift::Y => ang -= lin.cross_along::<1>(r[1]),
            Shift::Z => ang -= lin.cross_along::<2>(r[2]),
            Shift::Any => ang += r.cross(lin),
        }
        Force { ang, lin }
    }

    /// An articulated inertia of this link as seen at the parent's origin, in parent axes.
    #[inline(always)]
    pub(crate) fn articulated_to_parent<S: Stage>(
        &self,
        at: &Placement<R>,
        ia: &ArticulatedInertia<R>,
    ) -> ArticulatedInertia<R> {
        let mut ia = S::turn_articulated(at, ia);
        if self.turned {
            ia = ia.turned(&self.base_rotation);
        }
        let r = S::offset(self, at);
        match self.shift {
            Shift::None => ia,
            Shift::X => ia.shifted_along::<0>(r[0]),
            Shift::Y => ia.shifted_along::<1>(r[1]),
            Shift::Z => ia.shifted_along::<2>(r[2]),
            Shift::Any => ia.shifted(r),
        }
    }

    /// A rigid inertia of this link as seen at the parent's origin, in parent axes.
    #[inline(always)]
    pub(crate) fn rigid_to_parent<S: Stage>(&self, at: &Placement<R>, i: &RigidInertia<R>) -> RigidInertia<R> {
        let mut i = S::turn_rigid(at, i);
        if self.turned {
            i = i.turned(&self.base_rotation);
        }
        if self.shift == Shift::None { i } else { i.shifted(S::offset(self, at)) }
    }
}
