//! Sensors of the file: what they measure, how often, how wrong.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::object::{Object, ObjectKind};
use super::proximity::{self, ProximityFile};
use crate::diagnostic::{Diagnostic, Diagnostics, Located};
use crate::document::Document;
use crate::sensor::{Errors, SensorKind, SensorSpec};
use crate::suggest;

/// A sensor on a body or frame: sampled at its own rate, held in between.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(extend("allOf" = [
    {"not": {"required": ["rotation_deg", "quaternion_wxyz"]}},
    {"oneOf": [{"required": ["imu"]}, {"required": ["pose"]}, {"required": ["velocity"]}, {"required": ["height"]},
        {"required": ["contact"]}, {"required": ["proximity"]}]}
])))]
pub(crate) struct SensorFile {
    /// Letters, digits, `_` and `-`; the path is the parent's path, `/` and the name.
    pub name: String,
    /// Path of the body, joint or frame that carries it.
    pub parent: String,
    /// Where it is mounted in the parent frame [m].
    #[serde(default)]
    pub position: [f64; 3],
    /// Roll, pitch and yaw of its axes in the parent: R = Rz(yaw)·Ry(pitch)·Rx(roll) [deg].
    pub rotation_deg: Option<[f64; 3]>,
    /// Rotation of its axes in the parent as a quaternion (w, x, y, z), of any length but zero.
    pub quaternion_wxyz: Option<[f64; 4]>,
    /// Time between two samples: a whole number of base steps; default one [s].
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0.0)))]
    pub sample_time: Option<f64>,
    /// Accelerometer and gyro, in its own axes.
    pub imu: Option<ImuFile>,
    /// Position and attitude in the world.
    pub pose: Option<PoseFile>,
    /// Velocity of its origin, world axes.
    pub velocity: Option<NoisyFile>,
    /// Height of its origin over z = 0.
    pub height: Option<HeightFile>,
    /// Force and torque of what touches its body, own axes, about its origin.
    pub contact: Option<ContactSensorFile>,
    /// What of other bodies is closest inside a volume before it.
    pub proximity: Option<ProximityFile>,
}

/// Accelerometer, which measures acceleration without gravity (at rest: g upwards), and gyro.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ImuFile {
    /// Of the accelerometer, own axes [m/s²].
    #[serde(default)]
    pub accelerometer_bias: [f64; 3],
    /// Of the accelerometer; a sample deviates by this over the root of the sample time [m/s²/√Hz].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub accelerometer_noise_density: f64,
    /// Of the gyro, own axes [rad/s].
    #[serde(default)]
    pub gyro_bias: [f64; 3],
    /// Of the gyro; a sample deviates by this over the root of the sample time [rad/s/√Hz].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub gyro_noise_density: f64,
}

/// Position and attitude, as satellites or cameras give them.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct PoseFile {
    /// Standard deviation of each coordinate [m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub position_noise: f64,
    /// Standard deviation of a small turn about each of its axes [rad].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub angle_noise: f64,
}

/// A vector with noise.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct NoisyFile {
    /// Standard deviation of each component [m/s].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub noise: f64,
}

/// Height, as a barometer gives it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct HeightFile {
    /// Added to every sample [m].
    #[serde(default)]
    pub bias: f64,
    /// Standard deviation of a sample [m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub noise: f64,
}

/// What touches the body that carries it.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct ContactSensorFile {
    /// Paths of the bodies whose touch it feels; left out: of all.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub with: Option<Vec<String>>,
    /// Normal force of a point above which it counts as touching [N].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub threshold: f64,
    /// Standard deviation of each component of the force [N].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub force_noise: f64,
    /// Standard deviation of each component of the torque [N·m].
    #[serde(default)]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub torque_noise: f64,
}

/// Finds the bodies that contact sensors stand on and feel.
pub(super) fn find_bodies(specs: &mut [SensorSpec], objects: &[Object], diagnostics: &mut Diagnostics) {
    let touches = |o: &Object| matches!(o.kind, ObjectKind::Body { .. } | ObjectKind::Fixture) && o.contact.is_some();
    let known: Vec<&str> = objects.iter().filter(|o| touches(o)).map(|o| o.path.as_str()).collect();
    for spec in specs.iter_mut().filter(|s| matches!(s.kind, SensorKind::Contact { .. })) {
        let sensor = objects.iter().find(|o| o.path == spec.path).expect("a sensor is an object");
        let mut carrier = sensor.parent.map(|k| &objects[k]);
        while let Some(frame) = carrier.filter(|o| matches!(o.kind, ObjectKind::Frame)) {
            carrier = frame.parent.map(|k| &objects[k]);
        }
        match carrier.filter(|o| touches(o)) {
            Some(body) => spec.of = body.path.clone(),
            None => {
                let of = carrier.map_or("the world".to_owned(), |o| format!("`{}`", o.path));
                let message = format!("contact sensor `{}` is on {of}, which nothing can touch", spec.path);
                let help = "hang it on a body with a `contact`, or on a frame of such a body";
                diagnostics.push(Diagnostic::error(&sensor.location, message).with_help(help));
            }
        }
        for path in spec.with.iter().filter(|path| !known.contains(&path.value.as_str())) {
            let message = match objects.iter().find(|o| o.path == path.value) {
                Some(o) => format!("`{}` is a {} that nothing can touch", path.value, o.kind.word()),
                None => format!("there is no object `{}`", path.value),
            };
            let help = suggest::help(&path.value, &known, "bodies with a contact");
            diagnostics.push(Diagnostic::error(&path.at, message).with_help(help));
        }
    }
}

/// Specification of the sensor; none, with a diagnostic, if it is not valid.
pub(super) fn spec(
    file: &SensorFile,
    path: &str,
    pointer: &str,
    document: &Document,
    diagnostics: &mut Diagnostics,
) -> Option<SensorSpec> {
    let of = if file.proximity.is_some() { "proximity" } else { "contact" };
    let place = |k: usize| document.at(&format!("{pointer}/{of}/with/{k}"));
    let paths = file.contact.iter().flat_map(|contact| contact.with.iter().flatten());
    let paths = paths.chain(file.proximity.iter().flat_map(|proximity| proximity.with.iter().flatten())).enumerate();
    let with = paths.map(|(k, path)| Located { value: path.clone(), at: place(k) }).collect();
    let kind = match (&file.imu, &file.pose, &file.velocity, &file.height) {
        _ if file.proximity.is_some() => {
            proximity::kind(file.proximity.as_ref()?, &file.name, pointer, document, diagnostics)?
        }
        (Some(imu), ..) => SensorKind::Imu {
            accelerometer: Errors { bias: imu.accelerometer_bias, noise: imu.accelerometer_noise_density },
            gyro: Errors { bias: imu.gyro_bias, noise: imu.gyro_noise_density },
        },
        (_, Some(pose), ..) => SensorKind::Pose { position_noise: pose.position_noise, angle_noise: pose.angle_noise },
        (_, _, Some(velocity), _) => SensorKind::Velocity { noise: velocity.noise },
        (.., Some(height)) => SensorKind::Height { bias: height.bias, noise: height.noise },
        _ => {
            let &ContactSensorFile { force_noise, torque_noise, threshold, .. } = file.contact.as_ref()?;
            SensorKind::Contact { force_noise, torque_noise, threshold }
        }
    };
    if file.parent == "/" && file.contact.is_none() && file.proximity.is_none() {
        let at = document.at(&format!("{pointer}/parent"));
        let diagnostic = Diagnostic::error(&at, format!("sensor `{}` is fixed in the world", file.name)).as_warning();
        diagnostics.push(diagnostic.with_help("it measures nothing that moves; hang it on a body"));
    }
    let at = document.at(&format!("{pointer}/sample_time"));
    let sample_time = file.sample_time.map(|value| Located { value, at });
    Some(SensorSpec { path: path.to_owned(), kind, sample_time, of: String::new(), with })
}
