#![doc = include_str!("../README.md")]
//! # Elements
//!
//! | element | force or torque | potential energy | dissipated power |
//! |---|---|---|---|
//! | [`force_law`] | preload − k x − c ẋ + N(x, ẋ) | −∫ F(x, 0) dx | (F(x, 0) − F(x, ẋ)) ẋ |
//! | [`winding`] | N k_t i | ½ L i² | R i² |
//! | [`activation`] | none: what acts in the place of a command | | |
//! | [`velocity_band`] | none: where the velocity of a drive counts as its target | | |
//! | [`elastic_gear`] | −k p − c ẋ between two joints, outside of the backlash | ½ k p² | c ẋ² |

pub mod activation;
pub mod elastic_gear;
pub mod force_law;
pub mod velocity_band;
pub mod winding;

pub use activation::{Activation, ActivationDynamics};
pub use elastic_gear::ElasticGear;
pub use force_law::{ForceLaw, ForceTable, NonlinearLaw};
pub use velocity_band::VelocityBand;
pub use winding::Winding;
