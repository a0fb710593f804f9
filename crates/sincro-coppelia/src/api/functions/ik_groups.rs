//! Functions: groups of inverse kinematics as V-REP 3 has them, by name. Here a script or client makes them by
//! `simIK.createGroup` with a name.

use super::{Function, Outcome, function, handle, one};
use crate::api::{ApiError, Arguments, Handle, SimApi, Value};

/// Added to environment and group: a handle of its own, below those of scripts.
const FIRST: i64 = 900_000;
/// Groups of an environment.
const IN_ONE: i64 = 32;

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

/// Solved positions of joints, in the order of the request; joints outside the group keep their positions.
fn check(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (environment, group) = parts(a.int(0)?)?;
    let Value::List(joints) = a.get(1) else { return Err(ApiError::new("argument 2 is no list of handles")) };
    let joints = (0..joints.len()).map(|k| handle(sim, Arguments(joints), k)).collect::<Result<Vec<Handle>, _>>()?;
    let (outcome, found) = sim.solve_group(environment, group)?;
    let place = |joint: Handle| match found.iter().find(|(own, _)| *own == joint) {
        Some((_, q)) => Ok(*q),
        None => sim.joint_position(joint),
    };
    let places = joints.into_iter().map(place).collect::<Result<Vec<f64>, _>>()?;
    Ok(vec![Value::Int(if outcome.is_reached { SUCCESS } else { FAIL }), Value::reals(places)])
}
