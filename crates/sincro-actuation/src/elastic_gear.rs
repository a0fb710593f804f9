//! Elastic gear between two joints, with backlash: a spring and damper over the mesh error x = q₂ − r q₁ − offset that
//! acts outside of the gap only.
//!
//! With the gap b of the teeth, seen from the second joint, the deflection is the part of x beyond it,
//! p = x − clamp(x, −b/2, b/2), and the torque on the second joint τ = −k p − c ẋ while the teeth touch, never pulling;
//! the first joint has −r τ. Without backlash the teeth always touch. Source: key `nordin2002`, dead-zone model.
//!
//! Where the teeth meet and part the law has a corner (with damping a jump), which is not located as an event: explicit
//! methods with error control pass it with small steps, implicit ones too, which look at the branches of their laws.

use sincro_math::{Branches, Real};

/// Elastic gear of a model; from an `ElasticGearSpec`. Units are those of a revolute
/// second joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticGear<R> {
    /// Degrees of freedom of the two joints.
    pub dofs: [usize; 2],
    /// Indices of their coordinates.
    pub coordinates: [usize; 2],
    /// Ratio r of their rates, q̇₂ over q̇₁.
    pub ratio: R,
    /// Coordinate q₂ where q₁ = 0, in the middle of the gap `[rad]`.
    pub offset: R,
    /// Stiffness k of the mesh, at the second joint `[N·m/rad]`.
    pub stiffness: R,
    /// Damping c of the mesh while the teeth touch `[N·m·s/rad]`.
    pub damping: R,
    /// Backlash b: free travel of the second joint while the first is held `[rad]`.
    pub backlash: R,
}

impl<R: Real> ElasticGear<R> {
    /// Mesh error x `[rad]` for coordinates, and its rate `[rad/s]` for velocities of the model.
    #[inline(always)]
    pub fn error(&self, q: &[R], v: &[R]) -> (R, R) {
        let [q1, q2] = self.coordinates.map(|k| q[k]);
        (q2 - self.ratio * q1 - self.offset, self.rate(v))
    }

    /// Rate of the mesh error `[rad/s]` for velocities of the model.
    #[inline(always)]
    pub fn rate(&self, v: &[R]) -> R {
        let [v1, v2] = self.dofs.map(|k| v[k]);
        v2 - self.ratio * v1
    }

    /// Deflection of the teeth p `[rad]` at the mesh error `x`: zero within the gap.
    #[inline(always)]
    pub fn deflection(&self, x: R) -> R {
        let half = R::splat(0.5) * self.backlash;
        x - x.clamp_abs(half)
    }

    /// Torque on the second joint `[N·m]` at the mesh error `x` and its rate.
    #[inline(always)]
    pub fn torque(&self, x: R, rate: R) -> R {
        let zero = R::zero();
        let p = self.deflection(x);
        let both = -(self.stiffness * p) - self.damping * rate;
        // teeth push: on either side away from it
        let pushing = zero.if_less(p, both.min(zero), p.if_less(zero, both.max(zero), zero));
        zero.if_less(self.backlash, pushing, both)
    }

    /// Returns true if its law is in pieces: with backlash.
    #[must_use]
    pub fn has_branches(&self) -> bool {
        self.backlash.lane(0) > 0.0
    }

    /// Notes the branch that the law takes at the mesh error `x` and its rate, of lane 0: the side that touches.
    pub fn note_branch(&self, x: R, rate: R, branches: &mut Branches) {
        let side = if self.has_branches() { self.torque(x, rate).lane(0) } else { 0.0 };
        branches.note_side(side, 0.0);
    }

    /// Stiffness and damping that a linearly implicit step takes at the new state; zero where the torque is.
    #[inline(always)]
    pub fn implicit_terms(&self, x: R, rate: R) -> (R, R) {
        let (zero, torque) = (R::zero(), self.torque(x, rate));
        let acts = |y: R| zero.if_less(torque.abs(), y, zero);
        let touches = |y: R| zero.if_less(self.backlash, acts(y), y);
        (touches(self.stiffness), touches(self.damping))
    }

    /// Power that becomes heat `[W]` at the mesh error `x`, for its rate.
    #[inline(always)]
    pub fn dissipation(&self, x: R, rate: R) -> R {
        -((self.torque(x, rate) + self.stiffness * self.deflection(x)) * rate)
    }

    /// Potential energy ½ k p² `[J]` at the mesh error `x`.
    #[inline(always)]
    pub fn energy(&self, x: R) -> R {
        let p = self.deflection(x);
        R::splat(0.5) * self.stiffness * p * p
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn teeth_push_outside_of_the_gap_and_never_pull() {
        let gear = ElasticGear {
            dofs: [0, 1],
            coordinates: [0, 1],
            ratio: -0.5,
            offset: 0.1,
            stiffness: 100.0,
            damping: 2.0,
            backlash: 0.02,
        };
        assert_eq!(gear.error(&[0.4, 0.3], &[1.0, 2.0]), (0.3 + 0.2 - 0.1, 2.5));
        assert_eq!((gear.torque(0.005, 9.0), gear.energy(-0.009)), (0.0, 0.0));
        assert!((gear.torque(0.03, 0.0) + 2.0).abs() < 1e-15 && (gear.torque(-0.03, 0.0) - 2.0).abs() < 1e-15);
        // faster apart than the spring follows
        assert_eq!((gear.torque(0.011, -3.0), gear.torque(-0.011, 3.0)), (0.0, 0.0));
        assert_eq!(gear.implicit_terms(0.011, -3.0), (0.0, 0.0));
        let without = ElasticGear { backlash: 0.0, ..gear };
        assert!((without.torque(0.01, -3.0) - 5.0).abs() < 1e-15);
        assert!((without.dissipation(0.01, -3.0) - 18.0).abs() < 1e-13);
    }
}
