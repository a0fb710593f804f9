//! Count of what a run reports once, with the time of the first.

/// Number of occurrences in a run, from
/// [`World::passed_singularities`](crate::world::World::passed_singularities),
/// [`World::ambiguous_events`](crate::world::World::ambiguous_events),
/// [`World::chattering_steps`](crate::world::World::chattering_steps) and
/// [`World::jams`](crate::world::World::jams).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Occurrences {
    /// Number of occurrences.
    pub count: usize,
    /// Time of the first one `[s]`; 0 if there was none.
    pub first: f64,
}

impl Occurrences {
    /// Adds one at time `t` `[s]`.
    pub(crate) fn note(&mut self, t: f64) {
        if self.count == 0 {
            self.first = t;
        }
        self.count += 1;
    }
}
