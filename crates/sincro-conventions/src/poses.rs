//! The conventions of V-REP and CoppeliaSim for poses, converted at the boundary. Facts: rotations are right-handed;
//! Euler angles (α, β, γ) mean R = Rx(α)·Ry(β)·Rz(γ); quaternions are x, y, z, w; matrices are the upper 3×4 part row
//! by row; poses are position, then quaternion. Lengths `[m]`, angles `[rad]`.

use sincro_geometry::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_math::elementary::{asin, atan2, sin_cos};

/// |sin β| above which α and γ cannot be told apart; the others then have it so.
const GIMBAL: f64 = 0.999_995;

/// Euler angles α, β, γ `[rad]` of a rotation `R = Rx(α) Ry(β) Rz(γ)`, the convention of V-REP; β is within ±π/2. Where
/// cos β is almost zero, α and γ cannot be told apart: α is then 0.
///
/// ```
/// use sincro_conventions::poses::{euler_of, rotation_of_euler};
///
/// let angles = euler_of(&rotation_of_euler([0.1, -0.2, 0.3]));
/// assert!(angles.iter().zip([0.1, -0.2, 0.3]).all(|(got, want)| (got - want).abs() < 1e-15));
/// ```
#[must_use]
pub fn euler_of(rot: &Mat3<f64>) -> [f64; 3] {
    let m = &rot.0;
    let beta = asin(m[0][2].clamp(-1.0, 1.0)).0;
    if m[0][2].abs() < GIMBAL {
        [atan2(-m[1][2], m[2][2]).0, beta, atan2(-m[0][1], m[0][0]).0]
    } else {
        [0.0, beta, atan2(m[1][0], m[1][1]).0]
    }
}

/// Rotation matrix `R = Rx(α) Ry(β) Rz(γ)` (3 × 3) of the Euler angles α, β, γ `[rad]`, in this order.
#[must_use]
pub fn rotation_of_euler(angles: [f64; 3]) -> Mat3<f64> {
    let [(sa, ca), (sb, cb), (sc, cc)] = angles.map(sin_cos);
    Mat3::rotation::<0>(sa, ca).mul(&Mat3::rotation::<1>(sb, cb)).mul(&Mat3::rotation::<2>(sc, cc))
}

/// Unit quaternion (dimensionless) of a rotation, in the order x, y, z, w of the remote APIs.
#[must_use]
pub fn quaternion_of(rot: &Mat3<f64>) -> [f64; 4] {
    let q = Quat::from_matrix(rot);
    [q.xyz[0], q.xyz[1], q.xyz[2], q.w]
}

/// Rotation matrix (3 × 3) of a quaternion x, y, z, w, which need not have length one; none if a number is not finite
/// or the length is below 10⁻¹⁰.
#[must_use]
pub fn rotation_of_quaternion([x, y, z, w]: [f64; 4]) -> Option<Mat3<f64>> {
    let square = x * x + y * y + z * z + w * w;
    let usable = square.is_finite() && square > 1e-20;
    usable.then(|| Quat { w, xyz: Vec3([x, y, z]) }.normalized().matrix())
}

/// Upper 3 × 4 part `[R | p]` of the homogeneous matrix of a pose, row by row: entries 0–2, 4–6, 8–10 are the rotation,
/// entries 3, 7 and 11 the position `[m]`.
#[must_use]
pub fn matrix_of(pose: &Pose<f64>) -> [f64; 12] {
    let (r, p) = (&pose.rot.0, &pose.pos);
    [r[0][0], r[0][1], r[0][2], p[0], r[1][0], r[1][1], r[1][2], p[1], r[2][0], r[2][1], r[2][2], p[2]]
}

/// Pose of the twelve numbers of [`matrix_of`], positions in `[m]`; the rotation is taken as it is given.
#[must_use]
pub fn pose_of_matrix(m: &[f64; 12]) -> Pose<f64> {
    let rot = Mat3([[m[0], m[1], m[2]], [m[4], m[5], m[6]], [m[8], m[9], m[10]]]);
    Pose { rot, pos: Vec3([m[3], m[7], m[11]]) }
}

/// Seven numbers of a pose: position `[m]`, then the quaternion x, y, z, w.
#[must_use]
pub fn numbers_of_pose(pose: &Pose<f64>) -> [f64; 7] {
    let (p, q) = (&pose.pos, quaternion_of(&pose.rot));
    [p[0], p[1], p[2], q[0], q[1], q[2], q[3]]
}

/// Pose of seven numbers, position `[m]` and quaternion x, y, z, w; none if the quaternion has no direction.
#[must_use]
pub fn pose_of_numbers([x, y, z, qx, qy, qz, qw]: [f64; 7]) -> Option<Pose<f64>> {
    let rot = rotation_of_quaternion([qx, qy, qz, qw])?;
    Some(Pose { rot, pos: Vec3([x, y, z]) })
}

/// The shortest rotation that takes z to a direction: V-REP's joints turn about their own z.
#[must_use]
pub fn rotation_to(axis: [f64; 3]) -> Mat3<f64> {
    let a = Vec3(axis);
    let a = a.scale(1.0 / a.norm());
    if a[2] < -1.0 + 1e-12 {
        return Mat3([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]);
    }
    let v = Vec3([-a[1], a[0], 0.0]);
    let (skew, k) = (Mat3::skew(v), 1.0 / (1.0 + a[2]));
    let square = skew.mul(&skew);
    let square = Mat3(square.0.map(|row| row.map(|x| x * k)));
    Mat3::identity().plus(&skew).plus(&square)
}

/// Axis times angle `[rad]` of a rotation, the shorter way round.
#[must_use]
pub fn rotation_vector(rot: &Mat3<f64>) -> Vec3<f64> {
    let q = Quat::from_matrix(rot);
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    let sine = q.xyz.norm();
    if sine == 0.0 {
        return Vec3([0.0; 3]);
    }
    q.xyz.scale(sign * 2.0 * atan2(sine, q.w.abs()).0 / sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &Mat3<f64>, b: &Mat3<f64>) -> bool {
        (0..3).all(|i| (0..3).all(|j| (a.0[i][j] - b.0[i][j]).abs() < 1e-14))
    }

    #[test]
    fn angles_and_quaternions_give_their_rotation_back() {
        for k in 0..50 {
            let t = f64::from(k);
            let angles = [0.1 * t - 2.0, 0.03 * t - 0.7, 1.5 - 0.07 * t];
            let rot = rotation_of_euler(angles);
            for (got, want) in euler_of(&rot).iter().zip(angles) {
                assert!((got - want).abs() < 1e-14, "{angles:?}");
            }
            assert!(close(&rotation_of_quaternion(quaternion_of(&rot)).unwrap(), &rot));
            let pose = Pose { rot, pos: Vec3([1.0, 2.0, 3.0]) };
            assert_eq!(pose_of_matrix(&matrix_of(&pose)), pose);
            assert!(close(&pose_of_numbers(numbers_of_pose(&pose)).unwrap().rot, &rot));
        }
    }

    #[test]
    fn a_joints_z_is_its_axis() {
        let axes = [[0.0, 0.0, 1.0], [0.0, 0.0, -2.0], [0.0, -1.0, 0.0], [3.0, 0.0, 0.0], [1.0, -2.0, 0.5]];
        for axis in axes {
            let rot = rotation_to(axis);
            let unit = Vec3(axis).scale(1.0 / Vec3(axis).norm());
            assert!((rot.col(2) - unit).norm() < 1e-15, "{axis:?}");
            assert!(close(&rot.mul(&rot.transpose()), &Mat3::identity()), "{axis:?}");
        }
        assert_eq!(rotation_to([0.0, 0.0, 1.0]), Mat3::identity());
    }

    #[test]
    fn without_direction_there_is_no_rotation() {
        assert_eq!(rotation_of_quaternion([0.0; 4]), None);
        assert_eq!(rotation_of_quaternion([f64::NAN, 0.0, 0.0, 1.0]), None);
    }
}
