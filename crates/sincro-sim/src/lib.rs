//! Lock-step simulation: scenes, their controllers, the step that all of them make together, and its results.
//!
//! [`load()`] opens a scene folder and reports every problem in it at once; [`campaign::run_campaign`] runs it with its
//! variants, sweep, error bars and checks; [`results`] is what is written. [`rollout`] advances many worlds of one
//! structure on all processors.
//!
//! | modules | hold |
//! |---|---|
//! | [`load`](mod@load) | an opened folder with the parts of the program that it needs: language of scripts, linearisation |
//! | [`controller`], [`diagram_controller`] | controllers in lock-step; block diagrams as one |
//! | [`sensors`], [`proximity`] | sensors of a scene in a run |
//! | [`run`] | the step, and a run from its start to its end |
//! | [`trace`], [`snapshot`], [`validity`], [`replay`] | hash of a run, state as bytes, validity of rotor theory, keyframes |
//! | [`table`], [`sweep`], [`check`], [`results`], [`file`](mod@file) | columns of numbers, sweeps, checks, `run.json`, result files |
//! | [`campaign`] | an experiment with its variants, sweep and error bars |

pub mod campaign;
pub mod check;
pub mod controller;
pub mod diagram_controller;
mod error;
pub mod file;
pub mod load;
pub mod proximity;
pub mod replay;
pub mod results;
pub mod rollout;
pub mod run;
pub mod sensors;
pub mod snapshot;
pub mod sweep;
pub mod table;
pub mod trace;
pub mod validity;

pub use load::{Extensions, Loaded, ScriptEngine, load, load_alone};
