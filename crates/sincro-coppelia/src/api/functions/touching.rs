//! Functions: contacts, force sensors.

use super::{Function, Outcome, handle, one};
use crate::api::constants::HANDLE_FLAGS;
use crate::api::{ApiError, Arguments, ContactPoint, SimApi, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "getContactInfo",
        tip: "int[2] collidingObjects,float[3] collisionPoint,float[3] reactionForce,float[3] normalVector=sim.getContactInfo(int dynamicPass,int objectHandle,int index)",
        run: contact,
    },
    Function {
        name: "createForceSensor",
        tip: "int sensorHandle=sim.createForceSensor(int options,int[5] intParams={},float[5] floatParams={})",
        run: create_force_sensor,
    },
    Function {
        name: "readForceSensor",
        tip: "int result,float[3] forceVector,float[3] torqueVector=sim.readForceSensor(int objectHandle)",
        run: force_sensor,
    },
    Function {
        name: "breakForceSensor",
        tip: "int result=sim.breakForceSensor(int objectHandle)",
        run: |sim, a| {
            let own = handle(sim, a, 0)?;
            sim.break_force_sensor(own)?;
            one(1_i64)
        },
    },
];

fn create_force_sensor(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    if a.int_or(0, 0)? & 1 != 0 {
        return Err(ApiError::new(
            "a force sensor has no threshold at which it breaks: compare what sim.readForceSensor gives, then sim.breakForceSensor",
        ));
    }
    one(sim.create_force_sensor()?)
}

/// All entities.
const ALL: i32 = -2;

/// Returns true if a contact is one of an object; `ALL` stands for any.
fn is_of(contact: &ContactPoint, object: i32) -> bool {
    object == ALL || contact.bodies.iter().any(|body| body.0 == object)
}

/// The object of argument `k`, which can touch something, or `ALL`.
fn entity(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<i32, ApiError> {
    if a.handle(k)? == ALL {
        return Ok(ALL);
    }
    let object = handle(sim, a, k)?;
    sim.can_touch(object)?;
    Ok(object.0)
}

/// The contact of a number among those of an object; nothing behind the last one. The pass does not matter: contacts
/// are those of now.
fn contact(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    a.int(0)?;
    let object = entity(sim, a, 1)?;
    // a flag asks for the normal, which is always given here
    let index = a.int(2)? & i64::from(HANDLE_FLAGS - 1);
    let contact_points = sim.contact_points();
    let nth = contact_points.iter().filter(|contact| is_of(contact, object)).nth(index as usize);
    Ok(nth.map_or_else(
        || vec![Value::Nil; 4],
        |contact| {
            let vectors = [contact.point, contact.force, contact.normal].map(|v| Value::reals(v.0));
            [Value::handles(contact.bodies)].into_iter().chain(vectors).collect()
        },
    ))
}

/// Bit 0 says that there is a value: from the first step on; bit 1 that the sensor is broken.
fn force_sensor(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let (force, torque) = sim.force_sensor(own)?;
    Ok(vec![Value::Int(sim.force_sensor_state(own)), Value::reals(force), Value::reals(torque)])
}
