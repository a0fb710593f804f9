//! Lock-step simulation: scenes, their controllers, the step that all of them make together, and its results.
//!
//! [`load()`] opens a scene folder and reports every problem in it at once; [`campaign::run_campaign`] runs it with its
//! variants, sweep, error bars and checks; [`results`] is what is written. [`rollout`] advances many worlds of one
//! structure on all processors.
//!
//! A scene folder is loaded and run, then stepped by hand:
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use sincro_sim::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = std::env::temp_dir().join(format!("sincro-sim-doc-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! std::fs::write(folder.join("scene.toml"), r#"
//!     [[joint]]
//!     name = "hinge"
//!     kind = "revolute"
//!     axis = [0.0, 1.0, 0.0]
//!     initial = { position = 0.1 }
//!
//!     [[body]]
//!     name = "bob"
//!     parent = "/hinge"
//!     mass = 2.0
//!     center_of_mass = [0.0, 0.0, -1.0]
//!     inertia = { xx = 0.01, yy = 0.01, zz = 0.01 }
//! "#)?;
//! std::fs::write(folder.join("experiment.toml"), r#"
//!     title = "Pendulum"
//!     duration = 2.0
//!     step = 0.01
//!     record = ["/hinge.position", "energy.balance"]
//! "#)?;
//! let loaded = load(&folder, &[], Extensions::default())?;
//! let mut monitor = RunMonitor { interrupt: &AtomicBool::new(false), progress: &mut |_| {} };
//! let run = simulate(&loaded, RunOptions::default(), &mut monitor)?;
//! assert_eq!(run.status, Status::Completed);
//! let angle = &run.table.column("/hinge.position").unwrap().values; // [rad], 0.01 s apart
//! assert!(angle.len() == 201 && angle[0] == 0.1);
//! let balance = &run.table.column("energy.balance").unwrap().values; // [J]
//! assert!(balance.iter().all(|joules| joules.abs() < 1e-7));
//!
//! // the same run step by step, as controllers in Rust want it: the same bits
//! let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
//! lockstep.start()?;
//! while lockstep.tick() < 200 {
//!     lockstep.advance()?;
//! }
//! assert_eq!(lockstep.state().q[0], angle[200]);
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok(())
//! # }
//! ```
//!
//! | modules | hold |
//! |---|---|
//! | [`load`](mod@load) | an opened folder with the parts of the program that it needs: language of scripts, linearisation |
//! | [`notes`] | messages of controllers that are kept with a run, bounded |
//! | [`controller`], [`diagram_controller`] | controllers in lock-step; block diagrams as one |
//! | [`sensors`], [`proximity`] | sensors of a scene in a run |
//! | [`run`] | the step, and a run from its start to its end |
//! | [`restructure`], [`structure`] | change of the structure between two steps, and what it has become |
//! | [`runtime_object`] | objects that clients and scripts make at run time, for pictures |
//! | [`trace`], [`snapshot`], [`validity`], [`replay`] | hash of a run, state as bytes, validity of rotor theory, keyframes |
//! | [`audit`] | laws, solver, energy balance and inputs of every run, against the limits of its accuracy |
//! | [`table`], [`formats`], [`sweep`], [`check`], [`results`], [`result_folder`], [`file`](mod@file) | columns of numbers, sweeps, checks, `run.json`, folders and files of results |
//! | [`task`] | many worlds of a task, for reinforcement learning |
//! | [`campaign`] | an experiment with its variants, sweep and error bars |
//! | [`workers`] | independent jobs on all processors |

pub mod audit;
pub mod campaign;
pub mod check;
pub mod controller;
pub mod diagram_controller;
mod error;
pub mod file;
pub mod formats;
pub mod load;
pub mod notes;
mod number;
pub mod prelude;
pub mod proximity;
pub mod replay;
pub mod restructure;
pub mod result_folder;
pub mod results;
#[cfg(feature = "tasks")]
pub mod rollout;
pub mod run;
pub mod runtime_object;
pub mod sensors;
pub mod snapshot;
pub mod structure;
pub mod sweep;
pub mod table;
#[cfg(feature = "tasks")]
pub mod task;
pub mod trace;
pub mod validity;
pub mod workers;

pub use load::{ControllerFactory, Extensions, Loaded, ScriptEngine, load, load_without_variants};
