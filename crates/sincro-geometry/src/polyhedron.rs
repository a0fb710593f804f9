//! Triangle meshes: test for a closed surface, mass properties, convex hull of points.
//!
//! A mesh encloses a volume if every edge is traversed once in each direction and the corners of each triangle are
//! counter-clockwise seen from outside. Its mass properties are sums over the tetrahedra of one corner with each
//! triangle, exact but for rounding: of a tetrahedron with corners 0, a, b, c and D = det(a, b, c) the volume is D/6,
//! the first moment D/24·s and the second D/120·(a aᵀ + b bᵀ + c cᵀ + s sᵀ), s = a + b + c.

use std::collections::BTreeMap;

use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;

use super::MassProperties;
use crate::spatial::Vec3;

/// Twice the area of a triangle over the square of its longest side below which it is a line.
const FLAT: f64 = 1e-12;

/// Volume of a hull over the cube of its extent below which it is flat.
const NO_VOLUME: f64 = 1e-9;

/// Defect that keeps a triangle mesh from enclosing a volume, from [`defects`]. Corners and triangles are counted from
/// 0 in the lists given to it; edges are two corners `[m]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeshDefect {
    /// A coordinate of a corner is NaN or infinite.
    NotFinite {
        /// Index of the corner.
        corner: usize,
    },
    /// Fewer than four triangles.
    TooFew,
    /// A triangle without area: its corners lie on a line.
    Flat {
        /// Index of the triangle.
        triangle: usize,
    },
    /// An edge of a triangle that no other triangle traverses in the opposite direction: the surface has a hole.
    Open {
        /// Index of the triangle.
        triangle: usize,
        /// Start and end of the edge `[m]`.
        edge: [[f64; 3]; 2],
    },
    /// An edge that two triangles traverse in the same direction: one of them is turned over or doubled.
    Twice {
        /// Indices of the two triangles.
        triangles: [usize; 2],
        /// Start and end of the edge `[m]`.
        edge: [[f64; 3]; 2],
    },
    /// A closed surface whose triangles are clockwise seen from outside.
    InsideOut {
        /// Signed volume `[m³]`, zero or negative.
        volume: f64,
    },
}

/// Checks that a mesh encloses a volume: its defects, empty if there is none.
///
/// `corners` are points `[m]`; each triangle holds three indices into them, counter-clockwise seen from outside.
/// Corners that are not finite, or fewer than four triangles, are reported alone; then flat and doubled triangles in
/// the order of the list, and open edges in the order of their corners.
///
/// # Panics
///
/// If a triangle has an index beyond the corners.
#[must_use]
pub fn defects(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<MeshDefect> {
    let bad = (0..corners.len()).filter(|k| !corners[*k].iter().all(|x| x.is_finite()));
    let mut defects: Vec<MeshDefect> = bad.map(|corner| MeshDefect::NotFinite { corner }).collect();
    if !defects.is_empty() {
        return defects;
    }
    if triangles.len() < 4 {
        return vec![MeshDefect::TooFew];
    }
    let point = |k: u32| corners[k as usize];
    let mut edges = BTreeMap::new();
    for (triangle, t) in triangles.iter().enumerate() {
        if is_flat(t.map(point)) {
            defects.push(MeshDefect::Flat { triangle });
        }
        for k in 0..3 {
            let ends = [t[k], t[(k + 1) % 3]];
            if let Some(first) = edges.insert(ends, triangle) {
                defects.push(MeshDefect::Twice { triangles: [first, triangle], edge: ends.map(point) });
            }
        }
    }
    let open = edges.iter().filter(|([a, b], _)| !edges.contains_key(&[*b, *a]));
    defects.extend(open.map(|(ends, triangle)| MeshDefect::Open { triangle: *triangle, edge: ends.map(point) }));
    if defects.is_empty() {
        let volume = mass_properties(corners, triangles, 1.0).mass;
        if volume <= 0.0 {
            defects.push(MeshDefect::InsideOut { volume });
        }
    }
    defects
}

fn is_flat(corners: [[f64; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3);
    let (x, y, z) = (b - a, c - a, c - b);
    let longest = x.dot(x).max(y.dot(y)).max(z.dot(z));
    x.cross(y).norm() <= FLAT * longest
}

/// Mass `[kg]`, centre of mass `[m]` and inertia `[kg·m²]` of the volume inside a closed mesh of uniform `density`
/// `[kg/m³]`, in the frame of its corners.
///
/// `corners` are points `[m]`; each triangle holds three indices into them, counter-clockwise seen from outside.
/// Meaningful only for a mesh without [`defects`]; NaN for one without volume.
///
/// # Panics
///
/// If a triangle has an index beyond the corners.
#[must_use]
pub fn mass_properties(corners: &[[f64; 3]], triangles: &[[u32; 3]], density: f64) -> MassProperties {
    // seen from one of its corners, so that a mesh far from its origin loses no digits
    let origin = triangles.first().map_or(Vec3::zero(), |t| Vec3(corners[t[0] as usize]));
    let (mut volume, mut first, mut second) = (0.0, Vec3::zero(), [[0.0; 3]; 3]);
    for t in triangles {
        let [a, b, c] = t.map(|k| Vec3(corners[k as usize]) - origin);
        let (det, s) = (a.dot(b.cross(c)), a + b + c);
        volume += det / 6.0;
        first += s.scale(det / 24.0);
        for (i, row) in second.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += det / 120.0 * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]);
            }
        }
    }
    let center = first.scale(1.0 / volume);
    // ∫(x − c)(x − c)ᵀ dV, and from it the inertia tr(S)·1 − S
    let about = |i: usize, j: usize| second[i][j] - volume * center[i] * center[j];
    let trace = about(0, 0) + about(1, 1) + about(2, 2);
    let entry = |(i, j): (usize, usize)| density * (if i == j { trace } else { 0.0 } - about(i, j));
    let inertia = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].map(entry);
    MassProperties { mass: density * volume, center_of_mass: (origin + center).0, inertia }
}

/// Triangle mesh: corners `[m]`, and triangles of three indices into them, counter-clockwise seen from outside.
pub type Triangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// Convex hull of points `[m]` as a closed mesh in the same frame. `None` for fewer than four points, for coordinates
/// that are not finite, and for points that span no volume.
///
/// ```
/// use sincro_geometry::polyhedron::{convex_hull, mass_properties};
///
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let (corners, triangles) = convex_hull(&points).unwrap();
/// let tetrahedron = mass_properties(&corners, &triangles, 6000.0); // [kg/m³]
/// assert!((tetrahedron.mass - 1000.0).abs() < 1e-9); // 1/6 m³ of it [kg]
/// ```
#[must_use]
pub fn convex_hull(points: &[[f64; 3]]) -> Option<Triangles> {
    if points.len() < 4 || !points.iter().flatten().all(|x| x.is_finite()) {
        return None;
    }
    let list: Vec<Vector> = points.iter().map(|p| Vector::from_array(*p)).collect();
    let (corners, triangles) = try_convex_hull(&list).ok()?;
    let corners: Vec<[f64; 3]> = corners.iter().map(|p| [p.x, p.y, p.z]).collect();
    let extent = corners.iter().map(|p| (Vec3(*p) - Vec3(corners[0])).norm()).fold(0.0, f64::max);
    let volume = mass_properties(&corners, &triangles, 1.0).mass;
    (volume > NO_VOLUME * extent * extent * extent).then_some((corners, triangles))
}

#[cfg(test)]
mod tests {
    use super::super::Shape;
    use super::*;

    /// Corners and outward triangles of a cuboid about `center`.
    fn cuboid(size: [f64; 3], center: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let corner = |k: usize| {
            std::array::from_fn(|c| center[c] + if k >> c & 1 == 0 { -0.5 * size[c] } else { 0.5 * size[c] })
        };
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = faces.iter().flat_map(|f: &[u32; 4]| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]);
        ((0..8).map(corner).collect(), triangles.collect())
    }

    fn close(a: f64, b: f64, size: f64) {
        assert!((a - b).abs() <= 1e-14 * size, "{a} {b}");
    }

    #[test]
    fn a_cuboid_of_triangles_weighs_what_a_cuboid_does() {
        let (size, center) = ([0.2, 0.3, 0.5], [0.4, -0.1, 0.7]);
        let (corners, triangles) = cuboid(size, center);
        assert_eq!(defects(&corners, &triangles), []);
        let (mesh, solid) =
            (mass_properties(&corners, &triangles, 700.0), Shape::Cuboid { size }.mass_properties(700.0));
        close(mesh.mass, solid.mass, solid.mass);
        (0..3).for_each(|k| close(mesh.center_of_mass[k], center[k], 1.0));
        (0..6).for_each(|k| close(mesh.inertia[k], solid.inertia[k], solid.inertia[0]));
    }

    #[test]
    fn a_tetrahedron_has_its_textbook_moments() {
        // corners 0 and the unit points: volume 1/6, centre 1/4, ∫x² = 1/60, ∫xy = 1/120
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        assert_eq!(defects(&corners, &triangles), []);
        let found = mass_properties(&corners, &triangles, 6.0);
        close(found.mass, 1.0, 1.0);
        (0..3).for_each(|k| close(found.center_of_mass[k], 0.25, 1.0));
        close(found.inertia[0], 2.0 * (0.1 - 0.0625), 1.0);
        close(found.inertia[1], -(0.05 - 0.0625), 1.0);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let (corners, triangles) = cuboid([1.0; 3], [0.0; 3]);
        let mut open = triangles.clone();
        open.remove(5);
        assert!(matches!(
            defects(&corners, &open)[..],
            [MeshDefect::Open { .. }, MeshDefect::Open { .. }, MeshDefect::Open { .. }]
        ));
        let mut turned = triangles.clone();
        turned[5].swap(0, 1);
        assert!(defects(&corners, &turned).iter().any(|f| matches!(f, MeshDefect::Twice { triangles: [_, 5], .. })));
        let inside: Vec<[u32; 3]> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        assert!(matches!(defects(&corners, &inside)[..], [MeshDefect::InsideOut { .. }]));
        let mut nan = corners.clone();
        nan[3][1] = f64::NAN;
        assert_eq!(defects(&nan, &triangles), [MeshDefect::NotFinite { corner: 3 }]);
        let mut flat = triangles.clone();
        flat[2] = [0, 1, 1];
        assert!(defects(&corners, &flat).contains(&MeshDefect::Flat { triangle: 2 }));
        assert_eq!(defects(&corners, &triangles[..3]), [MeshDefect::TooFew]);
    }

    #[test]
    fn a_hull_keeps_corners_and_drops_what_is_inside() {
        let (mut points, _) = cuboid([0.2, 0.4, 0.6], [0.0; 3]);
        points.extend([[0.0; 3], [0.05, 0.1, -0.2], [0.09, 0.0, 0.0]]);
        let (corners, triangles) = convex_hull(&points).unwrap();
        assert_eq!((corners.len(), triangles.len()), (8, 12));
        assert_eq!(defects(&corners, &triangles), []);
        close(mass_properties(&corners, &triangles, 1.0).mass, 0.048, 1.0);
        assert!(convex_hull(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]).is_none());
        assert!(convex_hull(&points[..3]).is_none());
    }
}
