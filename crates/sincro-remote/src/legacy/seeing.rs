//! Commands of the legacy API: vision sensors.

use sincro_coppelia::session::{ApiError, SimApi};
use sincro_scene::camera::{Layer, Part};

use super::functions::{Call, Reply, done, ints, reals};

/// The answer of a command of this file; none for any other.
pub(super) fn run(sim: &mut SimApi<'_>, call: &Call<'_>) -> Option<Reply> {
    Some(match call.function {
        0x1003 => picture(sim, call, Layer::GREY),
        0x1004 => picture(sim, call, Layer::RGB),
        0x1005 => write(sim, call, Layer::GREY),
        0x1006 => write(sim, call, Layer::RGB),
        0x1011 => read(sim, call),
        0x1017 => depths(sim, call),
        _ => return None,
    })
}

/// Columns and rows, four bytes each, as large replies begin.
fn head([columns, rows]: [usize; 2]) -> Reply {
    ints([columns as i32, rows as i32])
}

/// Columns, rows, and the bytes of all pixels.
fn picture(sim: &mut SimApi<'_>, call: &Call<'_>, layer: Layer) -> Reply {
    let image = sim.vision_image(call.handle()?)?;
    let mut data = head(image.resolution())?;
    data.extend(image.bytes(image.whole(), layer));
    Ok(data)
}

fn write(sim: &mut SimApi<'_>, call: &Call<'_>, layer: Layer) -> Reply {
    let sensor = call.handle()?;
    let whole = Part { position: [0; 2], size: sim.registry.vision_sensor(sensor)?.optics.resolution };
    sim.write_vision(sensor, whole, layer, call.data)?;
    done()
}

/// Columns, rows, and the depths of all pixels from 0 to 1.
fn depths(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let image = sim.vision_image(call.handle()?)?;
    let mut data = head(image.resolution())?;
    data.extend(reals(image.depths(image.whole(), false))?);
    Ok(data)
}

/// State (1: triggered, which nothing does here), number of packets, their lengths, their numbers.
fn read(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let packet = sim.read_vision(call.handle()?)?;
    let packet = packet.ok_or_else(|| ApiError::new("the vision sensor has not been handled since the run began"))?;
    let mut data = vec![0];
    data.extend(ints([1, packet.len() as i32])?);
    data.extend(reals(packet)?);
    Ok(data)
}
