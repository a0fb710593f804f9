//! Commands of the legacy API: parameters of the simulator.

use sincro_coppelia::api::SimApi;

use super::functions::{Call, Reply, after, ints, reals};

pub(super) fn int(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    ints([i32::try_from(sim.int_parameter(call.parameter()?)?).unwrap_or(i32::MAX)])
}

/// Takes a number that belongs to windows, without effect.
pub(super) fn set_int(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let id = call.parameter()?;
    call.int(0)?;
    after(sim.set_int_parameter(id))
}

pub(super) fn float(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals([sim.float_parameter(call.parameter()?)?])
}

/// A float of a client means the nearest number that the base step has a multiple of.
pub(super) fn set_float(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_float_parameter(call.parameter()?, call.float(0)?))
}

pub(super) fn bool(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    ints([i32::from(sim.bool_parameter(call.parameter()?)?)])
}

/// Takes a switch of display or real time, without effect.
pub(super) fn set_bool(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_bool_parameter(call.parameter()?, call.int(0)? != 0))
}

pub(super) fn array(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    reals(sim.array_parameter(call.parameter()?)?)
}

pub(super) fn set_array(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    after(sim.set_array_parameter(call.parameter()?, call.floats(0)?))
}

pub(super) fn text(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let mut text = sim.string_parameter(call.parameter()?)?.into_bytes();
    text.push(0);
    Ok(text)
}
