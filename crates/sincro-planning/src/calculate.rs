//! The functions of V-REP 3 on collision and distance objects.

use sincro_values::{ApiError, Arguments, Value};

use crate::calculations::Kind;
use crate::call::Scene;

/// Handle that stands for all of them, and for those that are not handled one by one.
const ALL: [i64; 2] = [-2, -3];

/// Gives the names of the functions of [`calculate`] and their call tips to a macro, as literals.
#[macro_export]
macro_rules! for_calculations {
    ($table:ident) => {
        $table! {
            "createCollisionObject" "int collisionObjectHandle=sim.createCollisionObject(string name,int entity1Handle,int entity2Handle=-2)"
            "createDistanceObject" "int distanceObjectHandle=sim.createDistanceObject(string name,int entity1Handle,int entity2Handle=-2)"
            "getCollisionHandle" "int collisionObjectHandle=sim.getCollisionHandle(string collisionObjectName)"
            "getDistanceHandle" "int distanceObjectHandle=sim.getDistanceHandle(string distanceObjectName)"
            "handleCollision" "int collisionState,int[2] collidingObjects=sim.handleCollision(int collisionObjectHandle)"
            "readCollision" "int collisionState,int[2] collidingObjects=sim.readCollision(int collisionObjectHandle)"
            "resetCollision" "int result=sim.resetCollision(int collisionObjectHandle)"
            "handleDistance" "int result,float smallestDistance=sim.handleDistance(int distanceObjectHandle)"
            "readDistance" "int result,float smallestDistance=sim.readDistance(int distanceObjectHandle)"
            "resetDistance" "int result=sim.resetDistance(int distanceObjectHandle)"
        }
    };
}

/// Calls a function on collision and distance objects by its name.
///
/// # Errors
///
/// The arguments are not those of the function, there is no such object, or one of its pair is gone.
///
/// # Panics
///
/// There is no function of that name.
pub fn calculate<S: Scene>(scene: &mut S, name: &str, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let kind = if name.contains("Collision") { Kind::Collision } else { Kind::Distance };
    match name {
        "createCollisionObject" | "createDistanceObject" => make(scene, kind, a),
        "getCollisionHandle" | "getDistanceHandle" => {
            let name = a.text(0)?;
            let name = name.strip_suffix('#').unwrap_or(name);
            let found = scene.calculations().named(kind, name);
            let found = found.ok_or_else(|| {
                let (word, maker, name) = (kind.word(), kind.maker(), name.chars().take(100).collect::<String>());
                let help = "a script of the scene makes them, as a customization script before there is a run";
                ApiError(format!("there is no {word} object `{name}`: {help}, with {maker}(name, entity1, entity2)"))
            })?;
            Ok(vec![found.into()])
        }
        "resetCollision" | "resetDistance" => {
            let handle = a.int(0)?;
            if !ALL.contains(&handle) {
                scene.calculations().pair(kind, handle)?;
            }
            Ok(vec![1_i64.into()])
        }
        "handleCollision" | "handleDistance" if ALL.contains(&a.int(0)?) => {
            let mut n = 0;
            for pair in scene.calculations().pairs(kind) {
                n += match kind {
                    Kind::Collision => i64::from(scene.touching(pair)?.is_some()),
                    Kind::Distance => 1,
                };
            }
            Ok(vec![n.into()])
        }
        "handleCollision" | "readCollision" => {
            let pair = scene.calculations().pair(kind, a.int(0)?)?;
            Ok(match scene.touching(pair)? {
                Some(objects) => vec![1_i64.into(), Value::handles(objects)],
                None => vec![0_i64.into(), Value::List(Vec::new())],
            })
        }
        "handleDistance" | "readDistance" => {
            let pair = scene.calculations().pair(kind, a.int(0)?)?;
            Ok(match scene.distance_between(pair)? {
                Some(distance) => vec![1_i64.into(), distance.into()],
                None => vec![0_i64.into()],
            })
        }
        _ => unreachable!("`{name}` is no function on collision and distance objects"),
    }
}

fn make<S: Scene>(scene: &mut S, kind: Kind, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let first = a.handle(1)?;
    if i64::from(first) == ALL[0] {
        return Err(ApiError::new("the first of a pair is an object or collection, not sim.handle_all"));
    }
    let second = if a.has(2) { a.handle(2)? } else { -2 };
    let pair = [scene.collider(first)?, scene.collider(second)?];
    // an entity without shape is refused now, not when it is read
    match kind {
        Kind::Collision => drop(scene.touching(pair)?),
        Kind::Distance => drop(scene.distance_between(pair)?),
    }
    Ok(vec![scene.calculations().make(kind, a.text(0)?, pair)?.into()])
}
