//! Cylinders, cones and tori over a plane, or over a face of a cuboid as over its plane.
//!
//! A rim touches a plane with its lowest point, which moves around it as the body rolls or tilts: the candidate of a
//! rim knows the whole circle, so that its rates are those of the rolling body. The general algorithm gives one point
//! of the surface, to about 1e-8 m, as if it were a corner of the body.

use sincro_geometry::Shape;
use sincro_geometry::spatial::{Pose, Vec3};

use super::candidate::{ContactCandidate, Edge, Feature};
use super::{Collider, Surface};

/// Sine of the tilt below which a disc is held to stand on four points of its rim.
const STANDS: f64 = 1e-6;

/// Height over its lowest point, or over a face that it has sunk into, up to which all of a surface must lie over that
/// face `[m]`.
const NEAR: f64 = 1e-3;

/// Tolerance of points outside of an outline `[m]`.
const ON_OUTLINE: f64 = 1e-6;

/// Number of slots of the points around one rim: the lowest one, and those a quarter of a turn from it and opposite.
const AROUND: usize = 4;

/// Number of slots of such a surface over a plane; a torus has one rim.
pub(crate) fn slots(surface: &Surface) -> Option<usize> {
    Discs::of(surface).map(|discs| AROUND * discs.n + usize::from(discs.apex.is_some()))
}

/// Rims of a surface in its frame: circles about its z axis.
struct Discs {
    /// Radius of each `[m]`.
    radius: f64,
    /// Rounding about the circle `[m]`: of a torus, whose circle is in the middle of its tube.
    rounding: f64,
    /// Heights of the circles, `n` of them `[m]`.
    heights: [f64; 2],
    n: usize,
    /// Height of the apex `[m]`.
    apex: Option<f64>,
}

impl Discs {
    fn of(surface: &Surface) -> Option<Self> {
        Some(match *surface {
            Surface::Solid(Shape::Cylinder { radius, length }) => {
                Self { radius, rounding: 0.0, heights: [-0.5 * length, 0.5 * length], n: 2, apex: None }
            }
            Surface::Solid(Shape::Torus { major_radius, tube_radius }) => {
                Self { radius: major_radius, rounding: tube_radius, heights: [0.0; 2], n: 1, apex: None }
            }
            Surface::Solid(Shape::Cone { radius, length }) => {
                Self { radius, rounding: 0.0, heights: [-0.25 * length; 2], n: 1, apex: Some(0.75 * length) }
            }
            _ => return None,
        })
    }

    /// Ends along the axis: height, and share of the radius there.
    fn ends(&self) -> [(f64, f64); 2] {
        let first = (self.heights[0], 1.0);
        match self.apex {
            Some(z) => [first, (z, 0.0)],
            None => [first, (self.heights[1], 1.0)],
        }
    }

    fn heights(&self) -> &[f64] {
        &self.heights[..self.n]
    }

    /// Lowest height of the surface over the origin of its frame `[m]`; `along` is that of its axis, a unit vector.
    fn lowest(&self, along: f64) -> f64 {
        let rim = self.radius * (1.0 - along * along).max(0.0).sqrt() + self.rounding;
        let of_rims = self.heights().iter().map(|z| along * z - rim);
        of_rims.chain(self.apex.map(|z| along * z)).fold(f64::INFINITY, f64::min)
    }
}

/// Plane that a surface may touch.
struct Plane {
    /// In link axes of b.
    feature: Feature,
    /// Unit normal in the world.
    normal: Vec3<f64>,
}

/// Candidates of a surface with rims over the plane b: the lowest point of each rim, with the three points a quarter of
/// a turn from it and opposite that the rim may come to rest on within a step (`is_step`), and the apex.
pub(crate) fn over_half_space(
    (a, b): (&Collider, &Collider),
    (at_a, at_b): (&Pose<f64>, &Pose<f64>),
    is_step: bool,
    slots: &mut [Option<ContactCandidate>],
) {
    let feature = Feature::Plane { origin: b.pose.pos, normal: b.pose.rot.col(2) };
    over_plane((a, b), at_a, &Plane { feature, normal: at_b.rot.col(2) }, is_step, slots);
}

/// Candidates over the face of the cuboid b with the largest separation from the surface; returns false, without
/// candidates, where the surface reaches beyond the outline of that face near its plane. `margin`: distance within
/// which contacts are looked for `[m]`.
pub(crate) fn over_cuboid(
    (a, b): (&Collider, &Collider),
    (at_a, at_b): (&Pose<f64>, &Pose<f64>),
    (margin, is_step): (f64, bool),
    slots: &mut [Option<ContactCandidate>],
) -> bool {
    let (Some(discs), Surface::Solid(Shape::Cuboid { size })) = (Discs::of(&a.surface), &b.surface) else {
        return false;
    };
    let half = size.map(|s| 0.5 * s);
    let center = at_b.rot.tr_mul_vec(at_a.pos - at_b.pos);
    let axis = at_b.rot.tr_mul_vec(at_a.rot.col(2));
    let sides = (0..3).flat_map(|k| [(k, -1.0), (k, 1.0)]);
    let gap = |(k, sign): (usize, f64)| sign * center[k] - half[k] + discs.lowest(sign * axis[k]);
    let (mut face, mut separation) = ((0, 1.0), f64::NEG_INFINITY);
    for side in sides {
        let gap = gap(side);
        if gap > separation {
            (face, separation) = (side, gap);
        }
    }
    let (k, sign) = face;
    if separation > margin {
        return true;
    }
    let across = |j: usize| (1.0 - axis[j] * axis[j]).max(0.0).sqrt();
    // a section of the surface across its axis: its height there and its share of the radius
    let extent = |j: usize, share: f64| share * discs.radius * across(j) + discs.rounding;
    let at = |j: usize, z: f64| center[j] + axis[j] * z;
    let height = |(z, share): (f64, f64)| sign * at(k, z) - extent(k, share) - half[k];
    let is_within =
        |(z, share): (f64, f64)| (0..3).all(|j| j == k || at(j, z).abs() + extent(j, share) <= half[j] + ON_OUTLINE);
    // whatever distance contacts are looked for within: the same ones are found
    let (ends, reach) = (discs.ends(), NEAR + separation.max(0.0));
    for (k, end) in ends.iter().enumerate() {
        let (other, low) = (ends[(k + 1) % ends.len()], height(*end));
        if low > reach {
            continue;
        }
        // up to where the surface has risen above what is near, or to its other end
        let rise = height(other) - low;
        let share = if rise > reach - low { (reach - low) / rise } else { 1.0 };
        let last = (end.0 + share * (other.0 - end.0), end.1 + share * (other.1 - end.1));
        if !is_within(*end) || !is_within(last) {
            return false;
        }
    }
    let normal = Vec3::along(k, sign);
    let feature = Feature::Plane { origin: b.pose.point(normal.scale(half[k])), normal: b.pose.rot.mul_vec(normal) };
    over_plane((a, b), at_a, &Plane { feature, normal: at_b.rot.mul_vec(normal) }, is_step, slots);
    // high above, beside the face
    for (slots, _) in slots.chunks_mut(AROUND).zip(discs.heights()).filter(|(_, z)| !is_within((**z, 1.0))) {
        slots.fill(None);
    }
    if let (Some(z), Some(slot)) = (discs.apex, slots.get_mut(AROUND * discs.n))
        && !is_within((z, 0.0))
    {
        *slot = None;
    }
    true
}

fn over_plane(
    (a, b): (&Collider, &Collider),
    at_a: &Pose<f64>,
    plane: &Plane,
    is_step: bool,
    slots: &mut [Option<ContactCandidate>],
) {
    let Some(discs) = Discs::of(&a.surface) else { return };
    let candidate = |point: Vec3<f64>, edge: Option<Edge>| ContactCandidate {
        a: a.link,
        b: b.link,
        point: a.pose.point(point),
        radius: discs.rounding,
        radius_a: discs.rounding,
        edge,
        feature: plane.feature,
        id: 0,
    };
    let (n, axis) = (plane.normal, at_a.rot.col(2));
    let across = n - axis.scale(n.dot(axis));
    let stands = across.norm() < STANDS;
    let [x, y, _] = if stands { [1.0, 0.0, 0.0] } else { at_a.rot.tr_mul_vec(across.scale(-1.0 / across.norm())).0 };
    let around = [[x, y], [-y, x], [-x, -y], [y, -x]];
    for (slots, z) in slots.chunks_mut(AROUND).zip(discs.heights()) {
        for (slot, [x, y]) in slots.iter_mut().zip(around).filter(|_| stands || is_step) {
            *slot = Some(candidate(Vec3([discs.radius * x, discs.radius * y, *z]), None));
        }
        if !stands {
            let rim = Edge::Rim { axis: a.pose.rot.col(2), radius: discs.radius };
            slots[0] = Some(candidate(Vec3([0.0, 0.0, *z]), Some(rim)));
        }
    }
    if let (Some(z), Some(slot)) = (discs.apex, slots.get_mut(AROUND * discs.n)) {
        *slot = Some(candidate(Vec3([0.0, 0.0, z]), None));
    }
}
