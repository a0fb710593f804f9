//! Maths: without memory, component by component unless said otherwise.

mod gain;
mod sum;

pub use gain::Gain;
pub use sum::Sum;

use super::{Item, item};

pub(super) const SHELF: &[Item] = &[item::<Sum>(), item::<Gain>()];
