//! Support mappings of the convex surfaces: each is a core with a rounding radius; half spaces and sets of triangles
//! are kept apart. Source: key `ericson2004`, section 9.5.

use super::Geometry;
use super::bvh::Bvh;
use super::gjk::Convex;
use super::{Shape, Surface};
use crate::spatial::{Pose, Vec3};

/// Tolerance in the distances of faces from a point that they share `[m]`.
pub(super) const ON: f64 = 1e-9;

/// Surface by kind of distance query, in the frame of the surface.
pub(super) enum Solid<'a> {
    Convex(Core<'a>, f64),
    /// Everything below z = 0.
    HalfSpace,
    Triangles(&'a Bvh),
}

/// Core of a rounded convex surface.
#[derive(Clone, Copy, Debug)]
pub(super) enum Core<'a> {
    Point,
    /// Along z, half its length.
    Segment(f64),
    /// Half its size.
    Cuboid([f64; 3]),
    /// Radius and half its length along z.
    Cylinder(f64, f64),
    /// Radius and length; its apex at 3/4 of it, its base at −1/4.
    Cone(f64, f64),
    Points(&'a [[f64; 3]]),
    Triangle([Vec3<f64>; 3]),
}

/// Core at a pose, with its rounding radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed<'a> {
    pub core: Core<'a>,
    pub radius: f64,
    pub pose: Pose<f64>,
}

/// A point.
pub(super) const POINT: Core<'_> = Core::Point;

impl Geometry {
    pub(super) fn solid(&self) -> Solid<'_> {
        let closest_points = Solid::Convex;
        match &self.surface {
            Surface::Solid(Shape::Sphere { radius }) => closest_points(Core::Point, *radius),
            Surface::Solid(Shape::Cuboid { size }) => closest_points(Core::Cuboid(size.map(|x| 0.5 * x)), 0.0),
            Surface::Solid(Shape::Cylinder { radius, length }) => {
                closest_points(Core::Cylinder(*radius, 0.5 * length), 0.0)
            }
            Surface::Solid(Shape::Capsule { radius, length }) => closest_points(Core::Segment(0.5 * length), *radius),
            // its hull: a disc, rounded
            Surface::Solid(Shape::Torus { major_radius, tube_radius }) => {
                closest_points(Core::Cylinder(*major_radius, 0.0), *tube_radius)
            }
            Surface::Solid(Shape::Cone { radius, length }) => closest_points(Core::Cone(*radius, *length), 0.0),
            Surface::Hull(points) => closest_points(Core::Points(points), 0.0),
            Surface::HalfSpace => Solid::HalfSpace,
            Surface::Mesh(..) | Surface::HeightField { .. } => Solid::Triangles(&self.bvh),
        }
    }
}

impl Core<'_> {
    /// Support mapping in its own frame.
    pub(super) fn support(&self, d: Vec3<f64>) -> Vec3<f64> {
        let end = |half: f64, x: f64| if x >= 0.0 { half } else { -half };
        let rim = |radius: f64, z: f64| {
            let across = (d[0] * d[0] + d[1] * d[1]).sqrt();
            let k = if across > 0.0 { radius / across } else { 0.0 };
            Vec3([k * d[0], k * d[1], z])
        };
        match *self {
            Self::Point => Vec3::zero(),
            Self::Segment(half) => Vec3([0.0, 0.0, end(half, d[2])]),
            Self::Cuboid(half) => Vec3(std::array::from_fn(|k| end(half[k], d[k]))),
            Self::Cylinder(radius, half) => rim(radius, end(half, d[2])),
            Self::Cone(radius, length) => {
                let (apex, base) = (Vec3([0.0, 0.0, 0.75 * length]), rim(radius, -0.25 * length));
                if d.dot(apex) >= d.dot(base) { apex } else { base }
            }
            Self::Points(points) => Vec3(support_of_points(points.iter().copied(), d)),
            Self::Triangle(corners) => Vec3(support_of_points(corners.into_iter().map(|c| c.0), d)),
        }
    }

    fn interior_point(&self) -> Vec3<f64> {
        match *self {
            Self::Points(points) => Vec3(points[0]),
            Self::Triangle([a, ..]) => a,
            _ => Vec3::zero(),
        }
    }
}

fn support_of_points(points: impl Iterator<Item = [f64; 3]>, d: Vec3<f64>) -> [f64; 3] {
    let mut best = ([0.0; 3], f64::NEG_INFINITY);
    for p in points {
        let along = d.dot(Vec3(p));
        if along > best.1 {
            best = (p, along);
        }
    }
    best.0
}

impl Convex for Placed<'_> {
    fn support(&self, d: Vec3<f64>) -> Vec3<f64> {
        self.pose.point(self.core.support(self.pose.rot.tr_mul_vec(d)))
    }

    fn interior_point(&self) -> Vec3<f64> {
        self.pose.point(self.core.interior_point())
    }
}

/// Outward normal of a surface at a point of it, in the surface's frame: of several, at edges and vertices, the one
/// that faces `towards` most.
pub(super) fn normal_at(geometry: &Geometry, p: Vec3<f64>, towards: Vec3<f64>) -> Vec3<f64> {
    let across = (p[0] * p[0] + p[1] * p[1]).sqrt();
    let outwards = if across > 0.0 { Vec3([p[0] / across, p[1] / across, 0.0]) } else { Vec3([1.0, 0.0, 0.0]) };
    let up = |z: f64| Vec3([0.0, 0.0, if z >= 0.0 { 1.0 } else { -1.0 }]);
    match &geometry.surface {
        Surface::Solid(Shape::Sphere { .. }) => unit(p),
        Surface::Solid(Shape::Capsule { length, .. }) => {
            unit(p - Vec3([0.0, 0.0, p[2].clamp(-0.5 * length, 0.5 * length)]))
        }
        Surface::Solid(Shape::Torus { major_radius, .. }) if across <= *major_radius => up(p[2]),
        Surface::Solid(Shape::Torus { major_radius, .. }) => unit(p - outwards.scale(*major_radius)),
        Surface::HalfSpace => up(1.0),
        Surface::Solid(Shape::Cuboid { size }) => {
            let face = |k: usize| {
                let sign = if p[k] >= 0.0 { 1.0 } else { -1.0 };
                ((p[k].abs() - 0.5 * size[k]).abs(), Vec3::along(k, sign))
            };
            facing((0..3).map(face), towards)
        }
        Surface::Solid(Shape::Cylinder { radius, length }) => {
            let faces = [((across - radius).abs(), outwards), ((p[2].abs() - 0.5 * length).abs(), up(p[2]))];
            facing(faces.into_iter(), towards)
        }
        Surface::Solid(Shape::Cone { radius, length }) => {
            let lean = unit(Vec3([outwards[0] * length, outwards[1] * length, *radius]));
            let flank = lean.dot(p - Vec3([0.0, 0.0, 0.75 * length])).abs();
            facing([(flank, lean), ((p[2] + 0.25 * length).abs(), up(-1.0))].into_iter(), towards)
        }
        Surface::Hull(_) => facing(geometry.faces.iter().map(|(n, offset)| ((n.dot(p) - offset).abs(), *n)), towards),
        Surface::Mesh(..) | Surface::HeightField { .. } => geometry.bvh.normal_near(p, towards),
    }
}

fn unit(v: Vec3<f64>) -> Vec3<f64> {
    v.scale(1.0 / v.norm().max(f64::MIN_POSITIVE))
}

/// Normal of a face that a point lies on, from pairs of distance and normal: of several, the one that faces `towards`
/// most.
fn facing(faces: impl Iterator<Item = (f64, Vec3<f64>)> + Clone, towards: Vec3<f64>) -> Vec3<f64> {
    let least = faces.clone().fold(f64::INFINITY, |least, (off, _)| least.min(off));
    let mut best = (f64::NEG_INFINITY, Vec3([0.0, 0.0, 1.0]));
    for (_, normal) in faces.filter(|(off, _)| *off <= least + ON) {
        let facing = normal.dot(towards);
        if facing > best.0 {
            best = (facing, normal);
        }
    }
    best.1
}
