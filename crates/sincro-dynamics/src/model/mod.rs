//! The compiled model: immutable, flat, shared by every world that has it.
//!
//! [`ModelBuilder`] takes the tree as the user names it; [`ModelBuilder::build`] checks everything, reports all problems at
//! once and compiles: fixed joints and bodies hung on bodies are merged into *links*, universal and planar joints become
//! chains of one-degree-of-freedom stages, and every link frame is chosen parallel to its parent's (at q = 0) with the
//! joint's axis on a coordinate axis wherever the geometry allows, because that is what the recursions do fastest.
//! [`Names`] keeps the way back from the user's objects to links and coordinates.

pub(crate) mod builder;
pub(crate) mod diagnostic;
pub(crate) mod names;
mod pack;
pub(crate) mod parameters;

use std::sync::Arc;

use sincro_math::Real;

pub use crate::geometry::{MassProperties, Shape};
pub use builder::{
    BodySpec, ClosureSpec, CouplingSpec, DragSpec, ForceSpec, JointSpec, ModelBuilder, NodeId, REST_SPEED, RotorDrive,
    RotorSpec,
};
pub use diagnostic::{Problem, Severity};
pub use names::{FrameInfo, JointInfo, Names, SensorInfo};
pub use pack::PackError;

use crate::actuation::drive::Drive;
use crate::actuation::{AppliedTorque, AppliedWrench, Motor};
use crate::aero::AirDrag;
use crate::aero::rotor::MountedRotor;
use crate::aero::wind::Wind;
use crate::constraint::ConstraintSet;
use crate::joint::{Placement, Stage, StageKind};
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, RigidInertia, Vec3};

/// No parent: the link moves against the world.
pub(crate) const WORLD: u32 = u32::MAX;

/// How a link's origin lies off its parent's: products by zero are not computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shift {
    /// It does not.
    None,
    /// Along the parent's x axis.
    X,
    /// Along the parent's y axis.
    Y,
    /// Along the parent's z axis.
    Z,
    /// Anywhere.
    Any,
}

/// One moving link and the stage that joins it to its parent.
#[derive(Clone, Copy, Debug)]
pub struct Link<R> {
    pub(crate) parent: u32,
    pub(crate) kind: StageKind,
    /// Whether `base_rotation` is not the identity.
    pub(crate) turned: bool,
    /// Where the link's origin can lie off its parent's.
    pub(crate) shift: Shift,
    /// Whether other links hang on it.
    pub(crate) has_children: bool,
    /// Whether it is the first of its siblings that a tip-to-base pass meets.
    pub(crate) is_last_child: bool,
    /// First coordinate in q.
    pub(crate) q_idx: u32,
    /// First degree of freedom in v.
    pub(crate) v_idx: u32,
    /// Origin of the base frame in the parent link `[m]`.
    pub(crate) origin: Vec3<R>,
    /// Base to parent axes, if `turned`.
    pub(crate) base_rotation: Mat3<R>,
    /// +1, or −1 where the user's axis points against the coordinate axis: q_stage = sign·q.
    pub(crate) sign: R,
    /// Direction of a prismatic joint, parent axes.
    pub(crate) axis: Vec3<R>,
    /// Advance of a screw [m/rad].
    pub(crate) pitch: R,
    /// Of everything merged into the link, about its origin.
    pub(crate) inertia: RigidInertia<R>,
}

impl<R: Real> Link<R> {
    /// Components from base to parent axes.
    #[inline(always)]
    pub(crate) fn base_vector(&self, x: Vec3<R>) -> Vec3<R> {
        if self.turned { self.base_rotation.mul_vec(x) } else { x }
    }

    /// Index of the parent link, none for the world.
    #[inline(always)]
    pub fn parent(&self) -> Option<usize> {
        (self.parent != WORLD).then_some(self.parent as usize)
    }

    /// First degree of freedom in v of the stage that joins it to its parent.
    #[must_use]
    pub fn first_dof(&self) -> usize {
        self.v_idx as usize
    }

    /// Whether the link moves freely against its parent.
    pub fn is_free(&self) -> bool {
        self.kind == StageKind::Free
    }
}

/// Passive properties of one degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dof<R> {
    /// Reflected inertia [kg·m²] or `[kg]`.
    pub armature: R,
    /// Spring stiffness [N·m/rad] or [N/m].
    pub stiffness: R,
    /// Where the spring is at rest `[rad]` or `[m]`.
    pub rest: R,
    /// Viscous coefficient [N·m·s/rad] or [N·s/m].
    pub damping: R,
    /// Coulomb friction torque [N·m] or force `[N]`.
    pub friction: R,
    /// Constant applied torque [N·m] or force `[N]`.
    pub torque: R,
    /// Coordinate in q that this degree of freedom moves; `WORLD` for those of ball and free joints.
    pub(crate) q_idx: u32,
}

impl<R> Dof<R> {
    /// Index in q of the coordinate that this degree of freedom moves; none for those of ball and free joints.
    #[must_use]
    pub fn coordinate(&self) -> Option<usize> {
        (self.q_idx != WORLD).then_some(self.q_idx as usize)
    }
}

/// A compiled model. Numbers are of type `R`: one world's, or several worlds' packed into lanes ([`Model::pack`]).
#[derive(Clone, Debug)]
pub struct Model<R> {
    pub(crate) links: Vec<Link<R>>,
    pub(crate) dofs: Vec<Dof<R>>,
    pub(crate) gravity: Vec3<R>,
    pub(crate) motors: Vec<Motor<R>>,
    pub(crate) applied: Vec<AppliedTorque>,
    pub(crate) wrenches: Vec<AppliedWrench<R>>,
    pub(crate) rotors: Vec<MountedRotor<R>>,
    pub(crate) drags: Vec<AirDrag<R>>,
    pub(crate) wind: Option<Arc<Wind>>,
    pub(crate) drives: Vec<Drive>,
    pub(crate) constraints: Arc<ConstraintSet>,
    pub(crate) n_q: usize,
    pub(crate) names: Arc<Names>,
}

impl<R: Real> Model<R> {
    /// Number of coordinates (a quaternion has four).
    #[must_use]
    pub fn n_q(&self) -> usize {
        self.n_q
    }

    /// Number of degrees of freedom.
    #[must_use]
    pub fn n_v(&self) -> usize {
        self.dofs.len()
    }

    /// The moving links, parents before children.
    #[must_use]
    pub fn links(&self) -> &[Link<R>] {
        &self.links
    }

    /// Passive properties, one entry a degree of freedom.
    #[must_use]
    pub fn dofs(&self) -> &[Dof<R>] {
        &self.dofs
    }

    /// The motors, in the order of their commands.
    #[must_use]
    pub fn motors(&self) -> &[Motor<R>] {
        &self.motors
    }

    /// Number of commands: one a motor, then six (force `[N]`, torque [N·m]) for each external force that takes them, then one for each
    /// rotor that does not turn with a joint: its speed [rad/s].
    #[must_use]
    pub fn n_commands(&self) -> usize {
        let of_rotors = self.rotors.iter().filter(|r| r.speed.command().is_some()).count();
        self.motors.len() + 6 * self.names.inputs.len() + of_rotors
    }

    /// Number of states of rotors: [`crate::state::State::rotors`].
    #[must_use]
    pub fn n_rotor_states(&self) -> usize {
        self.rotors.iter().filter(|r| r.speed.state().is_some()).count()
    }

    /// The rotors.
    #[must_use]
    pub fn rotors(&self) -> &[MountedRotor<R>] {
        &self.rotors
    }

    /// The drag elements.
    #[must_use]
    pub fn drags(&self) -> &[AirDrag<R>] {
        &self.drags
    }

    /// The wind, if the air moves.
    #[must_use]
    pub fn wind(&self) -> Option<&Wind> {
        self.wind.as_deref()
    }

    /// Whether anything feels the air.
    pub(crate) fn feels_air(&self) -> bool {
        !self.rotors.is_empty() || !self.drags.is_empty()
    }

    /// The external forces on links, in the order in which they were added.
    #[must_use]
    pub fn wrenches(&self) -> &[AppliedWrench<R>] {
        &self.wrenches
    }

    /// Whether anything pushes on links from outside.
    pub(crate) fn has_external(&self) -> bool {
        !self.wrenches.is_empty() || self.feels_air()
    }

    /// Velocity motors and joints with Coulomb friction.
    #[must_use]
    pub fn drives(&self) -> &[Drive] {
        &self.drives
    }

    /// Closures, couplings, limits and contacts.
    #[must_use]
    pub fn constraints(&self) -> &ConstraintSet {
        &self.constraints
    }

    /// Number of drives.
    #[must_use]
    pub fn n_drives(&self) -> usize {
        self.drives.len()
    }

    /// Whether degree of freedom `dof` moves one coordinate of its own (not part of a ball or free joint).
    #[inline(always)]
    #[must_use]
    pub fn has_scalar_coordinate(&self, dof: usize) -> bool {
        self.dofs[dof].q_idx != WORLD
    }

    /// Whether there are ball or free joints. Without them coordinates and velocities match one to one.
    #[inline(always)]
    #[must_use]
    pub fn has_quaternions(&self) -> bool {
        self.n_q != self.dofs.len()
    }

    /// Mass of everything that moves `[kg]`.
    #[must_use]
    pub fn total_mass(&self) -> R {
        self.links.iter().fold(R::zero(), |sum, link| sum + link.inertia.mass)
    }

    /// Gravitational acceleration [m/s²], world axes.
    #[must_use]
    pub fn gravity(&self) -> Vec3<R> {
        self.gravity
    }

    /// Names sensors, each of which is a frame of the same name.
    ///
    /// # Panics
    ///
    /// If one of them is no frame.
    pub fn set_sensors(&mut self, sensors: Vec<SensorInfo>) {
        for sensor in &sensors {
            assert!(self.names.frame(&sensor.name).is_some(), "the sensor `{}` is no frame", sensor.name);
        }
        Arc::make_mut(&mut self.names).sensors = sensors;
    }

    /// The user's objects: joints, bodies, frames.
    #[must_use]
    pub fn names(&self) -> &Names {
        &self.names
    }
}

impl<R: Real> Model<R> {
    /// Applied torque [N·m] or force `[N]` on a degree of freedom at time `t` `[s]`.
    #[must_use]
    pub fn applied_torque(&self, dof: usize, t: f64) -> R {
        let signals = self.applied.iter().filter(|a| a.dof == dof).map(|a| a.torque::<R>(t));
        self.dofs[dof].torque + signals.fold(R::zero(), |sum, torque| sum + torque)
    }
}

impl Model<f64> {
    /// The first instant after `t` `[s]` at which an input signal or its slope jumps; infinite if there is none.
    #[must_use]
    pub fn next_corner(&self, t: f64) -> f64 {
        if self.applied.is_empty() && self.wrenches.is_empty() && self.wind.is_none() {
            return f64::INFINITY;
        }
        let of_wind = self.wind.as_ref().filter(|_| self.feels_air()).map_or(f64::INFINITY, |w| w.next_corner(t));
        let applied = self.applied.iter().flat_map(|a| &a.signal);
        let wrenches = self.wrenches.iter().flat_map(|w| w.force.iter().chain(&w.torque).flatten());
        applied.chain(wrenches).map(|s| s.next_corner(t)).fold(of_wind, f64::min)
    }
}

/// How motions and forces cross a joint.
impl<R: Real> Link<R> {
    /// A rate, acceleration or torque from the user's coordinate to the stage's, or back.
    #[inline(always)]
    pub(crate) fn signed<S: Stage>(&self, x: R) -> R {
        if S::N_V == 1 { self.sign * x } else { x }
    }

    /// A motion of the parent link as the motion of this link's origin, in link axes.
    #[inline(always)]
    pub(crate) fn motion_in_link<S: Stage>(&self, at: &Placement<R>, m: &Motion<R>) -> Motion<R> {
        let (mut ang, mut lin) = (m.ang, m.lin);
        let r = S::offset(self, at);
        match self.shift {
            Shift::None => {}
            Shift::X => lin += ang.cross_along::<0>(r[0]),
            Shift::Y => lin += ang.cross_along::<1>(r[1]),
            Shift::Z => lin += ang.cross_along::<2>(r[2]),
            Shift::Any => lin += ang.cross(r),
        }
        if self.turned {
            ang = self.base_rotation.tr_mul_vec(ang);
            lin = self.base_rotation.tr_mul_vec(lin);
        }
        Motion { ang: S::unturn(at, ang), lin: S::unturn(at, lin) }
    }

    /// A force on this link as the same force about the parent's origin, in parent axes.
    #[inline(always)]
    pub(crate) fn force_to_parent<S: Stage>(&self, at: &Placement<R>, f: &Force<R>) -> Force<R> {
        let mut ang = self.base_vector(S::turn(at, f.ang));
        let lin = self.base_vector(S::turn(at, f.lin));
        let r = S::offset(self, at);
        match self.shift {
            Shift::None => {}
            Shift::X => ang -= lin.cross_along::<0>(r[0]),
            Shift::Y => ang -= lin.cross_along::<1>(r[1]),
            Shift::Z => ang -= lin.cross_along::<2>(r[2]),
            Shift::Any => ang += r.cross(lin),
        }
        Force { ang, lin }
    }

    /// An articulated inertia of this link as seen at the parent's origin, in parent axes.
    #[inline(always)]
    pub(crate) fn articulated_to_parent<S: Stage>(
        &self,
        at: &Placement<R>,
        ia: &ArticulatedInertia<R>,
    ) -> ArticulatedInertia<R> {
        let mut ia = S::turn_articulated(at, ia);
        if self.turned {
            ia = ia.turned(&self.base_rotation);
        }
        let r = S::offset(self, at);
        match self.shift {
            Shift::None => ia,
            Shift::X => ia.shifted_along::<0>(r[0]),
            Shift::Y => ia.shifted_along::<1>(r[1]),
            Shift::Z => ia.shifted_along::<2>(r[2]),
            Shift::Any => ia.shifted(r),
        }
    }

    /// A rigid inertia of this link as seen at the parent's origin, in parent axes.
    #[inline(always)]
    pub(crate) fn rigid_to_parent<S: Stage>(&self, at: &Placement<R>, i: &RigidInertia<R>) -> RigidInertia<R> {
        let mut i = S::turn_rigid(at, i);
        if self.turned {
            i = i.turned(&self.base_rotation);
        }
        if self.shift == Shift::None { i } else { i.shifted(S::offset(self, at)) }
    }
}
