//! Recorded numbers: an algorithm that is generic over [`Real`](crate::Real), run once on [`Recorded`] numbers, leaves
//! the straight-line [`Program`] of its operations. Programs are compiled by `sincro-compile`; here they can be
//! evaluated and differentiated.
//!
//! A recording can tell no branch: whoever asks for the value of a recorded number that is not constant
//! ([`Real::lane`](crate::Real::lane), a comparison by `==`) makes the recording fail, with the reason. So a program
//! that exists is proved to be free of branches.
//!
//! A program gives the bits of the algorithm that it was recorded from, as long as its numbers are finite. What is
//! left out is exact: operations on constants, x·1, −(−x), x + (−y), equal operations made twice; and x·0 = 0,
//! x + 0 = x, which are exact but for the sign of a zero. Who relies on bits compares both, as `sincro-compile` does.

mod program;
mod recorded;
mod recorder;

pub use program::{Operation, Program};
pub use recorded::{Recorded, sin_cos_of_operations};
pub use recorder::{Unrecordable, record};
