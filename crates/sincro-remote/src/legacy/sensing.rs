//! Commands of the legacy API: sensors, collisions, distances; and the reasons for those that are not offered.

use sincro_coppelia::session::{ApiError, Entity, Handle, SimApi};

use super::functions::{Call, Reply, counted, ints, reals};

/// Commands that are refused, and why. A client sees return code 8, and the text by `simxGetLastErrors`.
const REFUSED: &[(&[u16], &str)] = &[
    (&[0x100b], "a ball joint is moved by forces and by its initial state, not put somewhere"),
    (&[0x1010], "force sensors do not break here"),
    (&[0x1014, 0x1015, 0x1016, 0x3009], "there are no consoles here: use simxAddStatusbarMessage"),
    (&[0x1026, 0x300a], "there are no collision objects here: use simxCheckCollision with two bodies or collections"),
    (&[0x1027, 0x300b], "there are no distance objects here: use simxCheckDistance with two bodies or collections"),
    (&[0x102b, 0x102c, 0x102d, 0x300c], "there is nobody to answer a dialog here"),
    (&[0x1029, 0x2001, 0x2002, 0x2003, 0x2004, 0x2005, 0x2006, 0x3005, 0x3007], "there are no user interfaces here"),
    (&[0x1035], "objects have no model properties here"),
];

/// The answer of a command of this file; none for any other.
pub(super) fn run(sim: &mut SimApi<'_>, call: &Call<'_>) -> Option<Reply> {
    match call.function {
        0x100f => Some(force_sensor(sim, call)),
        0x200f => Some(collision(sim, call)),
        0x2010 => Some(distance(sim, call)),
        0x1009 => Some(proximity(sim, call)),
        0x102e => Some(copies(sim, call)),
        function => {
            let (_, why) = REFUSED.iter().find(|(functions, _)| functions.contains(&function))?;
            Some(Err(ApiError::new(*why)))
        }
    }
}

/// State (bit 0: there are data), force, torque; the numbers are not aligned.
fn force_sensor(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let (force, torque) = sim.force_sensor(call.handle()?)?;
    let mut data = vec![1];
    data.extend(reals(force.into_iter().chain(torque))?);
    Ok(data)
}

/// The two bodies or collections of a call; −2 is everything.
fn entities(sim: &SimApi<'_>, call: &Call<'_>) -> Result<[Entity; 2], ApiError> {
    Ok([sim.entity(Handle(call.ident_int(0)?))?, sim.entity(Handle(call.ident_int(1)?))?])
}

/// Returns true if two bodies press on each other, or their surfaces meet.
fn collision(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let [one, two] = entities(sim, call)?;
    ints([i32::from(sim.collision(one, two)?.is_some())])
}

fn distance(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let [one, two] = entities(sim, call)?;
    let found = sim.distance(one, two, f64::INFINITY)?;
    reals([found.ok_or_else(|| ApiError::new("there is nothing that a distance could be measured to"))?.distance])
}

/// State, point in the sensor's axes, object, normal; the numbers are not aligned.
fn proximity(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
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
            (1, Handle::from(&saw).0, [x, y, z, u, v, w])
        }
        None => (0, -1, [0.0; 6]),
    })
}

/// Copies of runtime objects.
fn copies(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let handles = (0..call.data.len() / 4).map(|k| call.int(4 * k).map(Handle)).collect::<Result<Vec<_>, _>>()?;
    let copies = handles.into_iter().map(|handle| sim.copy(handle)).collect::<Result<Vec<_>, _>>()?;
    counted(&copies)
}
