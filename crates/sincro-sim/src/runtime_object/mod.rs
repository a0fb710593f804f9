//! Objects that clients and scripts make while a run is on, as controllers describe them for pictures.

mod drawing;

use std::sync::Arc;

use sincro_dynamics::geometry::{FieldOfView, Geometry};
use sincro_dynamics::kinematics::Attached;
use sincro_dynamics::spatial::Pose;

pub use drawing::{Drawing, DrawingKind, DrawingStyle};

/// Visible part of a [`RuntimeObject`].
#[derive(Clone, Debug)]
pub struct RuntimePart {
    /// Geometry in its own frame `[m]`.
    pub geometry: Arc<Geometry>,
    /// Pose of that frame in the object `[m]`.
    pub place: Pose<f64>,
    /// Colour: red, green, blue, 0 to 255.
    pub color: [u8; 3],
}

impl PartialEq for RuntimePart {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.geometry, &other.geometry) && (self.place, self.color) == (other.place, other.color)
    }
}

/// Object that a controller has made, or a frame of the scene that it has moved, as
/// [`Controller::runtime_objects`](crate::controller::Controller::runtime_objects) describes it.
#[derive(Clone, Debug)]
pub struct RuntimeObject<'a> {
    /// Number that the object keeps for the whole run, and that no other object of the controller has.
    pub id: u32,
    /// Path of the object.
    pub path: &'a str,
    /// Kind in English, such as `dummy`, `shape`, `proximity sensor`, `drawing`.
    pub kind: &'static str,
    /// Link (or the world) that carries it, and its pose there `[m]`.
    pub at: Attached<f64>,
    /// Visible parts.
    pub parts: Vec<RuntimePart>,
    /// Field of view of a proximity sensor, along z of the object; `None` for all else.
    pub field: Option<FieldOfView>,
    /// Items of a drawing, in the axes of the object; `None` for all else.
    pub drawing: Option<&'a Drawing>,
}
