//! Sensors: places on bodies where something is measured at a rate of its own, with errors.
//!
//! A sensor takes a sample at the multiples of its sample time, from the state at the tick and from the accelerations
//! under the commands that acted up to it: what a controller answers at a tick it cannot have measured at that tick, so
//! that no sensor closes an algebraic loop. Between samples its values are held. They are recorded and wired under the
//! sensor's path:
//!
//! | sensor | values |
//! |---|---|
//! | `imu` | `.accelerometer.x y z` [m/s²] specific force Rᵀ(a − g), `.gyro.x y z` [rad/s] angular velocity, both in its own axes |
//! | `pose` | `.measured_position.x y z` `[m]`, `.measured_quaternion.w x y z`, `.measured_roll` `.measured_pitch` `.measured_yaw` `[rad]` |
//! | `velocity` | `.measured_velocity.x y z` [m/s] of its origin, world axes |
//! | `height` | `.measured_height` `[m]` |
//! | `contact` | `.measured_force.x y z` `[N]` of all that touches its body, `.measured_torque.x y z` [N·m] about its origin, own axes; `.touching` 0 or 1; `.points` |
//! | `proximity` | `.detected` 0 or 1; `.distance` `[m]`, offset and range if nothing is there; `.detected_point.x y z` `[m]`, `.detected_normal.x y z`, own axes |
//!
//! Noise is white and of the normal distribution: number k of a component is a hash of the run's seed, the sensor's
//! path, the component and k, as in the block `noise`, so that any sample can be computed again on its own. A noise
//! density N gives samples of standard deviation N/√(sample time).

use sincro_dynamics::geometry::{FieldOfView, Volume};
use sincro_dynamics::model::{Model, SensorInfo};

use crate::diagnostic::Located;

/// A sensor as the scene has it.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let scene = from_text(r#"
///     joint = [{ name = "base", kind = "free" }]
///     body = [{ name = "drone", parent = "/base", density = 100.0, shape = [{ sphere = { radius = 0.1 } }] }]
///     sensor = [{ name = "altimeter", parent = "/base/drone", height = { noise = 0.02 }, sample_time = 0.01 }]
/// "#)?;
/// let altimeter: &SensorSpec = &scene.sensors[0];
/// assert_eq!(altimeter.path, "/base/drone/altimeter");
/// assert_eq!(altimeter.sample_time.as_ref().map(|time| time.value), Some(0.01)); // [s]
/// # Ok::<(), Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SensorSpec {
    /// Its path; a frame of the model has the same.
    pub path: String,
    /// Kind of measurement.
    pub kind: SensorKind,
    /// Time between two samples `[s]`; none: every base step.
    pub sample_time: Option<Located<f64>>,
    /// Path of the body whose contacts a contact sensor feels, or of what carries a proximity sensor; empty for others.
    pub of: String,
    /// Paths of the bodies whose touch it feels, or that it sees; empty: of all.
    pub with: Vec<Located<String>>,
}

/// Kind of a sensor, with the errors of its measurements.
///
/// ```
/// use sincro_scene::prelude::*;
///
/// let gps = SensorKind::Velocity { noise: 0.05 }; // [m/s]
/// let names: Vec<_> = gps.values().into_iter().map(|(name, unit)| format!("{name} [{unit}]")).collect();
/// assert_eq!(names[2], "measured_velocity.z [m/s]");
/// assert!(gps.field().is_none()); // it sees nothing
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorKind {
    /// Specific force and angular velocity, own axes.
    Imu {
        /// [m/s²]; its noise is a density [m/s²/√Hz].
        accelerometer: Errors,
        /// [rad/s]; its noise is a density [rad/s/√Hz].
        gyro: Errors,
    },
    /// Position and attitude in the world.
    Pose {
        /// Standard deviation of each coordinate `[m]`.
        position_noise: f64,
        /// Standard deviation of a small turn about each axis `[rad]`.
        angle_noise: f64,
    },
    /// Velocity of its origin, world axes.
    Velocity {
        /// Standard deviation of each component [m/s].
        noise: f64,
    },
    /// Height over z = 0.
    Height {
        /// Added `[m]`.
        bias: f64,
        /// Standard deviation `[m]`.
        noise: f64,
    },
    /// Force and torque of what touches its body, own axes, about its origin.
    Contact {
        /// Standard deviation of each component of the force `[N]`.
        force_noise: f64,
        /// Standard deviation of each component of the torque [N·m].
        torque_noise: f64,
        /// Normal force of a point below which it does not count as touching `[N]`.
        threshold: f64,
    },
    /// The closest point of other bodies inside a volume.
    Proximity {
        /// Volume of detection.
        volume: Volume,
        /// Offset of the volume along z `[m]`.
        offset: f64,
        /// Length of the volume from there `[m]`.
        range: f64,
        /// Standard deviation of the distance `[m]`.
        noise: f64,
    },
}

/// Errors of three components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Added to every sample.
    pub bias: [f64; 3],
    /// Standard deviation of their noise.
    pub noise: f64,
}

impl SensorKind {
    /// Field of view of a proximity sensor; none for others.
    #[must_use]
    pub fn field(self) -> Option<FieldOfView> {
        match self {
            Self::Proximity { volume, offset, range, .. } => FieldOfView::new(volume, offset, range),
            _ => None,
        }
    }

    /// Names of its values after its path, each with its unit, in the order in which they are kept.
    #[must_use]
    pub fn values(self) -> Vec<(&'static str, &'static str)> {
        match self {
            Self::Imu { .. } => vec![
                ("accelerometer.x", "m/s²"),
                ("accelerometer.y", "m/s²"),
                ("accelerometer.z", "m/s²"),
                ("gyro.x", "rad/s"),
                ("gyro.y", "rad/s"),
                ("gyro.z", "rad/s"),
            ],
            Self::Pose { .. } => vec![
                ("measured_position.x", "m"),
                ("measured_position.y", "m"),
                ("measured_position.z", "m"),
                ("measured_quaternion.w", "1"),
                ("measured_quaternion.x", "1"),
                ("measured_quaternion.y", "1"),
                ("measured_quaternion.z", "1"),
                ("measured_roll", "rad"),
                ("measured_pitch", "rad"),
                ("measured_yaw", "rad"),
            ],
            Self::Velocity { .. } => {
                vec![("measured_velocity.x", "m/s"), ("measured_velocity.y", "m/s"), ("measured_velocity.z", "m/s")]
            }
            Self::Height { .. } => vec![("measured_height", "m")],
            Self::Contact { .. } => vec![
                ("measured_force.x", "N"),
                ("measured_force.y", "N"),
                ("measured_force.z", "N"),
                ("measured_torque.x", "N·m"),
                ("measured_torque.y", "N·m"),
                ("measured_torque.z", "N·m"),
                ("touching", "1"),
                ("points", "1"),
            ],
            Self::Proximity { .. } => vec![
                ("detected", "1"),
                ("distance", "m"),
                ("detected_point.x", "m"),
                ("detected_point.y", "m"),
                ("detected_point.z", "m"),
                ("detected_normal.x", "1"),
                ("detected_normal.y", "1"),
                ("detected_normal.z", "1"),
            ],
        }
    }
}

/// The sensors in the names of their model.
pub(crate) fn register(model: &mut Model<f64>, specs: &[SensorSpec]) {
    let info = |spec: &SensorSpec| SensorInfo {
        name: spec.path.clone(),
        values: spec.kind.values().into_iter().map(|(name, unit)| (name.to_owned(), unit.to_owned())).collect(),
    };
    model.set_sensors(specs.iter().map(info).collect());
}

/// Base steps between two samples; none if the sample time is no whole number of steps of `step` `[s]`.
#[must_use]
pub fn every(spec: &SensorSpec, step: f64) -> Option<u64> {
    let Some(sample_time) = &spec.sample_time else { return Some(1) };
    let n = (sample_time.value / step).round();
    (n >= 1.0 && (n * step - sample_time.value).abs() <= 1e-9 * sample_time.value).then_some(n as u64)
}
