//! Scalars, SIMD lanes and dual numbers under one trait, elementary functions with the same bits on every platform,
//! formulas in text.
//!
//! Every algorithm of the dynamics and of block diagrams is written once over the trait [`Real`] and runs on
//!
//! - `f64`: one world, full precision;
//! - [`lanes`]: several worlds side by side in the lanes of a vector register, each with the bits it would have alone;
//! - [`Dual<N>`]: a value and `N` exact partial derivatives, for linearisation.
//!
//! The elementary functions ([`elementary`]) are polynomials and pure-Rust routines shared by all three: no call goes
//! to the platform's C library, so the same inputs give the same bits on every machine, in debug and in release.
//!
//! [`expression`] reads formulas in text (`0.5*m*v^2`) and evaluates them over any [`Real`].

// a loop over lanes reads one index in several arrays
#![allow(clippy::needless_range_loop)]

pub mod dual;
pub mod elementary;
pub mod expression;
pub mod lanes;
mod real;
mod scalar;

pub use dual::Dual;
pub use lanes::{LaneVisitor, Lanes};
pub use real::{Real, Task};
