//! Scene files and the run.

pub mod experiment;
pub mod problem;
