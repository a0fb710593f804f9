//! Vision sensors: cameras whose pictures clients and scripts read.
//!
//! As in V-REP a picture is that of the last handling: at the end of every step of clients and scripts, before the
//! scripts sense; that of a sensor with explicit handling when a client or script asks. It is drawn when somebody reads
//! it, from the coordinates kept at the handling: a sensor that nobody reads costs nothing, and looking changes
//! nothing. Before its first handling a sensor shows what it would see now.

use sincro_dynamics::kinematics;
use sincro_dynamics::scratch::Scratch;

use super::filters::Filtered;
use super::registry::{Handle, Kind, ObjectRegistry};
use super::senses::handle_of;
use super::{ApiError, Entity, SimApi};
use sincro_scene::camera::{Image, Layer, Optics, Part, Renderer};
use sincro_scene::scene::VisionSensor;
use sincro_scene::scenery::visible;

/// Pixels that all vision sensors may have together: 16 Mi, which take 250 MB once they are read.
const MAX_PIXELS: usize = 1 << 24;

/// The vision sensors of a registry.
#[derive(Clone, Debug, Default)]
pub(super) struct Vision {
    slots: Vec<SensorSlot>,
    /// Coordinates at the last handling of all that are not handled explicitly.
    q: Vec<f64>,
    buffers: DrawingBuffers,
}

/// One of them.
#[derive(Clone, Debug)]
struct SensorSlot {
    sensor: VisionSensor,
    /// Made by a client or script; none of the scene's.
    is_runtime: bool,
    is_removed: bool,
    shows: ImageState,
    image: Option<Image>,
    /// Entity that a client or script has it show; all by default.
    entity: Entity,
    filtered: Filtered,
}

impl SensorSlot {
    /// Forgets the picture and what was made of it.
    fn forget(&mut self) {
        (self.shows, self.image, self.filtered) = (ImageState::Nothing, None, Filtered::default());
    }
}

/// State of the image of a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ImageState {
    /// Not handled since the run began.
    Nothing,
    /// Handled, not drawn yet.
    Handled,
    /// Drawn, or written by a client.
    Drawn,
}

/// Renderer and scratch of drawing; a copy starts empty.
#[derive(Debug, Default)]
struct DrawingBuffers {
    renderer: Option<Renderer>,
    scratch: Option<Scratch<f64>>,
}

impl Clone for DrawingBuffers {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Which sensors are handled or reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sensors {
    /// All.
    All,
    /// All but those with explicit handling.
    NotExplicit,
    /// One.
    One(Handle),
}

impl Vision {
    /// Adds a sensor; its index.
    pub fn add(&mut self, sensor: VisionSensor, is_runtime: bool) -> usize {
        let shows = ImageState::Nothing;
        let (entity, filtered) = (Entity::All, Filtered::default());
        let slot = SensorSlot { sensor, is_runtime, is_removed: false, shows, image: None, entity, filtered };
        match self.slots.iter().position(|slot| slot.is_removed) {
            Some(k) => {
                self.slots[k] = slot;
                k
            }
            None => {
                self.slots.push(slot);
                self.slots.len() - 1
            }
        }
    }

    pub fn remove(&mut self, k: usize) {
        self.slots[k].is_removed = true;
        self.slots[k].forget();
    }

    /// All that are not handled explicitly are handled.
    pub fn handle(&mut self, q: &[f64]) {
        let mut is_used = false;
        for slot in self.slots.iter_mut().filter(|slot| !slot.sensor.is_explicit && !slot.sensor.is_external) {
            (slot.shows, is_used) = (ImageState::Handled, true);
            slot.filtered.begin();
        }
        if is_used {
            self.q.clear();
            self.q.extend_from_slice(q);
        }
    }

    /// The structure has changed: pictures that were handled have been drawn, and what draws them is made again.
    pub fn restructured(&mut self) {
        self.q.clear();
        self.buffers.scratch = None;
    }

    /// Entities that the sensors show.
    pub fn entities(&self) -> impl Iterator<Item = Entity> {
        self.slots.iter().map(|slot| slot.entity)
    }

    /// Sensors that were to show an entity that has gone show all.
    pub fn show_all_for(&mut self, entity: Entity) {
        self.slots.iter_mut().filter(|slot| slot.entity == entity).for_each(|slot| slot.entity = Entity::All);
    }

    /// Forgets all pictures.
    pub fn forget(&mut self) {
        self.slots.iter_mut().for_each(SensorSlot::forget);
    }

    /// Sensors of the scene are as they were `before` a run.
    pub fn end_run(&mut self, before: Self) {
        self.forget();
        for (now, then) in self.slots.iter_mut().zip(before.slots) {
            if !now.is_runtime {
                (now.sensor, now.entity) = (then.sensor, then.entity);
            }
        }
    }

    /// Refuses pixels that would be too many together with those of all sensors but `except`.
    fn check_stored_size(&self, optics: &Optics, except: Option<usize>) -> Result<(), ApiError> {
        let area = |optics: &Optics| optics.resolution[0] * optics.resolution[1];
        let others = self.slots.iter().enumerate().filter(|(k, slot)| !slot.is_removed && Some(*k) != except);
        let taken: usize = others.map(|(_, slot)| area(&slot.sensor.optics)).sum();
        if taken + area(optics) > MAX_PIXELS {
            return Err(ApiError(format!(
                "all vision sensors together would have more than {MAX_PIXELS} pixels: remove some, or give them fewer"
            )));
        }
        Ok(())
    }
}

fn checked(optics: &Optics) -> Result<(), ApiError> {
    optics.check().map_err(|wrong| ApiError(format!("{} cannot be: expected {}", wrong.found, wrong.expected)))
}

/// Another angle over the longer side `[rad]`, if it is one.
pub(super) fn with_angle(optics: Optics, angle: f64) -> Result<Optics, ApiError> {
    if angle > 0.0 && angle < std::f64::consts::PI {
        return Ok(optics.with_view_angle(angle));
    }
    Err(ApiError(format!("a view angle of {angle} rad cannot be: expected more than 0 and less than π")))
}

impl ObjectRegistry {
    /// The index of the vision sensor of a handle.
    fn vision_index(&self, handle: Handle) -> Result<usize, ApiError> {
        let entry = self.entry(handle)?;
        let Kind::Vision(k) = entry.kind else {
            let help = "give a [[camera]] of the scene a `resolution`, or make one with createVisionSensor";
            return Err(ApiError(format!("`{}` is no vision sensor: {help}", entry.path)));
        };
        Ok(k)
    }

    /// Settings of a vision sensor as they are now: optics (angles `[rad]`, distances `[m]`, resolution in pixels),
    /// background, handling.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or is no vision sensor.
    pub fn vision_sensor(&self, handle: Handle) -> Result<&VisionSensor, ApiError> {
        Ok(&self.vision.slots[self.vision_index(handle)?].sensor)
    }

    /// Objects that a vision sensor may show, in ascending order: those of its entity that are renderable and on a
    /// layer that is shown.
    fn seen_by(&self, k: usize) -> Vec<Handle> {
        let entity = self.vision.slots[k].entity;
        let overrides = matches!(entity, Entity::Collection(own) if self.overrides_flags(own));
        let members = self.members(entity).unwrap_or_default();
        members.into_iter().filter(|own| overrides || self.is_seen(*own)).collect()
    }

    /// Number of the entity that a vision sensor shows, −1 for all.
    pub(super) fn shown_number(&self, handle: Handle) -> Result<i64, ApiError> {
        Ok(self.vision.slots[self.vision_index(handle)?].entity.number())
    }

    /// Work image of a vision sensor, and what its script has made of its picture.
    pub(super) fn filtered(&mut self, handle: Handle) -> Result<&mut Filtered, ApiError> {
        let k = self.vision_index(handle)?;
        Ok(&mut self.vision.slots[k].filtered)
    }

    /// Those of all vision sensors.
    pub(super) fn all_filtered(&self) -> impl Iterator<Item = &Filtered> {
        self.vision.slots.iter().map(|slot| &slot.filtered)
    }

    /// Changes a vision sensor; its picture is forgotten if that has another size or another lens.
    ///
    /// # Errors
    ///
    /// There is no such object, it is none, or its pictures could not be drawn; it is then as it was.
    pub(crate) fn change_vision(
        &mut self,
        handle: Handle,
        change: impl FnOnce(&mut VisionSensor),
    ) -> Result<(), ApiError> {
        let k = self.vision_index(handle)?;
        let mut sensor = self.vision.slots[k].sensor.clone();
        change(&mut sensor);
        checked(&sensor.optics)?;
        self.vision.check_stored_size(&sensor.optics, Some(k))?;
        let slot = &mut self.vision.slots[k];
        if slot.sensor.optics != sensor.optics {
            slot.forget();
        }
        slot.sensor = sensor;
        Ok(())
    }

    /// Makes a vision sensor in the world's origin.
    ///
    /// # Errors
    ///
    /// There are too many objects or pixels, or its pictures could not be drawn.
    pub(crate) fn create_vision_sensor(&mut self, sensor: VisionSensor) -> Result<Handle, ApiError> {
        checked(&sensor.optics)?;
        self.vision.check_stored_size(&sensor.optics, None)?;
        let handle = self.create_dummy("VisionSensor")?;
        self.entry_mut(handle).kind = Kind::Vision(self.vision.add(sensor, true));
        Ok(handle)
    }

    /// Forgets the pictures of vision sensors.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is none.
    pub(crate) fn reset_vision(&mut self, which: Sensors) -> Result<(), ApiError> {
        let one = match which {
            Sensors::One(handle) => Some(self.vision_index(handle)?),
            _ => None,
        };
        for (k, slot) in self.vision.slots.iter_mut().enumerate() {
            if one.is_none_or(|one| one == k) && (which != Sensors::NotExplicit || !slot.sensor.is_explicit) {
                slot.forget();
            }
        }
        Ok(())
    }
}

impl SimApi<'_> {
    /// Lets a vision sensor show the objects of one entity alone, from now on.
    ///
    /// # Errors
    ///
    /// `handle` is no vision sensor, or the entity is none.
    pub(super) fn set_shown(&mut self, handle: Handle, entity: i64) -> Result<(), ApiError> {
        let (k, entity) = (self.registry.vision_index(handle)?, self.chosen(entity)?);
        self.finish_picture(handle);
        self.registry.vision.slots[k].entity = entity;
        Ok(())
    }

    /// Handles vision sensors: what they show is what is seen now. Sensors with external input keep what was written.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is none.
    pub(crate) fn handle_vision(&mut self, which: Sensors) -> Result<(), ApiError> {
        let q = std::mem::take(&mut self.world.state.q);
        if which != Sensors::NotExplicit {
            let entries = self.registry.entries().filter(|e| matches!(e.kind, Kind::Vision(_)));
            let all: Vec<Handle> = entries.map(|e| e.handle).collect();
            let wanted = |handle: &Handle| which == Sensors::All || which == Sensors::One(*handle);
            for handle in all.into_iter().filter(wanted) {
                let k = self.registry.vision_index(handle).unwrap_or_default();
                let sensor = &self.registry.vision.slots[k].sensor;
                if !sensor.is_external && (sensor.is_explicit || which != Sensors::All) {
                    self.draw(handle, k, &q);
                    self.registry.vision.slots[k].shows = ImageState::Drawn;
                    self.registry.vision.slots[k].filtered.begin();
                }
            }
        }
        if !matches!(which, Sensors::One(_)) {
            self.registry.vision.handle(&q);
        }
        self.world.state.q = q;
        match which {
            Sensors::One(handle) => self.registry.vision_index(handle).map(|_| ()),
            _ => Ok(()),
        }
    }

    /// Image of a vision sensor as of its last handling; before the first one, what it sees now. Clients that only read
    /// it change nothing.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or is no vision sensor.
    pub fn vision_image(&mut self, handle: Handle) -> Result<&Image, ApiError> {
        let k = self.registry.vision_index(handle)?;
        let slot = &self.registry.vision.slots[k];
        match slot.shows {
            ImageState::Handled => {
                let q = std::mem::take(&mut self.registry.vision.q);
                self.draw(handle, k, &q);
                (self.registry.vision.q, self.registry.vision.slots[k].shows) = (q, ImageState::Drawn);
            }
            ImageState::Nothing if !slot.sensor.is_external => {
                let q = std::mem::take(&mut self.world.state.q);
                self.draw(handle, k, &q);
                self.world.state.q = q;
            }
            _ => {}
        }
        let slot = &mut self.registry.vision.slots[k];
        let (optics, background) = (slot.sensor.optics, slot.sensor.background);
        Ok(slot.image.get_or_insert_with(|| {
            let mut image = Image::new(&optics);
            image.clear(&optics, background);
            image
        }))
    }

    /// Statistics of the image of a vision sensor, dimensionless from 0 to 1: five minima, five maxima and five means
    /// of intensity, red, green, blue and depth, in this order. None before its first handling, but at the start of
    /// a run those of what it sees then, as proximity sensors detect what is there, unless it has explicit handling.
    ///
    /// # Errors
    ///
    /// `handle` is no object, or is no vision sensor.
    pub(super) fn vision_statistics(&mut self, handle: Handle) -> Result<Option<[f64; 15]>, ApiError> {
        let k = self.registry.vision_index(handle)?;
        let slot = &self.registry.vision.slots[k];
        let begins = self.is_running() && self.world.state.tick == 0;
        let waits = slot.sensor.is_explicit || slot.sensor.is_external || !begins;
        if slot.shows == ImageState::Nothing && waits {
            return Ok(None);
        }
        Ok(Some(self.vision_image(handle)?.statistics()))
    }

    /// Overwrites the colours of a part (position of its lower left corner, columns and rows, in pixels) of a vision
    /// sensor's image. `bytes` holds the pixels row by row from the lowest, 1 (grey) or 3 (red, green, blue) bytes
    /// each, and one of opacity, which is ignored, if `layer` has it. The next handling draws over it, unless the
    /// sensor has external input.
    ///
    /// # Errors
    ///
    /// `handle` is no object or no vision sensor, the part does not lie in its image, or `bytes` are fewer than the
    /// part has.
    pub fn write_vision(&mut self, handle: Handle, part: Part, layer: Layer, bytes: &[u8]) -> Result<(), ApiError> {
        self.has_part(handle, part)?;
        let n = part.size[0] * part.size[1] * layer.width();
        if bytes.len() < n {
            return Err(ApiError(format!("there are {} bytes, expected {n}", bytes.len())));
        }
        let k = self.registry.vision_index(handle)?;
        self.vision_image(handle)?;
        let slot = &mut self.registry.vision.slots[k];
        if let Some(image) = &mut slot.image {
            image.write(part, layer, bytes);
        }
        slot.shows = ImageState::Drawn;
        Ok(())
    }

    /// Returns true if a part lies in the picture of a vision sensor.
    ///
    /// # Errors
    ///
    /// It does not.
    pub(crate) fn has_part(&mut self, handle: Handle, part: Part) -> Result<(), ApiError> {
        let [columns, rows] = self.registry.vision_sensor(handle)?.optics.resolution;
        let fits = |k: usize, n: usize| {
            part.size[k] > 0 && part.position[k].checked_add(part.size[k]).is_some_and(|end| end <= n)
        };
        if fits(0, columns) && fits(1, rows) {
            return Ok(());
        }
        let ([x, y], [w, h]) = (part.position, part.size);
        Err(ApiError(format!("a part of {w} × {h} pixels at {x}, {y} is not in a picture of {columns} × {rows}")))
    }

    /// Image of one object alone, or of all, now; true if it is in the image. The sensor's own image stays.
    ///
    /// # Errors
    ///
    /// There is no such object, it is none, or it has external input.
    pub(crate) fn check_vision(&mut self, handle: Handle, object: Option<Handle>) -> Result<(bool, Image), ApiError> {
        let k = self.registry.vision_index(handle)?;
        if self.registry.vision.slots[k].sensor.is_external {
            return Err(ApiError::new("the vision sensor has external input: it sees nothing by itself"));
        }
        if let Some(object) = object {
            self.registry.entry(object)?;
        }
        let kept = self.registry.vision.slots[k].image.take();
        let q = std::mem::take(&mut self.world.state.q);
        self.draw_some(handle, k, &q, object);
        self.world.state.q = q;
        let image = std::mem::replace(&mut self.registry.vision.slots[k].image, kept);
        let image = image.ok_or_else(|| ApiError::new("nothing was drawn"))?;
        let is_seen = image.pieces().iter().any(|piece| *piece != sincro_scene::camera::NO_PIECE);
        Ok((is_seen, image))
    }

    /// A sensor that is about to be moved has the picture of where it was, and where something is about to change that
    /// others see, they have theirs.
    pub(super) fn before_move(&mut self, handle: Handle) {
        if self.registry.vision_index(handle).is_ok() {
            self.finish_picture(handle);
        } else if self.registry.senses.has_runtime_pieces(handle) {
            self.finish_pictures();
        }
    }

    /// Draws the images of the last handling, before pieces are added, coloured or removed.
    pub(super) fn finish_pictures(&mut self) {
        let slots = self.registry.entries().filter(|e| matches!(e.kind, Kind::Vision(_)));
        for handle in slots.map(|e| e.handle).collect::<Vec<_>>() {
            self.finish_picture(handle);
        }
    }

    fn finish_picture(&mut self, handle: Handle) {
        if let Ok(k) = self.registry.vision_index(handle)
            && self.registry.vision.slots[k].shows == ImageState::Handled
        {
            // it exists: nothing is refused
            let _ = self.vision_image(handle);
        }
    }

    fn draw(&mut self, handle: Handle, k: usize, q: &[f64]) {
        self.draw_some(handle, k, q, None);
    }

    /// Draws what sensor `k` sees at coordinates `q`: all, or one object alone.
    fn draw_some(&mut self, handle: Handle, k: usize, q: &[f64], object: Option<Handle>) {
        let (model, registry) = (self.world.model(), &mut *self.registry);
        let Ok(frame) = registry.entry(handle).map(|entry| entry.frame) else { return };
        let seen = registry.seen_by(k);
        let Vision { slots, buffers, .. } = &mut registry.vision;
        let scratch = buffers.scratch.get_or_insert_with(|| Scratch::new(model));
        kinematics::poses(model, q, scratch);
        let x_wc = kinematics::frame_pose(scratch, &frame);
        let (senses, SensorSlot { sensor, image, .. }) = (&registry.senses, &mut slots[k]);
        let image = image.get_or_insert_with(|| Image::new(&sensor.optics));
        let is_wanted = |own: Handle| object.is_none_or(|object| own == object) && seen.binary_search(&own).is_ok();
        let pieces = senses.pieces().filter(|piece| is_wanted(handle_of(piece)));
        let pieces = visible(pieces, scratch);
        buffers.renderer.get_or_insert_default().draw(pieces, (&x_wc, &sensor.optics), sensor.background, image);
    }
}
