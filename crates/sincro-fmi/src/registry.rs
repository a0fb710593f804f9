//! All instances of this process, by the numbers that importers hold in place of pointers.
//!
//! A number is never given twice, so a call with one that was freed finds nothing. Each instance has a lock of its own:
//! instances run in as many threads as there are, and a second call into an instance that is at work is an error.

use std::collections::BTreeMap;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, RwLock, TryLockError};

use crate::component::Component;
use crate::log::{Message, Status};

static COMPONENTS: RwLock<BTreeMap<usize, Arc<Mutex<Component>>>> = RwLock::new(BTreeMap::new());
/// Numbers look like addresses that no memory has.
static NEXT: AtomicUsize = AtomicUsize::new(1);
const STRIDE: usize = 16;

/// Keeps an instance; returns its number as a pointer.
pub(crate) fn add(component: Component) -> *mut c_void {
    let number = NEXT.fetch_add(1, Ordering::Relaxed) * STRIDE;
    COMPONENTS.write().unwrap_or_else(PoisonError::into_inner).insert(number, Arc::new(Mutex::new(component)));
    number as *mut c_void
}

/// Forgets an instance; does nothing for a number that is none.
pub(crate) fn remove(handle: *mut c_void) {
    let removed = COMPONENTS.write().unwrap_or_else(PoisonError::into_inner).remove(&(handle as usize));
    // a panic of a destructor must not reach the importer
    let _ = catch_unwind(AssertUnwindSafe(|| drop(removed)));
}

/// Calls a function with an instance, then sends its messages. A panic ends the instance, not the process.
pub(crate) fn with(handle: *mut c_void, call: impl FnOnce(&mut Component) -> Status) -> Status {
    let mut call = Some(call);
    // one copy of what follows, not one for each function of the interface: the library goes into every FMU
    guarded_call(handle, &mut |component| call.take().map_or(Status::Fatal, |call| call(component)))
}

fn guarded_call(handle: *mut c_void, call: &mut dyn FnMut(&mut Component) -> Status) -> Status {
    let found = COMPONENTS.read().unwrap_or_else(PoisonError::into_inner).get(&(handle as usize)).cloned();
    let Some(component) = found else { return Status::Error };
    let mut locked = match component.try_lock() {
        Ok(locked) => locked,
        Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
        Err(TryLockError::WouldBlock) => return Status::Error,
    };
    let status = catch_unwind(AssertUnwindSafe(|| call(&mut locked))).unwrap_or_else(|_| {
        locked.fail();
        locked.messages.push(Message {
            status: Status::Fatal,
            category: "logStatusError",
            text: "sincro has an internal error, its message is on the standard error; this instance is lost".into(),
        });
        Status::Fatal
    });
    if locked.messages.is_empty() {
        return status;
    }
    let (messages, logger) = (std::mem::take(&mut locked.messages), locked.logger.clone());
    // the importer may call back from its logger
    drop(locked);
    messages.iter().for_each(|message| logger.send(message));
    status
}

/// Calls a function that makes an instance; a panic is none.
pub(crate) fn guarded<T>(call: impl FnOnce() -> Option<T>) -> Option<T> {
    catch_unwind(AssertUnwindSafe(call)).unwrap_or(None)
}
