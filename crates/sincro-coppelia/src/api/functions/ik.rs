//! Functions: `simIK`, inverse kinematics.

use super::{Function, Outcome, done, one, plain};
use crate::api::ik::Element;
use crate::api::{ApiError, Arguments, SimApi, Value};

/// Functions of `simIK`, named without it.
pub(super) const FUNCTIONS: &[Function] = &[
    Function { name: "createEnvironment", tip: "int environmentHandle=simIK.createEnvironment()", run: create },
    Function { name: "eraseEnvironment", tip: "simIK.eraseEnvironment(int environmentHandle)", run: erase },
    Function {
        name: "createGroup",
        tip: "int groupHandle=simIK.createGroup(int environmentHandle,string groupName='')",
        run: create_group,
    },
    Function {
        name: "getGroupHandle",
        tip: "int groupHandle=simIK.getGroupHandle(int environmentHandle,string groupName)",
        run: |d, a| one(d.group_of_name(Some(a.int(0)?), a.text(1)?)?.1),
    },
    Function {
        name: "setGroupCalculation",
        tip: "simIK.setGroupCalculation(int environmentHandle,int groupHandle,int method,float dampingFactor,int maxIterations)",
        run: calculation,
    },
    Function {
        name: "addElementFromScene",
        tip: "int elementHandle=simIK.addElementFromScene(int environmentHandle,int groupHandle,int baseHandle,int tipHandle,int targetHandle,int constraints)",
        run: add,
    },
    Function {
        name: "setElementPrecision",
        tip: "simIK.setElementPrecision(int environmentHandle,int groupHandle,int elementHandle,float[2] precision)",
        run: precision,
    },
    Function {
        name: "setElementWeights",
        tip: "simIK.setElementWeights(int environmentHandle,int groupHandle,int elementHandle,float[2] weights)",
        run: weights,
    },
    Function {
        name: "handleGroup",
        tip: "int result,int flags,float[2] precision=simIK.handleGroup(int environmentHandle,int groupHandle,map options={})",
        run: handle,
    },
    Function { name: "syncFromSim", tip: "simIK.syncFromSim(int environmentHandle,int[] groupHandles)", run: sync },
    Function { name: "syncToSim", tip: "simIK.syncToSim(int environmentHandle,int[] groupHandles)", run: sync },
];

/// Constants of `simIK`, named without it.
pub const CONSTANTS: &[(&str, i64)] = &[
    ("method_pseudo_inverse", 0),
    ("method_damped_least_squares", 1),
    ("method_undamped_pseudo_inverse", 3),
    ("constraint_x", 1),
    ("constraint_y", 2),
    ("constraint_z", 4),
    ("constraint_alpha_beta", 8),
    ("constraint_gamma", 16),
    ("constraint_position", 7),
    ("constraint_orientation", 24),
    ("constraint_pose", 31),
    ("result_not_performed", 0),
    ("result_success", 1),
    ("result_fail", 2),
    ("calc_notwithintolerance", NOT_WITHIN_TOLERANCE),
    ("calc_limithit", LIMIT_HIT),
];

/// Older names.
pub(super) const OLD: &[(&str, &str)] = &[
    ("createIkEnvironment", "createEnvironment"),
    ("eraseIkEnvironment", "eraseEnvironment"),
    ("createIkGroup", "createGroup"),
    ("setIkGroupCalculation", "setGroupCalculation"),
    ("addIkElementFromScene", "addElementFromScene"),
    ("setIkElementPrecision", "setElementPrecision"),
    ("setIkElementWeights", "setElementWeights"),
    ("handleIkGroup", "handleGroup"),
    ("getIkGroupHandle", "getGroupHandle"),
];

pub(super) const NOT_WITHIN_TOLERANCE: i64 = 16;
pub(super) const LIMIT_HIT: i64 = 64;

/// Precision that an element begins with `[m]`, `[rad]`: CoppeliaSim's half a millimetre and a tenth of a degree.
const PRECISION: [f64; 2] = [0.0005, 0.1 * std::f64::consts::PI / 180.0];

fn create(sim: &mut SimApi<'_>, _: Arguments<'_>) -> Outcome {
    one(sim.create_environment()? as i64)
}

fn erase(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.erase_environment(a.int(0)?)?;
    done()
}

fn create_group(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    one(sim.create_group(a.int(0)?, if a.has(1) { a.text(1)? } else { "" })? as i64)
}

fn calculation(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let damping = match a.int(2)? {
        0 | 3 => 0.0,
        1 => a.real(3)?,
        other => {
            return Err(ApiError(format!("method {other}: pseudo-inverse 0 and damped least squares 1 are offered")));
        }
    };
    sim.set_calculation(a.int(0)?, a.int(1)?, damping, a.int(4)?)?;
    done()
}

/// Objects have the same handles in environments: the maps that CoppeliaSim returns besides are not needed.
fn add(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let base = match a.handle(2)? {
        -1 => None,
        other => Some(plain(sim, other)?),
    };
    let (tip, target) = (super::handle(sim, a, 3)?, super::handle(sim, a, 4)?);
    let element = Element { base, tip, target, constraints: a.int(5)?, precision: PRECISION, weights: [1.0; 2] };
    one(sim.add_element(a.int(0)?, a.int(1)?, element)? as i64)
}

fn two(a: Arguments<'_>, what: &str) -> Result<[f64; 2], ApiError> {
    let numbers = a.reals(3)?;
    if numbers.iter().all(|x| x.is_finite() && *x >= 0.0) {
        return Ok(numbers);
    }
    Err(ApiError(format!("{what} {numbers:?}, expected two numbers that are not negative")))
}

fn precision(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let precision = two(a, "precision")?;
    sim.element(a.int(0)?, a.int(1)?, a.int(2)?)?.precision = precision;
    done()
}

fn weights(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let weights = two(a, "weights")?;
    sim.element(a.int(0)?, a.int(1)?, a.int(2)?)?.weights = weights;
    done()
}

/// Options: `syncWorlds` puts the joints of the scene there, `allowError` also if not all is reached.
fn handle(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (mut apply, mut allow_error) = (false, false);
    match a.get(2) {
        Value::Map(options) => {
            for (name, value) in options {
                let flag = value.as_bool().ok_or_else(|| ApiError(format!("option `{name}` is no truth value")))?;
                match name.as_str() {
                    "syncWorlds" => apply = flag,
                    "allowError" => allow_error = flag,
                    _ => return Err(ApiError(format!("there is no option `{name}`: syncWorlds, allowError"))),
                }
            }
        }
        Value::Nil => {}
        Value::List(list) if list.is_empty() => {}
        other => return Err(ApiError(format!("argument 3 is {}, expected a map of options", other.word()))),
    }
    let outcome = sim.handle_group(a.int(0)?, a.int(1)?, (apply, allow_error))?;
    let result = if outcome.is_reached { 1_i64 } else { 2 };
    let tolerance = if outcome.is_reached { 0 } else { NOT_WITHIN_TOLERANCE };
    let flags = tolerance | if outcome.hit_limit { LIMIT_HIT } else { 0 };
    Ok(vec![result.into(), flags.into(), Value::reals(outcome.errors)])
}

/// Environments are no worlds of their own: they are always as the scene is.
fn sync(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.group_count(a.int(0)?)?;
    done()
}
