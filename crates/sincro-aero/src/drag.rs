//! Drag of a body in the air that moves past it.
//!
//! F = −½ρ |u| (a ∘ u) − c ∘ u, u = v − wind, componentwise (∘) in the axes of the element, at its origin, the centre
//! of pressure. Equal areas a give the drag of a ball, ½ρ a |u|² against u whatever its direction; c is what creeping
//! flow or a linearised model gives. Both brake: −F·u ≥ 0, the power that the air takes as heat.
//!
//! In wind the force also does work: F·v = −D + F·wind, D = −F·u. The first is dissipation, the second the work of the
//! wind.
//!
//! Source: key `leishman2006`, equivalent flat-plate areas.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | a | drag coefficient by area, per axis | m² |
//! | c | linear coefficient, per axis | N·s/m |
//! | ρ | density of the air | kg/m³ |
//! | v, u | velocity of the centre of pressure, in the world and in the air | m/s |

use std::sync::Arc;

use sincro_math::Real;
use sincro_math::scalar_field::ScalarField;

use crate::wind::Air;
use sincro_geometry::spatial::{Force, Motion, Pose, Vec3};

/// Aerodynamic drag element fixed on a link: quadratic drag by flat-plate areas plus linear drag, at one point.
///
/// Of a built model: `Model::drags` of `sincro-dynamics`. Evaluated as velocity in the air, resistance, wrench:
///
/// ```
/// use sincro_aero::AirDrag;
/// use sincro_geometry::spatial::{Pose, Vec3};
///
/// let [area, linear] = [Vec3([0.2, 0.2, 0.5]), Vec3([0.0; 3])];
/// let plate = AirDrag { link: 0, pose: Pose::identity(), area, linear, density: 1.225, atmosphere: None };
/// let drag = plate.resistance(Vec3([10.0, 0.0, 0.0]), &Pose::identity()); // 10 m/s along x
/// assert!((drag.force[0] + 0.5 * 1.225 * 0.2 * 100.0).abs() < 1e-12); // N
/// assert!((drag.dissipation + drag.force[0] * 10.0).abs() < 1e-12); // W
/// ```
#[derive(Clone, Debug)]
pub struct AirDrag<R> {
    /// Index of the link that carries it, counted from 0 in the model's links.
    pub link: usize,
    /// Pose of the element in its link `[m]`: the origin is the centre of pressure, the axes are those of `area` and
    /// `linear`.
    pub pose: Pose<R>,
    /// Equivalent flat-plate area along each axis of the element `[m²]`: drag coefficient times area, not negative.
    pub area: Vec3<R>,
    /// Linear drag coefficient along each axis of the element `[N·s/m]`, not negative.
    pub linear: Vec3<R>,
    /// Density of the air `[kg/m³]`, where `atmosphere` does not give it.
    pub density: f64,
    /// Density of the air `[kg/m³]` over the position in the world; `None`: the same everywhere.
    pub atmosphere: Option<Arc<ScalarField>>,
}

/// Result of [`AirDrag::resistance`]: force on the centre of pressure and the power that it dissipates.
#[derive(Clone, Copy, Debug)]
pub struct Resistance<R> {
    /// Force of the air on the element at its centre of pressure `[N]`, in the axes of the element.
    pub force: Vec3<R>,
    /// Power `−F·u` that becomes heat `[W]`; not negative.
    pub dissipation: R,
}

impl<R: Real> AirDrag<R> {
    /// Velocity `[m/s]` of the centre of pressure relative to the air, in the axes of the element.
    ///
    /// `twist` is that of its link about the link's origin, in link axes (angular `[rad/s]`, linear `[m/s]`); `x_wl` is
    /// the pose of the link in the world `[m]`; without `air` the air rests.
    #[inline(always)]
    pub fn velocity(&self, twist: &Motion<R>, x_wl: &Pose<R>, air: Option<&Air<'_>>) -> Vec3<R> {
        velocity_in_air(&self.pose, twist, x_wl, air)
    }

    /// Drag force `[N]` and dissipated power `[W]` at the velocity `u` `[m/s]` of the centre of pressure relative to
    /// the air (from [`AirDrag::velocity`]), both vectors in the axes of the element; `x_wl` is the pose of its link in
    /// the world `[m]`.
    #[inline(always)]
    pub fn resistance(&self, u: Vec3<R>, x_wl: &Pose<R>) -> Resistance<R> {
        // below that the root has no slope, and 0 · ∞ would be the derivative
        let square = u.dot(u).max(R::splat(f64::MIN_POSITIVE));
        let half_density = match &self.atmosphere {
            None => R::splat(0.5 * self.density),
            Some(density) => R::splat(0.5) * density.at(x_wl.point(self.pose.pos).0),
        };
        let speed = half_density * square.sqrt();
        let force = Vec3(core::array::from_fn(|k| -((speed * self.area[k] + self.linear[k]) * u[k])));
        Resistance { force, dissipation: -force.dot(u) }
    }

    /// Wrench of a `force` on the centre of pressure `[N]`, given in the axes of the element: moment about the link's
    /// origin `[N·m]` and force `[N]`, in link axes.
    #[inline(always)]
    pub fn wrench(&self, force: Vec3<R>) -> Force<R> {
        let lin = self.pose.rot.mul_vec(force);
        Force { ang: self.pose.pos.cross(lin), lin }
    }
}

/// Velocity in the air [m/s] of the origin of a frame that stands at `x_lf` in a link, axes of the frame.
#[inline(always)]
pub(crate) fn velocity_in_air<R: Real>(
    x_lf: &Pose<R>,
    twist: &Motion<R>,
    x_wl: &Pose<R>,
    air: Option<&Air<'_>>,
) -> Vec3<R> {
    let v = x_lf.rot.tr_mul_vec(twist.lin + twist.ang.cross(x_lf.pos));
    let Some(air) = air else { return v };
    let wind = air.velocity_at(x_wl.point(x_lf.pos));
    v - x_lf.rot.tr_mul_vec(x_wl.rot.tr_mul_vec(wind))
}
