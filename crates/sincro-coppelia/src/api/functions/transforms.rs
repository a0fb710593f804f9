//! Functions: arithmetic of matrices (12 numbers, the upper 3×4 part row by row) and poses (position, then x y z w).

use sincro_dynamics::spatial::{Mat3, Pose, Vec3};

use super::{Function, Outcome, list};
use crate::api::convention::{
    euler_of, matrix_of, numbers_of_pose, pose_of_matrix, pose_of_numbers, quaternion_of, rotation_of_euler,
    rotation_of_quaternion,
};
use crate::api::{ApiError, Arguments, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "buildIdentityMatrix",
        tip: "float[12] matrix=sim.buildIdentityMatrix()",
        run: |_, _| list(matrix_of(&Pose::identity())),
    },
    Function {
        name: "buildMatrix",
        tip: "float[12] matrix=sim.buildMatrix(float[3] position,float[3] eulerAngles)",
        run: |_, a| list(matrix_of(&of_euler(a)?)),
    },
    Function {
        name: "buildMatrixQ",
        tip: "float[12] matrix=sim.buildMatrixQ(float[3] position,float[4] quaternion)",
        run: |_, a| build_q(a),
    },
    Function {
        name: "buildPose",
        tip: "float[7] pose=sim.buildPose(float[3] position,float[3] eulerAngles)",
        run: |_, a| list(numbers_of_pose(&of_euler(a)?)),
    },
    Function {
        name: "multiplyMatrices",
        tip: "float[12] resultMatrix=sim.multiplyMatrices(float[12] matrixIn1,float[12] matrixIn2)",
        run: |_, a| list(matrix_of(&any(a, 0)?.compose(&any(a, 1)?))),
    },
    Function {
        name: "multiplyPoses",
        tip: "float[7] resultPose=sim.multiplyPoses(float[7] poseIn1,float[7] poseIn2)",
        run: |_, a| list(numbers_of_pose(&any(a, 0)?.compose(&any(a, 1)?))),
    },
    Function {
        name: "multiplyVector",
        tip: "float[] resultVectors=sim.multiplyVector(float[] poseOrMatrix,float[] inVectors)",
        run: |_, a| vectors(a),
    },
    Function {
        name: "getMatrixInverse",
        tip: "float[12] matrixOut=sim.getMatrixInverse(float[12] matrixIn)",
        run: |_, a| list(matrix_of(&any(a, 0)?.inverse())),
    },
    Function {
        name: "getPoseInverse",
        tip: "float[7] pose=sim.getPoseInverse(float[7] pose)",
        run: |_, a| list(numbers_of_pose(&any(a, 0)?.inverse())),
    },
    Function {
        name: "matrixToPose",
        tip: "float[7] pose=sim.matrixToPose(float[12] matrix)",
        run: |_, a| list(numbers_of_pose(&any(a, 0)?)),
    },
    Function {
        name: "poseToMatrix",
        tip: "float[12] matrix=sim.poseToMatrix(float[7] pose)",
        run: |_, a| list(matrix_of(&any(a, 0)?)),
    },
    Function {
        name: "getEulerAnglesFromMatrix",
        tip: "float[3] eulerAngles=sim.getEulerAnglesFromMatrix(float[12] matrix)",
        run: |_, a| list(euler_of(&any(a, 0)?.rot)),
    },
    Function {
        name: "getQuaternionFromMatrix",
        tip: "float[4] quaternion=sim.getQuaternionFromMatrix(float[12] matrix)",
        run: |_, a| list(quaternion_of(&any(a, 0)?.rot)),
    },
    Function {
        name: "alphaBetaGammaToYawPitchRoll",
        tip: "float yaw,float pitch,float roll=sim.alphaBetaGammaToYawPitchRoll(float alpha,float beta,float gamma)",
        run: |_, a| to_yaw(a),
    },
    Function {
        name: "yawPitchRollToAlphaBetaGamma",
        tip: "float alpha,float beta,float gamma=sim.yawPitchRollToAlphaBetaGamma(float yaw,float pitch,float roll)",
        run: |_, a| from_yaw(a),
    },
];

/// A matrix or a pose, distinguished by the count of numbers.
pub(super) fn any(a: Arguments<'_>, k: usize) -> Result<Pose<f64>, ApiError> {
    match a.get(k).as_reals().map(|list| list.len()) {
        Some(7) => pose_of_numbers(a.reals(k)?).ok_or_else(|| ApiError::new("the quaternion has no direction")),
        _ => Ok(pose_of_matrix(&a.reals(k)?)),
    }
}

fn of_euler(a: Arguments<'_>) -> Result<Pose<f64>, ApiError> {
    Ok(Pose { pos: Vec3(a.reals(0)?), rot: rotation_of_euler(a.reals(1)?) })
}

fn build_q(a: Arguments<'_>) -> Outcome {
    let rot = rotation_of_quaternion(a.reals(1)?).ok_or_else(|| ApiError::new("the quaternion has no direction"))?;
    list(matrix_of(&Pose { pos: Vec3(a.reals(0)?), rot }))
}

fn vectors(a: Arguments<'_>) -> Outcome {
    let pose = any(a, 0)?;
    let numbers = a.get(1).as_reals().filter(|v| v.len().is_multiple_of(3));
    let numbers = numbers.ok_or_else(|| ApiError::new("argument 2 is no list of vectors of three numbers"))?;
    list(numbers.chunks_exact(3).flat_map(|v| pose.point(Vec3([v[0], v[1], v[2]])).0))
}

/// R = Rz(yaw)·Ry(pitch)·Rx(roll).
fn to_yaw(a: Arguments<'_>) -> Outcome {
    let rot = rotation_of_euler([a.real(0)?, a.real(1)?, a.real(2)?]);
    let [roll, pitch, yaw] = sincro_dynamics::kinematics::roll_pitch_yaw(&rot).0;
    Ok([yaw, pitch, roll].map(Value::Real).to_vec())
}

fn from_yaw(a: Arguments<'_>) -> Outcome {
    let [(sy, cy), (sp, cp), (sr, cr)] = [a.real(0)?, a.real(1)?, a.real(2)?].map(sincro_math::elementary::sin_cos);
    let rot = Mat3::rotation::<2>(sy, cy).mul(&Mat3::rotation::<1>(sp, cp)).mul(&Mat3::rotation::<0>(sr, cr));
    Ok(euler_of(&rot).map(Value::Real).to_vec())
}
