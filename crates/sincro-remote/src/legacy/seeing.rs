//! Commands of the legacy API: vision sensors.

use sincro_coppelia::api::{ApiError, SimApi};
use sincro_scene::camera::{Layer, Part};

use super::functions::{Call, Reply, done, ints, reals};

pub(super) fn grey_image(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    image(sim, call, Layer::GREY)
}

pub(super) fn rgb_image(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    image(sim, call, Layer::RGB)
}

pub(super) fn set_grey_image(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    write(sim, call, Layer::GREY)
}

pub(super) fn set_rgb_image(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    write(sim, call, Layer::RGB)
}

/// Columns and rows, four bytes each, as large replies begin.
fn head([columns, rows]: [usize; 2]) -> Reply {
    ints([columns as i32, rows as i32])
}

/// Columns, rows, and the bytes of all pixels.
fn image(sim: &mut SimApi<'_>, call: &Call<'_>, layer: Layer) -> Reply {
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
pub(super) fn depths(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let image = sim.vision_image(call.handle()?)?;
    let mut data = head(image.resolution())?;
    data.extend(reals(image.depths(image.whole(), false))?);
    Ok(data)
}

/// State (1: triggered by the sensor's script), number of packets, their lengths, their numbers.
pub(super) fn read(sim: &mut SimApi<'_>, call: &Call<'_>) -> Reply {
    let reading = sim.read_vision(call.handle()?)?;
    let reading = reading.ok_or_else(|| ApiError::new("the vision sensor has not been handled since the run began"))?;
    let lengths = reading.packets.iter().map(|packet| packet.len() as i32);
    let mut data = vec![u8::from(reading.is_triggered)];
    data.extend(ints(std::iter::once(reading.packets.len() as i32).chain(lengths))?);
    data.extend(reals(reading.packets.into_iter().flatten())?);
    Ok(data)
}
