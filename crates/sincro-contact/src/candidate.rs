//! Contact candidates and contact kinematics: signed distance between a point of one body, rounded by a radius, and a
//! feature of another.
//!
//! Every smooth contact of the shapes here has this form: a sphere, the end of a capsule or a vertex against a plane, a
//! point or a line, the rim of a disc against a plane. The signed distance g (gap function), the normal n (from b to a)
//! and the contact point C satisfy ġ = n·(v_a(C) − v_b(C)); with ṅ and Ċ given here the acceleration level of a
//! constraint follows, curvature included. Source: key `acary2008`, chapter 3.
//!
//! | feature | signed distance g | ṅ |
//! |---|---|---|
//! | plane (o, n) | n·(P − o) − r | ω_b × n |
//! | point o | \|P − o\| − r | (Ḋ − n (n·Ḋ))/\|D\|, D = P − o |
//! | line (o, d) | \|D\| − r, D = P − o − d (d·(P − o)) | the same |

use sincro_math::Real;

use crate::WORLD;
use sincro_geometry::spatial::{Motion, Pose, Vec3};

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
        /// Unit vector along the line.
        direction: Vec3<f64>,
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
    /// Disc whose rim it is, rounded by the radius; the point is then the disc's centre. Planes only.
    pub rim: Option<Rim>,
    /// Feature of body b that it may touch.
    pub feature: Feature,
    /// Features of the surfaces that the candidate comes from, the same as long as the same ones touch; 0: not known.
    pub id: u32,
}

/// Disc of which the lowest point over a plane may touch it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim {
    /// Unit vector along the axis of the disc, in link axes of a.
    pub axis: Vec3<f64>,
    /// Radius of the disc `[m]`; the rounding of its edge is the radius of the candidate.
    pub radius: f64,
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
    /// Returns true if it is a sharp corner over a plane. Of a compliant contact friction then acts where the corner
    /// meets the plane: corners of one face that have sunk in to different depths, as of a body that rocks, would
    /// otherwise contradict each other in how they slide.
    #[must_use]
    pub fn rubs_at_plane(&self) -> bool {
        self.radius == 0.0 && self.rim.is_none() && matches!(self.feature, Feature::Plane { .. })
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
                let height = n.dot(p - x_b.point(Vec3::splat(origin.0)));
                if let Some(Rim { axis, radius: of_disc }) = self.rim {
                    let axis = x_a.rot.mul_vec(Vec3::splat(axis.0));
                    let axis_dot = motions.twist_of(self.a).ang.cross(axis);
                    return rim(height, (p, p_dot), (n, n_dot), (axis, axis_dot), (R::splat(of_disc), radius));
                }
                let point = p - n.scale(radius);
                ContactKinematics {
                    distance: height - radius,
                    point,
                    normal: n,
                    point_dot: p_dot - n_dot.scale(radius),
                    normal_dot: n_dot,
                }
            }
            Feature::Point { origin } => {
                let o = x_b.point(Vec3::splat(origin.0));
                self.of_distance(p, p_dot, p - o, p_dot - motions.velocity_of(self.b, o))
            }
            Feature::Line { origin, direction } => {
                let o = x_b.point(Vec3::splat(origin.0));
                let d = x_b.rot.mul_vec(Vec3::splat(direction.0));
                let d_dot = w_b.cross(d);
                let (rho, rho_dot) = (p - o, p_dot - motions.velocity_of(self.b, o));
                let along = d.dot(rho);
                let along_dot = d_dot.dot(rho) + d.dot(rho_dot);
                self.of_distance(p, p_dot, rho - d.scale(along), rho_dot - d_dot.scale(along) - d.scale(along_dot))
            }
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

/// Two unit vectors across `n`, (t₁, t₂, n) right-handed; the same for the same bits of n.
#[must_use]
pub fn tangents<R: Real>(n: Vec3<R>) -> (Vec3<R>, Vec3<R>) {
    let size = |k: usize| n[k].lane(0).abs();
    let k = if size(0) <= size(1) && size(0) <= size(2) {
        0
    } else if size(1) <= size(2) {
        1
    } else {
        2
    };
    let e = Vec3::along(k, R::one());
    let t1 = e - n.scale(n[k]);
    let t1 = t1.scale(R::one() / t1.norm());
    (t1, n.cross(t1))
}
