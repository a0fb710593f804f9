//! Semi-implicit Euler: new velocity from forces at the old state, new position from the new velocity; joint dampers
//! act at the new velocity. Order 1. What most engines do: symplectic, so that an undamped swing keeps its amplitude,
//! as long as h·ω < 2.
//!
//! v⁺ = v + h (M + h D)⁻¹ τ(q, v),  q⁺ = q ⊕ h v⁺, with D the joint dampers; v⁺ in the axes at the start of the step,
//! from which [`System::rechart_at_velocity_level`] turns it into those at the end.

use sincro_math::Real;

use crate::{FixedStep, Implicit, System};

/// Semi-implicit Euler method of order 1 with a fixed step, and its working memory; joint dampers are taken implicitly.
#[derive(Clone, Debug)]
pub struct SemiImplicitEuler<R> {
    slope: Vec<R>,
}

impl<R: Real> SemiImplicitEuler<R> {
    /// Creates the method for systems with `dim` unknowns ([`System::dim`]).
    #[must_use]
    pub fn new(dim: usize) -> Self {
        Self { slope: vec![R::zero(); dim] }
    }
}

impl<R: Real> FixedStep<R> for SemiImplicitEuler<R> {
    #[inline(always)]
    fn step<S: System<R>>(&mut self, system: &mut S, t: f64, h: f64, y: &mut [R]) {
        system.implicit_slope(t, h, Implicit::Dampers, y, &mut self.slope);
        for (y, k) in y.iter_mut().zip(&self.slope) {
            *y += R::splat(h) * *k;
        }
        system.rechart_at_velocity_level(y);
    }
}
