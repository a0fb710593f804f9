//! Conveyor belts as V-REP 3 has them: a static body that is given an initial velocity at each step.
//!
//! In V-REP such a body is put into the dynamics anew at each step, with a velocity, and taken out before it has gone
//! far. Here a prismatic joint with an ideal velocity motor carries it along the belt for a step of clients, and it is
//! put back before the next one: what lies on it is driven by friction, and the work of the motor is in the balance of
//! energy. The joint is left out of the tree that clients see, and goes with the belt that is put or hung elsewhere.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::spatial::{Pose, Vec3};

use super::table;
use crate::api::registry::{Handle, Kind, axis_of};
use crate::api::{ApiError, Reference, SimApi};
use sincro_scene::draft::pose_keys;

/// Density of a belt that has no mass of its own [kg/m³]; it is carried by an ideal motor, so that nothing depends on
/// it.
const DENSITY: f64 = 1000.0;
/// Largest speed of a belt [m/s]: beyond that of any machine, and such that a step takes it no distance that rounds
/// the positions of what it touches.
const MAX_SPEED: f64 = 1000.0;
/// Sine of the angle by which the direction of a belt may differ from that of its joint.
const ALIGNED: f64 = 1e-9;

/// Static body that carries others along.
#[derive(Clone, Debug, Default)]
pub(in crate::api) struct Belt {
    /// Velocity of its surface `[m/s]`, world axes.
    velocity: [f64; 3],
    /// Prismatic joint that carries it; none before it has moved.
    joint: Option<Handle>,
    /// True if the velocity acts in the coming step: it was set or reset since the last one.
    is_due: bool,
    /// True if the body had no mass before it was put on the joint.
    was_massless: bool,
}

impl Belt {
    /// Joint that carries it.
    pub fn joint(&self) -> Option<Handle> {
        self.joint
    }

    /// Returns true if the scene gives the body no mass.
    pub fn was_massless(&self) -> bool {
        self.was_massless
    }
}

impl SimApi<'_> {
    /// Returns true if a body is static, or was before it carried others along.
    pub(in crate::api) fn is_fixed(&self, body: Handle) -> Result<bool, ApiError> {
        let entry = self.registry.entry(body)?;
        Ok(entry.frame.link.is_none() || self.registry.belts.contains_key(&body))
    }

    /// Sets one component of the velocity `[m/s]`, world axes, of the surface of a static body in the coming step of
    /// clients.
    ///
    /// # Errors
    ///
    /// The body touches nothing, or the speed is too large.
    pub(in crate::api) fn set_belt_velocity(
        &mut self,
        body: Handle,
        component: usize,
        value: f64,
    ) -> Result<(), ApiError> {
        self.can_touch(body)?;
        let mut velocity = self.registry.belts.get(&body).map_or([0.0; 3], |belt| belt.velocity);
        velocity[component] = value;
        if Vec3(velocity).norm() > MAX_SPEED {
            let path = &self.registry.entry(body)?.path;
            return Err(ApiError(format!("velocity {velocity:?} m/s of belt `{path}` is above {MAX_SPEED} m/s")));
        }
        let belt = self.registry.belts.entry(body).or_default();
        (belt.velocity, belt.is_due) = (velocity, true);
        Ok(())
    }

    /// Lets the velocity of a belt act in the coming step, too; nothing for other bodies.
    pub(in crate::api) fn reset_belt(&mut self, body: Handle) {
        if let Some(belt) = self.registry.belts.get_mut(&body) {
            belt.is_due = true;
        }
    }

    /// Puts all belts where they were made, and gives them their velocities for the coming step of clients.
    ///
    /// # Errors
    ///
    /// A belt cannot move: the model cannot be so.
    pub(crate) fn move_belts(&mut self) -> Result<(), ApiError> {
        let bodies: Vec<Handle> = self.registry.belts.keys().copied().collect();
        for body in bodies {
            let Some(belt) = self.registry.belts.get(&body).cloned() else { continue };
            let velocity = Vec3(if belt.is_due { belt.velocity } else { [0.0; 3] });
            let speed = velocity.norm();
            if speed > 0.0 {
                let direction = velocity.scale(1.0 / speed);
                let axis = belt.joint.map(|joint| self.belt_axis(joint)).transpose()?;
                if !axis.is_some_and(|axis| direction.cross(axis).norm() < ALIGNED) {
                    self.put_on_belt_joint(body, direction)?;
                }
            }
            if let Some(belt) = self.registry.belts.get_mut(&body) {
                belt.is_due = false;
            }
            let Some(joint) = self.belt_joint(body) else { continue };
            let speed = velocity.dot(self.belt_axis(joint)?);
            self.put_belt_back(body)?;
            self.set_target_velocity(joint, speed)?;
        }
        Ok(())
    }

    /// Prismatic joint that carries a belt; none before it has moved, and for other objects.
    pub(in crate::api) fn belt_joint(&self, body: Handle) -> Option<Handle> {
        self.registry.belts.get(&body).and_then(Belt::joint)
    }

    /// Direction of the joint of a belt, world axes.
    fn belt_axis(&mut self, joint: Handle) -> Result<Vec3<f64>, ApiError> {
        let axis =
            axis_of(&self.registry.joint(joint)?.kind).ok_or_else(|| ApiError::new("a belt goes along a line"))?;
        Ok(self.own_pose(joint)?.rot.mul_vec(Vec3(axis)))
    }

    /// Puts the joint of a belt back, if it has one; the change of the energy counts as work.
    pub(in crate::api) fn put_belt_back(&mut self, body: Handle) -> Result<(), ApiError> {
        let Some(joint) = self.belt_joint(body) else { return Ok(()) };
        let q_idx = self.registry.joint(joint)?.q_idx;
        self.count_as_work(|sim| sim.world.state.q[q_idx] = 0.0);
        Ok(())
    }

    /// Puts a static body, with the joint that it has as a belt, at a pose in the world.
    ///
    /// # Errors
    ///
    /// The model cannot be so.
    pub(in crate::api) fn place_fixed(&mut self, body: Handle, x_wb: &Pose<f64>) -> Result<(), ApiError> {
        let Some(joint) = self.belt_joint(body) else { return self.place_in_model(body, x_wb) };
        // the body stands in the joint's own frame, whose axes are others than those that the API shows of a joint
        let (own, shown) = (self.own_pose(joint)?, self.pose(joint, Reference::World)?);
        self.place_in_model(joint, &x_wb.compose(&own.inverse()).compose(&shown))
    }

    /// Makes a belt a static body that carries nothing along; nothing for other bodies.
    ///
    /// # Errors
    ///
    /// The model cannot be so.
    pub(super) fn take_off_belt(&mut self, body: Handle) -> Result<(), ApiError> {
        if let Some(joint) = self.belt_joint(body) {
            let (parent, x_wp) = self.model_parent(self.registry.entry(joint)?.parent)?;
            let pose = x_wp.inverse().compose(&self.own_pose(joint)?);
            let mut edit = self.draft()?;
            edit.draft.hang(&self.model_path(body)?, &parent, &pose);
            edit.draft.remove(&BTreeSet::from([self.model_path(joint)?]));
            self.rebuild(edit)?;
        }
        self.registry.belts.remove(&body);
        Ok(())
    }

    /// Hangs a static body on a prismatic joint along a direction in world axes, or turns the one that it has.
    fn put_on_belt_joint(&mut self, body: Handle, direction: Vec3<f64>) -> Result<(), ApiError> {
        let entry = self.registry.entry(body)?.clone();
        let Kind::Body(mass) = entry.kind else { return Err(ApiError(format!("`{}` is no body", entry.path))) };
        let x_wb = self.pose(body, Reference::World)?;
        let axis = Value::from(x_wb.rot.tr_mul_vec(direction).0.to_vec());
        let mut edit = self.draft()?;
        let known = self.belt_joint(body);
        let path = if let Some(joint) = known {
            let path = self.model_path(joint)?;
            let (list, keys) = edit.draft.table(&path).ok_or_else(|| ApiError(format!("there is no `{path}`")))?;
            let (list, mut keys) = (list.to_owned(), keys.clone());
            keys.insert("axis".into(), axis);
            edit.draft.replace(&path, &list, keys);
            path
        } else {
            let own = self.model_path(body)?;
            let (parent, x_wp) = self.model_parent(entry.parent)?;
            let name = self.fresh_name(&format!("{}_belt", entry.name));
            let motor = Value::Object(table([("mode", "velocity".into())]));
            let mut keys = table([("name", name.into()), ("parent", parent.into()), ("kind", "prismatic".into())]);
            keys.extend([("axis".to_owned(), axis), ("motor".to_owned(), motor)]);
            keys.extend(pose_keys(&x_wp.inverse().compose(&x_wb)));
            if mass.mass <= 0.0
                && let Some((list, keys)) = edit.draft.table(&own)
            {
                let (list, mut keys) = (list.to_owned(), keys.clone());
                keys.insert("density".into(), DENSITY.into());
                edit.draft.replace(&own, &list, keys);
            }
            let path = edit.draft.add("joint", keys);
            edit.draft.hang(&own, &path, &Pose::identity());
            path
        };
        self.rebuild(edit)?;
        let joint = self.handle_at(&path)?;
        if let Some(belt) = self.registry.belts.get_mut(&body) {
            belt.was_massless |= known.is_none() && mass.mass <= 0.0;
        }
        self.add_belt_joint(body, joint)
    }

    /// Takes a prismatic joint for that of a belt: clients do not see it, and its motor is an ideal one.
    fn add_belt_joint(&mut self, body: Handle, joint: Handle) -> Result<(), ApiError> {
        if let Some(belt) = self.registry.belts.get_mut(&body) {
            belt.joint = Some(joint);
        }
        self.registry.leave_out_belts();
        let ideal = Motor { max_torque: f64::INFINITY, ..Motor::new(MotorMode::Velocity) };
        self.change_motor(joint, |motor| *motor = ideal)?;
        self.restore_pairs();
        Ok(())
    }

    /// Makes the copies of belts belts, too.
    pub(super) fn copy_belts(&mut self, copies: &BTreeMap<Handle, Handle>) -> Result<(), ApiError> {
        for (original, copy) in copies {
            let Some(belt) = self.registry.belts.get(original).cloned() else { continue };
            let joint = belt.joint.and_then(|joint| copies.get(&joint)).copied();
            self.registry.belts.insert(*copy, Belt { joint: None, is_due: false, ..belt });
            if let Some(joint) = joint {
                self.add_belt_joint(*copy, joint)?;
                self.set_target_velocity(joint, 0.0)?;
            }
        }
        self.restore_pairs();
        Ok(())
    }
}
