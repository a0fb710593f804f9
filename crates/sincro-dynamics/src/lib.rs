//! What bodies do: the dynamics of kinematic trees in joint coordinates.
//!
//! A [`model::Model`] is built once and immutable; a [`state::State`] is exactly what must be saved to continue a run
//! bit for bit; a [`scratch::Scratch`] holds what can be recomputed at any time. Every algorithm is a function of the
//! three and is written once over [`Real`](sincro_math::Real).
//!
//! | want | see |
//! |---|---|
//! | accelerations from torques | [`aba`] |
//! | torques from accelerations | [`rnea`] |
//! | the mass matrix | [`crba`] |
//! | poses, velocities, Jacobians | [`kinematics`] |
//! | energies and momentum | [`energy`] |
//! | springs, dampers, friction, motors, rotors | [`force`] |
//! | closed loops, limits of joints, one solver for all constraints | [`constraint`] |
//! | what touches what | [`contact`] |
//! | what a ray hits, how far surfaces are apart | [`geometry`] |
//! | a world that advances | [`integrate`], [`world`] |
//! | the air that moves | [`wind`] |
//! | whether it can start so | [`start`] |
//! | how stiff it is | [`stiffness`] |
//! | what is integrated along, such as a diagram | [`attachment`] |
//! | many worlds at once | [`batch`] |
//!
//! Conventions: SI and radians; right-handed; six-vectors have their angular part first; quaternions are (w, x, y, z).
//! No files, clocks, threads or logs in this crate.

pub mod actuation;
pub mod aero;
pub mod batch;
mod compile;
pub mod constraint;
pub mod contact;
pub mod coupled;
pub mod energy;
pub mod geometry;
pub mod ids;
pub mod initial;
pub mod integrate;
pub mod joint;
pub mod mechanism;
pub mod model;
pub mod recursions;
pub mod scratch;
pub mod signal;
pub mod spatial;
pub mod state;
pub mod stiffness;
pub mod world;

pub use recursions::{aba, crba, kinematics, rnea};
