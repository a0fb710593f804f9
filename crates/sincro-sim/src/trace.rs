//! Hashes: of a model, and of every state that a run went through.

use std::fmt;
use std::hash::Hasher;

use sincro_dynamics::model::Model;
use sincro_dynamics::state::State;
use twox_hash::XxHash3_64;

use crate::load::Loaded;

/// Hash of all states of a run so far, in their order; equal hashes mean identical runs. Each state is hashed together
/// with the hash before it, so that these eight bytes are all that a snapshot must hold of the past.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Diagnostics> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let start = Trace::start(&loaded.scene.initial);
/// let mut moved = loaded.scene.initial.clone();
/// moved.q[0] += 1e-16; // the last bit of 0.1 rad
/// assert!(Trace::start(&moved) != start && start.to_string().len() == 16);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trace(pub u64);

impl Trace {
    /// Creates the hash of a run that begins in `state`.
    #[must_use]
    pub fn start(state: &State<f64>) -> Self {
        let mut trace = Self(0);
        trace.add(state);
        trace
    }

    /// Adds the state after one more tick to the hash, bit by bit.
    pub fn add(&mut self, state: &State<f64>) {
        let mut hasher = XxHash3_64::with_seed(self.0);
        let parts = [&state.q, &state.v, &state.commands, &state.drives, &state.contacts, &state.totals, &state.rotors];
        for x in parts.into_iter().flatten() {
            hasher.write(&x.to_bits().to_le_bytes());
        }
        hasher.write(&state.tick.to_le_bytes());
        self.0 = hasher.finish();
    }

    /// Adds the hash of a structure that differs from that of the start.
    pub(crate) fn add_structure(&mut self, structure: u64) {
        let mut hasher = XxHash3_64::with_seed(self.0);
        hasher.write(&structure.to_le_bytes());
        self.0 = hasher.finish();
    }

    /// Adds states that are integrated together with the world; nothing if there are none. What a controller remembers
    /// from tick to tick is not hashed: the same motion has the same hash, whoever commands it.
    pub(crate) fn add_continuous(&mut self, states: &[f64]) {
        if states.is_empty() {
            return;
        }
        let mut hasher = XxHash3_64::with_seed(self.0);
        for x in states {
            hasher.write(&x.to_bits().to_le_bytes());
        }
        self.0 = hasher.finish();
    }
}

impl fmt::Display for Trace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

/// Returns the hash of a compiled model, 16 hexadecimal digits: every number and name in it counts.
#[must_use]
pub fn model_hash(model: &Model<f64>) -> String {
    let mut hasher = XxHash3_64::with_seed(0);
    // the debug form has every field with all its digits
    hasher.write(format!("{model:?}").as_bytes());
    format!("{:016x}", hasher.finish())
}

/// Returns the hash of a scene's model and diagram, 16 hexadecimal digits: snapshots can be restored where it is the
/// same.
#[must_use]
pub fn plant_hash(loaded: &Loaded) -> String {
    let Some(controller) = &loaded.controller else { return model_hash(&loaded.scene.model) };
    let mut hasher = XxHash3_64::with_seed(0);
    hasher.write(model_hash(&loaded.scene.model).as_bytes());
    hasher.write(format!("{:?}", controller.diagram).as_bytes());
    format!("{:016x}", hasher.finish())
}
