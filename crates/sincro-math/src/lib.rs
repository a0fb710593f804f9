#![doc = include_str!("../README.md")]
// a loop over lanes reads one index in several arrays
#![allow(clippy::needless_range_loop)]

mod branches;
pub mod compiled;
pub mod dual;
pub mod elementary;
pub mod error;
pub mod expression;
mod functions;
pub mod lanes;
pub mod least_squares;
pub mod orthogonalization;
pub mod random;
mod real;
pub mod record;
mod scalar;
pub mod scalar_field;
pub mod series;
pub mod signal;

pub use branches::Branches;
pub use dual::Dual;
pub use lanes::{LaneVisitor, Lanes};
pub use real::{Real, Task, dot};
