//! Names for opening scenes and asking what is in them: `use sincro_scene::prelude::*`.

pub use crate::diagnostic::{Diagnostic, Diagnostics, Location, Severity};
pub use crate::diagram::ControlDiagram;
pub use crate::experiment::Experiment;
pub use crate::open::{Opened, open, settings_with};
pub use crate::overrides::Override;
pub use crate::record::{Entry, Probe, catalogue};
pub use crate::scene::{Model, Object, ObjectKind, Scene, from_text};
pub use crate::script::ScriptParser;
pub use crate::sensor::{SensorKind, SensorSpec};
