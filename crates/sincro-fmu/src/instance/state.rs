//! State of an instance: what an importer saves to go back to, or to go on from elsewhere.
//!
//! As bytes, little endian: magic and version, token of the FMU, time of the start, the present values of parameters
//! and inputs; then, if the run has begun, the values that it began with, the memory of the outputs and the snapshot.

use sincro_sim::snapshot::{Snapshot, SnapshotError};

use super::{Instance, Run};
use crate::variables::Role;

const MAGIC: &[u8; 8] = b"sfmu0001";

/// Saved state of an [`Instance`], parameters and inputs included: [`Instance::save`] makes it, [`Instance::restore`]
/// goes back to it.
#[derive(Clone, Debug, PartialEq)]
pub struct FmuState {
    start: f64,
    values: Vec<f64>,
    run: Option<SavedRun>,
}

impl FmuState {
    /// Returns true if the run had begun when the state was saved.
    #[must_use]
    pub fn has_begun(&self) -> bool {
        self.run.is_some()
    }
}

#[derive(Clone, Debug, PartialEq)]
struct SavedRun {
    begun_with: Vec<f64>,
    outputs: Vec<f64>,
    snapshot: Snapshot,
}

impl Instance {
    /// Copies the present state of the instance, to go back to it or on from it.
    ///
    /// # Errors
    ///
    /// The scene has scripts, whose memory cannot be saved, or the instance is used for model exchange.
    pub fn save(&mut self) -> Result<FmuState, String> {
        if !self.can_save() {
            let script = &self.loaded.scene.scripts[0];
            return Err(format!("the script of `{}` has a memory that cannot be saved", script.path));
        }
        if self.run.as_ref().is_some_and(|run| run.exchange.is_some()) {
            return Err("states of model exchange cannot be saved".into());
        }
        let run = self.run.as_mut().map(|run| {
            let outputs = run.recorder.memory().collect();
            SavedRun { begun_with: run.begun_with.clone(), outputs, snapshot: run.lockstep.snapshot(run.trace) }
        });
        Ok(FmuState { start: self.start, values: self.values.clone(), run })
    }

    /// Restores a saved state of this or another instance of the same FMU; the run goes on from there to the same bits.
    ///
    /// # Errors
    ///
    /// The state belongs to another FMU, or a run with its parameters cannot begin.
    pub fn restore(&mut self, state: &FmuState) -> Result<(), String> {
        if state.values.len() != self.values.len() {
            return Err("the state belongs to another FMU".into());
        }
        self.start = state.start;
        let Some(saved) = &state.run else {
            self.run = None;
            self.values.clone_from(&state.values);
            return Ok(());
        };
        if self.run.as_ref().is_none_or(|run| !is_same(&run.begun_with, &saved.begun_with)) {
            self.run = None;
            self.values.clone_from(&saved.begun_with);
            self.begin()?;
        }
        let run = self.run.as_mut().ok_or("the run has not begun")?;
        // tunable parameters come back with the snapshot
        for (variable, value) in self.catalogue.variables.iter().zip(&state.values) {
            if let Role::Input(command) = &variable.role {
                run.lockstep.hold_command(*command, *value);
            }
        }
        self.values.clone_from(&state.values);
        run.go_back(saved)
    }

    /// Encodes a saved state of this FMU for a file: little endian, with a version; [`Instance::from_bytes`] reads it.
    #[must_use]
    pub fn to_bytes(&self, state: &FmuState) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(state.start.to_le_bytes());
        push(&mut bytes, &state.values);
        bytes.push(u8::from(state.run.is_some()));
        if let Some(saved) = &state.run {
            push(&mut bytes, &saved.begun_with);
            push(&mut bytes, &saved.outputs);
            let loaded = self.run.as_ref().map_or(&self.loaded, |run| &run.loaded);
            bytes.extend(saved.snapshot.to_bytes(loaded));
        }
        bytes
    }

    /// Decodes a saved state from the bytes of [`Instance::to_bytes`]; the instance itself stays as it is.
    ///
    /// # Errors
    ///
    /// The bytes are no state or damaged, or the state is of another FMU or of an instance with other fixed parameters.
    pub fn from_bytes(&self, bytes: &[u8]) -> Result<FmuState, String> {
        let not_a_state = || "these bytes are no state of this FMU".to_owned();
        let mut rest = bytes.strip_prefix(MAGIC.as_slice()).ok_or_else(not_a_state)?;
        let start = number(&mut rest).ok_or_else(not_a_state)?;
        let values = vector(&mut rest).ok_or_else(not_a_state)?;
        let (has_run, mut rest) = rest.split_first().ok_or_else(not_a_state)?;
        if values.len() != self.values.len() {
            return Err(not_a_state());
        }
        if *has_run == 0 {
            return Ok(FmuState { start, values, run: None });
        }
        let begun_with = vector(&mut rest).ok_or_else(not_a_state)?;
        let outputs = vector(&mut rest).ok_or_else(not_a_state)?;
        let loaded = self.run.as_ref().map_or(&self.loaded, |run| &run.loaded);
        let snapshot = Snapshot::from_bytes(rest, loaded).map_err(|error| match error {
            SnapshotError::OtherModel => {
                "the state belongs to an instance with other fixed parameters: set them before it is read".to_owned()
            }
            error => error.to_string(),
        })?;
        Ok(FmuState { start, values, run: Some(SavedRun { begun_with, outputs, snapshot }) })
    }
}

impl Run {
    fn go_back(&mut self, saved: &SavedRun) -> Result<(), String> {
        let lengths = |s: &sincro_dynamics::state::State<f64>| {
            // contacts are as many as touch
            [&s.q, &s.v, &s.commands, &s.drives, &s.totals, &s.rotors].map(Vec::len)
        };
        let fits = lengths(&saved.snapshot.state) == lengths(self.lockstep.state());
        if !fits || !self.recorder.set_memory(&saved.outputs) {
            return Err("the state belongs to another FMU".into());
        }
        self.lockstep.restore(&saved.snapshot);
        self.trace = saved.snapshot.trace;
        (self.is_observed, self.is_begun) = (false, true);
        (self.followed, self.is_followed, self.ended) = (None, false, None);
        Ok(())
    }
}

/// Same bits: values that are not numbers are the same, too.
fn is_same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

fn push(bytes: &mut Vec<u8>, vector: &[f64]) {
    bytes.extend((vector.len() as u64).to_le_bytes());
    vector.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
}

fn number(rest: &mut &[u8]) -> Option<f64> {
    let (head, tail) = rest.split_first_chunk::<8>()?;
    *rest = tail;
    Some(f64::from_le_bytes(*head))
}

fn vector(rest: &mut &[u8]) -> Option<Vec<f64>> {
    let n = usize::try_from(number(rest)?.to_bits()).ok()?;
    if n > rest.len() / 8 {
        return None;
    }
    (0..n).map(|_| number(rest)).collect()
}
