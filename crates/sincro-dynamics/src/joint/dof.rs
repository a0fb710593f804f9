//! Passive properties of a degree of freedom: armature, spring, damper, Coulomb friction, constant torque.

use sincro_math::Real;

use super::{Friction, WORLD};

/// Passive properties of one degree of freedom: armature, spring, damper, friction; listed in
/// [`Model::dofs`](crate::model::Model::dofs).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dof<R> {
    /// Armature (reflected inertia of the drive) `[kg·m²]` or `[kg]`.
    pub armature: R,
    /// Spring stiffness [N·m/rad] or [N/m].
    pub stiffness: R,
    /// Rest position of the spring `[rad]` or `[m]`.
    pub rest: R,
    /// Viscous damping coefficient `[N·m·s/rad]` or `[N·s/m]`.
    pub damping: R,
    /// Coulomb friction and stiction, limits in `[N·m]` or `[N]`.
    pub friction: Friction<R>,
    /// Constant applied torque [N·m] or force `[N]`.
    pub torque: R,
    /// Coordinate in q that this degree of freedom moves; `WORLD` for those of ball and free joints.
    pub(crate) q_idx: u32,
}

impl<R> Dof<R> {
    /// Index in q of the coordinate that this degree of freedom moves; `None` for those of ball and free joints.
    #[must_use]
    pub fn coordinate(&self) -> Option<usize> {
        (self.q_idx != WORLD).then_some(self.q_idx as usize)
    }
}

impl<R: Real> Dof<R> {
    /// Coordinate in `q` that this degree of freedom moves `[rad]` or `[m]`; zero for those of ball and free joints.
    #[inline(always)]
    pub(crate) fn coordinate_in(&self, q: &[R]) -> R {
        q.get(self.q_idx as usize).copied().unwrap_or(R::zero())
    }
}
