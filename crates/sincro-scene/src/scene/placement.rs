//! Placement: position and rotation as written, to a pose.

use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_math::elementary::sin_cos;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Document;

/// Position `[m]` and one of the two forms of a rotation; the schema lets only one through.
pub(super) struct Placement {
    position: [f64; 3],
    rotation_deg: Option<[f64; 3]>,
    quaternion_wxyz: Option<[f64; 4]>,
}

impl Placement {
    pub fn new(position: [f64; 3], rotation_deg: Option<[f64; 3]>, quaternion_wxyz: Option<[f64; 4]>) -> Self {
        Self { position, rotation_deg, quaternion_wxyz }
    }
}

/// The pose; notes a null quaternion.
pub(super) fn pose(
    placement: &Placement,
    pointer: &str,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> Pose<f64> {
    let rot = match (placement.rotation_deg, placement.quaternion_wxyz) {
        (Some(angles), _) => rotation(angles),
        (None, Some(q)) => normalized(q).map_or_else(
            || {
                let at = document.at(&format!("{pointer}/quaternion_wxyz"));
                let diagnostic = Diagnostic::error(&at, format!("the quaternion {q:?} has no direction"));
                diagnostics.push(diagnostic.with_help("no rotation is [1, 0, 0, 0]: w, x, y, z"));
                Mat3::identity()
            },
            |q| q.matrix(),
        ),
        (None, None) => Mat3::identity(),
    };
    Pose { rot, pos: Vec3(placement.position) }
}

/// Rz(yaw)·Ry(pitch)·Rx(roll) of angles `[deg]`.
fn rotation([roll, pitch, yaw]: [f64; 3]) -> Mat3<f64> {
    let about = |degrees: f64| sin_cos_degrees(degrees);
    let ((sx, cx), (sy, cy), (sz, cz)) = (about(roll), about(pitch), about(yaw));
    Mat3::rotation::<2>(sz, cz).mul(&Mat3::rotation::<1>(sy, cy)).mul(&Mat3::rotation::<0>(sx, cx))
}

/// Exact for right angles, which is what most frames are turned by.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turned = degrees % 360.0;
    match turned {
        0.0 => (0.0, 1.0),
        90.0 | -270.0 => (1.0, 0.0),
        180.0 | -180.0 => (0.0, -1.0),
        270.0 | -90.0 => (-1.0, 0.0),
        _ => sin_cos(turned.to_radians()),
    }
}

/// The quaternion at length one; none if it has no direction.
pub(super) fn normalized(q: [f64; 4]) -> Option<Quat<f64>> {
    let largest = q.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    if !(largest > 1e-12 && largest.is_finite()) {
        return None;
    }
    // scaled first: no square overflows
    Some(Quat::from_slice(&q.map(|x| x / largest)).normalized())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roll_acts_first_and_yaw_last() {
        // the z axis, rolled by 90° to −y, then yawed by 90° to x
        let z = rotation([90.0, 0.0, 90.0]).mul_vec(Vec3([0.0, 0.0, 1.0]));
        assert_eq!(z.0, [1.0, 0.0, 0.0]);
        assert_eq!(rotation([0.0, 90.0, 0.0]).mul_vec(Vec3([0.0, 0.0, 1.0])).0, [1.0, 0.0, 0.0]);
    }

    #[test]
    fn degrees_agree_with_radians_off_the_right_angles() {
        for degrees in [-725.0, -90.5, 1e-3, 30.0, 359.0] {
            let (s, c) = sin_cos_degrees(degrees);
            let (s2, c2) = sin_cos(f64::to_radians(degrees));
            assert!((s - s2).abs() < 1e-13 && (c - c2).abs() < 1e-13, "{degrees}");
        }
    }

    #[test]
    fn quaternions_of_any_length_but_zero_have_a_direction() {
        assert_eq!(normalized([2e200, 0.0, 0.0, 0.0]), Some(Quat::identity()));
        assert_eq!(normalized([0.0; 4]), None);
    }
}
