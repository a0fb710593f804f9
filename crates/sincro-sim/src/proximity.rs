//! Proximity sensors: what of all pieces of a scene is closest inside a volume.

use sincro_dynamics::geometry::FieldOfView;
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Pose, Vec3};

use sincro_scene::scene::Scene;
use sincro_scene::scenery::Piece;
use sincro_scene::sensor::SensorSpec;

/// Proximity sensor: its field of view and the choice of objects that it detects.
#[derive(Clone, Debug)]
pub struct ProximitySensor {
    /// Volume of detection, in the sensor's axes `[m]`.
    pub field: FieldOfView,
    /// Numbers of the objects that it detects; empty: all but those that [`ProximitySensor::admits`] leaves out.
    pub with: Vec<usize>,
    /// Number of the object that carries it; `None`: it stands in the world.
    pub carrier: Option<usize>,
}

impl ProximitySensor {
    /// Creates the proximity sensor of a sensor specification of `scene`; `None` for other kinds of sensors.
    #[must_use]
    pub fn of(spec: &SensorSpec, scene: &Scene) -> Option<Self> {
        let object_of = |path: &str| scene.object(path).map(|o| o.id);
        let with = || spec.with.iter().filter_map(|path| object_of(&path.value)).collect();
        spec.kind.field().map(|field| Self { field, with: with(), carrier: object_of(&spec.of) })
    }
}

/// Detection of a proximity sensor: the nearest point in its volume, in the sensor's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// Number of the detected object: those of the scene first, then those that were made later, by scripts or clients.
    pub object: usize,
    /// Distance of the point from the sensor's origin `[m]`.
    pub distance: f64,
    /// Coordinates of the point in the sensor's axes `[m]`.
    pub point: Vec3<f64>,
    /// Outward unit normal of the surface there, in the sensor's axes.
    pub normal: Vec3<f64>,
}

impl Detection {
    /// The same detection at another distance `[m]`, in the same direction.
    #[must_use]
    pub(crate) fn at_distance(self, distance: f64) -> Self {
        let k = if self.distance > 0.0 { distance / self.distance } else { 0.0 };
        Self { distance, point: self.point.scale(k), ..self }
    }
}

impl ProximitySensor {
    /// Returns true if a sensor that is fixed to the link or world frame `at` may detect `piece`. A sensor with a list
    /// detects the objects in it; without one all but what moves with its link, or, in the world, all but its carrier.
    #[must_use]
    pub fn admits(&self, at: &Attached<f64>, piece: &Piece) -> bool {
        if !self.with.is_empty() {
            return self.with.contains(&piece.object);
        }
        match at.link {
            Some(_) => piece.at.link != at.link,
            None => Some(piece.object) != self.carrier,
        }
    }

    /// Returns the nearest point of `pieces` inside the volume of a sensor with the pose `x_we` in the world, within
    /// the distance `most` `[m]`; `None` if there is none. [`ProximitySensor::admits`] is not asked. `scratch` must
    /// hold the poses of the links.
    pub fn detect<'a>(
        &self,
        x_we: &Pose<f64>,
        pieces: impl Iterator<Item = &'a Piece>,
        scratch: &Scratch<f64>,
        most: f64,
    ) -> Option<Detection> {
        let (x_ew, mut best) = (x_we.inverse(), None::<Detection>);
        for piece in pieces {
            let x_ep = x_ew.compose(&kinematics::frame_pose(scratch, &piece.at));
            let limit = best.map_or(most, |best| best.distance);
            if let Some(seen) = self.field.detect(&piece.geometry, &x_ep, limit)
                && best.is_none_or(|best| seen.distance < best.distance)
            {
                let (distance, point, normal) = (seen.distance, seen.point, seen.normal);
                best = Some(Detection { object: piece.object, distance, point, normal });
            }
        }
        best
    }
}
