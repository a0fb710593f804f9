//! Deterministic simulation of robots and their controllers in lock-step: the library that puts the parts together.
//!
//! The parts are crates of their own: `sincro-dynamics` (multibody dynamics), `sincro-blocks` (block diagrams),
//! `sincro-sim` (scenes, experiments, the run), the adapters `sincro-lua`, `sincro-remote` and `sincro-viewer`, and
//! `sincro-figures`. None of the adapters knows another. This crate joins them once, for the command line and for every
//! other front end; but for the command line itself (`command_line`, feature `run`), it prints nothing
//! and never ends the process.
//!
//! | to do | use |
//! |---|---|
//! | open a scene folder whose scripts are in Lua | [`load`] |
//! | run an experiment and write its results and report | [`RunRequest`] |
//! | judge a finished run | [`Verdict`] |
//! | serve a scene to clients of V-REP and CoppeliaSim | [`serve`] |
//! | show a scene live, or a finished run, in the browser | [`view`] |
//! | export a scene as an FMU | [`export`] |
//! | export a scene as C | [`export_c`] |
//! | compare two finished runs | [`compare`] |
//! | write the linearisation of a scene | [`linearization`] |
//! | write pictures, frames, cards of a run | [`results`] |
//!
//! A scene folder, run from a program:
//!
//! ```
//! use std::path::Path;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/free-body");
//! let overrides = [sincro::Override::new("duration", "0.1")];
//! let loaded = sincro::load(&scene, &overrides)?;
//! let simulated = sincro::simulate(&loaded)?;
//! let times = simulated.table.times();
//! assert!((times.last().unwrap() - 0.1).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```

// the commands name the library as any other program would
#[cfg(feature = "run")]
extern crate self as sincro;

#[cfg(feature = "run")]
pub mod command_line;
#[cfg(feature = "run")]
mod commands;
pub mod compare;
#[cfg(feature = "run")]
mod diagnostics;
#[cfg(feature = "adapters")]
pub mod export;
#[cfg(feature = "formats")]
pub mod export_c;
#[cfg(feature = "analysis")]
pub mod linearization;
mod load;
pub mod results;
mod run;
#[cfg(feature = "adapters")]
pub mod serve;
#[cfg(feature = "run")]
mod snippet;
#[cfg(feature = "adapters")]
pub mod view;

#[cfg(feature = "run")]
pub(crate) use command_line::Exit;
pub use load::{camera, extensions, load, scene_name};
pub use run::{RunFailure, RunRequest, Verdict, simulate};

#[cfg(feature = "adapters")]
pub use sincro_lua::abort_running_scripts;
pub use sincro_scene::diagnostic::Diagnostics;
pub use sincro_scene::overrides::Override;
pub use sincro_sim::Loaded;
pub use sincro_sim::campaign::Campaign;
