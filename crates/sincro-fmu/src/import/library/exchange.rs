//! Model exchange: time, continuous states, derivatives, event indicators.

use super::{Component, Functions, Handle, Status};
use crate::description::FmiVersion;

type GetNumbers = unsafe extern "C" fn(Handle, *mut f64, usize) -> Status;
type SetNumbers = unsafe extern "C" fn(Handle, *const f64, usize) -> Status;

impl Functions {
    fn get_numbers(&self, c: Component, name: &str, numbers: &mut [f64]) -> Result<(), String> {
        if numbers.is_empty() {
            return Ok(());
        }
        let function = self.find::<GetNumbers>(name)?;
        // SAFETY: a live instance, as many places as the call is told
        Self::check(name, unsafe { function(c.0, numbers.as_mut_ptr(), numbers.len()) })
    }

    pub(in super::super) fn set_time(&self, c: Component, t: f64) -> Result<(), String> {
        let function = self.find::<unsafe extern "C" fn(Handle, f64) -> Status>("SetTime")?;
        // SAFETY: a live instance
        Self::check("SetTime", unsafe { function(c.0, t) })
    }

    pub(in super::super) fn set_continuous_states(&self, c: Component, states: &[f64]) -> Result<(), String> {
        const NAME: &str = "SetContinuousStates";
        if states.is_empty() {
            return Ok(());
        }
        let function = self.find::<SetNumbers>(NAME)?;
        // SAFETY: a live instance, as many values as the call is told
        Self::check(NAME, unsafe { function(c.0, states.as_ptr(), states.len()) })
    }

    pub(in super::super) fn continuous_states(&self, c: Component, states: &mut [f64]) -> Result<(), String> {
        self.get_numbers(c, "GetContinuousStates", states)
    }

    pub(in super::super) fn nominals(&self, c: Component, nominals: &mut [f64]) -> Result<(), String> {
        self.get_numbers(c, "GetNominalsOfContinuousStates", nominals)
    }

    pub(in super::super) fn derivatives(&self, c: Component, derivatives: &mut [f64]) -> Result<(), String> {
        let name = match self.version {
            FmiVersion::V2 => "GetDerivatives",
            FmiVersion::V3 => "GetContinuousStateDerivatives",
        };
        self.get_numbers(c, name, derivatives)
    }

    pub(in super::super) fn event_indicators(&self, c: Component, indicators: &mut [f64]) -> Result<(), String> {
        self.get_numbers(c, "GetEventIndicators", indicators)
    }

    /// Tells that a step was accepted; returns whether an event is to be handled, and whether the simulation ends.
    pub(in super::super) fn complete_step(&self, c: Component) -> Result<(bool, bool), String> {
        const NAME: &str = "CompletedIntegratorStep";
        match self.version {
            FmiVersion::V2 => {
                let (mut enters, mut ends) = (0_i32, 0_i32);
                type Complete = unsafe extern "C" fn(Handle, i32, *mut i32, *mut i32) -> Status;
                let function = self.find::<Complete>(NAME)?;
                // SAFETY: a live instance, places for the results
                Self::check(NAME, unsafe { function(c.0, 0, &raw mut enters, &raw mut ends) })?;
                Ok((enters != 0, ends != 0))
            }
            FmiVersion::V3 => {
                let (mut enters, mut ends) = (0_u8, 0_u8);
                type Complete = unsafe extern "C" fn(Handle, bool, *mut u8, *mut u8) -> Status;
                let function = self.find::<Complete>(NAME)?;
                // SAFETY: a live instance, places for the results
                Self::check(NAME, unsafe { function(c.0, false, &raw mut enters, &raw mut ends) })?;
                Ok((enters != 0, ends != 0))
            }
        }
    }

    /// Change of `unknowns` with `knowns` by `seed`; the numbers of arrays one after the other.
    pub(in super::super) fn directional_derivative(
        &self,
        c: Component,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
        change: &mut [f64],
    ) -> Result<(), String> {
        let (u, n_u, k, n_k) = (unknowns.as_ptr(), unknowns.len(), knowns.as_ptr(), knowns.len());
        match self.version {
            FmiVersion::V2 => {
                const NAME: &str = "GetDirectionalDerivative";
                type Refs = *const u32;
                type Get = unsafe extern "C" fn(Handle, Refs, usize, Refs, usize, *const f64, *mut f64) -> Status;
                if n_u != change.len() || n_k != seed.len() {
                    return Err("a derivative of an FMU of version 2 has one number for each variable".into());
                }
                let function = self.find::<Get>(NAME)?;
                // SAFETY: a seed for each known, a place for each unknown
                let status = unsafe { function(c.0, u, n_u, k, n_k, seed.as_ptr(), change.as_mut_ptr()) };
                Self::check(NAME, status)
            }
            FmiVersion::V3 => {
                const NAME: &str = "GetDirectionalDerivative";
                type Refs = *const u32;
                type Get = unsafe extern "C" fn(
                    Handle,
                    Refs,
                    usize,
                    Refs,
                    usize,
                    *const f64,
                    usize,
                    *mut f64,
                    usize,
                ) -> Status;
                let function = self.find::<Get>(NAME)?;
                let (s, n_s, x, n_x) = (seed.as_ptr(), seed.len(), change.as_mut_ptr(), change.len());
                // SAFETY: as many seeds and places as the call is told
                Self::check(NAME, unsafe { function(c.0, u, n_u, k, n_k, s, n_s, x, n_x) })
            }
        }
    }
}
