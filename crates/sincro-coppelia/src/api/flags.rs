//! Flags of objects: what they take part in, and what they show.
//!
//! As in V-REP an object is collidable, measurable, detectable and renderable unless a client or script clears the
//! flag, on it or on a model that it belongs to. A visibility layer outside of the eight that are shown by default
//! hides an object from vision sensors. Flags end with the run that they were set in.

use std::collections::BTreeMap;

use super::collections::Entity;
use super::registry::{Handle, ObjectRegistry};
use super::{ApiError, SimApi};

/// Found by [`SimApi::collision`].
pub(super) const COLLIDABLE: i64 = 1;
/// Found by [`SimApi::distance`].
pub(super) const MEASURABLE: i64 = 2;
/// Seen by proximity sensors; a bit for each of their kinds, of which one suffices here.
pub(super) const DETECTABLE: i64 = 0x1f0;
/// Seen by vision sensors.
pub(super) const RENDERABLE: i64 = 0x200;
/// Flags of an object that nobody has changed.
const ALL: i64 = COLLIDABLE | MEASURABLE | DETECTABLE | RENDERABLE;
/// Flags that mean nothing here and are given back: cuttable, ignored by path planning.
const KEPT: i64 = 0xc00;

/// Flags of a model that clear flags of all its objects: their bits, and those of objects.
const CLEARING: [(i64, i64); 4] = [(1, COLLIDABLE), (2, MEASURABLE), (4, RENDERABLE), (8, DETECTABLE)];
/// Flag of a model that hides all its objects from vision sensors.
const NOT_VISIBLE: i64 = 0x100;
/// Flags of a model that are refused, and why.
const REFUSED: [(i64, &str); 4] = [
    (0x20, "not dynamic: set the parameter 3003 (static) of its free bodies"),
    (0x40, "not respondable: set the parameter 3004 (respondable) of its bodies to 0"),
    (0x80, "not reset: a run ends with everything as it was before"),
    (0x200, "scripts inactive: scripts of a scene run until they end"),
];

/// Visibility layers that are shown by default.
const SHOWN_LAYERS: i64 = 0xff;

/// Flags by the object that has them.
type Map = BTreeMap<Handle, i64>;

/// Flags that clients and scripts have set, each by the object that has them.
#[derive(Clone, Debug, Default)]
pub(super) struct Flags {
    special: Map,
    model: Map,
    common: Map,
    layers: Map,
}

impl Flags {
    /// Forgets an object that was removed.
    pub fn forget(&mut self, own: Handle) {
        for map in [&mut self.special, &mut self.model, &mut self.common, &mut self.layers] {
            map.remove(&own);
        }
    }
}

impl ObjectRegistry {
    /// Flags of the models that an object belongs to, together.
    fn flags_of_models(&self, handle: Handle) -> i64 {
        if self.flags.model.is_empty() {
            return 0;
        }
        let chain = std::iter::successors(Some(handle), |at| self.visible_parent(*at)).take(self.entries.len() + 1);
        chain.filter_map(|at| self.flags.model.get(&at)).fold(0, |all, flags| all | flags)
    }

    /// Returns true if an object has one of these flags, and its models let it.
    pub(super) fn takes_part(&self, handle: Handle, flags: i64) -> bool {
        let own = self.special_property(handle);
        let of_models = self.flags_of_models(handle);
        let is_cleared = CLEARING.iter().any(|(model, own)| of_models & model != 0 && own & flags != 0);
        own & flags != 0 && !is_cleared
    }

    /// Returns true if an object takes part by its flags, or as a member of a collection that overrides them.
    pub(super) fn counts(&self, entity: Entity, handle: Handle, flags: i64) -> bool {
        matches!(entity, Entity::Collection(own) if self.overrides_flags(own)) || self.takes_part(handle, flags)
    }

    /// Returns true if vision sensors see an object: it is renderable, on a layer that is shown, and no model hides it.
    pub(crate) fn is_seen(&self, handle: Handle) -> bool {
        let is_hidden =
            self.visibility_layer(handle) & SHOWN_LAYERS == 0 || self.flags_of_models(handle) & NOT_VISIBLE != 0;
        !is_hidden && self.takes_part(handle, RENDERABLE)
    }

    /// Returns true if no proximity sensor detects an object, by its flags.
    pub(crate) fn is_undetectable(&self, handle: Handle) -> bool {
        !self.takes_part(handle, DETECTABLE)
    }

    /// Flags that say what an object takes part in, `sim.objectspecialproperty_…`.
    pub(crate) fn special_property(&self, handle: Handle) -> i64 {
        self.flags.special.get(&handle).copied().unwrap_or(ALL)
    }

    /// Flags of an object in the windows of V-REP, `sim.objectproperty_…`, as they were set.
    pub(crate) fn common_property(&self, handle: Handle) -> i64 {
        self.flags.common.get(&handle).copied().unwrap_or(0)
    }

    /// Visibility layers of an object, a bit each.
    pub(super) fn visibility_layer(&self, handle: Handle) -> i64 {
        self.flags.layers.get(&handle).copied().unwrap_or(1)
    }

    /// Flags of a model, `sim.modelproperty_…`, as they were set.
    ///
    /// # Errors
    ///
    /// There is no such object.
    pub fn model_property(&self, handle: Handle) -> Result<i64, ApiError> {
        self.entry(handle)?;
        Ok(self.flags.model.get(&handle).copied().unwrap_or(0))
    }

    /// Sets the flags of an object in the windows of V-REP.
    pub(crate) fn set_common_property(&mut self, handle: Handle, value: i64) {
        self.flags.common.insert(handle, value);
    }
}

impl SimApi<'_> {
    /// Says what an object takes part in, `sim.objectspecialproperty_…`.
    ///
    /// # Errors
    ///
    /// There is no such object or no such flag, or the model was changed 10,000 times already; the flags are then as
    /// they were.
    pub(crate) fn set_special_property(&mut self, handle: Handle, value: i64) -> Result<(), ApiError> {
        let path = &self.registry.entry(handle)?.path;
        if value & !(ALL | KEPT) != 0 {
            let known = "collidable 1, measurable 2, detectable 16 to 256, renderable 512";
            return Err(ApiError(format!("{value} has flags for `{path}` that there are not: {known}")));
        }
        self.set_flags(handle, value, |flags| &mut flags.special)
    }

    /// Sets or clears flags of an object that says what it takes part in.
    ///
    /// # Errors
    ///
    /// There is no such object.
    pub(crate) fn set_special_flags(&mut self, handle: Handle, flags: i64, is_set: bool) -> Result<(), ApiError> {
        let now = self.registry.special_property(handle);
        self.set_special_property(handle, if is_set { now | flags } else { now & !flags })
    }

    /// Sets the flags of a model, `sim.modelproperty_…`: they hold for all its objects.
    ///
    /// # Errors
    ///
    /// There is no such object, a flag is set that would change the physics, or the model was changed 10,000 times
    /// already; the flags are then as they were.
    pub fn set_model_property(&mut self, handle: Handle, value: i64) -> Result<(), ApiError> {
        let path = &self.registry.entry(handle)?.path;
        if let Some((_, why)) = REFUSED.iter().find(|(flag, _)| value & flag != 0) {
            return Err(ApiError(format!("the model `{path}` cannot be {why}")));
        }
        self.set_flags(handle, value, |flags| &mut flags.model)
    }

    /// Sets the visibility layers of an object, a bit each; on none of the first eight it is hidden from vision
    /// sensors.
    pub(super) fn set_visibility_layer(&mut self, handle: Handle, layers: i64) -> Result<(), ApiError> {
        if !(0..=0xffff).contains(&layers) {
            return Err(ApiError(format!("there are 16 visibility layers, a bit each: {layers} is more")));
        }
        self.finish_pictures();
        self.registry.flags.layers.insert(handle, layers);
        Ok(())
    }

    /// Sets flags of an object in one of the maps of them. The run keeps that proximity sensors detect the object from
    /// now on, or do not; the flags stay as they are if it cannot.
    fn set_flags(&mut self, handle: Handle, value: i64, map: fn(&mut Flags) -> &mut Map) -> Result<(), ApiError> {
        let before = self.registry.takes_part(handle, DETECTABLE);
        self.finish_pictures();
        let former = map(&mut self.registry.flags).insert(handle, value);
        let now = self.registry.takes_part(handle, DETECTABLE);
        let kept =
            if now == before { Ok(()) } else { self.change(handle, "detectable", vec![f64::from(u8::from(now))]) };
        if kept.is_err() {
            let flags = map(&mut self.registry.flags);
            match former {
                Some(former) => flags.insert(handle, former),
                None => flags.remove(&handle),
            };
        }
        kept
    }
}
