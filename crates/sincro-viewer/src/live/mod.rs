//! A live run: an engine in a thread of its own, the live state that it publishes, and viewers that read it, each at
//! its own pace.
//!
//! The engine waits for nobody: it appends to the live state under a lock that is held for a copy only, and the world
//! knows nothing of it. A viewer that stops reading stops its own task. Each change of numbers makes a new run from a
//! frame of an earlier one, so that nothing seen is lost.

mod command;
mod engine;
mod history;
mod live_state;
mod thinned;
mod track;

pub use command::Command;
pub use engine::{Engine, ResultWriter, Source};
pub use history::{KeptRun, Segment};
pub use live_state::{EngineState, LiveState, RunLog};

/// A refusal as a viewer gets it.
pub(crate) fn refusal(reason: &str) -> String {
    live_state::words("refused", reason)
}
