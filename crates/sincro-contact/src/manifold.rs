//! Contact manifolds of the pairs without a closed form, from the collision library parry.
//!
//! A point of a manifold becomes a contact candidate: a rounded point of one body over a plane of the other, so that
//! spheres, capsules and the flanks of cylinders keep their curvature, and flat faces are exact. The library's memory
//! between calls is discarded, because a result must not depend on the past.

use std::cmp::Ordering;

use parry3d_f64::math::{Pose as LibraryPose, Vector};
use parry3d_f64::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
};

use super::candidate::{ContactCandidate, Feature};
use super::{Collider, Pair, PairKind, Surface};
use sincro_geometry::Shape;
use sincro_geometry::parry::{ParryShape, parry_pose, vec3};
use sincro_geometry::spatial::{Pose, Vec3};

/// A normal is across an axis if its component along it is below this.
const ACROSS: f64 = 1e-9;

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
        for pair in pairs.iter().filter(|p| p.kind == PairKind::General) {
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
        let x_12 = x_1.inverse().compose(&x_2);
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
                    let (order, candidate) = (self.found.len() as u32, candidate((a, p_a, n_a), (b, p_b, n_b)));
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
/// frames.
fn candidate(
    (a, p_a, n_a): (&Collider, Vec3<f64>, Vec3<f64>),
    (b, p_b, n_b): (&Collider, Vec3<f64>, Vec3<f64>),
) -> ContactCandidate {
    let (core_a, core_b) = (core(a, p_a, n_a), core(b, p_b, n_b));
    if core_a.radius == 0.0 && core_b.radius > 0.0 {
        return over_plane((b, core_b), (a, p_a, n_a));
    }
    if core_b.radius == 0.0 {
        return over_plane((a, core_a), (b, p_b, n_b));
    }
    let origin = b.pose.point(core_b.point);
    let feature = match core_b.axis {
        Some(axis) => Feature::Line { origin, direction: b.pose.rot.mul_vec(axis) },
        None => Feature::Point { origin },
    };
    ContactCandidate {
        a: a.link,
        b: b.link,
        point: a.pose.point(core_a.point),
        radius: core_a.radius + core_b.radius,
        radius_a: core_a.radius,
        rim: None,
        feature,
        id: 0,
    }
}

fn over_plane((a, core): (&Collider, Core), (b, p_b, n_b): (&Collider, Vec3<f64>, Vec3<f64>)) -> ContactCandidate {
    ContactCandidate {
        a: a.link,
        b: b.link,
        point: a.pose.point(core.point),
        radius: core.radius,
        radius_a: core.radius,
        rim: None,
        feature: Feature::Plane { origin: b.pose.point(p_b), normal: b.pose.rot.mul_vec(n_b) },
        id: 0,
    }
}

/// Core of a rounded surface under one of its points: centre of curvature and radius.
#[derive(Clone, Copy)]
struct Core {
    point: Vec3<f64>,
    radius: f64,
    /// Direction of the core where it is a line.
    axis: Option<Vec3<f64>>,
}

/// The core under the point `p` with normal `n` outwards.
fn core(c: &Collider, p: Vec3<f64>, n: Vec3<f64>) -> Core {
    let z = Some(Vec3([0.0, 0.0, 1.0]));
    let inside = |radius: f64, axis| Core { point: p - n.scale(radius), radius, axis };
    match c.surface {
        Surface::Solid(Shape::Sphere { radius }) => inside(radius, None),
        Surface::Solid(Shape::Capsule { radius, length }) => {
            let core = inside(radius, None);
            let on_flank = n[2].abs() < ACROSS && core.point[2].abs() < 0.5 * length;
            Core { axis: z.filter(|_| on_flank), ..core }
        }
        Surface::Solid(Shape::Torus { tube_radius, .. }) => inside(tube_radius, None),
        Surface::Solid(Shape::Cylinder { radius, .. }) if n[2].abs() < ACROSS => inside(radius, z),
        _ => Core { point: p, radius: 0.0, axis: None },
    }
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
                        rim: None,
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
