//! Proximity sensors: what of all pieces of a scene is closest inside a volume.

use sincro_dynamics::geometry::FieldOfView;
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::scratch::Scratch;
use sincro_dynamics::spatial::{Pose, Vec3};

use sincro_scene::scene::Scene;
use sincro_scene::scenery::Piece;
use sincro_scene::sensor::SensorSpec;

/// Proximity sensor: its field of view and the objects that it detects.
#[derive(Clone, Debug)]
pub struct ProximitySensor {
    /// Its volume.
    pub field: FieldOfView,
    /// Objects that it sees, by index; empty: all that it is not fixed to.
    pub with: Vec<usize>,
    /// Object that carries it.
    pub carrier: Option<usize>,
}

impl ProximitySensor {
    /// Proximity sensor of a sensor of a scene; none for other kinds.
    #[must_use]
    pub fn of(spec: &SensorSpec, scene: &Scene) -> Option<Self> {
        let object_of = |path: &str| scene.objects.iter().position(|o| o.path == path);
        let with = || spec.with.iter().filter_map(|path| object_of(&path.value)).collect();
        spec.kind.field().map(|field| Self { field, with: with(), carrier: object_of(&spec.of) })
    }
}

/// Detection of a proximity sensor, in its own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// Index of the object, the scene's first, then those that were made later.
    pub object: usize,
    /// From the sensor's origin `[m]`.
    pub distance: f64,
    /// The point `[m]`.
    pub point: Vec3<f64>,
    /// Out of the surface there, length one.
    pub normal: Vec3<f64>,
}

impl Detection {
    /// The same detection at another distance `[m]`, in the same direction.
    #[must_use]
    pub fn at_distance(self, distance: f64) -> Self {
        let k = if self.distance > 0.0 { distance / self.distance } else { 0.0 };
        Self { distance, point: self.point.scale(k), ..self }
    }
}

impl ProximitySensor {
    /// Returns true if a sensor that is fixed at `at` detects a piece: of those that it names any; if it names none,
    /// all but what moves with it, and in the world all but what carries it.
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

    /// The closest point within `most` `[m]` of the pieces that the sensor admits, for a sensor at `x_we` in the world;
    /// after the kinematics.
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
