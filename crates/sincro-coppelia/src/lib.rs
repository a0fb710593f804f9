//! The API of V-REP and CoppeliaSim as a controller in lock-step.
//!
//! | modules | hold |
//! |---|---|
//! | [`api`] | objects with their handles, typed functions, functions by name |
//! | [`session`] | the life of the runs that clients make |
//! | [`host`] | host of the scripts of a run: when they are called, and with what |
//! | [`api_controller`] | objects and scripts as one [`sincro_sim::controller::Controller`] |

pub mod api;
pub mod api_controller;
pub mod host;
pub mod session;
