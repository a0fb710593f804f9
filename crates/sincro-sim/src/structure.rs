//! Structure of a run that differs from that of its start.

use std::sync::Arc;

use sincro_scene::scene::Scene;

use crate::restructure::Restructured;

/// Structure that differs from that of the start of a run, in a lock-step and in snapshots.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Scene as it is now; its initial state is that after the last change.
    pub scene: Arc<Scene>,
    /// Hash of all structures since the start, in their order; part of the trace of the run.
    pub hash: u64,
    /// Energy that changes of the structure have brought in or taken out since the start `[J]`.
    pub energy_added: f64,
    /// Number of changes since the start.
    pub count: u64,
}

impl PartialEq for Structure {
    fn eq(&self, other: &Self) -> bool {
        (self.hash, self.count) == (other.hash, other.count) && self.energy_added == other.energy_added
    }
}

impl Structure {
    /// Structure after a further change.
    #[must_use]
    pub fn after(before: Option<&Self>, change: &Restructured) -> Self {
        let (hash, energy, count) = before.map_or((0, 0.0, 0), |s| (s.hash, s.energy_added, s.count));
        let energy_added = change.steps.iter().fold(energy, |sum, step| sum + step.energy);
        let hash = change.steps.iter().fold(hash, |hash, step| sincro_math::random::splitmix64(hash, step.hash));
        let count = count + change.steps.len() as u64;
        Self { scene: change.scene.clone(), hash, energy_added, count }
    }
}
