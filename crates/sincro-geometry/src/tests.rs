//! Rays against the collision library's, which finds them by other ways.

use super::Shape;
use super::*;

/// Numbers from −1 to 1, always the same.
pub(super) struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> Vec3<f64> {
        Vec3(std::array::from_fn(|_| self.next()))
    }
}

pub(super) fn surfaces() -> Vec<Surface> {
    let tetrahedron = [[0.6, 0.0, 0.0], [-0.4, 0.5, 0.0], [-0.4, -0.5, 0.1], [0.0, 0.0, 0.7]];
    vec![
        Surface::Solid(Shape::Sphere { radius: 0.5 }),
        Surface::Solid(Shape::Cuboid { size: [0.6, 0.8, 1.0] }),
        Surface::Solid(Shape::Cylinder { radius: 0.4, length: 0.9 }),
        Surface::Solid(Shape::Capsule { radius: 0.3, length: 0.5 }),
        Surface::Solid(Shape::Cone { radius: 0.5, length: 1.0 }),
        Surface::Solid(Shape::Torus { major_radius: 0.5, tube_radius: 0.2 }),
        Surface::Hull(tetrahedron.to_vec()),
        Surface::HalfSpace,
    ]
}

#[test]
fn rays_enter_where_the_library_says() {
    let mut numbers = Numbers(1);
    for surface in surfaces() {
        let geometry = Geometry::new(surface).unwrap();
        let mut hits = 0;
        for _ in 0..20_000 {
            let origin = numbers.vector().scale(2.0);
            let aim = numbers.vector().scale(0.6) - origin;
            let ray = Ray { origin, direction: aim.scale(1.0 / aim.norm()) };
            let ParryShape { shape, pose } = &geometry.library;
            let inside = shape.contains_local_point(pose.rot.tr_mul_vec(ray.origin - pose.pos).0.into());
            let theirs = if inside { None } else { geometry.cast_ray_parry(&ray, 10.0) };
            match (geometry.cast_ray(&ray, 10.0), theirs) {
                (Some(ours), Some(theirs)) => {
                    hits += 1;
                    let apart = (ours.distance - theirs.distance).abs();
                    // the library stops its search for curved solids at about this
                    assert!(apart < 1e-5, "{:?}: {ours:?} {theirs:?}", geometry.surface());
                    assert!(ours.normal.dot(ray.direction) < 0.0);
                    assert!((ours.normal.norm() - 1.0).abs() < 1e-12);
                }
                (None, None) => {}
                // one of them may see what only grazes
                (one, two) => {
                    let at = one.or(two).unwrap().distance;
                    let normal = one.or(two).unwrap().normal;
                    assert!(normal.dot(ray.direction).abs() < 1e-3, "{:?}: {one:?} {two:?} {at}", geometry.surface());
                }
            }
        }
        assert!(hits > 2_000, "{:?}: {hits}", geometry.surface());
    }
}

#[test]
fn the_point_of_entry_lies_on_the_surface() {
    let mut numbers = Numbers(2);
    let on = |surface: &Surface, p: Vec3<f64>| match *surface {
        Surface::Solid(Shape::Sphere { radius }) => (p.norm() - radius).abs(),
        Surface::Solid(Shape::Cone { radius, length }) => {
            let across = (p[0] * p[0] + p[1] * p[1]).sqrt();
            let flank = (across - radius * (0.75 * length - p[2]) / length).abs();
            flank.min((p[2] + 0.25 * length).abs())
        }
        Surface::Solid(Shape::Cylinder { radius, length }) => {
            let across = (p[0] * p[0] + p[1] * p[1]).sqrt();
            (across - radius).abs().min((p[2].abs() - 0.5 * length).abs())
        }
        _ => 0.0,
    };
    for surface in surfaces() {
        let geometry = Geometry::new(surface.clone()).unwrap();
        for _ in 0..5_000 {
            let direction = numbers.vector();
            let ray = Ray { origin: numbers.vector().scale(3.0), direction: direction.scale(1.0 / direction.norm()) };
            if let Some(hit) = geometry.cast_ray(&ray, 20.0) {
                assert!(on(&surface, ray.at(hit.distance)) < 1e-12, "{surface:?} {ray:?}");
            }
        }
    }
}

#[test]
fn nothing_is_seen_beyond_the_range_or_from_inside() {
    for surface in surfaces() {
        let geometry = Geometry::new(surface).unwrap();
        let down = Ray { origin: Vec3([0.05, 0.02, 5.0]), direction: Vec3([0.0, 0.0, -1.0]) };
        let hit = geometry.cast_ray(&down, 10.0).unwrap();
        assert!(geometry.cast_ray(&down, hit.distance - 1e-9).is_none());
        assert!(geometry.cast_ray(&Ray { origin: down.at(hit.distance + 1e-6), ..down }, 10.0).is_none());
        assert!(geometry.cast_ray(&Ray { direction: -down.direction, ..down }, 10.0).is_none());
    }
}
