//! Actuation and passive forces of joints: motors, drives, Coulomb friction, springs, dampers, torques given over time.
//!
//! | element | torque on its joint | potential energy | dissipated power |
//! |---|---|---|---|
//! | [`spring`] | −k (q − rest) | ½ k (q − rest)² | |
//! | `damper` | −c q̇ | | c q̇² |
//! | `friction` | locked: any torque within the limit; sliding: ∓ limit(q̇) | | limit(q̇)·\|q̇\| |
//! | [`motor`] | by mode | | −τ q̇ |
//! | [`winding`] | N k_t i | ½ L i² | R i² |
//! | [`activation`] | none: what acts in the place of a command | | |
//! | [`applied`] | a signal of time | | −τ q̇ |
//! | [`elastic_gear`] | −k p − c ẋ between two joints, outside of the backlash | ½ k p² | c ẋ² |
//! | [`spring_damper`] | a force along the line between two points | −∫ F(x, 0) dx | (F(x, 0) − F(x, ẋ)) ẋ |
//! | [`bushing`] | a force and torque between two frames | ½ Σ kᵢ xᵢ² | Σ cᵢ ẋᵢ² |
//!
//! [`motor`], [`force_law`], [`winding`], [`activation`], [`elastic_gear`], [`spring_damper`] and [`bushing`] are those
//! of the crate `sincro-actuation`. Uniform gravity enters the recursions as an acceleration of the base
//! ([`crate::energy`] has its potential energy), one that depends on the position as forces on bodies
//! ([`gravity_field`]); elements in the air are in [`crate::aero`].

pub mod applied;
pub(crate) mod damper;
pub mod drive;
pub(crate) mod friction;
pub mod spring;

pub use applied::{AppliedTorque, AppliedWrench, ExternalForce};
pub use drive::{Drive, DriveKind};
pub use sincro_actuation::{
    Activation, ActivationDynamics, Bushing, ElasticGear, ForceLaw, ForceTable, GravityField, Motor, MotorMode,
    NonlinearLaw, SpringDamper, Winding, activation, bushing, elastic_gear, force_law, gravity_field, motor,
    spring_damper, winding,
};
