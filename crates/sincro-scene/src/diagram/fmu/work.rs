//! Instance of an FMU beside the diagram's memory.
//!
//! The state of an FMU does not stand in the diagram's memory. The memory counts the changes of that state, steps or
//! events; a run that goes back or is copied takes the state of the FMU along if the FMU can save it, and is refused
//! where count and state no longer belong to each other.

use std::sync::{Mutex, PoisonError};

use crate::fmu::{FmuInstance, FmuInterface, FmuModel};

/// An instance at work, with buffers.
#[derive(Debug, Default)]
pub struct Work {
    instance: Mutex<Option<Box<dyn FmuInstance>>>,
    /// Changes of state that the instance has made; NaN if its state is lost.
    pub(super) count: f64,
    /// State that the instance is to be given when it is made.
    saved: Option<Vec<u8>>,
    pub(super) buffers: Buffers,
}

/// Numbers that pass between diagram and FMU.
#[derive(Clone, Debug, Default)]
pub(super) struct Buffers {
    pub inputs: Vec<f64>,
    pub outputs: Vec<f64>,
    pub states: Vec<f64>,
    pub derivatives: Vec<f64>,
    pub indicators: Vec<f64>,
}

/// A copy takes the state of the instance along if it can be saved; else it can begin anew, but not go on.
impl Clone for Work {
    fn clone(&self) -> Self {
        let saved = self.saved.clone().or_else(|| self.save());
        Self { instance: Mutex::default(), count: self.count, saved, buffers: Buffers::default() }
    }
}

impl Work {
    /// State of the instance as bytes; none if there is none, or it cannot be saved.
    fn save(&self) -> Option<Vec<u8>> {
        let mut slot = self.instance.lock().unwrap_or_else(PoisonError::into_inner);
        slot.as_mut()?.save().ok()
    }

    /// State for a snapshot after `count` changes.
    pub(super) fn save_after(&self, count: f64) -> Option<Vec<u8>> {
        if count == 0.0 || count != self.count { None } else { self.saved.clone().or_else(|| self.save()) }
    }

    /// Takes back the state after `count` changes. Without one, only what belongs to that count goes on.
    pub(super) fn restore(&mut self, saved: Option<&[u8]>, count: f64) {
        let Some(saved) = saved else { return };
        self.count = count;
        match self.instance.get_mut().unwrap_or_else(PoisonError::into_inner) {
            Some(instance) => {
                self.saved = None;
                if instance.restore(saved).is_err() {
                    self.count = f64::NAN;
                }
            }
            None => self.saved = Some(saved.to_vec()),
        }
    }

    /// The instance after `count` changes, with the buffers; made, but not started, at the first call (`is_new`).
    pub(super) fn instance(
        &mut self,
        model: &dyn FmuModel,
        (interface, parameters): (FmuInterface, &[(usize, Vec<f64>)]),
        count: f64,
        t: f64,
    ) -> Result<(&mut dyn FmuInstance, &mut Buffers, bool), String> {
        if count == 0.0 && self.count != 0.0 {
            *self = Self::default();
        }
        if self.count != count {
            return Err(format!(
                "its state after {count} {} is not part of what was saved or copied",
                if interface == FmuInterface::ModelExchange { "events" } else { "steps" }
            ));
        }
        let slot = self.instance.get_mut().unwrap_or_else(PoisonError::into_inner);
        let is_new = slot.is_none();
        if is_new {
            if count != 0.0 && self.saved.is_none() {
                return Err("a copy of a run cannot go on: its state cannot be copied".into());
            }
            let mut instance = model.instantiate(interface, parameters)?;
            if let Some(saved) = self.saved.take() {
                instance.start(t, (&[], &[]))?;
                instance.restore(&saved)?;
            }
            *slot = Some(instance);
        }
        let instance = slot.as_deref_mut().ok_or("it was not made")?;
        Ok((instance as &mut dyn FmuInstance, &mut self.buffers, is_new && count == 0.0))
    }
}
