//! Structure of a run that differs from that of its start.

use std::sync::Arc;

use sincro_scene::scene::Scene;

use crate::restructure::Restructured;
use crate::trace::model_hash;

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
    /// Structure after one more change.
    #[must_use]
    pub fn after(before: Option<&Self>, change: &Restructured) -> Self {
        let (hash, energy, count) = before.map_or((0, 0.0, 0), |s| (s.hash, s.energy_added, s.count));
        let model = u64::from_str_radix(&model_hash(&change.scene.model), 16).unwrap_or(0);
        let energy_added = energy + change.transferred.energy_change;
        let hash = sincro_math::random::splitmix64(hash, model);
        Self { scene: change.scene.clone(), hash, energy_added, count: count + 1 }
    }
}
