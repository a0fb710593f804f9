//! Functions: turning about axes, and half-way between two poses.

use sincro_dynamics::spatial::{Pose, Quat, Vec3};

use super::transforms::any;
use super::{Function, Outcome, list};
use crate::api::convention::{matrix_of, numbers_of_pose, rotation_vector};
use crate::api::{ApiError, Arguments, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "interpolateMatrices",
        tip: "float[12] matrixOut=sim.interpolateMatrices(float[12] matrixIn1,float[12] matrixIn2,float interpolFactor)",
        run: |_, a| list(matrix_of(&between(a)?)),
    },
    Function {
        name: "interpolatePoses",
        tip: "float[7] poseOut=sim.interpolatePoses(float[7] poseIn1,float[7] poseIn2,float interpolFactor)",
        run: |_, a| list(numbers_of_pose(&between(a)?)),
    },
    Function {
        name: "getRotationAxis",
        tip: "float[3] axis,float angle=sim.getRotationAxis(float[12] matrixStart,float[12] matrixGoal)",
        run: |_, a| axis(a),
    },
    Function {
        name: "rotateAroundAxis",
        tip: "float[] out=sim.rotateAroundAxis(float[] poseOrMatrix,float[3] axis,float[3] axisPos,float angle)",
        run: |_, a| rotate(a),
    },
];

/// Positions on a line, rotations at constant rate about one axis.
fn between(a: Arguments<'_>) -> Result<Pose<f64>, ApiError> {
    let (from, to, share) = (any(a, 0)?, any(a, 1)?, a.real(2)?);
    let turn = rotation_vector(&from.rot.transpose().mul(&to.rot));
    let rot = from.rot.mul(&Quat::exp(turn.scale(share)).matrix());
    Ok(Pose { rot, pos: from.pos + (to.pos - from.pos).scale(share) })
}

/// In the world; z and 0 where both are the same.
fn axis(a: Arguments<'_>) -> Outcome {
    let turn = rotation_vector(&any(a, 1)?.rot.mul(&any(a, 0)?.rot.transpose()));
    let angle = turn.norm();
    let axis = if angle == 0.0 { Vec3([0.0, 0.0, 1.0]) } else { turn.scale(1.0 / angle) };
    Ok(vec![Value::reals(axis.0), Value::Real(angle)])
}

fn rotate(a: Arguments<'_>) -> Outcome {
    let (pose, axis, point) = (any(a, 0)?, Vec3(a.reals(1)?), Vec3(a.reals(2)?));
    let length = axis.norm();
    if !length.is_finite() || length == 0.0 {
        return Err(ApiError::new("argument 2 is no axis: it has no direction"));
    }
    let turn = Quat::exp(axis.scale(a.real(3)? / length)).matrix();
    let rotated = Pose { rot: turn.mul(&pose.rot), pos: turn.mul_vec(pose.pos - point) + point };
    if matches!(a.get(0), Value::List(numbers) if numbers.len() == 7) {
        list(numbers_of_pose(&rotated))
    } else {
        list(matrix_of(&rotated))
    }
}
