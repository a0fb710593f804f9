//! Proximity sensors as clients and scripts have them: what was seen when they were handled last, and what is there
//! now.

use sincro_dynamics::geometry::FieldOfView;

use super::flags::DETECTABLE;
use super::registry::{Handle, Kind, ObjectRegistry, WORLD};
use super::scene_objects::handle_of_id;
use super::senses::{ProximityEntry, handle_of};
use super::{ApiError, Entity, SimApi};
use sincro_sim::proximity::{Detection, ProximitySensor};

impl SimApi<'_> {
    fn proximity_entry(&self, handle: Handle) -> Result<&ProximityEntry, ApiError> {
        let entry = self.registry.entry(handle)?;
        let sensor = self.registry.senses.proximity.get(&entry.handle);
        sensor.ok_or_else(|| ApiError(format!("`{}` is no proximity sensor", entry.path)))
    }

    /// Reading of a proximity sensor when it was last evaluated, for a sensor of the scene at its last sample: the
    /// outer option is none before the first evaluation, the inner one if nothing was detected. Distances are in `[m]`.
    ///
    /// # Errors
    ///
    /// `handle` is no object of the registry, or is no proximity sensor.
    pub fn proximity(&self, handle: Handle) -> Result<Option<Option<Detection>>, ApiError> {
        Ok(self.proximity_entry(handle)?.saw)
    }

    /// Evaluates a proximity sensor at the present instant against one entity, within `most` `[m]`; none if it detects
    /// nothing. Objects whose flag `detectable` is cleared are not detected. The reading of [`SimApi::proximity`]
    /// stays.
    ///
    /// # Errors
    ///
    /// `handle` is no object or no proximity sensor, or the entity is a collection or object that was removed.
    pub fn look_at(&mut self, handle: Handle, entity: Entity, most: f64) -> Result<Option<Detection>, ApiError> {
        let entry = self.proximity_entry(handle)?;
        let (sensor, blind_below) = (entry.sensor.clone(), entry.blind_below);
        let at = self.registry.entry(handle)?.frame;
        let x_we = self.place(&at);
        let members = if entity == Entity::All { Vec::new() } else { self.members(entity)? };
        let (registry, t) = (&*self.registry, self.t);
        let pieces = registry.senses.pieces().filter(|piece| {
            let is_chosen = match entity {
                Entity::All => sensor.admits(&at, piece),
                _ => members.binary_search(&handle_of(piece)).is_ok(),
            };
            is_chosen && registry.counts(entity, handle_of(piece), DETECTABLE)
        });
        let saw = self.world.with_state_view(t, |seen| sensor.detect(&x_we, pieces, seen.scratch, most));
        Ok(saw.filter(|saw| saw.distance >= blind_below))
    }

    /// Evaluates a proximity sensor at the present instant. A sensor of the scene has its sample of the
    /// present tick already while a run is on.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is no proximity sensor.
    pub(crate) fn handle_proximity(&mut self, handle: Handle) -> Result<Option<Detection>, ApiError> {
        let entry = self.proximity_entry(handle)?;
        if entry.is_of_scene
            && !entry.is_explicit
            && self.is_running()
            && let Some(saw) = self.proximity(handle)?
        {
            return Ok(saw);
        }
        let entity = self.proximity_entry(handle)?.entity;
        let saw = self.look_at(handle, entity, f64::INFINITY)?;
        self.registry.tell(handle, saw);
        Ok(saw)
    }

    /// Evaluates all proximity sensors, those with explicit handling only if `explicit`: what the one that is closest
    /// to something saw.
    ///
    /// # Errors
    ///
    /// None yet.
    pub(crate) fn handle_proximities(&mut self, explicit: bool) -> Result<Option<Detection>, ApiError> {
        let all: Vec<Handle> = self
            .registry
            .senses
            .proximity
            .iter()
            .filter(|(_, l)| explicit || !l.is_explicit)
            .map(|(h, _)| *h)
            .collect();
        let mut nearest: Option<Detection> = None;
        for handle in all {
            let saw = self.handle_proximity(handle)?;
            if saw.is_some_and(|s| nearest.is_none_or(|n| s.distance < n.distance)) {
                nearest = saw;
            }
        }
        Ok(nearest)
    }

    /// Evaluates the runtime sensors, as a main script does, except those with explicit handling.
    pub(crate) fn handle_runtime_sensors(&mut self) {
        let proximity = &self.registry.senses.proximity;
        let made = proximity.iter().filter(|(_, l)| !l.is_of_scene && !l.is_explicit);
        let made: Vec<(Handle, Entity)> = made.map(|(handle, sensor)| (*handle, sensor.entity)).collect();
        for (handle, entity) in made {
            let saw = self.look_at(handle, entity, f64::INFINITY);
            self.registry.tell(handle, saw.ok().flatten());
        }
    }

    /// Lets a proximity sensor detect the objects of one entity alone, from its next sample on: a collection or object,
    /// or all that it detects in the scene for −1. Its recorded signals are those of the same choice.
    ///
    /// # Errors
    ///
    /// `handle` is no proximity sensor, or the entity is none.
    pub(super) fn set_detected(&mut self, handle: Handle, entity: i64) -> Result<(), ApiError> {
        self.proximity_entry(handle)?;
        let chosen = self.chosen(entity)?;
        self.change(handle, "detects", vec![entity as f64])?;
        if let Some(sensor) = self.registry.senses.proximity.get_mut(&handle) {
            sensor.entity = chosen;
        }
        Ok(())
    }

    /// Entity of a number that stands for what a sensor looks at: −1 is all.
    pub(super) fn chosen(&self, entity: i64) -> Result<Entity, ApiError> {
        let none =
            || ApiError(format!("{entity} is no object or collection that a sensor could look at, nor −1 for all"));
        match i32::try_from(entity) {
            Ok(-1 | -2) => Ok(Entity::All),
            Ok(number) => self.entity(Handle(number)).map_err(|_| none()),
            Err(_) => Err(none()),
        }
    }

    /// Number of the entity that a proximity sensor detects, −1 for all.
    pub(super) fn detected_number(&self, handle: Handle) -> Result<i64, ApiError> {
        Ok(self.proximity_entry(handle)?.entity.number())
    }

    /// Forgets what a proximity sensor saw.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is no proximity sensor.
    pub(crate) fn reset_proximity(&mut self, handle: Handle) -> Result<(), ApiError> {
        let own = self.registry.entry(handle)?.handle;
        self.proximity_entry(own)?;
        if let Some(entry) = self.registry.senses.proximity.get_mut(&own) {
            entry.saw = None;
        }
        Ok(())
    }

    /// Resets all proximity sensors, those with explicit handling only if `explicit`.
    pub(crate) fn reset_proximities(&mut self, explicit: bool) {
        for entry in self.registry.senses.proximity.values_mut().filter(|l| explicit || !l.is_explicit) {
            entry.saw = None;
        }
    }

    /// Makes a proximity sensor in the world's origin: one with explicit handling if it `is_explicit`, and
    /// sees nothing while something is nearer than `blind_below` `[m]`.
    ///
    /// # Errors
    ///
    /// There are too many objects.
    pub(crate) fn create_proximity_sensor(
        &mut self,
        field: FieldOfView,
        is_explicit: bool,
        blind_below: f64,
    ) -> Result<Handle, ApiError> {
        let handle = self.registry.create("ProximitySensor", Kind::Proximity, WORLD)?;
        let sensor = ProximitySensor { field, with: Vec::new(), carrier: None };
        self.registry.senses.proximity.insert(
            handle,
            ProximityEntry { sensor, is_explicit, is_of_scene: false, blind_below, saw: None, entity: Entity::All },
        );
        Ok(handle)
    }
}

impl ObjectRegistry {
    /// Numbers of the objects that a proximity sensor of the scene may detect, in ascending order, as a client or
    /// script has it; none if the scene decides.
    pub(crate) fn detected_objects(&self, sensor: usize) -> Option<Vec<usize>> {
        let entity = self.senses.proximity.get(&handle_of_id(sensor))?.entity;
        if entity == Entity::All {
            return None;
        }
        let members = self.members(entity).unwrap_or_default();
        let members = members.into_iter().filter(|own| self.counts(entity, *own, DETECTABLE));
        Some(members.filter_map(|own| usize::try_from(own.0 - 1).ok()).collect())
    }
}
