//! Scripts in scenes, run as `sincro run` runs them.

mod api;
mod blocks;
mod inverse;
mod language;
mod limits;
mod parity;
mod propeller;
mod styles;
mod touching;
mod world;
