//! Contact manifolds of the pairs without a closed form, from the collision library parry.
//!
//! A point of a manifold becomes a contact candidate of the parts of the surfaces that it is on: spheres, capsules and
//! the flanks and rims of cylinders keep their curvature, flat faces and edges are exact. Where parts are not told
//! apart (hulls, meshes, cones, two rims) it is a point of one body over a plane of the other. The library's memory
//! between calls is discarded, because a result must not depend on the past.

use std::cmp::Ordering;

use parry3d_f64::math::{Pose as LibraryPose, Vector};
use parry3d_f64::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
};

use super::candidate::{ContactCandidate, Edge, Feature};
use super::{Collider, Pair, PairKind, Surface};
use sincro_geometry::Shape;
use sincro_geometry::parry::{ParryShape, parry_pose, vec3};
use sincro_geometry::spatial::{Pose, Vec3};

/// A normal is across an axis if its component along it is below this: the library finds normals to about 1e-8.
const ACROSS: f64 = 1e-6;

/// Distance within which the library finds points `[m]`.
const FOUND: f64 = 1e-5;

/// Distance from the lowest point of a rim over a plane, relative to its radius, within which a point is that.
const LOWEST: f64 = 1e-3;

/// Sine of the angle between two edges below which they do not cross in one point.
const CROSSES: f64 = 1e-2;

/// Least distance of a point from a point or line by which the contact is told, relative to the rounding.
const LEAST_OUTSIDE: f64 = 0.1;

/// Maximum number of turns of Newton's method.
const MAX_TURNS: usize = 8;

/// Points of a manifold closer than this are one `[m]`.
const SAME_POINT: f64 = 1e-6;

/// The library's shapes, one manifold list a pair.
#[derive(Clone)]
pub(crate) struct Manifolds {
    shapes: Vec<Option<ParryShape>>,
    pairs: Vec<Vec<ContactManifold<(), ()>>>,
    workspace: Option<ContactManifoldsWorkspace>,
    /// Every point found, in the library's order.
    found: Vec<Found>,
    /// Places on the first surface of the points found.
    places: Vec<Vec3<f64>>,
}

/// A point of a manifold.
#[derive(Clone, Copy)]
struct Found {
    /// Distance of the surfaces there `[m]`.
    distance: f64,
    /// Number of points found before it.
    order: u32,
    candidate: ContactCandidate,
}

impl std::fmt::Debug for Manifolds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Manifolds").field("pairs", &self.pairs.len()).finish_non_exhaustive()
    }
}

impl Manifolds {
    pub fn new(colliders: &[Collider], pairs: &[Pair]) -> Self {
        let mut is_general = vec![false; colliders.len()];
        for pair in pairs.iter().filter(|p| matches!(p.kind, PairKind::General | PairKind::DiscsOnCuboid)) {
            (is_general[pair.a], is_general[pair.b]) = (true, true);
        }
        let shapes =
            colliders.iter().zip(is_general).map(|(c, general)| general.then(|| ParryShape::of(&c.surface)).flatten());
        Self {
            shapes: shapes.collect(),
            pairs: vec![Vec::new(); pairs.len()],
            workspace: None,
            found: Vec::new(),
            places: Vec::new(),
        }
    }

    /// Writes the candidates of pair `k`: the deepest ones, in the library's order.
    pub fn find(
        &mut self,
        k: usize,
        (i, j): (usize, usize),
        (a, b): (&Collider, &Collider),
        (at_a, at_b): (&Pose<f64>, &Pose<f64>),
        margin: f64,
        slots: &mut [Option<ContactCandidate>],
    ) {
        let (Some(one), Some(two)) = (&self.shapes[i], &self.shapes[j]) else { return };
        let (x_1, x_2) = (at_a.compose(&one.pose), at_b.compose(&two.pose));
        let (x_12, x_ab) = (x_1.inverse().compose(&x_2), at_a.inverse().compose(at_b));
        let manifolds = &mut self.pairs[k];
        self.found.clear();
        self.places.clear();
        if let [manifold] = &mut manifolds[..]
            && is_convex(a)
            && is_convex(b)
        {
            // keeps its room, forgets its points and the normal that the search would begin with
            manifold.clear();
            (manifold.local_n1, manifold.local_n2) = (Vector::ZERO, Vector::ZERO);
        } else {
            manifolds.clear();
        }
        self.workspace = None;
        let (g1, g2) = (&*one.shape.0, &*two.shape.0);
        let done = DefaultQueryDispatcher.contact_manifolds(
            &parry_pose(&x_12),
            g1,
            g2,
            margin,
            manifolds,
            &mut self.workspace,
        );
        if done.is_err() {
            return;
        }
        for manifold in manifolds.iter() {
            let side = |pose: Option<&LibraryPose>, p: Vector| vec3(pose.map_or(p, |pose| *pose * p));
            let turned = |pose: Option<&LibraryPose>, n: Vector| vec3(pose.map_or(n, |pose| pose.rotation * n));
            let n_1 = turned(manifold.subshape_pos1(), manifold.local_n1);
            // the normal in both surfaces' frames, out of each
            let n_a = one.pose.rot.mul_vec(n_1);
            let n_b = -at_b.rot.tr_mul_vec(at_a.rot.mul_vec(n_a));
            for point in manifold.points.iter().filter(|p| p.dist <= margin) {
                let p_a = one.pose.point(side(manifold.subshape_pos1(), point.local_p1));
                let p_b = two.pose.point(side(manifold.subshape_pos2(), point.local_p2));
                // where edges lie on edges, the library finds a corner of each
                let is_there =
                    |known: &Vec3<f64>| (p_a[0] - known[0]).abs() < SAME_POINT && (p_a - *known).norm() < SAME_POINT;
                if !self.places.iter().any(is_there) {
                    let (order, candidate) = (self.found.len() as u32, candidate((a, p_a, n_a), (b, p_b, n_b), &x_ab));
                    self.found.push(Found { distance: point.dist, order, candidate });
                    self.places.push(p_a);
                }
            }
        }
        fill(&mut self.found, slots);
    }
}

/// Writes the deepest candidates, in the order found; of equally deep ones the last.
fn fill(found: &mut Vec<Found>, slots: &mut [Option<ContactCandidate>]) {
    if slots.is_empty() {
        return;
    }
    if found.len() > slots.len() {
        found.select_nth_unstable_by(slots.len() - 1, |a, b| {
            a.distance.partial_cmp(&b.distance).unwrap_or(Ordering::Equal).then(b.order.cmp(&a.order))
        });
        found.truncate(slots.len());
        found.sort_unstable_by_key(|point| point.order);
    }
    for (slot, point) in slots.iter_mut().zip(found) {
        *slot = Some(point.candidate);
    }
}

/// Returns true if a pair of such surfaces has one manifold.
pub(crate) fn is_convex(c: &Collider) -> bool {
    matches!(c.surface, Surface::Solid(_) | Surface::Hull(_) | Surface::HalfSpace)
}

/// Contact candidate from the closest points of two surfaces and the outward normals there, all in the surfaces' own
/// frames: of what the points are on, where that is known, else of a point over a plane.
fn candidate(
    (a, p_a, n_a): (&Collider, Vec3<f64>, Vec3<f64>),
    (b, p_b, n_b): (&Collider, Vec3<f64>, Vec3<f64>),
    x_ab: &Pose<f64>,
) -> ContactCandidate {
    let (on_a, on_b) = (element(a, p_a, n_a), element(b, p_b, n_b));
    // of hulls and meshes it is not known whether they touch with a face
    if on_a.kind == Kind::Face && on_b.kind != Kind::Face && matches!(b.surface, Surface::Solid(_)) {
        return over_plane((b, p_b, on_b), (a, p_a, n_a), &x_ab.inverse());
    }
    between((a, on_a), (b, on_b, n_b), x_ab)
        .or_else(|| between((b, on_b), (a, on_a, n_a), &x_ab.inverse()))
        .unwrap_or_else(|| {
            if on_a.radius == 0.0 && on_b.radius > 0.0 {
                over_plane((b, p_b, on_b), (a, p_a, n_a), &x_ab.inverse())
            } else {
                over_plane((a, p_a, on_a), (b, p_b, n_b), x_ab)
            }
        })
}

/// Candidate of an element of a over a line, circle or point of b, `n_b` outwards from b; none where that is no smooth
/// contact.
fn between(
    (a, on_a): (&Collider, Element),
    (b, on_b, n_b): (&Collider, Element, Vec3<f64>),
    x_ab: &Pose<f64>,
) -> Option<ContactCandidate> {
    let radius = on_a.radius + on_b.radius;
    let (n, o) = (x_ab.rot.mul_vec(n_b), x_ab.point(on_b.point));
    let origin = b.pose.point(on_b.point);
    let is_edge = matches!(on_a.kind, Kind::Line(_) | Kind::Rim(_));
    if let (Kind::Line(w), true) = (on_b.kind, is_edge)
        && let Some((point, u, curvature)) = crossing_edge(on_a, (o, x_ab.rot.mul_vec(w)))
    {
        let w = if u.cross(x_ab.rot.mul_vec(w)).dot(n) < 0.0 { -w } else { w };
        let [direction, curvature] = [u, curvature].map(|v| a.pose.rot.mul_vec(v));
        let line = Feature::Line { origin, direction: b.pose.rot.mul_vec(w) };
        return Some(whole((a, on_a), b, point, radius, Some(Edge::Crossing { direction, curvature }), line));
    }
    let feature = match (on_a.kind, on_b.kind) {
        (Kind::Point, Kind::Point) => Feature::Point { origin },
        (Kind::Point, Kind::Rim(radius)) => {
            let origin = b.pose.point(Vec3([0.0, 0.0, on_b.point[2]]));
            Feature::Circle { origin, axis: b.pose.rot.col(2), radius }
        }
        // along a flank that is parallel to the line, or next to where it crosses it
        (Kind::Point | Kind::Line(_), Kind::Line(w)) => Feature::Line { origin, direction: b.pose.rot.mul_vec(w) },
        _ => return None,
    };
    // a distance from a point or line says nothing from inside of it
    let is_outside = n.dot(on_a.point - o) > LEAST_OUTSIDE * radius;
    (radius > 0.0 && is_outside).then(|| whole((a, on_a), b, on_a.point, radius, None, feature))
}

/// Point of an edge of a that is nearest to a line through `o` along the unit vector `w`, the tangent and the curvature
/// of the edge there; none where they do not cross at about the point found.
fn crossing_edge(on_a: Element, (o, w): (Vec3<f64>, Vec3<f64>)) -> Option<(Vec3<f64>, Vec3<f64>, Vec3<f64>)> {
    let (point, u, curvature) = match on_a.kind {
        Kind::Line(u) => {
            let across = |v: Vec3<f64>| v - w.scale(w.dot(v));
            let along = across(o - on_a.point).dot(u) / across(u).dot(u);
            (on_a.point + u.scale(along), u, Vec3::zero())
        }
        Kind::Rim(radius) => {
            let point = nearest_of_rim(on_a.point, radius, (o, w))?;
            let (tangent, curvature) = around(point, radius);
            (point, tangent, curvature)
        }
        _ => return None,
    };
    let crosses = u.cross(w).norm() > CROSSES && (point - on_a.point).norm() < 10.0 * FOUND;
    crosses.then_some((point, u, curvature))
}

/// Candidate of a point of a, in the frame of its surface.
fn whole(
    (a, on_a): (&Collider, Element),
    b: &Collider,
    point: Vec3<f64>,
    radius: f64,
    edge: Option<Edge>,
    feature: Feature,
) -> ContactCandidate {
    let point = a.pose.point(point);
    ContactCandidate { a: a.link, b: b.link, point, radius, radius_a: on_a.radius, edge, feature, id: 0 }
}

/// Candidate of an element of a over the plane through `p_b` with normal `n_b`.
fn over_plane(
    (a, p_a, on_a): (&Collider, Vec3<f64>, Element),
    (b, p_b, n_b): (&Collider, Vec3<f64>, Vec3<f64>),
    x_ab: &Pose<f64>,
) -> ContactCandidate {
    let feature = Feature::Plane { origin: b.pose.point(p_b), normal: b.pose.rot.mul_vec(n_b) };
    if let Kind::Rim(radius) = on_a.kind {
        // of a flat end on a face the library gives other points of the rim than the lowest one
        let n = x_ab.rot.mul_vec(n_b);
        let size = (n[0] * n[0] + n[1] * n[1]).sqrt();
        let lowest = Vec3([-radius * n[0] / size, -radius * n[1] / size, on_a.point[2]]);
        if (lowest - on_a.point).norm() < LOWEST * radius {
            let rim = Edge::Rim { axis: a.pose.rot.col(2), radius };
            return whole((a, on_a), b, Vec3([0.0, 0.0, on_a.point[2]]), 0.0, Some(rim), feature);
        }
    }
    // a rounded surface touches under its core, all others where they are found to
    let point = if on_a.radius > 0.0 { on_a.point } else { p_a };
    whole((a, on_a), b, point, on_a.radius, None, feature)
}

/// Part of a surface that one of its points is on, rounded: in the frame of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Element {
    kind: Kind,
    /// Point of the part without its rounding `[m]`.
    point: Vec3<f64>,
    /// Rounding `[m]`.
    radius: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Not told apart: of a curved surface, or a point that the surfaces do not touch at.
    Unknown,
    /// A flat face.
    Face,
    /// A vertex, or the centre of a sphere.
    Point,
    /// A straight edge or the axis of a rounded flank, along this unit vector.
    Line(Vec3<f64>),
    /// The rim of a flat end, a circle of this radius about the z axis.
    Rim(f64),
}

/// Part of a surface at its point `p` with normal `n` outwards.
fn element(c: &Collider, p: Vec3<f64>, n: Vec3<f64>) -> Element {
    let along_z = Kind::Line(Vec3([0.0, 0.0, 1.0]));
    let on_axis = |z: f64, kind: Kind, radius: f64| Element { kind, point: Vec3([0.0, 0.0, z]), radius };
    let sharp = |kind: Kind, point: Vec3<f64>| Element { kind, point, radius: 0.0 };
    let is_flank = n[2].abs() < ACROSS;
    let rim = |radius: f64, z: f64| {
        let size = (p[0] * p[0] + p[1] * p[1]).sqrt();
        if n[0].abs() < ACROSS && n[1].abs() < ACROSS {
            return sharp(Kind::Face, p);
        }
        if (size - radius).abs() > FOUND || (p[2] - z).abs() > FOUND {
            return sharp(Kind::Unknown, p);
        }
        let point = Vec3([p[0] * radius / size, p[1] * radius / size, z]);
        sharp(Kind::Rim(radius), point)
    };
    match c.surface {
        Surface::Solid(Shape::Sphere { radius }) => on_axis(0.0, Kind::Point, radius),
        Surface::Solid(Shape::Capsule { radius, length }) => {
            let (core, end) = (p[2] - n[2] * radius, 0.5 * length);
            if is_flank && core.abs() < end {
                on_axis(core, along_z, radius)
            } else if (core.abs() - end).abs() < FOUND {
                on_axis(if core < 0.0 { -end } else { end }, Kind::Point, radius)
            } else {
                // along a face that is a little tilted
                Element { kind: Kind::Unknown, point: p - n.scale(radius), radius }
            }
        }
        Surface::Solid(Shape::Torus { tube_radius, .. }) => {
            Element { kind: Kind::Point, point: p - n.scale(tube_radius), radius: tube_radius }
        }
        Surface::Solid(Shape::Cylinder { radius, .. }) if is_flank => on_axis(p[2], along_z, radius),
        Surface::Solid(Shape::Cylinder { radius, length }) => {
            rim(radius, if n[2] < 0.0 { -0.5 * length } else { 0.5 * length })
        }
        Surface::Solid(Shape::Cuboid { size }) => {
            let half = size.map(|s| 0.5 * s);
            let free = (0..3).filter(|k| n[*k].abs() < ACROSS).count();
            let to_side = |k: usize| if n[k] < 0.0 { -half[k] } else { half[k] };
            let point = Vec3(std::array::from_fn(|k| if n[k].abs() < ACROSS { p[k] } else { to_side(k) }));
            match free {
                // one more point of a manifold, at which the surfaces do not touch along this normal
                0 | 1 if (point - p).norm() > FOUND => sharp(Kind::Unknown, p),
                0 => sharp(Kind::Point, point),
                1 => sharp(Kind::Line(Vec3(n.0.map(|x| if x.abs() < ACROSS { 1.0 } else { 0.0 }))), point),
                _ => sharp(Kind::Face, p),
            }
        }
        Surface::HalfSpace => sharp(Kind::Face, p),
        _ => sharp(Kind::Unknown, p),
    }
}

/// Unit tangent and curvature vector of a circle of `radius` about the z axis at one of its points.
fn around(p: Vec3<f64>, radius: f64) -> (Vec3<f64>, Vec3<f64>) {
    let square = radius * radius;
    (Vec3([-p[1] / radius, p[0] / radius, 0.0]), Vec3([-p[0] / square, -p[1] / square, 0.0]))
}

/// Point of a circle of `radius` about the z axis that is nearest to a line through `o` along the unit vector `w`, from
/// one close to it, by Newton's method: the library's is that of an approximation. None if there is none so close.
fn nearest_of_rim(start: Vec3<f64>, radius: f64, (o, w): (Vec3<f64>, Vec3<f64>)) -> Option<Vec3<f64>> {
    let mut p = start;
    for _ in 0..MAX_TURNS {
        let (tangent, curvature) = around(p, radius);
        let across = |v: Vec3<f64>| v - w.scale(w.dot(v));
        let d = across(p - o);
        let slope = across(tangent).dot(tangent) + d.dot(curvature);
        let step = -d.dot(tangent) / slope;
        if step.is_nan() || step.abs() > 0.1 * radius || slope <= 0.0 {
            return None;
        }
        let moved = p + tangent.scale(step);
        let size = (moved[0] * moved[0] + moved[1] * moved[1]).sqrt();
        p = Vec3([moved[0] * radius / size, moved[1] * radius / size, p[2]]);
        if step.abs() < 1e-14 * radius {
            break;
        }
    }
    ((p - start).norm() < 10.0 * FOUND).then_some(p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::WORLD;

    #[test]
    fn the_deepest_points_stay_in_the_order_found() {
        let plane = Feature::Plane { origin: Vec3::zero(), normal: Vec3([0.0, 0.0, 1.0]) };
        let mut state = 1_u64;
        for n in 0..40 {
            // few different distances, so that many are equal
            let mut found: Vec<Found> = (0..n)
                .map(|order| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    let candidate = ContactCandidate {
                        a: 0,
                        b: WORLD,
                        point: Vec3::zero(),
                        radius: 0.0,
                        radius_a: 0.0,
                        edge: None,
                        feature: plane,
                        id: order,
                    };
                    Found { distance: (state >> 33) as f64 % 5.0, order, candidate }
                })
                .collect();
            // one by one, the first of the shallowest goes
            let mut left: Vec<(f64, u32)> = found.iter().map(|point| (point.distance, point.order)).collect();
            while left.len() > 4 {
                let deepest_last = |k: &usize, l: &usize| left[*k].0.total_cmp(&left[*l].0).then(l.cmp(k));
                let shallowest = (0..left.len()).max_by(deepest_last).expect("there are more than four");
                left.remove(shallowest);
            }
            let mut slots = [None; 4];
            fill(&mut found, &mut slots);
            let kept: Vec<u32> = slots.iter().flatten().map(|candidate| candidate.id).collect();
            assert_eq!(kept, left.iter().map(|point| point.1).collect::<Vec<_>>(), "{n} points");
        }
    }
}
