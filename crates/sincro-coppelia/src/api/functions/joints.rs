//! Functions: joints and their motors.

use super::{Function, Outcome, done, handle, one};
use crate::api::{ApiError, Arguments, SimApi, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "createJoint",
        tip: "int jointHandle=sim.createJoint(int jointType,int jointMode,int options,float[2] sizes={0.15,0.02})",
        run: create,
    },
    Function { name: "getJointPosition", tip: "float position=sim.getJointPosition(int objectHandle)", run: position },
    Function {
        name: "setJointPosition",
        tip: "sim.setJointPosition(int objectHandle,float position)",
        run: set_position,
    },
    Function { name: "getJointVelocity", tip: "float velocity=sim.getJointVelocity(int jointHandle)", run: velocity },
    Function {
        name: "getJointTargetVelocity",
        tip: "float targetVelocity=sim.getJointTargetVelocity(int objectHandle)",
        run: target_velocity,
    },
    Function {
        name: "setJointTargetVelocity",
        tip: "sim.setJointTargetVelocity(int objectHandle,float targetVelocity,float[] motionParams={})",
        run: set_target_velocity,
    },
    Function {
        name: "getJointTargetPosition",
        tip: "float targetPosition=sim.getJointTargetPosition(int objectHandle)",
        run: target_position,
    },
    Function {
        name: "setJointTargetPosition",
        tip: "sim.setJointTargetPosition(int objectHandle,float targetPosition,float[] motionParams={})",
        run: set_target_position,
    },
    Function {
        name: "getJointTargetForce",
        tip: "float force=sim.getJointTargetForce(int jointHandle)",
        run: target_force,
    },
    Function {
        name: "setJointTargetForce",
        tip: "sim.setJointTargetForce(int objectHandle,float forceOrTorque,bool signedValue=true)",
        run: set_target_force,
    },
    Function {
        name: "setJointForce",
        tip: "int result=sim.setJointForce(int objectHandle,float forceOrTorque)",
        run: set_force_along_target,
    },
    Function {
        name: "setJointMaxForce",
        tip: "sim.setJointMaxForce(int objectHandle,float forceOrTorque)",
        run: set_force_along_target,
    },
    Function { name: "getJointForce", tip: "float forceOrTorque=sim.getJointForce(int jointHandle)", run: force },
    Function { name: "getJointMode", tip: "int jointMode,int options=sim.getJointMode(int jointHandle)", run: mode },
    Function {
        name: "setJointMode",
        tip: "sim.setJointMode(int jointHandle,int jointMode,int options)",
        run: set_mode,
    },
    Function {
        name: "getJointInterval",
        tip: "bool cyclic,float[2] interval=sim.getJointInterval(int objectHandle)",
        run: interval,
    },
    Function {
        name: "setJointInterval",
        tip: "sim.setJointInterval(int objectHandle,bool cyclic,float[2] interval)",
        run: set_interval,
    },
    Function {
        name: "setJointDependency",
        tip: "sim.setJointDependency(int jointHandle,int masterJointHandle,float offset,float multCoeff)",
        run: set_dependency,
    },
    Function {
        name: "getJointDependency",
        tip: "int masterJointHandle,float offset,float multCoeff=sim.getJointDependency(int jointHandle)",
        run: dependency,
    },
];

/// Mode 0 kinematic, 5 dynamic; sizes are those of its drawing.
fn create(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (kind, mode) = (a.int(0)?, a.int_or(1, 5)?);
    let is_kinematic = match mode {
        0 => true,
        5 => false,
        other => {
            return Err(ApiError(format!("{other} is no mode of a joint: kinematic 0, dynamic 5")));
        }
    };
    one(sim.create_joint(kind, is_kinematic)?)
}

fn position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.joint_position(own)?)
}

fn set_position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.set_joint_position(own, a.real(1)?)?;
    done()
}

/// Limits within which a target is to go there, if they are given.
fn limits<const N: usize>(a: Arguments<'_>, what: &str) -> Result<Option<[f64; N]>, ApiError> {
    match a.get(2) {
        Value::Nil => Ok(None),
        Value::List(list) if list.is_empty() => Ok(None),
        // V-REP knows no limit of 0: without any, the target is given at once
        Value::List(list) if list.iter().all(|x| x.as_real() == Some(0.0)) => Ok(None),
        _ => a.reals(2).map(Some).map_err(|ApiError(why)| ApiError(format!("{why}: {what}"))),
    }
}

fn velocity(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.joint_velocity(own)?)
}

fn target_velocity(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.target_velocity(own)?)
}

fn set_target_velocity(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    match limits(a, "largest acceleration and jerk")? {
        Some(limits) => sim.go_to_velocity(own, a.real(1)?, limits)?,
        None => sim.set_target_velocity(own, a.real(1)?)?,
    }
    done()
}

fn target_position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.target_position(own)?)
}

fn set_target_position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    match limits(a, "largest velocity, acceleration and jerk")? {
        Some(limits) => sim.go_to_position(own, a.real(1)?, limits)?,
        None => sim.set_target_position(own, a.real(1)?)?,
    }
    done()
}

fn target_force(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    one(sim.target_force(own)?)
}

/// As before CoppeliaSim 4.3: in torque mode a magnitude has the direction of the target velocity. A negative number is
/// no magnitude: it is taken with its sign.
fn set_force_along_target(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let force = a.real(1)?;
    sim.set_target_force(own, force, force < 0.0)?;
    one(1_i64)
}

fn set_target_force(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.set_target_force(own, a.real(1)?, a.bool_or(2, true)?)?;
    done()
}

fn force(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    Ok(vec![sim.joint_force(own)?.map_or(Value::Nil, Value::Real)])
}

fn mode(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.joint_mode(own)?;
    let (mode, is_hybrid) = sim.kinematic_mode(own)?;
    Ok(vec![Value::Int(mode), Value::Int(i64::from(is_hybrid))])
}

/// Bit 0 of the options: hybrid.
fn set_mode(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    sim.set_kinematic_mode(own, a.int(1)?, a.int_or(2, 0)? & 1 != 0)?;
    done()
}

fn interval(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let (is_cyclic, range) = sim.joint_interval(own)?;
    Ok(vec![Value::Bool(is_cyclic), Value::reals(range)])
}

/// A lower limit and a range, as V-REP has it.
fn set_interval(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    if a.bool_or(1, false)? {
        sim.remove_joint_stops(own)?;
        return done();
    }
    let [lower, range]: [f64; 2] = a.reals(2)?;
    sim.set_joint_interval(own, lower, lower + range)?;
    done()
}

fn set_dependency(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    if a.handle(1)? == -1 {
        return match sim.joint_dependency(own)? {
            None => done(),
            Some(_) => Err(ApiError::new("a coupling of the scene is changed, not taken away")),
        };
    }
    let master = handle(sim, a, 1)?;
    sim.set_joint_dependency(own, master, (a.real(2)?, a.real(3)?))?;
    done()
}

/// A joint that follows none has no master, offset 0 and factor 1.
fn dependency(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let (master, offset, factor) = sim.joint_dependency(own)?.unwrap_or((crate::api::Handle(-1), 0.0, 1.0));
    Ok(vec![master.into(), Value::Real(offset), Value::Real(factor)])
}
