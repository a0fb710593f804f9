#![doc = include_str!("../README.md")]
//! # Geometry of surfaces
//!
//! A [`Geometry`] is a surface prepared for queries. Ray casts have closed forms on solids, hulls are cut by the planes
//! of their faces, meshes and height fields use the collision library. Distances are those of convex sets by GJK on
//! support mappings, and triangle by triangle for meshes and height fields in a bounding volume hierarchy. No query is
//! part of a step; contact detection uses the surfaces and the separating axes only.
//!
//! | file | content |
//! |---|---|
//! | [`spatial`] | spatial algebra: vectors, rotations, poses, six-vectors, inertias |
//! | `shape`, `mass`, `polyhedron`, `surface` | solids, mass properties, triangle meshes, surfaces of colliders |
//! | `elliptic`, [`triangulation`] | hulls of solids with elliptic sections, triangle meshes of surfaces |
//! | `support` | support mappings of the convex surfaces |
//! | `gjk` | distance of two convex sets |
//! | [`weld`] | triangle meshes from lists of triangles |
//! | `bvh` | bounding volume hierarchy of triangles |
//! | `sat` | separating axes and face clipping of convex polytopes |
//! | `distance` | closest points of two surfaces, or of a surface and a point |
//! | `ray_cast` | ray casts against solids |
//! | `field_of_view`, `proximity` | volumes of proximity sensors, and the detection in them |
//! | `parry` | conversion to the collision library |
//!
//! Source: C. Ericson, key `ericson2004`, chapters 4 to 6 and 9.

mod bvh;
mod distance;
#[cfg(test)]
mod distance_tests;
mod elliptic;
mod field_of_view;
mod gjk;
mod mass;
pub mod parry;
pub mod polyhedron;
mod proximity;
#[cfg(test)]
mod proximity_tests;
mod ray_cast;
pub mod sat;
mod shape;
pub mod spatial;
mod support;
mod surface;
#[cfg(test)]
mod tests;
pub mod triangulation;
pub mod weld;

use parry3d_f64::query::Ray as LibraryRay;

use crate::spatial::Vec3;
use bvh::Bvh;
use parry::{ParryShape, vec3};

pub use distance::Closest;
pub use field_of_view::{FieldOfView, Volume};
pub use mass::MassProperties;
pub use proximity::Detection;
pub use shape::Shape;
pub use surface::Surface;

/// Ray for [`Geometry::cast_ray`]: an origin and a unit direction, in the frame of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin `[m]`.
    pub origin: Vec3<f64>,
    /// Direction of unit length (dimensionless); distances along the ray are in metres only then.
    pub direction: Vec3<f64>,
}

impl Ray {
    /// Returns the point of the ray at `distance` from its origin `[m]`, in the frame of the ray `[m]`.
    #[must_use]
    pub fn at(&self, distance: f64) -> Vec3<f64> {
        self.origin + self.direction.scale(distance)
    }
}

/// Hit of a ray cast, from [`Geometry::cast_ray`]: the point where a ray enters a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance of the point from the ray's origin `[m]`; the point itself is [`Ray::at`] of it.
    pub distance: f64,
    /// Outward unit normal of the surface at the point, in the frame of the ray (dimensionless).
    pub normal: Vec3<f64>,
}

/// Surface prepared for ray casts, distances and detection by proximity sensors; made once by [`Geometry::new`].
///
/// ```
/// use sincro_geometry::spatial::Vec3;
/// use sincro_geometry::{Geometry, Ray, Shape, Surface};
///
/// let brick = Geometry::new(Surface::Solid(Shape::Cuboid { size: [2.0, 1.0, 1.0] })).unwrap();
/// let ray = Ray { origin: Vec3([-5.0, 0.0, 0.0]), direction: Vec3([1.0, 0.0, 0.0]) };
/// let hit = brick.cast_ray(&ray, 10.0).unwrap();
/// assert_eq!((hit.distance, hit.normal), (4.0, Vec3([-1.0, 0.0, 0.0]))); // [m]
/// ```
#[derive(Clone)]
pub struct Geometry {
    surface: Surface,
    library: ParryShape,
    /// Outward normals of a hull's faces and their distances from the origin.
    faces: Vec<(Vec3<f64>, f64)>,
    /// Triangles of a mesh or height field.
    bvh: Bvh,
    reach: f64,
}

impl std::fmt::Debug for Geometry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Geometry").field("surface", &self.surface).finish_non_exhaustive()
    }
}

impl Geometry {
    /// Prepares a surface. `None` if it is degenerate: a hull of points in one plane, a mesh without triangles or with
    /// inconsistent orientation.
    #[must_use]
    pub fn new(surface: Surface) -> Option<Self> {
        let library = ParryShape::of(&surface)?;
        let faces = match library.shape.as_convex_polyhedron() {
            Some(convex_hull) => {
                let of = |k: usize| {
                    let normal = vec3(convex_hull.faces()[k].normal);
                    let first = convex_hull.faces()[k].first_vertex_or_edge as usize;
                    let corner = convex_hull.points()[convex_hull.vertices_adj_to_face()[first] as usize];
                    (normal, normal.dot(vec3(corner)))
                };
                (0..convex_hull.faces().len()).map(of).collect()
            }
            None => Vec::new(),
        };
        let (bvh, reach) = (Bvh::new(library.triangles()), surface.reach());
        Some(Self { surface, library, faces, bvh, reach })
    }

    /// Surface from which it was made, in its own frame.
    #[must_use]
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Radius of the bounding sphere about the origin of the surface's frame `[m]`; infinite for a half space.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Returns the first point within `max_distance` `[m]` where `ray`, given in the surface's frame, enters the
    /// surface from outside; `None` if there is none. A ray that starts inside a solid does not hit it.
    #[must_use]
    pub fn cast_ray(&self, ray: &Ray, max_distance: f64) -> Option<Hit> {
        let hit = match &self.surface {
            Surface::Solid(shape) => ray_cast::solid(shape, ray),
            Surface::HalfSpace => ray_cast::half_space(ray),
            Surface::Hull(_) => ray_cast::planes(self.faces.iter().copied(), ray),
            Surface::Mesh(..) | Surface::HeightField { .. } => return self.cast_ray_parry(ray, max_distance),
        };
        hit.filter(|hit| hit.distance <= max_distance)
    }

    fn cast_ray_parry(&self, ray: &Ray, max_distance: f64) -> Option<Hit> {
        let ParryShape { shape, pose } = &self.library;
        let local = |v: Vec3<f64>| pose.rot.tr_mul_vec(v).0;
        let theirs = LibraryRay::new(local(ray.origin - pose.pos).into(), local(ray.direction).into());
        let hit = shape.cast_local_ray_and_get_normal(&theirs, max_distance, false)?;
        let normal = pose.rot.mul_vec(vec3(hit.normal));
        Some(Hit { distance: hit.time_of_impact, normal })
    }
}
