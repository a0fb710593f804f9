//! Surfaces to look at: what a ray hits first, what is closest, what a proximity sensor sees. No part of a step; sensors and clients ask.
//!
//! Rays have closed forms on solids, hulls are cut by the planes of their faces, meshes and height fields are the collision library's. Distances are
//! those of convex sets (`gjk`), triangle by triangle for meshes and height fields (`bvh`).

mod bvh;
mod distance;
#[cfg(test)]
mod distance_tests;
mod field_of_view;
mod gjk;
mod mass;
pub(crate) mod parry;
pub mod polyhedron;
mod proximity;
#[cfg(test)]
mod proximity_tests;
mod ray_cast;
pub(crate) mod sat;
mod shape;
mod support;
mod surface;
#[cfg(test)]
mod tests;

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

/// A ray: a point and a direction of length one, in whatever frame is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts `[m]`.
    pub origin: Vec3<f64>,
    /// Where it goes, length one.
    pub direction: Vec3<f64>,
}

impl Ray {
    /// The point at a distance `[m]` from its start.
    #[must_use]
    pub fn at(&self, distance: f64) -> Vec3<f64> {
        self.origin + self.direction.scale(distance)
    }
}

/// Where a ray enters a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// From the ray's start `[m]`.
    pub distance: f64,
    /// Out of the surface, length one, in the frame of the ray.
    pub normal: Vec3<f64>,
}

/// A surface, ready to be looked at.
#[derive(Clone)]
pub struct Geometry {
    surface: Surface,
    library: ParryShape,
    /// Of a hull: outward normals and distances from the origin.
    faces: Vec<(Vec3<f64>, f64)>,
    /// Of a mesh or height field: its triangles.
    bvh: Bvh,
    reach: f64,
}

impl std::fmt::Debug for Geometry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Geometry").field("surface", &self.surface).finish_non_exhaustive()
    }
}

impl Geometry {
    /// A surface; none if it has no extent that can be computed with, such as a flat hull.
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

    /// The surface.
    #[must_use]
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Radius of a ball about the frame's origin that holds it `[m]`; infinite for a half space.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Where a ray, given in the surface's frame, enters it from outside within `max_distance` `[m]`; what starts inside a solid does not see it.
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
