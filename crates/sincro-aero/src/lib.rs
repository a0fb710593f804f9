#![doc = include_str!("../README.md")]
//! # Elements
//!
//! | element | wrench on its link | power |
//! |---|---|---|
//! | [`rotor`] | thrust and reaction torque at the hub | delivered by the shaft |
//! | [`drag`] | −½ρ·abs(u)·(a ∘ u) − c ∘ u at the centre of pressure | dissipation −F·u |

pub mod drag;
pub mod rotor;
pub mod wind;

pub use drag::AirDrag;
