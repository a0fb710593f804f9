//! What is run, recorded and checked.

pub mod check;
