//! Orientations in the five forms of the format.

use sincro_dynamics::spatial::{Mat3, Quat, Vec3};
use sincro_math::elementary::sin_cos;
use sincro_scene::diagnostic::Diagnostic;

use super::defaults::Defaults;
use crate::robot::{Placement, Rotation};
use crate::source::Element;

/// Unit of angles and order of Euler angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angles {
    pub in_degrees: bool,
    /// Axis of each angle, and true if it is of the frame that turns.
    pub sequence: [(usize, bool); 3],
}

impl Default for Angles {
    fn default() -> Self {
        Self { in_degrees: true, sequence: [(0, true), (1, true), (2, true)] }
    }
}

impl Angles {
    /// An angle in radians.
    pub fn radians(&self, angle: f64) -> f64 {
        if self.in_degrees { angle.to_radians() } else { angle }
    }
}

/// Axes of a sequence such as `xyz` (of the turning frame) or `XYZ` (of the fixed one).
pub(super) fn sequence(text: &str) -> Option<[(usize, bool); 3]> {
    let axis = |c: char| "xyz".find(c.to_ascii_lowercase()).map(|k| (k, c.is_ascii_lowercase()));
    let axes: Option<Vec<_>> = text.chars().map(axis).collect();
    axes?.try_into().ok()
}

fn about(axis: usize, angle: f64) -> Mat3<f64> {
    let (s, c) = sin_cos(angle);
    match axis {
        0 => Mat3::rotation::<0>(s, c),
        1 => Mat3::rotation::<1>(s, c),
        _ => Mat3::rotation::<2>(s, c),
    }
}

/// Rotation with given first two axes, the second made orthogonal.
fn from_axes(x: Vec3<f64>, y: Vec3<f64>) -> Option<Mat3<f64>> {
    let x = unit(x)?;
    let y = unit(y - x.scale(x.dot(y)))?;
    Some(Mat3([x.0, y.0, x.cross(y).0]).transpose())
}

fn unit(v: Vec3<f64>) -> Option<Vec3<f64>> {
    let norm = v.norm();
    (norm > 1e-14 && norm.is_finite()).then(|| v.scale(1.0 / norm))
}

/// The shortest rotation from z to a direction.
pub(super) fn z_along(direction: Vec3<f64>) -> Option<Mat3<f64>> {
    let z = unit(direction)?;
    let axis = Vec3([0.0, 0.0, 1.0]).cross(z);
    let sine = axis.norm();
    if sine < 1e-14 {
        return Some(if z[2] > 0.0 { Mat3::identity() } else { about(0, std::f64::consts::PI) });
    }
    let angle = sincro_math::elementary::atan2(sine, z[2]).0;
    Some(Quat::exp(axis.scale(angle / sine)).matrix())
}

/// A rotation as a placement has it: a quaternion.
pub(super) fn rotation_of(matrix: &Mat3<f64>) -> Rotation {
    Placement::of_pose(&sincro_dynamics::spatial::Pose { rot: *matrix, pos: Vec3::zero() }).rotation
}

/// Attributes that give an orientation.
const KINDS: [&str; 5] = ["quat", "euler", "axisangle", "xyaxes", "zaxis"];

/// Orientation of an element; the identity if it gives none.
pub(super) fn rotation<'d>(
    element: Element<'d>,
    class: &str,
    defaults: &Defaults<'d>,
    angles: &Angles,
) -> Result<Rotation, Diagnostic> {
    // the nearest one counts, of whichever kind
    let Some(nearest) = defaults.nearest(element, class, &KINDS) else { return Ok(Rotation::RollPitchYaw([0.0; 3])) };
    if KINDS.iter().filter(|name| nearest.peek(name).is_some()).count() > 1 {
        return Err(nearest.error("it has more than one orientation").with_help("remove all but one of them"));
    }
    let numbers = |name: &str| nearest.numbers(name);
    let refuse = |name: &str| element.error(format!("`{name}` is no orientation"));
    if let Some(q) = numbers("quat")? {
        let q: [f64; 4] = q.try_into().map_err(|_| refuse("quat"))?;
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        return if norm > 1e-12 { Ok(Rotation::Quaternion(q)) } else { Err(refuse("quat")) };
    }
    if let Some(e) = numbers("euler")? {
        let e: [f64; 3] = e.try_into().map_err(|_| refuse("euler"))?;
        let mut matrix = Mat3::identity();
        for (angle, (axis, turns_along)) in e.into_iter().zip(angles.sequence) {
            let turn = about(axis, angles.radians(angle));
            matrix = if turns_along { matrix.mul(&turn) } else { turn.mul(&matrix) };
        }
        return Ok(rotation_of(&matrix));
    }
    if let Some(a) = numbers("axisangle")? {
        let [x, y, z, angle] = a[..] else { return Err(refuse("axisangle")) };
        let axis = unit(Vec3([x, y, z])).ok_or_else(|| refuse("axisangle"))?;
        return Ok(rotation_of(&Quat::exp(axis.scale(angles.radians(angle))).matrix()));
    }
    if let Some(a) = numbers("xyaxes")? {
        let [a, b, c, d, e, f] = a[..] else { return Err(refuse("xyaxes")) };
        return from_axes(Vec3([a, b, c]), Vec3([d, e, f])).map(|m| rotation_of(&m)).ok_or_else(|| refuse("xyaxes"));
    }
    if let Some(z) = numbers("zaxis")? {
        let z: [f64; 3] = z.try_into().map_err(|_| refuse("zaxis"))?;
        return z_along(Vec3(z)).map(|m| rotation_of(&m)).ok_or_else(|| refuse("zaxis"));
    }
    Ok(Rotation::RollPitchYaw([0.0; 3]))
}

/// Placement of an element: `pos` and orientation.
pub(super) fn placement<'d>(
    element: Element<'d>,
    class: &str,
    defaults: &Defaults<'d>,
    angles: &Angles,
) -> Result<Placement, Diagnostic> {
    let position = defaults.vector(element, class, "pos")?.unwrap_or_default();
    Ok(Placement { position, rotation: rotation(element, class, defaults, angles)? })
}
