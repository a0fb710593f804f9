//! Messages of clients and scripts, kept with the run; their number is bounded.

use crate::controller::Message;

/// Messages that are kept of a run: who says something at every tick must not fill the memory.
const MAX_MESSAGES: usize = 10_000;
/// Bytes of a message that are kept.
const MAX_MESSAGE_LEN: usize = 10_000;

/// Bounded list of messages.
#[derive(Clone, Debug, Default)]
pub struct Notes {
    messages: Vec<Message>,
    n_dropped: usize,
}

impl Notes {
    /// Adds a message of `object` at the time `t` `[s]`, cut off at 10,000 bytes; beyond 10,000 they are only counted.
    pub fn add(&mut self, t: f64, object: &str, text: &str) {
        if self.messages.len() == MAX_MESSAGES {
            self.n_dropped += 1;
            return;
        }
        let text = text[..text.floor_char_boundary(MAX_MESSAGE_LEN)].to_owned();
        self.messages.push(Message { t, object: object.to_owned(), text });
    }

    /// Messages that are kept, and the number of those that were dropped.
    #[must_use]
    pub fn all(&self) -> (&[Message], usize) {
        (&self.messages, self.n_dropped)
    }
}
