//! Functions: groups of inverse kinematics as V-REP 3 has them, by name. Here a script or client makes them by
//! `simIK.createGroup` with a name.

use super::{Function, Outcome, function, handle, one};
use crate::api::{ApiError, Arguments, Handle, SimApi, Value};

/// Added to environment and group: a handle of its own, below those of scripts.
const FIRST: i64 = 900_000;
/// Groups of an environment.
const IN_ONE: i64 = 32;

/// Configurations of which one is looked for that is good.
const MAX_CONFIGURATIONS: usize = 50;

/// Time of a search at least `[s]`, as attempts: V-REP tries hundreds in a few milliseconds.
const MIN_SECONDS: f64 = 0.05;

/// Results of a calculation.
const NOT_PERFORMED: i64 = 0;
const SUCCESS: i64 = 1;
const FAIL: i64 = 2;

pub(super) const FUNCTIONS: &[Function] = &[
    Function { name: "getIkGroupHandle", tip: "int ikGroupHandle=sim.getIkGroupHandle(string ikGroupName)", run: find },
    Function { name: "handleIkGroup", tip: "int result=sim.handleIkGroup(int ikGroupHandle)", run: solve },
    Function {
        name: "checkIkGroup",
        tip: "int result,float[] jointValues=sim.checkIkGroup(int ikGroupHandle,int[] jointHandles)",
        run: check,
    },
    Function {
        name: "getConfigForTipPose",
        tip: "float[] jointPositions=sim.getConfigForTipPose(int ikGroupHandle,int[] jointHandles,float distanceThreshold,int maxTimeInMs,float[4] metric=nil,int[] collisionPairs=nil,int[] jointOptions=nil,float[] lowLimits=nil,float[] ranges=nil)",
        run: config,
    },
    Function {
        name: "generateIkPath",
        tip: "float[] path=sim.generateIkPath(int ikGroupHandle,int[] jointHandles,int pointCount,int[] collisionPairs=nil,int[] jointOptions=nil)",
        run: path,
    },
    Function {
        name: "setIkGroupProperties",
        tip: "int result=sim.setIkGroupProperties(int ikGroupHandle,int resolutionMethod,int maxIterations,float damping)",
        run: |sim, a| {
            let (environment, group) = parts(a.int(0)?)?;
            let given = [environment.into(), group.into(), a.get(1).clone(), a.get(3).clone(), a.get(2).clone()];
            of_module(sim, "simIK.setGroupCalculation", &given)
        },
    },
    Function {
        name: "setIkElementProperties",
        tip: "int result=sim.setIkElementProperties(int ikGroupHandle,int tipDummyHandle,int constraints,float[2] precision=nil,float[2] weight=nil)",
        run: element_properties,
    },
];

/// Calls a function of `simIK`; 1, as V-REP gives where nothing is wrong.
fn of_module(sim: &mut SimApi<'_>, name: &str, given: &[Value]) -> Outcome {
    let of_module = function(name).expect("it is one of the module's functions");
    (of_module.run)(sim, Arguments(given))?;
    one(1_i64)
}

/// Constraints, precision and weights of the element of a group with a tip.
fn element_properties(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (environment, group) = parts(a.int(0)?)?;
    let tip = handle(sim, a, 1)?;
    let mut number = 0;
    while sim
        .element(environment, group, number)
        .map_err(|_| ApiError::new("the group has no element with that tip"))?
        .tip
        != tip
    {
        number += 1;
    }
    let mut set = |name: &str, value: &Value| {
        of_module(sim, name, &[environment.into(), group.into(), number.into(), value.clone()]).map(drop)
    };
    // as in V-REP an element without constraints takes no part
    let is_enabled = a.int(2)? != 0;
    if is_enabled {
        set("simIK.setElementConstraints", a.get(2))?;
    }
    set("simIK.setElementFlags", &Value::Int(i64::from(is_enabled)))?;
    if a.has(3) {
        set("simIK.setElementPrecision", a.get(3))?;
    }
    if a.has(4) {
        set("simIK.setElementWeights", a.get(4))?;
    }
    one(1_i64)
}

fn find(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let name = a.text(0)?;
    let (environment, group) = sim.group_of_name(None, name.strip_suffix('#').unwrap_or(name))?;
    one(FIRST + IN_ONE * environment + group)
}

/// Returns true if a number is the handle of a group.
pub(super) fn is_group(number: i64) -> bool {
    parts(number).is_ok()
}

/// Environment and number of a group.
pub(super) fn parts(number: i64) -> Result<(i64, i64), ApiError> {
    let k = number.checked_sub(FIRST).filter(|k| (0..IN_ONE * IN_ONE).contains(k));
    k.map(|k| (k / IN_ONE, k % IN_ONE)).ok_or_else(|| ApiError(format!("{number} is no handle of a group")))
}

/// Moves the joints of a group, also if not all of it is reached; of all groups for −2 and −3: how many those were.
fn solve(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let number = a.int(0)?;
    if matches!(number, -2 | -3) {
        let all: Vec<(i64, i64)> = sim.named_groups().map(|(e, group, _)| (e, group)).collect();
        for (environment, group) in &all {
            sim.handle_group(*environment, *group, (true, true))?;
        }
        return one(all.len() as i64);
    }
    let (environment, group) = parts(number)?;
    let outcome = sim.handle_group(environment, group, (true, true))?;
    one(outcome.map_or(NOT_PERFORMED, |outcome| if outcome.is_reached { SUCCESS } else { FAIL }))
}

/// Joints of the second argument.
fn joints(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Vec<Handle>, ApiError> {
    let Value::List(joints) = a.get(1) else { return Err(ApiError::new("argument 2 is no list of handles")) };
    (0..joints.len()).map(|k| handle(sim, Arguments(joints), k)).collect()
}

/// Collision pairs of an argument that may be left out.
fn pairs(sim: &SimApi<'_>, a: Arguments<'_>, k: usize) -> Result<Vec<[Handle; 2]>, ApiError> {
    if a.has(k) { sincro_planning::collision_pairs(sim, a, k) } else { Ok(Vec::new()) }
}

/// Configuration in which a group reaches its targets, within limits and where no pair meets; nothing if none is found.
fn config(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (group, joints, pairs) = (parts(a.int(0)?)?, joints(sim, a)?, pairs(sim, a, 5)?);
    let mut limits = [Vec::new(), Vec::new()];
    for (k, limit) in [7, 8].into_iter().zip(&mut limits).filter(|(k, _)| a.has(*k)) {
        let numbers = a.get(k).as_reals().filter(|numbers| numbers.len() == joints.len());
        *limit = numbers.ok_or_else(|| ApiError(format!("argument {} is no list of a number a joint", k + 1)))?;
    }
    let [low, range] = limits;
    let is_within = |q: &[f64]| {
        q.iter().zip(&low).all(|(q, low)| q >= low)
            && q.iter().zip(&low).zip(&range).all(|((q, low), range)| q - low <= *range)
    };
    let n = if pairs.is_empty() && low.is_empty() { 1 } else { MAX_CONFIGURATIONS };
    let seconds = (a.real(3)?.abs() / 1000.0).max(MIN_SECONDS);
    // a script that asks again gets other attempts, as in V-REP
    let salt = sim.registry.n_searches;
    sim.registry.n_searches = salt.wrapping_add(1);
    for q in sim.find_configurations(group, &joints, n, (seconds, salt))? {
        if is_within(&q) && sim.is_free(&joints, &q, &pairs)? {
            return Ok(vec![Value::reals(q)]);
        }
    }
    one(Value::Nil)
}

/// Configurations along the straight way of the first tip of a group to its target; nothing if a point is not reached
/// or a pair meets there.
fn path(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (group, joints, pairs) = (parts(a.int(0)?)?, joints(sim, a)?, pairs(sim, a, 3)?);
    let n = usize::try_from(a.int(2)?).map_err(|_| ApiError::new("the number of points is negative"))?;
    let tip = sim.element(group.0, group.1, 0)?.tip;
    let Some(path) = sim.generate_path(group, &joints, tip, n)? else { return one(Value::Nil) };
    for q in path.chunks(joints.len().max(1)) {
        if !sim.is_free(&joints, q, &pairs)? {
            return one(Value::Nil);
        }
    }
    Ok(vec![Value::reals(path)])
}

/// Solved positions of joints, in the order of the request; joints outside the group keep their positions.
fn check(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (environment, group) = parts(a.int(0)?)?;
    let joints = joints(sim, a)?;
    let (outcome, found) = sim.solve_group(environment, group)?;
    let place = |joint: Handle| match found.iter().find(|(own, _)| *own == joint) {
        Some((_, q)) => Ok(*q),
        None => sim.joint_position(joint),
    };
    let places = joints.into_iter().map(place).collect::<Result<Vec<f64>, _>>()?;
    Ok(vec![Value::Int(if outcome.is_reached { SUCCESS } else { FAIL }), Value::reals(places)])
}
