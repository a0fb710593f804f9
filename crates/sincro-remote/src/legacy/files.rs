//! What the commands of the legacy API do: scenes, models and files.

use super::functions::{Call, Reply, done, ints};
use crate::hub::Floor;
use sincro_coppelia::session::{Refusal, Value, api};

/// Commands of this file.
pub(super) const COMMANDS: [u16; 4] = [0x3002, 0x3003, 0x3004, 0x3006];

/// Runs a function.
pub(super) fn run(floor: &mut Floor, call: &Call<'_>) -> Reply {
    let name = call.name()?;
    // what a client calls a file may have its own folders before it
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    match call.function {
        0x3002 => {
            floor.act(|session| session.load(name))?;
            done()
        }
        0x3004 => floor.session.files()?.put(last, call.data).and_then(|()| done()),
        0x3006 => floor.session.files()?.erase(last).and_then(|()| done()),
        // meshes of the scene's folder; of others it says why not
        _ => {
            let made = api::call(&mut floor.session.desk(), "loadModel", &[Value::from(name)])?;
            let handle = made.first().and_then(Value::as_int).and_then(|h| i32::try_from(h).ok());
            ints([handle.ok_or_else(|| Refusal::new("nothing was loaded"))?])
        }
    }
}
