//! Contact candidates of all pairs that are near, by slot.

use super::candidate::ContactCandidate;

/// Candidate of one slot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlotCandidate {
    /// Slot among those of contacts.
    pub slot: u32,
    /// Index of the pair.
    pub pair: u32,
    pub candidate: ContactCandidate,
}

/// Candidates in the order of their slots.
#[derive(Clone, Debug, Default)]
pub(crate) struct CandidateList(Vec<SlotCandidate>);

impl CandidateList {
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds a candidate; slots increase.
    pub fn push(&mut self, new: SlotCandidate) {
        debug_assert!(self.0.last().is_none_or(|last| last.slot < new.slot), "candidates come in the order of slots");
        self.0.push(new);
    }

    /// Candidate of a slot.
    pub fn get(&self, slot: usize) -> Option<&ContactCandidate> {
        let k = self.0.binary_search_by_key(&slot, |c| c.slot as usize).ok()?;
        Some(&self.0[k].candidate)
    }

    /// All candidates in the order of their slots.
    pub fn iter(&self) -> impl Iterator<Item = &SlotCandidate> {
        self.0.iter()
    }

    /// All candidates, pair by pair.
    pub fn by_pair(&self) -> impl Iterator<Item = &[SlotCandidate]> {
        self.0.chunk_by(|one, two| one.pair == two.pair)
    }
}
