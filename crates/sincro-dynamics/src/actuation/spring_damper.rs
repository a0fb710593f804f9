//! Spring, damper and actuator between two points: a force along the line that joins a point of one link and a point of
//! another, or of the world.
//!
//! With the length ℓ of the line, its rate ℓ̇ and the free length ℓ₀ the force is F(ℓ − ℓ₀, ℓ̇) of a [`ForceLaw`] plus
//! the command of the actuator; positive forces push the points apart. Where the points coincide the line has no
//! direction, and the force is zero.
//!
//! Source: key `haug1989`, translational spring–damper–actuator.
//!
//! | symbol | meaning | frame |
//! |---|---|---|
//! | `p`, `v` | the two points, their velocities | world |
//! | `n` | unit vector from the first to the second | world |
//! | ℓ, ℓ̇ | distance of the points, its rate n·(v₂ − v₁) | |

use sincro_integrate::quadrature;
use sincro_math::Real;

use super::force_law::ForceLaw;
use crate::spatial::{Force, Motion, Pose, Vec3};

/// Point fixed in a link, or in the world: one end of a [`SpringDamper`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkPoint<R> {
    /// Index of the link in [`Model::links`](crate::model::Model::links); `None` for the world.
    pub link: Option<usize>,
    /// Position in the link's frame, or in the world `[m]`.
    pub position: Vec3<R>,
}

/// Actuator of a [`SpringDamper`]: adds its command, limited, to the force along the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineActuator<R> {
    /// Index in the model's commands of its command, a force `[N]`; positive pushes the points apart.
    pub command: usize,
    /// Largest magnitude of the force `[N]`; infinite for none.
    pub max_force: R,
}

/// Translational spring, damper and actuator along the line between two points; from
/// [`SpringDamperSpec`](crate::model::SpringDamperSpec).
#[derive(Clone, Debug, PartialEq)]
pub struct SpringDamper<R> {
    /// Two end points of the line.
    pub ends: [LinkPoint<R>; 2],
    /// Length at which the deflection is zero `[m]`.
    pub free_length: R,
    /// Force `[N]` over deflection (length less free length) `[m]` and rate `[m/s]`; positive pushes the points apart.
    pub law: ForceLaw<R>,
    /// True for a rope: it pulls, when longer than its free length, and never pushes.
    pub tension_only: bool,
    /// Actuator along the line; `None` without.
    pub actuator: Option<LineActuator<R>>,
}

/// Line of a [`SpringDamper`] at one instant, in world axes; from [`SpringDamper::line`].
#[derive(Clone, Copy, Debug)]
pub struct Line<R> {
    /// Positions of the two end points `[m]`.
    pub points: [Vec3<R>; 2],
    /// Velocities of the two end points `[m/s]`.
    pub velocities: [Vec3<R>; 2],
    /// Unit vector from the first point to the second; zero where they coincide.
    pub direction: Vec3<R>,
    /// Distance of the points `[m]`.
    pub length: R,
    /// Rate of the distance `[m/s]`.
    pub rate: R,
}

/// Forces of a [`SpringDamper`] along its line at one instant; positive ones push the points apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineForces<R> {
    /// Elastic force `[N]`: minus the derivative of the potential energy.
    pub elastic: R,
    /// Dissipating force `[N]`: the part that depends on the rate.
    pub damping: R,
    /// Force of the actuator `[N]`.
    pub actuator: R,
}

impl<R: Real> LineForces<R> {
    /// Sum of the three forces along the line `[N]`.
    #[inline(always)]
    pub fn total(&self) -> R {
        self.elastic + self.damping + self.actuator
    }
}

impl<R: Real> SpringDamper<R> {
    /// Computes the line at one instant. `at` gives, for the index of a link, its twist about its origin in link axes
    /// (`[rad/s]`, `[m/s]`) and its pose in the world `[m]`.
    #[inline(always)]
    pub fn line(&self, at: impl Fn(usize) -> (Motion<R>, Pose<R>)) -> Line<R> {
        let ends = self.ends.map(|end| match end.link {
            None => (end.position, Vec3::zero()),
            Some(link) => {
                let (twist, x_wl) = at(link);
                let velocity = x_wl.rot.mul_vec(twist.lin + twist.ang.cross(end.position));
                (x_wl.point(end.position), velocity)
            }
        });
        let [(p1, v1), (p2, v2)] = ends;
        let apart = p2 - p1;
        // below that the root has no slope, and 0 · ∞ would be the derivative
        let length = apart.dot(apart).max(R::splat(f64::MIN_POSITIVE)).sqrt();
        let direction = apart.scale(R::one() / length);
        Line { points: [p1, p2], velocities: [v1, v2], direction, length, rate: direction.dot(v2 - v1) }
    }

    /// Forces along the line `[N]` at its `length` `[m]` and `rate` of the length `[m/s]`; `commands` are all commands
    /// of the model (n_commands), of which an actuator reads its own.
    #[inline(always)]
    pub fn forces(&self, length: R, rate: R, commands: &[R]) -> LineForces<R> {
        let (x, zero) = (length - self.free_length, R::zero());
        let actuator = self.actuator.map_or(zero, |a| commands[a.command].clamp_abs(a.max_force));
        let (elastic, both) = (self.law.force(x, zero), self.law.force(x, rate));
        if !self.tension_only {
            return LineForces { elastic, damping: both - elastic, actuator };
        }
        let pulls = |force: R| zero.if_less(x, force.min(zero), zero);
        LineForces { elastic: pulls(elastic), damping: pulls(both) - pulls(elastic), actuator }
    }

    /// Potential energy `[J]` at a `length` of the line `[m]`, zero at the free length.
    pub fn potential(&self, length: R) -> R {
        let x = length - self.free_length;
        if !self.tension_only {
            return self.law.potential(x);
        }
        let zero = R::zero();
        if self.law.nonlinear.is_none() {
            return self.law.potential(x.max(zero));
        }
        // the law may push somewhere, which the rope does not; whatever the lane, the law is the same but for numbers
        let of = |l: usize, x: f64| {
            let force = |s: f64| self.law.force(R::splat(s), zero).lane(l).min(0.0);
            (-quadrature(&force, 0.0, x), -force(x))
        };
        let value = R::from_lanes(|l| of(l, x.lane(l).max(0.0)).0);
        let slope = R::from_lanes(|l| if x.lane(l) > 0.0 { of(l, x.lane(l)).1 } else { 0.0 });
        // derivatives by the chain rule: x less its own value carries them alone
        value + slope * (x - R::from_lanes(|l| x.lane(l)))
    }

    /// Stiffness `[N/m]` and damping `[N·s/m]` that a linearly implicit step evaluates at the new state, at a `length`
    /// of the line `[m]` and its `rate` `[m/s]`; zero for a slack rope.
    #[inline(always)]
    pub fn implicit_terms(&self, length: R, rate: R) -> (R, R) {
        let (x, zero) = (length - self.free_length, R::zero());
        let (k, c) = self.law.implicit_terms(x, rate);
        if !self.tension_only {
            return (k, c);
        }
        let is_taut = |y: R| zero.if_less(x, self.law.force(x, rate).if_less(zero, y, zero), zero);
        (is_taut(k), is_taut(c))
    }

    /// Wrench of a `force` along the line `[N]` on the link of end `k` (0 or 1): moment about the link's origin `[N·m]`
    /// and force `[N]`, in link axes. `x_wl` is the pose of that link in the world `[m]`.
    #[inline(always)]
    pub fn wrench(&self, k: usize, line: &Line<R>, force: R, x_wl: &Pose<R>) -> Force<R> {
        let along = line.direction.scale(if k == 0 { -force } else { force });
        let lin = x_wl.rot.tr_mul_vec(along);
        Force { ang: self.ends[k].position.cross(lin), lin }
    }
}
