//! Scripts in scenes, run as `sincro run` runs them.

mod api;
mod blocks;
mod callbacks;
mod coroutines;
mod customization;
mod errors;
mod graphs;
mod inverse;
mod language;
mod limits;
mod modules;
mod motion;
mod names;
mod old_names;
mod parity;
mod paths;
mod pictures;
mod placing;
mod planning;
mod propeller;
mod senses;
mod structure;
mod styles;
mod touching;
mod vision;
mod world;
