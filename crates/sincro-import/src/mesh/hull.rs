//! Convex hulls with few corners, for contact, and the ball that ellipsoids are scaled from.

use std::collections::BTreeSet;

use sincro_dynamics::geometry::polyhedron;
use sincro_dynamics::spatial::Vec3;

use super::Part;

/// Corners of a hull that is made; each may touch.
const HULL_CORNERS: usize = 128;
/// Points that a hull is made of, before its corners are chosen.
const CANDIDATES: usize = 500;

/// Ball of radius 1 m: an icosahedron, its triangles split twice.
pub(super) fn ball() -> Part {
    let g = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners: Vec<[f64; 3]> = Vec::new();
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        corners.extend([[a, b, 0.0], [0.0, a, b], [b, 0.0, a]]);
    }
    let unit = |p: [f64; 3]| {
        let norm = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
        p.map(|x| x / norm)
    };
    let hull = |points: Vec<[f64; 3]>| polyhedron::convex_hull(&points).unwrap_or_default();
    let mut mesh = hull(corners.into_iter().map(unit).collect());
    for _ in 0..2 {
        let (corners, triangles) = mesh;
        let middle = |a: u32, b: u32| unit(std::array::from_fn(|c| corners[a as usize][c] + corners[b as usize][c]));
        let between = triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let new = between.filter(|(a, b)| a < b).map(|(a, b)| middle(a, b));
        mesh = hull(corners.iter().copied().chain(new.collect::<Vec<_>>()).collect());
    }
    Part { corners: mesh.0, triangles: mesh.1, color: None }
}

/// Convex hull with few corners, those farthest in directions spread evenly; how many points it was made of, and how
/// far these are outside of it at most `[m]`, 0 if it is exact.
pub(super) fn reduced_hull(corners: &[[f64; 3]]) -> Option<(Part, usize, f64)> {
    let mut distinct: Vec<[u64; 3]> = corners.iter().map(|p| p.map(|x| (x + 0.0).to_bits())).collect();
    distinct.sort_unstable();
    distinct.dedup();
    let points: Vec<[f64; 3]> = distinct.into_iter().map(|p| p.map(f64::from_bits)).collect();
    // far more points than corners: first those that are extreme in many directions. The time of a hull grows with the
    // square of the points on one of its faces, as on the rim of a cylinder or a fan.
    let is_thinned = points.len() > CANDIDATES;
    let thinned = is_thinned.then(|| support(&points, CANDIDATES));
    let (hull, triangles) = polyhedron::convex_hull(thinned.as_ref().unwrap_or(&points))?;
    let part = if hull.len() <= HULL_CORNERS {
        Part { corners: hull, triangles, color: None }
    } else {
        let (corners, triangles) = polyhedron::convex_hull(&support(&hull, HULL_CORNERS))?;
        Part { corners, triangles, color: None }
    };
    let outside = outside(&points, &part);
    Some((part, points.len(), outside))
}

/// Largest distance of points from the nearest face plane that they are beyond `[m]`; rounding counts as 0.
fn outside(points: &[[f64; 3]], hull: &Part) -> f64 {
    let extent = hull.corners.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
    let mut largest = 0.0;
    for triangle in &hull.triangles {
        let [a, b, c] = triangle.map(|k| Vec3(hull.corners[k as usize]));
        let normal = (b - a).cross(c - a);
        let norm = normal.norm();
        if norm <= f64::MIN_POSITIVE {
            continue;
        }
        let normal = normal.scale(1.0 / norm);
        let offset = normal.dot(a);
        largest = points.iter().fold(largest, |largest: f64, p| largest.max(normal.dot(Vec3(*p)) - offset));
    }
    if largest > 1e-9 * extent { largest } else { 0.0 }
}

/// The points that are farthest in `n` directions of a spiral over the sphere, each once.
fn support(points: &[[f64; 3]], n: usize) -> Vec<[f64; 3]> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let extreme = |k: usize| {
        let z = 1.0 - 2.0 * (k as f64 + 0.5) / n as f64;
        let (s, c) = sincro_math::elementary::sin_cos(golden * k as f64);
        let r = (1.0 - z * z).sqrt();
        let d = [r * c, r * s, z];
        let along = |p: &[f64; 3]| p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
        let (mut best, mut largest) = (0, along(&points[0]));
        for (k, p) in points.iter().enumerate() {
            let distance = along(p);
            if distance > largest {
                (best, largest) = (k, distance);
            }
        }
        best
    };
    let chosen: BTreeSet<usize> = (0..n).map(extreme).collect();
    chosen.into_iter().map(|k| points[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hulls_with_many_corners_are_reduced() {
        let n = 3_000;
        let tetrahedron = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(support(&tetrahedron, 4).len() <= 4);
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let point = |k: usize| {
            let z = 1.0 - 2.0 * (k as f64 + 0.5) / n as f64;
            let r = (1.0 - z * z).sqrt();
            let (s, c) = sincro_math::elementary::sin_cos(golden * k as f64);
            [r * c, r * s, z]
        };
        let points: Vec<[f64; 3]> = (0..n).map(point).collect();
        let (hull, before, outside) = reduced_hull(&points).unwrap();
        assert_eq!(before, n);
        assert!(outside > 1e-3 && outside < 0.04, "{outside}");
        assert!(hull.corners.len() <= HULL_CORNERS);
        let volume = polyhedron::mass_properties(&hull.corners, &hull.triangles, 1.0).mass;
        assert!(volume > 0.93 * 4.0 / 3.0 * std::f64::consts::PI, "{volume}");
    }

    #[test]
    fn the_hull_of_many_points_on_one_circle_and_of_a_fine_box() {
        let n = 5_000;
        let rim = |k: usize| {
            let (s, c) = sincro_math::elementary::sin_cos(2.0 * std::f64::consts::PI * k as f64 / n as f64);
            [0.1 * c, 0.1 * s, 0.0]
        };
        let fan: Vec<[f64; 3]> = (0..n).map(rim).chain([[0.0, 0.0, 0.1]]).collect();
        let (hull, _, outside) = reduced_hull(&fan).unwrap();
        assert_eq!(polyhedron::defects(&hull.corners, &hull.triangles), []);
        assert!(outside > 0.0 && outside < 1e-3, "{outside}");
        let grid = |k: usize| [(k % 20) as f64 / 19.0, (k / 20 % 20) as f64 / 19.0, (k / 400) as f64 / 19.0];
        let cube: Vec<[f64; 3]> = (0..8_000).map(grid).collect();
        let (hull, _, outside) = reduced_hull(&cube).unwrap();
        assert_eq!((hull.corners.len(), outside), (8, 0.0));
    }
}
