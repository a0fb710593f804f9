//! Fields of view of proximity sensors, in the frame of the sensor: z is the axis of view. The part of a volume within
//! some radius about the origin is convex and has a support mapping, which is all that [`FieldOfView::detect`] needs.
//!
//! All volumes but the pyramid are described by their section with the plane of z and one direction across, u: lines
//! and a circle about the origin.

use sincro_math::elementary::sin_cos;

use super::gjk::Convex;
use crate::spatial::Vec3;

/// Tolerance of points on the boundary of a volume, relative to its size.
const ON: f64 = 1e-12;

/// Shape of a proximity sensor's field of view, along z of the sensor's frame from a near to a far end; those are the
/// `offset` and `range` of [`FieldOfView::new`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Volume {
    /// Line along z.
    Ray,
    /// Round section, with a radius that changes linearly from the near to the far end; the ends are flat. At least one
    /// radius is positive.
    Cylinder {
        /// Radius at the near end `[m]`.
        radius: f64,
        /// Radius at the far end `[m]`.
        far_radius: f64,
    },
    /// Fan of rays in the plane of x and z, on both sides of z; its ends are at constant z (near) and constant distance
    /// (far).
    Disc {
        /// Angle between the outermost rays `[rad]`, in (0, π].
        angle: f64,
    },
    /// All directions within half the angle of z; its near end is flat, its far end part of a sphere.
    Cone {
        /// Full opening angle `[rad]`, in (0, π].
        angle: f64,
    },
    /// Rectangular section, with widths that change linearly from the near to the far end; the ends are flat.
    Pyramid {
        /// Widths along x and y at the near end `[m]`.
        size: [f64; 2],
        /// Widths along x and y at the far end `[m]`.
        far_size: [f64; 2],
    },
}

/// Field of view of a proximity sensor: a [`Volume`] with its near and far end, in the frame of the sensor (z is the
/// axis of view). Made by [`FieldOfView::new`], used by [`FieldOfView::detect`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOfView {
    pub(super) volume: Volume,
    /// z of its near end `[m]`.
    pub(super) offset: f64,
    /// Its far end `[m]`: z of flat ones, radius of round ones.
    pub(super) end: f64,
    /// Distance of its farthest point from the origin `[m]`.
    pub(super) reach: f64,
    bounds: Bounds,
}

/// Lines or planes that bound a volume: n·p ≤ b, n of length one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Bounds {
    /// In the plane of u and z.
    Section([([f64; 2], f64); 4]),
    Planes([(Vec3<f64>, f64); 6]),
}

/// Part of a field of view within a radius about the origin.
pub(super) struct Within<'a> {
    pub field: &'a FieldOfView,
    pub radius: f64,
}

impl FieldOfView {
    /// Creates a field of view from z = `offset` to `offset` + `range` in front of the sensor `[m]`.
    ///
    /// `None` unless all numbers are finite, lengths not negative, the range positive, angles within (0, π], and the
    /// section is not a point or line at both ends (but for [`Volume::Ray`]).
    #[must_use]
    pub fn new(volume: Volume, offset: f64, range: f64) -> Option<Self> {
        let end = offset + range;
        let is_length = |x: f64| x.is_finite() && x >= 0.0;
        let is_angle = |x: f64| x > 0.0 && x <= core::f64::consts::PI;
        let fits = is_length(offset) && range > 0.0 && end.is_finite();
        let far = |x: f64, y: f64| (x * x + y * y + end * end).sqrt();
        let lines = |(near, far): (f64, f64)| {
            let side = |sign: f64| line([sign * range, -(far - near)], range * near - (far - near) * offset);
            [([0.0, -1.0], -offset), ([0.0, 1.0], end), side(1.0), side(-1.0)]
        };
        let fan = |angle: f64| {
            let (sin, cos) = sin_cos(0.5 * angle);
            // the far end is round: no line bounds it
            [([0.0, -1.0], -offset), ([0.0, 1.0], 2.0 * end), ([cos, -sin], 0.0), ([-cos, -sin], 0.0)]
        };
        let (valid, bounds, reach) = match volume {
            Volume::Ray => (true, Bounds::Section(lines((0.0, 0.0))), end),
            Volume::Cylinder { radius, far_radius } => {
                let valid = is_length(radius) && is_length(far_radius) && radius + far_radius > 0.0;
                let reach = far(far_radius, 0.0).max((radius * radius + offset * offset).sqrt());
                (valid, Bounds::Section(lines((radius, far_radius))), reach)
            }
            Volume::Disc { angle } | Volume::Cone { angle } => (is_angle(angle), Bounds::Section(fan(angle)), end),
            Volume::Pyramid { size, far_size } => {
                let all = [size[0], size[1], far_size[0], far_size[1]];
                let valid =
                    all.into_iter().all(is_length) && size[0] + far_size[0] > 0.0 && size[1] + far_size[1] > 0.0;
                let of = |k: usize| {
                    let [_, _, one, two] = lines((0.5 * size[k], 0.5 * far_size[k]));
                    [one, two].map(|([u, z], b)| {
                        let mut normal = Vec3([0.0, 0.0, z]);
                        normal[k] = u;
                        (normal, b)
                    })
                };
                let ([a, b], [c, d]) = (of(0), of(1));
                let ends = [(Vec3([0.0, 0.0, -1.0]), -offset), (Vec3([0.0, 0.0, 1.0]), end)];
                let reach = far(0.5 * far_size[0], 0.5 * far_size[1]);
                let near = 0.25 * (size[0] * size[0] + size[1] * size[1]) + offset * offset;
                (valid, Bounds::Planes([ends[0], ends[1], a, b, c, d]), reach.max(near.sqrt()))
            }
        };
        (fits && valid).then_some(Self { volume, offset, end, reach, bounds })
    }

    /// Shape of the field of view.
    #[must_use]
    pub fn volume(&self) -> Volume {
        self.volume
    }

    /// Distance of the near end from the sensor's origin, along z `[m]`.
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Length from the near to the far end, along z `[m]`.
    #[must_use]
    pub fn range(&self) -> f64 {
        self.end - self.offset
    }

    /// Distance of the farthest point of the field of view from the sensor's origin `[m]`: nothing beyond it is
    /// detected.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Returns true if the point `p` `[m]`, in the frame of the sensor, is in the field of view or on its border.
    #[must_use]
    pub fn contains(&self, p: Vec3<f64>) -> bool {
        let slack = ON * self.reach;
        if p.norm() > self.reach + slack {
            return false;
        }
        let u = match self.volume {
            Volume::Disc { .. } if p[1].abs() > slack => return false,
            Volume::Disc { .. } => p[0],
            _ => (p[0] * p[0] + p[1] * p[1]).sqrt(),
        };
        match &self.bounds {
            Bounds::Section(lines) => lines.iter().all(|([n, m], b)| n * u + m * p[2] <= b + slack),
            Bounds::Planes(planes) => planes.iter().all(|(n, b)| n.dot(p) <= b + slack),
        }
    }
}

/// n·p ≤ b with n brought to length one.
fn line([u, z]: [f64; 2], b: f64) -> ([f64; 2], f64) {
    let length = (u * u + z * z).sqrt();
    ([u / length, z / length], b / length)
}

impl Convex for Within<'_> {
    fn support(&self, d: Vec3<f64>) -> Vec3<f64> {
        let is_flat = matches!(self.field.volume, Volume::Disc { .. });
        match &self.field.bounds {
            Bounds::Section(lines) if is_flat => {
                let [u, z] = in_section(lines, self.radius, [d[0], d[2]]);
                Vec3([u, 0.0, z])
            }
            Bounds::Section(lines) => {
                let across = (d[0] * d[0] + d[1] * d[1]).sqrt();
                let [u, z] = in_section(lines, self.radius, [across, d[2]]);
                let k = if across > 0.0 { u / across } else { 0.0 };
                if across > 0.0 { Vec3([k * d[0], k * d[1], z]) } else { Vec3([u, 0.0, z]) }
            }
            Bounds::Planes(planes) => in_planes(planes, self.radius, d),
        }
    }

    fn interior_point(&self) -> Vec3<f64> {
        Vec3([0.0, 0.0, self.radius])
    }
}

/// Both points of a line n·p = b at the distance `radius` from the origin, its direction being `t`; a line that just
/// misses counts as touching.
fn on_circle([n, m]: [f64; 2], b: f64, radius: f64) -> Option<[[f64; 2]; 2]> {
    let square = radius * radius - b * b;
    if square < -ON * radius * radius {
        return None;
    }
    let half = square.max(0.0).sqrt();
    Some([1.0, -1.0].map(|sign| [b * n - sign * half * m, b * m + sign * half * n]))
}

/// Support mapping of the intersection of half planes and a circle.
fn in_section(lines: &[([f64; 2], f64); 4], radius: f64, d: [f64; 2]) -> [f64; 2] {
    let mut best = ([0.0; 2], f64::NEG_INFINITY);
    let mut look = |p: [f64; 2], skip: [usize; 2]| {
        let along = p[0] * d[0] + p[1] * d[1];
        let inside =
            |(k, ([n, m], b)): (usize, &([f64; 2], f64))| skip.contains(&k) || n * p[0] + m * p[1] <= b + ON * radius;
        if along > best.1 && lines.iter().enumerate().all(inside) {
            best = (p, along);
        }
    };
    let length = (d[0] * d[0] + d[1] * d[1]).sqrt();
    if length > 0.0 {
        look([radius * d[0] / length, radius * d[1] / length], [usize::MAX; 2]);
    }
    for (i, (n, b)) in lines.iter().enumerate() {
        for p in on_circle(*n, *b, radius).into_iter().flatten() {
            look(p, [i; 2]);
        }
        for (j, (m, c)) in lines.iter().enumerate().skip(i + 1) {
            let det = n[0] * m[1] - n[1] * m[0];
            let p = [(b * m[1] - c * n[1]) / det, (c * n[0] - b * m[0]) / det];
            if det.abs() > ON && p[0] * p[0] + p[1] * p[1] <= radius * radius * (1.0 + ON) {
                look(p, [i, j]);
            }
        }
    }
    best.0
}

/// Support mapping of the intersection of half spaces and a sphere.
fn in_planes(planes: &[(Vec3<f64>, f64); 6], radius: f64, d: Vec3<f64>) -> Vec3<f64> {
    let mut best = (Vec3::zero(), f64::NEG_INFINITY);
    let mut look = |p: Vec3<f64>, skip: [usize; 3]| {
        let along = d.dot(p);
        let inside = |(k, (n, b)): (usize, &(Vec3<f64>, f64))| skip.contains(&k) || n.dot(p) <= b + ON * radius;
        if along > best.1 && planes.iter().enumerate().all(inside) {
            best = (p, along);
        }
    };
    let length = d.norm();
    if length > 0.0 {
        look(d.scale(radius / length), [usize::MAX; 3]);
    }
    for (i, (n, b)) in planes.iter().enumerate() {
        let across = d - n.scale(n.dot(d));
        let (left, width) = (radius * radius - b * b, across.norm());
        // where `d` is at right angles to the face, its edges will do
        if left > -ON * radius * radius && width > ON * length {
            look(n.scale(*b) + across.scale(left.max(0.0).sqrt() / width), [i; 3]);
        }
        for (j, (m, c)) in planes.iter().enumerate().skip(i + 1) {
            let along = n.cross(*m);
            let square = along.dot(along);
            if square <= ON {
                continue;
            }
            // the point of both planes that is closest to the origin
            let foot = (m.cross(along).scale(*b) + along.cross(*n).scale(*c)).scale(1.0 / square);
            let left = radius * radius - foot.dot(foot);
            if left > -ON * radius * radius {
                let half = (left.max(0.0) / square).sqrt();
                look(foot + along.scale(half), [i, j, j]);
                look(foot - along.scale(half), [i, j, j]);
            }
            for (k, (o, e)) in planes.iter().enumerate().skip(j + 1) {
                let det = along.dot(*o);
                if det.abs() <= ON {
                    continue;
                }
                let p = foot + along.scale((e - o.dot(foot)) / det);
                if p.dot(p) <= radius * radius * (1.0 + ON) {
                    look(p, [i, j, k]);
                }
            }
        }
    }
    best.0
}
