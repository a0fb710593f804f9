//! Robots that are imported, as scenes that are read again: what is kept, what is told, what is refused.

mod actuation;
mod bad_input;
mod classes;
mod defaults;
mod export;
mod folder;
mod mjcf;
mod round_trip;
mod sdf;
mod urdf;
