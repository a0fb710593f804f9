//! Functions: vision sensors.

use super::ik_groups::{is_group, parts};
use super::{Function, Outcome, done, handle, one};
use crate::api::constants::HANDLE_FLAGS;
use crate::api::vision::{Sensors, with_angle};
use crate::api::{ApiError, Arguments, Handle, SimApi, Value, VisionReading};
use sincro_scene::camera::{Layer, Lens, Optics, Part};
use sincro_scene::scene::VisionSensor;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "getVisionSensorImg",
        tip: "buffer image,int[2] resolution=sim.getVisionSensorImg(int sensorHandle,int options=0,float rgbaCutOff=0.0,int[2] pos={0,0},int[2] size={0,0})",
        run: image,
    },
    Function {
        name: "setVisionSensorImg",
        tip: "sim.setVisionSensorImg(int sensorHandle,buffer image,int options=0,int[2] pos={0,0},int[2] size={0,0})",
        run: set_image,
    },
    Function {
        name: "getVisionSensorDepth",
        tip: "buffer depth,int[2] resolution=sim.getVisionSensorDepth(int sensorHandle,int options=0,int[2] pos={0,0},int[2] size={0,0})",
        run: depth,
    },
    Function {
        name: "getVisionSensorRes",
        tip: "int[2] resolution=sim.getVisionSensorRes(int sensorHandle)",
        run: |d, a| Ok(vec![pixels(resolution(d, a)?)]),
    },
    Function {
        name: "readVisionSensor",
        tip: "int result,float[15] packet1=sim.readVisionSensor(int sensorHandle)",
        run: read,
    },
    Function {
        name: "handleVisionSensor",
        tip: "int detectionCount,float[15] packet1=sim.handleVisionSensor(int sensorHandle)",
        run: handle_sensors,
    },
    Function { name: "resetVisionSensor", tip: "int result=sim.resetVisionSensor(int sensorHandle)", run: reset },
    Function {
        name: "checkVisionSensor",
        tip: "int result,float[15] packet1=sim.checkVisionSensor(int sensorHandle,int entityHandle)",
        run: check,
    },
    Function {
        name: "checkVisionSensorEx",
        tip: "buffer image=sim.checkVisionSensorEx(int sensorHandle,int entityHandle,bool returnImage)",
        run: check_ex,
    },
    Function {
        name: "createVisionSensor",
        tip: "int sensorHandle=sim.createVisionSensor(int options,int[4] intParams,float[11] floatParams)",
        run: create,
    },
    Function {
        name: "getExplicitHandling",
        tip: "int explicitHandlingFlags=sim.getExplicitHandling(int objectHandle)",
        run: explicit,
    },
    Function {
        name: "setExplicitHandling",
        tip: "sim.setExplicitHandling(int objectHandle,int explicitHandlingFlags)",
        run: set_explicit,
    },
    Function {
        name: "getVisionSensorImage",
        tip: "float[] image=sim.getVisionSensorImage(int sensorHandle,int posX=0,int posY=0,int sizeX=0,int sizeY=0,int returnType=0)",
        run: old_image,
    },
    Function {
        name: "getVisionSensorCharImage",
        tip: "buffer image,int resolutionX,int resolutionY=sim.getVisionSensorCharImage(int sensorHandle,int posX=0,int posY=0,int sizeX=0,int sizeY=0,float rgbaCutOff=0.0)",
        run: old_bytes,
    },
    Function {
        name: "getVisionSensorDepthBuffer",
        tip: "float[] depth,int resolutionX,int resolutionY=sim.getVisionSensorDepthBuffer(int sensorHandle,int posX=0,int posY=0,int sizeX=0,int sizeY=0)",
        run: old_depth,
    },
    Function {
        name: "setVisionSensorImage",
        tip: "int result=sim.setVisionSensorImage(int sensorHandle,float[] image)",
        run: set_old_image,
    },
    Function {
        name: "setVisionSensorCharImage",
        tip: "int result=sim.setVisionSensorCharImage(int sensorHandle,buffer image)",
        run: set_old_bytes,
    },
];

/// Added to a handle by older functions: grey instead of colours; bytes instead of numbers.
const GREY: i32 = 0x0040_0000;
/// Added to a handle by older functions: depths in metres.
const METRES: i32 = 0x0080_0000;

fn resolution(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<[usize; 2], ApiError> {
    Ok(sim.registry.vision_sensor(handle(sim, a, 0)?)?.optics.resolution)
}

fn pixels([columns, rows]: [usize; 2]) -> Value {
    Value::List(vec![Value::Int(columns as i64), Value::Int(rows as i64)])
}

/// A part of a picture: column, row and size; the whole if no size is given.
fn part(sim: &mut SimApi<'_>, own: Handle, position: [i64; 2], size: [i64; 2]) -> Result<Part, ApiError> {
    let whole = sim.registry.vision_sensor(own)?.optics.resolution;
    let place = |n: i64| usize::try_from(n).unwrap_or(usize::MAX);
    let size = if size == [0, 0] { whole } else { size.map(place) };
    let part = Part { position: position.map(place), size };
    sim.has_part(own, part)?;
    Ok(part)
}

/// A part as present functions have it: two lists from argument `k` on.
fn part_of_lists(sim: &mut SimApi<'_>, a: Arguments<'_>, own: Handle, k: usize) -> Result<Part, ApiError> {
    let two = |k: usize| -> Result<[i64; 2], ApiError> {
        if !a.has(k) {
            return Ok([0, 0]);
        }
        // beyond any picture, what is not whole stays out of it
        Ok(a.reals::<2>(k)?.map(|x| if x.fract() == 0.0 { x as i64 } else { -1 }))
    };
    let (position, size) = (two(k)?, two(k + 1)?);
    part(sim, own, position, size)
}

/// A part as older functions have it: four numbers from argument 1 on.
fn part_of_numbers(sim: &mut SimApi<'_>, a: Arguments<'_>, own: Handle) -> Result<Part, ApiError> {
    let [x, y, w, h] = [a.int_or(1, 0)?, a.int_or(2, 0)?, a.int_or(3, 0)?, a.int_or(4, 0)?];
    part(sim, own, [x, y], [w, h])
}

fn layer(options: i64, cut_off: f64) -> Layer {
    Layer { is_grey: options & 1 != 0, cut_off: (options & 2 != 0).then_some(cut_off) }
}

fn real_or(a: Arguments<'_>, k: usize, default: f64) -> Result<f64, ApiError> {
    if a.has(k) { a.real(k) } else { Ok(default) }
}

fn image(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let layer = layer(a.int_or(1, 0)?, real_or(a, 2, 0.0)?);
    let part = part_of_lists(sim, a, own, 3)?;
    let image = sim.vision_image(own)?;
    Ok(vec![Value::Bytes(image.bytes(part, layer)), pixels(image.resolution())])
}

fn set_image(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let bytes = a.bytes(1)?;
    let layer = layer(a.int_or(2, 0)?, 0.0);
    let part = part_of_lists(sim, a, own, 3)?;
    sim.write_vision(own, part, layer, bytes)?;
    done()
}

/// Depths as single precision, which is what clients unpack.
fn packed(depths: impl Iterator<Item = f64>) -> Vec<u8> {
    depths.flat_map(|x| (x as f32).to_le_bytes()).collect()
}

fn depth(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let in_metres = a.int_or(1, 0)? & 1 != 0;
    let part = part_of_lists(sim, a, own, 2)?;
    let image = sim.vision_image(own)?;
    Ok(vec![Value::Bytes(packed(image.depths(part, in_metres))), pixels(image.resolution())])
}

/// The trigger, which nothing but the sensor's script sets, and the packets; −1 if it has not been handled.
fn read(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    Ok(match sim.read_vision(own)? {
        Some(VisionReading { is_triggered, packets }) => {
            let packets = packets.into_iter().map(Value::reals);
            std::iter::once(Value::Int(i64::from(is_triggered))).chain(packets).collect()
        }
        None => vec![Value::Int(-1)],
    })
}

fn sensors(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Sensors, ApiError> {
    Ok(match a.handle(0)? {
        -2 => Sensors::All,
        -3 => Sensors::NotExplicit,
        _ => Sensors::One(handle(sim, a, 0)?),
    })
}

fn handle_sensors(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let which = sensors(sim, a)?;
    sim.handle_vision(which)?;
    match which {
        Sensors::One(_) => read(sim, a),
        _ => one(0_i64),
    }
}

fn reset(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let which = sensors(sim, a)?;
    sim.registry.reset_vision(which)?;
    one(1_i64)
}

/// The object that is to be seen alone; none for all.
fn entity(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Option<Handle>, ApiError> {
    if a.handle(1)? == -2 { Ok(None) } else { handle(sim, a, 1).map(Some) }
}

fn check(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, object) = (handle(sim, a, 0)?, entity(sim, a)?);
    let (is_seen, image) = sim.check_vision(own, object)?;
    Ok(vec![Value::Int(i64::from(is_seen)), Value::reals(image.statistics())])
}

/// The picture or the depths: a list of numbers from 0 to 1, bytes if the flag asks for them.
fn check_ex(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, object) = (handle(sim, a, 0)?, entity(sim, a)?);
    let wants_colors = a.bool_or(2, true)?;
    let (_, image) = sim.check_vision(own, object)?;
    let as_bytes = has_flag(a, GREY)?;
    Ok(vec![match (wants_colors, as_bytes) {
        (true, true) => Value::Bytes(image.rgb().to_vec()),
        (true, false) => Value::reals(image.rgb().iter().map(|x| f64::from(*x) / 255.0)),
        (false, true) => Value::Bytes(packed(image.depths(image.whole(), false))),
        (false, false) => Value::reals(image.depths(image.whole(), false)),
    }])
}

/// Returns true if a flag was added to the first handle.
fn has_flag(a: Arguments<'_>, flag: i32) -> Result<bool, ApiError> {
    let raw = a.handle(0)?;
    Ok(raw >= HANDLE_FLAGS && raw & flag != 0)
}

fn create(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let options = a.int(0)?;
    let [columns, rows, ..] = a.reals::<4>(1)?;
    let numbers = a.reals::<11>(2)?;
    let [near, far, view] = [numbers[0], numbers[1], numbers[2]];
    let side = |x: f64| if x.fract() == 0.0 && (0.0..1e6).contains(&x) { x as usize } else { 0 };
    let resolution = [side(columns), side(rows)];
    // what cannot be drawn is refused below; a ratio needs sides
    let flat = Optics { resolution, near, far, lens: Lens::Orthographic(1.0) };
    flat.check().map_err(|wrong| ApiError(format!("{} cannot be: expected {}", wrong.found, wrong.expected)))?;
    let optics = if options & 2 != 0 { with_angle(flat, view)? } else { flat.with_view_size(view) };
    let byte = |x: f64| (255.0 * x.clamp(0.0, 1.0) + 0.5) as u8;
    let own = options & 128 != 0;
    one(sim.registry.create_vision_sensor(VisionSensor {
        optics,
        background: if own { [6, 7, 8].map(|k| byte(numbers[k])) } else { sincro_scene::camera::BACKGROUND },
        is_explicit: options & 1 != 0,
        is_external: options & 16 != 0,
    })?)
}

fn explicit(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if is_group(a.int(0)?) {
        let (environment, group) = parts(a.int(0)?)?;
        return one(i64::from(sim.is_group_explicit(environment, group)?));
    }
    let own = handle(sim, a, 0)?;
    if let Some(sensor) = sim.registry.senses.proximity.get(&own) {
        return one(i64::from(sensor.is_explicit));
    }
    one(i64::from(sim.registry.vision_sensor(own)?.is_explicit))
}

/// Sets the explicit handling of a proximity or vision sensor, or of a group of inverse kinematics of V-REP 3.
fn set_explicit(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if is_group(a.int(0)?) {
        let (environment, group) = parts(a.int(0)?)?;
        sim.set_group_explicit(environment, group, a.int(1)? & 1 != 0)?;
        return done();
    }
    let (own, flags) = (handle(sim, a, 0)?, a.int(1)?);
    if let Some(sensor) = sim.registry.senses.proximity.get_mut(&own) {
        sensor.is_explicit = flags & 1 != 0;
        return done();
    }
    sim.registry.change_vision(own, |sensor| sensor.is_explicit = flags & 1 != 0)?;
    done()
}

/// Numbers from 0 to 1, or bytes if the return type is 1.
fn old_image(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let (part, layer) = (part_of_numbers(sim, a, own)?, layer(i64::from(has_flag(a, GREY)?), 0.0));
    let wants_bytes = a.int_or(5, 0)? != 0;
    let bytes = sim.vision_image(own)?.bytes(part, layer);
    Ok(vec![if wants_bytes {
        Value::Bytes(bytes)
    } else {
        Value::reals(bytes.into_iter().map(|x| f64::from(x) / 255.0))
    }])
}

fn old_bytes(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let part = part_of_numbers(sim, a, own)?;
    let cut_off = real_or(a, 5, 0.0)?;
    let layer = layer(i64::from(has_flag(a, GREY)?) | if cut_off > 0.0 { 2 } else { 0 }, cut_off);
    let image = sim.vision_image(own)?;
    let [columns, rows] = image.resolution().map(|n| Value::Int(n as i64));
    Ok(vec![Value::Bytes(image.bytes(part, layer)), columns, rows])
}

fn old_depth(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let part = part_of_numbers(sim, a, own)?;
    let (wants_bytes, in_metres) = (has_flag(a, GREY)?, has_flag(a, METRES)?);
    let image = sim.vision_image(own)?;
    let [columns, rows] = image.resolution().map(|n| Value::Int(n as i64));
    let depths = image.depths(part, in_metres);
    Ok(vec![if wants_bytes { Value::Bytes(packed(depths)) } else { Value::reals(depths) }, columns, rows])
}

fn set_old_image(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if a.get(1).as_bytes().is_some() {
        return set_old_bytes(sim, a);
    }
    let numbers =
        a.get(1).as_reals().ok_or_else(|| ApiError::new("argument 2 is neither a list of numbers nor bytes"))?;
    let bytes: Vec<u8> = numbers.iter().map(|x| (255.0 * x + 0.5) as u8).collect();
    write_whole(sim, a, &bytes)
}

fn set_old_bytes(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let bytes = a.bytes(1)?;
    write_whole(sim, a, bytes)
}

fn write_whole(sim: &mut SimApi<'_>, a: Arguments<'_>, bytes: &[u8]) -> Outcome {
    let own = handle(sim, a, 0)?;
    let (layer, whole) = (layer(i64::from(has_flag(a, GREY)?), 0.0), part(sim, own, [0, 0], [0, 0])?);
    sim.write_vision(own, whole, layer, bytes)?;
    one(1_i64)
}
