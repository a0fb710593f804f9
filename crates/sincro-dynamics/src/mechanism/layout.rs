//! Layout of y, the vector that is integrated: the one place that knows which of its entries are what.

use core::ops::Range;

use sincro_math::Real;

use crate::ids::MotorId;
use crate::model::Model;

/// Layout of y and of its slope: displacement in the chart, velocities, totals if they are tracked, states of rotors,
/// windings and activations.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    n_v: usize,
    /// Index of the first total.
    totals: usize,
    /// Index of the first state of an element.
    rotor_states: usize,
    /// Number of entries.
    dim: usize,
}

impl Layout {
    /// Layout for `model`; totals have a place if `tracks_totals`.
    #[must_use]
    pub fn new<R: Real>(model: &Model<R>, tracks_totals: bool) -> Self {
        let n_totals = if tracks_totals { 2 + model.motors().len() } else { 0 };
        let (n_v, totals) = (model.n_v(), 2 * model.n_v());
        let rotor_states = totals + n_totals;
        Self { n_v, totals, rotor_states, dim: rotor_states + model.n_rotor_states() }
    }

    /// Number of entries.
    #[inline(always)]
    #[must_use]
    pub fn dim(self) -> usize {
        self.dim
    }

    /// Displacement of the coordinates in the chart of the step (n_v).
    #[inline(always)]
    #[must_use]
    pub fn displacement(self) -> Range<usize> {
        0..self.n_v
    }

    /// Velocities (n_v).
    #[inline(always)]
    #[must_use]
    pub fn velocities(self) -> Range<usize> {
        self.n_v..self.totals
    }

    /// Velocity of one degree of freedom.
    #[inline(always)]
    #[must_use]
    pub fn velocity(self, dof: usize) -> usize {
        self.n_v + dof
    }

    /// Displacement and velocities.
    #[must_use]
    pub fn motion(self) -> Range<usize> {
        0..self.totals
    }

    /// Returns true if work, dissipation and motor impulses are integrated.
    #[inline(always)]
    #[must_use]
    pub fn tracks_totals(self) -> bool {
        self.rotor_states > self.totals
    }

    /// Totals: work `[J]`, dissipation `[J]`, impulse of each motor [N·m·s] or [N·s]; empty if they are not tracked.
    #[inline(always)]
    #[must_use]
    pub fn totals(self) -> Range<usize> {
        self.totals..self.rotor_states
    }

    /// Work `[J]`, if totals are tracked.
    #[must_use]
    pub fn work(self) -> usize {
        self.totals
    }

    /// Dissipation `[J]`, if totals are tracked.
    #[must_use]
    pub fn dissipation(self) -> usize {
        self.totals + 1
    }

    /// Impulse of a motor, if totals are tracked.
    #[must_use]
    pub fn motor_impulse(self, motor: MotorId) -> usize {
        self.totals + 2 + motor.index()
    }

    /// Returns true if elements have states.
    #[inline(always)]
    #[must_use]
    pub fn has_element_states(self) -> bool {
        self.dim > self.rotor_states
    }

    /// States of elements: of rotors, then of windings, then of activations.
    #[inline(always)]
    #[must_use]
    pub fn rotor_states(self) -> Range<usize> {
        self.rotor_states..self.dim
    }
}
