//! A live run: an engine in a thread of its own, a board that it writes to, and viewers that read the board at their
//! own pace.
//!
//! The engine waits for nobody: it appends to the board under a lock that is held for a copy only, and the world knows
//! nothing of it. A viewer that stops reading stops its own task. Each change of numbers makes a new run from a frame
//! of an earlier one, so that nothing seen is lost.

mod board;
mod command;
mod engine;
mod thinned;
mod track;

pub use board::{Board, RunLog, Standing};
pub use command::Command;
pub use engine::{Engine, Source};

/// A refusal as a viewer gets it.
pub(crate) fn refusal(reason: &str) -> String {
    board::words("refused", reason)
}
