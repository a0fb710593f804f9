//! Who acts when: scenes, experiments, the run and what comes out of it.
//!
//! [`load`] opens a scene folder and reports every problem in it at once; [`run::run_campaign`] runs it with its variants, sweep,
//! error bars and checks; [`results`] is what is written. [`rollout`] advances many worlds of one structure on all processors.

pub mod api_controller;
mod apply_overrides;
pub mod camera;
pub mod campaign;
pub mod check;
pub mod controller;
pub mod diagram;
pub mod diagram_controller;
pub mod document;
pub mod experiment;
pub mod file;
mod folder;
pub mod host;
pub mod linear;
pub mod linearize;
mod load;
pub mod motion;
pub mod open;
pub mod overrides;
pub mod problem;
pub mod proximity;
pub mod record;
pub mod replay;
pub mod results;
pub mod rollout;
pub mod run;
pub mod scene;
pub mod scenery;
pub mod schema;
pub mod script;
pub mod sensor;
pub mod sensors;
mod series;
pub mod session;
pub mod snapshot;
mod suggest;
pub mod sweep;
pub mod table;
pub mod trace;
mod tree;
pub mod validity;

pub use load::{Extensions, Loaded, ScriptEngine, load, load_alone};
