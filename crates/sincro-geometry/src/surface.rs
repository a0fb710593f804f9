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

    /// Largest coordinate of the surface along a direction of length 1 in its own axes `[m]`; none if it has no end.
    #[must_use]
    pub fn reach_along(&self, d: [f64; 3]) -> Option<f64> {
        let [x, y, z] = d;
        let across = (x * x + y * y).sqrt();
        let of_points = |points: &[[f64; 3]]| {
            points.iter().map(|p| p[0] * x + p[1] * y + p[2] * z).fold(f64::NEG_INFINITY, f64::max)
        };
        Some(match self {
            Self::Solid(Shape::Cuboid { size }) => 0.5 * (size[0] * x.abs() + size[1] * y.abs() + size[2] * z.abs()),
            Self::Solid(Shape::Sphere { radius }) => *radius,
            Self::Solid(Shape::Cylinder { radius, length }) => radius * across + 0.5 * length * z.abs(),
            // its origin is its centre of mass, a quarter of its height above the base
            Self::Solid(Shape::Cone { radius, length }) => (0.75 * length * z).max(radius * across - 0.25 * length * z),
            Self::Solid(Shape::Capsule { radius, length }) => radius + 0.5 * length * z.abs(),
            Self::Solid(Shape::Torus { major_radius, tube_radius }) => major_radius * across + tube_radius,
            Self::HalfSpace => return None,
            Self::Hull(points) | Self::Mesh(points, _) => of_points(points),
            Self::HeightField { columns, heights, size } => {
                let rows = heights.len() / columns;
                let place = |k: usize, n: usize| k as f64 / (n - 1) as f64 - 0.5;
                let point = |(k, h): (usize, &f64)| {
                    [size[0] * place(k % columns, *columns), size[1] * place(k / columns, rows), *h]
                };
                of_points(&heights.iter().enumerate().map(point).collect::<Vec<_>>())
            }
        })
    }

    /// The surface with all lengths times `k` (dimensionless), about the origin of its frame.
    #[must_use]
    pub fn scaled(&self, k: f64) -> Self {
        let points = |list: &[[f64; 3]]| list.iter().map(|p| p.map(|x| k * x)).collect();
        match self {
            Self::Solid(Shape::Cuboid { size }) => Self::Solid(Shape::Cuboid { size: size.map(|x| k * x) }),
            Self::Solid(Shape::Sphere { radius }) => Self::Solid(Shape::Sphere { radius: k * radius }),
            Self::Solid(Shape::Cylinder { radius, length }) => {
                Self::Solid(Shape::Cylinder { radius: k * radius, length: k * length })
            }
            Self::Solid(Shape::Cone { radius, length }) => {
                Self::Solid(Shape::Cone { radius: k * radius, length: k * length })
            }
            Self::Solid(Shape::Capsule { radius, length }) => {
                Self::Solid(Shape::Capsule { radius: k * radius, length: k * length })
            }
            Self::Solid(Shape::Torus { major_radius, tube_radius }) => {
                Self::Solid(Shape::Torus { major_radius: k * major_radius, tube_radius: k * tube_radius })
            }
            Self::HalfSpace => Self::HalfSpace,
            Self::Hull(list) => Self::Hull(points(list)),
            Self::Mesh(list, triangles) => Self::Mesh(points(list), triangles.clone()),
            Self::HeightField { columns, heights, size } => Self::HeightField {
                columns: *columns,
                heights: heights.iter().map(|h| k * h).collect(),
                size: size.map(|x| k * x),
            },
        }
    }
}
