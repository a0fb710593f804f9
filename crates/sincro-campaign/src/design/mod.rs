//! Designs of experiments: points of the unit cube as pure functions of a seed and an index, and distributions.

pub mod distribution;
pub mod random;
pub mod sobol;

pub use distribution::{Distribution, inverse_normal, normal_cdf};
