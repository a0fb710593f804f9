//! Conveyor belts as V-REP 3 has them: a static body that is given an initial velocity at each step.
//!
//! In V-REP such a body is put into the dynamics anew at each step, with a velocity, and taken out before it has gone
//! far. Here a prismatic joint with an ideal velocity motor carries it along the belt for a step of clients, and it is
//! put back before the next one: what lies on it is driven by friction, and the work of the motor is in the balance of
//! energy. The joint is left out of the tree that clients see.

use serde_json::Value;
use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::spatial::Vec3;

use super::table;
use crate::api::registry::{Handle, Kind};
use crate::api::{ApiError, Reference, SimApi};
use sincro_scene::draft::pose_keys;

/// Density of a belt that has no mass of its own [kg/m³]; it is carried by an ideal motor, so that nothing depends on
/// it.
const DENSITY: f64 = 1000.0;
/// Sine of the angle by which the direction of a belt may differ from that of its joint.
const ALIGNED: f64 = 1e-9;

/// Static body that carries others along.
#[derive(Clone, Debug, Default)]
pub(in crate::api) struct Belt {
    /// Velocity of its surface `[m/s]`, world axes.
    velocity: [f64; 3],
    /// Prismatic joint that carries it, with its direction in world axes; none before it has moved.
    joint: Option<(Handle, [f64; 3])>,
    /// True if the velocity acts in the coming step: it was set or reset since the last one.
    is_due: bool,
}

impl Belt {
    /// Joint that carries it.
    pub fn joint(&self) -> Option<Handle> {
        self.joint.map(|(joint, _)| joint)
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
    /// The body touches nothing.
    pub(in crate::api) fn set_belt_velocity(
        &mut self,
        body: Handle,
        component: usize,
        value: f64,
    ) -> Result<(), ApiError> {
        self.can_touch(body)?;
        let belt = self.registry.belts.entry(body).or_default();
        belt.velocity[component] = value;
        belt.is_due = true;
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
                let is_along = |(_, axis): (Handle, [f64; 3])| direction.cross(Vec3(axis)).norm() < ALIGNED;
                if !belt.joint.is_some_and(is_along) {
                    self.put_on_belt_joint(body, direction)?;
                }
            }
            if let Some(belt) = self.registry.belts.get_mut(&body) {
                belt.is_due = false;
            }
            let Some((joint, axis)) = self.registry.belts.get(&body).and_then(|belt| belt.joint) else { continue };
            self.drive_belt(joint, velocity.dot(Vec3(axis)))?;
        }
        Ok(())
    }

    /// Puts the joint of a belt back, and commands its speed `[m/s]`; the change of the energy counts as work.
    fn drive_belt(&mut self, joint: Handle, speed: f64) -> Result<(), ApiError> {
        let entry = self.registry.joint(joint)?.clone();
        self.count_as_work(|sim| sim.world.state.q[entry.q_idx] = 0.0);
        self.set_target_velocity(joint, speed)
    }

    /// Hangs a static body on a prismatic joint along a direction in world axes, or turns the one that it has.
    fn put_on_belt_joint(&mut self, body: Handle, direction: Vec3<f64>) -> Result<(), ApiError> {
        let entry = self.registry.entry(body)?.clone();
        let Kind::Body(mass) = entry.kind else { return Err(ApiError(format!("`{}` is no body", entry.path))) };
        let x_wb = self.pose(body, Reference::World)?;
        let axis = Value::from(x_wb.rot.tr_mul_vec(direction).0.to_vec());
        let mut edit = self.draft()?;
        let known = self.registry.belts.get(&body).and_then(|belt| belt.joint);
        let path = if let Some((joint, _)) = known {
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
            edit.draft.hang(&own, &path, &sincro_dynamics::spatial::Pose::identity());
            path
        };
        self.rebuild(edit)?;
        let joint = self.handle_at(&path)?;
        if let Some(belt) = self.registry.belts.get_mut(&body) {
            belt.joint = Some((joint, direction.0));
        }
        self.registry.leave_out_belts();
        let held = Motor { max_torque: f64::INFINITY, ..Motor::new(MotorMode::Velocity) };
        self.change_motor(joint, |motor| *motor = held)?;
        self.restore_pairs();
        Ok(())
    }
}
