//! Recursive algorithms of multibody dynamics, each linear in the number of links (the mass matrix: links × depth).

pub mod aba;
pub mod crba;
pub mod kinematics;
pub mod rnea;
