//! What a proximity sensor sees of a surface: the point inside its volume that is closest to its origin.
//!
//! If the closest point of a convex surface is inside the volume, it is that. If not, it lies on the boundary of the volume: then what of the volume is
//! within a radius r just touches the surface. Their distance f(r) is convex and falls to zero where it is wanted, so that secants from below never pass
//! it where the volume grows evenly; where they do, halving takes over. It ends at 1e-13 of the size. Meshes and height fields are their triangles, each of
//! which is convex. Rays have their own closed forms. What the origin, or the middle of the near end, is inside of is not seen.

use super::distance::closest_points;
use super::field_of_view::{FieldOfView, Volume, Within};
use super::gjk::{Convex, gjk};
use super::support::{Core, POINT, Placed, Solid, normal_at};
use super::{Geometry, Ray};
use crate::spatial::{Pose, Vec3};

/// Distance of volume and surface at which the search ends, by the size of the volume.
const TOUCHES: f64 = 1e-13;
/// Secants and halvings at most.
const MAX_ITERATIONS: usize = 120;

/// What a sensor sees, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// From the sensor's origin `[m]`.
    pub distance: f64,
    /// The point seen `[m]`.
    pub point: Vec3<f64>,
    /// Out of the surface there, length one.
    pub normal: Vec3<f64>,
}

impl FieldOfView {
    /// The point of a surface in the volume that is closest to the origin, within `max_distance` `[m]`; the surface's frame stands at `x_sg` in the sensor's.
    #[must_use]
    pub fn detect(&self, geometry: &Geometry, x_sg: &Pose<f64>, max_distance: f64) -> Option<Detection> {
        let max_distance = max_distance.min(self.reach);
        if x_sg.pos.norm() - geometry.reach() > max_distance {
            return None;
        }
        if self.volume == Volume::Ray {
            return self.detect_along_ray(geometry, x_sg).filter(|seen| seen.distance <= max_distance);
        }
        let point = match geometry.solid() {
            Solid::Convex(core, radius) => self.closest_in_convex(&Placed { core, radius, pose: *x_sg }, true),
            Solid::HalfSpace => self.closest_in_half_space(x_sg),
            Solid::Triangles(bvh) => {
                let mut best: Option<Vec3<f64>> = None;
                let origin = x_sg.inverse().pos;
                bvh.visit(origin, 0.0, max_distance, &mut |triangle, max_distance| {
                    let placed = Placed { core: Core::Triangle(*triangle), radius: 0.0, pose: *x_sg };
                    let point = self.closest_in_convex(&placed, false)?;
                    let distance = point.norm();
                    if distance > max_distance || best.is_some_and(|best| distance >= best.norm()) {
                        return None;
                    }
                    best = Some(point);
                    Some(distance)
                });
                best
            }
        }?;
        let (distance, local) = (point.norm(), x_sg.inverse().point(point));
        let normal = x_sg.rot.mul_vec(normal_at(geometry, local, x_sg.inverse().pos - local));
        (distance <= max_distance).then_some(Detection { distance, point, normal })
    }

    fn detect_along_ray(&self, geometry: &Geometry, x_sg: &Pose<f64>) -> Option<Detection> {
        let x_gs = x_sg.inverse();
        let start = Vec3([0.0, 0.0, self.offset]);
        let ray = Ray { origin: x_gs.point(start), direction: x_gs.rot.col(2) };
        let hit = geometry.cast_ray(&ray, self.end - self.offset)?;
        let distance = self.offset + hit.distance;
        Some(Detection { distance, point: Vec3([0.0, 0.0, distance]), normal: x_sg.rot.mul_vec(hit.normal) })
    }

    /// The closest point of a convex set; if it is a solid, none where the sensor is in it.
    fn closest_in_convex(&self, set: &Placed<'_>, is_solid: bool) -> Option<Vec3<f64>> {
        let at = |p: Vec3<f64>| Placed { core: POINT, radius: 0.0, pose: Pose::translation(p) };
        let start = Vec3([0.0, 0.0, self.offset]);
        if is_solid && closest_points(&at(start), set).distance == 0.0 {
            return None;
        }
        let closest = closest_points(&at(Vec3::zero()), set);
        if closest.distance > self.reach {
            return None;
        }
        if closest.distance > 0.0 && self.contains(closest.points[1]) {
            return Some(closest.points[1]);
        }
        self.first_contact(closest.distance, |within| {
            let found = gjk(within, set);
            let apart = found.distance - set.radius;
            let [p, q] = found.points;
            let off = if found.distance > 0.0 { set.radius / found.distance } else { 0.0 };
            (apart, q + (p - q).scale(off))
        })
    }

    fn closest_in_half_space(&self, x_sg: &Pose<f64>) -> Option<Vec3<f64>> {
        let (up, from) = (x_sg.rot.col(2), x_sg.pos);
        let height = |p: Vec3<f64>| up.dot(p - from);
        if height(Vec3([0.0, 0.0, self.offset])) <= 0.0 {
            return None;
        }
        let closest = up.scale(up.dot(from));
        if height(Vec3::zero()) > 0.0 && self.contains(closest) {
            return Some(closest);
        }
        self.first_contact(closest.norm(), |within| {
            let p = within.support(-up);
            (height(p), p)
        })
    }

    /// The point where what is within a radius first touches a set: `apart` tells how far they are apart, not above 0 if they meet, and the set's point.
    fn first_contact(&self, least: f64, apart: impl Fn(&Within<'_>) -> (f64, Vec3<f64>)) -> Option<Vec3<f64>> {
        let look = |radius: f64| apart(&Within { field: self, radius });
        let enough = TOUCHES * self.reach;
        if look(self.reach).0 > enough {
            return None;
        }
        let (mut low, mut high) = (least.max(self.offset), self.reach);
        let (mut f_low, mut point) = look(low);
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..MAX_ITERATIONS {
            if f_low <= enough || high - low <= enough {
                break;
            }
            let next = match before {
                Some((r, f)) if f > f_low => low + f_low * (low - r) / (f - f_low),
                _ => low + f_low,
            };
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            let (f, p) = look(next);
            if f > 0.0 {
                before = Some((low, f_low));
                (low, f_low, point) = (next, f, p);
            } else {
                // the volume did not grow evenly here
                (high, before) = (next, None);
            }
        }
        Some(point)
    }
}
