//! Drawings and particles that clients and scripts make: items in the world or in the frame of an object, shown in the
//! viewer. No step and no sensor knows them.

use std::collections::BTreeMap;

use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_sim::runtime_object::{Drawing, DrawingKind, DrawingStyle, RuntimeObject, RuntimePart};

use super::registry::{Handle, Kind, ObjectRegistry, WORLD};
use super::{ApiError, SimApi};

/// Drawings that may exist at once.
const MAX_DRAWINGS: usize = 10_000;
/// Items of one drawing.
const MAX_ITEMS: i64 = 200_000;
/// Numbers from which on identifiers of drawings begin, behind those of objects.
const FIRST_ID: u32 = 1 << 31;

/// Drawings and particles of a registry by their handles, which are not those of objects.
#[derive(Clone, Debug, Default)]
pub(super) struct Drawings {
    list: BTreeMap<i64, Entry>,
    n_made: i64,
}

/// A drawing and what it hangs on.
#[derive(Clone, Debug)]
struct Entry {
    path: String,
    parent: Option<Handle>,
    drawing: Drawing,
    layout: ItemLayout,
    /// True if it outlives the run in which it was made.
    is_persistent: bool,
}

/// Numbers of an item as clients give them, and what is done with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ItemLayout {
    /// Numbers that are drawn: positions, or position and velocity.
    pub n_drawn: usize,
    /// All numbers of an item.
    pub n_given: usize,
    /// Items nearer than this to another one are left out `[m]`.
    pub tolerance: f64,
    /// True if positions are in the frame of the parent, not in the world.
    pub is_local: bool,
}

/// Request for a drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawingRequest {
    pub style: DrawingStyle,
    pub layout: ItemLayout,
    pub parent: Option<Handle>,
    /// Items that it may have.
    pub capacity: i64,
    pub is_cyclic: bool,
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
        let DrawingStyle { size, lifetime, .. } = request.style;
        if !(size.is_finite() && size >= 0.0 && lifetime.is_finite()) {
            return Err(ApiError(format!("{size} is no size of an item")));
        }
        let drawings = &mut self.registry.drawings;
        if drawings.list.len() >= MAX_DRAWINGS {
            return Err(ApiError(format!("there are {MAX_DRAWINGS} drawings already: remove some")));
        }
        drawings.n_made += 1;
        let handle = drawings.n_made;
        let capacity = request.capacity.clamp(0, MAX_ITEMS) as usize;
        let what = if request.style.kind == DrawingKind::Particles { "particles" } else { "drawing" };
        let entry = Entry {
            path: format!("/{what}{handle}"),
            parent: request.parent,
            drawing: Drawing::new(request.style, capacity, request.is_cyclic),
            layout: request.layout,
            is_persistent: request.is_persistent,
        };
        drawings.list.insert(handle, entry);
        Ok(handle)
    }

    /// Adds items to a drawing, or the first alone unless `all`; no numbers remove all items. Returns false if an item
    /// was not taken because the drawing is full.
    ///
    /// # Errors
    ///
    /// There is no such drawing, or the numbers are fewer than an item has, or not finite.
    pub(crate) fn draw_items(&mut self, handle: i64, numbers: &[f64], all: bool) -> Result<bool, ApiError> {
        let (layout, parent, kind) = {
            let entry = self.registry.drawings.entry(handle)?;
            (entry.layout, entry.parent, entry.drawing.style.kind)
        };
        if numbers.is_empty() {
            self.registry.drawings.entry(handle)?.drawing.clear();
            return Ok(true);
        }
        let (n, given) = (numbers.len(), layout.n_given);
        if n < given || numbers.iter().any(|x| !x.is_finite()) {
            return Err(ApiError(format!("{n} numbers for an item that has {given}, all finite")));
        }
        let carrier = match parent {
            Some(parent) => self.registry.entry(parent)?.moving,
            None => WORLD,
        };
        let x_pw = if layout.is_local { Pose::identity() } else { self.place(&carrier).inverse() };
        let (t, drawing) = (self.t, &mut self.registry.drawings.entry(handle)?.drawing);
        let mut all_taken = true;
        for item in numbers.chunks_exact(given).take(if all { usize::MAX } else { 1 }) {
            let three = |k: usize| Vec3([item[k], item[k + 1], item[k + 2]]);
            let mut own = Vec::with_capacity(kind.width());
            if kind == DrawingKind::Particles {
                own.extend(x_pw.point(three(0)).0);
                own.extend(x_pw.rot.mul_vec(three(3)).0);
                own.push(t);
            } else {
                (0..layout.n_drawn).step_by(3).for_each(|k| own.extend(x_pw.point(three(k)).0));
            }
            let first = Vec3([own[0], own[1], own[2]]);
            if layout.tolerance > 0.0 && drawing.has_near(first, layout.tolerance) {
                continue;
            }
            all_taken &= drawing.push(&own);
        }
        Ok(all_taken)
    }

    /// Removes a drawing, or all of them for none.
    ///
    /// # Errors
    ///
    /// There is no such drawing.
    pub(crate) fn remove_drawing(&mut self, handle: Option<i64>) -> Result<(), ApiError> {
        match handle {
            None => self.registry.drawings.list.clear(),
            Some(handle) => {
                self.registry.drawings.entry(handle)?;
                self.registry.drawings.list.remove(&handle);
            }
        }
        Ok(())
    }
}

impl Drawings {
    fn entry(&mut self, handle: i64) -> Result<&mut Entry, ApiError> {
        self.list.get_mut(&handle).ok_or_else(|| ApiError(format!("there is no drawing {handle}")))
    }

    /// A run has ended: drawings that were made for it are gone, as in V-REP.
    pub(super) fn end_run(&mut self) {
        self.list.retain(|_, entry| entry.is_persistent);
    }

    /// Removes the drawings of an object.
    pub(super) fn forget(&mut self, own: Handle) {
        self.list.retain(|_, entry| entry.parent != Some(own));
    }
}

impl ObjectRegistry {
    /// Calls `visit` with everything that was made at run time, and with frames of the scene that were moved.
    pub(crate) fn visit_runtime_objects(&self, visit: &mut dyn FnMut(&RuntimeObject<'_>)) {
        for entry in self.entries().filter(|e| e.is_runtime || self.moved_frames.contains(&e.handle)) {
            let kind = match entry.kind {
                Kind::Shape => "shape",
                Kind::Proximity => "proximity sensor",
                Kind::Vision(_) => "vision sensor",
                Kind::Frame => "frame",
                _ => "dummy",
            };
            let parts = self.senses.parts_of(entry.handle);
            let part = |(piece, place): (sincro_scene::scenery::Piece, Pose<f64>)| RuntimePart {
                geometry: piece.geometry,
                place,
                color: piece.color,
            };
            visit(&RuntimeObject {
                id: entry.handle.0 as u32,
                path: &entry.path,
                kind,
                at: entry.frame,
                parts: parts.into_iter().map(part).collect(),
                field: self.senses.proximity.get(&entry.handle).map(|known| known.sensor.field),
                drawing: None,
            });
        }
        for (handle, entry) in &self.drawings.list {
            let at = entry.parent.and_then(|parent| self.entry(parent).ok()).map_or(WORLD, |parent| parent.moving);
            visit(&RuntimeObject {
                id: FIRST_ID + *handle as u32,
                path: &entry.path,
                kind: if entry.drawing.style.kind == DrawingKind::Particles { "particles" } else { "drawing" },
                at: Attached { ..at },
                parts: Vec::new(),
                field: None,
                drawing: Some(&entry.drawing),
            });
        }
    }
}
