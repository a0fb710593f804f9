//! Joints: the relative motions of a link and its parent.
//!
//! Users name eight kinds ([`JointKind`]); universal and planar ones are chains of one-degree-of-freedom joints without
//! mass in between, and fixed ones are merged away when the model is built. The recursions see a `Stage`: one file
//! each with the same operations, and the axis of a rotation a compile-time constant, because an axis-aligned rotation
//! costs a quarter of a general one.
//!
//! Frames of a link: the *base* frame is fixed in the parent link (its placement), the *link* frame moves. Both
//! coincide at q = 0. The motion subspace S of every stage is constant in the link frame, so its velocity product is `v
//! × S q̇`. Source: key `featherstone2008`, chapter 4.

mod ball;
mod dof;
mod free;
mod link;
mod prismatic;
mod revolute;
mod screw;

use core::marker::PhantomData;

use sincro_math::{Real, Task};

pub(crate) use crate::contact::WORLD;
pub(crate) use ball::Ball;
pub use dof::Dof;
pub(crate) use free::Free;
pub use link::Link;
pub(crate) use link::Shift;
pub(crate) use prismatic::Prismatic;
pub(crate) use revolute::Revolute;
pub(crate) use screw::Screw;
pub use sincro_actuation::Friction;

use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, RigidInertia, Vec3};

/// Kind of a joint with its axes, in the joint's frame; an axis may have any length but zero. Argument of
/// [`JointSpec::new`](crate::model::JointSpec::new).
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// let mut builder = ModelBuilder::new([0.0; 3]);
/// let planar = builder.joint("planar", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Planar));
/// let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// builder.body("puck", planar, Pose::identity(), BodySpec { mass });
/// // 5 mm forward each turn
/// let screw = JointKind::Screw { axis: [0.0, 0.0, 1.0], pitch: 0.005 / std::f64::consts::TAU };
/// let screw = builder.joint("screw", NodeId::WORLD, Pose::identity(), JointSpec::new(screw));
/// builder.body("nut", screw, Pose::identity(), BodySpec { mass });
/// let (model, _warnings) = builder.build()?;
/// let n_v = |name: &str| model.names().joint(name).unwrap().n_v;
/// assert_eq!((n_v("planar"), n_v("screw"), model.n_v()), (3, 1, 4));
/// # Ok::<(), BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind {
    /// Rigid connection without coordinates.
    Fixed,
    /// Rotation about `axis`. Coordinate: angle `[rad]`, unbounded.
    Revolute {
        /// Axis of rotation, joint frame.
        axis: [f64; 3],
    },
    /// Translation along `axis`. Coordinate: displacement `[m]`.
    Prismatic {
        /// Direction of translation, joint frame.
        axis: [f64; 3],
    },
    /// Rotation about `axis` with a translation of `pitch` along it. Coordinate: angle `[rad]`.
    Screw {
        /// Axis of the screw, joint frame.
        axis: [f64; 3],
        /// Translation over rotation `[m/rad]`.
        pitch: f64,
    },
    /// Rotation about `axis`, then about `axis2`, which the first one carries. Coordinates: the two angles `[rad]`.
    Universal {
        /// First axis, fixed in the parent, joint frame.
        axis: [f64; 3],
        /// Second axis, in the joint frame at zero angles.
        axis2: [f64; 3],
    },
    /// Any rotation. Coordinates: unit quaternion (w, x, y, z) of the child in the parent; rates: angular velocity of
    /// the child against the parent in child axes [rad/s].
    Ball,
    /// Translation along x and y of the joint frame and rotation about z. Coordinates: x, y `[m]`, angle `[rad]`.
    Planar,
    /// Six degrees of freedom. Coordinates: position of the child's joint frame `[m]`, unit quaternion (w, x, y, z);
    /// rates: angular [rad/s] then linear velocity [m/s] of that frame against the parent, both in child axes.
    Free,
}

/// Kind of a stage, as the compiled model stores it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
#[allow(missing_docs)]
pub(crate) enum StageKind {
    RevoluteX,
    RevoluteY,
    RevoluteZ,
    Prismatic,
    Screw,
    Ball,
    Free,
}

/// Configuration of one stage, computed once a kinematic pass.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Placement<R> {
    /// Sine of the joint angle (axis-aligned stages).
    pub sin: R,
    /// Cosine of the joint angle (axis-aligned stages).
    pub cos: R,
    /// Link to base rotation (ball and free only).
    pub rot: Mat3<R>,
    /// Origin of the link frame in the parent's axes (stages that translate only) `[m]`.
    pub offset: Vec3<R>,
}

/// Operations of a stage. Zero-sized types implement it; `match` on [`StageKind`] chooses among them.
pub(crate) trait Stage {
    /// Coordinates that the stage takes in q.
    const N_Q: usize;
    /// Degrees of freedom, places in v.
    const N_V: usize;

    /// Computes the configuration from the stage's coordinates `q` (`N_Q` of them); writes only what the stage's other
    /// operations read.
    fn place<R: Real>(link: &Link<R>, q: &[R], at: &mut Placement<R>);

    /// Origin of the link frame in the parent's axes, from the parent's origin `[m]`.
    fn offset<R: Real>(link: &Link<R>, at: &Placement<R>) -> Vec3<R>;

    /// Components of a vector from link to base axes.
    fn turn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R>;

    /// Components of a vector from base to link axes.
    fn unturn<R: Real>(at: &Placement<R>, x: Vec3<R>) -> Vec3<R>;

    /// An articulated inertia from link to base axes.
    fn turn_articulated<R: Real>(at: &Placement<R>, ia: &ArticulatedInertia<R>) -> ArticulatedInertia<R>;

    /// A rigid inertia from link to base axes.
    fn turn_rigid<R: Real>(at: &Placement<R>, i: &RigidInertia<R>) -> RigidInertia<R>;

    /// The whole rotation link to base.
    fn rotation<R: Real>(at: &Placement<R>) -> Mat3<R>;

    /// Column `j` of the motion subspace, in link axes, times `rate`.
    fn column<R: Real>(link: &Link<R>, j: usize, rate: R) -> Motion<R>;

    /// Generalised force of wrench `f` on degree of freedom `j`: `S_jᵀ f`.
    fn project<R: Real>(link: &Link<R>, j: usize, f: &Force<R>) -> R;

    /// `IA · S_j`.
    fn inertia_column<R: Real>(link: &Link<R>, j: usize, ia: &ArticulatedInertia<R>) -> Force<R>;

    /// `ia − u·kuᵀ` in the columns of the degrees of freedom before `j`: at the root nobody needs the others.
    #[inline(always)]
    fn minus_outer_before<R: Real>(
        ia: &ArticulatedInertia<R>,
        u: &Force<R>,
        ku: &Force<R>,
        _j: usize,
    ) -> ArticulatedInertia<R> {
        ia.minus_outer(u, ku)
    }

    /// Velocity product `c = v × v_J` of a link that moves with `v`, `v_J = S q̇` of it in its joint.
    #[inline(always)]
    fn velocity_product<R: Real>(v: &Motion<R>, v_joint: &Motion<R>) -> Motion<R> {
        v.cross(v_joint)
    }

    /// `IA · c` for the velocity product `c = v × S q̇`.
    #[inline(always)]
    fn inertia_times_bias<R: Real>(ia: &ArticulatedInertia<R>, c: &Motion<R>) -> Force<R> {
        ia.mul(c)
    }
}

/// A computation that is compiled once for each kind of stage.
pub(crate) trait StageVisitor {
    /// Numbers computed with.
    type Number: Real;
    /// Result type.
    type Output;

    /// Runs for stage type `S`.
    fn visit<S: Stage>(self) -> Self::Output;
}

/// A visitor of the stage type `S`, as a part of a task.
struct Visit<V, S>(V, PhantomData<S>);

impl<V: StageVisitor, S: Stage> Task for Visit<V, S> {
    type Output = V::Output;

    #[inline(always)]
    fn run(self) -> V::Output {
        self.0.visit::<S>()
    }
}

impl StageKind {
    /// Runs `visitor` for this kind.
    #[inline(always)]
    pub(crate) fn dispatch<V: StageVisitor>(self, visitor: V) -> V::Output {
        match self {
            Self::RevoluteX => V::Number::run_part(Visit::<V, Revolute<0>>(visitor, PhantomData)),
            Self::RevoluteY => V::Number::run_part(Visit::<V, Revolute<1>>(visitor, PhantomData)),
            Self::RevoluteZ => V::Number::run_part(Visit::<V, Revolute<2>>(visitor, PhantomData)),
            Self::Prismatic => V::Number::run_part(Visit::<V, Prismatic>(visitor, PhantomData)),
            Self::Screw => V::Number::run_part(Visit::<V, Screw>(visitor, PhantomData)),
            Self::Ball => V::Number::run_part(Visit::<V, Ball>(visitor, PhantomData)),
            Self::Free => V::Number::run_part(Visit::<V, Free>(visitor, PhantomData)),
        }
    }

    /// Coordinates in q.
    #[must_use]
    pub fn n_q(self) -> usize {
        match self {
            Self::Ball => Ball::N_Q,
            Self::Free => Free::N_Q,
            _ => 1,
        }
    }

    /// Degrees of freedom.
    #[must_use]
    pub fn n_v(self) -> usize {
        match self {
            Self::Ball => Ball::N_V,
            Self::Free => Free::N_V,
            _ => 1,
        }
    }

    /// Returns true if the link's origin stays where its base frame is.
    #[must_use]
    pub fn is_pure_rotation(self) -> bool {
        matches!(self, Self::RevoluteX | Self::RevoluteY | Self::RevoluteZ | Self::Ball)
    }
}

/// Turns `x` about coordinate axis `A`.
#[inline(always)]
fn turn_about<const A: usize, R: Real>(sin: R, cos: R, x: Vec3<R>) -> Vec3<R> {
    let (b, c) = ((A + 1) % 3, (A + 2) % 3);
    let mut y = x;
    y[b] = cos * x[b] - sin * x[c];
    y[c] = sin * x[b] + cos * x[c];
    y
}

/// A rigid inertia turned about coordinate axis `A`.
#[inline(always)]
fn turn_rigid_about<const A: usize, R: Real>(sin: R, cos: R, i: &RigidInertia<R>) -> RigidInertia<R> {
    RigidInertia {
        mass: i.mass,
        moment: turn_about::<A, R>(sin, cos, i.moment),
        rotational: i.rotational.rotated::<A>(sin, cos),
    }
}
