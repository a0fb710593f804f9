//! Live state that viewers read: the scene, the runs so far, the state of the engine, its messages.

use std::sync::{Mutex, MutexGuard};

use serde::Serialize;
use sincro_sim::replay::Contacts;
use tokio::sync::watch;

/// Messages that are kept for viewers; older ones have been read or never will be.
const MAX_WORDS: usize = 200;

/// State of a live run, shared by the engine, which writes it, and its viewers.
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

/// A run as viewers get it.
#[derive(Clone, Debug, Default)]
pub struct RunLog {
    /// Its description as JSON.
    pub header: String,
    /// Times `[s]`.
    pub times: Vec<f64>,
    /// Recorded signals, row by row.
    pub rows: Vec<f64>,
    /// Signals a row.
    pub n_columns: usize,
    /// Frames, one after the other.
    pub frames: Vec<f32>,
    /// Numbers a frame.
    pub width: usize,
    /// Points of contact of the frames.
    pub contacts: Contacts,
}

/// State of the engine.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EngineState {
    /// Number of the run that goes on.
    pub run: usize,
    /// True if it does so now.
    pub playing: bool,
    /// Simulated seconds a second that are aimed at; none: as fast as it goes.
    pub speed: Option<f64>,
    /// Simulated seconds a second that come out, while it plays.
    pub factor: Option<f64>,
    /// Reason for the early end of the run; empty if there was none.
    pub stop: String,
    /// True if it has come to its end.
    pub done: bool,
    /// Hash of its states.
    pub trace: String,
}

impl LiveState {
    /// Creates the state of a live run that has not begun; `replay` is the scene, as JSON.
    #[must_use]
    pub fn new(replay: String) -> Self {
        let content = Content { replay, ..Content::default() };
        Self { content: Mutex::new(content), changed: watch::Sender::new(0) }
    }

    /// The content, to be read and let go of at once.
    ///
    /// # Panics
    ///
    /// If a thread panicked while it wrote.
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

    /// Receiver that is notified at each change.
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
