//! Commands of the legacy API: signals.

use sincro_coppelia::api::{ApiError, SimApi};

use super::functions::{Call, Reply, after, done, ints, reals};

fn unset(name: &str) -> ApiError {
    ApiError(format!("there is no signal `{name}`"))
}

pub(super) fn float(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let name = call.name()?;
    reals([*sim.registry.floats.get(name).ok_or_else(|| unset(name))?])
}

pub(super) fn set_float(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (name, of_run) = (call.name()?, sim.is_running());
    after(sim.registry.floats.set(name, call.float(0)?, of_run))
}

pub(super) fn clear_float(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    sim.registry.floats.clear(call.name()?);
    done()
}

pub(super) fn int(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let name = call.name()?;
    let x = *sim.registry.integers.get(name).ok_or_else(|| unset(name))?;
    ints([x.clamp(i32::MIN.into(), i32::MAX.into()) as i32])
}

pub(super) fn set_int(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (name, of_run) = (call.name()?, sim.is_running());
    after(sim.registry.integers.set(name, call.int(0)?.into(), of_run))
}

pub(super) fn clear_int(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    sim.registry.integers.clear(call.name()?);
    done()
}

pub(super) fn text(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let name = call.name()?;
    sim.registry.strings.get(name).cloned().ok_or_else(|| unset(name))
}

pub(super) fn set_text(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (name, of_run) = (call.name()?, sim.is_running());
    sim.registry.check_stored_size(call.data.len())?;
    after(sim.registry.strings.set(name, call.data.to_vec(), of_run))
}

pub(super) fn append_text(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (name, of_run) = (call.name()?, sim.is_running());
    sim.registry.check_stored_size(call.data.len())?;
    after(sim.registry.strings.append(name, call.data, of_run))
}

pub(super) fn clear_text(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    sim.registry.strings.clear(call.name()?);
    done()
}

/// The bytes of a signal, which is cleared.
pub(super) fn take_text(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let bytes = text(sim, call)?;
    sim.registry.strings.clear(call.name()?);
    Ok(bytes)
}

/// As [`take_text`]; nothing if there is no such signal.
pub(super) fn read_stream(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let name = call.name()?;
    let bytes = sim.registry.strings.get(name).cloned().unwrap_or_default();
    if !bytes.is_empty() {
        sim.registry.strings.clear(name);
    }
    Ok(bytes)
}
