#![doc = include_str!("../README.md")]
//! # Modules
//!
//! From the bottom up; a module uses only those above it in this list (`cargo xtask tidy` measures it).
//!
//! | module | content |
//! |---|---|
//! | [`spatial`], [`geometry`] | spatial algebra; shapes, distances, ray casts: the crate `sincro-geometry` |
//! | [`contact`] | colliders, materials, broad and narrow phase, contact manifolds: the crate `sincro-contact` |
//! | [`aero`] | rotors, drag, wind: the crate `sincro-aero` |
//! | [`signal`], [`ids`], [`error`] | functions of time; ids; refused parameters |
//! | [`joint`] | joints, links, passive properties of degrees of freedom |
//! | [`actuation`] | motors, drives, friction, springs, dampers |
//! | [`model`] | the compiled tree and its builder |
//! | [`state`], [`scratch`] | generalized coordinates and all else that changes; working memory |
//! | [`recursions`] | forward and inverse dynamics, mass matrix, kinematics |
//! | [`energy`] | energies and momentum |
//! | [`constraint`] | loop joints, joint limits, contacts with friction: one complementarity problem |
//! | [`stiffness`] | rates of springs and dampers |
//! | [`integrate`] | fixed-step and error-controlled methods: the crate `sincro-integrate` |
//! | [`mechanism`], [`coupled`] | the system to integrate; systems integrated along with it |
//! | [`initial`] | consistency of an initial state |
//! | [`transfer`] | the state of a model carried over to another one: structure that changes |
//! | [`world`], [`batch`] | a world that advances; many worlds in lanes |
//! | [`tangent`] | a world with the derivative of its motion by one parameter |
//!
//! A [`model::Model`] is the compiled tree; a [`state::State`] the numbers that a snapshot needs; a
//! [`scratch::Scratch`] can be recomputed at any time. A [`world::World`] owns one of each, and its model's numbers can
//! be set between steps; every algorithm below it is a function of the three.

pub mod actuation;
#[cfg(feature = "batch")]
pub mod batch;
mod compile;
pub mod constraint;
pub mod coupled;
pub mod energy;
pub mod ids;
pub mod initial;
pub mod joint;
pub mod mechanism;
pub mod model;
pub mod occurrences;
pub mod prelude;
pub mod recursions;
pub mod scratch;
pub mod state;
pub mod stiffness;
#[cfg(feature = "tangent")]
pub mod tangent;
pub mod transfer;
pub mod world;

pub use sincro_aero as aero;
pub use sincro_contact as contact;
pub use sincro_geometry::{self as geometry, spatial};
pub use sincro_integrate as integrate;
pub use sincro_math::{error, signal};

pub use recursions::{aba, crba, kinematics, rnea};
