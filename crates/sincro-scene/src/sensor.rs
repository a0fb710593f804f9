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

/// Sensor of a scene: kind of measurement, errors, sample time.
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
    /// Path of the sensor; the frame of the model with the same name is its pose.
    pub path: String,
    /// Kind of measurement, with its errors.
    pub kind: SensorKind,
    /// Sample time `[s]`; `None`: it samples at every base step.
    pub sample_time: Option<Located<f64>>,
    /// Path of the body whose contacts a contact sensor measures, or of the object that carries a proximity sensor;
    /// empty for others.
    pub of: String,
    /// Paths of the bodies that a contact sensor feels or a proximity sensor sees; empty: all.
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
    /// Inertial measurement unit: specific force and angular velocity in the sensor's axes.
    Imu {
        /// Errors of the specific force: bias `[m/s²]`, noise density `[m/s²/√Hz]`.
        accelerometer: Errors,
        /// Errors of the angular velocity: bias `[rad/s]`, noise density `[rad/s/√Hz]`.
        gyro: Errors,
    },
    /// Position and orientation of the sensor's frame in the world.
    Pose {
        /// Standard deviation of the noise of each coordinate `[m]`.
        position_noise: f64,
        /// Standard deviation of the noise, a small rotation about each axis `[rad]`.
        angle_noise: f64,
    },
    /// Velocity of the sensor's origin in world axes.
    Velocity {
        /// Standard deviation of the noise of each component `[m/s]`.
        noise: f64,
    },
    /// Height of the sensor's origin above the world's plane z = 0.
    Height {
        /// Constant error `[m]`.
        bias: f64,
        /// Standard deviation of the noise `[m]`.
        noise: f64,
    },
    /// Sum of the contact forces on its body and their torque about the sensor's origin, in the sensor's axes.
    Contact {
        /// Standard deviation of the noise of each component of the force `[N]`.
        force_noise: f64,
        /// Standard deviation of the noise of each component of the torque `[N·m]`.
        torque_noise: f64,
        /// Normal force of a point below which it does not count as touching `[N]`.
        threshold: f64,
    },
    /// Proximity sensor: the nearest point of other bodies inside a volume along the sensor's z.
    Proximity {
        /// Shape of the volume of detection.
        volume: Volume,
        /// Distance from the sensor's origin along z at which the volume begins `[m]`.
        offset: f64,
        /// Length of the volume from there `[m]`.
        range: f64,
        /// Standard deviation of the noise of the distance `[m]`.
        noise: f64,
    },
}

/// Errors of a measured vector of three components, constant bias and noise, in its unit: of an IMU `[m/s²]` or
/// `[rad/s]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Constant error of each component, x, y, z in the sensor's axes, in the unit of the vector.
    pub bias: [f64; 3],
    /// Noise of each component: of an IMU density in the unit of the vector per `√Hz`, else standard deviation in that
    /// unit.
    pub noise: f64,
}

impl SensorKind {
    /// Returns the field of view of a proximity sensor; `None` for other kinds.
    #[must_use]
    pub fn field(self) -> Option<FieldOfView> {
        match self {
            Self::Proximity { volume, offset, range, .. } => FieldOfView::new(volume, offset, range),
            _ => None,
        }
    }

    /// Returns names and units of the sensor's values, in the order in which they are kept; the recorded signal is the
    /// sensor's path, `.` and the name.
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

/// Returns the number of base steps between two samples of a sensor; `step` is the base step `[s]`. `None` if the
/// sample time is no whole number of steps.
#[must_use]
pub fn every(spec: &SensorSpec, step: f64) -> Option<u64> {
    let Some(sample_time) = &spec.sample_time else { return Some(1) };
    let n = (sample_time.value / step).round();
    (n >= 1.0 && (n * step - sample_time.value).abs() <= 1e-9 * sample_time.value).then_some(n as u64)
}
