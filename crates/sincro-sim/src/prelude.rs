//! Names for loading scenes, running them, and controlling them: `use sincro_sim::prelude::*`.

pub use sincro_scene::diagnostic::Diagnostics;
pub use sincro_scene::overrides::Override;

pub use crate::campaign::{Campaign, run_campaign};
pub use crate::check::Verdict;
pub use crate::controller::{ClosureController, Commands, Controller, Instant};
pub use crate::load::{Extensions, Loaded, ScriptEngine, load, load_without_variants};
pub use crate::results::{RunReport, Status};
pub use crate::run::{Halt, LockStep, RunError, RunMonitor, RunOptions, Simulated, method_for, simulate};
pub use crate::snapshot::Snapshot;
pub use crate::table::{Column, Table};
pub use crate::trace::Trace;
