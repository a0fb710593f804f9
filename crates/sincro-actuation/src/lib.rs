#![doc = include_str!("../README.md")]
//! # Elements
//!
//! | element | force or torque | potential energy | dissipated power |
//! |---|---|---|---|
//! | [`force_law`] | preload − k x − c ẋ + N(x, ẋ) | −∫ F(x, 0) dx | (F(x, 0) − F(x, ẋ)) ẋ |
//! | [`motor`] | by mode | | −τ q̇ |
//! | [`winding`] | N k_t i | ½ L i² | R i² |
//! | [`activation`] | none: what acts in the place of a command | | |
//! | [`velocity_band`] | none: where the velocity of a drive counts as its target | | |
//! | [`friction`] | at rest: any within the limit; in motion: ∓ limit(q̇) | | limit(q̇)·\|q̇\| |
//! | [`kink`] | none: which limited drives are locked and which saturated | | |
//! | [`spring_damper`] | a force along the line between two points | −∫ F(x, 0) dx | (F(x, 0) − F(x, ẋ)) ẋ |
//! | [`bushing`] | a force and torque between two frames | ½ Σ kᵢ xᵢ² | Σ cᵢ ẋᵢ² |
//! | [`gravity_field`] | m g(p) on a body at its centre of mass | m U(p) | |
//! | [`elastic_gear`] | −k p − c ẋ between two joints, outside of the backlash | ½ k p² | c ẋ² |

pub mod activation;
pub mod bushing;
pub mod elastic_gear;
pub mod force_law;
pub mod friction;
pub mod gravity_field;
pub mod kink;
pub mod motor;
pub mod spring_damper;
pub mod velocity_band;
pub mod winding;

pub use activation::{Activation, ActivationDynamics};
pub use bushing::Bushing;
pub use elastic_gear::ElasticGear;
pub use force_law::{ForceLaw, ForceTable, NonlinearLaw};
pub use friction::Friction;
pub use gravity_field::GravityField;
pub use kink::{Kink, Kinks, Pivoting};
pub use motor::{Motor, MotorMode};
pub use spring_damper::SpringDamper;
pub use velocity_band::VelocityBand;
pub use winding::Winding;
