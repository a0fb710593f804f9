//! Edges of the fields of view of proximity sensors, for pictures.

use std::f64::consts::PI;

use sincro_dynamics::geometry::Volume;
use sincro_math::elementary::sin_cos;

/// Chords of a full circle.
const N_CHORDS: usize = 24;

/// Edge of the volume of a proximity sensor: two points, x, y, z in the sensor's frame `[m]`.
pub type Edge = [[f64; 3]; 2];

/// Edges of a volume from `offset` to `offset` + `range` along z of its sensor.
pub(super) fn edges(volume: Volume, offset: f64, range: f64) -> Vec<Edge> {
    let end = offset + range;
    match volume {
        Volume::Ray => vec![[[0.0, 0.0, offset], [0.0, 0.0, end]]],
        Volume::Cylinder { radius, far_radius } => {
            let side = |k: usize| [on_circle(radius, offset, k, 4), on_circle(far_radius, end, k, 4)];
            [circle(radius, offset), circle(far_radius, end), (0..4).map(side).collect()].concat()
        }
        Volume::Disc { angle } => [arc(angle, end, 0), sides(angle, offset, end, &[0])].concat(),
        Volume::Cone { angle } => {
            let (sin, cos) = sin_cos(0.5 * angle);
            [circle(end * sin, end * cos), arc(angle, end, 0), arc(angle, end, 1), sides(angle, offset, end, &[0, 1])]
                .concat()
        }
        Volume::Pyramid { size, far_size } => {
            let corner = |size: [f64; 2], z: f64, k: usize| {
                let signs = [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]][k % 4];
                [signs[0] * size[0], signs[1] * size[1], z]
            };
            let of_corner = |k: usize| {
                let (near, far) = (corner(size, offset, k), corner(far_size, end, k));
                [[near, far], [near, corner(size, offset, k + 1)], [far, corner(far_size, end, k + 1)]]
            };
            (0..4).flat_map(of_corner).collect()
        }
    }
}

fn on_circle(radius: f64, z: f64, k: usize, n: usize) -> [f64; 3] {
    let (sin, cos) = sin_cos(2.0 * PI * k as f64 / n as f64);
    [radius * cos, radius * sin, z]
}

fn circle(radius: f64, z: f64) -> Vec<Edge> {
    (0..N_CHORDS).map(|k| [on_circle(radius, z, k, N_CHORDS), on_circle(radius, z, k + 1, N_CHORDS)]).collect()
}

/// A point at a distance from the origin and an angle from z, towards x (0) or y (1).
fn at_angle(angle: f64, distance: f64, axis: usize) -> [f64; 3] {
    let (sin, cos) = sin_cos(angle);
    let mut point = [0.0, 0.0, distance * cos];
    point[axis] = distance * sin;
    point
}

/// The far end of a fan.
fn arc(angle: f64, end: f64, axis: usize) -> Vec<Edge> {
    let point = |k: usize| at_angle(angle * (k as f64 / N_CHORDS as f64 - 0.5), end, axis);
    (0..N_CHORDS).map(|k| [point(k), point(k + 1)]).collect()
}

/// The straight sides of fans.
fn sides(angle: f64, offset: f64, end: f64, axes: &[usize]) -> Vec<Edge> {
    let both = |axis: &usize| [0.5, -0.5].map(|half| [offset, end].map(|r| at_angle(half * angle, r, *axis)));
    axes.iter().flat_map(both).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_lie_within_the_range() {
        let volumes = [
            Volume::Ray,
            Volume::Cylinder { radius: 0.1, far_radius: 0.2 },
            Volume::Disc { angle: 1.0 },
            Volume::Cone { angle: 0.5 },
            Volume::Pyramid { size: [0.1, 0.2], far_size: [0.3, 0.4] },
        ];
        for volume in volumes {
            let edges = edges(volume, 0.05, 1.0);
            let far_end = edges.iter().flatten().map(|p| p[2]).fold(0.0, f64::max);
            assert!((far_end - 1.05).abs() < 1e-9, "{volume:?}: {far_end}");
            assert!(edges.iter().flatten().all(|p| p[2] > 0.0), "{volume:?}");
        }
    }
}
