//! Saved states of instances.

use super::{Component, Functions, Handle, Status};
use crate::description::FmiVersion;

/// Largest saved state that is read `[bytes]`: 1 GiB.
const MAX_STATE: usize = 1 << 30;

/// Saved state of an instance.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct SavedState(Handle);

// SAFETY: as for `Component`
unsafe impl Send for SavedState {}

impl Functions {
    /// Name of a function of states, which the versions write in two ways.
    fn state_name(&self, before: &str, after: &str) -> String {
        let state = if self.version == FmiVersion::V2 { "FMUstate" } else { "FMUState" };
        format!("{before}{state}{after}")
    }

    pub(in super::super) fn save(&self, c: Component) -> Result<SavedState, String> {
        let name = self.state_name("Get", "");
        let mut state = std::ptr::null_mut();
        let function = self.find::<unsafe extern "C" fn(Handle, *mut Handle) -> Status>(&name)?;
        // SAFETY: a live instance, a place for the state
        Self::check(&name, unsafe { function(c.0, &raw mut state) }).map(|()| SavedState(state))
    }

    pub(in super::super) fn restore(&self, c: Component, state: SavedState) -> Result<(), String> {
        let name = self.state_name("Set", "");
        let function = self.find::<unsafe extern "C" fn(Handle, Handle) -> Status>(&name)?;
        // SAFETY: a live instance and a state of it
        Self::check(&name, unsafe { function(c.0, state.0) })
    }

    pub(in super::super) fn free_state(&self, c: Component, state: SavedState) {
        let mut state = state.0;
        let name = self.state_name("Free", "");
        if let Ok(function) = self.find::<unsafe extern "C" fn(Handle, *mut Handle) -> Status>(&name) {
            // SAFETY: a live instance and a state of it, which its owner gives up
            unsafe { function(c.0, &raw mut state) };
        }
    }

    pub(in super::super) fn serialize(&self, c: Component, state: SavedState) -> Result<Vec<u8>, String> {
        let name = &*self.state_name("Serialized", "Size");
        let mut size = 0;
        let function = self.find::<unsafe extern "C" fn(Handle, Handle, *mut usize) -> Status>(name)?;
        // SAFETY: a live instance and a state of it, a place for the size
        Self::check(name, unsafe { function(c.0, state.0, &raw mut size) })?;
        if size > MAX_STATE {
            return Err(format!("the state of the FMU has {size} bytes, {MAX_STATE} at most are saved"));
        }
        let mut bytes = vec![0_u8; size];
        let name = &*self.state_name("Serialize", "");
        let function = self.find::<unsafe extern "C" fn(Handle, Handle, *mut u8, usize) -> Status>(name)?;
        // SAFETY: as above, with a place for as many bytes as the call is told
        Self::check(name, unsafe { function(c.0, state.0, bytes.as_mut_ptr(), size) })?;
        Ok(bytes)
    }

    pub(in super::super) fn deserialize(&self, c: Component, bytes: &[u8]) -> Result<SavedState, String> {
        let name = if self.version == FmiVersion::V2 { "DeSerializeFMUstate" } else { "DeserializeFMUState" };
        let mut state = std::ptr::null_mut();
        type Read = unsafe extern "C" fn(Handle, *const u8, usize, *mut Handle) -> Status;
        let function = self.find::<Read>(name)?;
        // SAFETY: a live instance, as many bytes as the call is told, a place for the state
        let status = unsafe { function(c.0, bytes.as_ptr(), bytes.len(), &raw mut state) };
        Self::check(name, status).map(|()| SavedState(state))
    }
}
