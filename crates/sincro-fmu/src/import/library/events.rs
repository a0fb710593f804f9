//! Event mode: the iteration that updates discrete states.

use sincro_scene::fmu::FmuEvents;

use super::{Component, Functions, Handle, Status};
use crate::description::FmiVersion;

/// Most iterations of one event.
const MAX_ITERATIONS: usize = 1000;

/// Result of an update of discrete states in FMI 2.0.
#[repr(C)]
#[derive(Default)]
struct EventInfo {
    needs_update: i32,
    ends: i32,
    nominals_changed: i32,
    values_changed: i32,
    has_next: i32,
    next: f64,
}

impl Functions {
    /// Updates the discrete states until they do not change any more, in event mode.
    pub(in super::super) fn update_discrete_states(&self, c: Component) -> Result<FmuEvents, String> {
        for _ in 0..MAX_ITERATIONS {
            let (needs_update, events) = match self.version {
                FmiVersion::V2 => self.update2(c)?,
                FmiVersion::V3 => self.update3(c)?,
            };
            if events.next.is_nan() {
                return Err("the FMU gives a next time event that is no number".into());
            }
            if events.ends || !needs_update {
                return Ok(events);
            }
        }
        Err(format!("the event of the FMU has no end after {MAX_ITERATIONS} iterations"))
    }

    fn update2(&self, c: Component) -> Result<(bool, FmuEvents), String> {
        const NAME: &str = "NewDiscreteStates";
        let mut info = EventInfo::default();
        let function = self.find::<unsafe extern "C" fn(Handle, *mut EventInfo) -> Status>(NAME)?;
        // SAFETY: a live instance, a place for the result
        Self::check(NAME, unsafe { function(c.0, &raw mut info) })?;
        let next = if info.has_next != 0 { info.next } else { f64::INFINITY };
        Ok((info.needs_update != 0, FmuEvents { next, ends: info.ends != 0 }))
    }

    fn update3(&self, c: Component) -> Result<(bool, FmuEvents), String> {
        const NAME: &str = "UpdateDiscreteStates";
        type Truth = *mut u8;
        type Update = unsafe extern "C" fn(Handle, Truth, Truth, Truth, Truth, Truth, *mut f64) -> Status;
        // bytes, because a library could leave something else than a truth value in a `bool`
        let [mut needs, mut ends, mut nominals, mut values, mut has_next] = [0_u8; 5];
        let mut next = 0.0;
        let function = self.find::<Update>(NAME)?;
        let places = (&raw mut needs, &raw mut ends, &raw mut nominals, &raw mut values, &raw mut has_next);
        // SAFETY: a live instance, places for the results
        let status = unsafe { function(c.0, places.0, places.1, places.2, places.3, places.4, &raw mut next) };
        Self::check(NAME, status)?;
        let next = if has_next != 0 { next } else { f64::INFINITY };
        Ok((needs != 0, FmuEvents { next, ends: ends != 0 }))
    }
}
