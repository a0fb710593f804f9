//! Closest points of two surfaces, and of a surface and a point. The distance is 0 where solids overlap; a mesh or
//! height field is the set of its triangles and has no inside. Spheres, capsules, cuboids, hulls, half spaces and
//! triangles are exact to rounding, cylinders and cones to about 1e-12 of their size.

use super::Geometry;
use super::bvh::Bvh;
use super::gjk::{Convex, Separation, gjk};
use super::support::{Core, POINT, Placed, Solid};
use crate::spatial::{Pose, Vec3};

/// Tolerance on opposite normals of two half spaces that have a distance between them.
const OPPOSITE: f64 = 1e-12;

/// Closest points of two surfaces, from [`Geometry::closest`] or [`Geometry::closest_to`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Distance of the two points `[m]`; 0 if the surfaces overlap.
    pub distance: f64,
    /// Point on the first surface and point on the second, both in the frame of the first `[m]`; one common point if
    /// the surfaces overlap.
    pub points: [Vec3<f64>; 2],
}

impl Closest {
    fn turned(self) -> Self {
        Self { points: [self.points[1], self.points[0]], ..self }
    }

    fn moved(self, x: &Pose<f64>) -> Self {
        Self { points: self.points.map(|p| x.point(p)), ..self }
    }
}

impl Geometry {
    /// Returns the closest points of this surface (the first) and `other`, whose pose in this surface's frame is `x_ab`
    /// `[m]`; `None` if they are farther apart than `max_distance` `[m]`. For distance sensors and clearance checks.
    ///
    /// ```
    /// use sincro_geometry::spatial::{Pose, Vec3};
    /// use sincro_geometry::{Geometry, Shape, Surface};
    ///
    /// let ball = Geometry::new(Surface::Solid(Shape::Sphere { radius: 0.5 })).unwrap();
    /// let x_ab = Pose::translation(Vec3([3.0, 0.0, 0.0]));
    /// let closest = ball.closest(&ball, &x_ab, 10.0).unwrap();
    /// assert!((closest.distance - 2.0).abs() < 1e-12); // [m]
    /// assert!(ball.closest(&ball, &x_ab, 1.0).is_none());
    /// ```
    #[must_use]
    pub fn closest(&self, other: &Self, x_ab: &Pose<f64>, max_distance: f64) -> Option<Closest> {
        let place = |core, radius, pose| Placed { core, radius, pose };
        let x_ba = || x_ab.inverse();
        let found = match (self.solid(), other.solid()) {
            (Solid::Convex(a, r), Solid::Convex(b, s)) => {
                Some(closest_points(&place(a, r, Pose::identity()), &place(b, s, *x_ab)))
            }
            (Solid::HalfSpace, Solid::Convex(b, s)) => Some(over_half_space(&place(b, s, *x_ab))),
            (Solid::Convex(a, r), Solid::HalfSpace) => Some(over_half_space(&place(a, r, x_ba())).turned().moved(x_ab)),
            (Solid::HalfSpace, Solid::HalfSpace) => Some(half_spaces(x_ab)),
            (Solid::HalfSpace, Solid::Triangles(bvh)) => triangles_over(bvh, x_ab),
            (Solid::Triangles(bvh), Solid::HalfSpace) => triangles_over(bvh, &x_ba()).map(|c| c.turned().moved(x_ab)),
            (Solid::Triangles(bvh), Solid::Convex(b, s)) => {
                convex_and_triangles(&place(b, s, *x_ab), other.reach, bvh, max_distance).map(Closest::turned)
            }
            (Solid::Convex(a, r), Solid::Triangles(bvh)) => {
                convex_and_triangles(&place(a, r, x_ba()), self.reach, bvh, max_distance).map(|c| c.moved(x_ab))
            }
            (Solid::Triangles(one), Solid::Triangles(two)) => triangles(one, two, x_ab, max_distance),
        };
        found.filter(|closest| closest.distance <= max_distance)
    }

    /// Returns the point of this surface closest to `p` (first) and `p` itself (second), both in this surface's frame
    /// `[m]`. Inside a solid or half space the distance is 0; `None` for a mesh or height field without triangles.
    #[must_use]
    pub fn closest_to(&self, p: Vec3<f64>) -> Option<Closest> {
        let point = Placed { core: POINT, radius: 0.0, pose: Pose::translation(p) };
        match self.solid() {
            Solid::Convex(core, radius) => {
                Some(closest_points(&Placed { core, radius, pose: Pose::identity() }, &point))
            }
            Solid::HalfSpace => Some(over_half_space(&point)),
            Solid::Triangles(bvh) => convex_and_triangles(&point, 0.0, bvh, f64::INFINITY).map(Closest::turned),
        }
    }
}

/// Two convex sets with their roundings.
pub(super) fn closest_points(a: &Placed<'_>, b: &Placed<'_>) -> Closest {
    let Separation { distance, points: [p, q] } = gjk(a, b);
    let apart = distance - a.radius - b.radius;
    if distance > 0.0 {
        let towards = (q - p).scale(1.0 / distance);
        if apart > 0.0 {
            return Closest { distance: apart, points: [p + towards.scale(a.radius), q - towards.scale(b.radius)] };
        }
        // inside both: the middle of where the roundings overlap
        let inside = 0.5 * (a.radius.min(distance) + (distance - b.radius).max(0.0));
        return Closest { distance: 0.0, points: [p + towards.scale(inside); 2] };
    }
    Closest { distance: 0.0, points: [p, q] }
}

/// The half space z ≤ 0 and a convex set.
fn over_half_space(b: &Placed<'_>) -> Closest {
    let down = Vec3([0.0, 0.0, -1.0]);
    let lowest = b.support(down) + down.scale(b.radius);
    over(lowest)
}

/// The half space z ≤ 0 and the lowest point of a set.
fn over(lowest: Vec3<f64>) -> Closest {
    let foot = Vec3([lowest[0], lowest[1], 0.0]);
    if lowest[2] > 0.0 {
        Closest { distance: lowest[2], points: [foot, lowest] }
    } else {
        Closest { distance: 0.0, points: [lowest; 2] }
    }
}

fn half_spaces(x_ab: &Pose<f64>) -> Closest {
    let normal = x_ab.rot.col(2);
    let is_opposite = normal[2] < 0.0 && normal[0].abs().max(normal[1].abs()) < OPPOSITE;
    if is_opposite {
        return over(x_ab.pos);
    }
    // two half spaces that are not opposite meet: far down both normals
    let p = x_ab.pos;
    let depth = p[2].abs() + normal.dot(p).abs() + 1.0;
    let down = Vec3([0.0, 0.0, 1.0]) + normal;
    let along = 1.0 + normal[2];
    let point = if along > 0.0 { down.scale(-depth / along) } else { p };
    Closest { distance: 0.0, points: [point; 2] }
}

fn triangles_over(bvh: &Bvh, x_ab: &Pose<f64>) -> Option<Closest> {
    let corners = bvh.triangles().iter().flatten().map(|c| x_ab.point(*c));
    corners.reduce(|low, c| if c[2] < low[2] { c } else { low }).map(over)
}

/// A convex set, within `reach` of its frame's origin, and triangles, in the frame of the triangles; its point first.
fn convex_and_triangles(a: &Placed<'_>, reach: f64, bvh: &Bvh, max_distance: f64) -> Option<Closest> {
    let mut best: Option<Closest> = None;
    bvh.visit(a.pose.pos, reach, max_distance, &mut |triangle, max_distance| {
        let placed = Placed { core: Core::Triangle(*triangle), radius: 0.0, pose: Pose::identity() };
        let found = closest_points(a, &placed);
        if found.distance > max_distance || best.is_some_and(|best| found.distance >= best.distance) {
            return None;
        }
        best = Some(found);
        Some(found.distance)
    });
    best
}

fn triangles(one: &Bvh, two: &Bvh, x_ab: &Pose<f64>, max_distance: f64) -> Option<Closest> {
    if one.triangles().len() > two.triangles().len() {
        return triangles(two, one, &x_ab.inverse(), max_distance).map(|c| c.turned().moved(x_ab));
    }
    let (x_ba, mut best) = (x_ab.inverse(), None::<Closest>);
    for triangle in one.triangles() {
        let limit = best.map_or(max_distance, |best| best.distance);
        let corners = triangle.map(|c| x_ba.point(c));
        let middle = (corners[0] + corners[1] + corners[2]).scale(1.0 / 3.0);
        let reach = corners.iter().map(|c| (*c - middle).norm()).fold(0.0, f64::max);
        let around = corners.map(|c| c - middle);
        let placed = Placed { core: Core::Triangle(around), radius: 0.0, pose: Pose::translation(middle) };
        if let Some(found) = convex_and_triangles(&placed, reach, two, limit)
            && best.is_none_or(|best| found.distance < best.distance)
        {
            best = Some(found);
        }
        if best.is_some_and(|best| best.distance == 0.0) {
            break;
        }
    }
    best.map(|c| c.moved(x_ab))
}
