//! Proximity sensors as clients and scripts have them: what was seen when they were handled last, and what is there now.

use sincro_dynamics::geometry::FieldOfView;

use super::senses::{Look, handle_of};
use super::table::{Handle, Kind, WORLD};
use super::{Desk, Entity, Refusal};
use sincro_sim::proximity::{Detection, ProximitySensor};

impl Desk<'_> {
    fn look_of(&self, handle: Handle) -> Result<&Look, Refusal> {
        let entry = self.table.entry(handle)?;
        let look = self.table.senses.looks.get(&entry.handle);
        look.ok_or_else(|| Refusal(format!("`{}` is no proximity sensor", entry.path)))
    }

    /// What a proximity sensor saw when it was handled last, a scene's sensors at each of their samples; none if it has not been yet.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is no proximity sensor.
    pub fn proximity(&self, handle: Handle) -> Result<Option<Option<Detection>>, Refusal> {
        Ok(self.look_of(handle)?.saw)
    }

    /// What a proximity sensor sees of an entity now, within `most` `[m]`; the reading stays.
    ///
    /// # Errors
    ///
    /// There is no such object, it is no proximity sensor, or the entity is gone.
    pub fn look_at(&mut self, handle: Handle, entity: Entity, most: f64) -> Result<Option<Detection>, Refusal> {
        let look = self.look_of(handle)?;
        let (eye, blind_below) = (look.eye.clone(), look.blind_below);
        let at = self.table.entry(handle)?.frame;
        let x_we = self.place(&at);
        let members = if entity == Entity::All { Vec::new() } else { self.members(entity)? };
        let (senses, t) = (&self.table.senses, self.t);
        let pieces = senses.pieces().filter(|piece| {
            if entity == Entity::All {
                eye.admits(&at, piece)
            } else {
                members.binary_search(&handle_of(piece)).is_ok()
            }
        });
        let saw = self.world.with_state_view(t, |seen| eye.detect(&x_we, pieces, seen.scratch, most));
        Ok(saw.filter(|saw| saw.distance >= blind_below))
    }

    /// Lets a proximity sensor look: the reading is what is there now. A sensor of the scene has its sample of the present tick already while a run is on.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is no proximity sensor.
    pub fn handle_proximity(&mut self, handle: Handle) -> Result<Option<Detection>, Refusal> {
        if self.look_of(handle)?.is_of_scene
            && self.is_running()
            && let Some(saw) = self.proximity(handle)?
        {
            return Ok(saw);
        }
        let saw = self.look_at(handle, Entity::All, f64::INFINITY)?;
        self.table.tell(handle, saw);
        Ok(saw)
    }

    /// Lets all proximity sensors look, those that wait to be told only if `explicit`: what the one that is closest to something saw.
    ///
    /// # Errors
    ///
    /// None yet.
    pub fn handle_proximities(&mut self, explicit: bool) -> Result<Option<Detection>, Refusal> {
        let all: Vec<Handle> =
            self.table.senses.looks.iter().filter(|(_, l)| explicit || !l.is_explicit).map(|(h, _)| *h).collect();
        let mut nearest: Option<Detection> = None;
        for handle in all {
            let saw = self.handle_proximity(handle)?;
            if saw.is_some_and(|s| nearest.is_none_or(|n| s.distance < n.distance)) {
                nearest = saw;
            }
        }
        Ok(nearest)
    }

    /// The sensors that were made at run time look, as a main script makes them; not those that wait to be told.
    pub(crate) fn handle_made_sensors(&mut self) {
        let looks = &self.table.senses.looks;
        let made: Vec<Handle> =
            looks.iter().filter(|(_, l)| !l.is_of_scene && !l.is_explicit).map(|(h, _)| *h).collect();
        for handle in made {
            let saw = self.look_at(handle, Entity::All, f64::INFINITY);
            self.table.tell(handle, saw.ok().flatten());
        }
    }

    /// Forgets what a proximity sensor saw.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is no proximity sensor.
    pub fn reset_proximity(&mut self, handle: Handle) -> Result<(), Refusal> {
        let own = self.table.entry(handle)?.handle;
        self.look_of(own)?;
        if let Some(look) = self.table.senses.looks.get_mut(&own) {
            look.saw = None;
        }
        Ok(())
    }

    /// Forgets what all proximity sensors saw, of those that wait to be told only if `explicit`.
    pub fn reset_proximities(&mut self, explicit: bool) {
        for look in self.table.senses.looks.values_mut().filter(|l| explicit || !l.is_explicit) {
            look.saw = None;
        }
    }

    /// Makes a proximity sensor in the world's origin: one that looks only when it is told to if it `is_explicit`, and sees nothing while something is
    /// nearer than `blind_below` `[m]`.
    ///
    /// # Errors
    ///
    /// There are too many objects.
    pub fn create_proximity_sensor(
        &mut self,
        field: FieldOfView,
        is_explicit: bool,
        blind_below: f64,
    ) -> Result<Handle, Refusal> {
        let handle = self.table.create("ProximitySensor", Kind::Proximity, WORLD)?;
        let eye = ProximitySensor { field, with: Vec::new(), carrier: None };
        self.table.senses.looks.insert(handle, Look { eye, is_explicit, is_of_scene: false, blind_below, saw: None });
        Ok(handle)
    }
}
