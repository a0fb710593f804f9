//! Parameters of vision sensors, by the numbers that clients use for them.

use super::program::unknown;
use super::registry::Handle;
use super::{ApiError, SimApi};
use sincro_scene::camera::Optics;

/// View angle of a vision sensor that was orthographic `[rad]`: 60°, as V-REP has it.
const DEFAULT_ANGLE: f64 = std::f64::consts::FRAC_PI_3;

/// Way in which a vision sensor draws.
const RENDER_MODE: i64 = 1017;

impl SimApi<'_> {
    /// Pixels of a vision sensor, and whether lines meet in its pictures.
    pub(super) fn set_vision_int(&mut self, handle: Handle, id: i64, value: i64) -> Result<(), ApiError> {
        if id == 1008 {
            return self.set_shown(handle, value);
        }
        let optics = self.registry.vision_sensor(handle)?.optics;
        if id == RENDER_MODE {
            if value != 0 {
                let path = self.registry.entry(handle)?.path.clone();
                let text =
                    format!("render mode {value} of `{path}` is not taken: pictures are drawn in one way, by colour");
                self.log(300, &text);
            }
            return Ok(());
        }
        let side = usize::try_from(value).unwrap_or_default();
        let [columns, rows] = optics.resolution;
        let changed = match id {
            1002 => Optics { resolution: [side, rows], ..optics },
            1003 => Optics { resolution: [columns, side], ..optics },
            1018 if value != 0 && optics.view_angle() == 0.0 => optics.with_view_angle(DEFAULT_ANGLE),
            1018 if value == 0 && optics.view_size() == 0.0 => optics.with_view_size(1.0),
            1018 => optics,
            // V-REP's angles and sizes are those of the longer side: they stay, the height follows
            _ => return Err(unknown("settable whole-number vision sensor", id)),
        };
        let (is_flat, angle, size) = (optics.view_angle() == 0.0, optics.view_angle(), optics.view_size());
        let follows = matches!(id, 1002 | 1003) && side > 0;
        let changed = match (follows, is_flat) {
            (false, _) => changed,
            (true, true) => changed.with_view_size(size),
            (true, false) => changed.with_view_angle(angle),
        };
        self.registry.change_vision(handle, |sensor| sensor.optics = changed)
    }

    /// Sets the clipping planes and the field of view of a vision sensor.
    pub(super) fn set_vision_float(&mut self, handle: Handle, id: i64, value: f64) -> Result<(), ApiError> {
        let optics = self.registry.vision_sensor(handle)?.optics;
        let is_flat = optics.view_angle() == 0.0;
        let changed = match id {
            1000 => Optics { near: value, ..optics },
            1001 => Optics { far: value, ..optics },
            // of the other lens it is taken and has no effect, as there is only one
            1004 if is_flat => optics,
            1004 => super::vision::with_angle(optics, value)?,
            1005 if is_flat => optics.with_view_size(value),
            1005 => optics,
            _ => return Err(unknown("float vision sensor", id)),
        };
        self.registry.change_vision(handle, |sensor| sensor.optics = changed)
    }
}

/// Whole numbers of a vision sensor: pixels, what is drawn how (all, by one way), whether lines meet.
pub(super) fn vision_int(optics: &Optics, id: i64) -> Result<i64, ApiError> {
    Ok(match id {
        1002 => optics.resolution[0] as i64,
        1003 => optics.resolution[1] as i64,
        // lights that are off, attributes of drawing, its way (OpenGL is the nearest in kind), colours and depths that
        // are left out
        1006 | 1007 | 1017 | 1020 | 1021 => 0,
        1018 => i64::from(optics.view_angle() > 0.0),
        _ => return Err(unknown("whole-number vision sensor", id)),
    })
}

/// Numbers of a vision sensor: where pictures begin and end `[m]`, angle `[rad]` or size `[m]` of the longer side.
pub(super) fn vision_float(optics: &Optics, id: i64) -> Result<f64, ApiError> {
    match id {
        1000 => Ok(optics.near),
        1001 => Ok(optics.far),
        1004 => Ok(optics.view_angle()),
        1005 => Ok(optics.view_size()),
        _ => Err(unknown("float vision sensor", id)),
    }
}
