//! Triangles of surfaces that are no simple solids, for pictures: hulls of points, meshes, height fields.

use sincro_dynamics::geometry::polyhedron;
use sincro_math::elementary::sin_cos;

/// Corners `[m]` and triangles, counter-clockwise seen from outside.
pub(super) type Triangles = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// Triangles of the convex hull of points; none if they span no volume.
pub(super) fn of_hull(points: &[[f64; 3]]) -> Triangles {
    polyhedron::convex_hull(points)
        .map_or_else(Triangles::default, |(corners, triangles)| of_mesh(&corners, &triangles))
}

/// Triangles of a mesh.
pub(super) fn of_mesh(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Triangles {
    (points.iter().map(|p| single(*p)).collect(), triangles.to_vec())
}

/// Triangles of heights over a grid centred on the frame, `columns` a row along x.
pub(super) fn of_heights(columns: usize, heights: &[f64], size: [f64; 2]) -> Triangles {
    let rows = heights.len() / columns.max(1);
    let along = |k: usize, n: usize, span: f64| span * (k as f64 / (n.max(2) - 1) as f64 - 0.5);
    let corner = |k: usize| {
        let (row, column) = (k / columns, k % columns);
        single([along(column, columns, size[0]), along(row, rows, size[1]), heights[k]])
    };
    let cell = |k: usize| {
        let (row, column) = (k / (columns - 1), k % (columns - 1));
        let a = (row * columns + column) as u32;
        let (b, c, d) = (a + 1, a + columns as u32, a + columns as u32 + 1);
        [[a, b, d], [a, d, c]]
    };
    let n_cells = columns.saturating_sub(1) * rows.saturating_sub(1);
    ((0..rows * columns).map(corner).collect(), (0..n_cells).flat_map(cell).collect())
}

/// Triangles of a torus about z.
pub(super) fn of_torus(major_radius: f64, tube_radius: f64) -> Triangles {
    const AROUND: usize = 48;
    const ALONG: usize = 16;
    let turn = |k: usize, n: usize| sin_cos(core::f64::consts::TAU * k as f64 / n as f64);
    let corner = |k: usize| {
        let ((sin, cos), (up, out)) = (turn(k / ALONG, AROUND), turn(k % ALONG, ALONG));
        let across = major_radius + tube_radius * out;
        single([across * cos, across * sin, tube_radius * up])
    };
    let at = |around: usize, along: usize| ((around % AROUND) * ALONG + along % ALONG) as u32;
    let quad = |k: usize| {
        let (i, j) = (k / ALONG, k % ALONG);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    ((0..AROUND * ALONG).map(corner).collect(), (0..AROUND * ALONG).flat_map(quad).collect())
}

fn single(p: [f64; 3]) -> [f32; 3] {
    p.map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use sincro_dynamics::spatial::Vec3;

    use super::*;

    /// Six times the volume that the triangles enclose.
    fn volume((corners, faces): &Triangles) -> f64 {
        let at = |k: u32| Vec3(corners[k as usize].map(f64::from));
        faces.iter().map(|f| at(f[0]).dot(at(f[1]).cross(at(f[2])))).sum()
    }

    #[test]
    fn a_torus_encloses_nearly_its_volume() {
        let exact = 2.0 * core::f64::consts::PI.powi(2) * 0.3 * 0.05 * 0.05;
        let found = volume(&of_torus(0.3, 0.05)) / 6.0;
        assert!(found < exact && found > 0.97 * exact, "{found} {exact}");
    }

    #[test]
    fn a_hull_encloses_the_volume_of_its_corners() {
        let corner = |k: usize| -> [f64; 3] { std::array::from_fn(|i| f64::from(u8::from(k >> i & 1 == 1)) + 3.0) };
        let mut points: Vec<[f64; 3]> = (0..8).map(corner).collect();
        let cube = of_hull(&points);
        assert_eq!((cube.0.len(), cube.1.len()), (8, 12));
        // more points, inside, on a face and on an edge, in any order: the same volume
        points.extend([[3.2, 3.5, 3.5], [3.5, 3.5, 3.0], [3.5, 3.0, 3.0]]);
        for _ in 0..points.len() {
            points.rotate_left(1);
            let made = of_hull(&points);
            assert!((volume(&made) - 6.0).abs() < 1e-5, "{}", volume(&made));
            assert!(!made.0.contains(&[3.2, 3.5, 3.5]), "what is inside is no corner");
        }
    }

    #[test]
    fn flat_points_have_no_hull() {
        assert!(of_hull(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]).1.is_empty());
        assert!(of_hull(&[]).1.is_empty());
    }

    #[test]
    fn heights_look_up() {
        let (corners, faces) = of_heights(3, &[0.0, 0.0, 1.0, 0.0, 0.0, 2.0], [4.0, 2.0]);
        assert_eq!((corners[2], corners[3]), ([2.0, -1.0, 1.0], [-2.0, 1.0, 0.0]));
        assert_eq!(faces.len(), 4);
        for face in faces {
            let [a, b, c] = face.map(|k| Vec3(corners[k as usize].map(f64::from)));
            assert!((b - a).cross(c - a)[2] > 0.0, "{face:?}");
        }
    }
}
