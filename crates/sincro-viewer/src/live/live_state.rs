//! Live state that viewers read: the scene, the runs so far, the state of the engine, its messages.

use std::sync::{Mutex, MutexGuard};

use serde::Serialize;
use sincro_sim::replay::{Contacts, RuntimeEvent};
use tokio::sync::watch;

/// Messages that are kept for viewers; older ones have been read or never will be.
const MAX_WORDS: usize = 200;

/// State of a live scene, shared by the engine, which writes it, and the viewers, which read it: the scene, its runs so
/// far, and messages.
#[derive(Debug)]
pub struct LiveState {
    content: Mutex<Content>,
    changed: watch::Sender<u64>,
}

/// Content of the live state.
#[derive(Debug, Default)]
pub struct Content {
    /// The scene and everything that does not change, as JSON.
    pub replay: String,
    /// The runs, in the order of their numbers.
    pub runs: Vec<RunLog>,
    /// State of the engine.
    pub engine: EngineState,
    /// Its messages as JSON, with running numbers.
    pub words: Vec<(u64, String)>,
    n_words: u64,
}

/// Run of a live scene as viewers get it: frames and recorded signals so far.
#[derive(Clone, Debug, Default)]
pub struct RunLog {
    /// Description of the run (name, scene, columns) as JSON.
    pub header: String,
    /// Simulated times of the frames and rows `[s]`, ascending.
    pub times: Vec<f64>,
    /// Recorded signals, row by row, `n_columns` values for each time, in the units of `header`.
    pub rows: Vec<f64>,
    /// Number of signals in a row.
    pub n_columns: usize,
    /// Frames, one after the other, `width` numbers for each time, as those of a `Trajectory`.
    pub frames: Vec<f32>,
    /// Number of numbers in a frame.
    pub width: usize,
    /// Points of contact of each frame.
    pub contacts: Contacts,
    /// Changes of objects that scripts have made.
    pub runtime: Vec<RuntimeEvent>,
}

/// State of the engine of a live scene: which run advances, and how fast.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EngineState {
    /// Number of the present run, from 0.
    pub run: usize,
    /// True if it advances, false if it is paused.
    pub playing: bool,
    /// Simulated seconds per second of wall time that are asked for (dimensionless); none: as fast as possible.
    pub speed: Option<f64>,
    /// Simulated seconds per second of wall time that are reached (dimensionless); none while paused.
    pub factor: Option<f64>,
    /// Reason for the early end of the present run; empty if there was none.
    pub stop: String,
    /// True if the present run has come to its end.
    pub done: bool,
    /// Trace hash of the present run so far (hexadecimal).
    pub trace: String,
}

impl LiveState {
    /// Creates the state of a live run that has not begun; `replay` is the scene, as JSON.
    #[must_use]
    pub(crate) fn new(replay: String) -> Self {
        let content = Content { replay, ..Content::default() };
        Self { content: Mutex::new(content), changed: watch::Sender::new(0) }
    }

    /// Locks the content for reading; the engine waits while it is held, so let go of it at once.
    ///
    /// # Panics
    ///
    /// A thread panicked while it wrote.
    pub fn read(&self) -> MutexGuard<'_, Content> {
        self.content.lock().expect("no thread panics while it writes to the live state")
    }

    /// Changes the content and tells the viewers.
    pub(crate) fn write(&self, change: impl FnOnce(&mut Content)) {
        change(&mut self.read());
        self.changed.send_modify(|n| *n += 1);
    }

    /// Says something to all viewers: `refused` or `saved`.
    pub(crate) fn say(&self, kind: &str, message: &str) {
        let text = words(kind, message);
        self.write(|content| {
            content.n_words += 1;
            content.words.push((content.n_words, text));
            if content.words.len() > MAX_WORDS {
                content.words.remove(0);
            }
        });
    }

    /// Receiver that is notified after each change of the content; its value is the number of changes so far.
    #[must_use]
    pub fn watch(&self) -> watch::Receiver<u64> {
        self.changed.subscribe()
    }
}

impl Content {
    /// Number of the last words.
    #[must_use]
    pub fn last_words(&self) -> u64 {
        self.n_words
    }
}

/// A message in words as JSON.
pub(crate) fn words(kind: &str, message: &str) -> String {
    serde_json::json!({ "type": kind, "message": message }).to_string()
}
