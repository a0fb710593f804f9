//! Sensors in a run: due samples are taken, the others held.

use sincro_blocks::library::sources::random::gaussian;
use sincro_blocks::program::seed_of;
use sincro_dynamics::constraint::ContactPoint;
use sincro_dynamics::coupled::StateView;
use sincro_dynamics::kinematics::{self, Attached, frame_acceleration, frame_pose, frame_velocity};
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::world::World;
use sincro_math::Real;
use sincro_math::random::splitmix64;

use crate::controller::Controller;
use crate::proximity::{Detection, ProximitySensor};
use sincro_scene::experiment::Experiment;
use sincro_scene::record::probe::attached;
use sincro_scene::scene::Scene;
use sincro_scene::scenery::{Piece, Scenery};
use sincro_scene::sensor::{Errors, SensorKind, every};

/// Timing and noise that samples depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timing {
    /// Base step `[s]`.
    pub step: f64,
    /// Seed of the experiment.
    pub seed: u64,
}

impl Timing {
    pub fn new(experiment: &Experiment) -> Self {
        Self { step: experiment.step, seed: experiment.seed }
    }
}

/// All sensors of a scene with what they gave last.
#[derive(Clone, Debug)]
pub(crate) struct Sensors {
    list: Vec<Sensor>,
    /// Values of all sensors, one after the other.
    pub values: Vec<f64>,
    accelerations: Vec<f64>,
    /// Contact points at the tick.
    points: Vec<ContactPoint>,
    /// Visible geometry, if there is a proximity sensor.
    scenery: Scenery,
    zero: Vec<f64>,
}

/// Sensor of a scene with its sample time and the seed of its noise.
#[derive(Clone, Debug)]
pub(crate) struct Sensor {
    kind: SensorKind,
    #[cfg(feature = "tasks")]
    path: String,
    /// Its frame among those of the model.
    frame: usize,
    /// Its object in the scene; of one that looks, what it looks into.
    object: usize,
    proximity: Option<ProximitySensor>,
    /// Frame of the body whose contacts it feels, and of those it feels; none: of all.
    of: usize,
    with: Vec<usize>,
    at: Attached<f64>,
    /// Sample time, in base steps.
    pub every: u64,
    /// 1/√(sample time).
    root_rate: f64,
    seed: u64,
    first: usize,
    n: usize,
}

/// Measurement without its errors, of a sensor that needs the kinematics alone.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Exact<R> {
    /// Specific force `[m/s²]` and angular velocity `[rad/s]` in the sensor's axes.
    Imu { force: Vec3<R>, rate: Vec3<R> },
    /// Pose in the world `[m]`.
    Pose(Pose<R>),
    /// Velocity in world axes `[m/s]`.
    Velocity(Vec3<R>),
    /// Height above z = 0 `[m]`.
    Height(R),
}

impl<R: Real> Exact<R> {
    /// Measurement of one lane.
    #[cfg(feature = "tasks")]
    pub fn lane(&self, k: usize) -> Exact<f64> {
        let vector = |v: Vec3<R>| Vec3(v.0.map(|x| x.lane(k)));
        match *self {
            Self::Imu { force, rate } => Exact::Imu { force: vector(force), rate: vector(rate) },
            Self::Pose(Pose { rot, pos }) => {
                let rot = sincro_dynamics::spatial::Mat3(rot.0.map(|row| row.map(|x| x.lane(k))));
                Exact::Pose(Pose { rot, pos: vector(pos) })
            }
            Self::Velocity(v) => Exact::Velocity(vector(v)),
            Self::Height(z) => Exact::Height(z.lane(k)),
        }
    }
}

impl Sensors {
    /// Before their first sample.
    pub fn new(scene: &Scene, timing: Timing) -> Self {
        let (mut list, mut first) = (Vec::new(), 0);
        for spec in &scene.sensors {
            let frames = &scene.model.names().frames;
            let frame = frames.iter().position(|f| f.name == spec.path).expect("a sensor is a frame of the model");
            let frame_of = |path: &str| frames.iter().position(|f| f.name == path);
            let every = every(spec, timing.step).expect("sample times have been checked");
            let n = spec.kind.values().len();
            let object_of = |path: &str| scene.object(path).map(|o| o.id);
            let proximity = ProximitySensor::of(spec, scene);
            list.push(Sensor {
                kind: spec.kind,
                #[cfg(feature = "tasks")]
                path: spec.path.clone(),
                frame,
                object: object_of(&spec.path).expect("a sensor is an object"),
                proximity,
                of: frame_of(&spec.of).unwrap_or(usize::MAX),
                with: spec.with.iter().filter_map(|path| frame_of(&path.value)).collect(),
                at: attached(&scene.model, frame),
                every,
                root_rate: 1.0 / (every as f64 * timing.step).sqrt(),
                seed: seed_of(timing.seed, &spec.path),
                first,
                n,
            });
            first += n;
        }
        let accelerations = vec![0.0; scene.model.n_v()];
        let points = Vec::with_capacity(scene.model.constraints().n_contacts());
        let looks = list.iter().any(|sensor: &Sensor| sensor.proximity.is_some());
        let scenery = if looks { scene.scenery().clone() } else { Scenery::default() };
        let zero = vec![0.0; if looks { scene.model.n_v() } else { 0 }];
        Self { list, values: vec![0.0; first], accelerations, points, scenery, zero }
    }

    /// The sensors alone, in the order of the scene.
    #[cfg(feature = "tasks")]
    pub fn into_list(self) -> Vec<Sensor> {
        self.list
    }

    /// Draws the noise of the samples to come by another seed of the experiment.
    #[cfg(feature = "tasks")]
    pub fn reseed(&mut self, seed: u64) {
        for sensor in &mut self.list {
            sensor.seed = sensor.seed_in(seed);
        }
    }

    /// Sensors of another scene; those that both have keep their last values.
    pub fn continued(&self, scene: &Scene, timing: Timing) -> Self {
        let mut new = Self::new(scene, timing);
        for sensor in &new.list {
            if let Some(old) = self.list.iter().find(|old| old.object == sensor.object && old.n == sensor.n) {
                new.values[sensor.first..][..sensor.n].copy_from_slice(&self.values[old.first..][..old.n]);
            }
        }
        new
    }

    /// Updates the proximity sensors that are due, before scripts sense, as in V-REP, and passes the detections to the
    /// controllers. Geometry that controllers have added to the scene is detected, too.
    pub fn update_proximity_sensors(
        &mut self,
        world: &mut World,
        tick: u64,
        t: f64,
        controllers: &mut [Box<dyn Controller>],
    ) {
        let due = |s: &&Sensor| tick.is_multiple_of(s.every) && s.proximity.is_some();
        if !self.list.iter().any(|s| due(&s)) {
            return;
        }
        let (list, values, zero, scenery) = (&self.list, &mut self.values, &self.zero, &self.scenery);
        world.with_state_view(t, |seen| {
            kinematics::motions(seen.model, seen.q, seen.v, zero, seen.scratch);
            for sensor in list.iter().filter(due) {
                let made = controllers.iter().flat_map(|controller| controller.pieces());
                let chosen = controllers.iter().find_map(|controller| controller.detected_objects(sensor.object));
                let pieces = scenery.pieces.iter().chain(made).filter(|piece| sensor.admits(piece, chosen.as_deref()));
                let is_seen = |piece: &&Piece| !controllers.iter().any(|c| c.is_undetectable(piece.object));
                // a choice has been made of what can be detected
                let pieces = pieces.filter(|piece| chosen.is_some() || is_seen(piece));
                let found = sensor.detect(&seen, pieces, tick / sensor.every);
                sensor.write(found.as_ref(), &mut values[sensor.first..][..sensor.n]);
                controllers.iter_mut().for_each(|controller| controller.detected(sensor.object, found));
            }
        });
    }

    /// Takes the samples that are due at a tick, except those of proximity sensors.
    pub fn sample(&mut self, world: &mut World, tick: u64, t: f64) {
        let due = |s: &&Sensor| tick.is_multiple_of(s.every) && s.proximity.is_none();
        if !self.list.iter().any(|s| due(&s)) {
            return;
        }
        let feels = |s: &Sensor| matches!(s.kind, SensorKind::Imu { .. } | SensorKind::Contact { .. });
        if self.list.iter().filter(due).any(feels) {
            self.accelerations.copy_from_slice(world.rates(t).0);
            self.points.clear();
            self.points.extend(world.contacts());
        }
        let (list, values, accelerations, points) = (&self.list, &mut self.values, &self.accelerations, &self.points);
        world.with_state_view(t, |seen| {
            kinematics::motions(seen.model, seen.q, seen.v, accelerations, seen.scratch);
            for sensor in list.iter().filter(due) {
                sensor.measure(&seen, tick / sensor.every, points, &mut values[sensor.first..][..sensor.n]);
            }
        });
    }
}

impl Sensor {
    /// Sample `k`, after the kinematics.
    fn measure(&self, seen: &StateView<'_, f64>, k: u64, points: &[ContactPoint], y: &mut [f64]) {
        let SensorKind::Contact { force_noise, torque_noise, threshold } = &self.kind else {
            let exact = self.exact(seen).expect("proximity sensors have their samples taken before");
            return self.add_errors(&exact, self.seed, k, y);
        };
        let pose = frame_pose(seen.scratch, &self.at);
        let (force, torque, n) = self.touch(seen, points, pose.pos, *threshold);
        let own = |v: Vec3<f64>| pose.rot.tr_mul_vec(v);
        let noise = Noise { seed: self.seed, k };
        y[..3].copy_from_slice(&noise.three(0, own(force), &plain(*force_noise), 1.0));
        y[3..6].copy_from_slice(&noise.three(3, own(torque), &plain(*torque_noise), 1.0));
        y[6] = f64::from(n > 0);
        y[7] = f64::from(n);
    }

    /// Returns true if it measures accelerations.
    #[cfg(feature = "tasks")]
    pub fn measures_accelerations(&self) -> bool {
        matches!(self.kind, SensorKind::Imu { .. })
    }

    /// Seed of its noise in an experiment with the seed `seed`.
    #[cfg(feature = "tasks")]
    pub fn seed_in(&self, seed: u64) -> u64 {
        seed_of(seed, &self.path)
    }

    /// Range of its values among those of all sensors.
    #[cfg(feature = "tasks")]
    pub fn values(&self) -> core::ops::Range<usize> {
        self.first..self.first + self.n
    }

    /// Measurement without errors, after the kinematics, those of an IMU with the accelerations; none of a sensor that
    /// measures anything else.
    #[inline(always)]
    pub fn exact<R: Real>(&self, seen: &StateView<'_, R>) -> Option<Exact<R>> {
        let at = attached(seen.model, self.frame);
        Some(match self.kind {
            SensorKind::Imu { .. } => {
                let pose = frame_pose(seen.scratch, &at);
                let own = |v: Vec3<R>| pose.rot.transpose().mul_vec(v);
                let gravity = seen.model.gravity_at(pose.pos);
                let force = own(frame_acceleration(seen.scratch, &at).lin - gravity);
                Exact::Imu { force, rate: own(frame_velocity(seen.scratch, &at).ang) }
            }
            SensorKind::Pose { .. } => Exact::Pose(frame_pose(seen.scratch, &at)),
            SensorKind::Velocity { .. } => Exact::Velocity(frame_velocity(seen.scratch, &at).lin),
            SensorKind::Height { .. } => Exact::Height(frame_pose(seen.scratch, &at).pos[2]),
            SensorKind::Contact { .. } | SensorKind::Proximity { .. } => return None,
        })
    }

    /// Writes sample `k` of a measurement: with bias, and with noise drawn by the seed `seed` ([`Sensor::seed_in`]).
    pub fn add_errors(&self, exact: &Exact<f64>, seed: u64, k: u64, y: &mut [f64]) {
        let noise = Noise { seed, k };
        match (&self.kind, exact) {
            (SensorKind::Imu { accelerometer, gyro }, Exact::Imu { force, rate }) => {
                y[..3].copy_from_slice(&noise.three(0, *force, accelerometer, self.root_rate));
                y[3..].copy_from_slice(&noise.three(3, *rate, gyro, self.root_rate));
            }
            (SensorKind::Pose { position_noise, angle_noise }, Exact::Pose(pose)) => {
                y[..3].copy_from_slice(&noise.three(0, pose.pos, &plain(*position_noise), 1.0));
                let half = Vec3(core::array::from_fn(|i| 0.5 * angle_noise * noise.of(3 + i)));
                let turned = Quat::from_matrix(&pose.rot).mul(&Quat { w: 1.0, xyz: half }.normalized());
                y[3] = turned.w;
                y[4..7].copy_from_slice(&turned.xyz.0);
                y[7..].copy_from_slice(&kinematics::roll_pitch_yaw(&turned.matrix()).0);
            }
            (SensorKind::Velocity { noise: std }, Exact::Velocity(velocity)) => {
                y.copy_from_slice(&noise.three(0, *velocity, &plain(*std), 1.0));
            }
            (SensorKind::Height { bias, noise: std }, Exact::Height(z)) => y[0] = z + bias + std * noise.of(0),
            _ => unreachable!("the measurement is of the sensor's kind"),
        }
    }

    /// Returns true if a proximity sensor may detect a piece: one of the objects that a controller has chosen, or
    /// those of the scene.
    fn admits(&self, piece: &Piece, chosen: Option<&[usize]>) -> bool {
        let of_scene = || self.proximity.as_ref().is_some_and(|proximity| proximity.admits(&self.at, piece));
        chosen.map_or_else(of_scene, |objects| objects.binary_search(&piece.object).is_ok())
    }

    /// Sample `k` of a proximity sensor of these pieces, after the kinematics.
    fn detect<'a>(
        &self,
        seen: &StateView<'_, f64>,
        pieces: impl Iterator<Item = &'a Piece>,
        k: u64,
    ) -> Option<Detection> {
        let (proximity, at) = (self.proximity.as_ref()?, &self.at);
        let SensorKind::Proximity { noise, .. } = self.kind else { return None };
        let found = proximity.detect(&frame_pose(seen.scratch, at), pieces, seen.scratch, f64::INFINITY)?;
        if noise == 0.0 {
            return Some(found);
        }
        Some(found.at_distance(found.distance + noise * gaussian(splitmix64(self.seed, 0), k)))
    }

    /// Writes a detection as sensor values.
    fn write(&self, found: Option<&Detection>, y: &mut [f64]) {
        let Some(found) = found else {
            y.fill(0.0);
            y[1] = self.proximity.as_ref().map_or(0.0, |proximity| proximity.field.offset() + proximity.field.range());
            return;
        };
        (y[0], y[1]) = (1.0, found.distance);
        y[2..5].copy_from_slice(&found.point.0);
        y[5..8].copy_from_slice(&found.normal.0);
    }

    /// Sum of the forces on the body and of their moments about `origin`, world axes, and the number of points that
    /// press with more than `threshold`.
    fn touch(
        &self,
        seen: &StateView<'_, f64>,
        points: &[ContactPoint],
        origin: Vec3<f64>,
        threshold: f64,
    ) -> (Vec3<f64>, Vec3<f64>, u32) {
        let colliders = &seen.model.constraints().colliders;
        let (mut force, mut torque, mut n) = (Vec3::zero(), Vec3::zero(), 0);
        for point in points {
            let [a, b] =
                point.surfaces.map(|s| colliders[s].body.map_or(usize::MAX, sincro_dynamics::ids::BodyId::index));
            // the force is on the first surface's body
            let (sign, other) = match (a == self.of, b == self.of) {
                (true, false) => (1.0, b),
                (false, true) => (-1.0, a),
                _ => continue,
            };
            if !self.with.is_empty() && !self.with.contains(&other) {
                continue;
            }
            force += point.force.scale(sign);
            torque += (point.torque + (point.point - origin).cross(point.force)).scale(sign);
            n += u32::from(point.force.dot(point.normal) > threshold);
        }
        (force, torque, n)
    }
}

/// Noise of sample `k`.
struct Noise {
    seed: u64,
    k: u64,
}

impl Noise {
    /// Standard normal number of a component.
    fn of(&self, component: usize) -> f64 {
        gaussian(splitmix64(self.seed, component as u64), self.k)
    }

    /// Vector with its errors, components from `first` on.
    fn three(&self, first: usize, x: Vec3<f64>, errors: &Errors, scale: f64) -> [f64; 3] {
        core::array::from_fn(|i| x[i] + errors.bias[i] + scale * errors.noise * self.of(first + i))
    }
}

/// Errors without bias.
fn plain(noise: f64) -> Errors {
    Errors { bias: [0.0; 3], noise }
}
