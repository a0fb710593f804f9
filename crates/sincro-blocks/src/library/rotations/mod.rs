//! Rotations: Euler angles, quaternions (w, x, y, z), matrices row by row.

mod algebra;
mod angular_velocity_to_quaternion_rate;
mod euler_rates;
mod euler_rates_to_angular_velocity;
mod euler_to_matrix;
mod euler_to_quaternion;
mod matrix_to_euler;
mod matrix_to_quaternion;
mod quaternion_conjugate;
mod quaternion_product;
mod quaternion_to_euler;
mod quaternion_to_matrix;
mod rotate_vector;

pub use algebra::Convention;
pub use angular_velocity_to_quaternion_rate::AngularVelocityToQuaternionRate;
pub use euler_rates::EulerRates;
pub use euler_rates_to_angular_velocity::EulerRatesToAngularVelocity;
pub use euler_to_matrix::EulerToMatrix;
pub use euler_to_quaternion::EulerToQuaternion;
pub use matrix_to_euler::MatrixToEuler;
pub use matrix_to_quaternion::MatrixToQuaternion;
pub use quaternion_conjugate::QuaternionConjugate;
pub use quaternion_product::QuaternionProduct;
pub use quaternion_to_euler::QuaternionToEuler;
pub use quaternion_to_matrix::QuaternionToMatrix;
pub use rotate_vector::RotateVector;

use sincro_math::Real;

use super::{Item, item};
use crate::block::At;

pub(super) const SHELF: &[Item] = &[
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

/// One output of width `output`, if all inputs have the widths that are expected of them.
fn fixed(inputs: &[Option<usize>], expected: &[(&str, usize)], output: usize) -> Result<Vec<Option<usize>>, String> {
    for ((name, expected), width) in expected.iter().zip(inputs) {
        if let Some(width) = width
            && width != expected
        {
            return Err(format!("`{name}` has {expected} components here, it gets {width}"));
        }
    }
    Ok(vec![Some(output)])
}

/// An input as an array.
#[inline(always)]
fn array<R: Real, const N: usize>(at: &At<'_, R>, input: usize) -> [R; N] {
    let u = at.input(input);
    core::array::from_fn(|k| u[k])
}
