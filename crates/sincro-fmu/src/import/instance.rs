//! One instance of a foreign FMU, in any of its interfaces.

use std::sync::Arc;

use sincro_scene::fmu::{FmuEvents, FmuInterface};

use super::ForeignFmu;
use super::clocks::Clocks;
use super::description::NumberKind;
use super::library::{Component, Functions, SavedState};

/// Most parts of one communication step.
const MAX_PARTS: usize = 1_000_000;

/// Most rounds of clocks that tick at one instant.
const MAX_ROUNDS: usize = 1000;

/// Instance of a foreign FMU, started once; dropping it ends and frees it.
#[derive(Debug)]
pub(super) struct Instance {
    pub fmu: Arc<ForeignFmu>,
    pub interface: FmuInterface,
    component: Component,
    clocks: Clocks,
    /// True for co-simulation in which the importer handles events: it has clocks.
    has_event_mode: bool,
    /// Present time `[s]`.
    t: f64,
    is_started: bool,
    has_failed: bool,
}

impl Instance {
    /// Makes an instance with a name for the FMU's own messages; the first one of an FMU loads its library.
    pub fn new(fmu: &Arc<ForeignFmu>, interface: FmuInterface, name: &str) -> Result<Self, String> {
        let clocks = Clocks::new(&fmu.description.clocks);
        let has_event_mode = interface == FmuInterface::CoSimulation && !clocks.is_empty();
        let functions = fmu.functions(interface)?;
        let resources = fmu.resources()?;
        let texts = (name, &*fmu.description.token, &*resources);
        let component = functions.instantiate((interface, has_event_mode), texts)?;
        Ok(Self {
            fmu: fmu.clone(),
            interface,
            component,
            clocks,
            has_event_mode,
            t: 0.0,
            is_started: false,
            has_failed: false,
        })
    }

    pub fn functions(&self) -> &Functions {
        self.fmu.functions(self.interface).expect("an instance was made with them")
    }

    fn call(&self, name: &str) -> Result<(), String> {
        self.functions().call(name, self.component)
    }

    /// Sets structural parameters, before anything else.
    pub fn configure(&self, set: impl FnOnce(&Self) -> Result<(), String>) -> Result<(), String> {
        self.call("EnterConfigurationMode")?;
        set(self)?;
        self.call("ExitConfigurationMode")
    }

    /// Initializes the instance at time `t` `[s]`; `set_inputs` is called in between.
    pub fn start(&mut self, t: f64, set_inputs: impl FnOnce(&Self) -> Result<(), String>) -> Result<FmuEvents, String> {
        let started = self.try_start(t, set_inputs);
        self.has_failed |= started.is_err();
        started
    }

    fn try_start(&mut self, t: f64, set_inputs: impl FnOnce(&Self) -> Result<(), String>) -> Result<FmuEvents, String> {
        let (fmu, c) = (self.fmu.clone(), self.component);
        let functions = fmu.functions(self.interface)?;
        functions.set_up(c, t)?;
        functions.enter_initialization(c, t)?;
        set_inputs(self)?;
        self.clocks.begin(functions, c, t)?;
        self.call("ExitInitializationMode")?;
        (self.t, self.is_started) = (t, true);
        match self.interface {
            FmuInterface::ModelExchange => {
                let events = self.iterate()?;
                self.call("EnterContinuousTimeMode")?;
                Ok(events)
            }
            FmuInterface::CoSimulation if self.has_event_mode => {
                let events = self.iterate()?;
                self.call("EnterStepMode")?;
                Ok(events)
            }
            FmuInterface::CoSimulation => Ok(FmuEvents { next: f64::INFINITY, ends: false }),
            FmuInterface::ScheduledExecution => {
                self.clocks.poll(functions, c, t)?;
                self.activate_until(t)?;
                Ok(FmuEvents { next: f64::INFINITY, ends: false })
            }
        }
    }

    /// Handles the events of the present instant, in event mode, clocks included.
    fn iterate(&mut self) -> Result<FmuEvents, String> {
        let (fmu, c) = (self.fmu.clone(), self.component);
        let functions = fmu.functions(self.interface)?;
        for _ in 0..MAX_ROUNDS {
            let due = self.clocks.take_due(self.t);
            if !due.is_empty() {
                functions.set_clocks(c, &due)?;
            }
            let mut events = functions.update_discrete_states(c)?;
            self.clocks.poll(functions, c, self.t)?;
            events.next = events.next.min(self.clocks.next());
            if events.ends || self.clocks.next() > self.t {
                return Ok(events);
            }
        }
        Err(format!("clocks of the FMU tick without end at t = {} s", self.t))
    }

    /// Handles events of model exchange; `set_inputs` is called in event mode.
    pub fn handle_events(&mut self, set_inputs: impl FnOnce(&Self) -> Result<(), String>) -> Result<FmuEvents, String> {
        self.call("EnterEventMode")?;
        set_inputs(self)?;
        let events = self.iterate()?;
        self.call("EnterContinuousTimeMode")?;
        Ok(events)
    }

    /// Makes a communication step from time `t` to `t + h`, both `[s]`; returns false if the FMU asks to end the
    /// simulation.
    pub fn step(&mut self, t: f64, h: f64) -> Result<bool, String> {
        let stepped = match self.interface {
            FmuInterface::ScheduledExecution => self.activate_until(t + h).map(|()| true),
            _ if self.has_event_mode => self.step_with_events(t, h),
            _ => self.functions().step(self.component, t, h).map(|stepped| !stepped.ends),
        };
        self.has_failed |= stepped.is_err();
        self.t = t + h;
        stepped
    }

    fn step_with_events(&mut self, t: f64, h: f64) -> Result<bool, String> {
        let end = t + h;
        self.t = t;
        for _ in 0..MAX_PARTS {
            let target = end.min(self.clocks.next());
            let mut has_event = false;
            if target > self.t {
                let stepped = self.functions().step(self.component, self.t, target - self.t)?;
                if stepped.ends {
                    return Ok(false);
                }
                let reached = stepped.reached.unwrap_or(target);
                if !(reached >= self.t && reached <= target) {
                    return Err(format!("a step to {target} s ended at {reached} s"));
                }
                (has_event, self.t) = (stepped.has_event, reached);
            }
            if has_event || self.clocks.next() <= self.t {
                self.call("EnterEventMode")?;
                if self.iterate()?.ends {
                    return Ok(false);
                }
                self.call("EnterStepMode")?;
            }
            if self.t >= end {
                return Ok(true);
            }
        }
        Err(format!("a step of {h} s has more than {MAX_PARTS} events"))
    }

    /// Runs the model partitions of all clocks that tick up to time `end` `[s]`, in scheduled execution.
    fn activate_until(&mut self, end: f64) -> Result<(), String> {
        let fmu = self.fmu.clone();
        let functions = fmu.functions(self.interface)?;
        for _ in 0..MAX_PARTS {
            let next = self.clocks.next();
            // ticks are multiples of the interval, ends those of the step: both are rounded
            if next > end + 1e-9 {
                return Ok(());
            }
            self.t = self.t.max(next);
            for reference in self.clocks.take_due(self.t) {
                functions.activate(self.component, reference, self.t)?;
            }
            self.clocks.poll(functions, self.component, self.t)?;
        }
        Err(format!("clocks of the FMU tick more than {MAX_PARTS} times in one step"))
    }

    /// Runs the model partition of a clock that the importer triggers, at time `t` `[s]`.
    pub fn trigger(&mut self, reference: u32, t: f64) -> Result<(), String> {
        if self.interface != FmuInterface::ScheduledExecution {
            return Err("clocks are triggered in scheduled execution alone".into());
        }
        let fmu = self.fmu.clone();
        let functions = fmu.functions(self.interface)?;
        functions.activate(self.component, reference, t)?;
        self.t = t;
        self.clocks.poll(functions, self.component, t)?;
        self.activate_until(t)
    }

    /// Sets time `[s]` and continuous states.
    pub fn set_continuous_states(&mut self, t: f64, states: &[f64]) -> Result<(), String> {
        self.t = t;
        self.functions().set_time(self.component, t)?;
        self.functions().set_continuous_states(self.component, states)
    }

    pub fn continuous_states(&self, states: &mut [f64], nominals: &mut [f64]) -> Result<(), String> {
        self.functions().continuous_states(self.component, states)?;
        self.functions().nominals(self.component, nominals)
    }

    pub fn derivatives(&self, derivatives: &mut [f64]) -> Result<(), String> {
        self.functions().derivatives(self.component, derivatives)
    }

    pub fn event_indicators(&self, indicators: &mut [f64]) -> Result<(), String> {
        self.functions().event_indicators(self.component, indicators)
    }

    /// Tells that a step was accepted; returns true if an event is to be handled.
    pub fn complete_step(&self) -> Result<bool, String> {
        if !self.fmu.description.interface(self.interface).is_some_and(|of| of.needs_completed_step) {
            return Ok(false);
        }
        match self.functions().complete_step(self.component)? {
            (_, true) => Err(format!("it ended the simulation at t = {} s", self.t)),
            (has_event, false) => Ok(has_event),
        }
    }

    /// Change of `unknowns` and behind them all derivatives of states with `knowns` and behind them all states; false
    /// if the FMU does not give it.
    pub fn directional_derivative(
        &self,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        change: &mut [f64],
    ) -> Result<bool, String> {
        let description = &self.fmu.description;
        let has = description.interface(self.interface).is_some_and(|of| of.has_derivatives);
        if !has || description.state_references.len() != description.states.len() {
            return Ok(false);
        }
        let derivatives = description.states.iter().map(|k| description.variables[*k].reference);
        let unknowns: Vec<u32> = unknowns.iter().copied().chain(derivatives).collect();
        let knowns: Vec<u32> = knowns.iter().chain(&description.state_references).copied().collect();
        self.functions().directional_derivative(self.component, (&unknowns, &knowns), seed, change)?;
        Ok(true)
    }

    /// Reads variables of one type, arrays whole.
    pub fn get(&self, kind: NumberKind, references: &[u32], values: &mut [f64]) -> Result<(), String> {
        self.functions().get(self.component, kind, references, values)
    }

    /// Sets variables of one type, arrays whole.
    pub fn set(&self, kind: NumberKind, references: &[u32], values: &[f64]) -> Result<(), String> {
        self.functions().set(self.component, kind, references, values)
    }

    /// Saves the state inside the library.
    pub fn save(&self) -> Result<SavedState, String> {
        if !self.fmu.description.interface(self.interface).is_some_and(|of| of.can_save) {
            return Err(format!("the FMU `{}` cannot save its state", self.fmu.description.name));
        }
        self.functions().save(self.component)
    }

    pub fn restore(&self, state: SavedState) -> Result<(), String> {
        self.functions().restore(self.component, state)
    }

    pub fn free_state(&self, state: SavedState) {
        self.functions().free_state(self.component, state);
    }

    /// State as bytes: numbers of the clocks, then what the FMU writes.
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let state = self.save()?;
        let written = self.functions().serialize(self.component, state);
        self.free_state(state);
        let own = [self.t].into_iter().chain(self.clocks.save());
        let mut bytes: Vec<u8> = own.flat_map(f64::to_le_bytes).collect();
        bytes.extend(written?);
        Ok(bytes)
    }

    /// Takes back the state of [`Instance::to_bytes`].
    pub fn restore_bytes(&mut self, bytes: &[u8]) -> Result<(), String> {
        let own = bytes.split_at_checked(8 * (1 + self.clocks.n_numbers())).ok_or("a saved state is too short")?;
        let numbers: Vec<f64> =
            own.0.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().expect("eight bytes"))).collect();
        let state = self.functions().deserialize(self.component, own.1)?;
        let restored = self.restore(state);
        self.free_state(state);
        self.t = numbers[0];
        self.clocks.restore(&numbers[1..]);
        restored
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        if self.is_started && !self.has_failed {
            let _ = self.call("Terminate");
        }
        self.functions().free(self.component);
    }
}
