//! Faces of the shapes of a scene.

use sincro_math::elementary;
use sincro_sim::replay::ShapeView;

use crate::vector::{V, add, dot, origin, point, rotate, scale, sub};

/// Sides of what is round.
const N_SIDES: usize = 20;
/// Triangles that a mesh has in a picture at most; one with more is drawn coarser.
const MAX_TRIANGLES: usize = 1200;
/// Squares along an edge of a plane's piece.
const N_SQUARES: usize = 10;

/// A flat face, or a line if it has two corners; what is not quite opaque is drawn fine.
pub(super) struct Face {
    pub corners: Vec<V>,
    pub color: [f64; 3],
    pub opacity: f64,
}

/// Adds the faces of a shape; a plane has none of its own ([`plane`]).
pub(super) fn solid(shape: &ShapeView, at: &[f64; 7], color: [f64; 3], faces: &mut Vec<Face>) {
    let size = |k: usize| shape.size.get(k).copied().unwrap_or(0.0);
    let (a, b) = (size(0), size(1));
    match shape.kind {
        "plane" => {}
        "mesh" => mesh(shape, at, color, faces),
        "cuboid" => cuboid([a, b, size(2)], at, color, faces),
        "cylinder" => turned(&[(0.0, -b / 2.0), (a, -b / 2.0), (a, b / 2.0), (0.0, b / 2.0)], at, color, faces),
        "cone" => turned(&[(0.0, -b / 4.0), (a, -b / 4.0), (0.0, 0.75 * b)], at, color, faces),
        // a sphere is a capsule without a middle
        kind => turned(&meridian(a, if kind == "capsule" { b / 2.0 } else { 0.0 }), at, color, faces),
    }
}

/// The piece of a plane below a box of the world, with its lines.
pub(super) fn plane(at: &[f64; 7], (low, high): (V, V), color: [f64; 3], faces: &mut Vec<Face>) {
    let normal = rotate(at, [0.0, 0.0, 1.0]);
    let middle = scale(add(low, high), 0.5);
    let foot = sub(middle, scale(normal, dot(sub(middle, origin(at)), normal)));
    let size = sub(high, low);
    let half = 0.62 * dot(size, size).sqrt();
    let corner = |x: f64, y: f64| {
        let (along, across) = (rotate(at, [1.0, 0.0, 0.0]), rotate(at, [0.0, 1.0, 0.0]));
        add(foot, add(scale(along, half * x), scale(across, half * y)))
    };
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    faces.push(Face { corners: square.map(|[x, y]| corner(x, y)).to_vec(), color, opacity: 1.0 });
    let darker = color.map(|c| 0.88 * c);
    for k in 0..=N_SQUARES {
        let at = 2.0 * k as f64 / N_SQUARES as f64 - 1.0;
        for ends in [[corner(at, -1.0), corner(at, 1.0)], [corner(-1.0, at), corner(1.0, at)]] {
            faces.push(Face { corners: ends.to_vec(), color: darker, opacity: 0.6 });
        }
    }
}

fn mesh(shape: &ShapeView, at: &[f64; 7], color: [f64; 3], faces: &mut Vec<Face>) {
    let corners: Vec<V> = shape.vertices.iter().map(|p| p.map(f64::from)).collect();
    let mut triangles = shape.triangles.clone();
    let mut cells = 96.0;
    while triangles.len() > MAX_TRIANGLES && cells > 4.0 {
        triangles = coarser(&corners, &shape.triangles, cells);
        cells *= 0.75;
    }
    for triangle in triangles {
        let corners = triangle.iter().map(|k| point(at, corners[*k as usize])).collect();
        faces.push(Face { corners, color, opacity: 1.0 });
    }
}

/// All corners within a cell become one of them; triangles that vanish are left out.
fn coarser(corners: &[V], triangles: &[[u32; 3]], cells: f64) -> Vec<[u32; 3]> {
    let bound = |least: bool| -> V {
        std::array::from_fn(|k| {
            let values = corners.iter().map(|p| p[k]);
            values.reduce(|a, b| if least { a.min(b) } else { a.max(b) }).unwrap_or(0.0)
        })
    };
    let (low, high) = (bound(true), bound(false));
    let edge = sub(high, low).into_iter().fold(1e-12, f64::max) / cells;
    let mut first = std::collections::BTreeMap::new();
    let of: Vec<u32> = (0_u32..)
        .zip(corners)
        .map(|(k, p)| *first.entry(sub(*p, low).map(|x| (x / edge) as u32)).or_insert(k))
        .collect();
    let moved = triangles.iter().map(|t| t.map(|k| of[k as usize]));
    moved.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// Radius and height along half a circle that is pulled apart by 2·`half`.
fn meridian(radius: f64, half: f64) -> Vec<(f64, f64)> {
    const N: u32 = 12;
    let corner = |k: u32| {
        let (sin, cos) = elementary::sin_cos(std::f64::consts::PI * f64::from(k) / f64::from(N));
        (radius * sin, -radius * cos + if 2 * k <= N { -half } else { half })
    };
    (0..=N).map(corner).collect()
}

pub(super) fn cuboid(size: V, at: &[f64; 7], color: [f64; 3], faces: &mut Vec<Face>) {
    let corner =
        |k: usize| -> V { std::array::from_fn(|i| if k >> i & 1 == 1 { size[i] / 2.0 } else { -size[i] / 2.0 }) };
    for corners in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        faces.push(Face { corners: corners.iter().map(|k| point(at, corner(*k))).collect(), color, opacity: 1.0 });
    }
}

pub(super) fn ring(radius: f64, z: f64) -> impl Iterator<Item = V> {
    (0..N_SIDES).map(move |k| {
        let (sin, cos) = elementary::sin_cos(2.0 * std::f64::consts::PI * k as f64 / N_SIDES as f64);
        [radius * cos, radius * sin, z]
    })
}

/// A profile of (radius, height) turned about z.
fn turned(profile: &[(f64, f64)], at: &[f64; 7], color: [f64; 3], faces: &mut Vec<Face>) {
    for pair in profile.windows(2) {
        let (low, high): (Vec<V>, Vec<V>) =
            (ring(pair[0].0, pair[0].1).collect(), ring(pair[1].0, pair[1].1).collect());
        if pair[0].1 == pair[1].1 {
            // an end: one face, its corners in the order in which it is seen from outside
            let (mut end, is_lower) = if pair[0].0 > pair[1].0 { (low, false) } else { (high, true) };
            if is_lower {
                end.reverse();
            }
            faces.push(Face { corners: end.into_iter().map(|p| point(at, p)).collect(), color, opacity: 1.0 });
            continue;
        }
        for k in 0..N_SIDES {
            let next = (k + 1) % N_SIDES;
            let corners = [low[k], low[next], high[next], high[k]].map(|p| point(at, p));
            faces.push(Face { corners: corners.to_vec(), color, opacity: 1.0 });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::cross;

    #[test]
    fn a_large_mesh_is_drawn_coarser_and_keeps_its_size() {
        let n = 80_u32;
        let vertices = (0..n * n).map(|k| [(k % n) as f32, (k / n) as f32, 0.0]).collect();
        let cell = |k: u32| {
            let a = k / (n - 1) * n + k % (n - 1);
            [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]
        };
        let triangles: Vec<[u32; 3]> = (0..(n - 1) * (n - 1)).flat_map(cell).collect();
        let shape = ShapeView {
            kind: "mesh",
            size: vec![],
            vertices,
            triangles,
            pose: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            color: None,
        };
        let mut faces = Vec::new();
        solid(&shape, &shape.pose, [0.5; 3], &mut faces);
        assert!(faces.len() <= MAX_TRIANGLES && faces.len() > 300, "{}", faces.len());
        let area = |face: &Face| {
            let normal = cross(sub(face.corners[1], face.corners[0]), sub(face.corners[2], face.corners[0]));
            0.5 * normal[2]
        };
        let (covered, whole): (f64, f64) = (faces.iter().map(area).sum(), f64::from((n - 1) * (n - 1)));
        assert!(covered > 0.85 * whole && covered < 1.01 * whole, "{covered} of {whole}");
    }

    #[test]
    fn round_solids_are_closed_and_look_outwards() {
        for profile in [meridian(1.0, 0.0), meridian(1.0, 0.5), vec![(0.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0)]]
        {
            let mut faces = Vec::new();
            turned(&profile, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [0.5; 3], &mut faces);
            for face in &faces {
                let first = face.corners[0];
                let pairs = face.corners.windows(2).skip(1);
                let area = pairs.fold([0.0; 3], |sum: V, p| add(sum, cross(sub(p[0], first), sub(p[1], first))));
                let middle = face.corners.iter().fold([0.0; 3], |sum: V, p| add(sum, *p));
                assert!(dot(area, middle) > 0.0, "{:?}", face.corners);
            }
        }
    }
}
