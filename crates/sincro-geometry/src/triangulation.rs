//! Triangle meshes of surfaces.
//!
//! Meshes, hulls and height fields are given as they are; solids of closed form are approximated: their surfaces of
//! revolution by `SEGMENTS` meridians, arcs by `ARC` parts a quarter.

use std::f64::consts::{FRAC_PI_2, TAU};

use sincro_math::elementary::sin_cos;

use super::{Shape, Surface};
use crate::polyhedron::{Triangles, convex_hull};
use crate::spatial::Vec3;

/// Meridians of a surface of revolution.
const SEGMENTS: usize = 32;
/// Parts of a quarter of a circle.
const ARC: usize = 8;

impl Surface {
    /// Triangle mesh of the surface in its own frame, corners `[m]` and triangles; `None` if it has no end (a half
    /// space), or is a hull of points in one plane. Round solids are approximated from inside.
    ///
    /// ```
    /// use sincro_geometry::{Shape, Surface};
    ///
    /// let (corners, triangles) = Surface::Solid(Shape::Cuboid { size: [1.0, 2.0, 3.0] }).triangles().unwrap();
    /// assert_eq!((corners.len(), triangles.len()), (8, 12));
    /// assert_eq!(Surface::HalfSpace.triangles(), None);
    /// ```
    #[must_use]
    pub fn triangles(&self) -> Option<Triangles> {
        Some(match self {
            Self::Solid(Shape::Cuboid { size }) => cuboid(size.map(|x| 0.5 * x)),
            Self::Solid(Shape::Sphere { radius }) => revolved(&arc(*radius, 0.0, -1, 1)),
            Self::Solid(Shape::Cylinder { radius, length }) => {
                let h = 0.5 * length;
                revolved(&[[0.0, -h], [*radius, -h], [*radius, h], [0.0, h]])
            }
            // its origin is its centre of mass, a quarter of its height above the base
            Self::Solid(Shape::Cone { radius, length }) => {
                revolved(&[[0.0, -0.25 * length], [*radius, -0.25 * length], [0.0, 0.75 * length]])
            }
            Self::Solid(Shape::Capsule { radius, length }) => {
                let h = 0.5 * length;
                revolved(&[arc(*radius, -h, -1, 0), arc(*radius, h, 0, 1)].concat())
            }
            Self::Solid(Shape::Torus { major_radius, tube_radius }) => torus(*major_radius, *tube_radius),
            Self::HalfSpace => return None,
            Self::Hull(points) => convex_hull(points)?,
            Self::Mesh(corners, triangles) => (corners.clone(), triangles.clone()),
            Self::HeightField { columns, heights, size } => ground(*columns, heights, *size),
        })
    }
}

/// Parts of a mesh as one.
#[must_use]
pub fn merged(parts: impl IntoIterator<Item = Triangles>) -> Triangles {
    let (mut corners, mut triangles) = Triangles::default();
    for (more, indices) in parts {
        let first = corners.len() as u32;
        corners.extend(more);
        triangles.extend(indices.iter().map(|t| t.map(|k| first + k)));
    }
    (corners, triangles)
}

/// Unit normal of each triangle, zero where it has no area.
#[must_use]
pub fn normals((corners, triangles): &Triangles) -> Vec<[f64; 3]> {
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|k| Vec3(corners[k as usize]));
        let n = (b - a).cross(c - a);
        let length = n.norm();
        if length > 0.0 { n.scale(1.0 / length).0 } else { [0.0; 3] }
    };
    triangles.iter().map(normal).collect()
}

/// Cuboid of half lengths; a rectangle if the last of them is zero.
fn cuboid([x, y, z]: [f64; 3]) -> Triangles {
    if z == 0.0 {
        return (vec![[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]], vec![[0, 1, 2], [0, 2, 3]]);
    }
    // bit k of a corner's number: the positive side along axis k
    let corner = |n: usize| std::array::from_fn(|k| if n >> k & 1 == 1 { [x, y, z][k] } else { -[x, y, z][k] });
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    ((0..8).map(corner).collect(), faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect())
}

/// Points `[r, z]` of a circle about `[0, middle]`, from one quarter to another (−1 the lowest point, 1 the highest).
fn arc(radius: f64, middle: f64, from: i32, to: i32) -> Vec<[f64; 2]> {
    let n = ARC as i32;
    let point = |k: i32| {
        let (sin, cos) = sin_cos(FRAC_PI_2 * f64::from(k) / f64::from(n));
        // the poles lie on the axis
        [if k.abs() == n { 0.0 } else { radius * cos }, middle + radius * sin]
    };
    (from * n..=to * n).map(point).collect()
}

/// Surface of revolution about z of a profile `[r, z]` from the lowest point on the axis to the highest.
fn revolved(profile: &[[f64; 2]]) -> Triangles {
    let inner = &profile[1..profile.len() - 1];
    let mut corners = vec![[0.0, 0.0, profile[0][1]]];
    corners.extend(inner.iter().flat_map(|point| circle(*point)));
    corners.push([0.0, 0.0, profile[profile.len() - 1][1]]);
    let at = |ring: usize, k: usize| (1 + ring * SEGMENTS + k % SEGMENTS) as u32;
    let (top, last) = (corners.len() as u32 - 1, inner.len() - 1);
    let mut triangles = Vec::new();
    for k in 0..SEGMENTS {
        triangles.push([0, at(0, k + 1), at(0, k)]);
        for ring in 0..last {
            let [a, b, c, d] = [at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([at(last, k), at(last, k + 1), top]);
    }
    (corners, triangles)
}

fn torus(major_radius: f64, tube_radius: f64) -> Triangles {
    let n = 4 * ARC;
    let point = |k: usize| {
        let (sin, cos) = sin_cos(TAU * k as f64 / n as f64);
        [major_radius + tube_radius * cos, tube_radius * sin]
    };
    let corners = (0..n).flat_map(|k| circle(point(k))).collect();
    let at = |ring: usize, k: usize| (ring % n * SEGMENTS + k % SEGMENTS) as u32;
    let quad = |ring: usize, k: usize| {
        let [a, b, c, d] = [at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)];
        [[a, b, c], [a, c, d]]
    };
    (corners, (0..n).flat_map(|ring| (0..SEGMENTS).flat_map(move |k| quad(ring, k))).collect())
}

/// Points on a circle of radius r at the height z.
fn circle([r, z]: [f64; 2]) -> impl Iterator<Item = [f64; 3]> {
    (0..SEGMENTS).map(move |k| {
        let (sin, cos) = sin_cos(TAU * k as f64 / SEGMENTS as f64);
        [r * cos, r * sin, z]
    })
}

fn ground(columns: usize, heights: &[f64], size: [f64; 2]) -> Triangles {
    let rows = heights.len() / columns;
    let place = |k: usize, n: usize, length: f64| length * (k as f64 / (n - 1) as f64 - 0.5);
    let corner = |(k, z): (usize, &f64)| [place(k % columns, columns, size[0]), place(k / columns, rows, size[1]), *z];
    let quad = |k: usize| {
        let first = k / (columns - 1) * columns + k % (columns - 1);
        let [a, b, c, d] = [first, first + 1, first + 1 + columns, first + columns].map(|k| k as u32);
        [[a, b, c], [a, c, d]]
    };
    let corners = heights.iter().enumerate().map(corner).collect();
    (corners, (0..(columns - 1) * (rows - 1)).flat_map(quad).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polyhedron::{defects, mass_properties};

    #[test]
    fn meshes_of_solids_are_closed_and_have_nearly_their_volume() {
        let solids = [
            Shape::Cuboid { size: [0.1, 0.2, 0.3] },
            Shape::Sphere { radius: 0.2 },
            Shape::Cylinder { radius: 0.1, length: 0.4 },
            Shape::Cone { radius: 0.1, length: 0.4 },
            Shape::Capsule { radius: 0.1, length: 0.4 },
            Shape::Torus { major_radius: 0.3, tube_radius: 0.1 },
        ];
        for solid in solids {
            let (corners, triangles) = Surface::Solid(solid).triangles().unwrap();
            assert!(defects(&corners, &triangles).is_empty(), "{solid:?}");
            let volume = mass_properties(&corners, &triangles, 1.0).mass;
            let exact = solid.mass_properties(1.0).mass;
            assert!(volume <= exact * (1.0 + 1e-12) && volume > 0.97 * exact, "{solid:?}: {volume} of {exact}");
        }
    }

    #[test]
    fn a_rectangle_is_two_triangles_that_look_up() {
        let mesh = Surface::Solid(Shape::Cuboid { size: [1.0, 2.0, 0.0] }).triangles().unwrap();
        assert_eq!((mesh.0.len(), normals(&mesh)), (4, vec![[0.0, 0.0, 1.0]; 2]));
        assert_eq!(Surface::HalfSpace.triangles(), None);
    }

    #[test]
    fn parts_are_numbered_one_after_the_other() {
        let one = || (vec![[0.0; 3]; 3], vec![[0, 1, 2]]);
        assert_eq!(merged([one(), one()]).1, [[0, 1, 2], [3, 4, 5]]);
    }
}
