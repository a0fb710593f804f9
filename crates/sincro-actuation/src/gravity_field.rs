//! Gravity that depends on the position: a force m g(p) on every body at its centre of mass p.
//!
//! With a potential U per unit of mass, g = −∇U, each body has the potential energy m U(p); without one the force does
//! work. Bodies are points for the field: a long body that feels its gradient is made of several.

use sincro_math::Real;
use sincro_math::dual::Dual;
use sincro_math::scalar_field::ScalarField;

use sincro_geometry::spatial::Vec3;

/// Tolerance of −∇U against g, relative to the larger of the two: formulas are written with some digits.
const POTENTIAL_TOLERANCE: f64 = 1e-6;

/// Gravitational acceleration as formulas of the position in the world; set by `ModelBuilder::set_gravity_field`.
#[derive(Clone, Debug, PartialEq)]
pub struct GravityField {
    /// Acceleration along the axes of the world `[m/s²]`.
    pub acceleration: [ScalarField; 3],
    /// Potential U per unit of mass, the acceleration is −∇U `[m²/s²]`; `None`: gravity does work.
    pub potential: Option<ScalarField>,
}

impl GravityField {
    /// Acceleration `[m/s²]` at a position `[m]`, world axes.
    #[inline]
    pub fn acceleration<R: Real>(&self, position: Vec3<R>) -> Vec3<R> {
        Vec3([0, 1, 2].map(|k| self.acceleration[k].at(position.0)))
    }

    /// Gradient −∇U `[m/s²]` at a position `[m]` if it is not the acceleration there.
    #[must_use]
    pub fn inconsistency(&self, position: Vec3<f64>) -> Option<Vec3<f64>> {
        let potential = self.potential.as_ref()?;
        let at = [0, 1, 2].map(|k| Dual::<3>::variable(position[k], k));
        let down = Vec3(potential.at(at).partials.map(|slope| -slope));
        let given = self.acceleration(position);
        // what is not a number is none either
        let fits = (down - given).norm() <= POTENTIAL_TOLERANCE * down.norm().max(given.norm());
        (!fits).then_some(down)
    }
}
