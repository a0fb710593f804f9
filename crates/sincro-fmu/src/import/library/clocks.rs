//! Clocks of FMI 3.0: ticks, intervals, model partitions.

use super::{Component, Functions, Handle, Status};

/// The FMU has set an interval since it was last asked.
const INTERVAL_CHANGED: i32 = 2;

impl Functions {
    /// Lets clocks tick, in event mode.
    pub(in super::super) fn set_clocks(&self, c: Component, references: &[u32]) -> Result<(), String> {
        let ticks = vec![1_u8; references.len()];
        type Set = unsafe extern "C" fn(Handle, *const u32, usize, *const u8) -> Status;
        let function = self.find::<Set>("SetClock")?;
        // SAFETY: a live instance, a truth value for each reference
        Self::check("SetClock", unsafe { function(c.0, references.as_ptr(), references.len(), ticks.as_ptr()) })
    }

    /// Interval of a clock `[s]`, and true if the FMU has set it since it was last asked.
    pub(in super::super) fn interval(&self, c: Component, reference: u32) -> Result<(f64, bool), String> {
        const NAME: &str = "GetIntervalDecimal";
        let (mut interval, mut qualifier) = (0.0, 0_i32);
        type Get = unsafe extern "C" fn(Handle, *const u32, usize, *mut f64, *mut i32) -> Status;
        let function = self.find::<Get>(NAME)?;
        // SAFETY: a live instance, one reference, a place for each result
        let status = unsafe { function(c.0, &raw const reference, 1, &raw mut interval, &raw mut qualifier) };
        Self::check(NAME, status)?;
        Ok((interval, qualifier == INTERVAL_CHANGED))
    }

    /// Shift of a clock `[s]`.
    pub(in super::super) fn shift(&self, c: Component, reference: u32) -> Result<f64, String> {
        const NAME: &str = "GetShiftDecimal";
        let mut shift = 0.0;
        type Get = unsafe extern "C" fn(Handle, *const u32, usize, *mut f64) -> Status;
        let function = self.find::<Get>(NAME)?;
        // SAFETY: a live instance, one reference, one place
        Self::check(NAME, unsafe { function(c.0, &raw const reference, 1, &raw mut shift) }).map(|()| shift)
    }

    /// Runs the model partition of a clock at time `t` `[s]`.
    pub(in super::super) fn activate(&self, c: Component, reference: u32, t: f64) -> Result<(), String> {
        const NAME: &str = "ActivateModelPartition";
        type Activate = unsafe extern "C" fn(Handle, u32, f64) -> Status;
        let function = self.find::<Activate>(NAME)?;
        // SAFETY: a live instance
        Self::check(NAME, unsafe { function(c.0, reference, t) })
    }
}
