//! Test support: temporary scene folders, the scenes that several crates test with, runs, served sessions, clients of
//! every protocol, random numbers, and the command line as a program.
//!
//! A dev-dependency of the other crates; no program contains it. Everything panics on failure, as tests do.

pub mod clients;
mod command_line;
mod folder;
pub mod random;
mod run;
pub mod scenes;
mod serve;
pub mod systems;

pub use command_line::{CommandLine, Exit};
pub use folder::{SceneFolder, repository_scene};
pub use run::{last, run, with_scripts};
pub use serve::{OpenSession, ServedSession, finished, free_port, options};
