//! One instance of a foreign FMU in co-simulation, for programs.

use std::sync::Arc;

use sincro_scene::fmu::FmuInterface;

use super::ForeignFmu;
use super::description::NumberKind;
use super::instance::Instance;
use super::library::SavedState;

/// Instance of a foreign FMU in co-simulation, with a state of its own. After [`Slave::new`] comes [`Slave::start`],
/// then inputs, steps and outputs in turn; dropping it ends and frees it. An error is the text of the FMU's failure.
#[derive(Debug)]
pub struct Slave {
    instance: Instance,
    saved: Option<SavedState>,
}

impl Slave {
    /// Creates an instance with a name for the FMU's own messages; the first one of an FMU loads its library.
    ///
    /// # Errors
    ///
    /// The FMU has no co-simulation, its library cannot be unpacked or loaded, or it refuses to make an instance.
    pub fn new(fmu: &Arc<ForeignFmu>, name: &str) -> Result<Self, String> {
        Ok(Self { instance: Instance::new(fmu, FmuInterface::CoSimulation, name)?, saved: None })
    }

    /// Initializes the instance at time `t` `[s]` with parameters: type, value reference and value, in the unit of the
    /// model description.
    ///
    /// # Errors
    ///
    /// A call of the FMU fails; the text names it.
    pub fn start(&mut self, t: f64, parameters: &[(NumberKind, u32, f64)]) -> Result<(), String> {
        for (kind, reference, value) in parameters {
            self.instance.set(*kind, &[*reference], &[*value])?;
        }
        self.instance.start(t, |_| Ok(())).map(|_| ())
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
        self.instance.get(NumberKind::Float64, references, values)
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
        self.instance.set(NumberKind::Float64, references, values)
    }

    /// Makes a communication step from time `t` to `t + h`, both `[s]`; returns false if the FMU asks to end the
    /// simulation.
    ///
    /// # Errors
    ///
    /// The step fails; the instance is then only to be dropped.
    pub fn step(&mut self, t: f64, h: f64) -> Result<bool, String> {
        self.instance.step(t, h)
    }

    /// Saves the present state inside the instance, in place of one that was saved before.
    ///
    /// # Errors
    ///
    /// The FMU cannot save its state (the text names it), or the call fails.
    pub fn save(&mut self) -> Result<(), String> {
        let state = self.instance.save()?;
        if let Some(old) = self.saved.replace(state) {
            self.instance.free_state(old);
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
        self.instance.restore(state)
    }
}

impl Drop for Slave {
    fn drop(&mut self) {
        if let Some(state) = self.saved.take() {
            self.instance.free_state(state);
        }
    }
}
