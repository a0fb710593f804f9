//! Functions: poses and velocities of objects.

use sincro_dynamics::spatial::{Pose, Vec3};

use super::{Function, Outcome, done, handle, list, reference, setter};
use crate::api::{ApiError, Arguments, Handle, Kind, Reference, SimApi, Value, convention};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "getObjectPosition",
        tip: "float[3] position=sim.getObjectPosition(int objectHandle,int relativeToObjectHandle=sim.handle_world)",
        run: position,
    },
    Function {
        name: "setObjectPosition",
        tip: "sim.setObjectPosition(int objectHandle,float[3] position,int relativeToObjectHandle=sim.handle_world)",
        run: set_position,
    },
    Function {
        name: "getObjectOrientation",
        tip: "float[3] eulerAngles=sim.getObjectOrientation(int objectHandle,int relativeToObjectHandle=sim.handle_world)",
        run: orientation,
    },
    Function {
        name: "setObjectOrientation",
        tip: "sim.setObjectOrientation(int objectHandle,float[3] eulerAngles,int relativeToObjectHandle=sim.handle_world)",
        run: set_orientation,
    },
    Function {
        name: "getObjectQuaternion",
        tip: "float[4] quaternion=sim.getObjectQuaternion(int objectHandle,int relativeToObjectHandle=sim.handle_world)",
        run: quaternion,
    },
    Function {
        name: "setObjectQuaternion",
        tip: "sim.setObjectQuaternion(int objectHandle,float[4] quaternion,int relativeToObjectHandle=sim.handle_world)",
        run: set_quaternion,
    },
    Function {
        name: "getObjectPose",
        tip: "float[7] pose=sim.getObjectPose(int objectHandle,int relativeToObjectHandle=sim.handle_world)",
        run: pose,
    },
    Function {
        name: "setObjectPose",
        tip: "sim.setObjectPose(int objectHandle,float[7] pose,int relativeToObjectHandle=sim.handle_world)",
        run: set_pose,
    },
    Function {
        name: "getObjectMatrix",
        tip: "float[12] matrix=sim.getObjectMatrix(int objectHandle,int relativeToObjectHandle=sim.handle_world)",
        run: matrix,
    },
    Function {
        name: "setObjectMatrix",
        tip: "sim.setObjectMatrix(int objectHandle,float[12] matrix,int relativeToObjectHandle=sim.handle_world)",
        run: set_matrix,
    },
    Function {
        name: "getJointMatrix",
        tip: "float[12] matrix=sim.getJointMatrix(int objectHandle)",
        run: joint_matrix,
    },
    Function {
        name: "setSphericalJointMatrix",
        tip: "sim.setSphericalJointMatrix(int objectHandle,float[12] matrix)",
        run: |sim, a| {
            let own = handle(sim, a, 0)?;
            sim.turn_ball_joint(own, &convention::pose_of_matrix(&a.reals(1)?))?;
            done()
        },
    },
    Function {
        name: "setObjectChildPose",
        tip: "sim.setObjectChildPose(int objectHandle,float[7] pose)",
        run: set_child_pose,
    },
    Function {
        name: "getObjectChildPose",
        tip: "float[7] pose=sim.getObjectChildPose(int objectHandle)",
        run: child_pose,
    },
    Function {
        name: "getObjectVelocity",
        tip: "float[3] linearVelocity,float[3] angularVelocity=sim.getObjectVelocity(int objectHandle)",
        run: velocity,
    },
    Function {
        name: "getVelocity",
        tip: "float[3] linearVelocity,float[3] angularVelocity=sim.getVelocity(int shapeHandle)",
        run: center_velocity,
    },
];

fn read(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<Pose<f64>, ApiError> {
    let (own, against) = (handle(sim, a, 0)?, reference(sim, a, 1)?);
    sim.pose(own, against)
}

/// Handle, present pose against the reference, the reference, and the place of the new value.
fn before(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<(Handle, Pose<f64>, Reference, usize), ApiError> {
    let (value, against) = setter(a);
    let (own, against) = (handle(sim, a, 0)?, reference(sim, a, against)?);
    Ok((own, sim.pose(own, against)?, against, value))
}

fn position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    list(read(sim, a)?.pos.0)
}

fn orientation(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    list(convention::euler_of(&read(sim, a)?.rot))
}

fn quaternion(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    list(convention::quaternion_of(&read(sim, a)?.rot))
}

fn pose(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    list(convention::numbers_of_pose(&read(sim, a)?))
}

fn matrix(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    list(convention::matrix_of(&read(sim, a)?))
}

fn set_position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, before, against, value) = before(sim, a)?;
    sim.set_pose(own, &Pose { pos: Vec3(a.reals(value)?), ..before }, against)?;
    done()
}

fn set_orientation(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, before, against, value) = before(sim, a)?;
    sim.set_pose(own, &Pose { rot: convention::rotation_of_euler(a.reals(value)?), ..before }, against)?;
    done()
}

fn set_quaternion(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, before, against, value) = before(sim, a)?;
    let rot = convention::rotation_of_quaternion(a.reals(value)?);
    let rot = rot.ok_or_else(|| ApiError::new("the quaternion has no direction"))?;
    sim.set_pose(own, &Pose { rot, ..before }, against)?;
    done()
}

fn set_pose(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, _, against, value) = before(sim, a)?;
    let pose = convention::pose_of_numbers(a.reals(value)?);
    let pose = pose.ok_or_else(|| ApiError::new("the quaternion has no direction"))?;
    sim.set_pose(own, &pose, against)?;
    done()
}

fn set_matrix(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, _, against, value) = before(sim, a)?;
    sim.set_pose(own, &convention::pose_of_matrix(&a.reals(value)?), against)?;
    done()
}

fn joint_matrix(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    list(convention::matrix_of(&sim.joint_pose(own)?))
}

/// Against the parent; the one of a joint is its position, which is set otherwise.
fn set_child_pose(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    if matches!(sim.registry.entry(own)?.kind, Kind::Joint(_) | Kind::ForceSensor(_) | Kind::Rotor(_)) {
        return Err(ApiError::new("the pose of a joint is its position: use sim.setJointPosition"));
    }
    let pose =
        convention::pose_of_numbers(a.reals(1)?).ok_or_else(|| ApiError::new("the quaternion has no direction"))?;
    sim.set_pose(own, &pose, Reference::Parent)?;
    done()
}

fn child_pose(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    list(convention::numbers_of_pose(&sim.joint_pose(own)?))
}

fn velocity(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let (linear, angular) = sim.velocity(own)?;
    Ok(vec![Value::reals(linear), Value::reals(angular)])
}

fn center_velocity(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = handle(sim, a, 0)?;
    let (linear, angular) = sim.center_velocity(own)?;
    Ok(vec![Value::reals(linear), Value::reals(angular)])
}
