//! Force elements: what pushes and brakes the bodies, each with its torque, its energy or its power.
//!
//! | element | torque on its joint | stores | takes |
//! |---|---|---|---|
//! | [`spring`] | −k (q − rest) | ½ k (q − rest)² | |
//! | [`damper`] | −c q̇ | | c q̇² |
//! | [`friction`] | ∓ limit, or whatever holds | | limit·|q̇| |
//! | [`motor`] | by mode | | −τ q̇ |
//! | [`applied`] | a signal of time | | −τ q̇ |
//! | [`gravity`] | through the base's acceleration | −m g·c | |
//! | [`rotor`] | thrust and reaction at a hub | | what the shaft gives |
//! | [`drag`] | −½ρ·abs(u)·(a ∘ u) − c ∘ u at a point | | −F·u |

pub mod applied;
pub mod damper;
pub mod drive;
pub mod friction;
pub mod motor;
pub mod spring;

pub use applied::{AppliedTorque, AppliedWrench, Push};
pub use drive::{Drive, DriveKind};
pub use motor::{Motor, MotorMode};
