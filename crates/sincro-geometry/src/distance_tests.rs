//! Distances against closed forms, against planes that separate, and against triangle after triangle.

use super::Shape;
use super::gjk::Convex;
use super::parry::parry_pose;
use super::support::{Core, Placed, Solid};
use super::tests::{Numbers, surfaces};
use super::*;
use crate::spatial::{Pose, Quat};

impl Numbers {
    pub(super) fn pose(&mut self, far: f64) -> Pose<f64> {
        let q = Quat { w: self.next(), xyz: self.vector() };
        Pose { rot: q.normalized().matrix(), pos: self.vector().scale(far) }
    }
}

/// A closed box with a dent, and hilly ground.
pub(super) fn with_triangles() -> Vec<Surface> {
    let heights: Vec<f64> = (0..30).map(|k| 0.1 * f64::from((k * 7) % 5)).collect();
    let corners: Vec<[f64; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|b| f64::from(b) - 0.5)).collect();
    let mut corners = corners;
    corners[7] = [0.1, 0.05, 0.1];
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    vec![Surface::Mesh(corners, triangles), Surface::HeightField { columns: 6, heights, size: [2.0, 1.5] }]
}

fn geometries() -> Vec<Geometry> {
    surfaces().into_iter().chain(with_triangles()).map(|s| Geometry::new(s).unwrap()).collect()
}

fn solid(shape: Shape) -> Geometry {
    Geometry::new(Surface::Solid(shape)).unwrap()
}

#[test]
fn balls_cuboids_and_planes_have_their_closed_forms() {
    let mut numbers = Numbers(11);
    let ball = solid(Shape::Sphere { radius: 0.3 });
    let size = [0.6, 0.8, 1.0];
    let (cuboid, capsule) = (solid(Shape::Cuboid { size }), solid(Shape::Capsule { radius: 0.1, length: 0.7 }));
    let ground = Geometry::new(Surface::HalfSpace).unwrap();
    for _ in 0..5_000 {
        let pose = numbers.pose(1.5);
        let p = pose.pos;
        let check = |a: &Geometry, expected: f64| {
            let found = a.closest(&ball, &pose, f64::INFINITY).unwrap();
            assert!(
                (found.distance - expected.max(0.0)).abs() < 2e-15,
                "{:?} {p:?} {expected}: {found:?}",
                a.surface()
            );
        };
        check(&solid(Shape::Sphere { radius: 0.2 }), p.norm() - 0.5);
        let off = Vec3([0, 1, 2].map(|k| (p[k].abs() - 0.5 * size[k]).max(0.0)));
        check(&cuboid, off.norm() - 0.3);
        let axis = Vec3([p[0], p[1], (p[2].abs() - 0.35).max(0.0)]);
        check(&capsule, axis.norm() - 0.4);
        check(&ground, p[2] - 0.3);
        // the lowest corner of the cuboid
        let corner = (0..3).map(|k| 0.5 * size[k] * pose.rot.0[2][k].abs()).sum::<f64>();
        let found = ground.closest(&cuboid, &pose, f64::INFINITY).unwrap().distance;
        assert!((found - (p[2] - corner).max(0.0)).abs() < 1e-15);
    }
}

/// The parts of a surface that are convex, in its frame.
pub(super) fn parts(geometry: &Geometry) -> Vec<Placed<'_>> {
    let placed = |core, radius| Placed { core, radius, pose: Pose::identity() };
    match geometry.solid() {
        Solid::Convex(core, radius) => vec![placed(core, radius)],
        Solid::Triangles(bvh) => bvh.triangles().iter().map(|t| placed(Core::Triangle(*t), 0.0)).collect(),
        Solid::HalfSpace => Vec::new(),
    }
}

/// Extent of a part along `n`.
pub(super) fn along(part: &Placed<'_>, n: Vec3<f64>) -> f64 {
    n.dot(part.support(n)) + part.radius
}

#[test]
fn a_plane_separates_what_is_apart() {
    let (mut numbers, all) = (Numbers(12), geometries());
    for (i, a) in all.iter().enumerate() {
        for (j, b) in all.iter().enumerate() {
            let mut apart = 0;
            for _ in 0..100 {
                let pose = numbers.pose(2.0);
                let found = a.closest(b, &pose, f64::INFINITY).unwrap();
                let back = b.closest(a, &pose.inverse(), f64::INFINITY).unwrap();
                assert!((found.distance - back.distance).abs() < 1e-11, "{i} {j}: {found:?} {back:?}");
                let [p, q] = found.points;
                assert!(((p - q).norm() - found.distance).abs() < 1e-12);
                // both points are on their surfaces
                let on_b = b.closest_to(pose.inverse().point(q)).unwrap().distance;
                assert!(a.closest_to(p).unwrap().distance < 1e-9 && on_b < 1e-9, "{i} {j} {found:?}");
                if found.distance < 1e-3 {
                    continue;
                }
                apart += 1;
                let n = (q - p).scale(1.0 / found.distance);
                let n_b = pose.rot.tr_mul_vec(n);
                let (parts_a, parts_b) = (parts(a), parts(b));
                if parts_a.len() == 1 && parts_b.len() == 1 {
                    assert!(along(&parts_a[0], n) <= n.dot(p) + 1e-12, "{i} {j} {pose:?}");
                    assert!(along(&parts_b[0], -n_b) <= -n_b.dot(pose.inverse().point(q)) + 1e-12, "{i} {j} {pose:?}");
                }
            }
            assert!(apart > 10 || i == j || a.reach().is_infinite() || b.reach().is_infinite(), "{i} {j}: {apart}");
        }
    }
}

#[test]
fn the_tree_finds_what_all_triangles_give() {
    let (mut numbers, all) = (Numbers(13), geometries());
    for a in with_triangles().into_iter().map(|s| Geometry::new(s).unwrap()) {
        for b in all.iter().filter(|b| !b.reach().is_infinite()) {
            for _ in 0..50 {
                let pose = numbers.pose(1.5);
                let mut least = f64::INFINITY;
                for one in parts(&a) {
                    for two in parts(b) {
                        let two = Placed { pose, ..two };
                        least = least.min(super::distance::closest_points(&one, &two).distance);
                    }
                }
                let found = a.closest(b, &pose, f64::INFINITY).unwrap().distance;
                assert!((found - least).abs() < 1e-12, "{:?}: {found} {least}", b.surface());
                assert!(found == 0.0 || a.closest(b, &pose, 0.999 * found).is_none());
            }
        }
    }
}

#[test]
fn distances_are_those_of_the_library_as_far_as_it_goes() {
    let (mut numbers, all) = (Numbers(14), geometries());
    let convex: Vec<&Geometry> = all.iter().filter(|g| parts(g).len() == 1).collect();
    let mut n = 0;
    for a in &convex {
        for b in &convex {
            for _ in 0..100 {
                let pose = numbers.pose(1.5);
                let at = |own: &Geometry, x: &Pose<f64>| parry_pose(&x.compose(&own.library.pose));
                let (at_a, at_b) = (at(a, &Pose::identity()), at(b, &pose));
                let (one, two) = (&*a.library.shape.0, &*b.library.shape.0);
                let theirs = parry3d_f64::query::distance(&at_a, one, &at_b, two).unwrap().distance;
                let ours = a.closest(b, &pose, f64::INFINITY).unwrap().distance;
                n += usize::from(ours > 0.0);
                // the library ends its search where it is within about this
                assert!(
                    ours < theirs + 1e-12 && theirs - ours < 1e-4,
                    "{:?} {:?} {pose:?}: {ours} {theirs}",
                    a.surface(),
                    b.surface()
                );
            }
        }
    }
    assert!(n > 1_000);
}

#[test]
fn what_has_a_point_in_common_has_no_distance() {
    let (mut numbers, all) = (Numbers(15), geometries());
    let inside = |g: &Geometry, p: Vec3<f64>| parts(g).len() == 1 && g.closest_to(p).unwrap().distance == 0.0;
    let mut met = 0;
    for a in &all {
        for b in &all {
            for _ in 0..200 {
                let (pose, p) = (numbers.pose(0.6), numbers.vector().scale(0.5));
                if inside(a, p) && inside(b, pose.inverse().point(p)) {
                    met += 1;
                    assert_eq!(a.closest(b, &pose, f64::INFINITY).unwrap().distance, 0.0);
                }
            }
        }
    }
    assert!(met > 200, "{met}");
}

#[test]
fn half_spaces_are_apart_only_if_they_are_opposite() {
    let ground = Geometry::new(Surface::HalfSpace).unwrap();
    let flip = Quat { w: 0.0, xyz: Vec3([1.0, 0.0, 0.0]) }.matrix();
    let above = Pose { rot: flip, pos: Vec3([3.0, 1.0, 0.7]) };
    assert_eq!(ground.closest(&ground, &above, 10.0).unwrap().distance, 0.7);
    let tilted = Pose { rot: Quat { w: 0.01, xyz: Vec3([1.0, 0.0, 0.0]) }.normalized().matrix(), ..above };
    let meeting = ground.closest(&ground, &tilted, 10.0).unwrap();
    assert_eq!(meeting.distance, 0.0);
    assert_eq!(ground.closest_to(meeting.points[0]).unwrap().distance, 0.0);
    assert!(ground.closest_to(tilted.inverse().point(meeting.points[0])).unwrap().distance < 1e-12);
}
