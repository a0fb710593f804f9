//! Contact candidates of all pairs that are near, by slot.

use super::candidate::ContactCandidate;

/// Candidate of one slot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlotCandidate {
    /// Slot among those of contacts.
    pub slot: u32,
    /// Index of the pair.
    pub pair: u32,
    /// The candidate.
    pub candidate: ContactCandidate,
}

/// Candidates in the order of their slots.
#[derive(Clone, Debug, Default)]
pub struct CandidateList(Vec<SlotCandidate>);

impl CandidateList {
    /// Removes all candidates; the memory stays.
    #[inline]
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds a candidate; slots increase.
    #[inline]
    pub fn push(&mut self, new: SlotCandidate) {
        debug_assert!(self.0.last().is_none_or(|last| last.slot < new.slot), "candidates come in the order of slots");
        self.0.push(new);
    }

    /// Candidate of a slot; none if the slot is empty.
    #[inline]
    #[must_use]
    pub fn get(&self, slot: usize) -> Option<&ContactCandidate> {
        let k = self.0.binary_search_by_key(&slot, |c| c.slot as usize).ok()?;
        Some(&self.0[k].candidate)
    }

    /// All candidates in the order of their slots.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = &SlotCandidate> {
        self.0.iter()
    }

    /// Candidates of a pair.
    pub fn of_pair(&self, pair: u32) -> impl Iterator<Item = &SlotCandidate> {
        // pairs have their slots one after the other
        let first = self.0.partition_point(|c| c.pair < pair);
        self.0[first..].iter().take_while(move |c| c.pair == pair)
    }

    /// All candidates, pair by pair.
    #[inline]
    pub fn by_pair(&self) -> impl Iterator<Item = &[SlotCandidate]> {
        self.0.chunk_by(|one, two| one.pair == two.pair)
    }
}
