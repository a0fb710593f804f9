//! `sysCall_contact`: a script says of two bodies that may come to touch whether they collide in the coming step, and
//! with what friction.

use mlua::{Error, Function, Lua, Table, Value};
use sincro_coppelia::api::{ContactOverride, Handle};

use crate::callback::noted;
use crate::shared::Shared;

/// Physics engine that scripts are given: the number that `sim.getInt32Param(8)` gives.
const ENGINE: i64 = 4;

/// Calls the function and does what it says; whether it said anything: it may leave the pair to others
/// (`ignoreContact`, or nothing given).
pub(crate) fn ask(
    lua: &Lua,
    shared: &Shared,
    index: usize,
    function: &Function,
    bodies: [Handle; 2],
) -> mlua::Result<bool> {
    let told = lua.create_table()?;
    told.set("handle1", bodies[0].0)?;
    told.set("handle2", bodies[1].0)?;
    told.set("engine", ENGINE)?;
    let Value::Table(given) = function.call::<Value>(told)? else { return Ok(false) };
    if is_set(&given, "ignoreContact")? == Some(true) {
        return Ok(false);
    }
    let passes = is_set(&given, "collisionResponse")? == Some(false);
    let (friction, restitution) = coefficients(&given)?;
    let answer = ContactOverride { passes, friction, restitution };
    let own = shared.object(index);
    shared
        .with_sim(own, |sim| sim.override_contact(bodies, answer))
        .map_err(|error| noted(lua, [friction, restitution], wrong(error.0)))?;
    Ok(true)
}

fn is_set(table: &Table, name: &str) -> mlua::Result<Option<bool>> {
    match table.get(name)? {
        Value::Nil => Ok(None),
        Value::Boolean(truth) => Ok(Some(truth)),
        other => Err(wrong(format!("{name} is a {}, expected true or false", other.type_name()))),
    }
}

/// Friction and restitution, as the tables of the engines have them; the first table that is there counts.
fn coefficients(given: &Table) -> mlua::Result<(Option<f64>, Option<f64>)> {
    let table = |name: &str| given.get::<Option<Table>>(name);
    if let Some(bullet) = table("bullet")? {
        return Ok((bullet.get("friction")?, bullet.get("restitution")?));
    }
    if let Some(newton) = table("newton")? {
        let (holding, sliding): (Option<f64>, Option<f64>) =
            (newton.get("staticFriction")?, newton.get("kineticFriction")?);
        if holding.is_some() && sliding.is_some() && holding != sliding {
            return Err(wrong(
                "staticFriction and kineticFriction differ: a contact has one coefficient here".to_owned(),
            ));
        }
        return Ok((holding.or(sliding), newton.get("restitution")?));
    }
    match table("ode")? {
        Some(ode) => Ok((ode.get("mu")?, ode.get("bounce")?)),
        None => Ok((None, None)),
    }
}

fn wrong(message: String) -> Error {
    Error::RuntimeError(format!("{message} (in function 'sysCall_contact')"))
}
