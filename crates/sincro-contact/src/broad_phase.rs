//! Broad phase: pairs of surfaces whose bounding spheres are close, by sweep and prune along the x axis.
//!
//! The intervals of all bounded surfaces are sorted along x, and only those that overlap, along y and z too, are looked
//! at; a half-space is looked at with every surface. The pairs come in the order of their indices, so that nothing
//! depends on the method. A few pairs are all looked at. Source: key `ericson2004`, section 7.5.

use super::{Collider, Pair, Surface};
use crate::WORLD;
use sincro_geometry::spatial::{Pose, Vec3};

/// Number of pairs up to which all of them are looked at.
const FEW: usize = 64;

/// Distance up to which surfaces are looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// Margin of any pair `[m]`.
    pub base: f64,
    /// Time over which their relative motion adds to it `[s]`; 0: it does not.
    pub time: f64,
}

impl Margin {
    /// The same margin for every pair.
    #[inline]
    #[must_use]
    pub fn of(base: f64) -> Self {
        Self { base, time: 0.0 }
    }

    /// Margin of a pair `[m]`.
    #[inline]
    fn of_pair(self, a: &Ball, b: &Ball) -> f64 {
        let Self { base, time } = self;
        if time > 0.0 { base + time * ((a.velocity - b.velocity).norm() + a.spin + b.spin) } else { base }
    }
}

/// Bounding sphere of a surface, moving.
#[derive(Clone, Copy, Debug)]
struct Ball {
    center: Vec3<f64>,
    radius: f64,
    /// Velocity of the centre [m/s], and speed of the surface about it at most.
    velocity: Vec3<f64>,
    spin: f64,
    /// True if pairs of it with others of this kind are passed over.
    is_left_out: bool,
}

/// Interval of a surface along x, with its centre and reach along y and z `[m]`.
#[derive(Clone, Copy, Debug)]
struct Interval {
    from: f64,
    to: f64,
    y: f64,
    z: f64,
    reach: f64,
    collider: u32,
}

impl Interval {
    /// Returns true if the intervals of two surfaces overlap along y and z.
    #[inline]
    fn overlaps(&self, other: &Self) -> bool {
        let reach = self.reach + other.reach;
        (self.y - other.y).abs() <= reach && (self.z - other.z).abs() <= reach
    }
}

/// Broad phase with its working memory.
#[derive(Clone, Debug)]
pub(crate) struct BroadPhase {
    /// Radius of the bounding sphere of each surface `[m]`.
    radii: Vec<f64>,
    balls: Vec<Ball>,
    /// Surfaces without bounds.
    unbounded: Vec<u32>,
    intervals: Vec<Interval>,
    /// Pair of each two surfaces, row by row below the diagonal; empty where all pairs are looked at.
    pair_of: Vec<u32>,
    /// Pairs found, in increasing order.
    pub near: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl BroadPhase {
    pub fn new(colliders: &[Collider], pairs: &[Pair]) -> Self {
        let mut pair_of = Vec::new();
        if pairs.len() > FEW {
            pair_of.resize(colliders.len() * colliders.len().saturating_sub(1) / 2, NONE);
            for (k, pair) in pairs.iter().enumerate() {
                pair_of[place(pair.a, pair.b)] = k as u32;
            }
        }
        let is_unbounded = |k: &usize| matches!(colliders[*k].surface, Surface::HalfSpace);
        Self {
            radii: colliders.iter().map(|c| c.surface.reach()).collect(),
            balls: Vec::with_capacity(colliders.len()),
            unbounded: (0..colliders.len()).filter(is_unbounded).map(|k| k as u32).collect(),
            intervals: Vec::new(),
            pair_of,
            near: Vec::with_capacity(pairs.len().min(FEW)),
        }
    }

    /// Radius of the bounding sphere of surface `k` `[m]`.
    pub fn radius(&self, k: usize) -> f64 {
        self.radii[k]
    }

    /// Margin of a pair `[m]`, as last found.
    #[inline]
    pub fn margin(&self, pair: &Pair, margin: Margin) -> f64 {
        margin.of_pair(&self.balls[pair.a], &self.balls[pair.b])
    }

    /// Finds the pairs whose bounding spheres are closer than their margin; `velocity` gives the velocity of a surface
    /// at a point [m/s] and its angular speed [rad/s]. Pairs both surfaces of which are left out are passed over.
    pub fn find(
        &mut self,
        (colliders, pairs): (&[Collider], &[Pair]),
        poses: &[Pose<f64>],
        margin: Margin,
        velocity: impl Fn(&Collider, Vec3<f64>) -> (Vec3<f64>, f64),
        is_left_out: impl Fn(&Collider) -> bool,
    ) {
        self.balls.clear();
        self.near.clear();
        if colliders.iter().all(&is_left_out) {
            return;
        }
        for (collider, radius) in colliders.iter().zip(&self.radii) {
            let center = center(collider, poses);
            let (mut ball_velocity, mut spin) = (Vec3::zero(), 0.0);
            if margin.time > 0.0 {
                let angular_speed;
                (ball_velocity, angular_speed) = velocity(collider, center);
                // a fixed surface may be unbounded
                spin = if angular_speed > 0.0 { angular_speed * radius } else { 0.0 };
            }
            let is_left_out = is_left_out(collider);
            self.balls.push(Ball { center, radius: *radius, velocity: ball_velocity, spin, is_left_out });
        }
        if self.pair_of.is_empty() {
            for (k, pair) in pairs.iter().enumerate() {
                if is_near(&self.balls, colliders, pair, margin) {
                    self.near.push(k as u32);
                }
            }
            return;
        }
        self.sweep((colliders, pairs), margin);
        self.near.sort_unstable();
    }

    fn sweep(&mut self, (colliders, pairs): (&[Collider], &[Pair]), margin: Margin) {
        let Self { balls, intervals, unbounded, near, pair_of, .. } = self;
        intervals.clear();
        for (k, ball) in balls.iter().enumerate() {
            if !unbounded.contains(&(k as u32)) {
                // half of what a pair may be apart
                let reach = ball.radius + 0.5 * margin.base + margin.time * (ball.velocity.norm() + ball.spin);
                let Vec3([x, y, z]) = ball.center;
                intervals.push(Interval { from: x - reach, to: x + reach, y, z, reach, collider: k as u32 });
            }
        }
        intervals.sort_unstable_by(|a, b| a.from.total_cmp(&b.from).then(a.collider.cmp(&b.collider)));
        let mut look = |a: u32, b: u32| {
            if balls[a as usize].is_left_out && balls[b as usize].is_left_out {
                return;
            }
            let k = pair_of[place(a as usize, b as usize)];
            if k != NONE && is_near(balls, colliders, &pairs[k as usize], margin) {
                near.push(k);
            }
        };
        for (i, one) in intervals.iter().enumerate() {
            for two in intervals[i + 1..].iter().take_while(|two| two.from <= one.to) {
                if one.overlaps(two) {
                    look(one.collider, two.collider);
                }
            }
            for fixed in unbounded.iter() {
                look(one.collider, *fixed);
            }
        }
    }
}

/// Place of two surfaces in a triangular table.
fn place(a: usize, b: usize) -> usize {
    let (low, high) = (a.min(b), a.max(b));
    high * (high - 1) / 2 + low
}

/// Returns true if the bounding spheres of a pair are closer than its margin.
#[inline]
fn is_near(balls: &[Ball], colliders: &[Collider], pair: &Pair, margin: Margin) -> bool {
    let (a, b) = (&balls[pair.a], &balls[pair.b]);
    !(a.is_left_out && b.is_left_out)
        && are_close((a.center, a.radius), &colliders[pair.b], (b.center, b.radius), margin.of_pair(a, b))
}

/// Returns true if the bounding spheres of two surfaces, each a centre and a radius, are closer than `margin` `[m]`; of
/// a half-space b the surface itself counts.
#[inline]
pub(super) fn are_close(
    (center_a, radius_a): (Vec3<f64>, f64),
    b: &Collider,
    (center_b, radius_b): (Vec3<f64>, f64),
    margin: f64,
) -> bool {
    if let Surface::HalfSpace = b.surface {
        return b.pose.rot.col(2).dot(center_a - b.pose.pos) <= radius_a + margin;
    }
    let (d, reach) = (center_a - center_b, radius_a + radius_b + margin);
    d.dot(d) <= reach * reach
}

/// Centre of a surface's bounding sphere, in the world.
#[inline]
pub(super) fn center(c: &Collider, poses: &[Pose<f64>]) -> Vec3<f64> {
    if c.link == WORLD { c.pose.pos } else { poses[c.link as usize].point(c.pose.pos) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Material, pairs};
    use sincro_geometry::Shape;

    #[test]
    fn sweep_and_prune_finds_what_a_look_at_all_pairs_finds() {
        let mut seed = 11_u64;
        let mut number = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..20 {
            let material = Material::default();
            let collider =
                |link: u32, pose, surface| Collider { name: String::new(), body: None, link, pose, surface, material };
            let plane = collider(WORLD, Pose::identity(), Surface::HalfSpace);
            let balls = (0..40).map(|k| {
                let surface = Surface::Solid(Shape::Sphere { radius: 0.02 + 0.1 * number() });
                collider(k, Pose::identity(), surface)
            });
            let colliders: Vec<_> = std::iter::once(plane).chain(balls).collect();
            let pairs = pairs(&colliders, |_, _| false, |_, _| crate::PairLaw::default());
            let mut point = |size: f64| Vec3(std::array::from_fn(|_| size * (number() - 0.3)));
            let poses: Vec<_> = (0..40).map(|_| Pose { pos: point(1.0), ..Pose::identity() }).collect();
            let velocities: Vec<_> = (0..40).map(|_| point(4.0)).collect();
            let velocity =
                |c: &Collider, _| (if c.link == WORLD { Vec3::zero() } else { velocities[c.link as usize] }, 0.5);
            for margin in [Margin::of(0.01), Margin { base: 1e-3, time: 0.02 }] {
                let mut swept = BroadPhase::new(&colliders, &pairs);
                let mut looked = BroadPhase { pair_of: Vec::new(), ..BroadPhase::new(&colliders, &pairs) };
                swept.find((&colliders, &pairs), &poses, margin, velocity, |_| false);
                looked.find((&colliders, &pairs), &poses, margin, velocity, |_| false);
                assert!(!swept.pair_of.is_empty() && swept.near.len() > 10, "{}", swept.near.len());
                assert_eq!(swept.near, looked.near);
                let is_left_out = |c: &Collider| c.link == WORLD || c.link.is_multiple_of(3);
                looked.near.retain(|k| {
                    let Pair { a, b, .. } = pairs[*k as usize];
                    !(is_left_out(&colliders[a]) && is_left_out(&colliders[b]))
                });
                swept.find((&colliders, &pairs), &poses, margin, velocity, is_left_out);
                assert_eq!(swept.near, looked.near);
            }
        }
    }
}
