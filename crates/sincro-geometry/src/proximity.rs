//! Detection by a proximity sensor: the point of a surface inside its field of view that is closest to its origin.
//!
//! If the closest point of a convex surface is inside the field of view, it is the detection. If not, the detection
//! lies on the boundary of the field of view: the part of it within a radius r then just touches the surface. The
//! distance f(r) of the two is convex and decreases to zero at the detection, so that secants from below never pass it
//! where the volume grows evenly; where they do, bisection takes over. The iteration ends at 1e-13 of the size. Meshes
//! and height fields are sets of triangles, each of which is convex. Rays have their own closed forms. A solid that
//! contains the origin, or the centre of the near end, is not detected.

use super::distance::closest_points;
use super::field_of_view::{FieldOfView, Volume, Within};
use super::gjk::{Convex, gjk};
use super::support::{Core, POINT, Placed, Solid, normal_at};
use super::{Geometry, Ray};
use crate::spatial::{Pose, Vec3};

/// Distance between volume and surface at which the iteration ends, relative to the size of the volume.
const TOUCHES: f64 = 1e-13;
/// Iteration limit of secants and bisections.
const MAX_ITERATIONS: usize = 120;

/// Detection of a proximity sensor, from [`FieldOfView::detect`]; all vectors in the frame of the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// Distance of the detected point from the sensor's origin `[m]`.
    pub distance: f64,
    /// Detected point `[m]`: the one of the surface within the field of view that is closest to the origin.
    pub point: Vec3<f64>,
    /// Outward unit normal of the surface there (dimensionless).
    pub normal: Vec3<f64>,
}

impl FieldOfView {
    /// Detects the point of a surface inside the field of view that is closest to the sensor's origin; `None` if there
    /// is none within `max_distance` `[m]` of it.
    ///
    /// `x_sg` is the pose of the surface's frame in that of the sensor `[m]`. A solid that contains the origin, or the
    /// centre of the near end, is not detected.
    ///
    /// ```
    /// use sincro_geometry::spatial::{Pose, Vec3};
    /// use sincro_geometry::{FieldOfView, Geometry, Shape, Surface, Volume};
    ///
    /// let sensor = FieldOfView::new(Volume::Cone { angle: 0.5 }, 0.0, 3.0).unwrap();
    /// let ball = Geometry::new(Surface::Solid(Shape::Sphere { radius: 0.5 })).unwrap();
    /// let seen = sensor.detect(&ball, &Pose::translation(Vec3([0.0, 0.0, 2.0])), 10.0).unwrap();
    /// assert!((seen.distance - 1.5).abs() < 1e-9); // [m]
    /// ```
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

    /// Closest point of a convex set; of a solid, none where the sensor is inside it.
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

    /// First contact of the growing volume with a set: `apart` returns their distance, not above 0 if they overlap, and
    /// the set's point.
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
