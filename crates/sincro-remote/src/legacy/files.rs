//! Commands of the legacy API: scenes, models and files.

use super::functions::{Call, Reply, done, ints};
use crate::hub::SessionGuard;
use sincro_coppelia::session::{ApiError, Value, api};

/// Commands of this file.
pub(super) const COMMANDS: [u16; 4] = [0x3002, 0x3003, 0x3004, 0x3006];

/// Runs a function.
pub(super) fn run(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let name = call.name()?;
    // what a client calls a file may have its own folders before it
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    match call.function {
        0x3002 => {
            guard.act(|session| session.load(name))?;
            done()
        }
        0x3004 => guard.session.files()?.put(last, call.data).and_then(|()| done()),
        0x3006 => guard.session.files()?.erase(last).and_then(|()| done()),
        // meshes of the scene's folder; of others it says why not
        _ => {
            let made = api::call(&mut guard.session.sim(), "loadModel", &[Value::from(name)])?;
            let handle = made.first().and_then(Value::as_int).and_then(|h| i32::try_from(h).ok());
            ints([handle.ok_or_else(|| ApiError::new("nothing was loaded"))?])
        }
    }
}
