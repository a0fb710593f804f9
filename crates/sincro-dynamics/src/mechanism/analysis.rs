//! Access for linearisation: modes taken over from a world, active constraints, prescribed accelerations.

use sincro_math::Real;

use super::Mechanism;
use crate::constraint::ActiveRow;

impl<R: Real> Mechanism<R> {
    /// Copies the constraint modes of a mechanism of the same model: the independent rows of loops, the closed contacts
    /// and limits, the sliding friction groups. For evaluating the same branch on dual numbers.
    pub fn take_constraint_modes(&mut self, other: &Mechanism<f64>) {
        if let (Some(own), Some(other)) = (&mut self.constraints, &other.constraints) {
            own.take_modes(other);
        }
        self.projection_scale = other.projection_scale;
    }

    /// Constraint equations that hold at the state last evaluated: loop joints, gears, limits, contacts. `v` (n_v) are
    /// the velocities of that evaluation.
    pub fn active_constraints(&self, v: &[R]) -> Vec<ActiveRow<R>> {
        self.constraints.as_deref().map_or(Vec::new(), |constraints| constraints.active_rows(&self.model, v))
    }

    /// Prescribes the acceleration `[rad/s²]` or `[m/s²]` of degree of freedom `dof` (0 to n_v − 1), which must be
    /// locked; lasts until the next [`Mechanism::mark_locked`].
    pub fn prescribe_acceleration(&mut self, dof: usize, acceleration: R) {
        self.prescribed_acceleration[dof] = acceleration;
    }
}
