//! Detections of proximity sensors against closed forms, and no point of the surface in the field of view nearer than
//! the detection.

use std::f64::consts::PI;

use super::Shape;
use super::distance_tests::{along, parts, with_triangles};
use super::field_of_view::Within;
use super::gjk::gjk;
use super::support::{POINT, Placed};
use super::tests::{Numbers, surfaces};
use super::*;
use crate::spatial::{Mat3, Pose};

fn fields() -> Vec<FieldOfView> {
    let volumes = [
        (Volume::Ray, 0.1),
        (Volume::Cylinder { radius: 0.2, far_radius: 0.5 }, 0.0),
        (Volume::Cylinder { radius: 0.3, far_radius: 0.1 }, 0.15),
        (Volume::Disc { angle: 1.2 }, 0.0),
        (Volume::Disc { angle: 2.0 }, 0.1),
        (Volume::Cone { angle: 0.6 }, 0.0),
        (Volume::Cone { angle: 1.4 }, 0.2),
        (Volume::Cone { angle: PI }, 0.0),
        (Volume::Pyramid { size: [0.1, 0.2], far_size: [0.8, 0.5] }, 0.05),
        (Volume::Pyramid { size: [0.0, 0.0], far_size: [0.6, 0.6] }, 0.0),
    ];
    volumes.into_iter().map(|(volume, offset)| FieldOfView::new(volume, offset, 1.3).unwrap()).collect()
}

/// Distance of a point from the field of view.
fn off(field: &FieldOfView, p: Vec3<f64>) -> f64 {
    let point = Placed { core: POINT, radius: 0.0, pose: Pose::translation(p) };
    gjk(&Within { field, radius: field.reach() }, &point).distance
}

#[test]
fn a_wall_is_seen_where_it_is_closest_or_at_the_rim() {
    let wall = Geometry::new(Surface::HalfSpace).unwrap();
    // a wall at z = 0.5 whose normal leans by some angle from the sensor's −z
    for k in 0..40 {
        let lean = 0.03 * f64::from(k);
        let (sin, cos) = sincro_math::elementary::sin_cos(PI - lean);
        let pose = Pose { rot: Mat3::rotation::<1>(sin, cos), pos: Vec3([0.0, 0.0, 0.5]) };
        let half: f64 = 0.35;
        let cone = FieldOfView::new(Volume::Cone { angle: 2.0 * half }, 0.0, 3.0).unwrap();
        let seen = cone.detect(&wall, &pose, f64::INFINITY).unwrap();
        let c = |x: f64| sincro_math::elementary::sin_cos(x).1;
        // the foot of the perpendicular, or the outermost ray towards it
        let expected = if lean <= half { 0.5 * c(lean) } else { 0.5 * c(lean) / c(lean - half) };
        assert!((seen.distance - expected).abs() < 1e-12, "{lean}: {} {expected}", seen.distance);
        assert!((seen.normal - pose.rot.col(2)).norm() < 1e-12);
        // a ray meets it on the axis
        let ray = FieldOfView::new(Volume::Ray, 0.0, 3.0).unwrap().detect(&wall, &pose, f64::INFINITY).unwrap();
        assert!((ray.distance - 0.5).abs() < 1e-15);
    }
}

#[test]
fn a_ball_beside_a_cone_is_seen_on_its_outermost_ray() {
    let ball = Geometry::new(Surface::Solid(Shape::Sphere { radius: 0.2 })).unwrap();
    let cone = FieldOfView::new(Volume::Cone { angle: 0.5 }, 0.0, 2.0).unwrap();
    let (sin, cos) = sincro_math::elementary::sin_cos(0.25);
    for k in 0..100 {
        let x = 0.01 * f64::from(k);
        let pose = Pose::translation(Vec3([0.0, x, 1.0]));
        let seen = cone.detect(&ball, &pose, f64::INFINITY);
        // along the outermost ray: t² − 2 t (x sin + cos) + x² + 1 − r² = 0
        let (b, c) = (x * sin + cos, x * x + 1.0 - 0.04);
        let expected = if x <= sin / cos {
            Some((x * x + 1.0).sqrt() - 0.2)
        } else {
            (b * b >= c).then(|| b - (b * b - c).sqrt())
        };
        match (seen, expected) {
            (Some(seen), Some(expected)) => {
                assert!((seen.distance - expected).abs() < 1e-9, "{x}: {} {expected}", seen.distance);
                assert!((seen.normal - (seen.point - pose.pos).scale(5.0)).norm() < 1e-7);
            }
            (seen, expected) => assert_eq!(seen.is_some(), expected.is_some(), "{x}"),
        }
    }
}

#[test]
fn nothing_in_the_volume_is_nearer_than_what_is_seen() {
    let mut numbers = Numbers(21);
    let all: Vec<Geometry> = surfaces().into_iter().map(|s| Geometry::new(s).unwrap()).collect();
    for (i, field) in fields().iter().enumerate() {
        let (mut seen_n, mut on_rim) = (0, 0);
        for (j, geometry) in all.iter().enumerate() {
            for _ in 0..150 {
                let mut pose = numbers.pose(0.9);
                pose.pos += Vec3([0.0, 0.0, 0.7]);
                let inside = |p: Vec3<f64>| geometry.closest_to(pose.inverse().point(p)).unwrap().distance;
                if inside(Vec3([0.0, 0.0, field.offset()])) == 0.0 {
                    assert!(field.detect(geometry, &pose, f64::INFINITY).is_none());
                    continue;
                }
                let seen = field.detect(geometry, &pose, f64::INFINITY);
                let least = seen.map_or(f64::INFINITY, |s| s.distance);
                if let Some(seen) = seen {
                    seen_n += 1;
                    assert!(off(field, seen.point) < 1e-9 && inside(seen.point) < 1e-9, "{i} {j} {pose:?} {seen:?}");
                    if let [part] = parts(geometry)[..] {
                        let n = pose.rot.tr_mul_vec(seen.normal);
                        let beyond = along(&part, n) - n.dot(pose.inverse().point(seen.point));
                        assert!(beyond < 1e-8, "{i} {j}: the surface goes {beyond} beyond {:?}", seen.normal);
                    }
                    on_rim += usize::from(
                        off(field, seen.point.scale(1.0 - 1e-6)) > 0.0
                            || !field.contains(seen.point + numbers.vector().scale(1e-6)),
                    );
                    // nothing around it is nearer
                    for k in 0..60 {
                        let scale = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6][k % 6];
                        let p = seen.point + numbers.vector().scale(scale);
                        let is_nearer = p.norm() < least - 1e-9;
                        assert!(
                            !(is_nearer && field.contains(p) && inside(p) == 0.0),
                            "{i} {j} {pose:?} {seen:?} {p:?}"
                        );
                    }
                }
                for _ in 0..60 {
                    let p = numbers.vector().scale(1.2) + Vec3([0.0, 0.0, 0.7]);
                    let p = if matches!(field.volume(), Volume::Disc { .. }) { Vec3([p[0], 0.0, p[2]]) } else { p };
                    let p = if field.volume() == Volume::Ray { Vec3([0.0, 0.0, p[2]]) } else { p };
                    let is_nearer = p.norm() < least - 1e-9;
                    assert!(!(is_nearer && field.contains(p) && inside(p) == 0.0), "{i} {j} {pose:?} {seen:?} {p:?}");
                }
            }
        }
        assert!(seen_n > 80 && on_rim > 0, "{i}: {seen_n} {on_rim}");
    }
}

#[test]
fn of_meshes_the_nearest_triangle_is_seen() {
    let mut numbers = Numbers(22);
    for geometry in with_triangles().into_iter().map(|s| Geometry::new(s).unwrap()) {
        for field in &fields() {
            let mut n = 0;
            for _ in 0..100 {
                let mut pose = numbers.pose(0.6);
                pose.pos += Vec3([0.0, 0.0, 0.8]);
                let seen = field.detect(&geometry, &pose, f64::INFINITY);
                let least = seen.map_or(f64::INFINITY, |s| s.distance);
                n += usize::from(seen.is_some());
                if let Some(seen) = seen {
                    let on = geometry.closest_to(pose.inverse().point(seen.point)).unwrap().distance;
                    assert!(on < 1e-9 && off(field, seen.point) < 1e-9, "{field:?} {seen:?} {on}");
                }
                if field.volume() == Volume::Ray {
                    continue;
                }
                // random points of random triangles
                let triangles = geometry.library.triangles();
                for k in 0..200 {
                    let [a, b, c] = triangles[k % triangles.len()];
                    let (u, v) = (0.5 + 0.5 * numbers.next(), 0.5 + 0.5 * numbers.next());
                    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                    let p = pose.point(a + (b - a).scale(u) + (c - a).scale(v));
                    assert!(p.norm() >= least - 1e-9 || !field.contains(p), "{field:?} {pose:?} {seen:?} {p:?}");
                }
            }
            assert!(n > 5, "{field:?}: {n}");
        }
    }
}

#[test]
fn fields_that_are_none_are_refused() {
    let bad = [
        (Volume::Ray, 0.0, 0.0),
        (Volume::Ray, -0.1, 1.0),
        (Volume::Ray, 0.0, f64::NAN),
        (Volume::Ray, 0.0, f64::INFINITY),
        (Volume::Cone { angle: 3.2 }, 0.0, 1.0),
        (Volume::Cone { angle: 0.0 }, 0.0, 1.0),
        (Volume::Disc { angle: f64::NAN }, 0.0, 1.0),
        (Volume::Cylinder { radius: 0.0, far_radius: 0.0 }, 0.0, 1.0),
        (Volume::Pyramid { size: [0.1, 0.0], far_size: [0.1, 0.0] }, 0.0, 1.0),
    ];
    for (volume, offset, range) in bad {
        assert!(FieldOfView::new(volume, offset, range).is_none(), "{volume:?} {offset} {range}");
    }
}

#[test]
fn volumes_know_their_farthest_points() {
    let mut numbers = Numbers(5);
    for field in fields() {
        let mut worst = 0.0_f64;
        for _ in 0..2000 {
            let r = field.offset() + 1e-3 + (field.reach() - field.offset() - 1e-3) * (0.5 + 0.5 * numbers.next());
            let d = numbers.vector();
            // straight at a side of a pyramid, too
            let d = if numbers.next() > 0.5 {
                Vec3([0.965_615_758_520_669_6 * d[0].signum(), 0.0, -0.259_973_473_447_872_6])
            } else {
                d
            };
            let w = Within { field: &field, radius: r };
            let p = super::gjk::Convex::support(&w, d);
            assert!(field.contains(p) && p.norm() <= r + 1e-9, "{field:?} {r} {d:?} {p:?}");
            for _ in 0..50 {
                let q = numbers.vector().scale(1.3);
                let q = if matches!(field.volume(), Volume::Disc { .. }) { Vec3([q[0], 0.0, q[2]]) } else { q };
                if field.contains(q) && q.norm() <= r {
                    worst = worst.max(d.dot(q) - d.dot(p));
                }
            }
        }
        assert!(worst < 1e-9, "{field:?} {worst}");
    }
}
