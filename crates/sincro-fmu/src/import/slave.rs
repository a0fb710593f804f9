//! One instance of a foreign FMU.

use std::sync::Arc;

use super::ForeignFmu;
use super::description::NumberKind;
use super::library::{Component, Functions, SavedState};

/// Instance of a foreign FMU in co-simulation, with a state of its own. After [`Slave::new`] comes [`Slave::start`],
/// then inputs, steps and outputs in turn; dropping it ends and frees it. An error is the text of the FMU's failure.
#[derive(Debug)]
pub struct Slave {
    fmu: Arc<ForeignFmu>,
    component: Component,
    saved: Option<SavedState>,
    is_started: bool,
    has_failed: bool,
}

impl Slave {
    /// Creates an instance with a name for the FMU's own messages; the first one of an FMU loads its library.
    ///
    /// # Errors
    ///
    /// The library cannot be unpacked or loaded, or the FMU refuses to make an instance.
    pub fn new(fmu: &Arc<ForeignFmu>, name: &str) -> Result<Self, String> {
        let opened = fmu.opened()?;
        let resources = opened.resources(fmu.description.version);
        let component = opened.functions.instantiate(name, &fmu.description.token, &resources)?;
        Ok(Self { fmu: fmu.clone(), component, saved: None, is_started: false, has_failed: false })
    }

    fn functions(&self) -> &Functions {
        &self.fmu.opened().expect("an instance was made with them").functions
    }

    /// Initializes the instance at time `t` `[s]` with parameters: type, value reference and value, in the unit of the
    /// model description.
    ///
    /// # Errors
    ///
    /// A call of the FMU fails; the text names it.
    pub fn start(&mut self, t: f64, parameters: &[(NumberKind, u32, f64)]) -> Result<(), String> {
        for (kind, reference, value) in parameters {
            self.set_number(*kind, *reference, *value)?;
        }
        self.functions().enter_initialization(self.component, t)?;
        self.functions().call("ExitInitializationMode", self.component)?;
        self.is_started = true;
        Ok(())
    }

    /// Reads real variables into `values`: entry k is the variable of value reference `references[k]`, in the unit of
    /// the model description.
    ///
    /// # Errors
    ///
    /// The slices differ in length, or the call of the FMU fails.
    pub fn get(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), String> {
        if references.len() != values.len() {
            return Err("there are not as many places as variables".into());
        }
        self.functions().get(self.component, references, values)
    }

    /// Sets real variables: the variable of value reference `references[k]` to `values[k]`, in the unit of the model
    /// description.
    ///
    /// # Errors
    ///
    /// The slices differ in length, or the call of the FMU fails.
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
    pub(crate) fn get_number(&mut self, kind: NumberKind, reference: u32) -> Result<f64, String> {
        self.functions().get_number(self.component, kind, reference)
    }

    /// Sets a variable of any numeric type, in the unit of the description: rounded, and cut off at the bounds of its
    /// type.
    ///
    /// # Errors
    ///
    /// The call fails.
    pub(crate) fn set_number(&mut self, kind: NumberKind, reference: u32, value: f64) -> Result<(), String> {
        self.functions().set_number(self.component, kind, reference, value)
    }

    /// Makes a communication step from time `t` to `t + h`, both `[s]`; returns false if the FMU asks to end the
    /// simulation.
    ///
    /// # Errors
    ///
    /// The step fails; the instance is then only to be dropped.
    pub fn step(&mut self, t: f64, h: f64) -> Result<bool, String> {
        let stepped = self.functions().step(self.component, t, h);
        self.has_failed |= stepped.is_err();
        stepped
    }

    /// Saves the present state inside the instance, in place of one that was saved before.
    ///
    /// # Errors
    ///
    /// The FMU cannot save its state (the text names it), or the call fails.
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

    /// Restores the state that was saved last; it can be restored again.
    ///
    /// # Errors
    ///
    /// No state was saved, or the call of the FMU fails.
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
