//! One instance of a foreign FMU.

use std::sync::Arc;

use super::ForeignFmu;
use super::description::NumberKind;
use super::library::{Component, Functions, SavedState};

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
        let opened = fmu.opened()?;
        let resources = opened.resources(fmu.description.version);
        let component = opened.functions.instantiate(name, &fmu.description.token, &resources)?;
        Ok(Self { fmu: fmu.clone(), component, saved: None, is_started: false, has_failed: false })
    }

    fn functions(&self) -> &Functions {
        &self.fmu.opened().expect("an instance was made with them").functions
    }

    /// The FMU that it is an instance of.
    #[must_use]
    pub fn fmu(&self) -> &Arc<ForeignFmu> {
        &self.fmu
    }

    /// Starts it at a time `[s]`, with parameters by their types and value references.
    ///
    /// # Errors
    ///
    /// A call fails.
    pub fn start(&mut self, t: f64, parameters: &[(NumberKind, u32, f64)]) -> Result<(), String> {
        for (kind, reference, value) in parameters {
            self.set_number(*kind, *reference, *value)?;
        }
        self.functions().enter_initialization(self.component, t)?;
        self.functions().call("ExitInitializationMode", self.component)?;
        self.is_started = true;
        Ok(())
    }

    /// Reads real variables by their value references into `values`, one for each, in the units of the description.
    ///
    /// # Errors
    ///
    /// The call fails, or there are not as many places as variables.
    pub fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), String> {
        if references.len() != values.len() {
            return Err("there are not as many places as variables".into());
        }
        self.functions().get(self.component, references, values)
    }

    /// Sets real variables by their value references, one value for each, in the units of the description.
    ///
    /// # Errors
    ///
    /// The call fails, or there are not as many values as variables.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), String> {
        if references.len() != values.len() {
            return Err("there are not as many values as variables".into());
        }
        self.functions().set(self.component, references, values)
    }

    /// Value of a variable of any numeric type, in the unit of the description.
    ///
    /// # Errors
    ///
    /// The call fails.
    pub fn get_number(&mut self, kind: NumberKind, reference: u32) -> Result<f64, String> {
        self.functions().get_number(self.component, kind, reference)
    }

    /// Sets a variable of any numeric type, in the unit of the description: rounded, and cut off at the bounds of its
    /// type.
    ///
    /// # Errors
    ///
    /// The call fails.
    pub fn set_number(&mut self, kind: NumberKind, reference: u32, value: f64) -> Result<(), String> {
        self.functions().set_number(self.component, kind, reference, value)
    }

    /// Makes a step from `t` by `h` `[s]`; returns false if the FMU ended the simulation.
    ///
    /// # Errors
    ///
    /// The step fails.
    pub fn step(&mut self, t: f64, h: f64) -> Result<bool, String> {
        let stepped = self.functions().step(self.component, t, h);
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
        let state = self.functions().save(self.component)?;
        if let Some(old) = self.saved.replace(state) {
            self.functions().free_state(self.component, old);
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
        self.functions().restore(self.component, state)
    }
}

impl Drop for Slave {
    fn drop(&mut self) {
        if let Some(state) = self.saved.take() {
            self.functions().free_state(self.component, state);
        }
        if self.is_started && !self.has_failed {
            let _ = self.functions().call("Terminate", self.component);
        }
        self.functions().free(self.component);
    }
}
