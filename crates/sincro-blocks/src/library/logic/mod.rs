//! Logic and comparison: true is 1, false is 0; any number but zero is taken for true, and a NaN makes NaN.

mod compare;
mod counter;
mod edge;
mod interval_test;
mod latch;
#[allow(clippy::module_inception)] // a file for every block, and this is its name
mod logic;
pub(super) mod truth;

pub use compare::{Compare, Comparison};
pub use counter::Counter;
pub use edge::{Direction, Edge};
pub use interval_test::IntervalTest;
pub use latch::{Dominant, Latch};
pub use logic::{Logic, Operator};

use super::{Item, item};

pub(super) static BLOCKS: &[Item] =
    &[item::<Compare>(), item::<IntervalTest>(), item::<Logic>(), item::<Edge>(), item::<Latch>(), item::<Counter>()];
