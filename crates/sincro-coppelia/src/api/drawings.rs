//! Drawings and particles that clients and scripts make: items in the world or in the frame of an object, shown in the
//! viewer. No step and no sensor knows them.

use std::collections::BTreeMap;

use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_sim::runtime_object::{Drawing, DrawingKind, DrawingStyle, RuntimeObject, RuntimePart};

use super::registry::{Handle, Kind, ObjectRegistry, WORLD};
use super::senses::handle_of;
use super::{ApiError, SimApi};

/// Drawings that may exist at once.
const MAX_DRAWINGS: usize = 10_000;
/// Items of one drawing, as in V-REP.
const MAX_ITEMS: i64 = 1_000_000;
/// Items of a drawing that does not say how many, as in V-REP.
const DEFAULT_ITEMS: i64 = 1000;
/// Numbers of the items of all drawings together.
const MAX_NUMBERS: usize = 4_000_000;
/// Numbers from which on identifiers of drawings begin, behind those of objects.
const FIRST_ID: u32 = 1 << 31;

/// Drawings and particles of a registry by their handles, which are not those of objects.
#[derive(Clone, Debug, Default)]
pub(super) struct Drawings {
    list: BTreeMap<i64, Entry>,
    /// Number of drawings that were made.
    n_made: u32,
}

/// Drawing, with the object that carries it.
#[derive(Clone, Debug)]
struct Entry {
    /// Number that no other drawing had or has.
    serial: u32,
    path: String,
    parent: Option<Handle>,
    drawing: Drawing,
    layout: ItemLayout,
    /// True if it outlives the run in which it was made.
    is_persistent: bool,
}

/// Layout of an item as clients give it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ItemLayout {
    /// Numbers that are drawn, the first ones: positions.
    pub n_drawn: usize,
    /// All numbers of an item.
    pub n_given: usize,
    /// True if positions are in the frame of the parent, not in the world.
    pub is_local: bool,
}

/// Request for a drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawingRequest {
    pub style: DrawingStyle,
    pub layout: ItemLayout,
    pub parent: Option<Handle>,
    /// Number of items that it may have; 0 is 1,000.
    pub capacity: i64,
    pub is_cyclic: bool,
    /// Distance up to which an item is the same as another one `[m]`; 0: none is.
    pub tolerance: f64,
    pub is_persistent: bool,
}

impl SimApi<'_> {
    /// Makes a drawing without items and returns its handle, which is none of an object.
    ///
    /// # Errors
    ///
    /// There is no such parent, there are too many drawings, or the size is no length.
    pub(crate) fn add_drawing(&mut self, request: DrawingRequest) -> Result<i64, ApiError> {
        if let Some(parent) = request.parent {
            self.registry.entry(parent)?;
        }
        let DrawingStyle { kind, size, lifetime, .. } = request.style;
        for (what, x) in [("size of an item", size), ("lifetime", lifetime), ("tolerance", request.tolerance)] {
            if !(x.is_finite() && x >= 0.0) {
                return Err(ApiError(format!("{x} is no {what}: expected a number that is not negative")));
            }
        }
        let drawings = &mut self.registry.drawings;
        if drawings.list.len() >= MAX_DRAWINGS {
            return Err(ApiError(format!("there are {MAX_DRAWINGS} drawings already: remove some")));
        }
        // handles of removed ones are given again: they must stay below the flags that are added to them
        let handle = (1..).find(|handle| !drawings.list.contains_key(handle)).expect("there are few drawings");
        drawings.n_made = drawings.n_made.wrapping_add(1) % FIRST_ID;
        let serial = drawings.n_made;
        let capacity = if request.capacity == 0 { DEFAULT_ITEMS } else { request.capacity.clamp(1, MAX_ITEMS) };
        let what = if kind == DrawingKind::Particles { "particles" } else { "drawing" };
        let entry = Entry {
            serial,
            path: format!("/{what}{serial}"),
            parent: request.parent,
            drawing: Drawing::new(request.style, capacity as usize, request.is_cyclic, request.tolerance),
            layout: request.layout,
            is_persistent: request.is_persistent,
        };
        drawings.list.insert(handle, entry);
        Ok(handle)
    }

    /// Adds items to a drawing, all or the first alone; with `replaces`, in place of those that it has. Returns false
    /// if an item was not taken: the drawing is full, or has one there already.
    ///
    /// # Errors
    ///
    /// There is no such drawing, or the numbers are fewer than an item has, or not finite.
    pub(crate) fn draw_items(
        &mut self,
        handle: i64,
        numbers: &[f64],
        all: bool,
        replaces: bool,
    ) -> Result<bool, ApiError> {
        let room = MAX_NUMBERS.saturating_sub(self.registry.drawings.n_numbers());
        let entry = self.registry.drawings.entry(handle)?;
        let (layout, parent, kind) = (entry.layout, entry.parent, entry.drawing.style.kind);
        let (n, given) = (numbers.len(), layout.n_given);
        // they are kept in single precision
        if n < given || numbers.iter().any(|x| !(*x as f32).is_finite()) {
            return Err(ApiError(format!("{n} numbers for an item that has {given}, all finite")));
        }
        if replaces {
            entry.drawing.clear();
        }
        let carrier = match parent {
            Some(parent) => self.registry.entry(parent)?.frame,
            None => WORLD,
        };
        let x_pw = if layout.is_local { Pose::identity() } else { self.place(&carrier).inverse() };
        // the state is that after the step while scripts sense, whose own time is that before it
        let t = if self.is_running() { self.world.state.tick as f64 * self.registry.base_step() } else { 0.0 };
        let drawing = &mut self.registry.drawings.entry(handle)?.drawing;
        let items = numbers.chunks_exact(given).take(if all { usize::MAX } else { 1 });
        let (mut left, mut all_taken) = (room / kind.width(), true);
        for item in items {
            let three = |k: usize| Vec3([item[k], item[k + 1], item[k + 2]]);
            let mut own = Vec::with_capacity(kind.width());
            if kind == DrawingKind::Particles {
                // two points: a particle goes from the first to the second in one second
                own.extend(x_pw.point(three(0)).0);
                own.extend(x_pw.rot.mul_vec(three(3) - three(0)).0);
                own.push(t);
            } else {
                (0..layout.n_drawn).step_by(3).for_each(|k| own.extend(x_pw.point(three(k)).0));
            }
            let grows = !drawing.is_full();
            let is_taken = (!grows || left > 0) && drawing.push(&own);
            left -= usize::from(grows && is_taken);
            all_taken &= is_taken;
        }
        Ok(all_taken)
    }

    /// Removes all items of a drawing.
    ///
    /// # Errors
    ///
    /// There is no such drawing.
    pub(crate) fn clear_drawing(&mut self, handle: i64) -> Result<(), ApiError> {
        self.registry.drawings.entry(handle)?.drawing.clear();
        Ok(())
    }

    /// Returns true if there is a drawing, or particles, of that handle.
    pub(crate) fn has_drawing(&self, handle: i64) -> bool {
        self.registry.drawings.list.contains_key(&handle)
    }

    /// Removes a drawing, or all for none: those of particles, or all others.
    ///
    /// # Errors
    ///
    /// There is no such drawing.
    pub(crate) fn remove_drawing(&mut self, handle: Option<i64>, particles: bool) -> Result<(), ApiError> {
        let is_meant = |entry: &Entry| (entry.drawing.style.kind == DrawingKind::Particles) == particles;
        let drawings = &mut self.registry.drawings;
        let Some(handle) = handle else {
            drawings.list.retain(|_, entry| !is_meant(entry));
            return Ok(());
        };
        if !is_meant(drawings.entry(handle)?) {
            let what = if particles { "a drawing, no particles" } else { "particles, no drawing" };
            return Err(ApiError(format!("{handle} is {what}")));
        }
        drawings.list.remove(&handle);
        Ok(())
    }
}

impl Drawings {
    fn entry(&mut self, handle: i64) -> Result<&mut Entry, ApiError> {
        self.list.get_mut(&handle).ok_or_else(|| ApiError(format!("there is no drawing {handle}")))
    }

    /// Numbers of all items.
    fn n_numbers(&self) -> usize {
        self.list.values().map(|entry| entry.drawing.n_items() * entry.drawing.style.kind.width()).sum()
    }

    /// A run has ended: drawings that were made for it are gone, as in V-REP.
    pub(super) fn end_run(&mut self) {
        self.list.retain(|_, entry| entry.is_persistent);
    }

    /// Removes the drawings that an object carries.
    pub(super) fn forget(&mut self, own: Handle) {
        self.list.retain(|_, entry| entry.parent != Some(own));
    }
}

impl ObjectRegistry {
    /// Visible parts of an object that was made: of a runtime object, or of one that is part of the model.
    fn shown_parts(
        &self,
        of_runtime: &mut BTreeMap<Handle, Vec<RuntimePart>>,
        entry: &super::Entry,
    ) -> Vec<RuntimePart> {
        if !self.added.contains(&entry.handle) {
            return of_runtime.remove(&entry.handle).unwrap_or_default();
        }
        let x_of = entry.frame.pose.inverse();
        let own = self.senses.scenery.pieces.iter().filter(|piece| handle_of(piece) == entry.handle);
        let part = |piece: &sincro_scene::scenery::Piece| RuntimePart {
            geometry: piece.geometry.clone(),
            place: x_of.compose(&piece.at.pose),
            color: piece.color,
        };
        own.map(part).collect()
    }

    /// Calls `visit` with everything that was made at run time, and with frames of the scene that were moved.
    pub(crate) fn visit_runtime_objects(&self, visit: &mut dyn FnMut(&RuntimeObject<'_>)) {
        let mut parts = self.senses.parts_by_object();
        let is_shown =
            |e: &&super::Entry| e.is_runtime || self.moved_frames.contains(&e.handle) || self.added.contains(&e.handle);
        for entry in self.entries().filter(is_shown) {
            let kind = match entry.kind {
                Kind::Body(_) => "body",
                Kind::Joint(_) => "joint",
                Kind::Shape => "shape",
                Kind::Proximity => "proximity sensor",
                Kind::Vision(_) => "vision sensor",
                Kind::Frame => "frame",
                _ => "dummy",
            };
            visit(&RuntimeObject {
                id: entry.handle.0 as u32,
                path: &entry.path,
                kind,
                at: entry.frame,
                parts: self.shown_parts(&mut parts, entry),
                field: self.senses.proximity.get(&entry.handle).map(|known| known.sensor.field),
                drawing: None,
            });
        }
        for entry in self.drawings.list.values() {
            let at = entry.parent.and_then(|parent| self.entry(parent).ok()).map_or(WORLD, |parent| parent.frame);
            visit(&RuntimeObject {
                id: FIRST_ID + entry.serial,
                path: &entry.path,
                kind: if entry.drawing.style.kind == DrawingKind::Particles { "particles" } else { "drawing" },
                at,
                parts: Vec::new(),
                field: None,
                drawing: Some(&entry.drawing),
            });
        }
    }
}
