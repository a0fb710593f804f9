//! Vectors and poses (position, then quaternion x, y, z, w) of pictures and arrows.

pub(crate) type V = [f64; 3];

pub(crate) fn origin(pose: &[f64; 7]) -> V {
    [pose[0], pose[1], pose[2]]
}

/// A point of a frame in the world: p + R(q)·x.
pub(crate) fn point(pose: &[f64; 7], x: V) -> V {
    add(origin(pose), rotate(pose, x))
}

pub(crate) fn rotate(pose: &[f64; 7], x: V) -> V {
    let (u, w) = ([pose[3], pose[4], pose[5]], pose[6]);
    let t = cross(u, x).map(|c| 2.0 * c);
    add(add(x, t.map(|c| w * c)), cross(u, t))
}

/// Pose of C in A from those of B in A and of C in B.
pub(crate) fn compose(ab: &[f64; 7], bc: &[f64; 7]) -> [f64; 7] {
    let p = point(ab, origin(bc));
    let (a, b) = (&ab[3..], &bc[3..]);
    let (u, v) = ([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
    let q = add(add(v.map(|c| a[3] * c), u.map(|c| b[3] * c)), cross(u, v));
    [p[0], p[1], p[2], q[0], q[1], q[2], a[3] * b[3] - dot(u, v)]
}

pub(crate) fn add(a: V, b: V) -> V {
    std::array::from_fn(|k| a[k] + b[k])
}

pub(crate) fn sub(a: V, b: V) -> V {
    std::array::from_fn(|k| a[k] - b[k])
}

pub(crate) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn scale(a: V, by: f64) -> V {
    a.map(|x| by * x)
}

pub(crate) fn unit(a: V) -> V {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_cancel() {
        let half = 0.5_f64.sqrt();
        // a quarter turn about z, then 1 m along the new x, which is the old y
        let turned = compose(&[0.0, 0.0, 0.0, 0.0, 0.0, half, half], &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        let p = point(&turned, [0.0, 2.0, 0.0]);
        assert!((p[0] + 2.0).abs() < 1e-12 && (p[1] - 1.0).abs() < 1e-12, "{p:?}");
    }
}
