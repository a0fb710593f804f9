//! Access for linearisation: modes taken over from a world, active constraints, prescribed accelerations.

use sincro_math::Real;

use super::Mechanism;
use crate::constraint::ActiveRow;

impl<R: Real> Mechanism<R> {
    /// Takes over from a mechanism of the same model which rows of loops are used, which contacts and limits are
    /// closed, and which of them slide.
    pub fn take_constraint_modes(&mut self, other: &Mechanism<f64>) {
        if let (Some(own), Some(other)) = (&mut self.constraints, &other.constraints) {
            own.take_modes(other);
        }
        self.projection_scale = other.projection_scale;
    }

    /// Equations that hold at the state last evaluated, for the velocities `v` that it was evaluated with.
    pub fn active_constraints(&self, v: &[R]) -> Vec<ActiveRow<R>> {
        self.constraints.as_deref().map_or(Vec::new(), |constraints| constraints.active_rows(&self.model, v))
    }

    /// Prescribes the acceleration of a locked degree of freedom until [`Mechanism::mark_locked`] [rad/s²] or [m/s²].
    pub fn prescribe_acceleration(&mut self, dof: usize, acceleration: R) {
        self.prescribed_acceleration[dof] = acceleration;
    }
}
