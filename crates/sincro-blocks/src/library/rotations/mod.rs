//! Rotations: Euler angles, quaternions (w, x, y, z), matrices row by row.

mod algebra;
mod blocks;

pub use algebra::Convention;
pub use blocks::{
    AngularVelocityToQuaternionRate, EulerRates, EulerRatesToAngularVelocity, EulerToMatrix, EulerToQuaternion, Map,
    MatrixToEuler, MatrixToQuaternion, QuaternionConjugate, QuaternionProduct, QuaternionToEuler, QuaternionToMatrix,
    RotateVector, Rotation,
};

use super::{Item, item};

pub(super) static BLOCKS: &[Item] = &[
    item::<EulerToQuaternion>(),
    item::<QuaternionToEuler>(),
    item::<EulerToMatrix>(),
    item::<MatrixToEuler>(),
    item::<QuaternionToMatrix>(),
    item::<MatrixToQuaternion>(),
    item::<RotateVector>(),
    item::<QuaternionProduct>(),
    item::<QuaternionConjugate>(),
    item::<AngularVelocityToQuaternionRate>(),
    item::<EulerRates>(),
    item::<EulerRatesToAngularVelocity>(),
];
