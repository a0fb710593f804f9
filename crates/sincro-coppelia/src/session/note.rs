//! What clients and scripts said of a run: kept with it, bounded.

use sincro_sim::controller::Message;

/// Messages that are kept of a run: who says something at every tick must not fill the memory.
const MOST: usize = 10_000;
/// Bytes of a message that are kept.
const LONGEST: usize = 10_000;

/// See the head of this file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes {
    messages: Vec<Message>,
    n_dropped: usize,
}

impl Notes {
    /// Adds one; those that are too many are counted.
    pub fn add(&mut self, t: f64, object: &str, text: &str) {
        if self.messages.len() == MOST {
            self.n_dropped += 1;
            return;
        }
        let text = text[..text.floor_char_boundary(LONGEST)].to_owned();
        self.messages.push(Message { t, object: object.to_owned(), text });
    }

    /// What is kept, and how many were too many.
    pub fn all(&self) -> (&[Message], usize) {
        (&self.messages, self.n_dropped)
    }
}
