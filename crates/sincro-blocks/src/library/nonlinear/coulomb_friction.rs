//! Block `coulomb-friction`.

use crate::library::prelude::*;

declare_block! {
    /// Friction against a velocity: a constant part with its sign, and a part in proportion.
    ///
    /// Zero at rest.
    pub struct CoulombFriction("coulomb-friction", Nonlinear): "y = coulomb·sign(u) + viscous·u" {
        /// Constant part `[unit of y]`.
        pub coulomb: Vec<f64> as PerComponent,
        /// Proportional part `[unit of y / unit of u]`.
        pub viscous: Vec<f64> as PerComponent = "0",
    }
}

impl CoulombFriction {
    /// The same for all components.
    #[must_use]
    pub fn new(coulomb: f64, viscous: f64) -> Self {
        Self { coulomb: vec![coulomb], viscous: vec![viscous] }
    }
}

impl Block for CoulombFriction {
    type Work<R: Real> = ();
    const IN_LANES: bool = true;

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let zero = R::zero();
        for (i, y) in y.iter_mut().enumerate() {
            let (u, c) = (at.component(0, i), R::splat(of(&self.coulomb, i)));
            let constant = zero.if_less(u, c, u.if_less(zero, -c, zero));
            *y = constant + R::splat(of(&self.viscous, i)) * u;
        }
    }
}
