//! Load of bearings: the force that a joint transmits, where its friction grows with it.
//!
//! Friction with a load coefficient c has the limit F + c N ([`crate::joint::Friction`]). N is the constraint force of
//! the bearing: of a hinge the force of parent on child, of a slider its part across the axis. It follows from the
//! accelerations, which follow from the friction: both are found by fixed-point iteration, from no load in each
//! evaluation, so that they depend on the state alone. A step contracts with c ∂N/∂τ; where that is 1 or more the joint
//! jams: the evaluation gives no numbers, and a step at velocity level stops the joint.

use sincro_math::Real;

use super::Mechanism;
use crate::integrate::Implicit;
use crate::joint::{JointKind, WORLD};
use crate::model::Model;
use crate::recursions::kinematics;
use crate::scratch::Scratch;
use crate::spatial::{Force, Vec3};

/// Tolerance of the loads, relative to the largest.
const TOLERANCE: f64 = 4e-15;

/// Iteration limit; a contraction of 0.9 needs half of it.
const MAX_ITERATIONS: usize = 600;

/// Iteration limit of a step at velocity level, whose last iterate is taken: contacts may close and open with the
/// friction, and the step is of order 1.
const STEP_ITERATIONS: usize = 20;

/// Joints whose friction grows with the load, with working memory.
#[derive(Clone, Debug)]
pub(super) struct Bearings<R> {
    /// Indices of the joints in the model's names.
    joints: Vec<usize>,
    /// Motions with the accelerations of an iteration.
    scratch: Scratch<R>,
}

impl<R: Real> Bearings<R> {
    /// The bearings of a model; `None` if no friction grows with a load.
    pub fn new(model: &Model<R>) -> Option<Box<Self>> {
        let is_loaded = |dof: usize| (0..R::LANES).any(|k| model.dofs[dof].friction.load_coefficient.lane(k) != 0.0);
        let joints = model.names.joints.iter().enumerate();
        let joints: Vec<usize> =
            joints.filter(|(_, joint)| joint.n_v == 1 && is_loaded(joint.v_idx)).map(|(k, _)| k).collect();
        (!joints.is_empty()).then(|| Box::new(Self { joints, scratch: Scratch::new(model) }))
    }
}

impl<R: Real> Mechanism<R> {
    /// Finds the loads of the bearings at a stage, before its slope: NaN where there are none. Arguments as in
    /// [`Mechanism::plain_slope`]; the slope is overwritten.
    #[inline(never)]
    pub(super) fn find_loads(&mut self, t: f64, implicit: Option<(f64, Implicit)>, y: &[R], slope: &mut [R]) {
        // laws hold for loads that fit alone
        let is_watched = core::mem::replace(&mut self.drive_monitor.is_active, false);
        self.loads.fill(R::zero());
        self.hand_loads_to_kinks();
        let at_velocity_level = matches!(implicit, Some((_, Implicit::Dampers)));
        let iterations = if at_velocity_level { STEP_ITERATIONS } else { MAX_ITERATIONS };
        let velocities = self.layout.velocities();
        let fits = (0..iterations).any(|_| {
            self.plain_slope(t, implicit, y, slope);
            let fits = self.take_loads(&y[velocities.clone()], &slope[velocities.clone()]);
            self.hand_loads_to_kinks();
            fits
        });
        if !fits && !at_velocity_level {
            self.loads.fill(R::splat(f64::NAN));
        }
        self.drive_monitor.is_active = is_watched;
    }

    fn hand_loads_to_kinks(&mut self) {
        if let Some(c) = &mut self.constraints {
            c.kinks.iter_mut().for_each(|kink| kink.load = self.loads[kink.dof].lane(0));
        }
    }

    /// Takes the loads of the last evaluation; returns true if they are those that it was made with.
    fn take_loads(&mut self, v: &[R], v_dot: &[R]) -> bool {
        let Some(mut bearings) = self.bearings.take() else { return true };
        kinematics::motions(&self.model, &self.q, v, v_dot, &mut bearings.scratch);
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        for joint in &bearings.joints {
            let (load, dof) = (self.bearing_load(*joint, &bearings.scratch), self.model.names.joints[*joint].v_idx);
            let (new, old) = (load.lane(0), self.loads[dof].lane(0));
            // what is not a number ends the iteration
            change = if (new - old).is_nan() { 0.0 } else { change.max((new - old).abs()) };
            largest = largest.max(new.abs());
            self.loads[dof] = load;
        }
        self.bearings = Some(bearings);
        change <= TOLERANCE * largest
    }

    /// Force that the bearing of a joint transmits, for motions in `scratch` `[N]`.
    fn bearing_load(&self, joint: usize, scratch: &Scratch<R>) -> R {
        let joint = &self.model.names.joints[joint];
        let Some(child) = joint.moving.link else { return R::zero() };
        let force = self.transmitted(child, scratch).lin;
        let across = match joint.kind {
            JointKind::Prismatic { axis } => {
                let axis = joint.base.pose.rot.mul_vec(Vec3(axis));
                let axis = Vec3::splat(axis.scale(1.0 / axis.norm()).0);
                let axis = joint.base.link.map_or(axis, |link| scratch.poses[link].rot.mul_vec(axis));
                force - axis.scale(axis.dot(force))
            }
            _ => force,
        };
        let square = across.dot(across);
        // a root has no slope at zero
        square.max(R::splat(f64::MIN_POSITIVE)).sqrt()
    }

    /// Wrench on `root` and all that hangs on it which its joint transmits, about the world's origin, world axes.
    fn transmitted(&self, root: usize, scratch: &Scratch<R>) -> Force<R> {
        let hangs = |link: usize| self.hangs_on(link, root);
        let mut sum = self.net_wrench_beyond(root, scratch);
        let Some(constraints) = self.constraints.as_deref() else { return sum };
        for (row, lambda) in constraints.rows.iter().zip(&constraints.lambda) {
            if row.a != WORLD && hangs(row.a as usize) {
                sum -= row.wa.scale(*lambda);
            }
            if row.b != WORLD && hangs(row.b as usize) {
                sum += row.wb.scale(*lambda);
            }
        }
        sum
    }
}
