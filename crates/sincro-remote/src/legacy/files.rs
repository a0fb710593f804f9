//! Commands of the legacy API: scenes, models and files.

use super::functions::{Call, Reply, after, ints};
use crate::hub::SessionGuard;
use sincro_coppelia::api::{ApiError, Value, functions};

pub(super) fn load_scene(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let name = call.name()?;
    after(guard.act(|session| session.load(name)))
}

/// Models, and meshes of the scene's folder.
pub(super) fn load_model(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let made = functions::call(&mut guard.session.sim(), "loadModel", &[Value::from(call.name()?)])?;
    let handle = made.first().and_then(Value::as_int).and_then(|h| i32::try_from(h).ok());
    ints([handle.ok_or_else(|| ApiError::new("nothing was loaded"))?])
}

pub(super) fn receive(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let name = file_name(call)?;
    after(guard.session.files()?.put(name, call.data))
}

pub(super) fn erase(guard: &mut SessionGuard, call: &Call<'_>) -> Reply {
    let name = file_name(call)?;
    after(guard.session.files()?.erase(name))
}

/// The last part of a name, which may have the client's own folders before it.
fn file_name<'a>(call: &Call<'a>) -> Result<&'a str, ApiError> {
    let name = call.name()?;
    Ok(name.rsplit(['/', '\\']).next().unwrap_or(name))
}
