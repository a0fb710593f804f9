//! Inverse kinematics as CoppeliaSim's `simIK` offers it: groups of elements, each of which brings a tip to a target.
//!
//! An iteration moves the joints between base and tip by damped least squares,
//!
//! ```text
//! Δq = Jᵀ·(J·Jᵀ + λ²·I)⁻¹·e          (key `wampler1986`)
//! ```
//!
//! with e the weighted errors of position `[m]` and orientation `[rad]`, in world axes, each joint at most 0.2 rad or
//! 0.1 m an iteration and within its limits. An environment has the objects of the scene, with their handles; of its
//! own it has positions of joints, from a calculation or setting until the scene is taken over again. Searches, which
//! move nothing, are in `ik_search.rs`.

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::spatial::{Pose, Vec3, rotation_between};
use sincro_math::elementary::atan2;
use sincro_math::least_squares::damped_step;
use sincro_scene::inverse_kinematics::{LEAST_DAMPING, MAX_ROTATION_STEP, MAX_TRANSLATION_STEP};

use std::collections::{BTreeMap, BTreeSet};

use super::registry::Handle;
use super::{ApiError, Phase, SimApi};
use sincro_conventions::ik_objects::OwnObjects;

/// Environments, groups in one.
const MAX_COUNT: usize = 32;
/// Elements in a group: with them and the iterations the longest call takes less than a second.
const MAX_ELEMENTS: usize = 16;
/// Iterations that may be asked for.
const MAX_ITERATIONS: i64 = 1_000;

/// Bit of the constraint on the position along x; combined with others in the constraints of an element.
pub(crate) const X: i64 = 1;
/// Bit of the constraint on the position along y.
pub(crate) const Y: i64 = 2;
/// Bit of the constraint on the position along z.
pub(crate) const Z: i64 = 4;
/// The z axis of the tip is that of the target.
pub(crate) const ALPHA_BETA: i64 = 8;
/// With it, x and y axes are, too.
pub(crate) const GAMMA: i64 = 16;

/// Groups that are solved together with nothing else.
#[derive(Clone, Debug, Default)]
pub(crate) struct Environment {
    groups: Vec<Group>,
    /// Positions of joints that differ from those of the scene `[rad]` or `[m]`.
    pub(super) positions: BTreeMap<Handle, f64>,
    /// Joints that no group moves.
    pub(super) passive: BTreeSet<Handle>,
    /// Dummies and joints that are not of the scene.
    pub(super) own: OwnObjects,
}

impl Environment {
    /// Gives all elements with a tip another target.
    pub(super) fn set_targets(&mut self, tip: Handle, target: Handle) {
        let elements = self.groups.iter_mut().flat_map(|group| &mut group.elements);
        elements.filter(|element| element.tip == tip).for_each(|element| element.target = target);
    }
}

/// Elements that are solved together.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    /// Empty for none.
    name: String,
    /// λ; 0 for the pseudo-inverse.
    pub(super) damping: f64,
    pub(super) iterations: usize,
    pub(super) elements: Vec<Element>,
    /// False if it is not calculated.
    pub(super) is_enabled: bool,
    /// True if joints move as far as they need in one iteration.
    pub(super) has_free_steps: bool,
    /// True if scripts and clients solve it; false if each step of theirs does.
    pub(super) is_explicit: bool,
}

/// A tip and its target.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    /// Base of the chain; none: the world.
    pub base: Option<Handle>,
    /// Tip of the chain (end effector).
    pub tip: Handle,
    /// Target of the tip.
    pub target: Handle,
    /// Constraints between tip and target, as a set of bits.
    pub constraints: i64,
    /// `[m]`, `[rad]`.
    pub precision: [f64; 2],
    /// Weights of position and orientation.
    pub weights: [f64; 2],
    /// Object whose axes the constraints are meant in; none: the base.
    pub axes_of: Option<Handle>,
    /// False if it is left out.
    pub is_enabled: bool,
    /// Pose that takes the place of the target's.
    pub(super) goal: Option<Pose<f64>>,
}

impl Element {
    /// An element with the precision `[m]`, `[rad]` and weights that CoppeliaSim begins with.
    #[must_use]
    pub(crate) fn new(base: Option<Handle>, tip: Handle, target: Handle, constraints: i64) -> Self {
        let precision = [0.0005, 0.1 * std::f64::consts::PI / 180.0];
        let (weights, axes_of) = ([1.0; 2], None);
        Self { base, tip, target, constraints, precision, weights, axes_of, is_enabled: true, goal: None }
    }
}

/// Result of solving a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    /// True if all elements are within their precision.
    pub is_reached: bool,
    /// True if a joint ended at a limit.
    pub hit_limit: bool,
    /// Largest errors left `[m]`, `[rad]`.
    pub errors: [f64; 2],
}

/// A joint that is moved.
#[derive(Clone)]
pub(super) struct IkJoint {
    pub handle: Handle,
    /// Place in the state; none for a joint of the environment's own.
    pub q_idx: Option<usize>,
    pub is_sliding: bool,
    pub bounds: [f64; 2],
}

impl SimApi<'_> {
    /// A new environment; its number.
    ///
    /// # Errors
    ///
    /// There are too many.
    pub(crate) fn create_environment(&mut self) -> Result<usize, ApiError> {
        let free =
            self.registry.environments.iter().position(Option::is_none).unwrap_or(self.registry.environments.len());
        if free >= MAX_COUNT {
            return Err(ApiError(format!("there are {MAX_COUNT} environments already: erase some")));
        }
        if free == self.registry.environments.len() {
            self.registry.environments.push(None);
        }
        self.registry.environments[free] = Some(Environment { own: OwnObjects::new(free), ..Environment::default() });
        Ok(free)
    }

    /// Forgets an environment.
    ///
    /// # Errors
    ///
    /// There is none of that number.
    pub(crate) fn erase_environment(&mut self, environment: i64) -> Result<(), ApiError> {
        self.environment(environment)?;
        self.registry.environments[environment as usize] = None;
        Ok(())
    }

    pub(super) fn environment(&mut self, number: i64) -> Result<&mut Environment, ApiError> {
        let k = usize::try_from(number).ok();
        let found = k.and_then(|k| self.registry.environments.get_mut(k)?.as_mut());
        found.ok_or_else(|| ApiError(format!("there is no environment {number}")))
    }

    /// A new group; its number.
    ///
    /// # Errors
    ///
    /// There is no such environment, it has too many, or one of the name (empty for none).
    pub(crate) fn create_group(&mut self, environment: i64, name: &str) -> Result<usize, ApiError> {
        let groups = &mut self.environment(environment)?.groups;
        if groups.len() >= MAX_COUNT {
            return Err(ApiError(format!("there are {MAX_COUNT} groups already")));
        }
        if !name.is_empty() && (name.len() > 100 || groups.iter().any(|group| group.name == name)) {
            return Err(ApiError(format!("a group has a name of its own of up to 100 bytes, not `{name:.100}`")));
        }
        // CoppeliaSim's: the pseudo-inverse, three iterations
        groups.push(Group {
            name: name.to_owned(),
            damping: 0.0,
            iterations: 3,
            elements: Vec::new(),
            is_enabled: true,
            has_free_steps: false,
            is_explicit: true,
        });
        Ok(groups.len() - 1)
    }

    /// Environment and number of the group of a name, in an environment or in any.
    ///
    /// # Errors
    ///
    /// There is none.
    pub(crate) fn group_of_name(&self, environment: Option<i64>, name: &str) -> Result<(i64, i64), ApiError> {
        self.named_groups()
            .find(|(e, _, known)| environment.is_none_or(|wanted| wanted == *e) && *known == name)
            .map(|(e, group, _)| (e, group))
            .ok_or_else(|| {
                let help = "groups have the names that simIK.createGroup gives them";
                ApiError(format!("there is no group `{name:.100}` of inverse kinematics: {help}"))
            })
    }

    /// Environment, number and name of all groups with names.
    pub(crate) fn named_groups(&self) -> impl Iterator<Item = (i64, i64, &str)> {
        let environments = self.registry.environments.iter().enumerate();
        let groups = environments.flat_map(|(e, environment)| {
            environment.iter().flat_map(move |environment| {
                environment.groups.iter().enumerate().map(move |(k, group)| (e as i64, k as i64, group.name.as_str()))
            })
        });
        groups.filter(|(_, _, name)| !name.is_empty())
    }

    pub(super) fn group(&mut self, environment: i64, number: i64) -> Result<&mut Group, ApiError> {
        let groups = &mut self.environment(environment)?.groups;
        let found = usize::try_from(number).ok().and_then(|k| groups.get_mut(k));
        found.ok_or_else(|| ApiError(format!("there is no group {number} in the environment")))
    }

    /// Sets the damping λ of the least-squares solution of a group (0: pseudo-inverse), dimensionless, and the limit of
    /// its iterations `n`.
    ///
    /// # Errors
    ///
    /// There is no such group, or a number makes no sense.
    pub(crate) fn set_calculation(
        &mut self,
        environment: i64,
        group: i64,
        damping: f64,
        n: i64,
    ) -> Result<(), ApiError> {
        if !(damping.is_finite() && damping >= 0.0 && (1..=MAX_ITERATIONS).contains(&n)) {
            let expected = format!("damping 0 or more, 1 to {MAX_ITERATIONS} iterations");
            return Err(ApiError(format!("damping {damping} and {n} iterations, expected {expected}")));
        }
        let group = self.group(environment, group)?;
        (group.damping, group.iterations) = (damping, n as usize);
        Ok(())
    }

    /// Adds an element to a group; its number.
    ///
    /// # Errors
    ///
    /// There is no such group or object, no joint lies between base and tip, or the constraints make no sense.
    pub(crate) fn add_element(&mut self, environment: i64, group: i64, element: Element) -> Result<usize, ApiError> {
        self.ik_pose(element.tip)?;
        self.ik_pose(element.target)?;
        self.check_element(&element)?;
        let elements = &mut self.group(environment, group)?.elements;
        if elements.len() >= MAX_ELEMENTS {
            return Err(ApiError(format!("there are {MAX_ELEMENTS} elements already")));
        }
        elements.push(element);
        Ok(elements.len() - 1)
    }

    /// Refuses constraints that make no sense, and a chain without joints.
    pub(super) fn check_element(&self, element: &Element) -> Result<(), ApiError> {
        let bits = element.constraints;
        if !(1..32).contains(&bits) || bits & (ALPHA_BETA | GAMMA) == GAMMA {
            let known = "x 1, y 2, z 4, alpha_beta 8, and with that gamma 16";
            return Err(ApiError(format!("constraints {bits}, expected a sum of {known}")));
        }
        if self.ik_joints(std::slice::from_ref(element))?.is_empty() {
            return Err(ApiError::new("no joint that turns or slides lies between base and tip"));
        }
        Ok(())
    }

    /// Element `number` of a group, counted from 0: a tip and the target that it is to reach.
    ///
    /// # Errors
    ///
    /// There is no such environment, group or element.
    pub(crate) fn element(&mut self, environment: i64, group: i64, number: i64) -> Result<&mut Element, ApiError> {
        let elements = &mut self.group(environment, group)?.elements;
        let found = usize::try_from(number).ok().and_then(|k| elements.get_mut(k));
        found.ok_or_else(|| ApiError(format!("there is no element {number} in the group")))
    }

    /// Solves a group. With `apply` it starts from the scene, and if it is reached, or `allow_error`, joints with a
    /// motor in position or spring mode get it as their target while a run is on, all others are put there. Without, it
    /// starts from the environment, which keeps the result. A group that is not enabled gives none.
    ///
    /// # Errors
    ///
    /// There is no such group, it has no elements, or an object of it was removed.
    pub(crate) fn handle_group(
        &mut self,
        environment: i64,
        group: i64,
        (apply, allow_error): (bool, bool),
    ) -> Result<Option<Outcome>, ApiError> {
        if !self.group(environment, group)?.is_enabled {
            return Ok(None);
        }
        if apply {
            self.environment(environment)?.positions.clear();
        }
        let (outcome, found) = self.solve_group(environment, group)?;
        match apply {
            true if outcome.is_reached || allow_error => {
                found.into_iter().try_for_each(|(joint, q)| self.apply(joint, q))?;
            }
            true => {}
            false => found.into_iter().try_for_each(|(joint, q)| self.keep_position(environment, joint, q))?,
        }
        Ok(Some(outcome))
    }

    /// Sets whether scripts and clients solve a group, as from the start, or each step of theirs does, after the
    /// scripts have acted.
    ///
    /// # Errors
    ///
    /// There is no such group.
    pub(crate) fn set_group_explicit(&mut self, environment: i64, group: i64, explicit: bool) -> Result<(), ApiError> {
        self.group(environment, group)?.is_explicit = explicit;
        Ok(())
    }

    /// Returns true if scripts and clients solve a group.
    ///
    /// # Errors
    ///
    /// There is no such group.
    pub(crate) fn is_group_explicit(&mut self, environment: i64, group: i64) -> Result<bool, ApiError> {
        Ok(self.group(environment, group)?.is_explicit)
    }

    /// Solves the groups that the step solves, and moves their joints, also if not all is reached.
    ///
    /// # Errors
    ///
    /// The first group that cannot be solved: an object of it was removed, say.
    pub(crate) fn handle_implicit_groups(&mut self) -> Result<(), ApiError> {
        if self.registry.switched_off.contains(&sincro_conventions::simulator::IK_HANDLING) {
            return Ok(());
        }
        let environments = self.registry.environments.iter().enumerate();
        let implicit = environments.flat_map(|(e, environment)| {
            let groups = environment.iter().flat_map(|environment| environment.groups.iter().enumerate());
            groups.filter(|(_, group)| !group.is_explicit).map(move |(k, _)| (e as i64, k as i64))
        });
        for (environment, group) in implicit.collect::<Vec<_>>() {
            self.handle_group(environment, group, (true, true))?;
        }
        Ok(())
    }

    /// Takes the positions of an environment over to the scene, as [`SimApi::handle_group`] does.
    ///
    /// # Errors
    ///
    /// There is no such environment, or a joint of it was removed.
    pub(crate) fn sync_to_scene(&mut self, environment: i64) -> Result<(), ApiError> {
        let positions = std::mem::take(&mut self.environment(environment)?.positions);
        positions.into_iter().try_for_each(|(joint, q)| self.apply(joint, q))
    }

    /// Takes the positions of the scene over to an environment.
    ///
    /// # Errors
    ///
    /// There is no such environment.
    pub(crate) fn sync_from_scene(&mut self, environment: i64) -> Result<(), ApiError> {
        self.environment(environment)?.positions.clear();
        Ok(())
    }

    /// Solves a group and moves nothing: how it went, and where each of its joints would be.
    ///
    /// # Errors
    ///
    /// As [`SimApi::handle_group`].
    pub(crate) fn solve_group(
        &mut self,
        environment: i64,
        group: i64,
    ) -> Result<(Outcome, Vec<(Handle, f64)>), ApiError> {
        let group = self.enabled(environment, group)?;
        self.inside(environment, &group, |sim, ik_joints| {
            let outcome = sim.solve(&group, ik_joints)?;
            Ok((outcome, ik_joints.iter().map(|m| (m.handle, sim.position_of(m))).collect()))
        })
    }

    /// A group with those of its elements that are enabled.
    pub(super) fn enabled(&mut self, environment: i64, group: i64) -> Result<Group, ApiError> {
        let mut group = self.group(environment, group)?.clone();
        group.elements.retain(|element| element.is_enabled);
        if group.elements.is_empty() {
            return Err(ApiError::new("the group has no elements"));
        }
        Ok(group)
    }

    /// Acts with the joints at the positions of an environment, then puts them back; given are those that a group
    /// moves.
    pub(super) fn inside<T>(
        &mut self,
        environment: i64,
        group: &Group,
        act: impl FnOnce(&mut Self, &[IkJoint]) -> Result<T, ApiError>,
    ) -> Result<T, ApiError> {
        let Environment { positions, passive, own, .. } = self.environment(environment)?.clone();
        let mut ik_joints = self.ik_joints(&group.elements)?;
        ik_joints.retain(|m| !passive.contains(&m.handle));
        let before = self.world.state.q.clone();
        for (joint, q) in positions {
            let q_idx = self.registry.joint(joint)?.q_idx;
            self.world.state.q[q_idx] = q;
        }
        self.moved();
        let done = act(self, &ik_joints);
        self.world.state.q.copy_from_slice(&before);
        self.environment(environment)?.own = own;
        self.moved();
        done
    }

    pub(super) fn put(&mut self, ik_joints: &[IkJoint], q: &[f64]) {
        ik_joints.iter().zip(q).for_each(|(ik_joint, q)| self.set_position_of(ik_joint, *q));
        self.moved();
    }

    /// A motor in position or spring mode gets it as its target while a run is on; any other joint is put there.
    pub(super) fn apply(&mut self, joint: Handle, q: f64) -> Result<(), ApiError> {
        use sincro_dynamics::actuation::MotorMode::{Position, Spring};
        if let Some(own) = self.own_object_mut(joint).and_then(|object| object.joint.as_mut()) {
            own.position = q;
            return Ok(());
        }
        let has_target = matches!(self.driving_mode(joint)?, Position | Spring);
        if self.registry.phase != Phase::Stopped && has_target {
            return self.set_target_position(joint, q);
        }
        self.set_joint_position(joint, q)
    }

    /// The joints between bases and tips, each once.
    pub(super) fn ik_joints(&self, elements: &[Element]) -> Result<Vec<IkJoint>, ApiError> {
        let mut ik_joints: Vec<IkJoint> = Vec::new();
        for element in elements {
            let mut at = Some(element.tip);
            while let Some(handle) = at.filter(|handle| Some(*handle) != element.base) {
                at = self.ik_parent(handle, element.base)?;
                if let Some(own) = self.own_object(handle) {
                    let Some(joint) = own.joint.filter(|_| ik_joints.iter().all(|m| m.handle != handle)) else {
                        continue;
                    };
                    let free = [f64::NEG_INFINITY, f64::INFINITY];
                    let bounds = joint.interval.map_or(free, |[low, range]| [low, low + range]);
                    ik_joints.push(IkJoint { handle, q_idx: None, is_sliding: joint.is_sliding, bounds });
                    continue;
                }
                let Ok(joint) = self.registry.joint(handle) else { continue };
                let is_sliding = matches!(joint.kind, JointKind::Prismatic { .. });
                let is_turning = matches!(joint.kind, JointKind::Revolute { .. });
                if !(is_sliding || is_turning) || ik_joints.iter().any(|m| m.handle == handle) {
                    continue;
                }
                let bounds = match self.joint_interval(handle)? {
                    (true, _) => [f64::NEG_INFINITY, f64::INFINITY],
                    (false, [low, range]) if low.is_finite() => [low, low + range],
                    (false, _) => [f64::NEG_INFINITY, f64::INFINITY],
                };
                ik_joints.push(IkJoint { handle, q_idx: Some(joint.q_idx), is_sliding, bounds });
            }
            if at != element.base {
                return Err(ApiError::new("the base carries the tip of no element: it must be one of its ancestors"));
            }
        }
        Ok(ik_joints)
    }

    /// Iterates; the state is left where the last iteration put it.
    pub(super) fn solve(&mut self, group: &Group, ik_joints: &[IkJoint]) -> Result<Outcome, ApiError> {
        let mut hit_limit = false;
        for iteration in 0..=group.iterations {
            let (errors, is_reached) = self.errors(&group.elements)?;
            if is_reached || iteration == group.iterations {
                return Ok(Outcome { is_reached, hit_limit, errors });
            }
            let (rows, e) = self.rows(&group.elements, ik_joints)?;
            let damping = (group.damping * group.damping).max(LEAST_DAMPING);
            let Some(changes) = damped_step(&rows, &e, damping) else {
                return Err(ApiError::new("the group cannot be solved: its equations are not finite"));
            };
            hit_limit = false;
            for (ik_joint, change) in ik_joints.iter().zip(changes) {
                let most = if group.has_free_steps {
                    f64::INFINITY
                } else if ik_joint.is_sliding {
                    MAX_TRANSLATION_STEP
                } else {
                    MAX_ROTATION_STEP
                };
                let wanted = self.position_of(ik_joint) + change.clamp(-most, most);
                let q = wanted.clamp(ik_joint.bounds[0], ik_joint.bounds[1]);
                hit_limit |= q != wanted;
                self.set_position_of(ik_joint, q);
            }
            self.moved();
        }
        unreachable!("the last iteration returns")
    }

    /// Poses of tip and target.
    pub(super) fn ends(&mut self, element: &Element) -> Result<[Pose<f64>; 2], ApiError> {
        let tip = self.ik_pose(element.tip)?;
        let target = element.goal.map_or_else(|| self.ik_pose(element.target), Ok)?;
        Ok([tip, target])
    }

    /// Largest errors of position and orientation, and whether all are within their precision.
    fn errors(&mut self, elements: &[Element]) -> Result<([f64; 2], bool), ApiError> {
        let (mut errors, mut is_reached) = ([0.0_f64; 2], true);
        for element in elements {
            let [tip, target] = self.ends(element)?;
            let frame = self.axes(element)?;
            let linear = masked(element, frame.transpose().mul_vec(target.pos - tip.pos)).norm();
            let angular = turn(element, &tip, &target).norm();
            is_reached &= linear <= element.precision[0] && angular <= element.precision[1];
            errors = [errors[0].max(linear), errors[1].max(angular)];
        }
        Ok((errors, is_reached))
    }

    /// The axes in which x, y and z are meant: the base's.
    fn axes(&mut self, element: &Element) -> Result<sincro_dynamics::spatial::Mat3<f64>, ApiError> {
        let Some(base) = element.axes_of.or(element.base) else {
            return Ok(sincro_dynamics::spatial::Mat3::identity());
        };
        Ok(self.ik_pose(base)?.rot)
    }

    /// Rows of the weighted Jacobian, a column for each joint, and the weighted errors.
    pub(super) fn rows(
        &mut self,
        elements: &[Element],
        ik_joints: &[IkJoint],
    ) -> Result<(Vec<Vec<f64>>, Vec<f64>), ApiError> {
        let (mut rows, mut e) = (Vec::new(), Vec::new());
        for element in elements {
            let [tip, target] = self.ends(element)?;
            let frame = self.axes(element)?.transpose();
            let chain = self.ik_joints(std::slice::from_ref(element))?;
            let mut columns = Vec::with_capacity(ik_joints.len());
            for ik_joint in ik_joints {
                if !chain.iter().any(|m| m.handle == ik_joint.handle) {
                    columns.push((Vec3::zero(), Vec3::zero()));
                    continue;
                }
                let joint = self.ik_pose(ik_joint.handle)?;
                let axis = joint.rot.col(2);
                columns.push(match ik_joint.is_sliding {
                    true => (axis, Vec3::zero()),
                    false => (axis.cross(tip.pos - joint.pos), axis),
                });
            }
            let [position, orientation] = element.weights;
            let miss = frame.mul_vec(target.pos - tip.pos);
            for k in (0..3).filter(|k| element.constraints & [X, Y, Z][*k] != 0) {
                rows.push(columns.iter().map(|(linear, _)| position * frame.mul_vec(*linear)[k]).collect());
                e.push(position * miss[k]);
            }
            if element.constraints & ALPHA_BETA != 0 {
                let error = turn(element, &tip, &target);
                // without gamma the tip may turn about its own z
                let z = tip.rot.col(2);
                let free = if element.constraints & GAMMA == 0 { 1.0 } else { 0.0 };
                for k in 0..3 {
                    let rate = |(_, w): &(Vec3<f64>, Vec3<f64>)| w[k] - free * z[k] * z.dot(*w);
                    rows.push(columns.iter().map(|column| orientation * rate(column)).collect());
                    e.push(orientation * error[k]);
                }
            }
        }
        Ok((rows, e))
    }
}

/// The components that are to agree.
fn masked(element: &Element, v: Vec3<f64>) -> Vec3<f64> {
    let of = |k: usize, bit: i64| if element.constraints & bit == 0 { 0.0 } else { v[k] };
    Vec3([of(0, X), of(1, Y), of(2, Z)])
}

/// Axis times angle of the turn that the tip still has to make `[rad]`, world axes.
fn turn(element: &Element, tip: &Pose<f64>, target: &Pose<f64>) -> Vec3<f64> {
    match (element.constraints & ALPHA_BETA != 0, element.constraints & GAMMA != 0) {
        (false, _) => Vec3::zero(),
        (true, true) => rotation_between(&tip.rot, &target.rot),
        (true, false) => {
            let (from, to) = (tip.rot.col(2), target.rot.col(2));
            let cross = from.cross(to);
            along(cross, cross.norm(), atan2(cross.norm(), from.dot(to)).0)
        }
    }
}

/// A direction with another length; zero if it has none.
fn along(v: Vec3<f64>, norm: f64, length: f64) -> Vec3<f64> {
    if norm == 0.0 { Vec3::zero() } else { v.scale(length / norm) }
}
