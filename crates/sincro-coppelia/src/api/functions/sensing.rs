//! Functions: proximity sensors.

use sincro_dynamics::geometry::{FieldOfView, Volume};

use super::distances::entity;
use super::{Function, Outcome, done, handle, one};
use crate::api::{ApiError, Arguments, Entity, Handle, SimApi, Value};
use sincro_sim::proximity::Detection;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "readProximitySensor",
        tip: "int result,float distance,float[3] detectedPoint,int detectedObjectHandle,float[3] normalVector=sim.readProximitySensor(int sensorHandle)",
        run: |d, a| Ok(d.proximity(handle(d, a, 0)?)?.map_or_else(|| nothing(-1), seen)),
    },
    Function {
        name: "handleProximitySensor",
        tip: "int result,float distance,float[3] detectedPoint,int detectedObjectHandle,float[3] normalVector=sim.handleProximitySensor(int sensorHandle)",
        run: look,
    },
    Function { name: "resetProximitySensor", tip: "sim.resetProximitySensor(int objectHandle)", run: reset },
    Function {
        name: "checkProximitySensor",
        tip: "int result,float distance,float[3] detectedPoint,int detectedObjectHandle,float[3] normalVector=sim.checkProximitySensor(int sensorHandle,int entityHandle)",
        run: |d, a| check(d, a, f64::INFINITY),
    },
    Function {
        name: "checkProximitySensorEx",
        tip: "int result,float distance,float[3] detectedPoint,int detectedObjectHandle,float[3] normalVector=sim.checkProximitySensorEx(int sensorHandle,int entityHandle,int mode,float threshold,float maxAngle)",
        run: check_more,
    },
    Function {
        name: "createProximitySensor",
        tip: "int sensorHandle=sim.createProximitySensor(int sensorType,int subType,int options,int[8] intParams,float[15] floatParams)",
        run: create,
    },
];

/// Result, distance, point in the sensor's axes, object, normal.
fn seen(saw: Option<Detection>) -> Vec<Value> {
    let Some(saw) = saw else { return nothing(0) };
    vec![
        Value::Int(1),
        Value::Real(saw.distance),
        Value::reals(saw.point.0),
        Value::from(seen_object(&saw)),
        Value::reals(saw.normal.0),
    ]
}

/// A result without a detection: clients in C++ and Java take the other values all the same.
fn nothing(result: i64) -> Vec<Value> {
    let zeros = || Value::reals([0.0; 3]);
    vec![Value::Int(result), Value::Real(0.0), zeros(), Value::Int(-1), zeros()]
}

/// The object that was seen.
pub(crate) fn seen_object(saw: &Detection) -> Handle {
    Handle(saw.object as i32 + 1)
}

/// One sensor, all, or all but those with explicit handling.
fn look(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    Ok(seen(match a.handle(0)? {
        -2 => sim.handle_proximities(true)?,
        -3 => sim.handle_proximities(false)?,
        _ => {
            let own = handle(sim, a, 0)?;
            sim.handle_proximity(own)?
        }
    }))
}

fn reset(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    match a.handle(0)? {
        all @ (-2 | -3) => sim.reset_proximities(all == -2),
        _ => {
            let own = handle(sim, a, 0)?;
            sim.reset_proximity(own)?;
        }
    }
    done()
}

fn check(sim: &mut SimApi<'_>, a: Arguments<'_>, most: f64) -> Outcome {
    let own = handle(sim, a, 0)?;
    let entity = if a.has(1) { entity(sim, a, 1)? } else { Entity::All };
    Ok(seen(sim.look_at(own, entity, most)?))
}

/// Mode: 1 front faces, 2 back faces, 4 fast, 8 limited angle.
fn check_more(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (mode, threshold) = (a.int(2)?, if a.has(3) { a.real(3)? } else { 0.0 });
    if mode & 8 != 0 {
        return Err(ApiError::new(
            "sensors see surfaces at any angle here: leave bit 3 of the mode out, and look at the normal",
        ));
    }
    if mode & 3 == 2 {
        return Err(ApiError::new("sensors see surfaces from outside here: set bit 0 of the mode"));
    }
    if threshold.is_nan() {
        return Err(ApiError::new("the threshold is not a number"));
    }
    check(sim, a, if threshold > 0.0 { threshold } else { f64::INFINITY })
}

/// As V-REP has it: options 1 explicit, 64 limited angle, 256 smallest distance, 512 randomized; offset, range, x and y
/// size, far x and y size, inside gap, radius, far radius, angle, the limit of the angle, the smallest distance.
fn create(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (kind, options) = (a.int(0)?, a.int(2)?);
    let Some(numbers) = a.get(4).as_reals().filter(|n| n.len() >= 10) else {
        return Err(ApiError::new("argument 5 is no list of 15 numbers"));
    };
    let n = |k: usize| numbers[k];
    let volume = match kind {
        30 => Volume::Pyramid { size: [n(2), n(3)], far_size: [n(4), n(5)] },
        31 => Volume::Cylinder { radius: n(7), far_radius: n(8) },
        32 => Volume::Disc { angle: n(9) },
        33 => Volume::Cone { angle: n(9) },
        34 => Volume::Ray,
        _ => {
            let known = "pyramid 30, cylinder 31, disc 32, cone 33, ray 34";
            return Err(ApiError(format!("{kind} is no proximity sensor: {known}")));
        }
    };
    let field = FieldOfView::new(volume, n(0), n(1)).ok_or_else(|| {
        let expected = "expected an offset that is not negative, a positive range, widths, and angles of at most π";
        ApiError(format!("a sensor {volume:?} with offset {} and range {}: {expected}", n(0), n(1)))
    })?;
    if options & (64 | 512) != 0 || n(6) != 0.0 {
        return Err(ApiError::new(
            "sensors see surfaces at any angle, in all of their volume, here: no options 64 and 512, no inside gap",
        ));
    }
    let blind_below = if options & 256 != 0 { numbers.get(11).copied().unwrap_or(0.0) } else { 0.0 };
    if blind_below.is_nan() {
        return Err(ApiError::new("the smallest distance is not a number"));
    }
    one(sim.create_proximity_sensor(field, options & 1 != 0, blind_below)?)
}
