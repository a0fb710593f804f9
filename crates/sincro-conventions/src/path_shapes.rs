//! Points of paths between control points: smooth, closed, turned along the path.

use sincro_geometry::spatial::{Mat3, Vec3};

use crate::paths::{Curve, POSE, Path};
use crate::poses::quaternion_of;

/// Form of the points between control points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// True if the last point is the first.
    pub is_closed: bool,
    /// True if the orientation follows the path.
    pub is_oriented: bool,
    /// Number of points, 2 or more.
    pub n: usize,
    /// From 0, straight lines, to 1 (dimensionless).
    pub smoothness: f64,
    /// Axes along the path and up, 0 to 5: x and y, x and z, y and x, y and z, z and x, z and y.
    pub mode: i64,
    /// Direction upwards.
    pub up: Vec3<f64>,
}

/// Lengths of a list of poses, seven numbers each, up to each of them: those of its positions `[m]`.
#[must_use]
pub fn lengths_of(poses: &[f64]) -> Vec<f64> {
    let positions: Vec<[f64; 3]> = poses.chunks_exact(7).map(|p| [p[0], p[1], p[2]]).collect();
    let mut sum = 0.0;
    let steps = positions.windows(2).map(|pair| {
        sum += (Vec3(pair[1]) - Vec3(pair[0])).norm();
        sum
    });
    [0.0].into_iter().chain(steps).collect()
}

/// Points of the path between control points, seven numbers each.
///
/// # Errors
///
/// As [`Path::new`].
pub fn sampled(control: &[f64], shape: &Shape) -> Result<Vec<f64>, &'static str> {
    let mut control = control.to_vec();
    if shape.is_closed && control[..7] != control[control.len() - 7..] {
        control.extend_from_within(..7);
    }
    let lengths = lengths_of(&control);
    let curve = match shape.smoothness {
        0.0 => Curve::Linear,
        strength => Curve::Bezier { strength, is_open: !shape.is_closed },
    };
    let mut points = Path::new(&control, &lengths)?.resampled(shape.n, curve, &POSE);
    if shape.is_oriented {
        orient(&mut points, shape);
    }
    Ok(points)
}

/// Turns each point along the path: by `mode` x along and y up (0), x along and z up (1), y along and x up (2), y along
/// and z up (3), z along and x up (4), z along and y up (5).
fn orient(points: &mut [f64], shape: &Shape) {
    let n = points.len() / 7;
    let position = |k: usize, points: &[f64]| Vec3([points[7 * k], points[7 * k + 1], points[7 * k + 2]]);
    let mut last = None;
    for k in 0..n {
        let (before, behind) = match (k, shape.is_closed) {
            (0, true) => (n.saturating_sub(2), 1),
            (k, true) if k + 1 == n => (k - 1, 1),
            (k, _) => (k.saturating_sub(1), (k + 1).min(n - 1)),
        };
        let along = position(behind, points) - position(before, points);
        let rot = oriented(along, shape.up, shape.mode).or(last);
        if let Some(rot) = rot {
            points[7 * k + 3..7 * k + 7].copy_from_slice(&quaternion_of(&rot));
        }
        last = rot;
    }
}

/// Rotation with one axis along a direction and another one as far up as that allows; none if both are the same.
fn oriented(along: Vec3<f64>, up: Vec3<f64>, mode: i64) -> Option<Mat3<f64>> {
    let unit = |v: Vec3<f64>| {
        let length = v.norm();
        (length > 1e-12).then(|| v.scale(1.0 / length))
    };
    let along = unit(along)?;
    let side = unit(along.cross(up))?;
    let up = side.cross(along);
    let (first, second) = match mode {
        1 => (0, 2),
        2 => (1, 0),
        3 => (1, 2),
        4 => (2, 0),
        5 => (2, 1),
        _ => (0, 1),
    };
    let mut columns = [Vec3([0.0; 3]); 3];
    (columns[first], columns[second]) = (along, up);
    let third = 3 - first - second;
    columns[third] = columns[(third + 1) % 3].cross(columns[(third + 2) % 3]);
    let [x, y, z] = columns;
    Some(Mat3([[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]]))
}
