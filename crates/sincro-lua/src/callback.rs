//! `sysCall_joint`: a script on a joint says at each step how fast its motor is to be, and with what force.

use mlua::{Error, Function, Lua, MultiValue, Table, Value};
use sincro_coppelia::api::{ApiError, SimApi};
use sincro_dynamics::joint::JointKind;

use crate::guard::Guard;
use crate::shared::Shared;

/// `sim.jointfloatparam_upper_limit`: the limit of a motor's velocity, infinite if it has none.
const MAX_VELOCITY: i64 = 2017;

/// Arguments of the callback of a joint.
struct Seen {
    handle: i32,
    is_revolute: bool,
    is_cyclic: bool,
    interval: [f64; 2],
    position: f64,
    velocity: f64,
    target_position: f64,
    target_velocity: f64,
    max_force: f64,
    max_velocity: f64,
    effort: f64,
}

fn look(sim: &mut SimApi<'_>) -> Result<Seen, ApiError> {
    let own = sim.own.ok_or_else(|| ApiError::new("no script calls"))?;
    let joint = sim.registry.joint(own)?.clone();
    if joint.motor.is_none() {
        return Err(ApiError::new("sysCall_joint needs a joint with a motor: give it one in the scene"));
    }
    let (is_cyclic, interval) = sim.joint_interval(own)?;
    Ok(Seen {
        handle: own.0,
        is_revolute: matches!(joint.kind, JointKind::Revolute { .. }),
        is_cyclic,
        interval,
        position: sim.joint_position(own)?,
        velocity: sim.joint_velocity(own)?,
        target_position: sim.target_position(own)?,
        target_velocity: sim.target_velocity(own)?,
        max_force: sim.target_force(own)?,
        max_velocity: sim.object_float(own, MAX_VELOCITY)?,
        effort: sim.joint_force(own)?.unwrap_or(0.0),
    })
}

/// Calls the function and commands the joint with its results.
pub(crate) fn joint(
    lua: &Lua,
    shared: &Shared,
    index: usize,
    function: &Function,
    (step, is_first): (f64, bool),
) -> mlua::Result<()> {
    let own = shared.object(index);
    let told = |ApiError(message): ApiError| Error::RuntimeError(format!("{message} (in function 'sysCall_joint')"));
    let seen = shared.with_sim(own, look).map_err(told)?;
    let answer: MultiValue = function.call(table_of(lua, &seen, step, is_first)?)?;
    let (velocity, force) = answer_of(&answer)?;
    shared
        .with_sim(own, |sim| {
            velocity.map_or(Ok(()), |velocity| sim.set_target_velocity(own, velocity))?;
            force.map_or(Ok(()), |force| sim.set_target_force(own, force, true))
        })
        .map_err(|error| noted(lua, [velocity, force], told(error)))
}

/// Notes an error by which numbers were refused, if one of them is not finite.
pub(crate) fn noted(lua: &Lua, numbers: [Option<f64>; 2], error: Error) -> Error {
    if let (Some(guard), true) = (Guard::of(lua), numbers.iter().flatten().any(|x| !x.is_finite())) {
        guard.note_not_finite(&error);
    }
    error
}

fn table_of(lua: &Lua, seen: &Seen, step: f64, is_first: bool) -> mlua::Result<Table> {
    let table = lua.create_table()?;
    table.set("first", is_first)?;
    table.set("handle", seen.handle)?;
    table.set("revolute", seen.is_revolute)?;
    table.set("cyclic", seen.is_cyclic)?;
    let [low, range] = seen.interval;
    for (name, value) in [
        ("lowLimit", low),
        ("highLimit", low + range),
        ("currentPos", seen.position),
        ("targetPos", seen.target_position),
        ("errorValue", seen.target_position - seen.position),
        ("currentVel", seen.velocity),
        ("targetVel", seen.target_velocity),
        ("maxForce", seen.max_force),
        ("velUpperLimit", seen.max_velocity),
        ("effort", seen.effort),
        ("dynStepSize", step),
    ] {
        table.set(name, value)?;
    }
    table.set("passCnt", 1)?;
    table.set("totalPasses", 1)?;
    Ok(table)
}

/// Velocity and force: fields of a table, or force and velocity one after the other.
fn answer_of(answer: &MultiValue) -> mlua::Result<(Option<f64>, Option<f64>)> {
    match answer.iter().next() {
        None | Some(Value::Nil) => Ok((None, None)),
        Some(Value::Table(table)) => {
            let velocity = table.get::<Option<f64>>("velocity")?;
            let velocity = velocity.map_or_else(|| table.get::<Option<f64>>("vel"), |v| Ok(Some(v)))?;
            Ok((velocity, table.get("force")?))
        }
        Some(first) => Ok((answer.get(1).map(number).transpose()?, Some(number(first)?))),
    }
}

fn number(value: &Value) -> mlua::Result<f64> {
    let number = value.as_number().or_else(|| value.as_integer().map(|n| n as f64));
    number.ok_or_else(|| {
        Error::RuntimeError(format!("sysCall_joint gave a {}, expected force and velocity", value.type_name()))
    })
}
