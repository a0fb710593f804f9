//! Surfaces of colliders and of what sensors detect: solids, half spaces, hulls, meshes, height fields.

use super::Shape;
use crate::spatial::Vec3;

/// Surface of a collider, or of an object that sensors detect, in its own frame.
///
/// ```
/// use sincro_geometry::{Shape, Surface};
///
/// let brick = Surface::Solid(Shape::Cuboid { size: [0.3, 0.4, 1.2] });
/// assert!((brick.reach() - 0.65).abs() < 1e-15); // half of its diagonal [m]
/// assert_eq!(Surface::HalfSpace.reach(), f64::INFINITY); // a floor
/// let tetrahedron = vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
/// assert_eq!(Surface::Hull(tetrahedron).reach(), f64::sqrt(3.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// Boundary of a solid.
    Solid(Shape),
    /// Half space z ≤ 0 of its frame, such as a floor; only fixed in the world.
    HalfSpace,
    /// Convex hull of points `[m]`.
    Hull(Vec<[f64; 3]>),
    /// Closed triangle mesh: vertices `[m]`, and triangles of three vertex indices, counter-clockwise seen from
    /// outside; only fixed in the world.
    Mesh(Vec<[f64; 3]>, Vec<[u32; 3]>),
    /// Terrain over a regular rectangular grid centred on the frame's origin; only fixed in the world.
    HeightField {
        /// Number of grid points along x, at least 2.
        columns: usize,
        /// Heights z of the grid points `[m]`, row by row: point i along x and j along y is `heights[j * columns + i]`,
        /// from the smallest x and y on.
        heights: Vec<f64>,
        /// Extents of the grid along x and y `[m]`.
        size: [f64; 2],
    },
}

impl Surface {
    /// Radius of the bounding sphere about the origin of the frame `[m]`; infinite for a half space.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let length = |p: &[f64; 3]| Vec3(*p).norm();
        match self {
            Self::Solid(Shape::Sphere { radius }) => *radius,
            Self::Solid(Shape::Cuboid { size }) => 0.5 * length(size),
            Self::Solid(Shape::Capsule { radius, length }) => 0.5 * length + radius,
            Self::Solid(Shape::Torus { major_radius, tube_radius }) => major_radius + tube_radius,
            Self::Solid(Shape::Cylinder { radius, length }) => (0.25 * length * length + radius * radius).sqrt(),
            Self::Solid(Shape::Cone { radius, length }) => {
                (0.75 * length).max((length * length / 16.0 + radius * radius).sqrt())
            }
            Self::Hull(points) | Self::Mesh(points, _) => points.iter().map(length).fold(0.0, f64::max),
            Self::HalfSpace => f64::INFINITY,
            Self::HeightField { heights, size, .. } => {
                let top = heights.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
                length(&[0.5 * size[0], 0.5 * size[1], top])
            }
        }
    }
}
