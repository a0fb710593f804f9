//! Aerodynamic force elements: rotors, drag, wind.

pub mod drag;
pub mod rotor;
pub mod wind;

pub use drag::AirDrag;
