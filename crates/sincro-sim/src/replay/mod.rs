//! What a run must keep so that it can be shown again: where everything was, and what everything is.
//!
//! [`Tape`] takes frames from a run, at most sixty a simulated second in a long one; [`SceneView`] describes the objects that the frames move, as plain
//! data that serialises; [`properties`] lists every number of the files that a user may change. Nothing here changes a run.

mod contacts;
mod properties;
mod scene;
mod surface;
mod tape;

pub use contacts::{CONTACT, Contacts};
pub use properties::{Property, edited, properties};
pub use scene::{CameraView, JointView, ObjectView, RotorView, SceneView, ShapeView};
pub use tape::{Layout, Tape};
