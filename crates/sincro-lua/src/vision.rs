//! `sysCall_vision` and `sysCall_trigger`: the script of a vision sensor filters its picture and adds packets of
//! numbers to its reading.

use mlua::{Error, Function, Lua, Table, Value};
use sincro_coppelia::api::{ApiError, Handle, VisionInput, check_packets};

use crate::api::function_of;
use crate::shared::Shared;

/// Calls the function for the sensor, keeps what it gives, and calls `sysCall_trigger` if it has triggered.
pub(crate) fn filter(lua: &Lua, shared: &Shared, sensor: Handle, function: &Function) -> mlua::Result<()> {
    let input = shared.with_sim(sensor, |sim| sim.begin_filters(sensor)).map_err(told)?;
    let (mut is_triggered, packets) = match function.call(table_of(lua, sensor, &input)?)? {
        Value::Table(result) => (is_true(&result)?, packets_of(&result)?),
        _ => (false, Vec::new()),
    };
    keep(shared, sensor, is_triggered, &packets)?;
    let Some(trigger) = function_of(lua, "sysCall_trigger").filter(|_| is_triggered) else { return Ok(()) };
    let seen = lua.create_table()?;
    seen.set("handle", sensor.0)?;
    seen.set("packets", packets.clone())?;
    if let Value::Table(result) = trigger.call(seen)? {
        is_triggered = result.get::<Option<bool>>("trigger")? != Some(false);
    }
    keep(shared, sensor, is_triggered, &packets)
}

/// Returns true if an object is a vision sensor.
pub(crate) fn is_sensor(shared: &Shared, object: Handle) -> bool {
    shared.with_sim(object, |sim| sim.registry.vision_sensor(object).map(drop)).is_ok()
}

/// Returns true if an object is a vision sensor that is handled at each step.
pub(crate) fn is_handled_by_step(shared: &Shared, object: Handle) -> bool {
    shared.with_sim(object, |sim| Ok(!sim.registry.vision_sensor(object)?.is_explicit)).unwrap_or(false)
}

fn told(ApiError(message): ApiError) -> Error {
    Error::RuntimeError(format!("{message} (in function 'sysCall_vision')"))
}

fn keep(shared: &Shared, sensor: Handle, is_triggered: bool, packets: &[Vec<f64>]) -> mlua::Result<()> {
    shared.with_sim(sensor, |sim| sim.set_vision_result(sensor, is_triggered, packets.to_vec())).map_err(told)
}

fn table_of(lua: &Lua, sensor: Handle, input: &VisionInput) -> mlua::Result<Table> {
    let table = lua.create_table()?;
    table.set("handle", sensor.0)?;
    table.set("resolution", input.resolution)?;
    table.set("clippingPlanes", input.clipping_planes)?;
    table.set("viewAngle", input.view_angle)?;
    table.set("orthoSize", input.view_size)?;
    table.set("perspectiveOperation", input.view_angle > 0.0)?;
    Ok(table)
}

fn is_true(result: &Table) -> mlua::Result<bool> {
    Ok(!matches!(result.get("trigger")?, Value::Nil | Value::Boolean(false)))
}

/// The packets: texts of packed floats, one after the other. They are counted before they are copied: a text may be in
/// the list many times.
fn packets_of(result: &Table) -> mlua::Result<Vec<Vec<f64>>> {
    let wrong = |what: &str| Error::RuntimeError(format!("{what} (in function 'sysCall_vision')"));
    let list = match result.get("packedPackets")? {
        Value::Nil => return Ok(Vec::new()),
        Value::Table(list) => list,
        other => return Err(wrong(&format!("packedPackets is a {}, expected a list", other.type_name()))),
    };
    let (mut packets, mut n_numbers) = (Vec::new(), 0);
    for value in list.sequence_values::<Value>() {
        let value = value?;
        let Value::String(text) = value else {
            let what = value.type_name();
            return Err(wrong(&format!("packedPackets has a {what}, expected texts (sim.packFloatTable)")));
        };
        let bytes = text.as_bytes();
        if bytes.len() % 4 != 0 {
            return Err(wrong(&format!(
                "packedPackets has {} bytes in a text, expected whole floats (sim.packFloatTable)",
                bytes.len()
            )));
        }
        n_numbers += bytes.len() / 4;
        check_packets(packets.len() + 1, n_numbers).map_err(told)?;
        let float = |four: &[u8]| f64::from(f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
        packets.push(bytes.chunks_exact(4).map(float).collect());
    }
    Ok(packets)
}
