//! What touches what, and what goes through force sensors, now.

use sincro_dynamics::spatial::Vec3;

use super::table::{Handle, Kind};
use super::{Desk, Refusal};

/// A point where two bodies press on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The two bodies; the force is on the first one.
    pub bodies: [Handle; 2],
    /// Where `[m]`, world axes.
    pub point: Vec3<f64>,
    /// `[N]`, world axes.
    pub force: Vec3<f64>,
    /// From the second body to the first.
    pub normal: Vec3<f64>,
}

impl Desk<'_> {
    /// Brings forces up to date with the present state.
    fn observe(&mut self) {
        let t = self.world.state.tick as f64 * self.table.base_step();
        self.world.observe(t);
        self.moved();
    }

    /// All points of contact that press now.
    pub fn touches(&mut self) -> Vec<Touch> {
        self.observe();
        let colliders = &self.world.model().constraints().colliders;
        let handle = |k: usize| self.table.entries().find(|e| e.path == colliders[k].name).map(|e| e.handle);
        let touch = |p: sincro_dynamics::constraint::ContactPoint| {
            let bodies = [handle(p.surfaces[0])?, handle(p.surfaces[1])?];
            Some(Touch { bodies, point: p.point, force: p.force, normal: p.normal })
        };
        self.world.contacts().filter_map(touch).collect()
    }

    /// Whether a body can touch anything.
    ///
    /// # Errors
    ///
    /// There is no such object, or it cannot.
    pub fn can_touch(&self, handle: Handle) -> Result<(), Refusal> {
        let path = &self.table.entry(handle)?.path;
        let mut colliders = self.world.model().constraints().colliders.iter();
        if colliders.any(|c| c.name == *path) {
            return Ok(());
        }
        Err(Refusal(format!("`{path}` touches nothing: give the body `contact = {{ … }}` in the scene")))
    }

    /// What goes through a force sensor: force `[N]` and torque [N·m] of what it carries on what carries it, in its own axes, as V-REP has it.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is no force sensor.
    pub fn force_sensor(&mut self, handle: Handle) -> Result<([f64; 3], [f64; 3]), Refusal> {
        let entry = self.table.entry(handle)?;
        let Kind::ForceSensor(first) = entry.kind else {
            let help = "give a fixed joint `force_sensor = true` in the scene";
            return Err(Refusal(format!("`{}` is no force sensor: {help}", entry.path)));
        };
        self.observe();
        // the joint's own figure is what carries on what is carried
        let held = |k: usize| -self.world.reaction(first + k);
        Ok(([held(3), held(4), held(5)], [held(0), held(1), held(2)]))
    }
}
