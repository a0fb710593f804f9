//! Commands of the legacy API: sensors, collisions, distances.

use sincro_coppelia::api::{ApiError, Entity, Handle, SimApi, Value, functions};

use super::functions::{Call, Reply, done, ints, reals};

/// State (bit 0: there are data; bit 1: it is broken), force, torque; the numbers are not aligned.
pub(super) fn force_sensor(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let sensor = call.handle()?;
    let (force, torque) = sim.force_sensor(sensor)?;
    let mut data = vec![sim.force_sensor_state(sensor) as u8];
    data.extend(reals(force.into_iter().chain(torque))?);
    Ok(data)
}

/// Parts what a force sensor carries from it.
pub(super) fn break_force_sensor(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    functions::call(sim, "breakForceSensor", &[call.handle()?.into()])?;
    done()
}

/// The two bodies or collections of a call; −2 is everything.
fn entities(sim: &SimApi<'_>, call: &Call<'_>) -> Result<[Entity; 2], ApiError> {
    Ok([sim.entity(Handle(call.ident_int(0)?))?, sim.entity(Handle(call.ident_int(1)?))?])
}

/// Returns true if two bodies press on each other, or their surfaces meet.
pub(super) fn collision(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let [one, two] = entities(sim, call)?;
    ints([i32::from(sim.collision(one, two)?.is_some())])
}

pub(super) fn distance(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let [one, two] = entities(sim, call)?;
    let found = sim.distance(one, two, f64::INFINITY)?;
    reals([found.ok_or_else(|| ApiError::new("there is nothing that a distance could be measured to"))?.distance])
}

/// State, point in the sensor's axes, object, normal; the numbers are not aligned.
pub(super) fn proximity(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (state, object, numbers) = seen(sim, call.handle()?)?;
    let mut data = vec![state as u8];
    data.extend(reals(numbers[..3].iter().copied())?);
    data.extend(ints([object])?);
    data.extend(reals(numbers[3..].iter().copied())?);
    Ok(data)
}

/// Reading of a proximity sensor: state, object, point and normal; zeros and −1 if nothing.
pub(super) fn seen(sim: &SimApi<'_>, sensor: Handle) -> Result<(i32, i32, [f64; 6]), ApiError> {
    Ok(match sim.proximity(sensor)?.flatten() {
        Some(saw) => {
            let ([x, y, z], [u, v, w]) = (saw.point.0, saw.normal.0);
            (1, saw.object as i32 + 1, [x, y, z, u, v, w])
        }
        None => (0, -1, [0.0; 6]),
    })
}

/// Handle of a collision object by its name.
pub(super) fn collision_handle(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    by_name(sim, "getCollisionHandle", call)
}

/// Handle of a distance object by its name.
pub(super) fn distance_handle(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    by_name(sim, "getDistanceHandle", call)
}

fn by_name(sim: &mut SimApi<'_>, function: &str, call: &Call<'_>) -> Reply {
    ints(functions::call(sim, function, &[call.name()?.into()])?.first().and_then(Value::as_int).map(|n| n as i32))
}

/// True if the two of a collision object meet.
pub(super) fn read_collision(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let read = functions::call(sim, "readCollision", &[call.parameter()?.into()])?;
    ints(read.first().and_then(Value::as_int).map(|n| n as i32))
}

/// Smallest distance of the two of a distance object.
pub(super) fn read_distance(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let read = functions::call(sim, "readDistance", &[call.parameter()?.into()])?;
    let distance = read.get(1).and_then(Value::as_real);
    reals([distance.ok_or_else(|| ApiError::new("there is nothing that a distance could be measured to"))?])
}
