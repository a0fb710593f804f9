//! Surfaces as shapes of the collision library parry. Its cylinders, cones and height fields have their axis along y:
//! axes are exchanged in cyclic order.

use parry3d_f64::math::{Pose as LibraryPose, Vector};
use parry3d_f64::shape::{SharedShape, TriMeshFlags};
use parry3d_f64::utils::Array2;

use super::{Shape, Surface};
use crate::spatial::{Mat3, Pose, Quat, Vec3};

/// Surface as a shape of the collision library parry, which the narrow phase and ray casts against meshes use.
#[derive(Clone)]
pub struct ParryShape {
    /// Shape in the library's own frame, lengths in `[m]`.
    pub shape: SharedShape,
    /// Pose of the library's frame in that of the surface `[m]`.
    pub pose: Pose<f64>,
}

/// Half the thickness of the disc in the core of a torus, relative to the radius of its tube.
const DISC: f64 = 1e-6;

/// Axes (x, y, z) of ours as (y, z, x) of the library's.
const CYCLIC: Mat3<f64> = Mat3([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);

impl ParryShape {
    /// Converts a surface. `None` if the library refuses it: a hull of points in one plane, a mesh without triangles or
    /// with inconsistent orientation.
    pub fn of(surface: &Surface) -> Option<Self> {
        let points = |list: &[[f64; 3]]| list.iter().map(|p| Vector::from_array(*p)).collect::<Vec<_>>();
        let plain = |shape: SharedShape| Some(Self { shape, pose: Pose::identity() });
        let turned =
            |shape: SharedShape, z: f64| Some(Self { shape, pose: Pose { rot: CYCLIC, pos: Vec3([0.0, 0.0, z]) } });
        match surface {
            Surface::Solid(Shape::Sphere { radius }) => plain(SharedShape::ball(*radius)),
            Surface::Solid(Shape::Cuboid { size: [x, y, z] }) => plain(SharedShape::cuboid(0.5 * x, 0.5 * y, 0.5 * z)),
            Surface::Solid(Shape::Capsule { radius, length }) => plain(SharedShape::capsule_z(0.5 * length, *radius)),
            Surface::Solid(Shape::Cylinder { radius, length }) => {
                turned(SharedShape::cylinder(0.5 * length, *radius), 0.0)
            }
            // its hull: a disc, which must have some thickness there, rounded
            Surface::Solid(Shape::Torus { major_radius, tube_radius }) => {
                let half = DISC * tube_radius;
                turned(SharedShape::round_cylinder(half, *major_radius, tube_radius - half), 0.0)
            }
            // ours has its centre of mass in the origin, the library's the middle of its height
            Surface::Solid(Shape::Cone { radius, length }) => {
                turned(SharedShape::cone(0.5 * length, *radius), 0.25 * length)
            }
            Surface::HalfSpace => plain(SharedShape::halfspace(Vector::Z)),
            Surface::Hull(list) => plain(SharedShape::convex_hull(&points(list))?),
            Surface::Mesh(vertices, triangles) => {
                let flags = TriMeshFlags::FIX_INTERNAL_EDGES | TriMeshFlags::ORIENTED;
                plain(SharedShape::trimesh_with_flags(points(vertices), triangles.clone(), flags).ok()?)
            }
            Surface::HeightField { columns, heights, size } => {
                let rows = heights.len() / columns;
                // the library's rows go along its z, our x; its columns along its x, our y; stored column by column
                let stored: Vec<f64> = (0..rows)
                    .flat_map(|j| (0..*columns).map(move |i| (i, j)))
                    .map(|(i, j)| heights[j * columns + i])
                    .collect();
                let grid = Array2::new(*columns, rows, stored);
                turned(SharedShape::heightfield(grid, Vector::new(size[1], 1.0, size[0])), 0.0)
            }
        }
    }
}

impl ParryShape {
    /// Triangles of a mesh or height field, three corners each `[m]`, in the frame of the surface; empty for other
    /// surfaces.
    pub fn triangles(&self) -> Vec<[Vec3<f64>; 3]> {
        let ours = |t: parry3d_f64::shape::Triangle| [t.a, t.b, t.c].map(|p| self.pose.point(vec3(p)));
        if let Some(mesh) = self.shape.as_trimesh() {
            return mesh.triangles().map(ours).collect();
        }
        self.shape.as_heightfield().map(|field| field.triangles().map(ours).collect()).unwrap_or_default()
    }
}

/// Converts a pose `[m]` to the type of the collision library.
pub fn parry_pose(x: &Pose<f64>) -> LibraryPose {
    let q = Quat::from_matrix(&x.rot);
    let mut pose = LibraryPose::IDENTITY;
    pose.translation = Vector::from_array(x.pos.0);
    (pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w) = (q.xyz[0], q.xyz[1], q.xyz[2], q.w);
    pose
}

/// Converts a vector of the collision library; components and unit stay.
pub fn vec3(v: Vector) -> Vec3<f64> {
    Vec3([v.x, v.y, v.z])
}
