//! Sensors of the file: what they measure, how often, how wrong.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::document::Document;
use crate::problem::{Located, Problem, Problems};
use crate::sensor::{Errors, SensorKind, SensorSpec};

/// A sensor on a body or frame: sampled at its own rate, held in between.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("allOf" = [
    {"not": {"required": ["rotation_deg", "quaternion_wxyz"]}},
    {"oneOf": [{"required": ["imu"]}, {"required": ["pose"]}, {"required": ["velocity"]}, {"required": ["height"]}]}
]))]
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
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub sample_time: Option<f64>,
    /// Accelerometer and gyro, in its own axes.
    pub imu: Option<ImuFile>,
    /// Position and attitude in the world.
    pub pose: Option<PoseFile>,
    /// Velocity of its origin, world axes.
    pub velocity: Option<NoisyFile>,
    /// Height of its origin over z = 0.
    pub height: Option<HeightFile>,
}

/// Accelerometer, which measures acceleration without gravity (at rest: g upwards), and gyro.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ImuFile {
    /// Of the accelerometer, own axes [m/s²].
    #[serde(default)]
    pub accelerometer_bias: [f64; 3],
    /// Of the accelerometer; a sample deviates by this over the root of the sample time [m/s²/√Hz].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub accelerometer_noise_density: f64,
    /// Of the gyro, own axes [rad/s].
    #[serde(default)]
    pub gyro_bias: [f64; 3],
    /// Of the gyro; a sample deviates by this over the root of the sample time [rad/s/√Hz].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub gyro_noise_density: f64,
}

/// Position and attitude, as satellites or cameras give them.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PoseFile {
    /// Standard deviation of each coordinate [m].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub position_noise: f64,
    /// Standard deviation of a small turn about each of its axes [rad].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub angle_noise: f64,
}

/// A vector with noise.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NoisyFile {
    /// Standard deviation of each component [m/s].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub noise: f64,
}

/// Height, as a barometer gives it.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct HeightFile {
    /// Added to every sample [m].
    #[serde(default)]
    pub bias: f64,
    /// Standard deviation of a sample [m].
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub noise: f64,
}

/// What it measures; none, with the reason noted, if numbers are not finite.
pub(super) fn spec(
    file: &SensorFile,
    path: &str,
    pointer: &str,
    document: &Document,
    problems: &mut Problems,
) -> Option<SensorSpec> {
    let kind = match (&file.imu, &file.pose, &file.velocity, &file.height) {
        (Some(imu), ..) => SensorKind::Imu {
            accelerometer: Errors { bias: imu.accelerometer_bias, noise: imu.accelerometer_noise_density },
            gyro: Errors { bias: imu.gyro_bias, noise: imu.gyro_noise_density },
        },
        (_, Some(pose), ..) => SensorKind::Pose { position_noise: pose.position_noise, angle_noise: pose.angle_noise },
        (_, _, Some(velocity), _) => SensorKind::Velocity { noise: velocity.noise },
        (.., Some(height)) => SensorKind::Height { bias: height.bias, noise: height.noise },
        _ => return None,
    };
    if file.parent == "/" {
        let at = document.at(&format!("{pointer}/parent"));
        let problem = Problem::error(&at, format!("sensor `{}` is fixed in the world", file.name)).as_warning();
        problems.push(problem.with_help("it measures nothing that moves; hang it on a body"));
    }
    let at = document.at(&format!("{pointer}/sample_time"));
    let sample_time = file.sample_time.map(|value| Located { value, at });
    Some(SensorSpec { path: path.to_owned(), kind, sample_time })
}
