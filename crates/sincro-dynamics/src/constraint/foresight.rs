//! Contacts and limits that count as closed in a step at velocity level because of a blow within it. How they are
//! found: `crate::mechanism::foresight`.

use crate::spatial::Motion;

/// Contacts and limits that blows within a step lead to, as found by tries of it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Foresight {
    /// Slots that a try would have passed, in increasing order.
    pub slots: Vec<usize>,
    /// Links that a blow accelerates beyond the margin of the first detection, in increasing order, with their twists
    /// at the end of a try about the world's origin.
    struck: Vec<(u32, Motion<f64>)>,
}

impl Foresight {
    /// Forgets everything.
    pub fn clear(&mut self) {
        self.slots.clear();
        self.struck.clear();
    }

    /// Returns true if a slot counts as closed.
    pub fn closes(&self, slot: usize) -> bool {
        self.slots.binary_search(&slot).is_ok()
    }

    /// Twist of a link about the world's origin after a blow; `None` of one that no blow accelerates.
    pub fn twist_of(&self, link: u32) -> Option<Motion<f64>> {
        self.struck.binary_search_by_key(&link, |(link, _)| *link).ok().map(|k| self.struck[k].1)
    }

    /// Notes the twist of a link after a blow.
    pub fn strike(&mut self, link: u32, twist: Motion<f64>) {
        match self.struck.binary_search_by_key(&link, |(link, _)| *link) {
            Ok(k) => self.struck[k].1 = twist,
            Err(k) => self.struck.insert(k, (link, twist)),
        }
    }
}
