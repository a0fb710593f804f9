//! Data of a run for its replay: keyframes of the trajectory, and the scene.
//!
//! [`Trajectory`] takes frames from a run, at most sixty a simulated second in a long one; [`SceneView`] describes the
//! objects that the frames move, as plain data that serialises; [`properties`] lists every number of the files that a
//! user may change; [`RuntimeLog`] follows the objects that clients and scripts make. Nothing here changes a run.

mod contacts;
mod frame_map;
mod properties;
mod runtime;
mod scene;
mod surface;
mod trajectory;
mod volume;

pub use contacts::{CONTACT, Contacts};
pub use frame_map::FrameMap;
pub use properties::{Property, edited, properties};
pub use runtime::{DrawingView, RuntimeChange, RuntimeEvent, RuntimeLog, RuntimeView};
pub use scene::{CameraView, JointView, ObjectView, RotorView, SceneView, ShapeView};
pub use trajectory::{Layout, Trajectory};
pub use volume::Edge;
