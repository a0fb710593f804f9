//! Contacts of bodies and loads of force sensors at the present instant.

use sincro_dynamics::spatial::Vec3;

use super::registry::{Handle, Kind};
use super::{ApiError, SimApi};

/// Point at which two bodies press on each other at the present instant, as [`SimApi::contact_points`] finds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Handles of the two bodies; the force acts on the first one, its opposite on the second.
    pub bodies: [Handle; 2],
    /// Position of the point `[m]`: x, y, z in the world frame.
    pub point: Vec3<f64>,
    /// Contact force, normal and friction `[N]`: x, y, z in world axes.
    pub force: Vec3<f64>,
    /// Unit normal from the second body to the first (dimensionless): x, y, z in world axes.
    pub normal: Vec3<f64>,
}

impl SimApi<'_> {
    /// Brings forces up to date with the present state.
    fn observe(&mut self) {
        let t = self.world.state.tick as f64 * self.registry.base_step();
        self.world.observe(t);
        self.moved();
    }

    /// Points of contact that carry a force now, the same order for the same state. Contact forces are brought up to
    /// date with the present positions and velocities first.
    pub fn contact_points(&mut self) -> Vec<ContactPoint> {
        self.observe();
        let colliders = &self.world.model().constraints().colliders;
        let handle = |k: usize| self.registry.entries().find(|e| e.path == colliders[k].name).map(|e| e.handle);
        let contact = |p: sincro_dynamics::constraint::ContactPoint| {
            let bodies = [handle(p.surfaces[0])?, handle(p.surfaces[1])?];
            Some(ContactPoint { bodies, point: p.point, force: p.force, normal: p.normal })
        };
        self.world.contacts().filter_map(contact).collect()
    }

    /// Returns true if a body can touch anything.
    ///
    /// # Errors
    ///
    /// There is no such object, or it cannot.
    pub(crate) fn can_touch(&self, handle: Handle) -> Result<(), ApiError> {
        let path = &self.registry.entry(handle)?.path;
        let mut colliders = self.world.model().constraints().colliders.iter();
        if colliders.any(|c| c.name == *path) {
            return Ok(());
        }
        Err(ApiError(format!("`{path}` touches nothing: give the body `contact = {{ … }}` in the scene")))
    }

    /// Load of a force sensor (a fixed joint with `force_sensor = true`), zero if it carries nothing yet: force `[N]`,
    /// then torque `[N·m]`, each as x, y, z in the axes of the joint. They act from what the joint carries on what
    /// carries it, the sign that V-REP reports.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry, or is no force sensor.
    pub fn force_sensor(&mut self, handle: Handle) -> Result<([f64; 3], [f64; 3]), ApiError> {
        let entry = self.registry.entry(handle)?;
        let Kind::ForceSensor(first) = entry.kind else {
            let help = "give a fixed joint `force_sensor = true` in the scene";
            return Err(ApiError(format!("`{}` is no force sensor: {help}", entry.path)));
        };
        let Some(first) = first else { return Ok(([0.0; 3], [0.0; 3])) };
        self.observe();
        // the joint's own figure is what carries on what is carried
        let held = |k: usize| -self.world.reaction(first + k);
        Ok(([held(3), held(4), held(5)], [held(0), held(1), held(2)]))
    }
}
