//! Scene files and the run.

pub mod document;
pub mod experiment;
mod folder;
mod load;
pub mod overrides;
pub mod problem;
pub mod scene;
pub mod schema;
mod series;
mod suggest;
mod tree;

pub use load::{Loaded, load};
