//! Designs of experiments: points of the unit cube as pure functions of a seed and an index, and distributions.

pub mod distribution;
pub mod random;
pub(crate) mod sobol;

pub(crate) use distribution::normal_cdf;
pub use distribution::{Distribution, inverse_normal};
