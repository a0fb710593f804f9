//! Spring, damper and actuator between two points, and tendons: a force along a path, which is the line that joins a
//! point of one link and a point of another or of the world, a polyline through several points (a spatial tendon), or
//! a linear combination of joint coordinates (a fixed tendon).
//!
//! With the length ℓ of the path, its rate ℓ̇ and the free length ℓ₀ the force is F(ℓ − ℓ₀, ℓ̇) of a [`ForceLaw`] plus
//! the command of the actuator; positive forces make the path longer. The generalized force is F·∂ℓ/∂q. Where two
//! points coincide their line has no direction, and no force.
//!
//! Sources: key `haug1989`, translational spring–damper–actuator; key `mjcf`, fixed and spatial tendons.
//!
//! | symbol | meaning | frame |
//! |---|---|---|
//! | `p`, `v` | two points of the path, their velocities | world |
//! | `n` | unit vector from the first to the second | world |
//! | ℓ, ℓ̇ | Σ over the lines of distance and its rate n·(v₂ − v₁), or Σ cᵢ qᵢ and Σ cᵢ q̇ᵢ | |

use sincro_integrate::quadrature;
use sincro_math::{Branches, Real};

use crate::force_law::ForceLaw;
use sincro_geometry::spatial::{Force, Motion, Pose, Vec3};

/// Point fixed in a link, or in the world: one end of a [`SpringDamper`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkPoint<R> {
    /// Index of the link in `Model::links`; `None` for the world.
    pub link: Option<usize>,
    /// Position in the link's frame, or in the world `[m]`.
    pub position: Vec3<R>,
}

/// Actuator of a [`SpringDamper`]: adds its command, limited, to the force along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineActuator<R> {
    /// Index in the model's commands of its command, a force `[N]`; positive makes the path longer.
    pub command: usize,
    /// Largest magnitude of the force `[N]`; infinite for none.
    pub max_force: R,
}

/// Piece of a path between two neighbouring points of it: a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<R> {
    /// The two points, in the order of the path.
    pub ends: [LinkPoint<R>; 2],
}

/// Share of a joint coordinate in the length of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointShare<R> {
    /// Degree of freedom.
    pub dof: usize,
    /// Index of its coordinate in q.
    pub coordinate: usize,
    /// Length for each unit of the coordinate `[m/rad]`, or `[1]` of a prismatic joint.
    pub coefficient: R,
}

/// Path along which a [`SpringDamper`] acts.
#[derive(Clone, Debug, PartialEq)]
pub enum Path<R> {
    /// Line through two points or more, without friction at those between its ends: one segment or more.
    Lines(Vec<Segment<R>>),
    /// Linear combination of coordinates of joints with one degree of freedom.
    Joints(Vec<JointShare<R>>),
}

/// Length of a [`Path`] and its rate at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathLength<R> {
    /// Length ℓ `[m]`.
    pub length: R,
    /// Rate of the length ℓ̇ `[m/s]`.
    pub rate: R,
}

/// Spring, damper and actuator along a path: between two points, or a tendon; from
/// `SpringDamperSpec`.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringDamper<R> {
    /// Path whose length the force law takes.
    pub path: Path<R>,
    /// Length at which the deflection is zero `[m]`.
    pub free_length: R,
    /// Force `[N]` over deflection (length less free length) `[m]` and rate `[m/s]`; positive makes the path longer.
    pub law: ForceLaw<R>,
    /// True for a rope: it pulls, when longer than its free length, and never pushes.
    pub tension_only: bool,
    /// Actuator along the path; `None` without.
    pub actuator: Option<LineActuator<R>>,
}

/// Line of a [`Segment`] at one instant, in world axes; from [`Segment::line`].
#[derive(Clone, Copy, Debug)]
pub struct Line<R> {
    /// Positions of the two end points `[m]`.
    pub points: [Vec3<R>; 2],
    /// Velocities of the two end points `[m/s]`.
    pub velocities: [Vec3<R>; 2],
    /// Unit vector from the first point to the second; zero where they coincide.
    pub direction: Vec3<R>,
    /// Distance of the points `[m]`.
    pub length: R,
    /// Rate of the distance `[m/s]`.
    pub rate: R,
}

/// Forces of a [`SpringDamper`] along its path at one instant; positive ones make it longer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineForces<R> {
    /// Elastic force `[N]`: minus the derivative of the potential energy.
    pub elastic: R,
    /// Dissipating force `[N]`: the part that depends on the rate.
    pub damping: R,
    /// Force of the actuator `[N]`.
    pub actuator: R,
}

impl<R: Real> LineForces<R> {
    /// Sum of the three forces along the line `[N]`.
    #[inline(always)]
    pub fn total(&self) -> R {
        self.elastic + self.damping + self.actuator
    }
}

impl<R: Real> Segment<R> {
    /// Computes the line at one instant. `at` gives, for the index of a link, its twist about its origin in link axes
    /// (`[rad/s]`, `[m/s]`) and its pose in the world `[m]`.
    #[inline(always)]
    pub fn line(&self, at: impl Fn(usize) -> (Motion<R>, Pose<R>)) -> Line<R> {
        let ends = self.ends.map(|end| match end.link {
            None => (end.position, Vec3::zero()),
            Some(link) => {
                let (twist, x_wl) = at(link);
                let velocity = x_wl.rot.mul_vec(twist.lin + twist.ang.cross(end.position));
                (x_wl.point(end.position), velocity)
            }
        });
        let [(p1, v1), (p2, v2)] = ends;
        let apart = p2 - p1;
        // below that the root has no slope, and 0 · ∞ would be the derivative
        let length = apart.dot(apart).max(R::splat(f64::MIN_POSITIVE)).sqrt();
        let direction = apart.scale(R::one() / length);
        Line { points: [p1, p2], velocities: [v1, v2], direction, length, rate: direction.dot(v2 - v1) }
    }

    /// Wrench of a `force` along the line `[N]` on the link of end `k` (0 or 1): moment about the link's origin `[N·m]`
    /// and force `[N]`, in link axes. `x_wl` is the pose of that link in the world `[m]`.
    #[inline(always)]
    pub fn wrench(&self, k: usize, line: &Line<R>, force: R, x_wl: &Pose<R>) -> Force<R> {
        let along = line.direction.scale(if k == 0 { -force } else { force });
        let lin = x_wl.rot.tr_mul_vec(along);
        Force { ang: self.ends[k].position.cross(lin), lin }
    }
}

impl<R: Real> PathLength<R> {
    /// Sum over the lines of a path.
    ///
    /// # Panics
    ///
    /// If there is no line.
    #[inline(always)]
    pub fn of_lines(lines: &[Line<R>]) -> Self {
        let mut sum = Self { length: lines[0].length, rate: lines[0].rate };
        for line in &lines[1..] {
            sum.length += line.length;
            sum.rate += line.rate;
        }
        sum
    }

    /// Linear combination of the coordinates `q` and velocities `v` of a model.
    #[inline(always)]
    pub fn of_joints(shares: &[JointShare<R>], q: &[R], v: &[R]) -> Self {
        let mut sum = Self { length: R::zero(), rate: R::zero() };
        for share in shares {
            sum.length += share.coefficient * q[share.coordinate];
            sum.rate += share.coefficient * v[share.dof];
        }
        sum
    }
}

impl<R: Real> SpringDamper<R> {
    /// Straight lines of its path; none of a linear combination of joint coordinates.
    #[inline(always)]
    pub fn segments(&self) -> &[Segment<R>] {
        match &self.path {
            Path::Lines(segments) => segments,
            Path::Joints(_) => &[],
        }
    }

    /// Shares of joint coordinates in its path; none of one through points.
    #[inline(always)]
    pub fn shares(&self) -> &[JointShare<R>] {
        match &self.path {
            Path::Lines(_) => &[],
            Path::Joints(shares) => shares,
        }
    }

    /// Length of the path and its rate at the coordinates `q` (n_q) and velocities `v` (n_v). `at` gives, for the index
    /// of a link, its twist about its origin in link axes (`[rad/s]`, `[m/s]`) and its pose in the world `[m]`.
    #[inline(always)]
    pub fn length(&self, q: &[R], v: &[R], at: impl Fn(usize) -> (Motion<R>, Pose<R>)) -> PathLength<R> {
        match &self.path {
            Path::Joints(shares) => PathLength::of_joints(shares, q, v),
            Path::Lines(segments) => {
                let mut sum = PathLength::of_lines(&[segments[0].line(&at)]);
                for segment in &segments[1..] {
                    let line = segment.line(&at);
                    sum = PathLength { length: sum.length + line.length, rate: sum.rate + line.rate };
                }
                sum
            }
        }
    }

    /// Returns true if its law is in pieces: that of a rope, or a nonlinear part.
    #[must_use]
    pub fn has_branches(&self) -> bool {
        self.tension_only || self.law.nonlinear.is_some()
    }

    /// Notes the branches that its law takes at a `length` of the path `[m]` and its `rate` `[m/s]`, of lane 0.
    pub fn note_branches(&self, length: R, rate: R, branches: &mut Branches) {
        let x = length - self.free_length;
        if self.tension_only {
            branches.note_side(R::zero().if_less(x, self.law.force(x, rate), R::zero()).lane(0), 0.0);
        }
        if let Some(law) = &self.law.nonlinear {
            law.note_branches(x.lane(0), rate.lane(0), branches);
        }
    }

    /// Forces along the path `[N]` at its `length` `[m]` and `rate` of the length `[m/s]`; `commands` are all commands
    /// of the model (n_commands), of which an actuator reads its own.
    #[inline(always)]
    pub fn forces(&self, length: R, rate: R, commands: &[R]) -> LineForces<R> {
        self.forces_under(length, rate, self.actuator.map_or(R::zero(), |a| commands[a.command]))
    }

    /// Forces along the path as [`SpringDamper::forces`], for the `command` of its actuator `[N]`.
    #[inline(always)]
    pub fn forces_under(&self, length: R, rate: R, command: R) -> LineForces<R> {
        let (x, zero) = (length - self.free_length, R::zero());
        let actuator = self.actuator.map_or(zero, |a| command.clamp_abs(a.max_force));
        let (elastic, both) = (self.law.force(x, zero), self.law.force(x, rate));
        if !self.tension_only {
            return LineForces { elastic, damping: both - elastic, actuator };
        }
        let pulls = |force: R| zero.if_less(x, force.min(zero), zero);
        LineForces { elastic: pulls(elastic), damping: pulls(both) - pulls(elastic), actuator }
    }

    /// Potential energy `[J]` at a `length` of the path `[m]`, zero at the free length.
    #[inline(always)]
    pub fn potential(&self, length: R) -> R {
        let x = length - self.free_length;
        if !self.tension_only {
            return self.law.potential(x);
        }
        let zero = R::zero();
        if self.law.nonlinear.is_none() {
            return self.law.potential(x.max(zero));
        }
        // the law may push somewhere, which the rope does not; whatever the lane, the law is the same but for numbers
        let of = |l: usize, x: f64| {
            let force = |s: f64| self.law.force(R::splat(s), zero).lane(l).min(0.0);
            (-quadrature(&force, 0.0, x), -force(x))
        };
        let value = R::from_lanes(|l| of(l, x.lane(l).max(0.0)).0);
        let slope = R::from_lanes(|l| if x.lane(l) > 0.0 { of(l, x.lane(l)).1 } else { 0.0 });
        // derivatives by the chain rule: x less its own value carries them alone
        value + slope * (x - R::from_lanes(|l| x.lane(l)))
    }

    /// Stiffness `[N/m]` and damping `[N·s/m]` that a linearly implicit step evaluates at the new state, at a `length`
    /// of the path `[m]` and its `rate` `[m/s]`; zero for a slack rope.
    #[inline(always)]
    pub fn implicit_terms(&self, length: R, rate: R) -> (R, R) {
        let (x, zero) = (length - self.free_length, R::zero());
        let (k, c) = self.law.implicit_terms(x, rate);
        if !self.tension_only {
            return (k, c);
        }
        let is_taut = |y: R| zero.if_less(x, self.law.force(x, rate).if_less(zero, y, zero), zero);
        (is_taut(k), is_taut(c))
    }
}
