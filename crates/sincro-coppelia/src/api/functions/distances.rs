//! Functions: distances and collisions.

use super::{Function, Outcome, plain};
use crate::api::{ApiError, Arguments, Entity, Handle, SimApi, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "checkDistance",
        tip: "int result,float[7] distanceData,int[2] objectHandlePair=sim.checkDistance(int entity1Handle,int entity2Handle,float threshold=0)",
        run: distance,
    },
    Function {
        name: "checkCollision",
        tip: "int result,int[2] collidingObjectHandles=sim.checkCollision(int entity1Handle,int entity2Handle)",
        run: collision,
    },
];

/// The object, collection or −2 for all of argument `k`.
pub(super) fn entity(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Entity, ApiError> {
    let raw = a.handle(k)?;
    if raw == -2 || sim.registry.is_collection(Handle(raw)) {
        return sim.entity(Handle(raw));
    }
    Ok(Entity::Object(plain(sim, raw)?))
}

/// Both points and the distance; only 0 if nothing is within the threshold, which holds where it is above zero.
fn distance(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let first = entity(sim, a, 0)?;
    let second = if a.has(1) { entity(sim, a, 1)? } else { Entity::All };
    let threshold = if a.has(2) { a.real(2)? } else { 0.0 };
    if threshold.is_nan() {
        return Err(ApiError::new("the threshold is not a number"));
    }
    let most = if threshold > 0.0 { threshold } else { f64::INFINITY };
    let Some(found) = sim.distance(first, second, most)? else { return Ok(vec![Value::Int(0)]) };
    let [p, q] = found.points.map(|p| p.0);
    let data = p.into_iter().chain(q).chain([found.distance]);
    Ok(vec![Value::Int(1), Value::reals(data), Value::handles(found.objects)])
}

/// Returns true if two bodies press on each other now, or their surfaces meet.
fn collision(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let first = entity(sim, a, 0)?;
    let second = if a.has(1) { entity(sim, a, 1)? } else { Entity::All };
    Ok(match sim.collision(first, second)? {
        Some(bodies) => vec![Value::Int(1), Value::handles(bodies)],
        None => vec![Value::Int(0), Value::handles([Handle(-1); 2])],
    })
}
