//! Maths: without memory, component by component unless said otherwise.

mod abs;
mod cross;
mod divide;
mod dot;
mod expression;
mod extremum;
mod function;
mod gain;
mod matrix_gain;
mod norm;
mod polynomial;
mod power;
mod product;
mod sign;
mod sqrt;
mod sum;
mod trigonometry;

pub use abs::Abs;
pub use cross::Cross;
pub use divide::Divide;
pub use dot::Dot;
pub use expression::Expression;
pub use extremum::{Extremum, Max, Min};
pub use function::{Function, Unary};
pub use gain::Gain;
pub use matrix_gain::MatrixGain;
pub use norm::Norm;
pub use polynomial::Polynomial;
pub use power::Power;
pub use product::Product;
pub use sign::Sign;
pub use sqrt::Sqrt;
pub use sum::Sum;
pub use trigonometry::{Trigonometric, Trigonometry};

use super::{Item, item};

pub(super) static BLOCKS: &[Item] = &[
    item::<Sum>(),
    item::<Gain>(),
    item::<MatrixGain>(),
    item::<Product>(),
    item::<Divide>(),
    item::<Dot>(),
    item::<Cross>(),
    item::<Norm>(),
    item::<Min>(),
    item::<Max>(),
    item::<Abs>(),
    item::<Sign>(),
    item::<Sqrt>(),
    item::<Power>(),
    item::<Polynomial>(),
    item::<Trigonometry>(),
    item::<Function>(),
    item::<Expression>(),
];
