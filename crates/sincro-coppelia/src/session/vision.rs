//! Vision sensors: cameras whose pictures clients and scripts read.
//!
//! As in V-REP a picture is that of the last handling: at the end of every step of clients and scripts, before the scripts sense; that of a sensor
//! with explicit handling when a client or script asks. It is drawn when somebody reads it, from the coordinates kept at the handling: a sensor that
//! nobody reads costs nothing, and looking changes nothing. Before its first handling a sensor shows what it would see now.

use sincro_dynamics::kinematics;
use sincro_dynamics::scratch::Scratch;

use super::senses::handle_of;
use super::table::{Handle, Kind, Table};
use super::{Desk, Refusal};
use sincro_scene::camera::{Image, Layer, Optics, Part, Renderer};
use sincro_scene::scene::VisionSensor;
use sincro_scene::scenery::placed;

/// Pixels that all vision sensors may have together: 16 Mi, which take 250 MB once they are read.
const MOST_PIXELS: usize = 1 << 24;

/// The vision sensors of a table.
#[derive(Clone, Debug, Default)]
pub(super) struct Vision {
    eyes: Vec<Eye>,
    /// Coordinates at the last handling of all that are not handled explicitly.
    q: Vec<f64>,
    studio: Studio,
}

/// One of them.
#[derive(Clone, Debug)]
struct Eye {
    sensor: VisionSensor,
    /// Made by a client or script; none of the scene's.
    is_made: bool,
    is_removed: bool,
    shows: Shows,
    image: Option<Image>,
}

/// What the picture of a sensor is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shows {
    /// Not handled since the run began.
    Nothing,
    /// Handled, not drawn yet.
    Handled,
    /// Drawn, or written by a client.
    Drawn,
}

/// What drawing needs besides; a copy begins anew.
#[derive(Debug, Default)]
struct Studio {
    renderer: Option<Renderer>,
    scratch: Option<Scratch<f64>>,
}

impl Clone for Studio {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Which sensors are handled or reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensors {
    /// All.
    All,
    /// All but those with explicit handling.
    NotExplicit,
    /// One.
    One(Handle),
}

impl Vision {
    /// Adds a sensor; its index.
    pub fn add(&mut self, sensor: VisionSensor, is_made: bool) -> usize {
        let eye = Eye { sensor, is_made, is_removed: false, shows: Shows::Nothing, image: None };
        match self.eyes.iter().position(|eye| eye.is_removed) {
            Some(k) => {
                self.eyes[k] = eye;
                k
            }
            None => {
                self.eyes.push(eye);
                self.eyes.len() - 1
            }
        }
    }

    pub fn remove(&mut self, k: usize) {
        (self.eyes[k].is_removed, self.eyes[k].image) = (true, None);
    }

    /// All that are not handled explicitly are handled.
    pub fn handle(&mut self, q: &[f64]) {
        let mut is_used = false;
        for eye in self.eyes.iter_mut().filter(|eye| !eye.sensor.is_explicit && !eye.sensor.is_external) {
            (eye.shows, is_used) = (Shows::Handled, true);
        }
        if is_used {
            self.q.clear();
            self.q.extend_from_slice(q);
        }
    }

    /// Forgets all pictures.
    pub fn forget(&mut self) {
        for eye in &mut self.eyes {
            (eye.shows, eye.image) = (Shows::Nothing, None);
        }
    }

    /// Sensors of the scene are as they were `before` a run.
    pub fn end_run(&mut self, before: Self) {
        self.forget();
        for (now, then) in self.eyes.iter_mut().zip(before.eyes) {
            if !now.is_made {
                now.sensor = then.sensor;
            }
        }
    }

    /// Refuses pixels that would be too many together with those of all sensors but `except`.
    fn make_room(&self, optics: &Optics, except: Option<usize>) -> Result<(), Refusal> {
        let area = |optics: &Optics| optics.resolution[0] * optics.resolution[1];
        let others = self.eyes.iter().enumerate().filter(|(k, eye)| !eye.is_removed && Some(*k) != except);
        let taken: usize = others.map(|(_, eye)| area(&eye.sensor.optics)).sum();
        if taken + area(optics) > MOST_PIXELS {
            return Err(Refusal(format!(
                "all vision sensors together would have more than {MOST_PIXELS} pixels: remove some, or give them fewer"
            )));
        }
        Ok(())
    }
}

fn checked(optics: &Optics) -> Result<(), Refusal> {
    optics.check().map_err(|wrong| Refusal(format!("{} cannot be: expected {}", wrong.found, wrong.expected)))
}

/// Another angle over the longer side `[rad]`, if it is one.
pub(super) fn with_angle(optics: Optics, angle: f64) -> Result<Optics, Refusal> {
    if angle > 0.0 && angle < std::f64::consts::PI {
        return Ok(optics.with_view_angle(angle));
    }
    Err(Refusal(format!("a view angle of {angle} rad cannot be: expected more than 0 and less than π")))
}

impl Table {
    /// The index of the vision sensor of a handle.
    fn eye(&self, handle: Handle) -> Result<usize, Refusal> {
        let entry = self.entry(handle)?;
        let Kind::Vision(k) = entry.kind else {
            let help = "give a [[camera]] of the scene a `resolution`, or make one with createVisionSensor";
            return Err(Refusal(format!("`{}` is no vision sensor: {help}", entry.path)));
        };
        Ok(k)
    }

    /// A vision sensor as it now is.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is none.
    pub fn vision_sensor(&self, handle: Handle) -> Result<&VisionSensor, Refusal> {
        Ok(&self.vision.eyes[self.eye(handle)?].sensor)
    }

    /// Changes a vision sensor; its picture is forgotten if that has another size or another lens.
    ///
    /// # Errors
    ///
    /// There is no such object, it is none, or its pictures could not be drawn; it is then as it was.
    pub fn change_vision(&mut self, handle: Handle, change: impl FnOnce(&mut VisionSensor)) -> Result<(), Refusal> {
        let k = self.eye(handle)?;
        let mut sensor = self.vision.eyes[k].sensor.clone();
        change(&mut sensor);
        checked(&sensor.optics)?;
        self.vision.make_room(&sensor.optics, Some(k))?;
        let eye = &mut self.vision.eyes[k];
        if eye.sensor.optics != sensor.optics {
            (eye.shows, eye.image) = (Shows::Nothing, None);
        }
        eye.sensor = sensor;
        Ok(())
    }

    /// Makes a vision sensor in the world's origin.
    ///
    /// # Errors
    ///
    /// There are too many objects or pixels, or its pictures could not be drawn.
    pub fn create_vision_sensor(&mut self, sensor: VisionSensor) -> Result<Handle, Refusal> {
        checked(&sensor.optics)?;
        self.vision.make_room(&sensor.optics, None)?;
        let handle = self.create_dummy("VisionSensor")?;
        self.entry_mut(handle).kind = Kind::Vision(self.vision.add(sensor, true));
        Ok(handle)
    }

    /// Forgets the pictures of vision sensors.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is none.
    pub fn reset_vision(&mut self, which: Sensors) -> Result<(), Refusal> {
        let one = match which {
            Sensors::One(handle) => Some(self.eye(handle)?),
            _ => None,
        };
        for (k, eye) in self.vision.eyes.iter_mut().enumerate() {
            if one.is_none_or(|one| one == k) && (which != Sensors::NotExplicit || !eye.sensor.is_explicit) {
                (eye.shows, eye.image) = (Shows::Nothing, None);
            }
        }
        Ok(())
    }
}

impl Desk<'_> {
    /// Handles vision sensors: what they show is what is seen now. Sensors with external input keep what was written.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is none.
    pub fn handle_vision(&mut self, which: Sensors) -> Result<(), Refusal> {
        let q = std::mem::take(&mut self.world.state.q);
        if which != Sensors::NotExplicit {
            let entries = self.table.entries().filter(|e| matches!(e.kind, Kind::Vision(_)));
            let all: Vec<Handle> = entries.map(|e| e.handle).collect();
            let wanted = |handle: &Handle| which == Sensors::All || which == Sensors::One(*handle);
            for handle in all.into_iter().filter(wanted) {
                let k = self.table.eye(handle).unwrap_or_default();
                let sensor = &self.table.vision.eyes[k].sensor;
                if !sensor.is_external && (sensor.is_explicit || which != Sensors::All) {
                    self.draw(handle, k, &q);
                    self.table.vision.eyes[k].shows = Shows::Drawn;
                }
            }
        }
        if !matches!(which, Sensors::One(_)) {
            self.table.vision.handle(&q);
        }
        self.world.state.q = q;
        match which {
            Sensors::One(handle) => self.table.eye(handle).map(|_| ()),
            _ => Ok(()),
        }
    }

    /// The picture of a vision sensor, of its last handling.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is none.
    ///
    /// # Panics
    ///
    /// Never: a picture has been drawn.
    pub fn vision_image(&mut self, handle: Handle) -> Result<&Image, Refusal> {
        let k = self.table.eye(handle)?;
        let eye = &self.table.vision.eyes[k];
        match eye.shows {
            Shows::Handled => {
                let q = std::mem::take(&mut self.table.vision.q);
                self.draw(handle, k, &q);
                (self.table.vision.q, self.table.vision.eyes[k].shows) = (q, Shows::Drawn);
            }
            Shows::Nothing if !eye.sensor.is_external => {
                let q = std::mem::take(&mut self.world.state.q);
                self.draw(handle, k, &q);
                self.world.state.q = q;
            }
            _ => {}
        }
        let eye = &mut self.table.vision.eyes[k];
        let (optics, background) = (eye.sensor.optics, eye.sensor.background);
        Ok(eye.image.get_or_insert_with(|| {
            let mut image = Image::new(&optics);
            image.clear(&optics, background);
            image
        }))
    }

    /// What is known of the picture of a vision sensor: least, greatest and mean of intensity, red, green, blue and depth. None before its first
    /// handling.
    ///
    /// # Errors
    ///
    /// There is no such object, or it is none.
    pub fn read_vision(&mut self, handle: Handle) -> Result<Option<[f64; 15]>, Refusal> {
        let k = self.table.eye(handle)?;
        if self.table.vision.eyes[k].shows == Shows::Nothing {
            return Ok(None);
        }
        Ok(Some(self.vision_image(handle)?.statistics()))
    }

    /// Writes into the picture of a vision sensor; the next handling draws over it unless the sensor has external input.
    ///
    /// # Errors
    ///
    /// There is no such object, it is none, the part is not in its picture, or there are fewer bytes than that has.
    pub fn write_vision(&mut self, handle: Handle, part: Part, layer: Layer, bytes: &[u8]) -> Result<(), Refusal> {
        self.has_part(handle, part)?;
        let n = part.size[0] * part.size[1] * layer.width();
        if bytes.len() < n {
            return Err(Refusal(format!("there are {} bytes, expected {n}", bytes.len())));
        }
        let k = self.table.eye(handle)?;
        self.vision_image(handle)?;
        let eye = &mut self.table.vision.eyes[k];
        if let Some(image) = &mut eye.image {
            image.write(part, layer, bytes);
        }
        eye.shows = Shows::Drawn;
        Ok(())
    }

    /// Whether a part lies in the picture of a vision sensor.
    ///
    /// # Errors
    ///
    /// It does not.
    pub fn has_part(&mut self, handle: Handle, part: Part) -> Result<(), Refusal> {
        let [columns, rows] = self.table.vision_sensor(handle)?.optics.resolution;
        let fits = |k: usize, n: usize| {
            part.size[k] > 0 && part.position[k].checked_add(part.size[k]).is_some_and(|end| end <= n)
        };
        if fits(0, columns) && fits(1, rows) {
            return Ok(());
        }
        let ([x, y], [w, h]) = (part.position, part.size);
        Err(Refusal(format!("a part of {w} × {h} pixels at {x}, {y} is not in a picture of {columns} × {rows}")))
    }

    /// What a vision sensor sees now of one object alone, or of all; whether it is in the picture. The sensor's own picture stays.
    ///
    /// # Errors
    ///
    /// There is no such object, it is none, or it has external input.
    pub fn check_vision(&mut self, handle: Handle, object: Option<Handle>) -> Result<(bool, Image), Refusal> {
        let k = self.table.eye(handle)?;
        if self.table.vision.eyes[k].sensor.is_external {
            return Err(Refusal::new("the vision sensor has external input: it sees nothing by itself"));
        }
        if let Some(object) = object {
            self.table.entry(object)?;
        }
        let kept = self.table.vision.eyes[k].image.take();
        let q = std::mem::take(&mut self.world.state.q);
        self.draw_some(handle, k, &q, object);
        self.world.state.q = q;
        let image = std::mem::replace(&mut self.table.vision.eyes[k].image, kept);
        let image = image.ok_or_else(|| Refusal::new("nothing was drawn"))?;
        let is_seen = image.pieces().iter().any(|piece| *piece != sincro_scene::camera::NOTHING);
        Ok((is_seen, image))
    }

    /// A sensor that is about to be moved has the picture of where it was, and where something is about to change that others see, they have
    /// theirs.
    pub(super) fn before_move(&mut self, handle: Handle) {
        if self.table.eye(handle).is_ok() {
            self.finish_picture(handle);
        } else if self.table.senses.has_made(handle) {
            self.finish_pictures();
        }
    }

    /// What is made, coloured or taken away from now on is not in the pictures of the last handling.
    pub(super) fn finish_pictures(&mut self) {
        let eyes = self.table.entries().filter(|e| matches!(e.kind, Kind::Vision(_)));
        for handle in eyes.map(|e| e.handle).collect::<Vec<_>>() {
            self.finish_picture(handle);
        }
    }

    fn finish_picture(&mut self, handle: Handle) {
        if let Ok(k) = self.table.eye(handle)
            && self.table.vision.eyes[k].shows == Shows::Handled
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
        let (model, table) = (self.world.model(), &mut *self.table);
        let Ok(frame) = table.entry(handle).map(|entry| entry.frame) else { return };
        let Vision { eyes, studio, .. } = &mut table.vision;
        let scratch = studio.scratch.get_or_insert_with(|| Scratch::new(model));
        kinematics::poses(model, q, scratch);
        let x_wc = kinematics::frame_pose(scratch, &frame);
        let Eye { sensor, image, .. } = &mut eyes[k];
        let image = image.get_or_insert_with(|| Image::new(&sensor.optics));
        let pieces = table.senses.pieces().filter(|piece| object.is_none_or(|object| handle_of(piece) == object));
        let pieces = placed(pieces, scratch);
        studio.renderer.get_or_insert_default().draw(pieces, (&x_wc, &sensor.optics), sensor.background, image);
    }
}
