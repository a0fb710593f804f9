//! Matrices as signals: row by row in one vector.

mod diagonal;
mod matrix_concatenate;
mod matrix_product;

pub use diagonal::Diagonal;
pub use matrix_concatenate::MatrixConcatenate;
pub use matrix_product::MatrixProduct;

use super::{Item, item};

pub(super) static BLOCKS: &[Item] = &[item::<MatrixProduct>(), item::<MatrixConcatenate>(), item::<Diagonal>()];
