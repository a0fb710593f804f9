//! Pairs of surfaces of worlds in lanes that may touch within a step.
//!
//! The rule is that of the broad phase, which looks for contacts where bounding spheres are closer than a margin that
//! grows with their velocities: in lanes where no pair is, a step is that of a world without contacts.

use sincro_math::Real;

use crate::contact::Collider;
use crate::geometry::Surface;
use crate::joint::WORLD;
use crate::kinematics::{frame_pose, frame_velocity, motions};
use crate::mechanism::Mechanism;
use crate::mechanism::constraints::ActivationRule;
use crate::model::{Attached, ConstraintSet};
use crate::spatial::{Mat3, Pose, Vec3};

/// Width of rounding of a margin, relative and in `[m]`: lanes make a step alone where a world may find nothing.
const ROUNDING: f64 = 1e-9;

/// Number of pairs of surfaces up to which lanes look at them.
pub(super) const MAX_PAIRS: usize = 256;

/// Pairs of surfaces that may touch, with the bounding spheres of the surfaces.
#[derive(Clone, Debug)]
pub(super) struct NearPairs<R> {
    pairs: Vec<[usize; 2]>,
    spheres: Vec<Sphere<R>>,
    /// Accelerations, of which nothing is asked.
    zeros: Vec<R>,
}

/// Bounding sphere of a surface.
#[derive(Clone, Debug)]
struct Sphere<R> {
    frame: Attached<R>,
    /// Radius `[m]`; zero of a half-space, which does not move.
    radius: R,
    is_half_space: bool,
    center: Vec3<R>,
    /// Velocity of the centre at the start of the step [m/s], and speed of the surface about it at most.
    velocity: Vec3<R>,
    spin: R,
    /// Largest speeds of the surface at start and end of the step, added [m/s].
    speeds: R,
}

impl<R: Real> Sphere<R> {
    fn new(collider: &Collider) -> Self {
        let number = |x: f64| R::splat(x);
        let rotation = Mat3(collider.pose.rot.0.map(|row| row.map(number)));
        let pose = Pose { rot: rotation, pos: Vec3(collider.pose.pos.0.map(number)) };
        let is_half_space = matches!(collider.surface, Surface::HalfSpace);
        Self {
            frame: Attached { link: (collider.link != WORLD).then_some(collider.link as usize), pose },
            radius: number(if is_half_space { 0.0 } else { collider.surface.reach() }),
            is_half_space,
            center: Vec3::zero(),
            velocity: Vec3::zero(),
            spin: R::zero(),
            speeds: R::zero(),
        }
    }
}

impl<R: Real> NearPairs<R> {
    /// Pairs of a model with `n_v` velocities; `None` if none can touch.
    pub fn new(set: &ConstraintSet, n_v: usize) -> Option<Self> {
        let pairs: Vec<_> = set.pairs.iter().filter(|pair| !pair.is_ignored).map(|pair| [pair.a, pair.b]).collect();
        let spheres = set.colliders.iter().map(Sphere::new).collect();
        (!pairs.is_empty()).then(|| Self { pairs, spheres, zeros: vec![R::zero(); n_v] })
    }

    /// Finds 1 for each lane in which a pair may touch within a step of length `h` `[s]` from the coordinates `q` (n_q)
    /// with the velocities `v` (n_v), at its start or at its end, under the strongest gravity [m/s²]; else 0.
    #[inline(always)]
    pub fn find(
        &mut self,
        mechanism: &mut Mechanism<R>,
        (q, v): (&[R], &[R]),
        (h, gravity): (f64, R),
        is_end: bool,
    ) -> R {
        motions(&mechanism.model, q, v, &self.zeros, &mut mechanism.scratch);
        for sphere in &mut self.spheres {
            let velocity = frame_velocity(&mechanism.scratch, &sphere.frame);
            let spin = velocity.ang.norm() * sphere.radius;
            let speed = velocity.lin.norm() + spin;
            if is_end {
                sphere.speeds += speed;
            } else {
                sphere.center = frame_pose(&mechanism.scratch, &sphere.frame).pos;
                (sphere.velocity, sphere.spin, sphere.speeds) = (velocity.lin, spin, speed);
            }
        }
        let [base, time] = ActivationRule::margin_of_step(h, gravity);
        let mut near = R::zero();
        for &[a, b] in &self.pairs {
            let (a, b) = (&self.spheres[a], &self.spheres[b]);
            let moved = if is_end { a.speeds + b.speeds } else { (a.velocity - b.velocity).norm() + a.spin + b.spin };
            let margin = (base + time * moved) * R::splat(1.0 + ROUNDING) + R::splat(ROUNDING);
            let between = a.center - b.center;
            let gap = if b.is_half_space {
                b.frame.pose.rot.col(2).dot(between) - a.radius
            } else {
                between.norm() - (a.radius + b.radius)
            };
            near = near.max(margin.if_less(gap, R::zero(), R::one()));
        }
        near
    }
}
