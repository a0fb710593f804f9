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

use sincro_math::Real;

use crate::wind::Air;
use sincro_geometry::spatial::{Force, Motion, Pose, Vec3};

/// A drag element on a link.
#[derive(Clone, Debug)]
pub struct AirDrag<R> {
    /// The link.
    pub link: usize,
    /// Its axes and centre of pressure in the link.
    pub pose: Pose<R>,
    /// Drag coefficient by area along each axis `[m²]`.
    pub area: Vec3<R>,
    /// Linear coefficient along each axis [N·s/m].
    pub linear: Vec3<R>,
    /// Density of the air [kg/m³].
    pub density: f64,
}

/// Aerodynamic force on a drag element.
#[derive(Clone, Copy, Debug)]
pub struct Resistance<R> {
    /// Force on the centre of pressure, axes of the element `[N]`.
    pub force: Vec3<R>,
    /// Power that becomes heat `[W]`; not negative.
    pub dissipation: R,
}

impl<R: Real> AirDrag<R> {
    /// Velocity of the centre of pressure in the air [m/s], axes of the element, for the twist of its link in link axes
    /// and the link's pose in the world.
    #[inline(always)]
    pub fn velocity(&self, twist: &Motion<R>, x_wl: &Pose<R>, air: Option<&Air<'_>>) -> Vec3<R> {
        velocity_in_air(&self.pose, twist, x_wl, air)
    }

    /// Force `[N]` and dissipation `[W]` at a velocity `u` in the air `[m/s]`, both vectors in the axes of the element.
    #[inline(always)]
    pub fn resistance(&self, u: Vec3<R>) -> Resistance<R> {
        // below that the root has no slope, and 0 · ∞ would be the derivative
        let square = u.dot(u).max(R::splat(f64::MIN_POSITIVE));
        let speed = R::splat(0.5 * self.density) * square.sqrt();
        let force = Vec3(core::array::from_fn(|k| -((speed * self.area[k] + self.linear[k]) * u[k])));
        Resistance { force, dissipation: -force.dot(u) }
    }

    /// Wrench about the link's origin `[N·m]`, `[N]`, in link axes, of a force on the centre of pressure `[N]` in the
    /// axes of the element.
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
