//! Block diagrams: ports, sample times, compiler, library.
//!
#![doc = include_str!("../README.md")]

pub mod block;
pub mod compile;
pub mod diagram;
pub mod endpoint;
pub mod instance;
pub mod kind;
pub mod lanes;
pub mod library;
pub mod parameter;
pub mod prelude;
pub mod program;
pub mod reader;
pub mod runner;
pub mod simulator;
pub mod suggest;
pub mod unit;
pub mod unit_rule;
