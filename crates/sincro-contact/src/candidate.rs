//! Contact candidates and contact kinematics: signed distance between a point of one body, rounded by a radius, and a
//! feature of another.
//!
//! Every smooth contact of the shapes here has this form: a sphere, the end of a capsule or a vertex against a plane, a
//! point, a line or a circle, the rim of a disc against a plane, an edge across an edge. The signed distance g (gap
//! function), the normal n (from b to a) and the contact point C satisfy ġ = n·(v_a(C) − v_b(C)); with ṅ and Ċ given
//! here the acceleration level of a constraint follows, curvature included. The gap at a point that is cut off, or over
//! a vertex, also changes as C moves over tilted surfaces. Source: key `acary2008`, chapter 3.
//!
//! | feature | signed distance g | ṅ |
//! |---|---|---|
//! | plane (o, n) | n·(P − o) − r | ω_b × n |
//! | point o | \|P − o\| − r | (Ḋ − n (n·Ḋ))/\|D\|, D = P − o |
//! | line (o, d) | \|D\| − r, D = P − o − d (d·(P − o)) | the same |
//! | circle (o, k, R) | \|D\| − r, D = P − o − R e, e along P − o across k | the same |
//! | line (o, w) under an edge along u | n·(P − o), n = c/\|c\|, c = u × w | (ċ − n (n·ċ))/\|c\|, ċ = (ω_a × u) × w + u × (ω_b × w) |

use std::mem::discriminant;

use sincro_math::Real;

use crate::WORLD;
use crate::material::Material;
use sincro_geometry::spatial::{Motion, Pose, Vec3};

/// Cosine of the angle between the normals of two planes above which they may be one, found at two instants.
const SAME_PLANE: f64 = 0.9;

/// Distance of a point of one line from another one below which they may be one `[m]`.
const SAME_LINE: f64 = 1e-5;

/// Feature of body b that the point of body a may touch, in link axes of b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feature {
    /// Plane.
    Plane {
        /// Point of the plane `[m]`.
        origin: Vec3<f64>,
        /// Unit normal, towards body a.
        normal: Vec3<f64>,
    },
    /// Point.
    Point {
        /// Its position `[m]`.
        origin: Vec3<f64>,
    },
    /// Straight line.
    Line {
        /// Point of the line `[m]`.
        origin: Vec3<f64>,
        /// Vector along the line: a unit vector, but with an edge that crosses it, where it has any length.
        direction: Vec3<f64>,
    },
    /// Circle, the rim of a disc.
    Circle {
        /// Centre `[m]`.
        origin: Vec3<f64>,
        /// Unit vector along its axis.
        axis: Vec3<f64>,
        /// Radius `[m]`.
        radius: f64,
    },
}

/// Contact candidate: a possible point of contact between two links.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactCandidate {
    /// Index of the link of body a, [`WORLD`] for none.
    pub a: u32,
    /// Index of the link of body b, [`WORLD`] for none.
    pub b: u32,
    /// Point of body a that may touch, in link axes of a `[m]`.
    pub point: Vec3<f64>,
    /// Rounding about the point (and of b's feature, added) `[m]`.
    pub radius: f64,
    /// Share of the radius that belongs to a.
    pub radius_a: f64,
    /// Edge or face that the point moves along, where it does not stay in place on body a.
    pub edge: Option<Edge>,
    /// Feature of body b that it may touch.
    pub feature: Feature,
    /// Features of the surfaces that the candidate comes from, the same as long as the same ones touch; 0: not known.
    pub id: u32,
}

/// Edge of body a on which the contact point is, in link axes of a; vectors are of any length where not said otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge {
    /// Edge through the point, which crosses the line of body b. The signed distance is that of the two lines, negative
    /// where they have passed each other.
    Crossing {
        /// Along the edge, a unit vector where it is curved; the normal points along its vector product with the line.
        direction: Vec3<f64>,
        /// Curvature of the edge: the rate of a unit vector along it by its length, zero of a straight one `[1/m]`.
        curvature: Vec3<f64>,
    },
    /// Straight edge over the plane of b, cut off by a side of the surface in that plane, which goes through the
    /// plane's point: the contact point moves along both.
    Cut {
        /// Along the edge.
        direction: Vec3<f64>,
        /// Normal of the side, in link axes of b.
        side: Vec3<f64>,
    },
    /// Face over the plane of b: the contact point is that over the plane's point, a vertex of the surface in it.
    OverVertex {
        /// Normal of the face.
        face: Vec3<f64>,
    },
    /// Rim of a disc, the lowest point of which over a plane may touch it; the candidate's point is its centre, the
    /// rounding of the edge is the radius of the candidate.
    Rim {
        /// Unit vector along the axis of the disc.
        axis: Vec3<f64>,
        /// Radius of the disc `[m]`.
        radius: f64,
    },
}

/// Contact kinematics of a candidate at one instant, world axes.
#[derive(Clone, Copy, Debug)]
pub struct ContactKinematics<R> {
    /// Signed distance g `[m]`; negative where the bodies overlap.
    pub distance: R,
    /// Contact point C `[m]`.
    pub point: Vec3<R>,
    /// Unit normal n, from b to a.
    pub normal: Vec3<R>,
    /// Velocity Ċ of the contact point `[m/s]`.
    pub point_dot: Vec3<R>,
    /// Rate ṅ of the normal `[1/s]`.
    pub normal_dot: Vec3<R>,
}

/// Poses and twists of all links at one instant, in world axes; twists are about the world's origin.
#[derive(Clone, Copy, Debug)]
pub struct LinkMotions<'a, R> {
    /// Pose of each link `[m]`.
    pub poses: &'a [Pose<R>],
    /// Twist of each link [rad/s, m/s].
    pub twists: &'a [Motion<R>],
}

impl<R: Real> LinkMotions<'_, R> {
    fn pose_of(&self, link: u32) -> Pose<R> {
        if link == WORLD { Pose::identity() } else { self.poses[link as usize] }
    }

    /// Twist of a link [rad/s, m/s]; zero for the world.
    #[must_use]
    pub fn twist_of(&self, link: u32) -> Motion<R> {
        if link == WORLD { Motion::zero() } else { self.twists[link as usize] }
    }

    /// Velocity [m/s] of the point of a link that is at `p` in the world.
    #[must_use]
    pub fn velocity_of(&self, link: u32, p: Vec3<R>) -> Vec3<R> {
        let v = self.twist_of(link);
        v.lin + v.ang.cross(p)
    }
}

impl ContactCandidate {
    /// Returns true if friction of a contact, `is_compliant` or not, acts where a sharp corner or edge meets the plane
    /// or edge of the other body, not at the contact point: corners of one face that have sunk in to different depths,
    /// as of a body that rocks, would otherwise contradict each other in how they slide.
    fn rubs_at_plane(&self, is_compliant: bool) -> bool {
        is_compliant && self.radius == 0.0 && !matches!(self.edge, Some(Edge::Rim { .. }))
    }

    /// Returns true if its distance has a sign on either side of the feature, as over a plane; that from a point or a
    /// line goes through the least there is and grows again.
    #[must_use]
    pub fn is_signed(&self) -> bool {
        matches!(self.feature, Feature::Plane { .. }) || self.edge.is_some()
    }

    /// Returns true if this candidate and another one of the same two surfaces, found at another instant, are of the
    /// same features, as far as these are told apart.
    #[must_use]
    pub fn has_features_of(&self, other: &Self) -> bool {
        if self.id != 0 || other.id != 0 {
            return self.id == other.id;
        }
        let is_edge = match (self.edge, other.edge) {
            (Some(Edge::Rim { .. }), Some(Edge::Rim { .. })) => self.point == other.point,
            (one, two) => one.map(|edge| discriminant(&edge)) == two.map(|edge| discriminant(&edge)),
        };
        let is_feature = match (self.feature, other.feature) {
            (Feature::Plane { normal, .. }, Feature::Plane { normal: other, .. }) => normal.dot(other) > SAME_PLANE,
            (Feature::Line { origin, direction }, Feature::Line { origin: point, .. }) => {
                (point - origin).cross(direction).norm() < SAME_LINE * direction.norm()
            }
            (one, two) => discriminant(&one) == discriminant(&two),
        };
        self.a == other.a && is_edge && is_feature
    }

    /// Point at which friction of a contact, `is_compliant` or not, acts, in the world frame `[m]`.
    #[must_use]
    pub fn friction_point<R: Real>(&self, at: &ContactKinematics<R>, is_compliant: bool) -> Vec3<R> {
        if self.rubs_at_plane(is_compliant) { at.point - at.normal.scale(at.distance) } else { at.point }
    }

    /// Velocity of that point `[m/s]`; `twist_b` is that of link b.
    #[must_use]
    pub fn friction_point_dot<R: Real>(
        &self,
        at: &ContactKinematics<R>,
        twist_b: Motion<R>,
        is_compliant: bool,
    ) -> Vec3<R> {
        if !self.rubs_at_plane(is_compliant) {
            return at.point_dot;
        }
        // the rate of the distance at the point as it moves, which need not be with body a
        let rate = at.normal.dot(at.point_dot - twist_b.lin - twist_b.ang.cross(at.point));
        at.point_dot - at.normal.scale(rate) - at.normal_dot.scale(at.distance)
    }

    /// Rate of the distance [m/s], for the twists of links about the world's origin.
    #[must_use]
    pub fn normal_rate(&self, twist: impl Fn(u32) -> Motion<f64>, at: &ContactKinematics<f64>) -> f64 {
        self.relative_velocity(twist, at.point).dot(at.normal)
    }

    /// Velocity of a's material at a point of the world against b's [m/s].
    fn relative_velocity(&self, twist: impl Fn(u32) -> Motion<f64>, point: Vec3<f64>) -> Vec3<f64> {
        let [a, b] = [twist(self.a), twist(self.b)];
        (a.lin + a.ang.cross(point)) - (b.lin + b.ang.cross(point))
    }

    /// Friction groups that slide faster than `zero_speed` [m/s], [rad/s]: friction, rolling, spinning.
    #[must_use]
    pub fn slides(
        &self,
        twist: impl Fn(u32) -> Motion<f64>,
        at: &ContactKinematics<f64>,
        material: &Material,
        zero_speed: f64,
    ) -> [bool; 3] {
        let (t1, t2) = tangents(at.normal);
        let w = twist(self.a).ang - twist(self.b).ang;
        let v = self.relative_velocity(twist, self.friction_point(at, material.stiffness.is_finite()));
        let across = |x: Vec3<f64>| (x.dot(t1) * x.dot(t1) + x.dot(t2) * x.dot(t2)).sqrt() > zero_speed;
        [
            material.friction > 0.0 && across(v),
            material.rolling_friction > 0.0 && across(w),
            material.spinning_friction > 0.0 && w.dot(at.normal).abs() > zero_speed,
        ]
    }

    /// Contact kinematics: signed distance, contact point, normal and their rates, at the instant of `motions`.
    #[must_use]
    pub fn kinematics<R: Real>(&self, motions: &LinkMotions<'_, R>) -> ContactKinematics<R> {
        let (x_a, x_b) = (motions.pose_of(self.a), motions.pose_of(self.b));
        let p = x_a.point(Vec3::splat(self.point.0));
        let p_dot = motions.velocity_of(self.a, p);
        let w_b = motions.twist_of(self.b).ang;
        let radius = R::splat(self.radius);
        match self.feature {
            Feature::Plane { origin, normal } => {
                let n = x_b.rot.mul_vec(Vec3::splat(normal.0));
                let n_dot = w_b.cross(n);
                let o = x_b.point(Vec3::splat(origin.0));
                if let Some(Edge::Rim { axis, radius: of_disc }) = self.edge {
                    let height = n.dot(p - o);
                    let axis = x_a.rot.mul_vec(Vec3::splat(axis.0));
                    let axis_dot = motions.twist_of(self.a).ang.cross(axis);
                    return rim(height, (p, p_dot), (n, n_dot), (axis, axis_dot), (R::splat(of_disc), radius));
                }
                let (p, p_dot) = self.moved(motions, (x_a, x_b), (p, p_dot), (o, n));
                ContactKinematics {
                    distance: n.dot(p - o) - radius,
                    point: p - n.scale(radius),
                    normal: n,
                    point_dot: p_dot - n_dot.scale(radius),
                    normal_dot: n_dot,
                }
            }
            Feature::Point { origin } => {
                let o = x_b.point(Vec3::splat(origin.0));
                self.of_distance(p, p_dot, p - o, p_dot - motions.velocity_of(self.b, o))
            }
            Feature::Circle { origin, axis, radius } => {
                let o = x_b.point(Vec3::splat(origin.0));
                let k = x_b.rot.mul_vec(Vec3::splat(axis.0));
                let k_dot = w_b.cross(k);
                let (d, d_dot) = (p - o, p_dot - motions.velocity_of(self.b, o));
                let (high, high_dot) = (k.dot(d), k_dot.dot(d) + k.dot(d_dot));
                let (across, across_dot) = (d - k.scale(high), d_dot - k_dot.scale(high) - k.scale(high_dot));
                let inverse = R::one() / across.norm();
                let e = across.scale(inverse);
                let e_dot = (across_dot - e.scale(e.dot(across_dot))).scale(inverse);
                let radius = R::splat(radius);
                self.of_distance(p, p_dot, d - e.scale(radius), d_dot - e_dot.scale(radius))
            }
            Feature::Line { origin, direction } => {
                let o = x_b.point(Vec3::splat(origin.0));
                let d = x_b.rot.mul_vec(Vec3::splat(direction.0));
                let d_dot = w_b.cross(d);
                if let Some(Edge::Crossing { direction, curvature }) = self.edge {
                    let [u, k] = [direction, curvature].map(|x| x_a.rot.mul_vec(Vec3::splat(x.0)));
                    return self.crossing(motions, (p, u, k), (o, d));
                }
                let (rho, rho_dot) = (p - o, p_dot - motions.velocity_of(self.b, o));
                let along = d.dot(rho);
                let along_dot = d_dot.dot(rho) + d.dot(rho_dot);
                self.of_distance(p, p_dot, rho - d.scale(along), rho_dot - d_dot.scale(along) - d.scale(along_dot))
            }
        }
    }

    /// Point over a plane through `o` with normal `n`, and its velocity, of one that is `p` on body a where it stays in
    /// place: where the edge through it crosses the side through `o`, or the face through it is over `o`.
    fn moved<R: Real>(
        &self,
        motions: &LinkMotions<'_, R>,
        (x_a, x_b): (Pose<R>, Pose<R>),
        (p, p_dot): (Vec3<R>, Vec3<R>),
        (o, n): (Vec3<R>, Vec3<R>),
    ) -> (Vec3<R>, Vec3<R>) {
        let velocities = |c: Vec3<R>| (motions.velocity_of(self.a, c), motions.velocity_of(self.b, c));
        match self.edge {
            Some(Edge::Cut { direction, side }) => {
                let (u, m) = (x_a.rot.mul_vec(Vec3::splat(direction.0)), x_b.rot.mul_vec(Vec3::splat(side.0)));
                let inverse = R::one() / m.dot(u);
                let c = p - u.scale(m.dot(p - o) * inverse);
                let (v_a, v_b) = velocities(c);
                (c, v_a - u.scale(m.dot(v_a - v_b) * inverse))
            }
            Some(Edge::OverVertex { face }) => {
                let m = x_a.rot.mul_vec(Vec3::splat(face.0));
                let inverse = R::one() / m.dot(n);
                let c = o + n.scale(m.dot(p - o) * inverse);
                let (v_a, v_b) = velocities(c);
                (c, v_b + n.scale(m.dot(v_a - v_b) * inverse))
            }
            _ => (p, p_dot),
        }
    }

    /// Two lines: through `p` along `u` on body a, through `o` along `w` on b. With c = u × w and D = P − o their
    /// nearest points are P + s u and o + t w; D + s u − t w = g n, so that s = −D·(w × c)/|c|², and its derivative
    /// gives ṡ. An edge with the curvature `k` is P + s u + k s²/2, of which s is nearly zero.
    fn crossing<R: Real>(
        &self,
        motions: &LinkMotions<'_, R>,
        (p, u, k): (Vec3<R>, Vec3<R>, Vec3<R>),
        (o, w): (Vec3<R>, Vec3<R>),
    ) -> ContactKinematics<R> {
        let (w_a, w_b) = (motions.twist_of(self.a).ang, motions.twist_of(self.b).ang);
        let at = |u: Vec3<R>, p: Vec3<R>| {
            let c = u.cross(w);
            let inverse = R::one() / c.norm();
            let (n, across) = (c.scale(inverse), w.cross(c).scale(inverse * inverse));
            let turned = move |c_dot: Vec3<R>| (c_dot - n.scale(n.dot(c_dot))).scale(inverse);
            let (gap, by_s) = (n.dot(p - o), turned(k.cross(w)));
            (n, across, gap, by_s, R::one() - gap * by_s.dot(across), turned)
        };
        let (_, across, .., bend, _) = at(u, p);
        let s = -((p - o).dot(across) / bend);
        let (nearest, u) = (p + (u + k.scale(R::splat(0.5) * s)).scale(s), u + k.scale(s));
        let (n, across, gap, by_s, bend, turned) = at(u, nearest);
        let n_dot = turned(w_a.cross(u).cross(w) + u.cross(w_b.cross(w)));
        let v_a = motions.velocity_of(self.a, nearest);
        let v = v_a - motions.velocity_of(self.b, nearest - n.scale(gap)) - n_dot.scale(gap);
        let s_dot = -(v.dot(across) / bend);
        let (n_dot, own) = (n_dot + by_s.scale(s_dot), R::splat(self.radius_a));
        ContactKinematics {
            distance: gap - R::splat(self.radius),
            point: nearest - n.scale(own),
            normal: n,
            point_dot: v_a + u.scale(s_dot) - n_dot.scale(own),
            normal_dot: n_dot,
        }
    }

    /// Contact kinematics from the vector D, which leads from the feature to the point P.
    fn of_distance<R: Real>(&self, p: Vec3<R>, p_dot: Vec3<R>, d: Vec3<R>, d_dot: Vec3<R>) -> ContactKinematics<R> {
        let length = d.norm();
        let inverse = R::one() / length;
        let n = d.scale(inverse);
        let n_dot = (d_dot - n.scale(n.dot(d_dot))).scale(inverse);
        let own = R::splat(self.radius_a);
        ContactKinematics {
            distance: length - R::splat(self.radius),
            point: p - n.scale(own),
            normal: n,
            point_dot: p_dot - n_dot.scale(own),
            normal_dot: n_dot,
        }
    }
}

/// The lowest point of a disc's rim over a plane, rounded by ρ: C = P + r u − ρ n, u = −(n − (n·a) a)/s, s its length;
/// gap = n·(P − o) − r s − ρ. Of a torus r is the major radius and ρ that of the tube.
fn rim<R: Real>(
    height: R,
    (p, p_dot): (Vec3<R>, Vec3<R>),
    (n, n_dot): (Vec3<R>, Vec3<R>),
    (axis, axis_dot): (Vec3<R>, Vec3<R>),
    (radius, rounding): (R, R),
) -> ContactKinematics<R> {
    let along = n.dot(axis);
    let across = n - axis.scale(along);
    let along_dot = n_dot.dot(axis) + n.dot(axis_dot);
    let across_dot = n_dot - axis.scale(along_dot) - axis_dot.scale(along);
    let s = across.norm();
    let inverse = R::one() / s;
    let u = across.scale(-inverse);
    let u_dot = -(across_dot.scale(inverse) - across.scale(inverse * inverse * inverse * across.dot(across_dot)));
    ContactKinematics {
        distance: height - radius * s - rounding,
        point: p + u.scale(radius) - n.scale(rounding),
        normal: n,
        point_dot: p_dot + u_dot.scale(radius) - n_dot.scale(rounding),
        normal_dot: n_dot,
    }
}

/// Component of a normal up to which the first tangent is along the x axis: far from those of floors, walls and slopes
/// of 45 degrees, since directions of friction that are kept over a step would change with the tangents.
const ALONG_X: f64 = 0.77;

/// Two unit vectors across `n`, (t₁, t₂, n) right-handed; the same for the same bits of n, and near each other for
/// normals near each other but where a normal's x component passes ±0.77.
#[must_use]
pub fn tangents<R: Real>(n: Vec3<R>) -> (Vec3<R>, Vec3<R>) {
    let k = usize::from(n[0].lane(0).abs() > ALONG_X);
    let e = Vec3::along(k, R::one());
    let t1 = e - n.scale(n[k]);
    let t1 = t1.scale(R::one() / t1.norm());
    (t1, n.cross(t1))
}
