//! One instance of a foreign FMU.

use std::sync::Arc;

use super::ForeignFmu;
use super::library::{Component, SavedState};

/// An instance of a foreign FMU in co-simulation.
#[derive(Debug)]
pub struct Slave {
    fmu: Arc<ForeignFmu>,
    component: Component,
    saved: Option<SavedState>,
    is_started: bool,
    has_failed: bool,
}

impl Slave {
    /// Makes an instance.
    ///
    /// # Errors
    ///
    /// The FMU refuses.
    pub fn new(fmu: &Arc<ForeignFmu>, name: &str) -> Result<Self, String> {
        let component = fmu.functions.instantiate(name, &fmu.description.token, &fmu.resources())?;
        Ok(Self { fmu: fmu.clone(), component, saved: None, is_started: false, has_failed: false })
    }

    /// The FMU that it is an instance of.
    #[must_use]
    pub fn fmu(&self) -> &Arc<ForeignFmu> {
        &self.fmu
    }

    /// Starts it at a time `[s]`, with parameters by their value references.
    ///
    /// # Errors
    ///
    /// A call fails.
    pub fn start(&mut self, t: f64, parameters: &[(u32, f64)]) -> Result<(), String> {
        for (reference, value) in parameters {
            self.set(&[*reference], &[*value])?;
        }
        self.fmu.functions.enter_initialization(self.component, t)?;
        self.fmu.functions.call("ExitInitializationMode", self.component)?;
        self.is_started = true;
        Ok(())
    }

    /// Reads real variables.
    ///
    /// # Errors
    ///
    /// The call fails, or there are not as many places as variables.
    pub fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), String> {
        if references.len() != values.len() {
            return Err("there are not as many places as variables".into());
        }
        self.fmu.functions.get(self.component, references, values)
    }

    /// Sets real variables.
    ///
    /// # Errors
    ///
    /// The call fails, or there are not as many values as variables.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), String> {
        if references.len() != values.len() {
            return Err("there are not as many values as variables".into());
        }
        self.fmu.functions.set(self.component, references, values)
    }

    /// Makes a step from `t` by `h` `[s]`; returns false if the FMU ended the simulation.
    ///
    /// # Errors
    ///
    /// The step fails.
    pub fn step(&mut self, t: f64, h: f64) -> Result<bool, String> {
        let stepped = self.fmu.functions.step(self.component, t, h);
        self.has_failed |= stepped.is_err();
        stepped
    }

    /// Keeps the present state, in place of one that was kept before.
    ///
    /// # Errors
    ///
    /// The FMU cannot save its state; it is named.
    pub fn save(&mut self) -> Result<(), String> {
        if !self.fmu.description.can_save {
            return Err(format!("the FMU `{}` cannot save its state", self.fmu.description.name));
        }
        let state = self.fmu.functions.save(self.component)?;
        if let Some(old) = self.saved.replace(state) {
            self.fmu.functions.free_state(self.component, old);
        }
        Ok(())
    }

    /// Goes back to the state that was kept.
    ///
    /// # Errors
    ///
    /// None was kept, or the call fails.
    pub fn restore(&mut self) -> Result<(), String> {
        let state = self.saved.ok_or("no state was kept")?;
        self.fmu.functions.restore(self.component, state)
    }
}

impl Drop for Slave {
    fn drop(&mut self) {
        if let Some(state) = self.saved.take() {
            self.fmu.functions.free_state(self.component, state);
        }
        if self.is_started && !self.has_failed {
            let _ = self.fmu.functions.call("Terminate", self.component);
        }
        self.fmu.functions.free(self.component);
    }
}
