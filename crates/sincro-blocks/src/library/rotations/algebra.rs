//! Quaternions (w, x, y, z), rotation matrices row by row, and Euler angles, over any [`Real`].
//!
//! All rotate vectors: the matrix R_wb, and the quaternion q_wb, take components in B to components in W.

use sincro_math::{Real, elementary};

use crate::choice;

/// w, x, y, z.
pub(super) type Quaternion<R> = [R; 4];
/// Row by row.
pub(super) type Matrix3<R> = [R; 9];
/// In the order in which the convention names them.
pub(super) type Angles<R> = [R; 3];

choice! {
    /// Meaning of three Euler angles `[rad]`.
    #[derive(Default)]
    pub enum Convention {
        /// Roll, pitch, yaw: R = Rz(yaw)·Ry(pitch)·Rx(roll), as of aircraft and vehicles.
        #[default]
        Zyx = "zyx",
        /// α, β, γ: R = Rx(α)·Ry(β)·Rz(γ), as in V-REP and CoppeliaSim.
        Xyz = "xyz",
    }
}

/// Below this cosine of the middle angle the outer two turn about one axis: the leftmost in the product (yaw; α) is
/// then taken as zero.
const LOCKED: f64 = 1e-12;

/// p ⊗ q: first q, then p.
#[inline(always)]
pub(super) fn product<R: Real>(p: Quaternion<R>, q: Quaternion<R>) -> Quaternion<R> {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// The rotation back.
#[inline(always)]
pub(super) fn conjugate<R: Real>(q: Quaternion<R>) -> Quaternion<R> {
    [q[0], -q[1], -q[2], -q[3]]
}

/// The rotation matrix of `q/|q|`.
#[inline(always)]
pub(super) fn quaternion_to_matrix<R: Real>(q: Quaternion<R>) -> Matrix3<R> {
    let [w, x, y, z] = q;
    let s = R::splat(2.0) / (w * w + x * x + y * y + z * z);
    let one = R::one();
    [
        one - s * (y * y + z * z),
        s * (x * y - w * z),
        s * (x * z + w * y),
        s * (x * y + w * z),
        one - s * (x * x + z * z),
        s * (y * z - w * x),
        s * (x * z - w * y),
        s * (y * z + w * x),
        one - s * (x * x + y * y),
    ]
}

/// The quaternion with w ≥ 0; the component of largest size is found first, so that nothing small is divided by
/// (Shepperd's method).
#[inline(always)]
pub(super) fn matrix_to_quaternion<R: Real>(m: Matrix3<R>) -> Quaternion<R> {
    let one = R::one();
    // 4w², 4x², 4y², 4z²
    let squares =
        [one + m[0] + m[4] + m[8], one + m[0] - m[4] - m[8], one - m[0] + m[4] - m[8], one - m[0] - m[4] + m[8]];
    let largest = (1..4).fold(0, |best, k| if squares[k].lane(0) > squares[best].lane(0) { k } else { best });
    let size = squares[largest].sqrt();
    let (own, f) = (R::splat(0.5) * size, R::splat(0.5) / size);
    let (wx, wy, wz) = (f * (m[7] - m[5]), f * (m[2] - m[6]), f * (m[3] - m[1]));
    let (xy, xz, yz) = (f * (m[3] + m[1]), f * (m[2] + m[6]), f * (m[7] + m[5]));
    let q = match largest {
        0 => [own, wx, wy, wz],
        1 => [wx, own, xy, xz],
        2 => [wy, xy, own, yz],
        _ => [wz, xz, yz, own],
    };
    let zero = R::zero();
    q.map(|x| q[0].if_less(zero, -x, x))
}

/// Rate of a quaternion from the angular velocity `[rad/s]`, in the axes of the body or of the world.
#[inline(always)]
pub(super) fn quaternion_rate<R: Real>(q: Quaternion<R>, w: [R; 3], is_world: bool) -> Quaternion<R> {
    let half = R::splat(0.5);
    let w = [R::zero(), half * w[0], half * w[1], half * w[2]];
    if is_world { product(w, q) } else { product(q, w) }
}

/// The quaternion of Euler angles.
#[inline(always)]
pub(super) fn euler_to_quaternion<R: Real>(angles: Angles<R>, convention: Convention) -> Quaternion<R> {
    let (zero, half) = (R::zero(), R::splat(0.5));
    let [(sx, cx), (sy, cy), (sz, cz)] = angles.map(|angle| (half * angle).sin_cos());
    let (x, y, z) = ([cx, sx, zero, zero], [cy, zero, sy, zero], [cz, zero, zero, sz]);
    match convention {
        Convention::Zyx => product(z, product(y, x)),
        Convention::Xyz => product(x, product(y, z)),
    }
}

/// The rotation matrix of Euler angles.
#[inline(always)]
pub(super) fn euler_to_matrix<R: Real>(angles: Angles<R>, convention: Convention) -> Matrix3<R> {
    let [(sx, cx), (sy, cy), (sz, cz)] = sines_and_cosines(angles);
    match convention {
        Convention::Zyx => [
            cz * cy,
            cz * sy * sx - sz * cx,
            cz * sy * cx + sz * sx,
            sz * cy,
            sz * sy * sx + cz * cx,
            sz * sy * cx - cz * sx,
            -sy,
            cy * sx,
            cy * cx,
        ],
        Convention::Xyz => [
            cy * cz,
            -cy * sz,
            sy,
            sx * sy * cz + cx * sz,
            cx * cz - sx * sy * sz,
            -sx * cy,
            sx * sz - cx * sy * cz,
            cx * sy * sz + sx * cz,
            cx * cy,
        ],
    }
}

/// Euler angles of a rotation matrix: the middle one in [−π/2, π/2], the others in [−π, π].
///
/// The leftmost rotation is found first and taken away, the rightmost read from what is left: so both fit together
/// however near the middle angle is to ±π/2.
#[inline(always)]
pub(super) fn matrix_to_euler<R: Real>(m: Matrix3<R>, convention: Convention) -> Angles<R> {
    let angle = |y: R, x: R| y.binary(elementary::Binary::Atan2, x);
    let leftmost = |y: R, x: R, cos: R| if cos.lane(0) < LOCKED { R::zero() } else { angle(y, x) };
    match convention {
        Convention::Zyx => {
            let cos = m[0].binary(elementary::Binary::Hypot, m[3]);
            let yaw = leftmost(m[3], m[0], cos);
            let (s, c) = yaw.sin_cos();
            [angle(s * m[2] - c * m[5], c * m[4] - s * m[1]), angle(-m[6], cos), yaw]
        }
        Convention::Xyz => {
            let cos = m[5].binary(elementary::Binary::Hypot, m[8]);
            let first = leftmost(-m[5], m[8], cos);
            let (s, c) = first.sin_cos();
            [first, angle(m[2], cos), angle(c * m[3] + s * m[6], c * m[4] + s * m[7])]
        }
    }
}

/// R·v, or Rᵀ·v.
#[inline(always)]
pub(super) fn rotate<R: Real>(m: Matrix3<R>, v: [R; 3], inverse: bool) -> [R; 3] {
    let entry = |i: usize, k: usize| if inverse { m[3 * k + i] } else { m[3 * i + k] };
    core::array::from_fn(|i| entry(i, 0) * v[0] + entry(i, 1) * v[1] + entry(i, 2) * v[2])
}

#[inline(always)]
fn sines_and_cosines<R: Real>(angles: Angles<R>) -> [(R, R); 3] {
    // no closure: it would not be compiled for lanes
    [angles[0].sin_cos(), angles[1].sin_cos(), angles[2].sin_cos()]
}

/// Rates of the Euler angles of a body that turns with the angular velocity `w` in its own axes; not finite where the
/// middle angle is ±π/2.
#[inline(always)]
pub(super) fn euler_rates<R: Real>(angles: Angles<R>, w: [R; 3], convention: Convention) -> Angles<R> {
    let [(sx, cx), (sy, cy), (sz, cz)] = sines_and_cosines(angles);
    match convention {
        Convention::Zyx => {
            let yaw = (w[1] * sx + w[2] * cx) / cy;
            [w[0] + yaw * sy, w[1] * cx - w[2] * sx, yaw]
        }
        Convention::Xyz => {
            let first = (w[0] * cz - w[1] * sz) / cy;
            [first, w[0] * sz + w[1] * cz, w[2] - first * sy]
        }
    }
}

/// E(angles)·rates: the angular velocity in the axes of the body.
#[inline(always)]
pub(super) fn angular_velocity<R: Real>(angles: Angles<R>, rates: [R; 3], convention: Convention) -> [R; 3] {
    let [(sx, cx), (sy, cy), (sz, cz)] = sines_and_cosines(angles);
    match convention {
        Convention::Zyx => {
            let yaw = cy * rates[2];
            [rates[0] - sy * rates[2], cx * rates[1] + sx * yaw, cx * yaw - sx * rates[1]]
        }
        Convention::Xyz => {
            let first = cy * rates[0];
            [cz * first + sz * rates[1], cz * rates[1] - sz * first, rates[2] + sy * rates[0]]
        }
    }
}

/// E⁻ᵀ(angles)·w: the torque about the axes of the body with the power of torques `w` about the angles' axes; not
/// finite where the middle angle is ±π/2.
#[inline(always)]
pub(super) fn body_torque<R: Real>(angles: Angles<R>, w: [R; 3], convention: Convention) -> [R; 3] {
    let [(sx, cx), (sy, cy), (sz, cz)] = sines_and_cosines(angles);
    match convention {
        Convention::Zyx => {
            let yaw = (w[2] + sy * w[0]) / cy;
            [w[0], cx * w[1] + sx * yaw, cx * yaw - sx * w[1]]
        }
        Convention::Xyz => {
            let first = (w[0] - sy * w[2]) / cy;
            [cz * first + sz * w[1], cz * w[1] - sz * first, w[2]]
        }
    }
}

/// Eᵀ(angles)·torque: the inverse of [`body_torque`].
#[inline(always)]
pub(super) fn euler_torque<R: Real>(angles: Angles<R>, torque: [R; 3], convention: Convention) -> [R; 3] {
    let [(sx, cx), (sy, cy), (sz, cz)] = sines_and_cosines(angles);
    match convention {
        Convention::Zyx => {
            let yaw = sx * torque[1] + cx * torque[2];
            [torque[0], cx * torque[1] - sx * torque[2], cy * yaw - sy * torque[0]]
        }
        Convention::Xyz => {
            let first = cz * torque[0] - sz * torque[1];
            [cy * first + sy * torque[2], sz * torque[0] + cz * torque[1], torque[2]]
        }
    }
}
